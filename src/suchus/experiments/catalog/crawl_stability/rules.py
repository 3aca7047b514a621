"""When the claims on a steady crawl count as what (section IV.A, Figs 13 to 15)."""

from math import nan, radians

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    DEFAULT_SPREAD_OF,
    Clause,
    ControlGroup,
    Rule,
    SmallestEffect,
    Variation,
    measure_with_interval,
)

_STEADINESS_REASON = "steadier is a smaller fluctuation"
_VISIBLE_CHANGE = SmallestEffect(
    size=0.05, why="a twentieth of a fluctuation of 4 mm is 0.2 mm, about what motion capture resolves"
)
_MAX_DUTY_CLAUSE = Clause(
    "hind_duty_limbs_tail_lifted", "<=", 0.85, "feet that hardly leave the ground walk in no gait, and rise with none"
)
_MIN_DUTY_CLAUSE = Clause("hind_duty_limbs_tail_lifted", ">=", 0.3, "feet that hardly touch the ground take no steps")
_TAIL_LIFTED_GROUP = ControlGroup(
    group="limbs_tail_lifted",
    why="Section IV.A: only the limbs move, the tail is lifted off the ground, spine and tail are fixed.",
    needs=(_MAX_DUTY_CLAUSE, _MIN_DUTY_CLAUSE),
)

RULES = (
    Rule(
        claim="com_fluctuation",
        experiment="crawl_stability",
        measure="com_height_pp_change_tail_lifted",
        definition="relative change, by spine and tail, of the highest less the lowest height of the centre of "
        "mass, from limbs only with the tail in the air",
        holds=(Clause("com_height_pp_change_tail_lifted", "<", 0.0, _STEADINESS_REASON, _VISIBLE_CHANGE),),
        control=_TAIL_LIFTED_GROUP,
        spread=("com_height_pp_change_tail_lifted", "hind_duty_limbs_tail_lifted"),
        of=DEFAULT_SPREAD_OF,
        why="Highest less lowest height: {com_height_pp_coordinated:mm.1f} mm with spine and tail, "
        "{com_height_pp_limbs_tail_lifted:mm.1f} mm with limbs only and the tail in the air, a change of "
        "{com_height_pp_change_tail_lifted:+.0%} ({com_height_pp_change_tail_lifted_low:+.0%} to "
        "{com_height_pp_change_tail_lifted_high:+.0%}) in robots as built and of "
        "{com_height_pp_change_tail_lifted_designed:+.0%} exactly as designed. That group's hind feet stand "
        "{hind_duty_limbs_tail_lifted:.0%} "
        "of the time. With limbs only and the tail lying still it is {com_height_pp_limbs_only:mm.1f} mm, a change of "
        "{com_height_pp_change:+.0%}, as designed {com_height_pp_change_designed:+.0%}. The standard deviation "
        "changes by {com_height_std_change:+.0%}, the roll by "
        "{roll_pp_change:+.0%}.",
    ),
    Rule(
        claim="com_on_support_line",
        experiment="crawl_stability",
        measure="line_distance_max_limbs_tail_lifted",
        definition="greatest distance of the centre of mass from the line of the two supporting feet, limbs only, "
        "tail in the air",
        unit="m",
        holds=(
            Clause(
                "line_distance_max_limbs_tail_lifted", "<=", 0.024, "a foot is 24 mm wide: farther off is off the line"
            ),
        ),
        control=_TAIL_LIFTED_GROUP,
        spread=("line_distance_max_limbs_tail_lifted", "hind_duty_limbs_tail_lifted"),
        of=DEFAULT_SPREAD_OF,
        why="The article speaks of two feet that carry alone. With limbs only and the tail in the air they do so for "
        "{two_feet_alone_share_limbs_tail_lifted:.0%} of the time; with the tail on the ground, which carries "
        "{tail_load_share_limbs_only:.0%} of the weight, for {two_feet_alone_share_limbs_only:.0%}.",
    ),
    Rule(
        claim="tilt_limbs_only",
        experiment="crawl_stability",
        measure="lean_on_two_feet_limbs_tail_lifted_1200_ms",
        definition="lean of the pelvis on two feet at 1.2 s, limbs only, tail in the air",
        unit="rad",
        holds=(
            Clause("lean_limbs_tail_lifted_1200_ms", ">=", radians(1.0), "the least tilt that a screenshot shows"),
            Clause(
                "lean_limbs_tail_lifted_1200_ms", ">", "lean_coordinated_1200_ms", "the article shows it of this group"
            ),
            Clause("line_distance_limbs_tail_lifted_1200_ms", ">", 0.024, "a foot's width off the line"),
        ),
        control=_TAIL_LIFTED_GROUP,
        spread=(
            "hind_duty_limbs_tail_lifted",
            "lean_on_two_feet_limbs_tail_lifted_1200_ms",
            "lean_limbs_tail_lifted_1200_ms",
            "lean_coordinated_1200_ms",
            "line_distance_limbs_tail_lifted_1200_ms",
        ),
        of=DEFAULT_SPREAD_OF,
        why="At 1.2 s {standing_feet_limbs_tail_lifted_1200_ms:.0f} feet stand with limbs only and the tail in the "
        "air "
        "and the pelvis leans by {lean_limbs_tail_lifted_1200_ms:deg.1f} degrees, against "
        "{lean_coordinated_1200_ms:deg.1f} with spine and tail and {lean_limbs_only_1200_ms:deg.1f} on "
        "{standing_feet_limbs_only_1200_ms:.0f} feet with limbs only and the tail lying still; a line of support "
        "needs "
        "two feet.",
    ),
    Rule(
        claim="tail_supports",
        experiment="crawl_stability",
        measure="tail_contact_pp_change",
        definition="relative change, by a tail on the ground, of the highest less the lowest height of the centre "
        "of mass, from the same crawl with the tail in the air",
        holds=(
            Clause(
                "tail_load_share_coordinated",
                ">=",
                0.05,
                "less than a twentieth of the weight supports nothing",
            ),
            Clause("tail_contact_pp_change", "<", 0.0, _STEADINESS_REASON, _VISIBLE_CHANGE),
        ),
        control=ControlGroup(
            group="spine_only",
            why="What lies on the ground supports: the same crawl with the tail in the air, unswung.",
        ),
        spread=("tail_contact_pp_change", "tail_load_share_coordinated"),
        of=DEFAULT_SPREAD_OF,
        why="On the ground the tail carries {tail_load_share_coordinated:.1%} of the weight "
        "({tail_load_share_coordinated_low:.1%} to {tail_load_share_coordinated_high:.1%}) and changes the "
        "fluctuation "
        "by {tail_contact_pp_change:+.0%} against the same crawl with the tail in the air ("
        "{tail_contact_pp_change_low:+.0%} to {tail_contact_pp_change_high:+.0%}; as designed "
        "{tail_contact_pp_change_designed:+.0%}), by "
        "{tail_contact_pp_change_limbs_only:+.0%} with the trunk straight.",
    ),
    Rule(
        claim="wagging_balances",
        experiment="crawl_stability",
        measure="wagging_pp_change",
        definition="relative change, by a tail that swings, of the highest less the lowest height of the centre of "
        "mass, from a tail that is dragged without a swing",
        holds=(Clause("wagging_pp_change", "<", 0.0, _STEADINESS_REASON, _VISIBLE_CHANGE),),
        control=ControlGroup(
            group="tail_still", why="What wags balances: the same crawl whose tail is dragged without it."
        ),
        spread=("wagging_pp_change",),
        of=DEFAULT_SPREAD_OF,
        why="Against a tail that is dragged without a swing wagging changes the fluctuation by "
        "{wagging_pp_change:+.0%} ({wagging_pp_change_low:+.0%} to {wagging_pp_change_high:+.0%}; as designed "
        "{wagging_pp_change_designed:+.0%}).",
    ),
    Rule(
        claim="spine_sinusoidal",
        experiment="crawl_stability",
        measure="spine_sine_r2",
        definition="share of the variance of the spine's joint angles that a sine explains",
        kind="construction",
        holds=(Clause("spine_sine_r2", ">=", 0.95, "a triangle has 0.986 of its variance in a sine, a square 0.81"),),
        why="A sine is commanded; {spine_sine_r2:.1%} of the variance of the joints' angles follow it.",
    ),
)

VARIED = Variation(claims=("tilt_limbs_only",), designs=("robot", "gait"), samples=128)

_HEIGHT = {
    "com_height_pp_change_tail_lifted": -0.1,
    "com_height_pp_change_tail_lifted_low": -0.2,
    "com_height_pp_change_tail_lifted_high": -0.051,
    **measure_with_interval("hind_duty_limbs_tail_lifted", 0.7, 0.845),
    "com_height_pp_coordinated": 0.0038,
    "com_height_pp_limbs_only": 0.0042,
    "com_height_pp_limbs_tail_lifted": 0.004,
    "com_height_pp_change": -0.05,
    "com_height_pp_change_designed": -0.1,
    "com_height_pp_change_tail_lifted_designed": -0.15,
    "com_height_std_change": -0.1,
    "roll_pp_change": 0.1,
}
_DUTY_ABOVE_LIMIT = measure_with_interval("hind_duty_limbs_tail_lifted", 0.851, 1.0)
_DUTY_ACROSS_LIMIT = measure_with_interval("hind_duty_limbs_tail_lifted", 0.8, 0.851)
_DUTY_ABOVE_LEAST = measure_with_interval("hind_duty_limbs_tail_lifted", 0.301, 0.8)
_DUTY_ACROSS_LEAST = measure_with_interval("hind_duty_limbs_tail_lifted", 0.299, 0.8)
_DUTY_BELOW_LEAST = measure_with_interval("hind_duty_limbs_tail_lifted", 0.1, 0.299)
_LINE = {
    **measure_with_interval("hind_duty_limbs_tail_lifted", 0.7, 0.845),
    "two_feet_alone_share_limbs_only": 0.0,
    "two_feet_alone_share_limbs_tail_lifted": 0.0,
    "tail_load_share_limbs_only": 0.05,
}
_ON_LINE = _LINE | measure_with_interval("line_distance_max_limbs_tail_lifted", 0.01, 0.0239)
_TILT = {
    **measure_with_interval("hind_duty_limbs_tail_lifted", 0.7, 0.845),
    **measure_with_interval("lean_on_two_feet_limbs_tail_lifted_1200_ms", radians(1.01), radians(1.1)),
    **measure_with_interval("lean_limbs_tail_lifted_1200_ms", radians(1.01), radians(1.1)),
    **measure_with_interval("lean_coordinated_1200_ms", radians(0.9), radians(1.0)),
    "lean_limbs_only_1200_ms": 0.1,
    **measure_with_interval("line_distance_limbs_tail_lifted_1200_ms", 0.0241, 0.03),
    "standing_feet_limbs_tail_lifted_1200_ms": 2,
    "standing_feet_limbs_only_1200_ms": 4,
}
_TAIL = {
    "tail_contact_pp_change": -0.1,
    "tail_contact_pp_change_low": -0.2,
    "tail_contact_pp_change_high": -0.051,
    "tail_contact_pp_change_limbs_only": -0.4,
    "tail_contact_pp_change_designed": -0.15,
    **measure_with_interval("tail_load_share_coordinated", 0.0505, 0.06),
}
_WAG = {
    "wagging_pp_change_designed": -0.1,
    "wagging_pp_change": -0.1,
    "wagging_pp_change_low": -0.2,
    "wagging_pp_change_high": -0.051,
}

EXAMPLES: Examples = {
    "com_fluctuation": [
        (_HEIGHT, "reproduced"),
        (_HEIGHT | _DUTY_ABOVE_LEAST, "reproduced"),
        (_HEIGHT | _DUTY_ACROSS_LEAST, "undecided"),
        (_HEIGHT | _DUTY_BELOW_LEAST, "not testable"),
        (_HEIGHT | {"com_height_pp_change_tail_lifted_high": -0.049}, "undecided"),
        (_HEIGHT | measure_with_interval("com_height_pp_change_tail_lifted", -0.049, 0.1), "contradicted"),
        (_HEIGHT | _DUTY_ACROSS_LIMIT, "undecided"),
        (
            _HEIGHT | measure_with_interval("com_height_pp_change_tail_lifted", -0.049, 0.1) | _DUTY_ACROSS_LIMIT,
            "undecided",
        ),
        (_HEIGHT | _DUTY_ABOVE_LIMIT, "not testable"),
        (
            _HEIGHT | measure_with_interval("com_height_pp_change_tail_lifted", -0.049, 0.1) | _DUTY_ABOVE_LIMIT,
            "not testable",
        ),
    ],
    "com_on_support_line": [
        (_ON_LINE, "reproduced"),
        (_ON_LINE | _DUTY_ABOVE_LEAST, "reproduced"),
        (_ON_LINE | _DUTY_ACROSS_LEAST, "undecided"),
        (_ON_LINE | _DUTY_BELOW_LEAST, "not testable"),
        (_LINE | measure_with_interval("line_distance_max_limbs_tail_lifted", 0.01, 0.0241), "undecided"),
        (_LINE | measure_with_interval("line_distance_max_limbs_tail_lifted", 0.0241, 0.03), "contradicted"),
        (
            _LINE | measure_with_interval("line_distance_max_limbs_tail_lifted", nan, nan),
            "not testable",
        ),  # never on two feet alone
        (_ON_LINE | _DUTY_ACROSS_LIMIT, "undecided"),
        (_ON_LINE | _DUTY_ABOVE_LIMIT, "not testable"),
    ],
    "tilt_limbs_only": [
        (_TILT, "reproduced"),
        (_TILT | _DUTY_ABOVE_LEAST, "reproduced"),
        (_TILT | _DUTY_ACROSS_LEAST, "undecided"),
        (_TILT | _DUTY_BELOW_LEAST, "not testable"),
        (_TILT | {"lean_on_two_feet_limbs_tail_lifted_1200_ms": nan}, "not testable"),
        (
            _TILT
            | measure_with_interval("lean_limbs_tail_lifted_1200_ms", radians(0.9), radians(0.99))
            | measure_with_interval("lean_coordinated_1200_ms", 0.0, 0.0),
            "contradicted",
        ),
        (_TILT | measure_with_interval("lean_limbs_tail_lifted_1200_ms", radians(0.99), radians(1.02)), "undecided"),
        (_TILT | measure_with_interval("lean_coordinated_1200_ms", radians(0.9), radians(1.02)), "undecided"),
        (_TILT | measure_with_interval("lean_coordinated_1200_ms", radians(1.12), radians(1.2)), "contradicted"),
        (_TILT | measure_with_interval("line_distance_limbs_tail_lifted_1200_ms", 0.0239, 0.03), "undecided"),
        (_TILT | measure_with_interval("line_distance_limbs_tail_lifted_1200_ms", 0.01, 0.0239), "contradicted"),
        (_TILT | _DUTY_ACROSS_LIMIT, "undecided"),
        (_TILT | _DUTY_ABOVE_LIMIT, "not testable"),
        (
            _TILT | measure_with_interval("line_distance_limbs_tail_lifted_1200_ms", 0.01, 0.0239) | _DUTY_ABOVE_LIMIT,
            "not testable",
        ),
    ],
    "tail_supports": [
        (_TAIL, "reproduced"),
        (_TAIL | measure_with_interval("tail_load_share_coordinated", 0.0495, 0.06), "undecided"),
        (_TAIL | measure_with_interval("tail_load_share_coordinated", 0.04, 0.0495), "contradicted"),
        (_TAIL | {"tail_contact_pp_change_high": -0.049}, "undecided"),
        (_TAIL | measure_with_interval("tail_contact_pp_change", -0.049, 0.1), "contradicted"),
    ],
    "wagging_balances": [
        (_WAG, "reproduced"),
        (_WAG | {"wagging_pp_change_high": -0.049}, "undecided"),
        (_WAG | measure_with_interval("wagging_pp_change", -0.049, 0.1), "contradicted"),
    ],
    "spine_sinusoidal": [
        ({"spine_sine_r2": 0.951}, "by construction"),
        ({"spine_sine_r2": 0.949}, "contradicted"),
    ],
}
