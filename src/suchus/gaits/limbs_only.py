"""The crawl of the article's control group: the same legs, the trunk straight, the tail lying still on the ground.

The article says of this group only that tail and spine are not involved in the motion. Its tail lies as in the crawl
with spine and tail, so that both groups differ in nothing but the motion of spine and tail. With the tail held in the
air (``limbs_tail_lifted``) the robot is so heavy behind that its hind feet never leave the ground.
"""

from dataclasses import replace

from suchus.gaits import belly_crawl

gait = replace(belly_crawl.gait, name="limbs_only", trunk_bend=0.0, tail_bend=0.0)
"""Legs alone."""
chosen = belly_crawl.chosen
