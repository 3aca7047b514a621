"""When the claims on failed joints count as what (section IV.C, Figs 18 to 21)."""

from itertools import product

from suchus.article.paper import CLAIMS
from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    Clause,
    ControlGroup,
    Interpretation,
    Rule,
    SmallestEffect,
    Variation,
    measure_with_interval,
)

_VISIBLE_RISE = SmallestEffect(
    size=0.001, why="1 mm is a pixel of a picture of the whole robot, 1 m in a thousand pixels"
)
_PRINTED_LOSS = SmallestEffect(size=0.01, why="the article prints losses in whole per cents")
_SMALL_LOSS = Clause("", ">=", -1 / 3, "'only' is a loss of less than a third")
_LARGE_LOSS = Clause("", "<=", -1 / 2, "a loss of most is one of more than half")
_TOTAL_LOSS = Clause("", "<=", -0.9, "less than a tenth is left of a motion that has ended")
_HALF_LOSS = (
    Clause("", "<=", -0.4, "about half is 40 % at least"),
    Clause("", ">=", -0.7, "about half is 70 % at most"),
)
_INTACT_GROUP = ControlGroup(
    group="coordinated", why="Section IV.C counts from the intact robot with spine and tail, of both groups."
)
_NO_LOSS = Clause("", ">=", -0.1, "almost nothing is less than a tenth")
_ARTICLE_CLAUSES: dict[tuple[str, str], tuple[Clause, ...]] = {
    ("front_yaw", "limbs_only"): (_LARGE_LOSS,),
    ("front_yaw", "coordinated"): (_SMALL_LOSS,),
    ("hind_yaw", "limbs_only"): (_LARGE_LOSS,),
    ("hind_yaw", "coordinated"): (_SMALL_LOSS,),
    ("front_pitch", "limbs_only"): (_TOTAL_LOSS,),
    ("front_pitch", "coordinated"): (_TOTAL_LOSS,),
    ("hind_pitch", "limbs_only"): _HALF_LOSS,
    ("hind_pitch", "coordinated"): (_NO_LOSS,),
}
"""For each joint and arm the bounds within which the article's sentence is true."""


_FITTED_CLAIMS = ("fault_front_yaw_limbs_only", "fault_hind_yaw_limbs_only")
"""Claims whose number follows from the fit of the two displacements: the intact robot makes most of the change."""
_TOLERATED_JOINTS = ("front_yaw", "hind_yaw", "hind_pitch")
"""Joints for which the article says that the loss is smaller with spine and tail; a front pitch joint stops both."""
_LIMP = "limp"
_LOCKED = Interpretation(name="locked", measures=("_limp", "_locked"))
"""The article's joint 'cannot receive and execute commands': limp, as a servo without pulses, or held where it is."""


def _fault_rule(joint: str, group: str, clauses: tuple[Clause, ...]) -> Rule:
    """Return the rule for the article's sentence on one joint and one group.

    Args:
        joint: joint that fails, as ``front_yaw``.
        group: ``coordinated`` or ``limbs_only``.
        clauses: bounds, within which the sentence is true, of the relative change of displacement [-]; a loss is
            negative.
    """
    condition = f"{joint}_limp_one"
    measure_name = f"loss_{condition}_{group}"
    all_variants = "; ".join(
        f"{failure}, {affected_side} {{loss_{joint}_{failure}_{affected_side}_{group}:+.0%}}"
        for failure in ("limp", "locked")
        for affected_side in ("one", "both")
    )
    explanation = (
        f"Of a limp joint of one leg: {{{measure_name}_low:+.0%}} to {{{measure_name}_high:+.0%}}. "
        f"All variants: {all_variants}."
    )
    return Rule(
        claim=f"fault_{joint}_{group}",
        experiment="joint_faults",
        measure=measure_name,
        definition="relative change of displacement from the intact robot with spine and tail, with one joint limp",
        kind="fitted" if f"fault_{joint}_{group}" in _FITTED_CLAIMS else "measured",
        holds=tuple(Clause(measure_name, clause.relation, clause.bound, clause.why) for clause in clauses),
        control=_INTACT_GROUP,
        spread=(measure_name,),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why=(_limbs_only_explanation(joint) if group == "limbs_only" else "") + explanation,
    )


def _limbs_only_explanation(joint: str) -> str:
    """Return the explanation of a loss with limbs only.

    It compares the loss with the group's own intact displacement, with the intact robot, and with the tail lifted.
    """
    text = (
        f"Of its own intact displacement the robot with limbs only loses {{own_loss_{joint}_limp_one_limbs_only:+.0%}};"
        " against the one with spine and tail, as the article counts, it is at {loss_intact_limbs_only:+.0%} when "
        f"intact. With its tail in the air it is at {{loss_intact_limbs_tail_lifted:+.0%}} intact and at "
        f"{{loss_{joint}_limp_one_limbs_tail_lifted:+.0%}} with the joint failed. "
    )
    printed_loss = CLAIMS[f"fault_{joint}_limbs_only"].value or 0.0
    coordinated_distance, limbs_only_distance = (
        CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in ("coordinated", "limbs_only")
    )
    remaining_distance = coordinated_distance * (1.0 + printed_loss)
    if remaining_distance <= limbs_only_distance:
        return text
    return (
        f"{text}The article's {printed_loss:+.0%} leave {remaining_distance:.2f} m of {coordinated_distance:g} m, more "
        f"than the {limbs_only_distance:g} m of its own intact robot. "
    )


def _tolerance_explanation() -> str:
    """Return the explanation: what each group loses against its own intact robot, joint by joint, as fractions."""
    rows = "; ".join(
        f"{joint.replace('_', ' ')} {{loss_{joint}_limp_one_coordinated:+.0%}} and "
        f"{{own_loss_{joint}_limp_one_limbs_only:+.0%}}, a gain of {{gain_{joint}_limp_one_low:+.0%}} to "
        f"{{gain_{joint}_limp_one_high:+.0%}}"
        for joint in _TOLERATED_JOINTS
    )
    return f"Of its own intact displacement the robot loses with spine and tail, and with limbs only: {rows}."


RULES = (
    *(_fault_rule(joint, arm, clauses) for (joint, arm), clauses in _ARTICLE_CLAUSES.items()),
    Rule(
        claim="fault_support",
        experiment="joint_faults",
        measure="support_share_limp",
        definition="part of the load on tail, right front and left hind foot while the damaged leg is meant to swing",
        holds=(
            Clause("support_share_limp", ">", 0.5, "to carry the body is to carry most of its weight"),
            Clause("com_rise_limp", ">", 0.0, "raised is higher than with the joint intact", _VISIBLE_RISE),
            Clause("foot_free_limp", ">=", 0.5, "a foot that swings is off the ground for most of its swing"),
        ),
        control=ControlGroup(
            group="intact", why="What carries and raises more does so against the same crawl undamaged."
        ),
        why="While the damaged right hind leg is meant to swing, tail, right front and left hind foot carry "
        "{support_share_limp:.0%} of the load with its pitch joint limp, {support_share_intact:.0%} intact; the tail's "
        "own part is {tail_load_limp:.1f} N. Against intact the height of the centre of mass is "
        "{com_rise_limp:mm+.1f} mm. The foot is off the ground for {foot_free_limp:.0%} of its swing (intact "
        "{foot_free_intact:.0%}) and rises by {foot_lift_limp:mm.0f} mm (intact {foot_lift_intact:mm.0f} mm).",
        spread=("support_share_limp", "com_rise_limp", "foot_free_limp"),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
    ),
    Rule(
        claim="fault_tolerance",
        experiment="joint_faults",
        measure="gain_front_yaw_limp_one",
        definition="loss of the own displacement by a limp front yaw joint, with limbs only less with spine and tail",
        holds=tuple(
            Clause(
                f"gain_{joint}_limp_one", ">", 0.0, f"{joint.replace('_', ' ')}: less of its own is lost", _PRINTED_LOSS
            )
            for joint in _TOLERATED_JOINTS
        ),
        control=ControlGroup(
            group="limbs_only",
            why="Section IV.C: without trunk cooperative motion. It does not say where the tail is; ours lies still.",
        ),
        spread=tuple(f"gain_{joint}_limp_one" for joint in _TOLERATED_JOINTS),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why=_tolerance_explanation(),
    ),
)

VARIED = Variation(claims=("fault_support",), designs=("robot", "gait"), settings={"holds": (0.5,)}, samples=16)

_READINGS = list(product(("limp", "locked"), ("one", "both")))


def _in_both_readings(measures: dict[str, float]) -> dict[str, float]:
    """Return example measures of a limp joint, and the same of a locked one."""
    return measures | {_LOCKED.measure(name): value for name, value in measures.items()}


def _loss(
    joint: str,
    arm: str,
    value: float,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    locked: float | None = None,
) -> dict[str, float]:
    """Return example measures of one loss: the judged one with its interval, and those that the explanation names.

    Args:
        joint: joint that fails, as ``front_yaw``.
        arm: ``coordinated`` or ``limbs_only``.
        value: judged loss [-].
        lower_bound: lower end of its interval [-]; the loss itself by default.
        upper_bound: upper end of its interval [-]; the loss itself by default.
        locked: loss with the joint locked, without an interval [-]; as if it were limp by default.
    """
    measure_name = f"loss_{joint}_limp_one_{arm}"
    judged_measures = {
        measure_name: value,
        f"{measure_name}_low": value if lower_bound is None else lower_bound,
        f"{measure_name}_high": value if upper_bound is None else upper_bound,
    }
    locked_name = _LOCKED.measure(measure_name)
    locked_measures = {} if locked is None else measure_with_interval(locked_name, locked, locked)
    measures = {f"loss_{joint}_{kind}_{legs}_{arm}": -0.5 for kind, legs in _READINGS}
    measures |= {"loss_intact_limbs_only": -0.77, "loss_intact_limbs_tail_lifted": -0.78}
    measures |= {f"own_loss_{joint}_limp_one_limbs_only": -0.2, f"loss_{joint}_limp_one_limbs_tail_lifted": -0.8}
    return measures | _in_both_readings(judged_measures) | locked_measures


def _gain_measures(**gains: float) -> dict[str, float]:
    """Return example measures of the gain [-], with an interval of 0.02 to both sides; 0.1 by default."""
    measures: dict[str, float] = {}
    for joint in _TOLERATED_JOINTS:
        gain = gains.get(joint, 0.1)
        measures |= measure_with_interval(f"gain_{joint}_limp_one", gain - 0.02, gain + 0.02)
        measures |= {f"loss_{joint}_limp_one_coordinated": -0.2, f"own_loss_{joint}_limp_one_limbs_only": -0.2 - gain}
    return _in_both_readings(measures)


def _support_measures(load_fraction: float = 0.9, rise: float = 0.00151, free: float = 0.6) -> dict[str, float]:
    """Return example measures of the support, with narrow intervals.

    Args:
        load_fraction: fraction of the load on tail, right front and left hind foot [-].
        rise: rise of the centre of mass against the intact robot [m].
        free: fraction of the swing in which the foot is unloaded [-].
    """
    judged_measures = {"support_share_limp": load_fraction, "com_rise_limp": rise, "foot_free_limp": free}
    reported_measures = {
        "support_share_intact": 0.8,
        "tail_load_limp": 5.0,
        "foot_free_intact": 0.6,
        "foot_lift_limp": 0.02,
    }
    ends = [measure_with_interval(name, value - 5e-4, value + 5e-4) for name, value in judged_measures.items()]
    return reported_measures | {"foot_lift_intact": 0.02} | _in_both_readings(ends[0] | ends[1] | ends[2])


EXAMPLES: Examples = {
    "fault_front_yaw_limbs_only": [
        (_loss("front_yaw", "limbs_only", -0.80), "fitted"),
        (_loss("front_yaw", "limbs_only", -0.7, lower_bound=-0.9, upper_bound=-0.6), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.6, lower_bound=-0.7, upper_bound=-0.49), "undecided"),
        (_loss("front_yaw", "limbs_only", -0.796), "fitted"),
        (_loss("front_yaw", "limbs_only", -0.794), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.804), "fitted"),
        (_loss("front_yaw", "limbs_only", -0.806), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.505), "same sense"),
        (_loss("front_yaw", "limbs_only", -0.495), "contradicted"),
        (_loss("front_yaw", "limbs_only", -0.80, locked=-0.495), "depends on the reading"),
    ],
    "fault_front_yaw_coordinated": [
        (_loss("front_yaw", "coordinated", -0.22), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.1, lower_bound=-0.3, upper_bound=-0.05), "same sense"),
        (_loss("front_yaw", "coordinated", -0.3, lower_bound=-0.35, upper_bound=-0.2), "undecided"),
        (_loss("front_yaw", "coordinated", -0.216), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.214), "same sense"),
        (_loss("front_yaw", "coordinated", -0.224), "reproduced"),
        (_loss("front_yaw", "coordinated", -0.226), "same sense"),
        (_loss("front_yaw", "coordinated", -0.330), "same sense"),
        (_loss("front_yaw", "coordinated", -0.337), "contradicted"),
        (_loss("front_yaw", "coordinated", -0.22, locked=-0.4), "depends on the reading"),
    ],
    "fault_hind_yaw_limbs_only": [
        (_loss("hind_yaw", "limbs_only", -0.75), "fitted"),
        (_loss("hind_yaw", "limbs_only", -0.7, lower_bound=-0.9, upper_bound=-0.6), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.6, lower_bound=-0.7, upper_bound=-0.49), "undecided"),
        (_loss("hind_yaw", "limbs_only", -0.746), "fitted"),
        (_loss("hind_yaw", "limbs_only", -0.744), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.754), "fitted"),
        (_loss("hind_yaw", "limbs_only", -0.756), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.505), "same sense"),
        (_loss("hind_yaw", "limbs_only", -0.495), "contradicted"),
        (_loss("hind_yaw", "limbs_only", -0.75, locked=-0.3), "depends on the reading"),
    ],
    "fault_hind_yaw_coordinated": [
        (_loss("hind_yaw", "coordinated", -0.17), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.1, lower_bound=-0.3, upper_bound=-0.05), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.3, lower_bound=-0.35, upper_bound=-0.2), "undecided"),
        (_loss("hind_yaw", "coordinated", -0.166), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.164), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.174), "reproduced"),
        (_loss("hind_yaw", "coordinated", -0.176), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.330), "same sense"),
        (_loss("hind_yaw", "coordinated", -0.337), "contradicted"),
        (_loss("hind_yaw", "coordinated", -0.17, locked=-0.4), "depends on the reading"),
    ],
    **{
        f"fault_front_pitch_{arm}": [
            (_loss("front_pitch", arm, -1.0), "reproduced"),
            (_loss("front_pitch", arm, -0.95, lower_bound=-1.1, upper_bound=-0.92), "same sense"),
            (_loss("front_pitch", arm, -0.95, lower_bound=-1.1, upper_bound=-0.89), "undecided"),
            (_loss("front_pitch", arm, -0.996), "reproduced"),
            (_loss("front_pitch", arm, -0.994), "same sense"),
            (_loss("front_pitch", arm, -1.004), "reproduced"),
            (_loss("front_pitch", arm, -1.006), "same sense"),
            (_loss("front_pitch", arm, -0.91), "same sense"),
            (_loss("front_pitch", arm, -0.89), "contradicted"),
            (_loss("front_pitch", arm, -1.0, locked=-0.5), "depends on the reading"),
        ]
        for arm in ("limbs_only", "coordinated")
    },
    "fault_hind_pitch_limbs_only": [
        (_loss("hind_pitch", "limbs_only", -0.55), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.5, lower_bound=-0.6, upper_bound=-0.45), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.5, lower_bound=-0.6, upper_bound=-0.39), "undecided"),
        (_loss("hind_pitch", "limbs_only", -0.546), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.544), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.554), "reproduced"),
        (_loss("hind_pitch", "limbs_only", -0.556), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.405), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.395), "contradicted"),
        (_loss("hind_pitch", "limbs_only", -0.695), "same sense"),
        (_loss("hind_pitch", "limbs_only", -0.705), "contradicted"),
        (_loss("hind_pitch", "limbs_only", -0.55, locked=-0.8), "depends on the reading"),
        (_loss("hind_pitch", "limbs_only", float("nan")), "not testable"),
    ],
    "fault_hind_pitch_coordinated": [
        (_loss("hind_pitch", "coordinated", 0.0), "reproduced"),
        (_loss("hind_pitch", "coordinated", -0.05, lower_bound=-0.06, upper_bound=0.06), "same sense"),
        (_loss("hind_pitch", "coordinated", -0.05, lower_bound=-0.11, upper_bound=0.0), "undecided"),
        (_loss("hind_pitch", "coordinated", -0.004), "reproduced"),
        (_loss("hind_pitch", "coordinated", -0.006), "same sense"),
        (_loss("hind_pitch", "coordinated", 0.004), "reproduced"),
        (_loss("hind_pitch", "coordinated", 0.006), "same sense"),
        (_loss("hind_pitch", "coordinated", -0.099), "same sense"),
        (_loss("hind_pitch", "coordinated", -0.101), "contradicted"),
        (_loss("hind_pitch", "coordinated", -0.40, locked=-0.02), "depends on the reading"),
        (_loss("hind_pitch", "coordinated", -0.40, locked=-0.11), "contradicted"),
        (_loss("hind_pitch", "coordinated", -0.05, locked=-0.11), "depends on the reading"),
        (_loss("hind_pitch", "coordinated", -0.05, -0.11, 0.0, locked=-0.2), "undecided"),
    ],
    "fault_support": [
        (_support_measures(), "reproduced"),
        (_support_measures(load_fraction=0.505), "reproduced"),
        (_support_measures(load_fraction=0.5), "undecided"),
        (_support_measures(load_fraction=0.495), "contradicted"),
        (_support_measures(rise=0.00149), "undecided"),
        (_support_measures(rise=0.00049), "contradicted"),
        (_support_measures(free=0.505), "reproduced"),
        (_support_measures(free=0.5), "undecided"),
        (_support_measures(free=0.495), "contradicted"),
        (_support_measures() | measure_with_interval("foot_free_locked", 0.3, 0.4), "depends on the reading"),
    ],
    "fault_tolerance": [
        (_gain_measures(), "reproduced"),
        *((_gain_measures(**{joint: 0.0301}), "reproduced") for joint in _TOLERATED_JOINTS),
        *((_gain_measures(**{joint: 0.0299}), "undecided") for joint in _TOLERATED_JOINTS),
        *((_gain_measures(**{joint: -0.0101}), "contradicted") for joint in _TOLERATED_JOINTS),
        (_gain_measures(front_yaw=0.0, hind_pitch=-0.0101), "contradicted"),
        (_gain_measures(front_yaw=float("nan")), "not testable"),
        (
            _gain_measures() | measure_with_interval("gain_hind_yaw_locked_one", -0.1, -0.02),
            "depends on the reading",
        ),
    ],
}
