"""When a walk begins."""

from suchus.paper import CRAWL_START

START = CRAWL_START
"""A robot stands still until then, so that it has settled on the ground [s]."""
