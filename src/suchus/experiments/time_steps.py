"""How much the measures of an experiment change with the time step of its physics, as ``make converge`` found it.

The table beside this module holds the experiments that were compared: the time step of the comparison, and of each
measure that left its tolerance the greatest change at smaller steps. It holds for the robot, the gaits and at most the
time step with which an experiment stands in the catalog. ``python -m evidence.converge --say`` writes it.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from importlib import resources
from math import inf, isfinite
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from suchus.article.paper import Claim
from suchus.article.verdict import Rule, judge, listed

if TYPE_CHECKING:
    from suchus.experiments.experiment import Experiment

FILE = "time_steps.json"
FIELD = "timestep"
"""Name of the field of an experiment that holds the time step of its physics [s]."""
_ENDS = ("_low", "_high")


@dataclass(frozen=True, slots=True, kw_only=True)
class StepComparison:
    """How much the measures of an experiment change at half and a quarter of its time step."""

    measures: int
    """Number of measures that were compared [-]."""
    timestep: float | None
    """Time step of the experiment [s]; None where its robot decides."""
    changes: Mapping[str, float]
    """Greatest change of each measure that left its tolerance, by name, in its own unit; infinite where it is no number
    at some of the steps."""


def _read(entry: Mapping[str, Any]) -> StepComparison:
    changes = {name: inf if change is None else float(change) for name, change in entry["changes"].items()}
    return StepComparison(measures=entry["measures"], timestep=entry[FIELD], changes=MappingProxyType(changes))


def _shipped() -> dict[str, StepComparison]:
    file = resources.files("suchus.experiments") / FILE
    return {name: _read(entry) for name, entry in json.loads(file.read_text(encoding="utf-8")).items()}


COMPARED: Mapping[str, StepComparison] = MappingProxyType(_shipped())
"""What was found of each experiment, by its name."""


def comparison_of(question: "Experiment") -> StepComparison | None:
    """Return what is known of the measures of an experiment as it is; None where it has another robot, gait or step."""
    return None if difference(question) else COMPARED.get(question.name())


def difference(question: "Experiment") -> str:
    """Return in what an experiment differs from the compared one, as a clause; empty where it does not.

    An experiment that was not compared differs in nothing.
    """
    compared = COMPARED.get(question.name())
    if compared is None:
        return ""
    catalog_form = type(question)()
    known = (catalog_form, catalog_form.quick(), catalog_form.for_verdicts())
    for name in (field.name for field in fields(question)):  # type: ignore[arg-type]
        value = getattr(question, name)
        if _holds_values(value) and value not in [getattr(form, name) for form in known]:
            return f"another {name.removesuffix('s')}"
    step = getattr(question, FIELD, None)
    if compared.timestep is not None and step is not None and step > compared.timestep * (1.0 + 1e-9):
        return f"a time step of {1e3 * step:g} ms, above the {1e3 * compared.timestep:g} ms of the comparison"
    return ""


def _holds_values(value: Any) -> bool:
    """Return whether a field holds a robot, gaits or other values of several numbers, and no number, name or switch."""
    return any(map(is_dataclass, value)) if isinstance(value, tuple) else is_dataclass(value)


def sentence(question: "Experiment") -> str:
    """Return what a page says of the time step above the measures of an experiment; empty where it was not compared."""
    compared = COMPARED.get(question.name())
    if compared is None:
        return ""
    if differs := difference(question):
        return f"How much these numbers change with the time step is not known: this run has {differs}."
    return (
        "Behind “time step” stands how much a number changes with smaller time steps, where that is more than its "
        "tolerance, found in short runs."
    )


def caution(
    rule: Rule, measures: Mapping[str, float], changes: Mapping[str, float], claims: Mapping[str, Claim]
) -> str:
    """Return which other words a verdict would have within the changes with the time step; empty if none.

    Each measure that decides is moved alone, up and down by its change, with its interval.

    Args:
        rule: the claim's.
        measures: measures of its experiment, by name, in SI units.
        changes: greatest change with the time step, by name of measure, see ``StepComparison``.
        claims: those that rules may judge, by key.
    """
    word = judge(rule, measures, claims=claims).verdict
    found = []
    needed = rule.needs.union(*(other.needs for other in rule.interpreted_rules))
    for name in sorted({_stem(name) for name in needed}):
        names = [name, *(f"{name}{end}" for end in _ENDS)]
        change = max((changes.get(one, 0.0) for one in names), default=0.0)
        if not change or not isfinite(change):
            continue
        moved = [
            judge(rule, {**measures, **{one: measures[one] + step for one in names if one in measures}}, claims=claims)
            for step in (-change, change)
        ]
        words = list(dict.fromkeys(verdict.verdict for verdict in moved if verdict.verdict != word))
        if words:
            found.append(f"{' or '.join(f'“{other}”' for other in words)} within {change:.2g} of `{name}`")
    return f"Smaller time steps may give the word {listed(found)}." if found else ""


def _stem(name: str) -> str:
    """Return the name of a measure without that of an end of its interval."""
    for end in _ENDS:
        name = name.removesuffix(end)
    return name
