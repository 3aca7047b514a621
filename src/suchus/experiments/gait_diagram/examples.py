"""Measures for which each rule of ``gait_diagram`` says each of its words, close to both sides of every bound."""

from math import radians

from suchus.verdict.judging import Examples

_DIAGONAL = {"diagonal_phase_error": 0.124, "duty_factor_greatest": 0.949}
_BENDS = {"spine_changes_per_cycle": 2.0, "tail_changes_per_cycle": 2.0}

EXAMPLES: Examples = {
    "diagonal_gait": [
        (_DIAGONAL, "reproduced"),
        (_DIAGONAL | {"diagonal_phase_error": 0.126}, "contradicted"),
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
