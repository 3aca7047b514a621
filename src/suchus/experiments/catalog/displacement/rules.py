"""When the claims on the displacement count as what (section IV.B, Fig. 16)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    PRINTED_DISPLACEMENT,
    Clause,
    ControlGroup,
    Rule,
    measure_with_interval,
)

_FREE_PARAMETERS_REASON = (
    "Leg stroke and trunk bend are free in the article and were chosen so that its two displacements come out; "
    "the tail's pitch is free too and moves this one from {forward_over_tail_pitch_low:.2f} to "
    "{forward_over_tail_pitch_high:.2f} m over its plausible range."
)
_FORWARD_REASON = "forward is forward"
_GAIN_REASON = "a gain is more than none"
_GAIT_MEASURES = ("hind_duty_limbs_only", "two_feet_share_limbs_only")
_LIMBS_ONLY_GROUP = ControlGroup(
    group="limbs_only",
    why="Fig. 16: spine and tail are not engaged. It does not say where the tail is; ours lies still, and what is so "
    "with the tail in the air, as in section IV.A, is told beside.",
    needs=(
        Clause(_GAIT_MEASURES[0], "<=", 0.85, "feet that hardly leave the ground walk in no gait"),
        Clause(_GAIT_MEASURES[0], ">=", 0.3, "feet that hardly touch the ground take no steps"),
        Clause(_GAIT_MEASURES[1], ">=", 0.3, "a diagonal gait stands on two feet for part of its cycle"),
    ),
)
_STRAIGHT_TRUNK_GROUP = ControlGroup(group="tail_drag", why="What bends adds: the same crawl with a straight trunk.")

RULES = (
    Rule(
        claim="displacement_coordinated",
        experiment="displacement",
        measure="forward_coordinated",
        definition="displacement forward in two cycles with spine and tail",
        unit="m",
        kind="fitted",
        holds=(Clause("forward_coordinated", ">", 0.0, _FORWARD_REASON, PRINTED_DISPLACEMENT),),
        spread=("forward_coordinated",),
        of=DEFAULT_SPREAD_OF,
        why=_FREE_PARAMETERS_REASON,
    ),
    Rule(
        claim="displacement_limbs_only",
        experiment="displacement",
        measure="forward_limbs_only",
        definition="displacement forward in two cycles with limbs only",
        unit="m",
        kind="fitted",
        holds=(Clause("forward_limbs_only", ">", 0.0, _FORWARD_REASON, PRINTED_DISPLACEMENT),),
        control=_LIMBS_ONLY_GROUP,
        spread=("forward_limbs_only", *_GAIT_MEASURES),
        of=DEFAULT_SPREAD_OF,
        why="The same legs with the trunk straight and the tail lying still; hind feet stand "
        "{hind_duty_limbs_only:.0%} of the time ({hind_duty_limbs_only_low:.0%} to {hind_duty_limbs_only_high:.0%}), "
        "two feet for {two_feet_share_limbs_only:.0%} of it ({two_feet_share_limbs_only_low:.0%} to "
        "{two_feet_share_limbs_only_high:.0%}); they are lifted by {hind_clearance_limbs_only:mm.0f} mm. With the tail "
        "in the air it is {forward_limbs_tail_lifted:.2f} m, and the hind feet stand "
        "{hind_duty_limbs_tail_lifted:.0%} of the time.",
    ),
    Rule(
        claim="displacement_ratio",
        experiment="displacement",
        measure="forward_ratio",
        definition="displacement with spine and tail over displacement with limbs only",
        kind="fitted",
        holds=(Clause("forward_ratio", ">", 1.0, "farther with than without"),),
        control=_LIMBS_ONLY_GROUP,
        spread=("forward_ratio", *_GAIT_MEASURES),
        of=DEFAULT_SPREAD_OF,
        why="Both displacements were fitted, and so is their ratio: other strokes and bends give "
        "{ratio_on_map_low:.1f} to {ratio_on_map_high:.1f}. Against the control group with its tail in the air it is "
        "{forward_ratio_tail_lifted:.2f}.",
    ),
    Rule(
        claim="spine_swing",
        experiment="displacement",
        measure="gain_spine_swing",
        definition="displacement less that of the same crawl with a straight trunk",
        unit="m",
        holds=(Clause("gain_spine_swing", ">", 0.0, _GAIN_REASON, PRINTED_DISPLACEMENT),),
        control=_STRAIGHT_TRUNK_GROUP,
        spread=("gain_spine_swing",),
        of=DEFAULT_SPREAD_OF,
        why="Against the same crawl with a straight trunk: the tail drags and swings in both. It changes the "
        "displacement by {gain_spine_swing_low:.2f} to {gain_spine_swing_high:.2f} m.",
    ),
    Rule(
        claim="tail_swing",
        experiment="displacement",
        measure="gain_tail_swing",
        definition="displacement less that of the same crawl whose tail is dragged without a swing",
        unit="m",
        holds=(Clause("gain_tail_swing", ">", 0.0, _GAIN_REASON, PRINTED_DISPLACEMENT),),
        control=ControlGroup(
            group="tail_still", why="What swings adds: the same crawl whose tail is dragged without a swing."
        ),
        spread=("gain_tail_swing",),
        of=DEFAULT_SPREAD_OF,
        why="Against the same crawl whose tail drags without a swing the swing changes the displacement by "
        "{gain_tail_swing:mm+.0f} mm, {gain_tail_swing_low:mm+.0f} to {gain_tail_swing_high:mm+.0f} mm; "
        "lying on the ground instead of in the air changes it by {gain_tail_contact:mm+.0f} mm.",
    ),
    Rule(
        claim="bending_lengthens_stride",
        experiment="displacement",
        measure="gain_spine_swing",
        definition="displacement less that of the same crawl with a straight trunk",
        unit="m",
        kind="animals",
        holds=(Clause("gain_spine_swing", ">", 0.0, _GAIN_REASON, PRINTED_DISPLACEMENT),),
        control=_STRAIGHT_TRUNK_GROUP,
        spread=("gain_spine_swing",),
        of=DEFAULT_SPREAD_OF,
        why="Said of crocodiles. The robot does the same: at equal strokes of the legs its bending trunk changes the "
        "displacement by {gain_spine_swing:+.2f} m.",
    ),
)

_COORDINATED = {
    "forward_coordinated": 0.729,
    "forward_coordinated_low": 0.722,
    "forward_coordinated_high": 0.754,
    "forward_over_tail_pitch_low": 0.6,
    "forward_over_tail_pitch_high": 0.7,
}
_LIMBS = {
    "forward_limbs_only": 0.164,
    "forward_limbs_only_low": 0.160,
    "forward_limbs_only_high": 0.185,
    **measure_with_interval("hind_duty_limbs_only", 0.80, 0.84),
    **measure_with_interval("two_feet_share_limbs_only", 0.31, 0.41),
    "hind_clearance_limbs_only": 0.007,
    "forward_limbs_tail_lifted": 0.158,
    "hind_duty_limbs_tail_lifted": 1.0,
}
_RATIO = {
    **measure_with_interval("hind_duty_limbs_only", 0.80, 0.84),
    **measure_with_interval("two_feet_share_limbs_only", 0.31, 0.41),
    "forward_ratio": 4.39,
    "forward_ratio_low": 4.0,
    "forward_ratio_high": 4.5,
    "ratio_on_map_low": 1.0,
    "ratio_on_map_high": 17.0,
    "forward_ratio_tail_lifted": 4.6,
}
_SPINE = {"gain_spine_swing": 0.5, "gain_spine_swing_low": 0.0051, "gain_spine_swing_high": 0.6}
_TAIL = {
    "gain_tail_swing": 0.02,
    "gain_tail_swing_low": 0.0051,
    "gain_tail_swing_high": 0.03,
    "gain_tail_contact": 0.1,
}

EXAMPLES: Examples = {
    "displacement_coordinated": [
        (_COORDINATED, "fitted"),
        (_COORDINATED | {"forward_coordinated": 0.7251}, "fitted"),  # the least that rounds to 0.73 is 0.725
        (_COORDINATED | {"forward_coordinated": 0.7249}, "same sense"),
        (_COORDINATED | {"forward_coordinated": 0.7349}, "fitted"),
        (_COORDINATED | {"forward_coordinated": 0.7351}, "same sense"),
        (_COORDINATED | {"forward_coordinated_low": 0.0051}, "fitted"),
        (_COORDINATED | {"forward_coordinated_low": 0.0049}, "undecided"),
        (_COORDINATED | measure_with_interval("forward_coordinated", -0.1, 0.0049), "contradicted"),
        (_COORDINATED | {"forward_coordinated": float("nan")}, "not testable"),
    ],
    "displacement_limbs_only": [
        (_LIMBS, "fitted"),
        (_LIMBS | {"forward_limbs_only": 0.1551}, "fitted"),
        (_LIMBS | {"forward_limbs_only": 0.1549}, "same sense"),
        (_LIMBS | {"forward_limbs_only": 0.1649}, "fitted"),
        (_LIMBS | {"forward_limbs_only": 0.1651}, "same sense"),
        (_LIMBS | {"forward_limbs_only_low": 0.0051}, "fitted"),
        (_LIMBS | {"forward_limbs_only_low": 0.0049}, "undecided"),
        (_LIMBS | measure_with_interval("forward_limbs_only", -0.1, 0.0049), "contradicted"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.8, 0.849), "fitted"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.8, 0.851), "undecided"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.851, 0.9), "not testable"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.301, 0.84), "fitted"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.299, 0.84), "undecided"),
        (_LIMBS | measure_with_interval("hind_duty_limbs_only", 0.1, 0.299), "not testable"),
        (_LIMBS | measure_with_interval("two_feet_share_limbs_only", 0.301, 0.4), "fitted"),
        (_LIMBS | measure_with_interval("two_feet_share_limbs_only", 0.299, 0.4), "undecided"),
        (_LIMBS | measure_with_interval("two_feet_share_limbs_only", 0.2, 0.299), "not testable"),
        (_LIMBS | {"forward_limbs_only_low": 0.0049} | measure_with_interval("hind_duty_limbs_only", 0.851, 0.9),
        "not testable"),
    ],
    "displacement_ratio": [
        (_RATIO, "fitted"),
        (_RATIO | {"forward_ratio": 4.39}, "fitted"),  # rounding reaches down to 4.383
        (_RATIO | {"forward_ratio": 4.38}, "same sense"),
        (_RATIO | {"forward_ratio": 4.73}, "fitted"),
        (_RATIO | {"forward_ratio": 4.75}, "same sense"),
        (_RATIO | {"forward_ratio_low": 1.01}, "fitted"),
        (_RATIO | {"forward_ratio_low": 0.99}, "undecided"),
        (_RATIO | measure_with_interval("forward_ratio", 0.9, 0.99), "contradicted"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.8, 0.849), "fitted"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.8, 0.851), "undecided"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.851, 0.9), "not testable"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.301, 0.84), "fitted"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.299, 0.84), "undecided"),
        (_RATIO | measure_with_interval("hind_duty_limbs_only", 0.1, 0.299), "not testable"),
        (_RATIO | measure_with_interval("two_feet_share_limbs_only", 0.301, 0.4), "fitted"),
        (_RATIO | measure_with_interval("two_feet_share_limbs_only", 0.299, 0.4), "undecided"),
        (_RATIO | measure_with_interval("two_feet_share_limbs_only", 0.2, 0.299), "not testable"),
    ],
    "spine_swing": [
        (_SPINE, "reproduced"),
        (_SPINE | {"gain_spine_swing_low": 0.0049}, "undecided"),
        (_SPINE | measure_with_interval("gain_spine_swing", -0.1, 0.0049), "contradicted"),
    ],
    "tail_swing": [
        (_TAIL, "reproduced"),
        (_TAIL | {"gain_tail_swing_low": 0.0049}, "undecided"),
        (_TAIL | measure_with_interval("gain_tail_swing", -0.1, 0.0049), "contradicted"),
    ],
    "bending_lengthens_stride": [
        (_SPINE, "same sense"),
        (_SPINE | {"gain_spine_swing_low": 0.0049}, "undecided"),
        (_SPINE | measure_with_interval("gain_spine_swing", -0.1, 0.0049), "not testable"),
    ],
}  # fmt: skip
