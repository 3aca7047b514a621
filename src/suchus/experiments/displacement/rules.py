"""When the claims on the displacement count as what (section IV.B, Fig. 16)."""

from suchus.verdict.rule import Band, Clause, Rule

_REPEATS = "repeats with noise on the servos and a tenth of spread in the friction"
_FREE = (
    "Leg stroke and trunk bend are free in the article and were chosen so that its two displacements come out; "
    "the tail's pitch is free too and moves this one from {forward_over_tail_pitch_low:.2f} to "
    "{forward_over_tail_pitch_high:.2f} m over its plausible range."
)
_FORWARD = "forward is forward"
_EACH = "in each of the repeats, not only in their mean"


def _repeated(measure: str) -> Band:
    return Band(low=f"{measure}_low", high=f"{measure}_high", of=_REPEATS)


RULES = (
    Rule(
        claim="displacement_coordinated",
        experiment="displacement",
        measure="forward_coordinated",
        kind="fitted",
        holds=(Clause("forward_coordinated_low", ">", 0.0, _FORWARD),),
        band=_repeated("forward_coordinated"),
        why=_FREE,
    ),
    Rule(
        claim="displacement_limbs_only",
        experiment="displacement",
        measure="forward_limbs_only",
        kind="fitted",
        holds=(
            Clause("forward_limbs_only_low", ">", 0.0, _FORWARD),
            Clause("hind_duty_limbs_only", "<=", 0.85, "feet that hardly leave the ground walk in no gait"),
            Clause("two_feet_share_limbs_only", ">=", 0.3, "a diagonal gait stands on two feet for part of its cycle"),
        ),
        band=_repeated("forward_limbs_only"),
        why="The same legs with the trunk straight and the tail lying still; hind feet stand "
        "{hind_duty_limbs_only:.0%} of the time and are lifted by {hind_clearance_limbs_only:mm.0f} mm. With the tail "
        "in the air it is {forward_limbs_tail_lifted:.2f} m, and the hind feet stand "
        "{hind_duty_limbs_tail_lifted:.0%} of the time: they never walk.",
    ),
    Rule(
        claim="displacement_ratio",
        experiment="displacement",
        measure="forward_ratio",
        kind="fitted",
        holds=(Clause("forward_ratio_low", ">", 1.0, _EACH),),
        band=_repeated("forward_ratio"),
        why="Both displacements were fitted, and so is their ratio: other strokes and bends give "
        "{ratio_on_map_low:.1f} to {ratio_on_map_high:.1f}. Against the control group with its tail in the air it is "
        "{forward_ratio_tail_lifted:.2f}.",
    ),
    Rule(
        claim="spine_swing",
        experiment="displacement",
        measure="gain_spine_swing",
        holds=(Clause("gain_spine_swing_low", ">", 0.0, _EACH),),
        band=_repeated("gain_spine_swing"),
        why="Against the same crawl with a straight trunk: the tail drags and swings in both. Repeats give "
        "{gain_spine_swing_low:.2f} to {gain_spine_swing_high:.2f} m.",
    ),
    Rule(
        claim="tail_swing",
        experiment="displacement",
        measure="gain_tail_swing",
        holds=(Clause("gain_tail_swing_low", ">", 0.0, _EACH),),
        band=_repeated("gain_tail_swing"),
        why="Against the same crawl whose tail drags without a swing the swing changes the displacement by "
        "{gain_tail_swing:mm+.0f} mm, {gain_tail_swing_low:mm+.0f} to {gain_tail_swing_high:mm+.0f} mm in the repeats; "
        "lying on the ground instead of in the air changes it by {gain_tail_contact:mm+.0f} mm.",
    ),
    Rule(
        claim="bending_lengthens_stride",
        experiment="displacement",
        measure="gain_spine_swing",
        kind="animals",
        holds=(Clause("gain_spine_swing_low", ">", 0.0, _EACH),),
        band=_repeated("gain_spine_swing"),
        why="Said of crocodiles. The robot does the same: at equal strokes of the legs its bending trunk changes the "
        "displacement by {gain_spine_swing:+.2f} m.",
    ),
)
