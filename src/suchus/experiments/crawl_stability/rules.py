"""When the claims on a steady crawl count as what (section IV.A, Figs 13 to 15)."""

from math import nan, radians

from suchus.verdict.judging import Examples
from suchus.verdict.rule import Clause, Rule, Varied, between

_BUILT = "robots built of the design, with the errors of their servos, masses and friction"
_STEADIER = "steadier is a smaller fluctuation"


RULES = (
    Rule(
        claim="com_fluctuation",
        experiment="crawl_stability",
        measure="com_height_pp_change",
        holds=(Clause("com_height_pp_change", "<", 0.0, _STEADIER),),
        spread=("com_height_pp_change",),
        of=_BUILT,
        why="Highest less lowest height: {com_height_pp_coordinated:mm.1f} mm with spine and tail, "
        "{com_height_pp_limbs_only:mm.1f} mm with limbs only and the tail lying still, a change of "
        "{com_height_pp_change:+.0%} ({com_height_pp_change_low:+.0%} to {com_height_pp_change_high:+.0%}); "
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
        spread=("line_distance_max_limbs_only",),
        of=_BUILT,
        why="The article speaks of two feet that carry alone. With limbs only they do so for "
        "{two_feet_alone_share_limbs_only:.0%} of the time, since the tail lies on the ground and carries "
        "{tail_load_share_limbs_only:.0%} of the weight; with the tail in the air for "
        "{two_feet_alone_share_limbs_tail_lifted:.0%}.",
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
        spread=(
            "lean_on_two_feet_limbs_only_1200_ms",
            "lean_limbs_only_1200_ms",
            "lean_coordinated_1200_ms",
            "line_distance_limbs_only_1200_ms",
        ),
        of=_BUILT,
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
            Clause(
                "tail_load_share_coordinated",
                ">=",
                0.05,
                "less than a twentieth of the weight supports nothing",
            ),
            Clause("tail_contact_pp_change", "<", 0.0, _STEADIER),
        ),
        spread=("tail_contact_pp_change", "tail_load_share_coordinated"),
        of=_BUILT,
        why="On the ground the tail carries {tail_load_share_coordinated:.1%} of the weight "
        "({tail_load_share_coordinated_low:.1%} to {tail_load_share_coordinated_high:.1%}) and changes the fluctuation "
        "by {tail_contact_pp_change:+.0%} against the same crawl with the tail in the air ("
        "{tail_contact_pp_change_low:+.0%} to {tail_contact_pp_change_high:+.0%}), by "
        "{tail_contact_pp_change_limbs_only:+.0%} with the trunk straight.",
    ),
    Rule(
        claim="wagging_balances",
        experiment="crawl_stability",
        measure="wagging_pp_change",
        holds=(Clause("wagging_pp_change", "<", 0.0, _STEADIER),),
        spread=("wagging_pp_change",),
        of=_BUILT,
        why="Against a tail that is dragged without a swing wagging changes the fluctuation by "
        "{wagging_pp_change:+.0%} ({wagging_pp_change_low:+.0%} to {wagging_pp_change_high:+.0%}).",
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
_LINE = {
    "two_feet_alone_share_limbs_only": 0.0,
    "two_feet_alone_share_limbs_tail_lifted": 0.0,
    "tail_load_share_limbs_only": 0.05,
}
_TILT = {
    **between("lean_on_two_feet_limbs_only_1200_ms", radians(1.01), radians(1.1)),
    **between("lean_limbs_only_1200_ms", radians(1.01), radians(1.1)),
    **between("lean_coordinated_1200_ms", radians(0.9), radians(1.0)),
    "lean_limbs_tail_lifted_1200_ms": 0.1,
    **between("line_distance_limbs_only_1200_ms", 0.0241, 0.03),
    "standing_feet_limbs_only_1200_ms": 2,
    "standing_feet_limbs_tail_lifted_1200_ms": 4,
}
_TAIL = {
    "tail_contact_pp_change": -0.1,
    "tail_contact_pp_change_low": -0.2,
    "tail_contact_pp_change_high": -0.001,
    "tail_contact_pp_change_limbs_only": -0.4,
    **between("tail_load_share_coordinated", 0.0505, 0.06),
}
_WAG = {"wagging_pp_change": -0.1, "wagging_pp_change_low": -0.2, "wagging_pp_change_high": -0.001}

EXAMPLES: Examples = {
    "com_fluctuation": [
        (_HEIGHT, "reproduced"),
        (_HEIGHT | {"com_height_pp_change_high": 0.001}, "undecided"),
        (_HEIGHT | between("com_height_pp_change", 0.001, 0.1), "contradicted"),
    ],
    "com_on_support_line": [
        (_LINE | between("line_distance_max_limbs_only", 0.01, 0.0239), "reproduced"),
        (_LINE | between("line_distance_max_limbs_only", 0.01, 0.0241), "undecided"),
        (_LINE | between("line_distance_max_limbs_only", 0.0241, 0.03), "contradicted"),
        (_LINE | between("line_distance_max_limbs_only", nan, nan), "not testable"),  # two feet never carry alone
    ],
    "tilt_limbs_only": [
        (_TILT, "reproduced"),
        (_TILT | {"lean_on_two_feet_limbs_only_1200_ms": nan}, "not testable"),
        (
            _TILT
            | between("lean_limbs_only_1200_ms", radians(0.9), radians(0.99))
            | between("lean_coordinated_1200_ms", 0.0, 0.0),
            "contradicted",
        ),
        (_TILT | between("lean_limbs_only_1200_ms", radians(0.99), radians(1.02)), "undecided"),
        (_TILT | between("lean_coordinated_1200_ms", radians(0.9), radians(1.02)), "undecided"),
        (_TILT | between("lean_coordinated_1200_ms", radians(1.12), radians(1.2)), "contradicted"),
        (_TILT | between("line_distance_limbs_only_1200_ms", 0.0239, 0.03), "undecided"),
        (_TILT | between("line_distance_limbs_only_1200_ms", 0.01, 0.0239), "contradicted"),
    ],
    "tail_supports": [
        (_TAIL, "reproduced"),
        (_TAIL | between("tail_load_share_coordinated", 0.0495, 0.06), "undecided"),
        (_TAIL | between("tail_load_share_coordinated", 0.04, 0.0495), "contradicted"),
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
