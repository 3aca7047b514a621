"""When the claims on swimming count as what (sections II.A and IV.B, equation (20), Fig. 17)."""

from math import atan, nan

from suchus.verdict.judging import Examples
from suchus.verdict.rule import Clause, Rule, between

_DIAGONAL = 0.1
_HELD = "cycles of the tethered body after the first"
_LAST = "the last two cycles of the compared swims"
_MORE = "more than none"
_UNSWEPT = "A swim by CFD takes up to two minutes; no study runs it for other designs."


RULES = (
    Rule(
        claim="swim_tail_sine",
        experiment="swimming",
        measure="tail_sine_share",
        kind="animals",
        holds=(
            Clause("tail_sine_share", ">=", 0.95, "of the variance: a square wave, which is no sine, has 0.81 of it"),
        ),
        spread=("tail_sine_share",),
        of="the last two cycles of the free swim",
        why="Said of crocodiles. The robot's joints are commanded as sines; swimming freely, {tail_sine_share:.1%} of "
        "the variance of its tail's tip to the side is the sine of one cycle.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_body_wave",
        experiment="swimming",
        measure="wave_share",
        kind="construction",
        holds=(
            Clause("wave_share", ">=", 0.95, "of the mean square swing, as much as a sine needs to be called one"),
            Clause("wave_envelope_tip", ">", "wave_envelope_middle", "the envelope of (20) grows to the tail"),
            Clause("wave_waves_per_body", ">", 0.0, "a fish's wave runs from head to tail"),
        ),
        why="The joints are commanded to follow (20) as nearly as they can. Swimming freely, {wave_share:.1%} of the "
        "midline's mean square swing is a wave of the form (20), with {wave_waves_per_body:.2f} waves on the body; its "
        "own swing falls back by up to {envelope_dip:.0%} between the joints on its way to the tip.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_pressure_convex",
        experiment="swimming",
        measure="pressure_difference_1_quarter",
        holds=(Clause("pressure_difference_1_quarter", ">", 0.0, _MORE),),
        spread=("pressure_difference_1_quarter",),
        of=_HELD,
        why="Mean pressure along the convex side of the tail less that along the concave side, at T/4 of (20): "
        "{pressure_difference_1_quarter_low:.0f} to {pressure_difference_1_quarter_high:.0f} Pa. The convex side has "
        "the higher one in {convex_higher_share:.0%} of the cycle.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_diagonal_force",
        experiment="swimming",
        measure="force_angle_1_quarter",
        holds=(
            Clause("force_angle_1_quarter", ">=", atan(_DIAGONAL), "less aside than a tenth of forward is ahead"),
            Clause("force_angle_1_quarter", "<=", atan(1 / _DIAGONAL), "less ahead than a tenth of aside is aside"),
        ),
        spread=("force_angle_1_quarter",),
        of=_HELD,
        why="At T/4 the force is {thrust_1_quarter:.1f} N/m forward and {aside_1_quarter:.1f} N/m to the right: "
        "{force_angle_1_quarter:deg.0f} degrees from straight ahead, {force_angle_1_quarter_low:deg.0f} to "
        "{force_angle_1_quarter_high:deg.0f} over the cycles.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_pressure_falls",
        experiment="swimming",
        measure="pressure_fall",
        holds=(Clause("pressure_fall", ">", 0.0, _MORE),),
        spread=("pressure_fall",),
        of=_HELD,
        why="At T/4 the two sides differ by {pressure_difference_1_quarter:.0f} Pa, at 3T/4, which Fig. 17(c) shows, "
        "by {pressure_difference_3_quarter:.0f} Pa; over the cycles the size falls by {pressure_fall_low:.0f} to "
        "{pressure_fall_high:.0f} Pa. Between the two, at T/2, it is {pressure_difference_2_quarter:.0f} Pa.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_thrust_symmetric",
        experiment="swimming",
        measure="thrust_asymmetry",
        holds=(
            Clause("thrust_asymmetry", "<", 0.15, "of the force: less than a seventh looks alike in a picture"),
            Clause("thrust_3_quarter", ">", 0.0, "a forward thrust is forward"),
        ),
        spread=("thrust_asymmetry", "thrust_3_quarter"),
        of=_HELD,
        why="Half a cycle apart the forces are {thrust_1_quarter:.1f} and {thrust_3_quarter:.1f} N/m forward, "
        "{aside_1_quarter:.1f} and {aside_3_quarter:.1f} N/m to the right. Mirrored, they differ by "
        "{thrust_asymmetry_low:.0%} to {thrust_asymmetry_high:.0%} over the cycles.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_s_shape",
        experiment="swimming",
        measure="track_sway",
        holds=(
            Clause("track_sway", ">=", 0.01, "of the body's length: less is as straight as a line in a picture"),
            Clause("track_sway", ">", "track_noise", "beyond what of the track is no swing of one cycle"),
        ),
        spread=("track_sway",),
        of="the last cycles of the free swim",
        why="Over the last {track_cycles:.0f} cycles the centre of mass sways by {track_sway:.2%} of the body's length "
        "to either side once a cycle, and by up to {track_noise:.2%} otherwise; the snout sways by {snout_sway:.1%}.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_tail_thrust",
        experiment="swimming",
        measure="gain_tail_swim",
        holds=(
            Clause("gain_tail_swim", ">", 0.0, _MORE),
            Clause("gain_tail_swim_share", ">", 0.5, "the main part is more than half"),
        ),
        spread=("gain_tail_swim", "gain_tail_swim_share"),
        of=_LAST,
        why="The limbs are left out, here as in the article. Trunk and tail together reach {speed_trunk_and_tail:.3f} "
        "m/s, the trunk alone {speed_trunk_only:.3f}: without the swing of the tail {gain_tail_swim_share:.0%} of the "
        "speed is missing.",
        unswept=_UNSWEPT,
    ),
    Rule(
        claim="swim_spine_thrust",
        experiment="swimming",
        measure="gain_spine_swim",
        holds=(Clause("gain_spine_swim", ">", 0.0, _MORE),),
        spread=("gain_spine_swim",),
        of=_LAST,
        why="Trunk and tail together reach {speed_trunk_and_tail:.3f} m/s, the tail alone {speed_tail_only:.3f}: the "
        "swing of the spine changes the speed by {gain_spine_swim:+.3f} m/s.",
        unswept=_UNSWEPT,
    ),
)

_WHY = {
    "tail_sine_share": 0.999,
    "tail_sine_share_low": 0.999,
    "tail_sine_share_high": 0.999,
    "wave_share": 0.99,
    "wave_waves_per_body": 1.0,
    "wave_envelope_middle": 0.03,
    "wave_envelope_tip": 0.1,
    "envelope_dip": 0.1,
    "convex_higher_share": 0.5,
    "pressure_difference_1_quarter": 100.0,
    "pressure_difference_1_quarter_low": 90.0,
    "pressure_difference_1_quarter_high": 110.0,
    "pressure_difference_2_quarter": 50.0,
    "pressure_difference_3_quarter": 10.0,
    "force_angle_1_quarter": 0.8,
    "force_angle_1_quarter_low": 0.7,
    "force_angle_1_quarter_high": 0.9,
    "pressure_fall": 90.0,
    "pressure_fall_low": 80.0,
    "pressure_fall_high": 95.0,
    "thrust_asymmetry": 0.1,
    "thrust_asymmetry_low": 0.05,
    "thrust_asymmetry_high": 0.12,
    "thrust_1_quarter": 50.0,
    "thrust_3_quarter": 50.0,
    "thrust_3_quarter_low": 45.0,
    "thrust_3_quarter_high": 55.0,
    "aside_1_quarter": 40.0,
    "aside_3_quarter": -40.0,
    "track_sway": 0.02,
    "track_sway_low": 0.018,
    "track_sway_high": 0.022,
    "track_noise": 0.001,
    "track_cycles": 4.0,
    "snout_sway": 0.02,
    "speed_trunk_and_tail": 0.2,
    "speed_trunk_only": 0.02,
    "speed_tail_only": 0.15,
    "gain_tail_swim": 0.18,
    "gain_tail_swim_low": 0.17,
    "gain_tail_swim_high": 0.18,
    "gain_tail_swim_share": 0.9,
    "gain_tail_swim_share_low": 0.88,
    "gain_tail_swim_share_high": 0.92,
    "gain_spine_swim": 0.05,
    "gain_spine_swim_low": 0.04,
    "gain_spine_swim_high": 0.05,
}

EXAMPLES: Examples = {
    "swim_tail_sine": [
        (_WHY, "same sense"),
        (_WHY | {"tail_sine_share_low": 0.951}, "same sense"),
        (_WHY | {"tail_sine_share_low": 0.949}, "undecided"),
        (_WHY | between("tail_sine_share", 0.8541, 0.949), "not testable"),
    ],
    "swim_body_wave": [
        (_WHY, "by construction"),
        (_WHY | {"wave_share": 0.951}, "by construction"),
        (_WHY | {"wave_share": 0.949}, "contradicted"),
        (_WHY | {"wave_envelope_middle": 0.099}, "by construction"),
        (_WHY | {"wave_envelope_middle": 0.101}, "contradicted"),
        (_WHY | {"wave_waves_per_body": 1e-4}, "by construction"),
        (_WHY | {"wave_waves_per_body": -1e-4}, "contradicted"),
        (_WHY | {"wave_share": nan}, "not testable"),
    ],
    "swim_pressure_convex": [
        (_WHY | {"pressure_difference_1_quarter_low": 1e-4}, "reproduced"),
        (_WHY | {"pressure_difference_1_quarter_low": -1e-4}, "undecided"),
        (_WHY | between("pressure_difference_1_quarter", -0.00011, -0.0001), "contradicted"),
        (_WHY | {"pressure_difference_1_quarter": nan}, "not testable"),
    ],
    "swim_diagonal_force": [
        (_WHY, "reproduced"),
        (_WHY | {"force_angle_1_quarter_low": 0.1}, "reproduced"),  # the arc tangent of 0.1 is 0.0997
        (_WHY | {"force_angle_1_quarter_low": 0.0992}, "undecided"),
        (_WHY | between("force_angle_1_quarter", 0.08928, 0.0992), "contradicted"),
        (_WHY | {"force_angle_1_quarter_high": 1.47}, "reproduced"),  # that of 10 is 1.4711
        (_WHY | {"force_angle_1_quarter_high": 1.472}, "undecided"),
        (_WHY | between("force_angle_1_quarter", 1.472, 1.619), "contradicted"),
        (_WHY | {"force_angle_1_quarter": nan}, "not testable"),
    ],
    "swim_pressure_falls": [
        (_WHY | {"pressure_fall_low": 1e-4}, "reproduced"),
        (_WHY | {"pressure_fall_low": -1e-4}, "undecided"),
        (_WHY | between("pressure_fall", -0.00011, -0.0001), "contradicted"),
        (_WHY | {"pressure_fall": nan}, "not testable"),
    ],
    "swim_thrust_symmetric": [
        (_WHY, "reproduced"),
        (_WHY | {"thrust_asymmetry_high": 0.149}, "reproduced"),
        (_WHY | {"thrust_asymmetry_high": 0.151}, "undecided"),
        (_WHY | between("thrust_asymmetry", 0.151, 0.1661), "contradicted"),
        (_WHY | {"thrust_3_quarter_low": 1e-4}, "reproduced"),
        (_WHY | {"thrust_3_quarter_low": -1e-4}, "undecided"),
        (_WHY | between("thrust_3_quarter", -0.00011, -0.0001), "contradicted"),
        (_WHY | {"thrust_asymmetry": nan}, "not testable"),
    ],
    "swim_s_shape": [
        (_WHY, "reproduced"),
        (_WHY | {"track_sway_low": 0.0101}, "reproduced"),
        (_WHY | {"track_sway_low": 0.0099}, "undecided"),
        (_WHY | between("track_sway", 0.00891, 0.0099), "contradicted"),
        (_WHY | {"track_noise": 0.0178}, "reproduced"),
        (_WHY | {"track_noise": 0.0182}, "undecided"),
        (_WHY | {"track_noise": 0.0222}, "contradicted"),
        (_WHY | {"track_sway": nan}, "not testable"),
    ],
    "swim_tail_thrust": [
        (_WHY, "reproduced"),
        (_WHY | {"gain_tail_swim_low": 1e-4}, "reproduced"),
        (_WHY | {"gain_tail_swim_low": -1e-4}, "undecided"),
        (_WHY | between("gain_tail_swim", -0.00011, -0.0001), "contradicted"),
        (_WHY | {"gain_tail_swim_share_low": 0.505}, "reproduced"),
        (_WHY | {"gain_tail_swim_share_low": 0.495}, "undecided"),
        (_WHY | between("gain_tail_swim_share", 0.4455, 0.495), "contradicted"),
        (_WHY | {"gain_tail_swim": nan}, "not testable"),
    ],
    "swim_spine_thrust": [
        (_WHY | {"gain_spine_swim_low": 1e-4}, "reproduced"),
        (_WHY | {"gain_spine_swim_low": -1e-4}, "undecided"),
        (_WHY | between("gain_spine_swim", -0.00011, -0.0001), "contradicted"),
        (_WHY | {"gain_spine_swim": nan}, "not testable"),
    ],
}
