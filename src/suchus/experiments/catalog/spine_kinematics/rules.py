"""When the claims on the spine's kinematics count as what (section III.B, Table II, eq. (15))."""

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule

EXACT = 1e-9
"""Greatest error that counts as rounding, as a share of the length [-]."""
_CONSTRUCTION_NOTE = "A count of the robot that was built so; nothing is simulated."


def _count(claim: str) -> Rule:
    """Return the rule of a claim that is a count of joints: the robot was built with this number."""
    return Rule(
        claim=claim,
        experiment="spine_kinematics",
        measure=claim,
        definition="joints of the trunk, counted in the model",
        kind="construction",
        why=f"{_CONSTRUCTION_NOTE} Yaw and pitch joints take turns, beginning with yaw.",
        unswept=_CONSTRUCTION_NOTE,
    )


RULES = (
    Rule(
        claim="spine_forward",
        experiment="spine_kinematics",
        measure="printed_error_share",
        definition="greatest error of the spine's end by (15), over the spine's length",
        kind="construction",
        holds=(
            Clause("printed_error_share", "<=", EXACT, "what follows from Table II equals its end to the last digits"),
        ),
        why="The straight spine is {straight_length:mm.1f} mm long by Table II and {straight_length_printed:mm.1f} mm "
        "by (15); bent by up to 30 degrees a joint, its ends differ by up to {printed_error_max:mm.1f} mm, the "
        "measured share of the spine's length. With 60.5 C4 for 0.5 they differ by {mended_error_max:.0e} m at most.",
        unswept="An identity of formulas over random postures; Table II gives every length.",
    ),
    _count("spine_joints"),
    _count("spine_lateral_joints"),
    _count("spine_pitch_joints"),
)

_FORWARD = {
    "printed_error_share": 0.99e-9,
    "printed_error_max": 2.9e-10,
    "mended_error_max": 1e-16,
    "straight_length": 0.2925,
    "straight_length_printed": 0.2925,
}

EXAMPLES: Examples = {
    "spine_forward": [
        (_FORWARD, "by construction"),
        (_FORWARD | {"printed_error_share": 1.01e-9}, "contradicted"),
        (_FORWARD | {"printed_error_share": 0.205, "straight_length_printed": 0.2325}, "contradicted"),
    ],
    "spine_joints": [
        ({"spine_joints": 5.0}, "by construction"),
        ({"spine_joints": 4.0}, "contradicted"),
    ],
    "spine_lateral_joints": [
        ({"spine_lateral_joints": 3.0}, "by construction"),
        ({"spine_lateral_joints": 2.0}, "contradicted"),
    ],
    "spine_pitch_joints": [
        ({"spine_pitch_joints": 2.0}, "by construction"),
        ({"spine_pitch_joints": 3.0}, "contradicted"),
    ],
}
