"""The results that suchus keeps: for each the code that it reaches, a probe of its behaviour, and how it is renewed."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Any

from evidence import (
    built,
    complete_loads,
    converge,
    filmed_crawl,
    page_measures,
    probes,
    servo_loads,
    shedding,
    short_forms,
    tolerance,
    untrained_policies,
    wall_model,
)
from evidence.tolerance import Bounded
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.robots import ROBOTS

FORMS: Mapping[str, tuple[str, Mapping[str, Any]]] = MappingProxyType(
    {
        **{name: (name, {}) for name in EXPERIMENTS},
        "swim_free_space": ("swim_free", {"water": "space"}),
        "swim_free_space_slow": ("swim_free", {"water": "space", "frequency": 0.5, "reynolds": 3500.0}),
    }
)
"""Experiment and settings of each result that is an experiment in full."""
SEARCHES = ("crawl", "fault", "lifted", "stand", "thrift", "turn")
"""Searches whose outcome is kept, as ``optimise_NAME``."""
_SWIMS = ("suchus.experiments.catalog.swim_free", "suchus.swimming.coupling", "suchus.flow")
_ATLAS = "evidence.atlas"
_VALIDATE = "make validate"


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """A result that is kept."""

    name: str
    """Name of the result, and of its file in ``results``."""
    modules: tuple[str, ...]
    """Modules or packages of suchus that make it; what they import is reached too."""
    probe: Callable[[], Any] | None = None
    """Gives the behaviour of the code in seconds, as numbers in mappings and lists; None where only the code itself can
    be compared."""
    renew: str
    """Command that computes it again."""
    compute: Callable[[], Any] | None = None
    """Returns its numbers; None where a program of its own computes and keeps it."""
    relative: float = tolerance.RELATIVE
    """Relative change of its probe's numbers that means the same [-]."""
    small: float = tolerance.SMALL
    """Absolute change of them that no reader looks at [SI unit]."""
    sources: tuple[str, ...] = ()
    """Results that it is made of: it is old when one of them is."""

    def bounded(self) -> dict[str, Bounded]:
        """Return what its probe gives now, each number with its range; nothing where it has no probe."""
        if self.probe is None:
            return {}
        return tolerance.bounded(probes.flat(self.probe()), relative=self.relative, small=self.small)


def run_experiment(name: str) -> dict[str, float]:
    """Return the measures of a result that is an experiment in full.

    Args:
        name: of the result, a key of ``FORMS``.
    """
    experiment, settings = FORMS[name]
    measures = replace(EXPERIMENTS[experiment], **settings).run().measures
    return {key: float(measure.value) for key, measure in sorted(measures.items())}


def _experiment(name: str, of: str) -> Kept:
    return Kept(
        name=name, modules=(f"suchus.experiments.catalog.{of}", "suchus.experiments.experiment"),
        probe=partial(probes.experiment, of),
        renew=f"make renew NAME={name}", compute=partial(run_experiment, name),
    )  # fmt: skip


def _flows(name: str, renew: str, *modules: str, flows: Sequence[str] = probes.PLANE) -> Kept:
    return Kept(
        name=name, modules=("suchus.flow", *modules), probe=partial(probes.first_steps, tuple(flows)), renew=renew
    )


_OTHERS = (
    *(
        Kept(
            name=f"optimise_{name}", modules=("suchus.experiments.optimise",), probe=partial(probes.search, name),
            renew=f"suchus optimise {name} --out out/{name} && make renew NAME=out/{name}/result/outcome.json",
        )
        for name in SEARCHES
    ),
    Kept(
        name="claims", modules=("suchus.experiments.study", "suchus.article.verdict"), probe=probes.claims,
        renew="suchus study claims --out out/claims && make renew NAME=out/claims/result/claims.json",
    ),
    Kept(
        name="verdicts", modules=("suchus.article.verdict",),
        renew="suchus reproduce --all && python tools/verdict_table.py out",
        sources=("claims", *EXPERIMENTS),
    ),
    Kept(
        name=short_forms.NAME, modules=("suchus.article.verdict", "suchus.experiments.experiment"),
        renew="suchus reproduce --out out/short && suchus reproduce --all --out out/whole && "
        "python -m evidence.short_forms out/short out/whole",
    ),
    Kept(name="bodies", modules=("suchus.apps.cli",), renew="python tools/body_table.py --anew"),
    Kept(
        name="league", modules=("evidence.league.cases", "evidence.league"), probe=probes.predictions,
        renew="python -m evidence.league --out out/league && python tools/league_page.py out/league",
    ),
    _flows("atlas", "make atlas", _ATLAS, flows=probes.ATLAS),
    _flows("validation", _VALIDATE, "suchus.swimming.coupling", flows=(*probes.PLANE, *probes.SPACE)),
    _flows("snakes", _VALIDATE, _ATLAS),
    _flows("sphere_300", _VALIDATE, flows=probes.SPACE),
    _flows("flag", _VALIDATE, "suchus.swimming.coupling"),
    _flows("wall_stress", _VALIDATE, flows=(*probes.PLANE, *probes.SPACE)),
    replace(_flows("shedding", "make renew NAME=shedding", "evidence.shedding", flows=probes.SPACE),
            compute=shedding.table),
    _flows("sections", "python tools/sections.py out/sections", "suchus.swimming.water.sections", _ATLAS),
    _flows("calibration", "python tools/calibration.py out/calibration", "suchus.swimming.water", flows=probes.SPACE),
    Kept(
        name="swim_grids", modules=_SWIMS, probe=partial(probes.experiment, "swimming"), renew=_VALIDATE,
    ),
    Kept(
        name="wave_fits", modules=("suchus.swimming.water",), probe=probes.wave_fit, renew="python tools/wave_fits.py",
    ),
    Kept(
        name="servo_loads", modules=("suchus.hardware",), probe=probes.servo_loads, renew="make renew NAME=servo_loads",
        compute=partial(servo_loads.measured, ROBOTS["caiman"], cycles=2),
    ),
    Kept(name="built", modules=("suchus.hardware",), probe=probes.servo_loads, renew="make renew NAME=built",
         compute=built.measured),
    *(
        Kept(
            name=name, modules=("suchus.swimming.water", "suchus.sim.land", "suchus.robot.control"), compute=compute,
            probe=probes.wave_fit if name == "printed_direction" else compute, renew=f"make renew NAME={name}",
        )
        for name, compute in page_measures.SOURCES.items()
    ),
    Kept(
        name=untrained_policies.NAME, modules=("suchus.apps.envs",), compute=untrained_policies.measured,
        probe=partial(untrained_policies.body_results, "caiman"), renew=f"make renew NAME={untrained_policies.NAME}",
    ),
    Kept(
        name="filmed_crawl", modules=("suchus.animals.capture", "suchus.sim.land"), compute=filmed_crawl.measured,
        probe=partial(filmed_crawl.measured, 1), renew="make renew NAME=filmed_crawl",
    ),
    Kept(
        name=complete_loads.NAME, modules=("suchus.experiments.study", "suchus.sim.land"),
        probe=partial(complete_loads.measured, 4, 2), renew="python -m evidence.complete_loads",
    ),
    Kept(name="converge", modules=converge.MODULES, probe=converge.probe, renew="make converge"),
    Kept(
        name="walls", modules=("suchus.flow",), compute=wall_model.compared, probe=wall_model.compared,
        renew="make renew NAME=walls",
    ),
    Kept(name="bench_flow", modules=(), renew="python bench/bench_flow.py --keep"),
    Kept(name="bench_small_flows", modules=(), renew="python bench/bench_flow.py --small --keep"),
    Kept(name="bench_gpu", modules=(), renew="python bench/bench_gpu.py --keep"),
    Kept(name="bench_page", modules=(), renew="python bench/bench_page.py --keep"),
)  # fmt: skip

RESULTS: Mapping[str, Kept] = MappingProxyType(
    {kept.name: kept for kept in (*(_experiment(name, of) for name, (of, _) in FORMS.items()), *_OTHERS)}
)
"""Every result that may be kept, by name. Those that are have a file in ``results``."""
