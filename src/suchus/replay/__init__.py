"""A run on land as one HTML file: three-dimensional, plays offline, can be mailed."""

from suchus.replay.page import replay, save

__all__ = ["replay", "save"]
