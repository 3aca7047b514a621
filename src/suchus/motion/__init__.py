"""From time to intended posture: phases, foot paths, bends, servo targets."""

from suchus.motion.altered import (
    longest_strokes,
    straightened,
    strides,
    with_axis_lag,
    with_bends,
    with_strokes,
)
from suchus.motion.angle_table import AngleTable, Curve
from suchus.motion.any_body import (
    AnyGait,
    Intended,
    check_limits,
    cycle_targets,
    hip_height,
    intended,
    limb_targets,
    middle_stance,
    pattern_targets,
    shortest_period,
)
from suchus.motion.draft import draft_gait
from suchus.motion.gait import Gait, Legs
from suchus.motion.pattern import AxialWave, FootPath, Held, Pattern, Sweep
from suchus.motion.phase import limb_phase, stance, tail_bend, trunk_bend
from suchus.motion.posture import Keyed, Planned, Posture, plan
from suchus.motion.rising import stand_up, stretched, tallest
from suchus.motion.roll import Roll, check_roll, roll_targets
from suchus.motion.steered import bends as axis_bends
from suchus.motion.steered import steerable, steered, trunk_amplitude
from suchus.motion.swim import LIMBS_BACK, Bends, Swim, bends, check_swim, limbs_back, swim_targets
from suchus.motion.tabled import as_table
from suchus.motion.targets import foot_targets, longest_stroke, servo_targets, within_reach
from suchus.motion.timing import START

__all__ = [
    "LIMBS_BACK",
    "START",
    "AngleTable",
    "AnyGait",
    "AxialWave",
    "Bends",
    "Curve",
    "FootPath",
    "Gait",
    "Held",
    "Intended",
    "Keyed",
    "Legs",
    "Pattern",
    "Planned",
    "Posture",
    "Roll",
    "Sweep",
    "Swim",
    "as_table",
    "axis_bends",
    "bends",
    "check_limits",
    "check_roll",
    "check_swim",
    "cycle_targets",
    "draft_gait",
    "foot_targets",
    "hip_height",
    "intended",
    "limb_phase",
    "limb_targets",
    "limbs_back",
    "longest_stroke",
    "longest_strokes",
    "middle_stance",
    "pattern_targets",
    "plan",
    "roll_targets",
    "servo_targets",
    "shortest_period",
    "stance",
    "stand_up",
    "steerable",
    "steered",
    "straightened",
    "stretched",
    "strides",
    "swim_targets",
    "tail_bend",
    "tallest",
    "trunk_amplitude",
    "trunk_bend",
    "with_axis_lag",
    "with_bends",
    "with_strokes",
    "within_reach",
]
