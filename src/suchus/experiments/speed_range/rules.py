"""When the claims on the animals' high walk count as what (section II.A)."""

from suchus.verdict.judging import Examples
from suchus.verdict.rule import Band, Clause, Rule

_KMH = 1 / 3.6
_UNSWEPT = "Said of crocodiles; no design of a robot says how fast or how they walk."
_MODELS = "both models of the legs' servos"
_ROBOT = "; the robot resembles it if it walks as fast"
_HALF = "about half: what is nearer to a half than to a fifth or to four fifths"

RULES = (
    Rule(
        claim="high_walk_speed_low",
        experiment="speed_range",
        measure="speed_high_walk_slowest",
        kind="animals",
        holds=(Clause("speed_high_walk_slowest", ">=", 4.5 * _KMH, f"5 km/h, as rounded{_ROBOT}"),),
        band=Band(low="speed_high_walk_slowest_low", high="speed_high_walk_slowest_high", of=_MODELS),
        why="Said of crocodiles, of which the article gives no size. Nile crocodiles of 1.5 to 7 kg walk high at "
        "{animals_high_walk_slowest:.1f} to {animals_high_walk_fastest:.1f} m/s (Michel). The robot, 1 m long, walks "
        "high at {speed_high_walk_slowest:.2f} to {speed_high_walk_fastest:.2f} m/s.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="high_walk_speed_high",
        experiment="speed_range",
        measure="speed_high_walk_fastest",
        kind="animals",
        holds=(Clause("speed_high_walk_fastest", ">=", 9.5 * _KMH, f"10 km/h, as rounded{_ROBOT}"),),
        band=Band(low="speed_high_walk_fastest_low", high="speed_high_walk_fastest_high", of=_MODELS),
        why="Said of crocodiles, of which the article gives no size. Nile crocodiles of 1.5 to 7 kg walk high at up to "
        "{animals_high_walk_fastest:.1f} m/s (Michel), the robot at up to {speed_high_walk_fastest:.2f} m/s.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="tail_on_ground_in_high_walk",
        experiment="speed_range",
        measure="tail_on_ground_high_walk",
        kind="animals",
        holds=(
            Clause("tail_on_ground_high_walk", ">=", 0.35, _HALF),
            Clause("tail_on_ground_high_walk", "<=", 0.65, _HALF),
        ),
        band=Band(low="tail_on_ground_high_walk_low", high="tail_on_ground_high_walk_high", of="the cycle times"),
        why="Said of crocodiles. The robot's tail touches the ground {tail_touches_high_walk:.0%} of the time; of its "
        "length {tail_on_ground_high_walk:.0%} lie within 5 mm of it.",
        unswept=_UNSWEPT,
    ),
)

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
