"""Pictures of a search: how it converged, the front, the best gaits, what lies around them."""

from collections.abc import Sequence
from math import ceil

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.experiments.optimise.aims import AIMS, Kind
from suchus.experiments.optimise.evaluate import is_allowed
from suchus.experiments.optimise.search import SearchResult
from suchus.experiments.optimise.spec import value_at_fraction
from suchus.robot.control import Standing
from suchus.robot.design import unit_at
from suchus.robot.motion import START
from suchus.sim.land import Run
from suchus.visual.figures import COLOURS, LINES, captioned, panels, styled
from suchus.visual.figures.posture import draw_posture, draw_strip

_ROLES = ("coordinated", "limbs_only", "tail_drag", "spine_only", "tail", "water")
_STANDING_SPACING, _GAP = 0.6, 0.06  # [m]; between two robots that stand, between two that walk
_MM = {"m": (1000.0, "mm"), "rad": (180 / np.pi, "deg")}


def role(number: int) -> str:
    """Return the role of ``figures.COLOURS`` of a condition."""
    return _ROLES[number % len(_ROLES)]


def label(name: str) -> str:
    """Return the name of a field, a limit or a condition as pages and figures show it."""
    if name in LINES and LINES[name]["label"]:
        return str(LINES[name]["label"])
    name = name.rpartition("gait.")[2].removeprefix("robot.").replace("_", " ").replace(".", ", ")
    return f"{name.removeprefix('control, ')} (control)" if name.startswith("control, ") else name


def draw_convergence(searches: Sequence[SearchResult]) -> Figure:
    """Draw the first aim of the best so far of every condition over the candidates tried."""
    kind, name = AIMS[searches[0].spec.aims[0].name], label(searches[0].spec.aims[0].name)
    with styled():
        figure, axes = panels(1, 1, height=4.0)
        ax = axes[0, 0]
        for i, search in enumerate(searches):
            colour, values = COLOURS[role(i)], search.history[f"aim_{search.spec.aims[0].name}"].values
            allowed = is_allowed(search.spec, search.history)
            ax.plot(np.flatnonzero(allowed), values[allowed], ".", color=colour, markersize=3, alpha=0.35)
            ax.plot(search.best_so_far(), color=colour, drawstyle="steps-post", label=label(search.arm))
            ax.plot(
                0, float(search.start[f"aim_{search.spec.aims[0].name}"][0]), "D", color=colour, markeredgecolor="black"
            )
        _limit_axis(ax, searches)
        ax.set_xlabel("candidates tried [-]")
        ax.set_ylabel(f"{name} [{kind.unit}]")
        ax.legend(loc="lower right" if kind.good == "more" else "upper right")
    return captioned(
        figure,
        f"How the search converged: {kind.tells}. Lines: best so far among candidates that keep all limits; dots: each "
        "such candidate; diamonds: where the search started.",
    )


def _limit_axis(ax: Axes, searches: Sequence[SearchResult]) -> None:
    """Leave wild candidates out of the picture."""
    values = np.concatenate([search.best_so_far() for search in searches])
    values = values[np.isfinite(values)]
    if values.size:
        y_min, y_max = float(values.min()), float(values.max())
        pad = max(0.15 * (y_max - y_min), 0.02 * abs(y_max), 1e-6)
        ax.set_ylim(y_min - pad, y_max + pad)


def draw_front(search: SearchResult) -> Figure:
    """Draw the two aims of every candidate that keeps all limits, and the front."""
    first_column, second_column = (f"aim_{aim.name}" for aim in search.spec.aims)
    kinds = [AIMS[aim.name] for aim in search.spec.aims]
    allowed, table, front, chosen_indices = (
        is_allowed(search.spec, search.history),
        search.history,
        search.front,
        search.chosen_indices,
    )
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.2, width_ratios=[1.4, 1])
        ax = axes[0, 0]
        x, y = table[first_column].values, table[second_column].values
        ax.plot(
            x[allowed],
            y[allowed],
            ".",
            color=COLOURS["neutral"],
            markersize=4,
            alpha=0.4,
            label="keeps all limits",
        )
        ax.plot(x[front], y[front], "o-", color=COLOURS["ours"], markersize=4, linewidth=1.2, label="front")
        ax.plot(x[chosen_indices], y[chosen_indices], "o", color=COLOURS["alarm"], markersize=9, label="gait files")
        ax.plot(x[0], y[0], "D", color="white", markeredgecolor="black", markersize=8, label="start")
        if front:
            spread = np.ptp(y[front]) + 0.1 * abs(y[front]).max()
            ax.set_ylim(y[front].min() - 0.3 * spread, max(y[front].max() + spread, y[0] + 0.2 * spread))
        for i, name in zip(chosen_indices, search.names, strict=True):
            ax.annotate(name.rpartition("_")[2], (x[i], y[i]), (7, 5), textcoords="offset points")
        for axis, aim, kind in zip((ax.set_xlabel, ax.set_ylabel), search.spec.aims, kinds, strict=True):
            axis(f"{label(aim.name)} [{kind.unit}], {kind.good} is better")
        ax.legend(loc="best", fontsize=10)
        areas = search.covered_areas()
        axes[0, 1].plot(areas, color=COLOURS["ours"])
        axes[0, 1].set_xlabel("generation [-]")
        axes[0, 1].set_ylabel("area that the front covers [-]")
    return captioned(
        figure,
        "Left: both aims of every candidate that keeps all limits; no other betters those of the front in both. Right: "
        "the area that the front covers, in parts of what the start has.",
    )


def draw_gaits(runs: Sequence[Run], record: xr.Dataset, texts: Sequence[str]) -> Figure:
    """Draw what every run does: from above at its beginning, half-way and at its end; who stands from its side.

    Args:
        runs: the start, and the best.
        record: record of the runs.
        texts: what is written beside each.
    """
    if all(isinstance(run.control, Standing) for run in runs):
        return _draw_standing(runs, record, texts)
    end = float(record.time[-1])
    times = [START, (START + end) / 2, end]
    offsets, depth = _lanes(runs, record, times)
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=10.5, height=1.0 + 3.8 * depth)
        ax = axes[0, 0]
        for i, run in enumerate(runs):
            walk, hue = record.isel(run=i), _shade(run.label, i)
            draw_strip(ax, run.robot, walk, times, role=hue, lateral_offset=offsets[i])
            text_y = float(walk.centre_of_mass.sel(xyz="y").sel(time=end, method="nearest")) + offsets[i]
            text_x = float(_extreme_points(walk, times)[:, 0].max())
            ax.text(
                text_x + _GAP, text_y, f"{label(run.label)}\n{texts[i]}", color=COLOURS[hue], va="center", fontsize=13
            )
        ax.set_xlim(right=float(_extreme_points(record, times)[:, 0].max()) + 0.45)
        ax.set_axis_off()
    return captioned(
        figure,
        f"From above at {times[0]:g}, {times[1]:g} and {times[2]:g} s, with the track of the centre of mass. Filled "
        "feet stand.",
    )


def _extreme_points(record: xr.Dataset, times: Sequence[float]) -> np.ndarray:
    """Return where feet, snout and tail tip are at some times, shape (point, 3) [m]."""
    samples = record.sel(time=list(times), method="nearest")
    return np.concatenate([samples[name].values.reshape(-1, 3) for name in ("foot_position", "snout", "tail_tip")])


def _lanes(runs: Sequence[Run], record: xr.Dataset, times: Sequence[float]) -> tuple[list[float], float]:
    """Return how far to the left each run is drawn so that none lies on another, and how deep all are together [m]."""
    offsets, top = [], 0.0
    for i in range(len(runs)):
        y = _extreme_points(record.isel(run=i), times)[:, 1]
        offsets.append(top - float(y.max()))
        top += float(y.min() - y.max()) - 1.5 * _GAP  # hands reach beyond the feet' middles
    return offsets, -top


def _draw_standing(runs: Sequence[Run], record: xr.Dataset, texts: Sequence[str]) -> Figure:
    """Draw every run from its right side, in the middle of the time in which it should stand.

    Args:
        runs: runs with a control that stands up.
        record: record of the runs.
        texts: written under each.
    """
    with styled():
        figure, axes = panels(1, 1, width=3.0 + 2.6 * len(runs), height=5.6)
        ax = axes[0, 0]
        for i, run in enumerate(runs):
            assert isinstance(run.control, Standing)
            walk = record.isel(run=i)
            time = (run.control.upright_from(run.robot) + run.control.upright_until(run.robot)) / 2
            hips = float(walk.position.sel(xyz="x").sel(time=time, method="nearest"))
            shifted_walk = walk.assign(
                {
                    name: walk[name] + _forward_shift(walk, _STANDING_SPACING * i - hips)
                    for name in ("position", "centre_of_mass")
                }
            )
            draw_posture(ax, run.robot, shifted_walk, time, view="side", support=False)
            ax.text(_STANDING_SPACING * i, -0.05, f"{label(run.label)}\n{texts[i]}", ha="center", va="top", fontsize=12,
                    color=COLOURS[_shade(run.label, i)])  # fmt: skip
        ax.set_ylim(bottom=-0.17)
        ax.set_xticks([])
        ax.spines["bottom"].set_visible(False)
        ax.set_ylabel("height [m]")
    return captioned(figure, "From the right side, half of the time that it is meant to stand.")


def _forward_shift(record: xr.Dataset, distance: float) -> xr.DataArray:
    return xr.DataArray([distance, 0.0, 0.0], dims="xyz", coords={"xyz": record.xyz})


def _shade(name: str, number: int) -> str:
    return "neutral" if name == "start" else role(number - 1)


def draw_around(search: SearchResult) -> Figure:
    """Draw the first aim as each field alone moves to both sides of the best; crosses break a limit."""
    neighbourhood = search.neighbourhood
    assert neighbourhood is not None
    aim = search.spec.aims[0].name
    kind: Kind = AIMS[aim]
    fields, columns = search.fields, 4
    rows = ceil(len(fields) / columns)
    values, best = neighbourhood[f"aim_{aim}"].values, float(neighbourhood[f"aim_{aim}"].sel(step=0.0)[0])
    with styled(axes__labelsize=10, xtick__labelsize=9, ytick__labelsize=9):
        figure, axes = panels(rows, columns, width=10.5, height=0.7 + 1.9 * rows, sharey=True)
        for i, vary in enumerate(search.spec.vary):
            ax = axes.flat[i]
            scale, unit = scaled(search.spec.run, vary.field)
            positions = (
                np.array([value_at_fraction(vary, float(share)) for share in neighbourhood["at"].values[i]]) * scale
            )
            is_allowed = _allowed_steps(search, neighbourhood, i)
            ax.plot(positions, values[i], color=COLOURS["ours"], linewidth=1.2)
            ax.plot(positions[is_allowed], values[i][is_allowed], "o", color=COLOURS["ours"], markersize=5)
            ax.plot(
                positions[~is_allowed],
                values[i][~is_allowed],
                "x",
                color=COLOURS["alarm"],
                markersize=6,
                markeredgewidth=1.6,
            )
            ax.axhline(best, color=COLOURS["neutral"], linewidth=0.8, linestyle=(0, (2, 2)))
            ax.set_xlabel(f"{label(vary.field)}{f' [{unit}]' if unit else ''}")
        for ax in axes.flat[len(fields) :]:
            ax.set_axis_off()
        for ax in axes[:, 0]:
            ax.set_ylabel(f"{label(aim)} [{kind.unit}]")
    return captioned(
        figure,
        f"Around the best of {label(search.arm)}: each field alone moves by a twentieth and a tenth of its range. "
        "Crosses break a limit; what is missing could not be walked.",
    )


def _allowed_steps(search: SearchResult, neighbourhood: xr.Dataset, row: int) -> np.ndarray:
    """Tell which of the points beside the best keep all limits."""
    field_record = neighbourhood.isel(moved=row).rename(step="candidate")
    return is_allowed(search.spec, field_record)


def scaled(run: Run, field: str) -> tuple[float, str]:
    """Return the factor and the unit in which people read a field: millimetres, degrees."""
    unit = unit_at(run, field)
    return _MM.get(unit, (1.0, "" if unit == "-" else unit))
