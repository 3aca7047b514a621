"""The crawl with the trunk straight and the tail on the ground, swinging as in the full crawl."""

from suchus.robot.gaits import belly_crawl

gait = belly_crawl.gait.without("trunk", name="tail_drag")
"""Legs and tail."""
chosen = belly_crawl.chosen
