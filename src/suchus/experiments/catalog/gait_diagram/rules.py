"""When the claims on the gait diagram count as what (sections II.A and III.D, Fig. 12)."""

from math import radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import DEFAULT_SPREAD_OF, Clause, Rule, measure_with_interval

RULES = (
    Rule(
        claim="diagonal_gait",
        experiment="gait_diagram",
        measure="diagonal_phase_error",
        definition="greatest time between the stances of a diagonal pair",
        unit="cycle",
        holds=(
            Clause("diagonal_phase_error", "<", 0.125, "Hildebrand: a trot within an eighth of a cycle"),
            Clause("duty_factor_greatest", "<=", 0.95, "a foot that hardly leaves the ground has no phase"),
        ),
        spread=("diagonal_phase_error",),
        of=DEFAULT_SPREAD_OF,
        why="By pressure the stances of a diagonal pair are at most {diagonal_phase_error:.3f} cycle apart "
        "({diagonal_phase_error_low:.3f} to {diagonal_phase_error_high:.3f}) in robots as built and "
        "{diagonal_phase_error_designed:.3f} exactly as designed; the foot "
        "that stands longest does so {duty_factor_greatest:.0%} of the time.",
    ),
    Rule(
        claim="gait_diagram",
        experiment="gait_diagram",
        measure="spine_changes_per_cycle",
        definition="changes of side of the spine's joints in a cycle",
        kind="construction",
        holds=(
            Clause("spine_changes_per_cycle", ">", 1.5, "two changes of side are one bend to each"),
            Clause("spine_changes_per_cycle", "<", 2.5, "two changes of side are one bend to each"),
            Clause("tail_changes_per_cycle", ">", 1.5, "two changes of side are one bend to each"),
            Clause("tail_changes_per_cycle", "<", 2.5, "two changes of side are one bend to each"),
        ),
        why="One bend to each side is commanded. The joints change side {spine_changes_per_cycle:.1f} times a cycle in "
        "the spine and {tail_changes_per_cycle:.1f} in the tail; two are one bend to each side.",
    ),
    Rule(
        claim="tail_swings_in_crawl",
        experiment="gait_diagram",
        measure="tail_swing_least",
        definition="least swing of the tail to either side",
        unit="rad",
        kind="animals",
        holds=(Clause("tail_swing_least", ">=", radians(5.0), "less than 5 degrees is a tail that trails"),),
        why="Said of crocodiles. The robot's tail swings by {tail_swing_least:deg.0f} degrees at least to both sides.",
    ),
    Rule(
        claim="cycle_period",
        experiment="gait_diagram",
        measure="period",
        definition="time after which the loads of the feet repeat themselves",
        unit="s",
        kind="construction",
        why="Commanded; the loads of the feet repeat themselves after {period:.2f} s.",
        unswept="the period is an input",
    ),
    Rule(
        claim="cycle_count",
        experiment="gait_diagram",
        measure="cycles",
        definition="time that is simulated",
        unit="cycle",
        kind="construction",
        why="Simulated as the article does it: {cycles:.0f} cycles.",
        unswept="the number of cycles is an input",
    ),
)

_DIAGONAL = {
    **measure_with_interval("diagonal_phase_error", 0.11, 0.124),
    "diagonal_phase_error_designed": 0.13,
    "duty_factor_greatest": 0.949,
}
_BENDS = {"spine_changes_per_cycle": 2.0, "tail_changes_per_cycle": 2.0}

EXAMPLES: Examples = {
    "diagonal_gait": [
        (_DIAGONAL, "reproduced"),
        (_DIAGONAL | measure_with_interval("diagonal_phase_error", 0.11, 0.126), "undecided"),
        (_DIAGONAL | measure_with_interval("diagonal_phase_error", 0.126, 0.13), "contradicted"),
        (_DIAGONAL | {"duty_factor_greatest": 0.951}, "contradicted"),
    ],
    "gait_diagram": [
        (_BENDS, "by construction"),
        (_BENDS | {"spine_changes_per_cycle": 1.49}, "contradicted"),
        (_BENDS | {"spine_changes_per_cycle": 1.51}, "by construction"),
        (_BENDS | {"spine_changes_per_cycle": 2.49}, "by construction"),
        (_BENDS | {"spine_changes_per_cycle": 2.51}, "contradicted"),
        (_BENDS | {"tail_changes_per_cycle": 1.49}, "contradicted"),
        (_BENDS | {"tail_changes_per_cycle": 1.51}, "by construction"),
        (_BENDS | {"tail_changes_per_cycle": 2.49}, "by construction"),
        (_BENDS | {"tail_changes_per_cycle": 2.51}, "contradicted"),
    ],
    "tail_swings_in_crawl": [
        ({"tail_swing_least": radians(5.01)}, "same sense"),
        ({"tail_swing_least": radians(4.99)}, "not testable"),
        ({"tail_swing_least": -0.1}, "not testable"),
    ],
    "cycle_period": [
        ({"period": 4.0}, "by construction"),
        ({"period": 4.49}, "by construction"),
        ({"period": 4.51}, "contradicted"),
        ({"period": 3.51}, "by construction"),
        ({"period": 3.49}, "contradicted"),
    ],
    "cycle_count": [
        ({"cycles": 2.0}, "by construction"),
        ({"cycles": 3.0}, "contradicted"),
        ({"cycles": 1.0}, "contradicted"),
    ],
}  # fmt: skip
