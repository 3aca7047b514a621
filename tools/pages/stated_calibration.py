"""Passages that set the water of the runs beside the flow in three dimensions; see ``stated`` and ``calibration``."""

from collections.abc import Callable, Mapping, Sequence
from math import floor, log10
from typing import Any

WORTH = 2.0
"""Factor by which a correction must lower what the model is off, where nothing was fitted, to be worth having [-]."""
_HELD = {"thrust": ("mean thrust", "N"), "aside": ("rms side force", "N"), "power": ("power", "W")}
_ASIDE = ("mean thrust held", "drag towed")
"""What does not decide about a correction for swims: a small difference of large forces, and no swim."""
_FREE = {"speed": ("speed", "mm/s"), "power": ("power", "W")}


def off(flow: float, model: float) -> float:
    """Return by how much a model is off, over the flow [-]."""
    return model / flow - 1.0


def mean_off(rows: Sequence[Sequence[float]], which: int) -> float:
    """Return the mean size of what a model is off, over the flow.

    Args:
        rows: flow, model of the runs, fitted model.
        which: 1 is the model of the runs, 2 the fitted one.
    """
    return sum(abs(off(row[0], row[which])) for row in rows) / len(rows)


def held_out(m: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Return how far off both models are in the mean on the grid of the fit, where nothing was fitted [-]."""
    held = {name: [one[name] for key, one in m["held"].items() if key != "whole wave"] for name in _HELD}
    free = {name: [one[name] for one in m["free"].values()] for name in _FREE}
    groups = {f"{_HELD[name][0]} held": rows for name, rows in held.items()}
    groups |= {f"{_FREE[name][0]} free": rows for name, rows in free.items()}
    groups["drag towed"] = [one["drag"] for one in m["towed"].values()]
    return {name: (mean_off(rows, 1), mean_off(rows, 2)) for name, rows in groups.items()}


def worth(m: Mapping[str, Any]) -> dict[str, bool]:
    """Return of every quantity whether the fitted coefficients are worth having.

    They are where they halve what the model of the runs is off, on the grid of the fit where nothing was fitted, and
    are also nearer than it to where the flow tends as the cells become finer.
    """
    found = {}
    for name, (before, after) in held_out(m).items():
        quantity, kind = name.rsplit(" ", 1)
        key = next(key for key, (called, _) in {**_HELD, **_FREE, "drag": ("drag", "N")}.items() if called == quantity)
        limit, models = m["grids"][f"{kind} {key}"]["limit"], m["models"][f"{kind} {key}"]
        found[name] = after <= before / WORTH and abs(off(limit, models[1])) < abs(off(limit, models[0]))
    return found


def earned(m: Mapping[str, Any]) -> bool:
    """Return whether a correction is earned: one set of coefficients must be worth having for all of a swim."""
    return all(good for name, good in worth(m).items() if name not in _ASIDE)


def _row(first: str, values: Sequence[float], unit: str) -> str:
    flow, model, fitted = (_number(value, unit) for value in values)
    away = [f"{off(values[0], value):+.0%}" for value in values[1:]]
    return f"| {first} | {flow} | {model} ({away[0]}) | {fitted} ({away[1]}) |"


def _number(value: float, unit: str) -> str:
    """Return a number with its unit, to three digits."""
    shown = 1e3 * value if unit == "mm/s" else value
    text = f"{shown:.0f}" if abs(shown) >= 100.0 else f"{shown:.{max(0, 2 - floor(log10(abs(shown) or 1.0)))}f}"
    return f"{text} {unit}".strip()


def _cases(m: Mapping[str, Any]) -> list[str]:
    """Return the table of all bodies on the coarsest grid."""
    lines = [f"| {m['cells'][0]} cells a length | flow | model of the runs | fitted to the first three rows |",
             "|---|---|---|---|"]  # fmt: skip
    for name, one in m["held"].items():
        lines += [_row(f"held, {name}: {called}", one[key], unit) for key, (called, unit) in _HELD.items()]
    for name, one in m["free"].items():
        lines += [_row(f"free, {name}: {called}", one[key], unit) for key, (called, unit) in _FREE.items()]
    return lines + [_row(f"towed, {name}: drag", one["drag"], "N") for name, one in m["towed"].items()]


def _on_grids(m: Mapping[str, Any]) -> list[str]:
    """Return the table of the flow on its grids beside the models."""
    *coarse, finest = m["cells"]
    head = [
        *(f"{cells}" for cells in coarse),
        f"a line says of {finest}",
        f"{finest}",
        "and of none",
        "model",
        "fitted",
    ]
    lines = [f"| whole wave; cells a length | {' | '.join(head)} |", "|---" * (len(head) + 1) + "|"]
    rows = {f"held {name}": (f"held: {called}", unit) for name, (called, unit) in _HELD.items()}
    rows |= {f"free {name}": (f"free: {called}", unit) for name, (called, unit) in _FREE.items()}
    rows |= {"towed drag": ("towed at 0.1 m/s: drag", "N"), "cross_drag": ("fitted drag coefficient across", ""),
             "thickening": ("fitted factor on friction along", "")}  # fmt: skip
    for key, (called, unit) in rows.items():
        one, models = m["grids"][key], m["models"][key]
        values = [*one["values"][: len(coarse)], one["foretold"], *one["values"][len(coarse) :]]
        shown = [_number(value, unit) for value in values] + [""] * (len(coarse) + 2 - len(values))
        shown += [_number(value, unit) for value in (one["limit"], *models)]
        lines.append(f"| {called} | {' | '.join(shown)} |")
    return lines


def _left(m: Mapping[str, Any]) -> list[str]:
    """Return the table of what is left of the forces over a cycle."""
    lines = ["| rms of the difference over a cycle, over the flow's peak | thrust | side force | power |",
             "|---|---|---|---|"]  # fmt: skip
    for name, (ours, fitted) in (m["left"] | {f"whole wave, {m['cells'][-1]} cells": m["left_finest"]}).items():
        shown = [f"{ours[key]:.0%}, fitted {fitted[key]:.0%}" for key in _HELD]
        lines.append(f"| held, {name} | {' | '.join(shown)} |")
    return lines


def _calibration(m: Mapping[str, Any]) -> str:
    """Return the tables of flow and models, of the grids, and what is left of the forces over a cycle."""
    said = "; ".join(f"{name} {before:.0%} and {after:.0%}" for name, (before, after) in held_out(m).items())
    good = ", ".join(name for name, one in worth(m).items() if one) or "nothing"
    verdict = (
        f"By both measures the fit is worth having for: {good}. A correction is {'' if earned(m) else 'not '}earned."
    )
    added = ", ".join(f"{values[2]:.1f}" for values in m["all_three"].values())
    return "\n".join([*_cases(m), "", *_on_grids(m), "", *_left(m)]) + (
        "\n\nOn the grid of the fit, where nothing was fitted, the model of the runs and the fitted one are off in "
        f"the mean by: {said}. {verdict} Fitted to each swim on the spot together with the other two coefficients, the "
        f"factor on added mass is {added}.\n"
    )


PASSAGES: Mapping[str, Mapping[str, Callable[[Mapping[str, Any]], str]]] = {
    "calibration": {"calibration": _calibration}
}
"""What makes each passage, by what was measured."""
