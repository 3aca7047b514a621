"""The crawl with the trunk swinging and the tail straight and lifted clear of the ground."""

from suchus.robot.gaits import belly_crawl
from suchus.robot.gaits.limbs_tail_lifted import LIFTED

gait = belly_crawl.gait.without("tail").lifted(LIFTED, name="spine_only")
"""Legs and trunk."""
chosen = belly_crawl.chosen
