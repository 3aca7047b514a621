"""When the claims on the animals' high walk count as what (section II.A)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Variation, measure_with_interval

_KMH = 1 / 3.6
_MODELS = "both models of the legs' servos"
_ROBOT = "; the robot resembles it if it walks as fast"
_HALF = "about half: what is nearer to a half than to a fifth or to four fifths"

RULES = (
    Rule(
        claim="high_walk_speed_low",
        experiment="speed_range",
        measure="speed_high_walk_slowest",
        definition="speed of the slowest high walk",
        unit="m/s",
        kind="animals",
        holds=(Clause("speed_high_walk_slowest", ">=", 4.5 * _KMH, f"5 km/h, as rounded{_ROBOT}"),),
        spread=("speed_high_walk_slowest",),
        of=_MODELS,
        why="Said of crocodiles, of which the article gives no size. Nile crocodiles of 1.5 to 7 kg walk high at "
        "{animals_high_walk_slowest:.1f} to {animals_high_walk_fastest:.1f} m/s (Michel). The robot, 1 m long, walks "
        "high at {speed_high_walk_slowest:.2f} to {speed_high_walk_fastest:.2f} m/s.",
    ),
    Rule(
        claim="high_walk_speed_high",
        experiment="speed_range",
        measure="speed_high_walk_fastest",
        definition="speed of the fastest high walk",
        unit="m/s",
        kind="animals",
        holds=(Clause("speed_high_walk_fastest", ">=", 9.5 * _KMH, f"10 km/h, as rounded{_ROBOT}"),),
        spread=("speed_high_walk_fastest",),
        of=_MODELS,
        why="Said of crocodiles, of which the article gives no size. Nile crocodiles of 1.5 to 7 kg walk high at up to "
        "{animals_high_walk_fastest:.1f} m/s (Michel), the robot at up to {speed_high_walk_fastest:.2f} m/s.",
    ),
    Rule(
        claim="tail_on_ground_in_high_walk",
        experiment="speed_range",
        measure="tail_on_ground_high_walk",
        definition="part of the tail's length within 5 mm of the ground in the high walk",
        kind="animals",
        holds=(
            Clause("tail_on_ground_high_walk", ">=", 0.35, _HALF),
            Clause("tail_on_ground_high_walk", "<=", 0.65, _HALF),
        ),
        spread=("tail_on_ground_high_walk",),
        of="the cycle times",
        why="Said of crocodiles. The robot's tail touches the ground {tail_touches_high_walk:.0%} of the time; of its "
        "length {tail_on_ground_high_walk:.0%} lie within 5 mm of it.",
    ),
)

VARIED = Variation(
    claims=("high_walk_speed_low", "high_walk_speed_high", "tail_on_ground_in_high_walk"),
    designs=("robot",),
    settings={"slower": (0.45, 0.6, 0.75, 1.0)},
    samples=32,
)

_REASON_MEASURES = {
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
        (
            _REASON_MEASURES | measure_with_interval("speed_high_walk_slowest", 1.251, 1.3),
            "same sense",
        ),  # 4.5 km/h are 1.25 m/s
        (_REASON_MEASURES | measure_with_interval("speed_high_walk_slowest", 1.249, 1.251), "undecided"),
        (_REASON_MEASURES | measure_with_interval("speed_high_walk_slowest", 1.2, 1.249), "not testable"),
        (_REASON_MEASURES, "not testable"),
    ],
    "high_walk_speed_high": [
        (
            _REASON_MEASURES | measure_with_interval("speed_high_walk_fastest", 2.64, 2.7),
            "same sense",
        ),  # 9.5 km/h are 2.639 m/s
        (_REASON_MEASURES | measure_with_interval("speed_high_walk_fastest", 2.637, 2.64), "undecided"),
        (_REASON_MEASURES | measure_with_interval("speed_high_walk_fastest", 2.6, 2.637), "not testable"),
        (_REASON_MEASURES, "not testable"),
    ],
    "tail_on_ground_in_high_walk": [
        (_REASON_MEASURES | measure_with_interval("tail_on_ground_high_walk", 0.351, 0.649), "same sense"),
        (_REASON_MEASURES | measure_with_interval("tail_on_ground_high_walk", 0.349, 0.5), "undecided"),
        (_REASON_MEASURES | measure_with_interval("tail_on_ground_high_walk", 0.3, 0.349), "not testable"),
        (_REASON_MEASURES | measure_with_interval("tail_on_ground_high_walk", 0.5, 0.651), "undecided"),
        (_REASON_MEASURES | measure_with_interval("tail_on_ground_high_walk", 0.651, 0.7), "not testable"),
    ],
}
