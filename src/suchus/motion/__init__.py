"""From phase to posture: one gait for every body, what it asks of servos, and courses of postures."""

from suchus.motion.draft import draft_gait
from suchus.motion.forms import AxialWave, GaitByAngles, GaitByPlaces, GaitInMetres, limb_reaches
from suchus.motion.gait import NUMBERS, Bend, Curve, FootPath, Gait, Held, Sweep
from suchus.motion.limits import (
    as_table,
    check_limits,
    excess,
    longest_strokes,
    servo_parts,
    servo_range,
    shortest_period,
    suits,
)
from suchus.motion.movement import (
    START,
    Batch,
    Intended,
    Movement,
    Steer,
    cycle_targets,
    hip_height,
    intended,
    limb_targets,
    middle_stance,
    movement,
)
from suchus.motion.posture import Keyed, Planned, Posture, plan
from suchus.motion.rising import stand_up, stretched, tallest
from suchus.motion.roll import Roll, check_roll, roll_targets
from suchus.motion.swim import LIMBS_BACK, Bends, Swim, bends, check_swim, limbs_back, swim_targets

__all__ = [
    "LIMBS_BACK",
    "NUMBERS",
    "START",
    "AxialWave",
    "Batch",
    "Bends",
    "Bend",
    "Curve",
    "FootPath",
    "Gait",
    "GaitByAngles",
    "GaitByPlaces",
    "GaitInMetres",
    "Held",
    "Intended",
    "Keyed",
    "Movement",
    "Planned",
    "Posture",
    "Roll",
    "Steer",
    "Sweep",
    "Swim",
    "as_table",
    "bends",
    "check_limits",
    "check_roll",
    "check_swim",
    "cycle_targets",
    "draft_gait",
    "excess",
    "hip_height",
    "intended",
    "limb_reaches",
    "limb_targets",
    "limbs_back",
    "longest_strokes",
    "middle_stance",
    "movement",
    "plan",
    "roll_targets",
    "servo_parts",
    "servo_range",
    "shortest_period",
    "stand_up",
    "stretched",
    "suits",
    "swim_targets",
    "tallest",
]
