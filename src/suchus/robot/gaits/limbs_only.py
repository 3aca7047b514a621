"""The crawl of the article's control group: the same legs, the trunk straight, the tail lying still on the ground.

The article's control group crawls with "the tail lifted off the ground, and the spine and tail were fixed" (IV.A).
With our masses a robot with its tail in the air (``limbs_tail_lifted``) is so heavy behind that its hind feet never
leave the ground: it walks in no gait, and what is compared with it is compared with a robot that drags its feet. So
the control group is this one, whose tail lies as in the crawl with spine and tail: both differ in nothing but the
motion of spine and tail. The other is simulated beside it wherever a claim rests on the control group.
"""

from suchus.robot.gaits import belly_crawl

gait = belly_crawl.gait.without("axis", name="limbs_only")
"""Legs alone."""
trunk_steering = {"caiman": 0.13}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""
chosen = belly_crawl.chosen
