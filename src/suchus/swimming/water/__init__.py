"""The robot in water: its outline, waves fitted to its joints, and the models a designer calculates with.

Swims by CFD stand in ``suchus.swimming.water.resolved``, which loads the flow solver.
"""

from suchus.robot.design.water import Water
from suchus.swimming.water.fit import Fit, ReadingFit, fit, fits_of_readings, readings_table, swim_of
from suchus.swimming.water.measures import (
    Quarters,
    Sway,
    SwimMeasures,
    convex_higher,
    efficiency,
    level,
    swing,
    wave_form,
)
from suchus.swimming.water.outline import BodySilhouette, MidlineCurve, Outline, silhouette
from suchus.swimming.water.passive import with_passive_end
from suchus.swimming.water.slender import Cruise, Effort, cruise, cycle, reactive, recoil, resistive
from suchus.swimming.water.speed_range import RealWaterSpeed, SpeedEstimate, real_water_speed
from suchus.swimming.water.swimming import MODELS, displaced_mass, max_amplitude_factor, survey, swim, wave_speed
from suchus.swimming.water.undulation import ExactWave, Motion, Undulation, motion_of_record, undulation, unevenness
from suchus.swimming.water.waves import BodyWave, FilmedWave, PrintedWave, printed_wave

__all__ = [
    "MODELS",
    "BodySilhouette",
    "BodyWave",
    "Cruise",
    "Effort",
    "ExactWave",
    "FilmedWave",
    "Fit",
    "MidlineCurve",
    "Motion",
    "Outline",
    "PrintedWave",
    "Quarters",
    "ReadingFit",
    "RealWaterSpeed",
    "SpeedEstimate",
    "Sway",
    "SwimMeasures",
    "Undulation",
    "Water",
    "convex_higher",
    "cruise",
    "cycle",
    "displaced_mass",
    "efficiency",
    "fit",
    "fits_of_readings",
    "level",
    "max_amplitude_factor",
    "motion_of_record",
    "printed_wave",
    "reactive",
    "readings_table",
    "real_water_speed",
    "recoil",
    "resistive",
    "silhouette",
    "survey",
    "swim",
    "swim_of",
    "swing",
    "undulation",
    "unevenness",
    "wave_form",
    "wave_speed",
    "with_passive_end",
]
