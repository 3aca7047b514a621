"""Measures for which each rule of ``spine_kinematics`` says each of its words, close to both sides of its bound."""

from suchus.verdict.judging import Examples

_FORWARD = {
    "printed_error_share": 0.99e-9,
    "printed_error_max": 2.9e-10,
    "mended_error_max": 1e-16,
    "straight_length": 0.2925,
    "straight_length_printed": 0.2925,
}

EXAMPLES: Examples = {
    "spine_forward": [
        (_FORWARD, "reproduced"),
        (_FORWARD | {"printed_error_share": 1.01e-9}, "contradicted"),
        (_FORWARD | {"printed_error_share": 0.205, "straight_length_printed": 0.2325}, "contradicted"),
    ],
    "spine_joints": [
        ({"spine_joints": 5.0}, "by construction"),
        ({"spine_joints": 4.0}, "contradicted"),
    ],
    "spine_lateral_joints": [
        ({"spine_lateral_joints": 3.0}, "by construction"),
        ({"spine_lateral_joints": 2.0}, "contradicted"),
    ],
    "spine_pitch_joints": [
        ({"spine_pitch_joints": 2.0}, "by construction"),
        ({"spine_pitch_joints": 3.0}, "contradicted"),
    ],
}
