"""A run on land or a swim as one HTML file: three-dimensional, plays offline, can be mailed; or as a film."""

from suchus.visual.replay.page import replay, save, wake_replay
from suchus.visual.replay.video import video

__all__ = ["replay", "save", "video", "wake_replay"]
