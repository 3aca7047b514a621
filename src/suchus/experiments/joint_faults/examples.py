"""Measures for which each rule of ``joint_faults`` says each of its words, close to both sides of every bound."""

from itertools import product

from suchus.verdict.judging import Examples

_READINGS = list(product(("limp", "locked"), ("one", "both")))


def _loss(joint: str, arm: str, value: float, low: float | None = None, high: float | None = None) -> dict[str, float]:
    """Return the measures of one loss: the judged one with its repeats, and those that are only said."""
    judged = f"loss_{joint}_limp_one_{arm}"
    said = {f"loss_{joint}_{kind}_{legs}_{arm}": -0.5 for kind, legs in _READINGS}
    said |= {"loss_intact_limbs_only": -0.77, "loss_intact_limbs_tail_lifted": -0.78}
    return said | {
        f"loss_{joint}_limp_one_limbs_tail_lifted": -0.8,
        f"{judged}_low": value - 0.1,
        f"{judged}_high": value + 0.1,
        judged: value,
        f"{judged}_repeated_low": value if low is None else low,
        f"{judged}_repeated_high": value if high is None else high,
    }


_SUPPORT = {
    "support_share_limp": 0.9,
    "support_share_intact": 0.8,
    "tail_load_limp": 5.0,
    "com_rise_limp": 0.001,
    "foot_free_limp": 0.6,
    "foot_free_intact": 0.6,
    "foot_lift_limp": 0.02,
    "foot_lift_intact": 0.02,
}
_TOLERANCE = {
    "share_spine_and_tail_bear_better": 0.51,
    "chance_spine_and_tail_bear_better": 0.0039,
    "share_variations_bear_better": 1.0,
    "share_spine_and_tail_ahead": 0.9,
    "share_bear_better_front_yaw": 0.6,
    "share_bear_better_hind_yaw": 0.6,
    "share_bear_better_front_pitch": 0.1,
    "share_bear_better_hind_pitch": 0.8,
}

EXAMPLES: Examples = {
    "fault_front_yaw_limbs_only": [
        (_loss("front_yaw", "limbs_only", -0.80), "reproduced"),
        (_loss("front_yaw", "limbs_only", -0.70, low=-0.796), "reproduced"),
        (_loss("front_yaw", "limbs_only", -0.70, low=-0.794), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.90, high=-0.804), "reproduced"),
        (_loss("front_yaw", "limbs_only", -0.90, high=-0.806), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.505), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.495), "contradicted"),
    ],
    "fault_front_yaw_coordinated": [
        (_loss("front_yaw", "coordinated", -0.22), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.10, low=-0.216), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.10, low=-0.214), "same sense"),
        (_loss("front_yaw", "coordinated", -0.30, high=-0.224), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.30, high=-0.226), "same sense"),
        (_loss("front_yaw", "coordinated", -0.330), "same sense"),
        (_loss("front_yaw", "coordinated", -0.337), "contradicted"),
    ],
    "fault_hind_yaw_limbs_only": [
        (_loss("hind_yaw", "limbs_only", -0.75), "reproduced"),
        (_loss("hind_yaw", "limbs_only", -0.70, low=-0.746), "reproduced"),
        (_loss("hind_yaw", "limbs_only", -0.70, low=-0.744), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.90, high=-0.754), "reproduced"),
        (_loss("hind_yaw", "limbs_only", -0.90, high=-0.756), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.505), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.495), "contradicted"),
    ],
    "fault_hind_yaw_coordinated": [
        (_loss("hind_yaw", "coordinated", -0.17), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.10, low=-0.166), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.10, low=-0.164), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.30, high=-0.174), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.30, high=-0.176), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.330), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.337), "contradicted"),
    ],
    **{
        f"fault_front_pitch_{arm}": [
            (_loss("front_pitch", arm, -1.0), "reproduced"),
            (_loss("front_pitch", arm, -0.95, low=-0.996), "reproduced"),
            (_loss("front_pitch", arm, -0.95, low=-0.994), "same sense"),
            (_loss("front_pitch", arm, -1.08, high=-1.004), "reproduced"),
            (_loss("front_pitch", arm, -1.08, high=-1.006), "same sense"),
            (_loss("front_pitch", arm, -0.91), "same sense"),
            (_loss("front_pitch", arm, -0.89), "contradicted"),
        ]
        for arm in ("limbs_only", "coordinated")
    },
    "fault_hind_pitch_limbs_only": [
        (_loss("hind_pitch", "limbs_only", -0.55), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.45, low=-0.546), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.45, low=-0.544), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.65, high=-0.554), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.65, high=-0.556), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.405), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.395), "contradicted"),
        (_loss("hind_pitch", "limbs_only", -0.695), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.705), "contradicted"),
        (_loss("hind_pitch", "limbs_only", float("nan")), "not testable"),
    ],
    "fault_hind_pitch_coordinated": [
        (_loss("hind_pitch", "coordinated", 0.0), "reproduced"),
        (_loss("hind_pitch", "coordinated", -0.05, high=-0.004), "reproduced"),
        (_loss("hind_pitch", "coordinated", -0.05, high=-0.006), "same sense"),
        (_loss("hind_pitch", "coordinated", 0.05, low=0.004), "reproduced"),
        (_loss("hind_pitch", "coordinated", 0.05, low=0.006), "same sense"),
        (_loss("hind_pitch", "coordinated", -0.099), "same sense"),
        (_loss("hind_pitch", "coordinated", -0.101), "contradicted"),
    ],
    "fault_support": [
        (_SUPPORT, "reproduced"),
        (_SUPPORT | {"support_share_limp": 0.505}, "reproduced"),
        (_SUPPORT | {"support_share_limp": 0.495}, "contradicted"),
        (_SUPPORT | {"com_rise_limp": -0.001}, "contradicted"),
        (_SUPPORT | {"foot_free_limp": 0.505}, "reproduced"),
        (_SUPPORT | {"foot_free_limp": 0.495}, "contradicted"),
    ],
    "fault_tolerance": [
        (_TOLERANCE, "reproduced"),
        (_TOLERANCE | {"share_spine_and_tail_bear_better": 0.49}, "contradicted"),
        (_TOLERANCE | {"chance_spine_and_tail_bear_better": 0.0495}, "reproduced"),
        (_TOLERANCE | {"chance_spine_and_tail_bear_better": 0.0505}, "contradicted"),
        (
            _TOLERANCE | {"share_variations_bear_better": 0.75, "chance_spine_and_tail_bear_better": 0.14},
            "contradicted",
        ),
    ],
}
