"""When claims on how crocodiles swim count as what (section II.A)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, SmallestEffect

_LEAST_GAIN = SmallestEffect(size=0.02, why="less than a fiftieth of the speed is of no use to a swimmer")
_OF_ANIMALS = "Said of crocodiles; no design of a robot says how they swim."

RULES = (
    Rule(
        claim="swim_limbs_pressed",
        experiment="swim_free",
        measure="gain_limbs_pressed",
        definition="relative change of speed with the limbs along the body, from limbs straight out",
        kind="animals",
        holds=(Clause("gain_limbs_pressed", ">", 0.0, "pressed limbs are faster than spread ones", _LEAST_GAIN),),
        why="With its limbs along the body the robot swims at {speed_whole:.3f} m/s, with the limbs straight out at "
        "{speed_limbs_spread:.3f} m/s. The section model knows the drag of limbs, and not the wake behind them.",
        unswept=_OF_ANIMALS,
    ),
    Rule(
        claim="swim_rapid_swings",
        experiment="swim_free",
        measure="gain_faster_swings",
        definition="relative change of speed with swings a quarter more frequent",
        kind="animals",
        holds=(Clause("gain_faster_swings", ">", 0.0, "faster swings make a faster swim", _LEAST_GAIN),),
        why="With swings a quarter more frequent the robot swims at {speed_faster:.3f} m/s in the place of "
        "{speed_whole:.3f} m/s.",
        unswept=_OF_ANIMALS,
    ),
)

EXAMPLES: Examples = {
    "swim_limbs_pressed": [
        ({"gain_limbs_pressed": 0.0202, "speed_whole": 0.2, "speed_limbs_spread": 0.1}, "same sense"),
        ({"gain_limbs_pressed": 0.0198, "speed_whole": 0.2, "speed_limbs_spread": 0.1}, "not testable"),
    ],
    "swim_rapid_swings": [
        ({"gain_faster_swings": 0.0202, "speed_whole": 0.2, "speed_faster": 0.2}, "same sense"),
        ({"gain_faster_swings": 0.0198, "speed_whole": 0.2, "speed_faster": 0.2}, "not testable"),
    ],
}
