"""The crawl with the trunk straight and the tail on the ground, swinging as in the full crawl."""

from suchus.robot.gaits import belly_crawl

gait = belly_crawl.gait.without("trunk", name="tail_drag")
"""Legs and tail."""
trunk_steering = {"caiman": 0.14}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""
chosen = belly_crawl.chosen
