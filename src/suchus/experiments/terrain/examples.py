"""Measures of ``terrain`` for which each rule says each of its words."""

from math import nan

from suchus.verdict.judging import Examples

_WHY = {
    "flat_cost_ratio": 0.5,
    "flat_cost_ratio_low": 0.4,
    "flat_cost_ratio_high": 0.6,
    "flat_forward_low_crawl": 1.7,
    "flat_forward_high_walk": 1.6,
    "erect_ahead_share": 0.8,
    "erect_ahead_share_low": 0.6,
    "erect_ahead_share_high": 0.9,
    "erect_open_loop_ahead_share": 0.5,
    "semi_erect_ahead_of_both_share": 0.9,
    "rough_grounds": 9.0,
    "rough_runs": 36.0,
    "falls_rough_low_crawl": 20.0,
    "falls_rough_high_walk_level": 0.0,
    "falls_rough_high_walk": 12.0,
    "transitions": 12.0,
    "transitions_upright": 1.0,
    "transition_tilt": 0.4,
    "transition_after_least": 0.3,
}

EXAMPLES: Examples = {
    "crawl_structure_flat": [
        (_WHY | {"flat_cost_ratio_high": 0.999}, "reproduced"),
        (_WHY | {"flat_cost_ratio_high": 1.001}, "contradicted"),
        (_WHY | {"flat_cost_ratio": nan}, "not testable"),
    ],
    "erect_structure_rough": [
        (_WHY, "reproduced"),
        (_WHY | {"erect_ahead_share": 0.501}, "reproduced"),
        (_WHY | {"erect_ahead_share": 0.5}, "contradicted"),
        (_WHY | {"erect_ahead_share": 0.499}, "contradicted"),
        (_WHY | {"falls_rough_high_walk_level": 20.0}, "reproduced"),
        (_WHY | {"falls_rough_high_walk_level": 19.8}, "reproduced"),
        (_WHY | {"falls_rough_high_walk_level": 20.2}, "contradicted"),
        (_WHY | {"erect_ahead_share": nan}, "not testable"),  # somebody did not meet what stands in the path
    ],
    "switches_structure": [
        (_WHY, "reproduced"),
        (_WHY | {"transitions_upright": 0.999}, "contradicted"),
        (_WHY | {"transition_after_least": 1e-4}, "reproduced"),
        (_WHY | {"transition_after_least": -1e-4}, "contradicted"),
        (_WHY | {"transitions_upright": nan}, "not testable"),
    ],
}
