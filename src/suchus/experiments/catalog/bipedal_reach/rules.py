"""When the claims on the heights that are reached count as what (section IV.D, Figs 22 to 24)."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    PRINTED_DISPLACEMENT,
    Clause,
    Rule,
    Variation,
    measure_with_interval,
)

RULES = (
    Rule(
        claim="height_crawl",
        experiment="bipedal_reach",
        measure="reach_crawl",
        definition="height of the top of the back in the crawl",
        unit="m",
        holds=(
            Clause(
                "hips_at_printed_height",
                "<=",
                "hip_height_plausible",
                "the robot can reach the printed height when it crawls: with hips no higher than a sprawled crawl has",
            ),
            Clause("distance_high_crawl", ">", 0.0, "a crawl that gets forward", PRINTED_DISPLACEMENT),
        ),
        spread=("reach_crawl", "hips_at_printed_height"),
        of=DEFAULT_SPREAD_OF,
        why="The top of the back, with the hips at {hip_height:mm.0f} mm. The article says neither which point it "
        "measured nor how high the hips are; hips at {hips_at_printed_height:mm.0f} mm give the printed height, and up "
        "to {hip_height_plausible:mm.0f} mm are plausible.",
    ),
    Rule(
        claim="height_standing",
        experiment="bipedal_reach",
        measure="reach_standing",
        definition="least height of the snout while the robot stands on hind legs and tail",
        unit="m",
        kind="fitted",
        holds=(
            Clause("reach_ratio", ">", 1.0, "standing reaches higher than crawling"),
            Clause(
                "held_share", ">=", 0.99, "it stands for as long as it is asked to, but for the samples at the ends"
            ),
        ),
        spread=("reach_standing", "reach_ratio", "held_share"),
        of=DEFAULT_SPREAD_OF,
        why="The snout at its lowest while it stands, for {held:.0f} s. Hind leg, spine and head in one line are "
        "{stretched_length:.3f} m: the article does not give the head's length, and ours was chosen so that they make "
        "the printed height.",
    ),
    Rule(
        claim="height_ratio",
        experiment="bipedal_reach",
        measure="reach_ratio",
        definition="height of the stand over that of the crawl",
        kind="fitted",
        holds=(Clause("reach_ratio", ">", 2.0, "several times as high is more than twice"),),
        spread=("reach_ratio",),
        of=DEFAULT_SPREAD_OF,
        why="The height of the stand was fitted, and so is its ratio. The crawl reaches {reach_crawl:.3f} m; with the "
        "hips at {hips_at_printed_height:mm.0f} mm it would reach the printed height.",
    ),
    Rule(
        claim="height_from_legs",
        experiment="bipedal_reach",
        measure="gain_leg_crawling",
        definition="gain of the crawl's height over the gain of the legs' length",
        kind="construction",
        holds=(
            Clause("gain_leg_crawling", ">=", 0.1, "less than a tenth of what the legs grow by is no dependence"),
            Clause("gain_leg_crawling", ">", "gain_others_crawling", "it depends on the legs, not on spine or head"),
        ),
        why="Per millimetre of longer legs the crawl reaches {gain_leg_crawling:.2f} mm higher, because the heights of "
        "the gait are set in proportion to the legs; per millimetre of spine or head it changes by "
        "{gain_others_crawling:.2f} mm at most.",
        unswept="The height of the hips is commanded in proportion to the legs.",
    ),
    Rule(
        claim="height_from_spine_head_legs",
        experiment="bipedal_reach",
        measure="gain_least_standing",
        definition="least gain of the stand's height over the gain of hind legs, spine or head in length",
        holds=(
            Clause(
                "gain_least_standing",
                ">=",
                0.5,
                "what adds less than half of its own length does not determine the height",
            ),
        ),
        why="Per millimetre of hind leg, spine and head the stand reaches {gain_leg_standing:.2f}, "
        "{gain_spine_standing:.2f} and {gain_head_standing:.2f} mm higher; measured is the least of them.",
    ),
)

VARIED = Variation(
    claims=("height_crawl", "height_standing", "height_ratio", "height_from_spine_head_legs"),
    designs=("robot",),
    settings={"hold": 10.0, "torques": (3.0,), "forebodies": (0.6,), "leads": (), "pushes": (1.0,), "finer": 0},
    samples=16,
)

_CRAWL = {
    "reach_crawl": 0.16,
    "reach_crawl_low": 0.16,
    "reach_crawl_high": 0.16,
    **measure_with_interval("hips_at_printed_height", 0.119, 0.1195),
    "hip_height_plausible": 0.12,
    "distance_high_crawl": 0.3,
    "hip_height": 0.09,
}
_STAND = {
    "reach_standing": 0.68,
    "reach_standing_low": 0.68,
    "reach_standing_high": 0.68,
    "reach_ratio": 4.25,
    "reach_ratio_low": 4.25,
    "reach_ratio_high": 4.25,
    **measure_with_interval("held_share", 1.0, 1.0),
    "held": 60.0,
    "stretched_length": 0.68,
}
_RATIO = {
    "reach_ratio": 4.25,
    "reach_ratio_low": 4.25,
    "reach_ratio_high": 4.25,
    "reach_crawl": 0.16,
    "hips_at_printed_height": 0.119,
}
_LEGS = {"gain_leg_crawling": 0.5, "gain_others_crawling": 0.02}
_STANDING_GAINS = {
    "gain_least_standing": 0.8,
    "gain_leg_standing": 0.8,
    "gain_spine_standing": 1.0,
    "gain_head_standing": 1.0,
}

EXAMPLES: Examples = {
    "height_crawl": [
        (_CRAWL, "reproduced"),
        (_CRAWL | measure_with_interval("reach_crawl", 0.1551, 0.1551), "reproduced"),
        (_CRAWL | measure_with_interval("reach_crawl", 0.1549, 0.1549), "same sense"),
        (_CRAWL | measure_with_interval("reach_crawl", 0.1649, 0.1649), "reproduced"),
        (_CRAWL | measure_with_interval("reach_crawl", 0.1651, 0.1651), "same sense"),
        (_CRAWL | measure_with_interval("reach_crawl", 0.10, 0.18), "same sense"),
        (_CRAWL | measure_with_interval("hips_at_printed_height", 0.119, 0.1199), "reproduced"),
        (_CRAWL | measure_with_interval("hips_at_printed_height", 0.119, 0.1201), "undecided"),
        (_CRAWL | measure_with_interval("hips_at_printed_height", 0.1199, 0.121), "undecided"),
        (_CRAWL | measure_with_interval("hips_at_printed_height", 0.1201, 0.121), "contradicted"),
        (_CRAWL | {"distance_high_crawl": 0.0051}, "reproduced"),
        (_CRAWL | {"distance_high_crawl": 0.0049}, "contradicted"),
    ],
    "height_standing": [
        (_STAND, "fitted"),
        (_STAND | measure_with_interval("reach_standing", 0.6751, 0.6751), "fitted"),
        (_STAND | measure_with_interval("reach_standing", 0.6749, 0.6749), "same sense"),
        (_STAND | measure_with_interval("reach_standing", 0.6849, 0.6849), "fitted"),
        (_STAND | measure_with_interval("reach_standing", 0.6851, 0.6851), "same sense"),
        (_STAND | measure_with_interval("reach_standing", 0.60, 0.70), "same sense"),
        (_STAND | measure_with_interval("reach_ratio", 1.01, 4.0), "fitted"),
        (_STAND | measure_with_interval("reach_ratio", 0.99, 4.0), "undecided"),
        (_STAND | measure_with_interval("reach_ratio", 0.9, 0.99), "contradicted"),
        (_STAND | measure_with_interval("held_share", 0.991, 1.0), "fitted"),
        (_STAND | measure_with_interval("held_share", 0.989, 1.0), "undecided"),
        (_STAND | measure_with_interval("held_share", 0.5, 0.989), "contradicted"),
    ],
    "height_ratio": [
        (_RATIO, "fitted"),
        (_RATIO | measure_with_interval("reach_ratio", 4.2451, 4.2451), "fitted"),
        (_RATIO | measure_with_interval("reach_ratio", 4.2449, 4.2449), "same sense"),
        (_RATIO | measure_with_interval("reach_ratio", 4.2549, 4.2549), "fitted"),
        (_RATIO | measure_with_interval("reach_ratio", 4.2551, 4.2551), "same sense"),
        (_RATIO | measure_with_interval("reach_ratio", 2.02, 4.26), "same sense"),
        (_RATIO | measure_with_interval("reach_ratio", 1.98, 4.26), "undecided"),
        (_RATIO | measure_with_interval("reach_ratio", 2.02, 6.48), "fitted"),
        (_RATIO | measure_with_interval("reach_ratio", 1.98, 6.52), "undecided"),
        (_RATIO | measure_with_interval("reach_ratio", 1.9, 1.98), "contradicted"),
    ],
    "height_from_legs": [
        (_LEGS, "by construction"),
        (_LEGS | {"gain_leg_crawling": 0.101}, "by construction"),
        (_LEGS | {"gain_leg_crawling": 0.099}, "contradicted"),
        (_LEGS | {"gain_others_crawling": 0.49}, "by construction"),
        (_LEGS | {"gain_others_crawling": 0.51}, "contradicted"),
    ],
    "height_from_spine_head_legs": [
        (_STANDING_GAINS, "reproduced"),
        (_STANDING_GAINS | {"gain_least_standing": 0.505}, "reproduced"),
        (_STANDING_GAINS | {"gain_least_standing": 0.495}, "contradicted"),
    ],
}
