"""When the model's swim counts as the salamander's: how far it comes in a cycle, and which models say it."""

from collections.abc import Mapping
from math import nan

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Rung, Variation

LADDER: Mapping[str, str] = {
    "resistive": "resistive theory",
    "reactive": "reactive theory",
    "sections": "six degrees of freedom on sections",
}
"""Labels of the models by name."""
_CARRY = ("resistive", "sections")
_QUARTER = "a model that says where a stroke goes is within a quarter of the animal's stride, 0.225 body lengths"
_GRID_REASON = (
    "Grids resolve it in water many times as thick as the animal's, where the same stroke goes another way; what is "
    "asked is a length, and not on which side of nothing it lies."
)
_REASONS = {
    "resistive": "It drags every section by its own velocity, which drives a body along which a wave runs.",
    "reactive": "It counts the momentum that the body's end sheds, and the model's tail ends in a point: of such a "
    "body it knows no thrust, however it swims.",
    "sections": "Joints, roll and heave are free; every section feels its own motion, without a wake.",
}

RULES = (
    Rule(
        claim="salamander_swim_stride",
        experiment="salamander_swim",
        measure="stride",
        definition="displacement in a cycle in body lengths, mean of the animal's frequencies",
        holds=(
            Clause("stride_off", ">=", -0.25, _QUARTER),
            Clause("stride_off", "<=", 0.25, _QUARTER),
        ),
        rungs=(
            *(
                Rung(name=name, model=model, why=_REASONS[name], carries=name in _CARRY)
                for name, model in LADDER.items()
            ),
            Rung(name="space", model="three dimensions", why=_GRID_REASON, carries=False),
        ),
        form=".3f",
        why="Body lengths that it comes in a cycle, the mean of the animal's frequencies; the animal comes 0.225.",
    ),
)

VARIED = Variation(
    claims=("salamander_swim_stride",),
    settings={"factors": (), "own_size": (), "settle": 6, "cycles": 4},
    samples=32,
)


def _rung_measures(rungs: Mapping[str, float], *, spread: float = 0.01, unsettled: str = "") -> dict[str, float]:
    """Return example measures of rungs from their relative error of the stride."""
    measures: dict[str, float] = {}
    for rung, relative_error in rungs.items():
        for name, value in (("stride", 0.225 * (1.0 + relative_error)), ("stride_off", relative_error)):
            measures |= {f"{name}_{rung}{end}": value for end in ("", "_low", "_high")}
            measures[f"{name}_{rung}_apart"] = spread if unsettled in ("", rung) else 0.01
    return measures


def _all_rungs(relative_error: float, **exceptions: float) -> dict[str, float]:
    return dict.fromkeys((*LADDER, "space"), relative_error) | exceptions


EXAMPLES: Examples = {
    "salamander_swim_stride": [
        (_rung_measures(_all_rungs(0.0)), "reproduced"),
        (_rung_measures(_all_rungs(0.002)), "reproduced"),  # 0.2254
        (_rung_measures(_all_rungs(0.004)), "same sense"),  # 0.2259
        (_rung_measures(_all_rungs(0.249)), "same sense"),
        (_rung_measures(_all_rungs(0.251)), "contradicted"),
        (_rung_measures(_all_rungs(-0.249)), "same sense"),
        (_rung_measures(_all_rungs(-0.251)), "contradicted"),
        (_rung_measures(_all_rungs(0.0), spread=nan), "not testable"),
        *((_rung_measures(_all_rungs(0.0, **{rung: 0.5})), "reproduced") for rung in ("reactive", "space")),
        *((_rung_measures(_all_rungs(0.0, **{rung: 0.5})), "models disagree") for rung in _CARRY),
        *(
            (_rung_measures(_all_rungs(0.0, **{rung: 0.5}), spread=0.099, unsettled=rung), "models disagree")
            for rung in _CARRY
        ),
        *(
            (_rung_measures(_all_rungs(0.0, **{rung: 0.5}), spread=0.101, unsettled=rung), "undecided")
            for rung in _CARRY
        ),
    ],
}
