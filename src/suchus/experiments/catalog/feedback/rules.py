"""When the claims on the three feedback rules and the shared variables count as what (section III.D)."""

from math import nan

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import (
    PRINTED_DISPLACEMENT,
    Clause,
    ControlGroup,
    Rule,
    Variation,
    measure_with_interval,
)

_UNDISTURBED_REASON = "a rule must not spoil a walk that is right: 3 % and no more"
_STARTS = "random starts, each of a robot of its own that is built of the design"
_GROWTH_REASON = "an error that grows from cycle to cycle by more than its scatter is not stable"

RULES = (
    Rule(
        claim="feedback_rules",
        experiment="feedback",
        measure="converged_cross_load",
        definition="share of starts at random phases from which the limbs find the gait",
        holds=(
            Clause("converged_cross_load", ">=", 0.95, "limbs: of random starts, all but one in twenty"),
            Clause("converged_wrong_sign", "<", 0.05, "limbs: the same rule with the wrong sign must fail"),
            Clause("distortion", "<=", 0.03, f"limbs: {_UNDISTURBED_REASON}"),
            Clause("spine_lacking_spine", "<", "spine_lacking_open", "spine: one stuck, less of the bend is missing"),
            Clause("spine_lacking_growth", "<=", 1.05, f"spine: {_GROWTH_REASON}"),
            Clause("kept_undisturbed_spine", ">=", 0.97, f"spine: {_UNDISTURBED_REASON}"),
            Clause("tail_load_tail", "<", "tail_load_open", "tail: uphill its servo holds less"),
            Clause("tail_pitch_drift", "<=", 0.035, "tail: two degrees from one cycle to the next are settled"),
            Clause("kept_undisturbed_tail", ">=", 0.97, f"tail: {_UNDISTURBED_REASON}"),
            Clause("locked_spine_loss_closed", "<", "locked_spine_loss_open", "all three together still help"),
        ),
        control=ControlGroup(group="open", why="What a rule does is what the same robot does not do without it."),
        spread=("converged_cross_load", "converged_wrong_sign"),
        of=_STARTS,
        why="Limbs: from random phases {converged_cross_load:.0%} find the gait, 90 % of them within "
        "{cycles_to_converge:.1f} cycles; {converged_off:.0%} without feedback, {converged_own_load:.0%} if every "
        "limb feels its own foot alone, {converged_wrong_sign:.0%} with the wrong sign. Spine: with a stuck joint "
        "{spine_lacking_spine:deg.1f} degrees of the bend are missing instead of {spine_lacking_open:deg.1f}. Tail: "
        "uphill its servo holds {tail_load_tail:.2f} N m instead of {tail_load_open:.2f}, its pitch moving by "
        "{tail_pitch_drift:deg.1f} degrees in the last cycle. All three: a stuck spine joint costs "
        "{locked_spine_loss_closed:.0%} of the displacement instead of {locked_spine_loss_open:.0%}; a push still "
        "turns the robot by {heading_push_closed:deg.0f} degrees ({heading_push_open:deg.0f} without feedback), a "
        "limp front yaw by {heading_limp_yaw_closed:deg.0f} ({heading_limp_yaw_open:deg.0f}).",
    ),
    Rule(
        claim="shared_variables",
        experiment="feedback",
        measure="way_gain_shared",
        definition="displacement in a cycle after a random start, with shared phases less without",
        unit="m",
        holds=(
            Clause("way_gain_shared", ">", 0.0, "a coordinated body gets farther in a cycle", PRINTED_DISPLACEMENT),
            Clause("way_shared_least", ">", "way_isolated_least", "from the worst start too"),
        ),
        control=ControlGroup(
            group="isolated", why="What is shared helps against the same robot whose parts hear nothing."
        ),
        spread=("way_gain_shared",),
        of=_STARTS,
        why="After random starts a cycle gains {way_shared:.2f} m (at least {way_shared_least:.2f}) where spine and "
        "tail hear of the limbs' phases, and {way_isolated:.2f} m (at least {way_isolated_least:.2f}) where each "
        "follows the clock for itself: {way_gain_shared:+.3f} m ({way_gain_shared_low:+.3f} to "
        "{way_gain_shared_high:+.3f}).",
    ),
)

VARIED = Variation(
    claims=("feedback_rules", "shared_variables"),
    designs=("robot", "gait"),
    settings={"extent": "verdicts", "judged_cycles": 6},  # fewer than 72 starts could not reproduce the first claim
    samples=16,
)

_RULES_EXAMPLE = {
    "converged_cross_load": 1.0,
    "converged_cross_load_low": 1.0,
    "converged_cross_load_high": 1.0,
    "cycles_to_converge": 2.3,
    "converged_off": 0.0,
    "converged_own_load": 0.9,
    **measure_with_interval("converged_wrong_sign", 0.0, 0.0),
    "distortion": 0.01,
    "spine_lacking_spine": 0.2,
    "spine_lacking_open": 0.5,
    "spine_lacking_growth": 1.0,
    "kept_undisturbed_spine": 1.0,
    "tail_load_tail": 0.1,
    "tail_load_open": 0.5,
    "tail_pitch_drift": 0.01,
    "kept_undisturbed_tail": 1.0,
    "locked_spine_loss_closed": 0.15,
    "locked_spine_loss_open": 0.3,
    "heading_push_closed": 0.4,
    "heading_push_open": 0.6,
    "heading_limp_yaw_closed": 2.0,
    "heading_limp_yaw_open": 2.0,
    **measure_with_interval("way_gain_shared", 0.01, 0.1),
    "way_shared": 0.36,
    "way_shared_least": 0.33,
    "way_isolated": 0.3,
    "way_isolated_least": 0.1,
}

EXAMPLES: Examples = {
    "feedback_rules": [
        (_RULES_EXAMPLE, "reproduced"),
        (_RULES_EXAMPLE | measure_with_interval("converged_cross_load", 0.951, 1.0), "reproduced"),
        (_RULES_EXAMPLE | measure_with_interval("converged_cross_load", 0.949, 1.0), "undecided"),
        (_RULES_EXAMPLE | measure_with_interval("converged_cross_load", 0.9, 0.949), "contradicted"),
        (_RULES_EXAMPLE | measure_with_interval("converged_wrong_sign", 0.0, 0.0499), "reproduced"),
        (_RULES_EXAMPLE | measure_with_interval("converged_wrong_sign", 0.0, 0.0501), "undecided"),
        (_RULES_EXAMPLE | measure_with_interval("converged_wrong_sign", 0.0501, 0.1), "contradicted"),
        (_RULES_EXAMPLE | {"distortion": 0.0299}, "reproduced"),
        (_RULES_EXAMPLE | {"distortion": 0.0301}, "contradicted"),
        (_RULES_EXAMPLE | {"spine_lacking_spine": 0.495}, "reproduced"),
        (_RULES_EXAMPLE | {"spine_lacking_spine": 0.505}, "contradicted"),
        (_RULES_EXAMPLE | {"spine_lacking_growth": 1.049}, "reproduced"),
        (_RULES_EXAMPLE | {"spine_lacking_growth": 1.051}, "contradicted"),
        (_RULES_EXAMPLE | {"kept_undisturbed_spine": 0.971}, "reproduced"),
        (_RULES_EXAMPLE | {"kept_undisturbed_spine": 0.969}, "contradicted"),
        (_RULES_EXAMPLE | {"tail_load_tail": 0.495}, "reproduced"),
        (_RULES_EXAMPLE | {"tail_load_tail": 0.505}, "contradicted"),
        (_RULES_EXAMPLE | {"tail_pitch_drift": 0.0349}, "reproduced"),
        (_RULES_EXAMPLE | {"tail_pitch_drift": 0.0351}, "contradicted"),
        (_RULES_EXAMPLE | {"kept_undisturbed_tail": 0.971}, "reproduced"),
        (_RULES_EXAMPLE | {"kept_undisturbed_tail": 0.969}, "contradicted"),
        (_RULES_EXAMPLE | {"locked_spine_loss_closed": 0.298}, "reproduced"),
        (_RULES_EXAMPLE | {"locked_spine_loss_closed": 0.302}, "contradicted"),
        (_RULES_EXAMPLE | {"converged_cross_load": nan}, "not testable"),
    ],
    "shared_variables": [
        (_RULES_EXAMPLE, "reproduced"),
        (_RULES_EXAMPLE | measure_with_interval("way_gain_shared", 0.0051, 0.1), "reproduced"),
        (_RULES_EXAMPLE | measure_with_interval("way_gain_shared", 0.0049, 0.1), "undecided"),
        (_RULES_EXAMPLE | measure_with_interval("way_gain_shared", -0.1, 0.0049), "contradicted"),
        (_RULES_EXAMPLE | {"way_isolated_least": 0.327}, "reproduced"),
        (_RULES_EXAMPLE | {"way_isolated_least": 0.333}, "contradicted"),
        (_RULES_EXAMPLE | measure_with_interval("way_gain_shared", nan, nan), "not testable"),
    ],
}
