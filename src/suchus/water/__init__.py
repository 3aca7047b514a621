"""The robot in water: its outline, waves fitted to its joints, and the models a designer calculates with."""

from suchus.water.fit import BodyWave, EelWave, Fit, PrintedWave, fit, head_base, printed_wave
from suchus.water.outline import Base, Curve, Outline, Silhouette, silhouette
from suchus.water.slender import Cruise, Effort, Water, cruise, cycle, reactive, recoil, resistive
from suchus.water.swimming import MODELS, displaced, swim, wave_speed

__all__ = [
    "MODELS",
    "Base",
    "BodyWave",
    "Cruise",
    "Curve",
    "EelWave",
    "Effort",
    "Fit",
    "Outline",
    "PrintedWave",
    "Silhouette",
    "Water",
    "cruise",
    "cycle",
    "displaced",
    "fit",
    "head_base",
    "printed_wave",
    "reactive",
    "recoil",
    "resistive",
    "silhouette",
    "swim",
    "wave_speed",
]
