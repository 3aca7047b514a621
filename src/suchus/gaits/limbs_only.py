"""The crawl of the article's control group: the same legs, the trunk straight, the tail lifted clear of the ground."""

from dataclasses import replace

from suchus.gaits import belly_crawl

LIFTED = -0.25  # [rad]; clear of the ground, and the passive end does not touch it either

gait = replace(belly_crawl.gait, name="limbs_only", trunk_bend=0.0, tail_bend=0.0, tail_pitch=LIFTED)
"""Legs alone."""
chosen = belly_crawl.chosen
