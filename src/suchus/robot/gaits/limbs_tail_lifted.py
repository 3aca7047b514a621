"""The crawl with limbs only and the tail held clear of the ground, as the control group was until version 0.1."""

from suchus.robot.gaits import belly_crawl, limbs_only

LIFTED = -0.25  # [rad]; clear of the ground, and the passive end does not touch it either

gait = limbs_only.gait.lifted(LIFTED, name="limbs_tail_lifted")
"""Legs alone, the tail in the air: the robot is then so heavy behind that its hind feet never leave the ground."""
trunk_steering = {"caiman": 0.13}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""
chosen = belly_crawl.chosen
