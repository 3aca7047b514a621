"""The crawl with the trunk swinging and the tail straight and lifted clear of the ground."""

from suchus.robot.gaits import belly_crawl
from suchus.robot.gaits.limbs_tail_lifted import LIFTED

gait = belly_crawl.gait.without("tail").lifted(LIFTED, name="spine_only")
"""Legs and trunk."""
trunk_steering = {"caiman": -1.26}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""
chosen = belly_crawl.chosen
