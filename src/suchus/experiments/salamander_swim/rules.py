"""When the model's swim counts as the salamander's: how far it comes in a cycle."""

from suchus.verdict.judging import Examples
from suchus.verdict.rule import Clause, Rule, Varied

_QUARTER = "a model that says where a stroke goes is within a quarter of the animal's stride, 0.225 body lengths"

RULES = (
    Rule(
        claim="salamander_swim_stride",
        experiment="salamander_swim",
        measure="stride_swim",
        holds=(
            Clause("stride_off", ">=", -0.25, _QUARTER),
            Clause("stride_off", "<=", 0.25, _QUARTER),
        ),
        why="It comes {stride_swim:.3f} body lengths in a cycle, {stride_off:+.0%} off the animal's, with "
        "{share_under:.0%} of it under water.",
    ),
)

VARIED = Varied(claims=("salamander_swim_stride",), settings={"factors": (), "settle": 6, "cycles": 4}, samples=32)

EXAMPLES: Examples = {
    "salamander_swim_stride": [
        ({"stride_swim": 0.2254, "stride_off": 0.002, "share_under": 1.0}, "reproduced"),
        ({"stride_swim": 0.2258, "stride_off": 0.004, "share_under": 1.0}, "same sense"),
        ({"stride_swim": 0.225, "stride_off": 0.0, "share_under": 1.0}, "reproduced"),
        ({"stride_swim": 0.28, "stride_off": 0.249, "share_under": 1.0}, "same sense"),
        ({"stride_swim": 0.282, "stride_off": 0.251, "share_under": 1.0}, "contradicted"),
        ({"stride_swim": 0.17, "stride_off": -0.249, "share_under": 1.0}, "same sense"),
        ({"stride_swim": 0.168, "stride_off": -0.251, "share_under": 1.0}, "contradicted"),
    ],
}
