"""Measures for which each rule of ``tail_bending`` says each of its words, close to both sides of every bound."""

from math import radians

from suchus.verdict.judging import Examples

_SMALL = {"error_of_eq_17_max": 0.0411, "error_of_eq_17_plausible": 0.063}
_CORDS = {"cords_opposed_share": 1.0, "slack_max": 0.006}
_POSITIONS = {
    "printed_last_joint_error_share": 0.99e-9,
    "printed_last_joint_error_straight": 0.0,
    "printed_last_joint_error_max": 2e-10,
}
_ALIKE = {
    "tail_joint_spread": radians(9.9),
    "tail_joint_spread_share": 0.0,
    "tail_joint_spread_straight": radians(34),
    "tail_joint_spread_share_straight": 0.61,
}

EXAMPLES: Examples = {
    "tail_quadratic_small": [
        (_SMALL, "reproduced"),
        (_SMALL | {"error_of_eq_17_max": 0.0495}, "reproduced"),
        (_SMALL | {"error_of_eq_17_max": 0.0505}, "contradicted"),
    ],
    "tail_cords_inextensible": [
        (_CORDS, "reproduced"),
        (_CORDS | {"cords_opposed_share": 0.99}, "contradicted"),
    ],
    "tail_joint_positions": [
        (_POSITIONS, "reproduced"),
        (_POSITIONS | {"printed_last_joint_error_share": 1.01e-9}, "contradicted"),
        (_POSITIONS | {"printed_last_joint_error_share": 1.72}, "contradicted"),
    ],
    "tail_equal_bends": [
        (_ALIKE, "reproduced"),
        (_ALIKE | {"tail_joint_spread": radians(10.1)}, "contradicted"),
        (_ALIKE | {"tail_joint_spread": radians(25), "tail_joint_spread_share": 0.31}, "contradicted"),
        (_ALIKE | {"tail_joint_spread": float("nan")}, "not testable"),
    ],
    "tail_joints": [
        ({"tail_joints": 6.0}, "by construction"),
        ({"tail_joints": 5.0}, "contradicted"),
    ],
    "tail_actuators": [
        ({"tail_actuators": 2.0}, "by construction"),
        ({"tail_actuators": 1.0}, "contradicted"),
    ],
    "tail_share": [
        ({"tail_share": 0.5}, "by construction"),
        ({"tail_share": 0.451}, "by construction"),
        ({"tail_share": 0.449}, "contradicted"),
        ({"tail_share": 0.549}, "by construction"),
        ({"tail_share": 0.551}, "contradicted"),
    ],
}
