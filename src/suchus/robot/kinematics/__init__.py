"""Kinematics: pure NumPy, double precision, batched over leading axes."""

from suchus.robot.kinematics import dh, leg, limb, printed, spine, tail, tree, trim, wave
from suchus.robot.kinematics.tree import Landmarks, landmarks
from suchus.robot.kinematics.wave import TravellingWave

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
