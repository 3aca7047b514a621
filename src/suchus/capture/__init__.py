"""Tracked keypoints of a walking body -> spine and tail angles, foot contacts, one mean cycle -> a gait."""

from suchus.capture.angle_table import AngleCycle, is_angle_table, read_angles
from suchus.capture.animal import SyntheticAnimal, film_animal
from suchus.capture.film import Camera, film, keypoints
from suchus.capture.reading import ReadingOptions, read_tracks, summary, write_gait
from suchus.capture.retarget import NEEDED, Captured, driven_share, to_curves, to_gait
from suchus.capture.table import write_table
from suchus.capture.tracks import Tracks, UnusableTracks
from suchus.capture.walk import Seen, Walk, observe
from suchus.capture.wave import standing_index

__all__ = [
    "NEEDED",
    "AngleCycle",
    "Camera",
    "Captured",
    "ReadingOptions",
    "Seen",
    "SyntheticAnimal",
    "Tracks",
    "UnusableTracks",
    "Walk",
    "driven_share",
    "film",
    "film_animal",
    "is_angle_table",
    "keypoints",
    "observe",
    "read_angles",
    "read_tracks",
    "standing_index",
    "summary",
    "to_curves",
    "to_gait",
    "write_gait",
    "write_table",
]
