"""When the claims on the structures of the legs count as what (section II.B, Fig. 3)."""

from math import nan

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    Clause,
    ControlGroup,
    Interpretation,
    Rule,
    SmallestEffect,
    Variation,
    measure_with_interval,
)

_LEAST_WALK = SmallestEffect(size=0.05, why="a robot that slides or settles moves by up to a twentieth of its length")

RULES = (
    Rule(
        claim="crawl_structure_flat",
        experiment="terrain",
        measure="flat_cost_ratio",
        definition="work of the low crawl over that of the high walk, for the same distance on even ground",
        holds=(Clause("flat_cost_ratio", "<", 1.0, "the structure to adopt is the one that costs less"),),
        control=ControlGroup(group="high_walk", why="Section II.B: one structure or the other, on the same ground."),
        spread=("flat_cost_ratio",),
        of=DEFAULT_SPREAD_OF,
        why="On even ground the low crawl costs {flat_cost_ratio:.2f} of the high walk's work over the same "
        "distance, and gets {flat_forward_low_crawl:.2f} m while the high walk gets {flat_forward_high_walk:.2f} m.",
    ),
    Rule(
        claim="erect_structure_rough",
        experiment="terrain",
        measure="erect_open_loop_ahead_share",
        definition="share of the rough grounds on which the erect walk gets farther than the crawl",
        holds=(
            Clause("erect_open_loop_ahead_share", ">", 0.5, "on more rough grounds than not"),
            Clause("falls_rough_high_walk", "<=", "falls_rough_low_crawl", "what falls does not move better"),
        ),
        control=ControlGroup(group="low_crawl", why="Section II.B: one structure or the other, on the same grounds."),
        spread=("erect_open_loop_ahead_share",),
        interpretation="by distance",
        interpretations=(
            Interpretation(
                name="by the fraction kept of its own distance on even ground",
                measures=("open_loop_ahead_share", "open_loop_kept_share"),
            ),
        ),
        of="grounds, each with its own obstacles and its own robot",
        why="Open loop, since the article names no IMU: on {erect_open_loop_ahead_share:.0%} "
        "({erect_open_loop_ahead_share_low:.0%} to {erect_open_loop_ahead_share_high:.0%}) of {rough_grounds:.0f} "
        "grounds 30 mm and rougher, all met by all robots, the erect walk gets farther than the crawl, falling "
        "{falls_rough_high_walk:.0f} times (the crawl {falls_rough_low_crawl:.0f} times). With an IMU that is so on "
        "{erect_ahead_share:.0%}, with {falls_rough_high_walk_level:.0f} falls. Semi-erect legs beat both on "
        "{semi_erect_ahead_of_both_share:.0%}.",
    ),
    Rule(
        claim="switches_structure",
        experiment="terrain",
        measure="transitions_upright",
        definition="share of the transitions between walks that end upright",
        holds=(
            Clause("transitions_upright", ">=", 1.0, "a robot that falls has not switched"),
            Clause("transition_after_least", ">", 0.0, "after the switch it walks on", _LEAST_WALK),
        ),
        why="{transitions:.0f} transitions out of one walk into another, 3.5 s at a stand each, on even ground and "
        "bumps of 30 mm: {transitions_upright:.0%} stay upright, with tilts up to {transition_tilt:deg.0f} degrees, "
        "and walk on by at least {transition_after_least:.2f} m.",
    ),
)

VARIED = Variation(
    claims=("crawl_structure_flat", "erect_structure_rough", "switches_structure"),
    designs=("robot",),
    settings={"flat_robots": 6},
    samples=16,
)

_REASON_MEASURES = {
    "flat_cost_ratio": 0.5,
    "flat_cost_ratio_low": 0.4,
    "flat_cost_ratio_high": 0.6,
    "flat_forward_low_crawl": 1.7,
    "flat_forward_high_walk": 1.6,
    "erect_open_loop_ahead_share": 0.8,
    "erect_open_loop_ahead_share_low": 0.6,
    "erect_open_loop_ahead_share_high": 0.9,
    "erect_open_loop_kept_share": 0.8,
    "erect_open_loop_kept_share_low": 0.6,
    "erect_open_loop_kept_share_high": 0.9,
    "erect_ahead_share": 0.5,
    "semi_erect_ahead_of_both_share": 0.9,
    "rough_grounds": 36.0,
    "falls_rough_low_crawl": 20.0,
    "falls_rough_high_walk_level": 12.0,
    "falls_rough_high_walk": 0.0,
    "transitions": 12.0,
    "transitions_upright": 1.0,
    "transition_tilt": 0.4,
    "transition_after_least": 0.3,
}

EXAMPLES: Examples = {
    "crawl_structure_flat": [
        (_REASON_MEASURES | {"flat_cost_ratio_high": 0.999}, "reproduced"),
        (_REASON_MEASURES | {"flat_cost_ratio_high": 1.001}, "undecided"),
        (_REASON_MEASURES | measure_with_interval("flat_cost_ratio", 1.001, 1.1), "contradicted"),
        (_REASON_MEASURES | {"flat_cost_ratio": nan}, "not testable"),
    ],
    "erect_structure_rough": [
        (_REASON_MEASURES, "reproduced"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_ahead_share", 0.501, 0.9), "reproduced"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_ahead_share", 0.5, 0.9), "undecided"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_ahead_share", 0.2, 0.501), "undecided"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_ahead_share", 0.2, 0.5), "depends on the reading"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_kept_share", 0.2, 0.5), "depends on the reading"),
        (_REASON_MEASURES | measure_with_interval("erect_open_loop_kept_share", 0.2, 0.501), "reproduced"),
        (
            _REASON_MEASURES
            | measure_with_interval("erect_open_loop_ahead_share", 0.2, 0.5)
            | measure_with_interval("erect_open_loop_kept_share", 0.2, 0.5),
            "contradicted",
        ),
        (_REASON_MEASURES | {"falls_rough_high_walk": 20.0}, "reproduced"),
        (_REASON_MEASURES | {"falls_rough_high_walk": 19.8}, "reproduced"),
        (_REASON_MEASURES | {"falls_rough_high_walk": 20.2}, "contradicted"),
        (
            _REASON_MEASURES | {"erect_open_loop_ahead_share": nan},
            "not testable",
        ),  # somebody did not meet what stands in the path
    ],
    "switches_structure": [
        (_REASON_MEASURES, "reproduced"),
        (_REASON_MEASURES | {"transitions_upright": 0.999}, "contradicted"),
        (_REASON_MEASURES | {"transition_after_least": 0.051}, "reproduced"),
        (_REASON_MEASURES | {"transition_after_least": 0.049}, "contradicted"),
        (_REASON_MEASURES | {"transitions_upright": nan}, "not testable"),
    ],
}
