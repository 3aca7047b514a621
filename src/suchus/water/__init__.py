"""The robot in water: its outline, waves fitted to its joints, and the models a designer calculates with."""

from suchus.design.water import Water
from suchus.water.diary import portion
from suchus.water.fit import Fit, fit, head_base
from suchus.water.free import check_free_swim, free_swim
from suchus.water.held import tether
from suchus.water.immersed import immersed
from suchus.water.measures import Quarters, Sway, Swum, convex_higher, efficiency, level, swing, wave_form
from suchus.water.outline import Base, BodySilhouette, MidlineCurve, Outline, silhouette
from suchus.water.passive import sprung
from suchus.water.readings import Attempt, attempts, readings_table
from suchus.water.slender import Cruise, Effort, cruise, cycle, reactive, recoil, resistive
from suchus.water.space import Basin, check_swim_in_space, folded, half_heights, swim_in_space, trunk
from suchus.water.space_held import held_in_space, towed_in_space
from suchus.water.sweep import greatest, scaled, survey
from suchus.water.swimming import MODELS, displaced, swim, wave_speed
from suchus.water.taken import taken, unevenness
from suchus.water.tank import Tether
from suchus.water.towed import towed
from suchus.water.undulation import ExactWave, Motion, Undulation, undulation
from suchus.water.waves import BodyWave, EelWave, PrintedWave, printed_wave

__all__ = [
    "MODELS",
    "Attempt",
    "Base",
    "Basin",
    "BodySilhouette",
    "BodyWave",
    "Cruise",
    "EelWave",
    "Effort",
    "ExactWave",
    "Fit",
    "MidlineCurve",
    "Motion",
    "Outline",
    "PrintedWave",
    "Quarters",
    "Sway",
    "Swum",
    "Tether",
    "Undulation",
    "Water",
    "attempts",
    "check_free_swim",
    "check_swim_in_space",
    "convex_higher",
    "cruise",
    "cycle",
    "displaced",
    "efficiency",
    "fit",
    "folded",
    "free_swim",
    "greatest",
    "half_heights",
    "head_base",
    "held_in_space",
    "immersed",
    "level",
    "portion",
    "printed_wave",
    "reactive",
    "readings_table",
    "recoil",
    "resistive",
    "scaled",
    "silhouette",
    "sprung",
    "survey",
    "swim",
    "swim_in_space",
    "swing",
    "taken",
    "tether",
    "towed",
    "towed_in_space",
    "trunk",
    "undulation",
    "unevenness",
    "wave_form",
    "wave_speed",
]
