"""When the claims on a steady crawl count as what (section IV.A, Figs 13 to 15)."""

from math import radians

from suchus.verdict.judging import Examples
from suchus.verdict.rule import Clause, Rule, Varied, between

_REPEATS = "repeats with noise on the servos and a tenth of spread in the friction"
_STEADIER = "steadier is a smaller fluctuation"


RULES = (
    Rule(
        claim="com_fluctuation",
        experiment="crawl_stability",
        measure="com_height_pp_change",
        holds=(Clause("com_height_pp_change", "<", 0.0, _STEADIER),),
        spread=("com_height_pp_change",),
        of=_REPEATS,
        why="Highest less lowest height: {com_height_pp_coordinated:mm.1f} mm with spine and tail, "
        "{com_height_pp_limbs_only:mm.1f} mm with limbs only and the tail lying still, a change of "
        "{com_height_pp_change:+.0%} (repeats {com_height_pp_change_low:+.0%} to {com_height_pp_change_high:+.0%}); "
        "{com_height_pp_limbs_tail_lifted:mm.1f} mm with the tail in the air, a change of "
        "{com_height_pp_change_tail_lifted:+.0%}. The standard deviation changes by {com_height_std_change:+.0%}, the "
        "roll by {roll_pp_change:+.0%}.",
    ),
    Rule(
        claim="com_on_support_line",
        experiment="crawl_stability",
        measure="line_distance_max_limbs_only",
        holds=(
            Clause("line_distance_max_limbs_only", "<=", 0.024, "a foot is 24 mm wide: farther off is off the line"),
        ),
        why="Whenever two feet stand with limbs only, the projected centre of mass comes as far as "
        "{line_distance_max_limbs_only:mm.0f} mm from their line, and the robot walks on: the dragged tail or a swing "
        "foot is its third support.",
    ),
    Rule(
        claim="tilt_limbs_only",
        experiment="crawl_stability",
        measure="lean_on_two_feet_limbs_only_1200_ms",
        holds=(
            Clause("lean_limbs_only_1200_ms", ">=", radians(1.0), "the least tilt that a screenshot shows"),
            Clause("lean_limbs_only_1200_ms", ">", "lean_coordinated_1200_ms", "the article shows it of this group"),
            Clause("line_distance_limbs_only_1200_ms", ">", 0.024, "a foot's width off the line"),
        ),
        why="At 1.2 s {standing_feet_limbs_only_1200_ms:.0f} feet stand with limbs only, and the pelvis leans by "
        "{lean_limbs_only_1200_ms:deg.1f} degrees, against {lean_coordinated_1200_ms:deg.1f} with spine and tail and "
        "{lean_limbs_tail_lifted_1200_ms:deg.1f} on {standing_feet_limbs_tail_lifted_1200_ms:.0f} feet with limbs only "
        "and the tail in the air; a line of support needs two feet.",
    ),
    Rule(
        claim="tail_supports",
        experiment="crawl_stability",
        measure="tail_contact_pp_change",
        holds=(
            Clause("tail_load_share", ">=", 0.05, "what carries less than a twentieth of the weight supports nothing"),
            Clause("tail_contact_pp_change", "<", 0.0, _STEADIER),
        ),
        spread=("tail_contact_pp_change",),
        of=_REPEATS,
        why="On the ground the tail carries {tail_load_share:.0%} of the weight and changes the fluctuation by "
        "{tail_contact_pp_change:+.0%} against the same crawl with the tail in the air (repeats "
        "{tail_contact_pp_change_low:+.0%} to {tail_contact_pp_change_high:+.0%}), by "
        "{tail_contact_pp_change_limbs_only:+.0%} with the trunk straight.",
    ),
    Rule(
        claim="wagging_balances",
        experiment="crawl_stability",
        measure="wagging_pp_change",
        holds=(Clause("wagging_pp_change", "<", 0.0, _STEADIER),),
        spread=("wagging_pp_change",),
        of=_REPEATS,
        why="Against a tail that is dragged without a swing wagging changes the fluctuation by "
        "{wagging_pp_change:+.0%} (repeats {wagging_pp_change_low:+.0%} to {wagging_pp_change_high:+.0%}).",
    ),
    Rule(
        claim="spine_sinusoidal",
        experiment="crawl_stability",
        measure="spine_sine_r2",
        kind="construction",
        holds=(Clause("spine_sine_r2", ">=", 0.95, "a triangle has 0.986 of its variance in a sine, a square 0.81"),),
        why="A sine is commanded; {spine_sine_r2:.1%} of the variance of the joints' angles follow it.",
    ),
)

VARIED = Varied(claims=("tilt_limbs_only",), designs=("robot", "gait"), samples=32)

_HEIGHT = {
    "com_height_pp_change": -0.1,
    "com_height_pp_change_low": -0.2,
    "com_height_pp_change_high": -0.001,
    "com_height_pp_coordinated": 0.0038,
    "com_height_pp_limbs_only": 0.0042,
    "com_height_pp_limbs_tail_lifted": 0.004,
    "com_height_pp_change_tail_lifted": -0.05,
    "com_height_std_change": -0.1,
    "roll_pp_change": 0.1,
}
_TILT = {
    "lean_on_two_feet_limbs_only_1200_ms": radians(1.01),
    "lean_limbs_only_1200_ms": radians(1.01),
    "lean_coordinated_1200_ms": radians(1.0),
    "lean_limbs_tail_lifted_1200_ms": 0.1,
    "line_distance_limbs_only_1200_ms": 0.0241,
    "standing_feet_limbs_only_1200_ms": 2,
    "standing_feet_limbs_tail_lifted_1200_ms": 4,
}
_TAIL = {
    "tail_contact_pp_change": -0.1,
    "tail_contact_pp_change_low": -0.2,
    "tail_contact_pp_change_high": -0.001,
    "tail_contact_pp_change_limbs_only": -0.4,
    "tail_load_share": 0.0505,
}
_WAG = {"wagging_pp_change": -0.1, "wagging_pp_change_low": -0.2, "wagging_pp_change_high": -0.001}

EXAMPLES: Examples = {
    "com_fluctuation": [
        (_HEIGHT, "reproduced"),
        (_HEIGHT | {"com_height_pp_change_high": 0.001}, "undecided"),
        (_HEIGHT | between("com_height_pp_change", 0.001, 0.1), "contradicted"),
    ],
    "com_on_support_line": [
        ({"line_distance_max_limbs_only": 0.0239}, "reproduced"),
        ({"line_distance_max_limbs_only": 0.0241}, "contradicted"),
        ({"line_distance_max_limbs_only": float("nan")}, "not testable"),  # two feet never stand alone
    ],
    "tilt_limbs_only": [
        (_TILT, "reproduced"),
        (_TILT | {"lean_on_two_feet_limbs_only_1200_ms": float("nan")}, "not testable"),
        (_TILT | {"lean_limbs_only_1200_ms": radians(0.99), "lean_coordinated_1200_ms": 0.0}, "contradicted"),
        (_TILT | {"lean_coordinated_1200_ms": radians(1.02)}, "contradicted"),
        (_TILT | {"line_distance_limbs_only_1200_ms": 0.0239}, "contradicted"),
    ],
    "tail_supports": [
        (_TAIL, "reproduced"),
        (_TAIL | {"tail_load_share": 0.0495}, "contradicted"),
        (_TAIL | {"tail_contact_pp_change_high": 0.001}, "undecided"),
        (_TAIL | between("tail_contact_pp_change", 0.001, 0.1), "contradicted"),
    ],
    "wagging_balances": [
        (_WAG, "reproduced"),
        (_WAG | {"wagging_pp_change_high": 0.001}, "undecided"),
        (_WAG | between("wagging_pp_change", 0.001, 0.1), "contradicted"),
    ],
    "spine_sinusoidal": [
        ({"spine_sine_r2": 0.951}, "by construction"),
        ({"spine_sine_r2": 0.949}, "contradicted"),
    ],
}
