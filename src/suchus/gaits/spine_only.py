"""The crawl with the trunk swinging and the tail straight and lifted clear of the ground."""

from dataclasses import replace

from suchus.gaits.belly_crawl import chosen as chosen
from suchus.gaits.belly_crawl import gait as _crawl
from suchus.gaits.limbs_only import LIFTED

gait = replace(_crawl, name="spine_only", tail_bend=0.0, tail_pitch=LIFTED)
"""Legs and trunk."""
