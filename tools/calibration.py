"""Set the water of the runs beside the flow in three dimensions: the robot towed, held and free, at one viscosity.

``python tools/calibration.py FOLDER``: flows that are in the folder, of the same set-up by the same code, are kept, so
that it may be stopped and begun again; then what the page states and its picture are made anew.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from lighter import lighten
from pages.stated import keep
from pages.stated import main as write_pages
from suchus.core.jobs import conduct_sweep
from suchus.core.progress import Progress
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land.prescribed import free_sections, held_sections, towed_sections
from suchus.swimming.water import Outline, Water, fit, printed_wave, recoil
from suchus.swimming.water.resolved import FREE, TETHERED, SwimSetting, resolved_swim, towed_drag
from suchus.visual.figures import COLOURS, panels, styled
from water_coefficients import NAMES, QUANTITIES, WaterCoefficients, fitted, left, responses

ROBOT = ROBOTS["caiman"]
REYNOLDS = 7000.0
"""Frequency of the whole wave times length squared over viscosity [-]."""
VISCOSITY = ROBOT.length**2 / REYNOLDS
"""Kinematic viscosity of the water in all cases [m2/s]."""
GRIDS = (68, 80, 96)
"""Cells per body length; most cases are computed on the first [-]."""
FINEST = 128
"""Cells per body length of one swim on the spot more, which what three grids say of a finer one is tried on [-]."""
SPEEDS = (0.02, 0.05, 0.1, 0.2)
"""Speeds of the tows [m/s]."""
FREE_SWIMS = ("half the amplitude", "half the frequency", "whole wave", "trunk only", "tail only", "as printed")
"""Motions of free swims, in the order of the page."""
TOWED = "0.1 m/s"
"""Name of the tow that is computed on several grids [-]."""
WHOLE = "whole wave"
"""Name of the motion that the coefficients are fitted to [-]."""
FITTED = ("cross_drag", "thickening")
"""Coefficients that are fitted, to the whole wave of the body that is held."""
WORTH = 2.0
"""Factor by which a correction must lower what the model is off, where nothing was fitted, to be worth having [-]."""
_JUDGED = {
    "mean thrust held": ("held", "thrust"),
    "rms side force held": ("held", "aside"),
    "power held": ("held", "power"),
    "speed free": ("free", "speed"),
    "power free": ("free", "power"),
    "drag towed": ("towed", "drag"),
}
"""Kind of case and quantity that each name on the page stands for."""
_ASIDE = ("mean thrust held", "drag towed")
"""What does not decide about a correction for swims: a small difference of large forces, and no swim."""
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "calibration.png"
HELD_CYCLES, FREE_CYCLES = 3, 6
"""Cycles from rest, of which the last counts [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One body in the water."""

    name: str
    """Name, as the tables show it."""
    kind: Literal["towed", "held", "free"]
    """What is done to it."""
    cells: int = GRIDS[0]
    """Cells per body length [-]."""
    swim: Gait
    """Its motion; that of a towed body does not count."""
    speed: float = 0.0
    """Of a towed body [m/s]."""

    def setting(self) -> SwimSetting:
        """Return grid, water, time, and what moves the body."""
        free, cycles = (FREE, FREE_CYCLES) if self.kind == "free" else (TETHERED, HELD_CYCLES)
        return SwimSetting(axes=3, cells=self.cells, viscosity=VISCOSITY, cycles=cycles, free=free)


def motions() -> dict[str, Gait]:
    """Return the motions by name, the whole wave of (20) first."""
    whole = fit(ROBOT, printed_wave(ROBOT, "I", sign=-1)).gait
    return {
        "whole wave": whole,
        "half the amplitude": whole.bent(0.5),
        "half the frequency": replace(whole, period=2.0 * whole.period),
        "trunk only": whole.straightened("tail"),
        "tail only": whole.straightened("trunk"),
        "as printed": fit(ROBOT, printed_wave(ROBOT, "I", sign=1)).gait,
    }


def cases() -> list[Case]:
    """Return every case."""
    swims = motions()
    whole = swims["whole wave"]
    found = [Case(name=name, kind="held", swim=swim) for name, swim in swims.items()]
    found += [Case(name="whole wave", kind="held", swim=whole, cells=cells) for cells in GRIDS[1:]]
    found += [Case(name=f"{speed:g} m/s", kind="towed", swim=whole, speed=speed) for speed in SPEEDS[::-1]]
    found += [Case(name=TOWED, kind="towed", swim=whole, speed=0.1, cells=cells) for cells in GRIDS[1:]]
    found += [Case(name=name, kind="free", swim=swims[name]) for name in FREE_SWIMS]
    return found + [Case(name=WHOLE, kind="free", swim=whole, cells=cells) for cells in GRIDS[1:]]


def flowed(case: Case, progress: Progress) -> xr.Dataset:
    """Return what the flow says: drag, forces over the last cycle, or speed and power per cycle."""
    if case.kind == "towed":
        return xr.Dataset({"drag": ((), towed_drag(ROBOT, case.speed, case.setting()), {"units": "N"})})
    if case.kind == "held":
        sway, turn = recoil(Outline(ROBOT, case.cells + 1), case.swim, 0.0, Water())
        return resolved_swim(ROBOT, case.swim, case.setting(), sway=sway, turn=turn, progress=progress)
    swum = resolved_swim(ROBOT, case.swim, case.setting(), progress=progress)
    return swum[["speed", "thrust", "power"]]


Found = Mapping[tuple[str, str, int], xr.Dataset]
"""What the flow says, by kind and name of the case and cells per body length."""


def stated(found: Found) -> Mapping[str, Any]:
    """Return what the page states: flow, model of the runs and fitted model beside each other, and the grids."""
    swims, kinds = motions(), ("held", "free", "towed")
    both = WaterCoefficients(), _fit(found, WHOLE, GRIDS[0], FITTED)
    names = {kind: [name for one, name, cells in found if one == kind and cells == GRIDS[0]] for kind in kinds}
    beside = {kind: {name: _beside(found, kind, name, swims, both) for name in names[kind]} for kind in kinds}
    flows = {name: found["held", name, GRIDS[0]] for name in names["held"]}
    return {
        "reynolds": REYNOLDS,
        "cells": [*GRIDS, FINEST],
        **beside,
        "grids": {name: _on_grids(values) for name, values in _grids(found).items()},
        "models": {
            **{f"held {name}": beside["held"][WHOLE][name][1:] for name in beside["held"][WHOLE]},
            **{f"free {name}": beside["free"][WHOLE][name][1:] for name in beside["free"][WHOLE]},
            "towed drag": beside["towed"][TOWED]["drag"][1:],
            **{name: [getattr(one, name) for one in both] for name in FITTED},
        },
        "left": {name: [left(flow, _held(swims[name], flow, one)) for one in both] for name, flow in flows.items()},
        "left_finest": [left(found["held", WHOLE, FINEST], _held(swims[WHOLE], flows[WHOLE], one)) for one in both],
        "all_three": {name: list(asdict(_fit(found, name, GRIDS[0], NAMES)).values()) for name in flows},
    }


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
    swims = {"held": {name: swim for name, swim in m["held"].items() if name != WHOLE}, "free": m["free"]}
    rows = {name: [swim[key] for swim in swims.get(kind, m[kind]).values()] for name, (kind, key) in _JUDGED.items()}
    return {name: (mean_off(values, 1), mean_off(values, 2)) for name, values in rows.items()}


def worth(m: Mapping[str, Any]) -> dict[str, bool]:
    """Return of every quantity whether the fitted coefficients are worth having.

    They are where they halve what the model of the runs is off, on the grid of the fit where nothing was fitted, and
    are also nearer than it to where the flow tends as the cells become finer.
    """
    good = {}
    for name, (before, after) in held_out(m).items():
        place = " ".join(_JUDGED[name])
        limit, (plain, ours) = m["grids"][place]["limit"], m["models"][place]
        good[name] = after <= before / WORTH and abs(off(limit, ours)) < abs(off(limit, plain))
    return good


def earned(m: Mapping[str, Any]) -> bool:
    """Return whether a correction is earned: one set of coefficients must be worth having for all of a swim."""
    return all(good for name, good in worth(m).items() if name not in _ASIDE)


def judged(m: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the page states, with whether the fitted coefficients are worth having."""
    good = [name for name, well in worth(m).items() if well]
    held = {name: list(away) for name, away in held_out(m).items()}
    return {**m, "held_out": held, "worth_having": good, "earned": earned(m)}


def _grids(found: Found) -> dict[str, list[float]]:
    """Return what was computed on several grids, on each of them, and the coefficients that are fitted on each."""
    ladders = {"held": (WHOLE, (*GRIDS, FINEST)), "free": (WHOLE, GRIDS), "towed": (TOWED, GRIDS)}
    out: dict[str, list[float]] = {}
    for kind, (name, grids) in ladders.items():
        for cells in grids:
            for quantity, value in numbers(kind, found[kind, name, cells]).items():
                out.setdefault(f"{kind} {quantity}", []).append(value)
    for cells in (*GRIDS, FINEST):
        for name in FITTED:
            out.setdefault(name, []).append(getattr(_fit(found, WHOLE, cells, FITTED), name))
    return out


def _on_grids(values: Sequence[float]) -> dict[str, Any]:
    """Return values on the grids, and what a straight line over the cell through the first three says of finer ones."""
    line = np.polynomial.Polynomial.fit(1.0 / np.array(GRIDS), values[: len(GRIDS)], 1)
    return {"values": list(values), "foretold": float(line(1.0 / FINEST)), "limit": float(line(0.0))}


def _held(swim: Gait, flow: xr.Dataset, one: WaterCoefficients) -> xr.Dataset:
    """Return what the model of the runs says with coefficients of a body that is held as in a flow."""
    return held_sections(ROBOT, swim, one.lake(VISCOSITY), **_head(flow))


def _head(flow: xr.Dataset) -> dict[str, complex]:
    """Return how the head moved in a flow around a body that is held."""
    return {name: complex(flow[name][0], -flow[name][1]) for name in ("sway", "turn")}


def _fit(found: Found, name: str, cells: int, fitted_names: Sequence[str]) -> WaterCoefficients:
    flow = found["held", name, cells]
    return fitted(flow, responses(ROBOT, motions()[name], VISCOSITY, **_head(flow)), fitted_names)


def numbers(kind: str, flow: xr.Dataset) -> dict[str, float]:
    """Return what is compared of a body: drag, means over a cycle and rms side force, or those of the last cycle."""
    if kind == "towed":
        return {"drag": float(flow.drag)}
    if kind == "free":
        return {name: float(flow[name][-1]) for name in ("speed", "power")}
    aside = float(np.sqrt(np.mean(flow.aside.values**2)))
    return {"thrust": float(flow.thrust.mean()), "aside": aside, "power": float(flow.power.mean())}


def _beside(
    found: Found, kind: str, name: str, swims: Mapping[str, Gait], both: Sequence[WaterCoefficients]
) -> dict[str, list[float]]:
    """Return, by quantity, what the flow says, the model of the runs and the fitted one."""
    flow = found[kind, name, GRIDS[0]]
    rows = [numbers(kind, flow)]
    for one in both:
        lake = one.lake(VISCOSITY)
        if kind == "towed":
            rows.append({"drag": towed_sections(ROBOT, float(name.split(maxsplit=1)[0]), lake)})
        elif kind == "held":
            rows.append(numbers(kind, _held(swims[name], flow, one)))
        else:
            rows.append(numbers(kind, free_sections(ROBOT, swims[name], lake, FREE_CYCLES)))
    return {quantity: [row[quantity] for row in rows] for quantity in rows[0]}


def draw(found: Found) -> Figure:
    """Draw thrust, side force and power of the body that is held over a cycle: the flow and the models."""
    swim, flow = motions()[WHOLE], found["held", WHOLE, GRIDS[0]]
    plain, nearest = (_held(swim, flow, one) for one in (WaterCoefficients(), _fit(found, WHOLE, GRIDS[0], FITTED)))
    with styled():
        figure, axes = panels(1, 3, width=12.0, height=4.2)
        lines: list[tuple[xr.Dataset, str, dict[str, Any]]] = [
            (flow, f"flow, {GRIDS[0]} cells a length", {"color": COLOURS["ours"]}),
            (found["held", WHOLE, FINEST], f"flow, {FINEST} cells", {"color": COLOURS["water"]}),
            (plain, "model of the runs", {"color": COLOURS["alarm"], "linestyle": "--"}),
            (nearest, f"fitted to {GRIDS[0]} cells", {"color": COLOURS["neutral"], "linestyle": (0, (1, 1.2))}),
        ]
        for ax, name, label in zip(
            axes[0], QUANTITIES, ("thrust [N]", "force to the right [N]", "power [W]"), strict=True
        ):
            for one, called, look in lines:
                ax.plot(one.phase, one[name], label=called, **look)
            ax.axhline(0.0, color=COLOURS["grid"], linewidth=0.8)
            ax.set(xlabel="phase [cycle]", ylabel=label)
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(lines))
    return figure


def main(folder: Path) -> None:
    """Compute what is not there yet, and write page and picture anew."""
    asked = cases()
    finest = [Case(name=WHOLE, kind="held", swim=motions()[WHOLE], cells=FINEST)]
    flows = conduct_sweep("calibration", flowed, asked, folder / "cases", progress=_tell)
    flows += conduct_sweep("finest", flowed, finest, folder / "finest", progress=_tell)
    asked += finest
    found = {(one.kind, one.name, one.cells): flow for one, flow in zip(asked, flows, strict=True)}
    keep("calibration", judged(stated(found)))
    write_pages()
    figure = draw(found)
    figure.savefig(PICTURE, dpi=110)
    lighten(PICTURE)


def _tell(stage: str, share: float) -> None:
    print(f"\r{share:.1%}, {stage}", end="", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
