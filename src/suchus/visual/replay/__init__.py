"""A run on land or a swim as one HTML file: three-dimensional, plays offline, can be mailed."""

from suchus.visual.replay.page import replay, save, wake_replay

__all__ = ["replay", "save", "wake_replay"]
