"""Kinematics: pure NumPy, double precision, batched over leading axes."""

from suchus.kinematics import body, dh, leg, limb, mass, printed, spine, tail, tree, trim, wave
from suchus.kinematics.body import Landmarks, landmarks
from suchus.kinematics.wave import TravellingWave

__all__ = [
    "Landmarks",
    "TravellingWave",
    "body",
    "dh",
    "landmarks",
    "leg",
    "limb",
    "mass",
    "printed",
    "spine",
    "tail",
    "tree",
    "trim",
    "wave",
]
