"""Kinematics: pure NumPy, double precision, batched over leading axes."""

from suchus.kinematics import dh, leg, limb, printed, spine, tail, tree, trim, wave
from suchus.kinematics.tree import Landmarks, landmarks
from suchus.kinematics.wave import TravellingWave

__all__ = [
    "Landmarks",
    "TravellingWave",
    "dh",
    "landmarks",
    "leg",
    "limb",
    "printed",
    "spine",
    "tail",
    "tree",
    "trim",
    "wave",
]
