"""Tracked keypoints of a walking body -> spine and tail angles, foot contacts, one mean cycle -> a gait."""

from suchus.animals.capture.angles import standing_index
from suchus.animals.capture.animal import SyntheticAnimal, film_animal
from suchus.animals.capture.beside import compare_joints, comparison_lines
from suchus.animals.capture.film import Camera, film, keypoints
from suchus.animals.capture.reading import ReadingOptions, read_tracks, summary, write_gait
from suchus.animals.capture.retarget import ROBOT_NEEDS, Captured, driven_fraction, to_curves, to_gait
from suchus.animals.capture.table import AngleCycle, is_angle_table, read_angles, write_table
from suchus.animals.capture.tables import angle_tables, tables
from suchus.animals.capture.tracks import Tracks, UnusableTracks, View
from suchus.animals.capture.walk import Measurement, Walk, observe

__all__ = [
    "ROBOT_NEEDS",
    "AngleCycle",
    "Camera",
    "Captured",
    "Measurement",
    "ReadingOptions",
    "SyntheticAnimal",
    "Tracks",
    "UnusableTracks",
    "View",
    "Walk",
    "angle_tables",
    "compare_joints",
    "comparison_lines",
    "driven_fraction",
    "film",
    "film_animal",
    "is_angle_table",
    "keypoints",
    "observe",
    "read_angles",
    "read_tracks",
    "standing_index",
    "summary",
    "tables",
    "to_curves",
    "to_gait",
    "write_gait",
    "write_table",
]
