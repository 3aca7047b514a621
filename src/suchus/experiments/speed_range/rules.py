"""When the claims on the animals' high walk count as what (section II.A)."""

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
