"""When the claims on the cable-driven tail count as what (section III.C, eqs (16) to (19))."""

from math import radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Variation

SMALL = 0.05
"""Greatest ratio of a neglected term to the retained one that counts as small [-]."""
EQUAL_ANGLE_TOLERANCE = radians(10)
"""Greatest difference of joint angles that counts as equal [rad].

It is what the stiffness of the robot's tail joints was chosen to keep to, and two thirds of what each of six joints
turns when the tail bends by 90 degrees.
"""
MIN_VISIBLE_ANGLE = radians(1)
"""Least angle that a screenshot shows [rad]."""
EXACT = 1e-9
"""Greatest error that counts as rounding, as a share of the length [-]."""
_CONSTRUCTION_NOTE = "A count of the robot that was built so; nothing is simulated."
_FORMULA = "A comparison of formulas; what is free in them is varied within the verdict's own measures."

RULES = (
    Rule(
        claim="tail_quadratic_small",
        experiment="tail_bending",
        measure="error_of_eq_17_max",
        definition="greatest relative error of the cord lengths by (17) up to half a turn",
        holds=(Clause("error_of_eq_17_max", "<", SMALL, "one part in twenty of what is kept counts as small"),),
        why="Up to a half turn (17) is off by at most {error_of_eq_17_max:.1%}; with the widest gap and the narrowest "
        "spacing of the cords that we hold plausible, by {error_of_eq_17_plausible:.1%}.",
    ),
    Rule(
        claim="tail_cords_inextensible",
        experiment="tail_bending",
        measure="cords_opposed_share",
        definition="share of the bends at which one cord is shorter and the other longer",
        kind="construction",
        holds=(Clause("cords_opposed_share", ">=", 1.0, "one cord is shorter and the other longer at every bend"),),
        why="At {cords_opposed_share:.0%} of the bends one cord is shorter and the other longer. They do not change by "
        "the same: up to {slack_max:mm.1f} mm of cord hang loose, so that one of them needs a spring. The article says "
        "no more than that one is elongated and the other shortened; its (17) makes both changes equal.",
        unswept=_FORMULA,
    ),
    Rule(
        claim="tail_joint_positions",
        experiment="tail_bending",
        measure="printed_last_joint_error_share",
        definition="greatest error of the last joint's place by (19), over the section's length",
        kind="construction",
        holds=(Clause("printed_last_joint_error_share", "<=", EXACT, "positions of a chain are exact up to rounding"),),
        why="The last joint by (19) is {printed_last_joint_error_straight:mm.0f} mm off in a straight tail and up to "
        "{printed_last_joint_error_max:mm.0f} mm off in a bent one, the measured share of the section's length: "
        "(19) has two cosines and the wrong index.",
        unswept="An identity of formulas: no length can mend it.",
    ),
    Rule(
        claim="tail_equal_bends",
        experiment="tail_bending",
        measure="tail_joint_spread",
        definition="greatest difference between the angles of the tail's joints in the crawl",
        unit="rad",
        holds=(
            Clause(
                "tail_joint_spread",
                "<=",
                EQUAL_ANGLE_TOLERANCE,
                "ten degrees, two thirds of what each joint turns at a bend of 90 degrees: what differs by more does "
                "not turn alike",
            ),
        ),
        why="In the crawl the joints' angles differ by up to {tail_joint_spread:deg.0f} degrees, by more than ten for "
        "{tail_joint_spread_share:.0%} of the time; with a straight trunk by up to "
        "{tail_joint_spread_straight:deg.0f} degrees, for {tail_joint_spread_share_straight:.0%}. One cable bends them "
        "all; nothing in the robot makes them alike but their springs.",
    ),
    Rule(
        claim="tail_joints",
        experiment="tail_bending",
        measure="tail_joints",
        definition="joints of the cable section",
        kind="construction",
        why=f"{_CONSTRUCTION_NOTE} Its hinges share one input.",
        unswept=_CONSTRUCTION_NOTE,
    ),
    Rule(
        claim="tail_actuators",
        experiment="tail_bending",
        measure="tail_actuators",
        definition="servos of the tail",
        kind="construction",
        why=f"{_CONSTRUCTION_NOTE} A pitch servo and a servo for the cable.",
        unswept=_CONSTRUCTION_NOTE,
    ),
    Rule(
        claim="tail_end_flexible",
        experiment="tail_bending",
        measure="end_bend",
        definition="range of the bend of the tail's end in the crawl",
        unit="rad",
        kind="construction",
        holds=(Clause("end_bend", ">=", MIN_VISIBLE_ANGLE, "flexible is what bends by as much as a picture shows"),),
        why="Behind the last cable joint there are springs and dampers and no servo; in the crawl they let that end "
        "bend to and fro over {end_bend:deg.0f} degrees. The article gives no stiffness: ours was chosen.",
        unswept="What its springs let it do follows from their stiffness, which was chosen so that it does.",
    ),
    Rule(
        claim="tail_share",
        experiment="tail_bending",
        measure="tail_share",
        definition="length of the tail over that of the body",
        kind="construction",
        why="The article gives no length of the robot's tail; ours was chosen so that it makes this share.",
        unswept="The tail's length was chosen so.",
    ),
)

VARIED = Variation(claims=("tail_quadratic_small",), designs=("robot",), settings={"steps": 91}, samples=128)

_SMALL = {"error_of_eq_17_max": 0.0411, "error_of_eq_17_plausible": 0.063}
_CORDS = {"cords_opposed_share": 1.0, "slack_max": 0.006}
_POSITIONS = {
    "printed_last_joint_error_share": 0.99e-9,
    "printed_last_joint_error_straight": 0.0,
    "printed_last_joint_error_max": 2e-10,
}
_EQUAL_BEND_MEASURES = {
    "tail_joint_spread": radians(9.9),
    "tail_joint_spread_share": 0.0,
    "tail_joint_spread_straight": radians(34),
    "tail_joint_spread_share_straight": 0.61,
}

EXAMPLES: Examples = {
    "tail_quadratic_small": [
        (_SMALL, "reproduced"),
        (_SMALL | {"error_of_eq_17_max": 0.0495}, "reproduced"),
        (_SMALL | {"error_of_eq_17_max": 0.0505}, "contradicted"),
    ],
    "tail_cords_inextensible": [
        (_CORDS, "by construction"),
        (_CORDS | {"cords_opposed_share": 0.99}, "contradicted"),
    ],
    "tail_joint_positions": [
        (_POSITIONS, "by construction"),
        (_POSITIONS | {"printed_last_joint_error_share": 1.01e-9}, "contradicted"),
        (_POSITIONS | {"printed_last_joint_error_share": 1.72}, "contradicted"),
    ],
    "tail_equal_bends": [
        (_EQUAL_BEND_MEASURES, "reproduced"),
        (_EQUAL_BEND_MEASURES | {"tail_joint_spread": radians(10.1)}, "contradicted"),
        (_EQUAL_BEND_MEASURES | {"tail_joint_spread": radians(25), "tail_joint_spread_share": 0.31}, "contradicted"),
        (_EQUAL_BEND_MEASURES | {"tail_joint_spread": float("nan")}, "not testable"),
    ],
    "tail_end_flexible": [
        ({"end_bend": radians(1.01)}, "by construction"),
        ({"end_bend": radians(0.99)}, "contradicted"),
        ({"end_bend": float("nan")}, "not testable"),
    ],
    "tail_joints": [
        ({"tail_joints": 6.0}, "by construction"),
        ({"tail_joints": 5.0}, "contradicted"),
    ],
    "tail_actuators": [
        ({"tail_actuators": 2.0}, "by construction"),
        ({"tail_actuators": 1.0}, "contradicted"),
    ],
    "tail_share": [
        ({"tail_share": 0.5}, "by construction"),
        ({"tail_share": 0.451}, "by construction"),
        ({"tail_share": 0.449}, "contradicted"),
        ({"tail_share": 0.549}, "by construction"),
        ({"tail_share": 0.551}, "contradicted"),
    ],
}
