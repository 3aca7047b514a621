"""Measures for which each rule of ``crawl_stability`` says each of its words, close to both sides of every bound."""

from math import radians

from suchus.verdict.judging import Examples

_HEIGHT = {
    "com_height_pp_change": -0.1,
    "com_height_pp_change_low": -0.2,
    "com_height_pp_change_high": -0.001,
    "com_height_pp_coordinated": 0.0038,
    "com_height_pp_limbs_only": 0.0042,
    "com_height_pp_limbs_tail_lifted": 0.004,
    "com_height_pp_change_tail_lifted": -0.05,
    "com_height_std_change": -0.1,
    "roll_pp_change": 0.1,
}
_TILT = {
    "lean_on_two_feet_limbs_only_1200_ms": radians(1.01),
    "lean_limbs_only_1200_ms": radians(1.01),
    "lean_coordinated_1200_ms": radians(1.0),
    "lean_limbs_tail_lifted_1200_ms": 0.1,
    "line_distance_limbs_only_1200_ms": 0.0241,
    "standing_feet_limbs_only_1200_ms": 2,
    "standing_feet_limbs_tail_lifted_1200_ms": 4,
}
_TAIL = {
    "tail_contact_pp_change": -0.1,
    "tail_contact_pp_change_low": -0.2,
    "tail_contact_pp_change_high": -0.001,
    "tail_contact_pp_change_limbs_only": -0.4,
    "tail_load_share": 0.0505,
}
_WAG = {"wagging_pp_change": -0.1, "wagging_pp_change_low": -0.2, "wagging_pp_change_high": -0.001}

EXAMPLES: Examples = {
    "com_fluctuation": [
        (_HEIGHT, "reproduced"),
        (_HEIGHT | {"com_height_pp_change_high": 0.001}, "contradicted"),
    ],
    "com_on_support_line": [
        ({"line_distance_max_limbs_only": 0.0239}, "reproduced"),
        ({"line_distance_max_limbs_only": 0.0241}, "contradicted"),
        ({"line_distance_max_limbs_only": float("nan")}, "not testable"),  # two feet never stand alone
    ],
    "tilt_limbs_only": [
        (_TILT, "reproduced"),
        (_TILT | {"lean_on_two_feet_limbs_only_1200_ms": float("nan")}, "not testable"),
        (_TILT | {"lean_limbs_only_1200_ms": radians(0.99), "lean_coordinated_1200_ms": 0.0}, "contradicted"),
        (_TILT | {"lean_coordinated_1200_ms": radians(1.02)}, "contradicted"),
        (_TILT | {"line_distance_limbs_only_1200_ms": 0.0239}, "contradicted"),
    ],
    "tail_supports": [
        (_TAIL, "reproduced"),
        (_TAIL | {"tail_load_share": 0.0495}, "contradicted"),
        (_TAIL | {"tail_contact_pp_change_high": 0.001}, "contradicted"),
    ],
    "wagging_balances": [
        (_WAG, "reproduced"),
        (_WAG | {"wagging_pp_change_high": 0.001}, "contradicted"),
    ],
    "spine_sinusoidal": [
        ({"spine_sine_r2": 0.951}, "by construction"),
        ({"spine_sine_r2": 0.949}, "contradicted"),
    ],
}
