"""Measures for which each rule of ``displacement`` says each of its words, close to both sides of every bound."""

from suchus.verdict.judging import Examples

_COORDINATED = {
    "forward_coordinated": 0.729,
    "forward_coordinated_low": 0.722,
    "forward_coordinated_high": 0.754,
    "forward_over_tail_pitch_low": 0.6,
    "forward_over_tail_pitch_high": 0.7,
}
_LIMBS = {
    "forward_limbs_only": 0.166,
    "forward_limbs_only_low": 0.160,
    "forward_limbs_only_high": 0.185,
    "hind_duty_limbs_only": 0.82,
    "two_feet_share_limbs_only": 0.36,
    "hind_clearance_limbs_only": 0.007,
    "forward_limbs_tail_lifted": 0.158,
    "hind_duty_limbs_tail_lifted": 1.0,
}
_SHORT = _COORDINATED | {"forward_coordinated": 0.70, "forward_coordinated_low": 0.70}
_LIMBS_SHORT = _LIMBS | {"forward_limbs_only": 0.15, "forward_limbs_only_low": 0.15}
_RATIO = {
    "forward_ratio": 4.39,
    "forward_ratio_low": 4.0,
    "forward_ratio_high": 4.5,
    "ratio_on_map_low": 1.0,
    "ratio_on_map_high": 17.0,
    "forward_ratio_tail_lifted": 4.6,
}
_SPINE = {"gain_spine_swing": 0.5, "gain_spine_swing_low": 0.001, "gain_spine_swing_high": 0.6}
_TAIL = {
    "gain_tail_swing": 0.02,
    "gain_tail_swing_low": 0.001,
    "gain_tail_swing_high": 0.03,
    "gain_tail_contact": 0.1,
}

EXAMPLES: Examples = {
    "displacement_coordinated": [
        (_COORDINATED, "fitted"),
        (_SHORT | {"forward_coordinated_high": 0.726}, "fitted"),  # the least that rounds to 0.73 is 0.725
        (_SHORT | {"forward_coordinated_high": 0.724}, "same sense"),
        (_COORDINATED | {"forward_coordinated": 0.74, "forward_coordinated_low": 0.734}, "fitted"),
        (_COORDINATED | {"forward_coordinated": 0.74, "forward_coordinated_low": 0.736}, "same sense"),
        (_COORDINATED | {"forward_coordinated_low": 0.001}, "fitted"),
        (_COORDINATED | {"forward_coordinated_low": -0.001}, "contradicted"),
        (_COORDINATED | {"forward_coordinated": float("nan")}, "not testable"),
    ],
    "displacement_limbs_only": [
        (_LIMBS, "fitted"),
        (_LIMBS | {"forward_limbs_only_low": 0.164}, "fitted"),
        (_LIMBS | {"forward_limbs_only_low": 0.1655}, "same sense"),
        (_LIMBS_SHORT | {"forward_limbs_only_high": 0.154}, "same sense"),
        (_LIMBS_SHORT | {"forward_limbs_only_high": 0.156}, "fitted"),
        (_LIMBS | {"forward_limbs_only_low": 0.001}, "fitted"),
        (_LIMBS | {"forward_limbs_only_low": -0.001}, "contradicted"),
        (_LIMBS | {"hind_duty_limbs_only": 0.849}, "fitted"),
        (_LIMBS | {"hind_duty_limbs_only": 0.851}, "contradicted"),
        (_LIMBS | {"two_feet_share_limbs_only": 0.301}, "fitted"),
        (_LIMBS | {"two_feet_share_limbs_only": 0.299}, "contradicted"),
    ],
    "displacement_ratio": [
        (_RATIO, "fitted"),
        (_RATIO | {"forward_ratio": 4.2, "forward_ratio_high": 4.39}, "fitted"),  # rounding reaches down to 4.383
        (_RATIO | {"forward_ratio": 4.2, "forward_ratio_high": 4.37}, "same sense"),
        (_RATIO | {"forward_ratio": 4.9, "forward_ratio_low": 4.73}, "fitted"),
        (_RATIO | {"forward_ratio": 4.9, "forward_ratio_low": 4.75}, "same sense"),
        (_RATIO | {"forward_ratio_low": 1.01}, "fitted"),
        (_RATIO | {"forward_ratio_low": 0.99}, "contradicted"),
    ],
    "spine_swing": [
        (_SPINE, "reproduced"),
        (_SPINE | {"gain_spine_swing_low": -0.001}, "contradicted"),
    ],
    "tail_swing": [
        (_TAIL, "reproduced"),
        (_TAIL | {"gain_tail_swing_low": -0.001}, "contradicted"),
    ],
    "bending_lengthens_stride": [
        (_SPINE, "same sense"),
        (_SPINE | {"gain_spine_swing_low": -0.001}, "not testable"),
    ],
}  # fmt: skip
