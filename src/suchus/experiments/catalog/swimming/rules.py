"""When claims on swimming count as what (sections II.A and IV.B, equation (20), Fig. 17), and which models say it."""

from collections.abc import Mapping, Sequence
from math import atan, nan

from suchus.article.verdict.judging import Examples, Word
from suchus.article.verdict.rule import Clause, ControlGroup, Rule, Rung, SmallestEffect, Variation

LADDER: Mapping[str, str] = {
    "resistive": "resistive theory",
    "reactive": "reactive theory",
    "slice": "slice, midline as commanded",
    "slice_taken": "slice, midline as the joints take it",
    "sections": "six degrees of freedom on sections",
    "space": "three dimensions",
}
"""Labels of the rungs by name."""
MAX_SETTLED_SPREAD = 0.1
"""Greatest relative spread of halves and starting sides with which a rung counts for a verdict [-]."""
MIN_VISIBLE_SWAY = 0.01
"""Least sway of the centre of mass that is visible in a picture [body length]."""
_DIAGONAL = 0.1
_VISIBLE_SHARE = SmallestEffect(size=_DIAGONAL, why="less than a tenth of the mean size is none in a picture")
_LEAST_WAVE = SmallestEffect(size=0.1, why="less than a tenth of a wave on the body is a swing without a wave")
_LEAST_GAIN = SmallestEffect(size=0.05, why="half of what halves and starting sides of a settled swim may differ by")

_RESOLVED = {
    "slice": "It resolves the wake, as of a plate without ends, in water as thick as the grid needs.",
    "slice_taken": "The same, on the midline that the joints take where the water bends them.",
    "space": "It resolves the wake of the body itself, in water as thick as the grid needs.",
}
_JOINTS = "Joints, cable, roll and heave are free; every section feels its own motion, without a wake."
_MEANS = "It gives the mean force of a cycle, and neither pressures nor an instant."
_COMMANDED = "It swings as commanded: what is asked was put in."


def _rungs(cannot: Mapping[str, str], can: Mapping[str, str]) -> tuple[Rung, ...]:
    """Return the ladder with the reasons why rungs cannot carry a claim, and why the others can."""
    reasons = {**_RESOLVED, "sections": _JOINTS, **can, **cannot}
    return tuple(
        Rung(name=name, model=model, why=reasons[name], carries=name not in cannot) for name, model in LADDER.items()
    )


_SPEEDS = {
    "resistive": "It drags every section by its own velocity, which drives a body along which a wave runs.",
    "reactive": "It counts the momentum that the tail sheds, and how the trunk moves the tail.",
}
_OF_TAIL = _rungs({}, _SPEEDS)
_OF_SPINE = _rungs(
    {
        "resistive": "Drag alone gives a tail with one input no mean thrust, since it comes back the way it went: of "
        "the article's robot, whose tail hangs on one cable, the answer would be assumed."
    },
    _SPEEDS,
)
_OF_TRACK = _rungs(
    {"resistive": "It takes sway and turn of the body from the reactive theory and would say the same twice."},
    {"reactive": "It balances the lateral momentum of body and water, as a sine."},
)
_OF_WAVE = _rungs({"resistive": _COMMANDED, "reactive": _COMMANDED}, {})
_AT_AN_INSTANT = _rungs(
    {
        "resistive": _MEANS,
        "reactive": _MEANS,
        "sections": "It swims free and knows no pressure; the claim is read of a body that is held at its snout.",
    },
    {"space": f"{_RESOLVED['space']} The pressures of the two sides are read as the push on the tail over its side."},
)

RULES = (
    Rule(
        claim="swim_tail_sine",
        experiment="swimming",
        measure="tail_sine_share",
        definition="part of the variance of the tail's tip to the side that the sine of one cycle explains",
        kind="animals",
        holds=(
            Clause("tail_sine_share", ">=", 0.95, "of the variance: a square wave, which is no sine, has 0.81 of it"),
        ),
        rungs=_OF_WAVE,
        form=".1%",
        why="Said of crocodiles. The robot's joints are commanded as sines; measured is which share of the variance "
        "of "
        "the free tail's tip to the side is the sine of one cycle.",
    ),
    Rule(
        claim="swim_body_wave",
        experiment="swimming",
        measure="wave_share",
        definition="part of the midline's mean square swing that the nearest wave of (20) explains",
        kind="construction",
        holds=(
            Clause("wave_share", ">=", 0.95, "of the mean square swing, as much as a sine needs to be called one"),
            Clause("wave_envelope_tip", ">", "wave_envelope_middle", "the envelope of (20) grows to the tail"),
            Clause("wave_waves_per_body", ">", 0.0, "a fish's wave runs from head to tail", _LEAST_WAVE),
        ),
        rungs=_OF_WAVE,
        form=".1%",
        why="The joints are commanded to follow (20) as nearly as they can; measured is which share of the free "
        "midline's mean square swing is the nearest wave of the form (20).",
    ),
    Rule(
        claim="swim_pressure_convex",
        experiment="swimming",
        measure="pressure_convex_share",
        definition="mean pressure on the tail's convex side less that on its concave side at T/4, over the mean "
        "size of the difference",
        holds=(Clause("pressure_convex_share", ">", 0.0, "in both halves, started to either side", _VISIBLE_SHARE),),
        rungs=_AT_AN_INSTANT,
        form="+.0%",
        why="Mean pressure along the convex side of the tail less that along the concave side at T/4 of (20), over "
        "the "
        "mean size of this difference at the quarters of the cycle.",
    ),
    Rule(
        claim="swim_diagonal_force",
        experiment="swimming",
        measure="force_angle_1_quarter",
        definition="angle between the force at T/4 and straight ahead",
        unit="rad",
        holds=(
            Clause("force_angle_1_quarter", ">=", atan(_DIAGONAL), "less aside than a tenth of forward is ahead"),
            Clause("force_angle_1_quarter", "<=", atan(1 / _DIAGONAL), "less ahead than a tenth of aside is aside"),
        ),
        rungs=_AT_AN_INSTANT,
        form="deg.0f",
        why="The angle between the force at T/4 and straight ahead.",
    ),
    Rule(
        claim="swim_pressure_falls",
        experiment="swimming",
        measure="pressure_fall_share",
        definition="difference of pressure across the tail at T/4 less that at 3T/4, over the mean size of the "
        "difference",
        kind="construction",
        holds=(
            Clause("pressure_fall_share", ">=", _DIAGONAL, "of the difference itself: less is no fall in a picture"),
        ),
        rungs=_AT_AN_INSTANT,
        form="+.0%",
        why="By how much the two sides of the tail differ less at 3T/4, which Fig. 17(c) shows, than at T/4, over the "
        "mean size of their difference. A swim that starts to the other side is the mirror image of this one: it does "
        "at T/4 what this one does at 3T/4, so that a swim that has forgotten its start has no such fall: symmetry "
        "decides, and no run is evidence.",
    ),
    Rule(
        claim="swim_thrust_symmetric",
        experiment="swimming",
        measure="thrust_3_quarter_share",
        definition="force forward at 3T/4, over the mean size of the force at the quarters of the cycle",
        holds=(
            Clause("thrust_asymmetry", "<", 0.15, "of the force: less than a seventh looks alike in a picture"),
            Clause("thrust_3_quarter_share", ">", 0.0, "a forward thrust is forward", _VISIBLE_SHARE),
        ),
        rungs=_AT_AN_INSTANT,
        form="+.0%",
        why="The force forward at 3T/4, over the mean size of the force at the quarters. It mirrors the one at T/4 "
        "in every swim that has forgotten its start; whether it points forward is what decides.",
    ),
    Rule(
        claim="swim_s_shape",
        experiment="swimming",
        measure="track_sway",
        definition="sway of the centre of mass to either side, over the body's length",
        holds=(
            Clause(
                "track_sway", ">=", MIN_VISIBLE_SWAY, "of the body's length: less is as straight as a line in a picture"
            ),
            Clause("track_sway", ">", "track_noise", "beyond what of the track is no swing of one cycle"),
        ),
        rungs=_OF_TRACK,
        form=".1%",
        why="By how much of the body's length the centre of mass sways to either side once a cycle.",
    ),
    Rule(
        claim="swim_tail_thrust",
        experiment="swimming",
        measure="gain_tail_share",
        definition="part of the free speed that is missing without the swing of the tail",
        holds=(Clause("gain_tail_share", ">", 0.5, "the main part is more than half"),),
        control=ControlGroup(
            group="trunk only", why="What the tail gives is what the same swim lacks without its swing."
        ),
        rungs=_OF_TAIL,
        form="+.0%",
        why="The share of the free speed that is missing without the swing of the tail; limbs are left out, here as "
        "in "
        "the article.",
    ),
    Rule(
        claim="swim_spine_thrust",
        experiment="swimming",
        measure="gain_spine_share",
        definition="part of the free speed that is missing without the swing of the spine",
        holds=(Clause("gain_spine_share", ">", 0.0, "more than nothing, in both halves", _LEAST_GAIN),),
        control=ControlGroup(
            group="tail only", why="What the spine gives is what the same swim lacks without its swing."
        ),
        rungs=_OF_SPINE,
        form="+.0%",
        why="The share of the free speed that is missing without the swing of the spine; negative where it is a loss.",
    ),
)

VARIED = Variation(
    claims=tuple(rule.claim for rule in RULES),
    over={
        "cells": (48, 96, "The article does not say how fine its grid is: from about half of ours to a fifth more."),
        "space_cells": (48, 72, "It does not say so in three dimensions either, where finer ones take hours."),
        "reynolds": (
            2000.0,
            7000.0,
            "The article gives no viscosity: up to ours, the greatest that our grids resolve.",
        ),
        "cycles": (10, 14, "It does not say which cycle its figure shows; fewer than ten are not judged."),
        "frequency": (0.5, 2.0, "Equation (20) has no frequency; theories and sections, in real water, feel it."),
    },
    designs=("robot",),
    settings={"readings": (), "tow": 1.5, "frames": 1, "arm_cycles": 2},
    samples=16,
)


def _ladder_measures(
    values: Mapping[str, float], *, spread: float = 0.01, rungs: Sequence[str] = tuple(LADDER)
) -> dict[str, float]:
    """Return measures of rungs, each the same on all of them and settled."""
    measures: dict[str, float] = {}
    for name, value in values.items():
        for rung in rungs:
            ends = {"": value, "_low": value, "_high": value, "_apart": spread}
            measures |= {f"{name}_{rung}{end}": number for end, number in ends.items()}
    return measures


def _examples(
    good: Mapping[str, float], bad: Mapping[str, float], words: tuple[Word, Word]
) -> list[tuple[dict[str, float], Word]]:
    """Return what follows of any ladder: one rung that says otherwise is enough if it carries the claim and is settled.

    Args:
        good: values with which the claim holds.
        bad: values with which it does not, one or more of them.
        words: what is said where all rungs hold, and where none does.
    """
    (rule,) = [rule for rule in RULES if {rule.measure, *(clause.measure for clause in rule.holds)} <= set(good)]
    good_measures, worse, rows = _ladder_measures(good), {**good, **bad}, []
    for rung in rule.rungs:
        word: Word = "models disagree" if rung.carries else words[0]
        rows.append((good_measures | _ladder_measures(worse, rungs=[rung.name]), word))
        if rung.carries:
            rows.append((good_measures | _ladder_measures(worse, rungs=[rung.name], spread=0.099), word))
            rows.append((good_measures | _ladder_measures(worse, rungs=[rung.name], spread=0.101), words[0]))
    return [
        (good_measures, words[0]),
        (_ladder_measures(worse), words[1]),
        (_ladder_measures(good, spread=nan), "not testable"),
        *rows,
    ]


_WAVE = {"wave_share": 0.99, "wave_envelope_tip": 0.1, "wave_envelope_middle": 0.03, "wave_waves_per_body": 1.0}
_FORCES = {"thrust_asymmetry": 0.1, "thrust_3_quarter_share": 0.5}
_TRACK = {"track_sway": 0.02, "track_noise": 0.001}

EXAMPLES: Examples = {
    "swim_tail_sine": _examples({"tail_sine_share": 0.951}, {"tail_sine_share": 0.949}, ("same sense", "not testable")),
    "swim_body_wave": [
        *_examples(_WAVE, {"wave_share": 0.949}, ("by construction", "contradicted")),
        (_ladder_measures(_WAVE | {"wave_share": 0.951}), "by construction"),
        (_ladder_measures(_WAVE | {"wave_envelope_middle": 0.099}), "by construction"),
        (_ladder_measures(_WAVE | {"wave_envelope_middle": 0.101}), "contradicted"),
        (_ladder_measures(_WAVE | {"wave_waves_per_body": 0.101}), "by construction"),
        (_ladder_measures(_WAVE | {"wave_waves_per_body": 0.099}), "contradicted"),
    ],
    "swim_pressure_convex": _examples(
        {"pressure_convex_share": 0.101}, {"pressure_convex_share": 0.099}, ("reproduced", "contradicted")
    ),
    "swim_diagonal_force": [
        *_examples(
            {"force_angle_1_quarter": 0.1},  # the arc tangent of 0.1 is 0.0997
            {"force_angle_1_quarter": 0.0992},
            ("reproduced", "contradicted"),
        ),
        (_ladder_measures({"force_angle_1_quarter": 1.47}), "reproduced"),  # that of 10 is 1.4711
        (_ladder_measures({"force_angle_1_quarter": 1.472}), "contradicted"),
    ],
    "swim_pressure_falls": _examples(
        {"pressure_fall_share": 0.101}, {"pressure_fall_share": 0.099}, ("by construction", "contradicted")
    ),
    "swim_thrust_symmetric": [
        *_examples(_FORCES, {"thrust_3_quarter_share": 0.099}, ("reproduced", "contradicted")),
        (_ladder_measures(_FORCES | {"thrust_asymmetry": 0.149}), "reproduced"),
        (_ladder_measures(_FORCES | {"thrust_asymmetry": 0.151}), "contradicted"),
        (_ladder_measures(_FORCES | {"thrust_3_quarter_share": 0.101}), "reproduced"),
    ],
    "swim_s_shape": [
        *_examples(_TRACK, {"track_sway": 0.0099}, ("reproduced", "contradicted")),
        (_ladder_measures(_TRACK | {"track_sway": 0.0101}), "reproduced"),
        (_ladder_measures(_TRACK | {"track_noise": 0.0198}), "reproduced"),
        (_ladder_measures(_TRACK | {"track_noise": 0.0202}), "contradicted"),
    ],
    "swim_tail_thrust": _examples(
        {"gain_tail_share": 0.505}, {"gain_tail_share": 0.495}, ("reproduced", "contradicted")
    ),
    "swim_spine_thrust": _examples(
        {"gain_spine_share": 0.0505}, {"gain_spine_share": 0.0495}, ("reproduced", "contradicted")
    ),
}
