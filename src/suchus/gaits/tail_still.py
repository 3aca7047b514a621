"""The crawl with the trunk swinging and the tail dragged along without a swing of its own."""

from dataclasses import replace

from suchus.gaits import belly_crawl

gait = replace(belly_crawl.gait, name="tail_still", tail_bend=0.0)
"""Legs and trunk, the tail on the ground."""
chosen = belly_crawl.chosen
