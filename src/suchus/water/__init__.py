"""The robot in water: its outline, waves fitted to its joints, and the models a designer calculates with."""

from suchus.water.fit import BodyWave, EelWave, Fit, PrintedWave, fit, head_base, printed_wave
from suchus.water.immersed import immersed
from suchus.water.outline import Base, Curve, Outline, Silhouette, silhouette
from suchus.water.resolved import Tether, free_swim, tether
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
    "Tether",
    "Water",
    "cruise",
    "cycle",
    "displaced",
    "fit",
    "free_swim",
    "head_base",
    "immersed",
    "printed_wave",
    "reactive",
    "recoil",
    "resistive",
    "silhouette",
    "swim",
    "tether",
    "wave_speed",
]
