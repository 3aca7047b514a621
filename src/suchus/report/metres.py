"""Speed and cost of transport on land, at the surface and below, from the outcomes of a report."""

from collections.abc import Mapping
from dataclasses import dataclass

from suchus.metrics.energy import METRES
from suchus.report.numbers import quantity
from suchus.report.result import Result

_MEASURES = ("speed", "work_per_metre", "cost_of_transport")


@dataclass(frozen=True, slots=True, kw_only=True)
class Metre:
    """A row of the table."""

    where: str
    """Place, in words."""
    experiment: str
    """Name of the experiment that measured them."""
    speed: str
    """Speed, with its unit."""
    work: str
    """Work of the servos over the distance, with its unit."""
    cost: str
    """Cost of transport: that work over the weight; empty where it was not measured."""


def metres(results: Mapping[str, Result]) -> list[Metre]:
    """Return the rows that the outcomes allow, in the order from land to depth."""
    rows = []
    for ending, where in METRES.items():
        for name, result in results.items():
            outcome = result.outcome["measures"]
            speed, work, cost = (_with_unit(outcome.get(f"{what}_{ending}")) for what in _MEASURES)
            if speed and work:
                rows.append(Metre(where=where, experiment=name, speed=speed, work=work, cost=cost))
    return rows


def _with_unit(measure: Mapping[str, object] | None) -> str:
    """Return a measure with its unit; empty where there is none, or no number."""
    if measure is None or not isinstance(measure["value"], (int, float)):
        return ""
    return quantity(float(measure["value"]), str(measure["unit"]), 3)
