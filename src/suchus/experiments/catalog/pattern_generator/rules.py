"""When the oscillators do what the model of the salamander's spinal cord does (Ijspeert et al. 2007)."""

from math import radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Variation

_HALF = "half way between a travelling wave, 0, and a standing one, 1"

RULES = (
    Rule(
        claim="oscillators_switch",
        experiment="pattern_generator",
        measure="standing_index_walk",
        definition="standing index of the axis while the limbs walk; 1 is a standing wave, 0 a travelling one",
        holds=(
            Clause("standing_index_walk", ">=", 0.5, _HALF),
            Clause("standing_index_swim", "<", 0.5, _HALF),
            Clause("amplitude_limbs_walk", ">", 0.05, "limbs that walk move"),
            Clause("amplitude_limbs_swim", "<=", 0.05, "limbs that are silent do not"),
        ),
        why="The standing index of the axis is {standing_index_walk:.2f} while the limbs walk and "
        "{standing_index_swim:.2f} where they are silent.",
        unswept="The network alone decides, and its numbers are the published ones.",
    ),
    Rule(
        claim="oscillators_direction",
        experiment="pattern_generator",
        measure="turn_gained",
        definition="difference of the turn in a cycle between unequal and equal drives of both sides",
        unit="rad/cycle",
        holds=(Clause("turn_gained", ">=", radians(1.0), "with less a circle takes more than 360 cycles"),),
        why="Drives that differ by one between the sides turn the walk by {turn_gained:deg.2f} degrees a cycle more or "
        "less than equal ones.",
    ),
)

VARIED = Variation(
    claims=("oscillators_direction",),
    designs=("robot", "gait"),
    settings={"drives": (1.0, 2.0, 4.0), "starts": 1, "shore_time": 3.0, "ramp": 1.0},
    samples=32,
)

_SWITCH = {"standing_index_walk": 0.9, "standing_index_swim": 0.2, "amplitude_limbs_walk": 0.4,
           "amplitude_limbs_swim": 0.0}  # fmt: skip

EXAMPLES: Examples = {
    "oscillators_switch": [
        (_SWITCH, "reproduced"),
        (_SWITCH | {"standing_index_walk": 0.501}, "reproduced"),
        (_SWITCH | {"standing_index_walk": 0.499}, "contradicted"),
        (_SWITCH | {"standing_index_swim": 0.499}, "reproduced"),
        (_SWITCH | {"standing_index_swim": 0.501}, "contradicted"),
        (_SWITCH | {"amplitude_limbs_walk": 0.0505}, "reproduced"),
        (_SWITCH | {"amplitude_limbs_walk": 0.0495}, "contradicted"),
        (_SWITCH | {"amplitude_limbs_swim": 0.0495}, "reproduced"),
        (_SWITCH | {"amplitude_limbs_swim": 0.0505}, "contradicted"),
    ],
    "oscillators_direction": [
        ({"turn_gained": radians(1.01)}, "reproduced"),
        ({"turn_gained": radians(0.99)}, "contradicted"),
    ],
}
