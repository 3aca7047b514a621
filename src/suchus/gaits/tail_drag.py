"""The crawl with the trunk straight and the tail on the ground, swinging as in the full crawl."""

from dataclasses import replace

from suchus.gaits import belly_crawl

gait = replace(belly_crawl.gait, name="tail_drag", trunk_bend=0.0)
"""Legs and tail."""
chosen = belly_crawl.chosen
