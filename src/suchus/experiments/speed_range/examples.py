"""Measures of ``speed_range`` for which each rule says each of its words."""

from suchus.verdict.judging import Examples

_WHY = {
    "animals_high_walk_slowest": 0.1,
    "animals_high_walk_fastest": 0.7,
    "speed_high_walk_slowest": 0.1,
    "speed_high_walk_slowest_low": 0.1,
    "speed_high_walk_slowest_high": 0.1,
    "speed_high_walk_fastest": 0.3,
    "speed_high_walk_fastest_low": 0.3,
    "speed_high_walk_fastest_high": 0.3,
    "tail_touches_high_walk": 1.0,
    "tail_on_ground_high_walk": 0.5,
    "tail_on_ground_high_walk_low": 0.1,
    "tail_on_ground_high_walk_high": 0.9,
}

EXAMPLES: Examples = {
    "high_walk_speed_low": [
        (_WHY | {"speed_high_walk_slowest": 1.251}, "same sense"),  # 4.5 km/h are 1.25 m/s
        (_WHY | {"speed_high_walk_slowest": 1.249}, "not testable"),
        (_WHY, "not testable"),
    ],
    "high_walk_speed_high": [
        (_WHY | {"speed_high_walk_fastest": 2.64}, "same sense"),  # 9.5 km/h are 2.639 m/s
        (_WHY | {"speed_high_walk_fastest": 2.637}, "not testable"),
        (_WHY, "not testable"),
    ],
    "tail_on_ground_in_high_walk": [
        (_WHY, "same sense"),
        (_WHY | {"tail_on_ground_high_walk": 0.351}, "same sense"),
        (_WHY | {"tail_on_ground_high_walk": 0.349}, "not testable"),
        (_WHY | {"tail_on_ground_high_walk": 0.649}, "same sense"),
        (_WHY | {"tail_on_ground_high_walk": 0.651}, "not testable"),
    ],
}
