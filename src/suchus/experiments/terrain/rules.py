"""When the claims on the structures of the legs count as what (section II.B, Fig. 3)."""

from suchus.verdict.rule import Band, Clause, Rule

_UNSWEPT = "Each answer takes hundreds of runs on rough ground; no study runs them for other designs."

RULES = (
    Rule(
        claim="crawl_structure_flat",
        experiment="terrain",
        measure="flat_cost_ratio",
        holds=(Clause("flat_cost_ratio_high", "<", 1.0, "the structure to adopt is the one that costs less"),),
        band=Band(low="flat_cost_ratio_low", high="flat_cost_ratio_high", of="repeats with noise on the servos"),
        why="On even ground the low crawl costs {flat_cost_ratio:.2f} of the high walk's work over the same "
        "distance, and gets {flat_forward_low_crawl:.2f} m while the high walk gets {flat_forward_high_walk:.2f} m.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="erect_structure_rough",
        experiment="terrain",
        measure="erect_ahead_share",
        holds=(
            Clause("erect_ahead_share", ">", 0.5, "on more rough grounds than not"),
            Clause("falls_rough_high_walk_level", "<=", "falls_rough_low_crawl", "what falls does not move better"),
        ),
        band=Band(low="erect_ahead_share_low", high="erect_ahead_share_high", of="seeds, each with its own obstacles"),
        why="With the IMU, which the article does not name: on {erect_ahead_share:.0%} of {rough_grounds:.0f} "
        "grounds 30 mm and rougher, all of them met by all robots, the erect walk gets farther than the crawl, "
        "falling {falls_rough_high_walk_level:.0f} times in {rough_runs:.0f} runs (the crawl "
        "{falls_rough_low_crawl:.0f} times); open loop on {erect_open_loop_ahead_share:.0%}, falling "
        "{falls_rough_high_walk:.0f} times. Semi-erect legs beat both on {semi_erect_ahead_of_both_share:.0%}.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="switches_structure",
        experiment="terrain",
        measure="transitions_upright",
        holds=(
            Clause("transitions_upright", ">=", 1.0, "a robot that falls has not switched"),
            Clause("transition_after_least", ">", 0.0, "after the switch it walks on"),
        ),
        why="{transitions:.0f} transitions out of one walk into another, 3.5 s at a stand each, on even ground and "
        "bumps of 30 mm: {transitions_upright:.0%} stay upright, with tilts up to {transition_tilt:deg.0f} degrees, "
        "and walk on by at least {transition_after_least:.2f} m.",
        unswept=_UNSWEPT,
    ),
)
