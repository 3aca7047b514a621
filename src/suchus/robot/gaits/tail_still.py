"""The crawl with the trunk swinging and the tail dragged along without a swing of its own."""

from suchus.robot.gaits import belly_crawl

gait = belly_crawl.gait.without("tail", name="tail_still")
"""Legs and trunk, the tail on the ground."""
trunk_steering = {"caiman": -0.04}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""
chosen = belly_crawl.chosen
