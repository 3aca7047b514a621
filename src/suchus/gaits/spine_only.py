"""The crawl with the trunk swinging and the tail straight and lifted clear of the ground."""

from dataclasses import replace

from suchus.gaits import belly_crawl
from suchus.gaits.limbs_tail_lifted import LIFTED

gait = replace(belly_crawl.gait, name="spine_only", tail_bend=0.0, tail_pitch=LIFTED)
"""Legs and trunk."""
chosen = belly_crawl.chosen
