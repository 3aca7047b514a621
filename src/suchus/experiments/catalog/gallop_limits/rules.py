"""When the claim on galloping counts as what (section II.A)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import DEFAULT_SPREAD_OF, Clause, Rule, measure_with_interval

RULES = (
    Rule(
        claim="gallop_fastest",
        experiment="gallop_limits",
        measure="bound_over_walk",
        definition="speed of the fastest bound over that of the fastest walk, with the robot's servos",
        kind="animals",
        holds=(
            Clause("bound_over_walk", ">", 1.0, "the fastest gait outruns the others"),
            Clause("flight_bound", ">=", 0.1, "a gallop has phases of flight; less is a walk that stumbles"),
        ),
        spread=("bound_over_walk",),
        of=DEFAULT_SPREAD_OF,
        why="Said of crocodiles. With servos like the robot's own a bound goes {speed_bound:.2f} m/s, "
        "{flight_bound:.0%} of the time in flight, and the fastest walk {speed_walk:.2f} m/s; with the best servos "
        "tried the bound goes {speed_bound_best:.2f} m/s.",
        unswept="Said of crocodiles; no design of a robot says how fast they are.",
    ),
)

_FAST = {
    **measure_with_interval("bound_over_walk", 1.01, 1.2),
    "flight_bound": 0.101,
    "speed_bound": 0.5,
    "speed_walk": 0.4,
    "speed_bound_best": 1.0,
}

EXAMPLES: Examples = {
    "gallop_fastest": [
        (_FAST, "same sense"),
        (_FAST | measure_with_interval("bound_over_walk", 0.99, 1.2), "undecided"),
        (_FAST | measure_with_interval("bound_over_walk", 0.8, 0.99), "not testable"),
        (_FAST | {"flight_bound": 0.099}, "not testable"),
    ],
}
