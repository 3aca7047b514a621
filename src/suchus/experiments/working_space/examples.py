"""Measures for which each rule of ``working_space`` says each of its words, close to both sides of every bound."""

from suchus.verdict.judging import Examples

_ROOM = {
    "volume_ratio": 5.0,
    "volume_ratio_low": 2.02,
    "volume_ratio_high": 9.0,
    "area_ratio": 3.0,
    "area_ratio_low": 1.01,
    "area_ratio_high": 4.0,
}

EXAMPLES: Examples = {
    "working_space": [
        (_ROOM, "reproduced"),
        (_ROOM | {"volume_ratio_low": 1.98}, "contradicted"),
        (_ROOM | {"area_ratio_low": 0.99}, "contradicted"),
        (_ROOM | {"volume_ratio": float("nan")}, "not testable"),
    ],
}
