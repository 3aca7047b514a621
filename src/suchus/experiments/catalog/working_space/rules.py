"""When the claim on the working space counts as what (section IV.D)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Variation, measure_with_interval

RULES = (
    Rule(
        claim="working_space",
        experiment="working_space",
        measure="volume_ratio",
        definition="volume in reach of the snout when the robot stands, over that on four feet",
        holds=(
            Clause("volume_ratio", ">=", 2.0, "less than twice as much is no great improvement"),
            Clause("area_ratio", ">", 1.0, "larger from the side too, as Fig. 23 shows it"),
        ),
        spread=("volume_ratio", "area_ratio"),
        of="what counting cells leaves open",
        why="Standing, the snout reaches {volume_ratio:.0f} times the volume that it reaches on four feet "
        "({volume_ratio_low:.0f} to {volume_ratio_high:.0f}), and {area_ratio:.1f} times the area seen from the side "
        "({area_ratio_low:.1f} to {area_ratio_high:.1f}); joint ranges and balance are met, torques not looked at.",
    ),
)

VARIED = Variation(claims=("working_space",), designs=("robot",), samples=32)

_SPACE_MEASURES = {
    "volume_ratio": 5.0,
    "volume_ratio_low": 2.02,
    "volume_ratio_high": 9.0,
    "area_ratio": 3.0,
    "area_ratio_low": 1.01,
    "area_ratio_high": 4.0,
}

EXAMPLES: Examples = {
    "working_space": [
        (_SPACE_MEASURES, "reproduced"),
        (_SPACE_MEASURES | {"volume_ratio_low": 1.98}, "undecided"),
        (_SPACE_MEASURES | measure_with_interval("volume_ratio", 1.5, 1.98), "contradicted"),
        (_SPACE_MEASURES | {"area_ratio_low": 0.99}, "undecided"),
        (_SPACE_MEASURES | measure_with_interval("area_ratio", 0.9, 0.99), "contradicted"),
        (_SPACE_MEASURES | {"volume_ratio": float("nan")}, "not testable"),
    ],
}
