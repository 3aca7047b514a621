"""The crawl with the trunk straight and the tail on the ground, swinging as in the full crawl."""

from dataclasses import replace

from suchus.gaits.belly_crawl import chosen as chosen
from suchus.gaits.belly_crawl import gait as _crawl

gait = replace(_crawl, name="tail_drag", trunk_bend=0.0)
"""Legs and tail."""
