"""When the hypotheses on knowing a failed joint count as what; they begin where section IV.C ends."""

from suchus.article.paper import Claim
from suchus.article.verdict.judging import Examples, Word
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    PRINTED_DISPLACEMENT,
    Clause,
    ControlGroup,
    Interpretation,
    Rule,
    SmallestEffect,
    measure_with_interval,
)

_PRINTED_LOSS = SmallestEffect(size=0.01, why="the article prints losses in whole per cents")
_LIMP = "limp"
_LOCKED = Interpretation(name="locked", measures=("_limp", "_locked"))
_UNSWEPT = "Each design would need gaits that are searched for it."
_SOURCE, _PLACE = "hypothesis of suchus", "stated before the first run, after section IV.C"


def _claim(key: str, quantity: str, sense: str, unit: str = "m") -> Claim:
    return Claim(key=key, of=_SOURCE, where=_PLACE, quantity=quantity, unit=unit, sense=sense)


CLAIMS = (
    _claim(
        "knowing_coordinated",
        "displacement gained by knowing a failed joint, with spine and tail",
        "With spine and tail, a robot that knows which joint has failed gets farther than one that keeps its gait.",
    ),
    _claim(
        "knowing_limbs_only",
        "displacement gained by knowing a failed joint, with limbs only",
        "With limbs only, a robot that knows which joint has failed gets farther than one that keeps its gait.",
    ),
    _claim(
        "knowing_the_joint",
        "displacement with the gait of the failed joint, less that with the best single gait",
        "With spine and tail, the gait of the failed joint goes farther than the best single gait for all failures.",
    ),
    _claim(
        "knowing_spine_and_tail",
        "displacement gained by knowing a failed joint, with spine and tail less with limbs only",
        "A robot with spine and tail gains more from knowing which joint has failed than one with limbs only.",
    ),
    _claim(
        "tolerance_when_known",
        "fraction of the intact displacement that is left, with spine and tail less with limbs only",
        "A robot that knows which joint has failed bears the loss better with spine and tail than with limbs only.",
        unit="-",
    ),
)

_KEPT_GAIT = ControlGroup(group="kept", why="The robot that does not know of its fault keeps its gait.")
_LIMBS_ONLY = ControlGroup(group="limbs_only", why="Section IV.C compares with the robot whose trunk stays still.")

RULES = (
    Rule(
        claim="knowing_coordinated",
        experiment="fault_knowledge",
        measure="gain_limp_coordinated",
        definition="displacement of the robot that knows its limp joint less that of the one that keeps its gait, "
        "with spine and tail",
        unit="m",
        holds=(Clause("gain_limp_coordinated", ">", 0.0, "farther is farther", PRINTED_DISPLACEMENT),),
        control=_KEPT_GAIT,
        spread=("gain_limp_coordinated",),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why="On average over the joints {forward_limp_coordinated_told:.2f} m against "
        "{forward_limp_coordinated_kept:.2f} m limp, {forward_locked_coordinated_told:.2f} m against "
        "{forward_locked_coordinated_kept:.2f} m locked. The best gait of the intact robot, which needs no knowledge, "
        "gives {forward_limp_coordinated_intact:.2f} m limp.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="knowing_limbs_only",
        experiment="fault_knowledge",
        measure="gain_limp_limbs_only",
        definition="displacement of the robot that knows its limp joint less that of the one that keeps its gait, "
        "with limbs only",
        unit="m",
        holds=(Clause("gain_limp_limbs_only", ">", 0.0, "farther is farther", PRINTED_DISPLACEMENT),),
        control=_KEPT_GAIT,
        spread=("gain_limp_limbs_only",),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why="On average over the joints {forward_limp_limbs_only_told:.2f} m against "
        "{forward_limp_limbs_only_kept:.2f} m limp, {forward_locked_limbs_only_told:.2f} m against "
        "{forward_locked_limbs_only_kept:.2f} m locked. The best gait of the intact robot, which needs no knowledge, "
        "gives {forward_limp_limbs_only_intact:.2f} m limp.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="knowing_the_joint",
        experiment="fault_knowledge",
        measure="joint_gain_limp_coordinated",
        definition="displacement in the gait of the limp joint less that in the best single gait",
        unit="m",
        holds=(Clause("joint_gain_limp_coordinated", ">", 0.0, "farther is farther", PRINTED_DISPLACEMENT),),
        control=ControlGroup(
            group="single",
            why="A robot that cannot tell its joints apart can still walk in the gait that is best for all of them.",
        ),
        spread=("joint_gain_limp_coordinated",),
        of=DEFAULT_SPREAD_OF,
        why="On average over the limp joints the gait of the joint gives {forward_limp_coordinated_told:.2f} m and the "
        "best single gait {forward_limp_coordinated_single:.2f} m.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="knowing_spine_and_tail",
        experiment="fault_knowledge",
        measure="difference_limp",
        definition="gain by knowing the limp joint with spine and tail less that with limbs only",
        unit="m",
        holds=(Clause("difference_limp", ">", 0.0, "more is more", PRINTED_DISPLACEMENT),),
        control=_LIMBS_ONLY,
        spread=("difference_limp",),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why="Knowing brings {gain_limp_coordinated:+.2f} m with spine and tail and {gain_limp_limbs_only:+.2f} m with "
        "limbs only, limp; {gain_locked_coordinated:+.2f} m and {gain_locked_limbs_only:+.2f} m locked.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="tolerance_when_known",
        experiment="fault_knowledge",
        measure="tolerance_limp",
        definition="share of the displacement that is left with a known limp joint, with spine and tail less with "
        "limbs only",
        holds=(Clause("tolerance_limp", ">", 0.0, "a greater part is left", _PRINTED_LOSS),),
        control=_LIMBS_ONLY,
        spread=("tolerance_limp",),
        of=DEFAULT_SPREAD_OF,
        interpretation=_LIMP,
        interpretations=(_LOCKED,),
        why="Of the displacement of its own unbroken robot in its best gait, the robot that knows loses "
        "{loss_limp_coordinated_told:+.0%} with spine and tail and {loss_limp_limbs_only_told:+.0%} with limbs only, "
        "limp; {loss_locked_coordinated_told:+.0%} and {loss_locked_limbs_only_told:+.0%} locked.",
        unswept=_UNSWEPT,
    ),
)


def _example(rule: Rule, bounds: tuple[float, float], locked: tuple[float, float] | None = None) -> dict[str, float]:
    """Return example measures: the judged one with its interval in all readings, and those of the sentence.

    Args:
        rule: rule whose measures they are.
        bounds: interval of its measure.
        locked: interval of the same measure of a locked joint; the same by default.
    """
    measures = dict.fromkeys(rule.named_in_reason, 0.5) | measure_with_interval(rule.measure, *bounds)
    for reading in rule.interpretations:
        measures |= measure_with_interval(reading.measure(rule.measure), *(locked or bounds))
    return measures


def _examples(rule: Rule) -> list[tuple[dict[str, float], Word]]:
    """Return examples on both sides of the bound of a rule with one clause."""
    (clause,) = rule.holds
    assert clause.smallest_effect is not None
    smallest = clause.smallest_effect.size
    above, below = (1.02 * smallest, 3.0 * smallest), (-3.0 * smallest, 0.98 * smallest)
    examples: list[tuple[dict[str, float], Word]] = [
        (_example(rule, above), "reproduced"),
        (_example(rule, (0.98 * smallest, 3.0 * smallest)), "undecided"),
        (_example(rule, below), "contradicted"),
    ]
    if rule.interpretations:
        examples.append((_example(rule, above, locked=below), "depends on the reading"))
    return examples


EXAMPLES: Examples = {rule.claim: _examples(rule) for rule in RULES}
