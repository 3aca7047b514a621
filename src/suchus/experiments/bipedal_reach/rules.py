"""When the claims on the heights that are reached count as what (section IV.D, Figs 22 to 24)."""

from suchus.verdict.rule import Band, Clause, Rule

_REPEATS = "repeats with noise on the servos"
_ONE_ROBOT = "Lengths and torques of other robots are varied on the maps of the experiment, one or two at a time."


def _repeated(measure: str) -> Band:
    return Band(low=f"{measure}_repeated_low", high=f"{measure}_repeated_high", of=_REPEATS)


RULES = (
    Rule(
        claim="height_crawl",
        experiment="bipedal_reach",
        measure="reach_crawl",
        holds=(
            Clause(
                "hips_at_printed_height",
                "<=",
                "hip_height_plausible",
                "the robot can reach the printed height when it crawls: with hips no higher than a sprawled crawl has",
            ),
            Clause("distance_crawl_high", ">", 0.0, "a crawl that gets forward"),
        ),
        band=_repeated("reach_crawl"),
        why="The top of the back, with the hips at {hip_height:mm.0f} mm. The article says neither which point it "
        "measured nor how high the hips are; hips at {hips_at_printed_height:mm.0f} mm give the printed height, and up "
        "to {hip_height_plausible:mm.0f} mm are plausible.",
        unswept=_ONE_ROBOT,
    ),
    Rule(
        claim="height_standing",
        experiment="bipedal_reach",
        measure="reach_standing",
        kind="fitted",
        holds=(
            Clause("reach_ratio", ">", 1.0, "standing reaches higher than crawling"),
            Clause(
                "held_share", ">=", 0.99, "it stands for as long as it is asked to, but for the samples at the ends"
            ),
        ),
        band=_repeated("reach_standing"),
        why="The snout at its lowest while it stands, for {held:.0f} s. Hind leg, spine and head in one line are "
        "{stretched_length:.3f} m: the article does not give the head's length, and ours was chosen so that they make "
        "the printed height.",
        unswept=_ONE_ROBOT,
    ),
    Rule(
        claim="height_ratio",
        experiment="bipedal_reach",
        measure="reach_ratio",
        kind="fitted",
        holds=(Clause("reach_ratio", ">", 2.0, "several times as high is more than twice"),),
        band=_repeated("reach_ratio"),
        why="The height of the stand was fitted, and so is its ratio. The crawl reaches {reach_crawl:.3f} m; with the "
        "hips at {hips_at_printed_height:mm.0f} mm it would reach the printed height.",
        unswept=_ONE_ROBOT,
    ),
    Rule(
        claim="height_from_legs",
        experiment="bipedal_reach",
        measure="gain_leg_crawling",
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
        unswept=_ONE_ROBOT,
    ),
)
