"""Measures of ``gallop_limits`` for which its rule says each of its words."""

from suchus.verdict.judging import Examples

_FAST = {
    "bound_over_walk": 1.01,
    "flight_bound": 0.101,
    "speed_bound": 0.5,
    "speed_walk": 0.4,
    "speed_bound_best": 1.0,
}

EXAMPLES: Examples = {
    "gallop_fastest": [
        (_FAST, "same sense"),
        (_FAST | {"bound_over_walk": 0.99}, "not testable"),
        (_FAST | {"flight_bound": 0.099}, "not testable"),
    ],
}
