"""The crawl with the trunk swinging and the tail dragged along without a swing of its own."""

from suchus.robot.gaits import belly_crawl

gait = belly_crawl.gait.without("tail", name="tail_still")
"""Legs and trunk, the tail on the ground."""
chosen = belly_crawl.chosen
