"""When the model's swim counts as the salamander's: how far it comes in a cycle, and which models say it."""

from collections.abc import Mapping
from math import nan

from suchus.article.verdict.judging import Examples
from suchus.article.verdict.rule import Clause, Rule, Rung, Varied

LADDER: Mapping[str, str] = {
    "resistive": "resistive theory",
    "reactive": "reactive theory",
    "sections": "six degrees of freedom on sections",
}
"""The models that are asked, by name, in words."""
_CARRY = ("resistive", "sections")
_QUARTER = "a model that says where a stroke goes is within a quarter of the animal's stride, 0.225 body lengths"
_THICK = (
    "Grids resolve it in water many times as thick as the animal's, where the same stroke goes another way; what is "
    "asked is a length, and not on which side of nothing it lies."
)
_WHY = {
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
        holds=(
            Clause("stride_off", ">=", -0.25, _QUARTER),
            Clause("stride_off", "<=", 0.25, _QUARTER),
        ),
        rungs=(
            *(Rung(name=name, model=model, why=_WHY[name], carries=name in _CARRY) for name, model in LADDER.items()),
            Rung(name="space", model="three dimensions", why=_THICK, carries=False),
        ),
        form=".3f",
        why="Body lengths that it comes in a cycle, the mean of the animal's frequencies; the animal comes 0.225.",
    ),
)

VARIED = Varied(
    claims=("salamander_swim_stride",),
    settings={"factors": (), "own_size": (), "settle": 6, "cycles": 4},
    samples=32,
)


def _of(rungs: Mapping[str, float], *, apart: float = 0.01, unsettled: str = "") -> dict[str, float]:
    """Return measures of rungs by how far they are off the animal's stride."""
    found: dict[str, float] = {}
    for rung, off in rungs.items():
        for name, value in (("stride", 0.225 * (1.0 + off)), ("stride_off", off)):
            found |= {f"{name}_{rung}{end}": value for end in ("", "_low", "_high")}
            found[f"{name}_{rung}_apart"] = apart if unsettled in ("", rung) else 0.01
    return found


def _all(off: float, **others: float) -> dict[str, float]:
    return dict.fromkeys((*LADDER, "space"), off) | others


EXAMPLES: Examples = {
    "salamander_swim_stride": [
        (_of(_all(0.0)), "reproduced"),
        (_of(_all(0.002)), "reproduced"),  # 0.2254
        (_of(_all(0.004)), "same sense"),  # 0.2259
        (_of(_all(0.249)), "same sense"),
        (_of(_all(0.251)), "contradicted"),
        (_of(_all(-0.249)), "same sense"),
        (_of(_all(-0.251)), "contradicted"),
        (_of(_all(0.0), apart=nan), "not testable"),
        *((_of(_all(0.0, **{rung: 0.5})), "reproduced") for rung in ("reactive", "space")),
        *((_of(_all(0.0, **{rung: 0.5})), "models disagree") for rung in _CARRY),
        *((_of(_all(0.0, **{rung: 0.5}), apart=0.099, unsettled=rung), "models disagree") for rung in _CARRY),
        *((_of(_all(0.0, **{rung: 0.5}), apart=0.101, unsettled=rung), "undecided") for rung in _CARRY),
    ],
}
