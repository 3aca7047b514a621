"""Measures for which each rule of ``leg_kinematics`` says each of its words."""

from suchus.verdict.judging import Examples

_INVERSE = {
    "printed_inverse_holds_crawl": 1.0,
    "printed_inverse_holds_high_walk": 0.999,
    "printed_inverse_holds": 0.25,
}

EXAMPLES: Examples = {
    "leg_inverse": [
        (_INVERSE, "reproduced"),
        (_INVERSE | {"printed_inverse_holds_crawl": 0.999}, "contradicted"),
        (_INVERSE | {"printed_inverse_holds": 1.0, "printed_inverse_holds_crawl": 0.98}, "contradicted"),
    ],
    "leg_servos": [
        ({"leg_servos": 3.0}, "by construction"),
        ({"leg_servos": 4.0}, "contradicted"),
    ],
    "actuator_count": [
        ({"actuators": 19.0}, "by construction"),
        ({"actuators": 18.0}, "contradicted"),
        ({"actuators": 23.0}, "contradicted"),
    ],
}
