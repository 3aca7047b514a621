"""Measures for which each rule of ``bipedal_reach`` says each of its words, close to both sides of every bound."""

from suchus.verdict.judging import Examples

_CRAWL = {
    "reach_crawl": 0.16,
    "reach_crawl_repeated_low": 0.16,
    "reach_crawl_repeated_high": 0.16,
    "hips_at_printed_height": 0.119,
    "hip_height_plausible": 0.12,
    "distance_crawl_high": 0.3,
    "hip_height": 0.09,
}
_LOW = _CRAWL | {"reach_crawl": 0.13, "reach_crawl_repeated_low": 0.13}
_HIGH = _CRAWL | {"reach_crawl": 0.18, "reach_crawl_repeated_high": 0.18}
_STAND = {
    "reach_standing": 0.68,
    "reach_standing_repeated_low": 0.68,
    "reach_standing_repeated_high": 0.68,
    "reach_ratio": 4.25,
    "held_share": 1.0,
    "held": 60.0,
    "stretched_length": 0.68,
}
_STOOPED = _STAND | {"reach_standing": 0.65, "reach_standing_repeated_low": 0.65}
_TALL = _STAND | {"reach_standing": 0.70, "reach_standing_repeated_high": 0.70}
_RATIO = {
    "reach_ratio": 4.25,
    "reach_ratio_repeated_low": 4.25,
    "reach_ratio_repeated_high": 4.25,
    "reach_crawl": 0.16,
    "hips_at_printed_height": 0.119,
}
_SMALL = _RATIO | {"reach_ratio": 2.5, "reach_ratio_repeated_low": 2.5}
_LARGE = _RATIO | {"reach_ratio": 5.3, "reach_ratio_repeated_high": 5.4}
_LEGS = {"gain_leg_crawling": 0.5, "gain_others_crawling": 0.02}
_ALL = {
    "gain_least_standing": 0.8,
    "gain_leg_standing": 0.8,
    "gain_spine_standing": 1.0,
    "gain_head_standing": 1.0,
}

EXAMPLES: Examples = {
    "height_crawl": [
        (_CRAWL, "reproduced"),
        (_LOW | {"reach_crawl_repeated_high": 0.156}, "reproduced"),
        (_LOW | {"reach_crawl_repeated_high": 0.154}, "same sense"),
        (_HIGH | {"reach_crawl_repeated_low": 0.164}, "reproduced"),
        (_HIGH | {"reach_crawl_repeated_low": 0.166}, "same sense"),
        (_CRAWL | {"hips_at_printed_height": 0.121}, "contradicted"),
        (_CRAWL | {"distance_crawl_high": 0.01}, "reproduced"),
        (_CRAWL | {"distance_crawl_high": -0.01}, "contradicted"),
    ],
    "height_standing": [
        (_STAND, "fitted"),
        (_STOOPED | {"reach_standing_repeated_high": 0.676}, "fitted"),
        (_STOOPED | {"reach_standing_repeated_high": 0.674}, "same sense"),
        (_TALL | {"reach_standing_repeated_low": 0.684}, "fitted"),
        (_TALL | {"reach_standing_repeated_low": 0.686}, "same sense"),
        (_STAND | {"reach_ratio": 1.01}, "fitted"),
        (_STAND | {"reach_ratio": 0.99}, "contradicted"),
        (_STAND | {"held_share": 0.991}, "fitted"),
        (_STAND | {"held_share": 0.989}, "contradicted"),
    ],
    "height_ratio": [
        (_RATIO, "fitted"),
        (_SMALL | {"reach_ratio_repeated_high": 4.246}, "fitted"),
        (_SMALL | {"reach_ratio_repeated_high": 4.244}, "same sense"),
        (_LARGE | {"reach_ratio_repeated_low": 4.254}, "fitted"),
        (_LARGE | {"reach_ratio_repeated_low": 4.256}, "same sense"),
        (_SMALL | {"reach_ratio": 2.02}, "fitted"),
        (_SMALL | {"reach_ratio": 1.98}, "contradicted"),
    ],
    "height_from_legs": [
        (_LEGS, "by construction"),
        (_LEGS | {"gain_leg_crawling": 0.101}, "by construction"),
        (_LEGS | {"gain_leg_crawling": 0.099}, "contradicted"),
        (_LEGS | {"gain_others_crawling": 0.49}, "by construction"),
        (_LEGS | {"gain_others_crawling": 0.51}, "contradicted"),
    ],
    "height_from_spine_head_legs": [
        (_ALL, "reproduced"),
        (_ALL | {"gain_least_standing": 0.505}, "reproduced"),
        (_ALL | {"gain_least_standing": 0.495}, "contradicted"),
    ],
}
