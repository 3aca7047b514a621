"""Pictures of flows: vorticity, pressure, time series; and the validation's table and figures."""

import json
import re
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.errors import IncompatibleRecord
from suchus.flow import ALONG_THE_SKIN, Record, Simulation


def _panel(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained", dpi=110)
    return figure, figure.add_subplot()


def _field(sim: Simulation, values: np.ndarray, limit: float, label: str, cmap: str, shift: float) -> Figure:
    grid = sim.setup.grid
    wide, high = grid.size
    figure, axes = _panel(7.5, 1.0 + 6.2 * high / wide)
    x0, y0 = grid.origin[0] + shift * grid.cell, grid.origin[1] + shift * grid.cell
    extent = (x0, x0 + values.shape[1] * grid.cell, y0, y0 + values.shape[0] * grid.cell)
    image = axes.imshow(
        values, origin="lower", extent=extent, cmap=cmap, vmin=-limit, vmax=limit, interpolation="bilinear"
    )
    body = sim.fluid_share
    if body.min() < 0.5:
        axes.contourf(grid.x, grid.y, body, levels=[-1, 0.5], colors=["0.25"])
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.set_title(f"t = {sim.time:.3g} s", loc="left", fontsize="medium")
    figure.colorbar(image, ax=axes, label=label, shrink=0.85, extend="both")
    return figure


def vorticity(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the vorticity, red counter-clockwise; ``limit`` is the end of the scale [1/s]."""
    values = sim.vorticity
    end = float(np.quantile(np.abs(values), 0.99)) if limit is None else limit
    return _field(sim, values, max(end, 1e-9), "vorticity (1/s)", "RdBu_r", 0.5)


def pressure(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the pressure; ``limit`` is the end of the scale [Pa]."""
    values = sim.pressure
    end = float(np.quantile(np.abs(values), 0.99)) if limit is None else limit
    return _field(sim, values, max(end, 1e-9), "pressure (Pa)", "PuOr_r", 0.0)


def forces(record: Record, body: str | int = 0) -> Figure:
    """Return the force on a body over time, after the jolt of the first steps."""
    figure, axes = _panel(7.0, 3.0)
    force = record.force(body)
    for values, label in ((force[:, 0], "along x"), (force[:, 1], "along y")):
        axes.plot(record.time, values, label=label, linewidth=1.2)
    settled = force[len(force) // 20 :]
    low, high = float(settled.min()), float(settled.max())
    margin = 0.1 * max(high - low, 1e-12)
    axes.set_ylim(low - margin, high + margin)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("force (N/m)")
    axes.legend(frameon=False)
    return figure


def skin(sim: Simulation, body: str | None = None) -> Figure:
    """Return pressure and friction along a body's outline now, and what is known of their error."""
    surface = sim.surface(body)
    m = surface.markers
    place = np.cumsum(m.length) - m.length / 2
    friction = surface.shear[1] * m.normal_x - surface.shear[0] * m.normal_y
    figure = Figure(figsize=(7.5, 3.6), layout="constrained", dpi=110)
    for axes, values, label in zip(
        figure.subplots(1, 2), (surface.pressure, friction), ("pressure (Pa)", "friction, counter-clockwise (Pa)"),
        strict=True,
    ):  # fmt: skip
        axes.plot(place, values, linewidth=1.2)
        axes.set(xlabel="along the outline, counter-clockwise (m)", ylabel=label)
    figure.suptitle(f"t = {sim.time:.3g} s", fontsize="medium", x=0.02, ha="left")
    figure.supxlabel("\n".join(wrap(ALONG_THE_SKIN, 130)), fontsize="x-small", x=0.02, ha="left")
    return figure


def _rows(folder: Path) -> list[dict[str, Any]]:
    rows = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))]
    if not rows:
        raise IncompatibleRecord(f"{folder} holds no validation rows; run `make validate` first.")
    return rows


def _curves(rows: list[dict[str, Any]], case: str, part: str) -> dict[str, Any] | None:
    whole = re.compile(re.escape(part) + r"(?!\d)")  # Re 100 is not Re 1000
    found = [r["curves"] for r in rows if r["case"] == case and whole.search(r["quantity"]) and r["curves"]]
    return max(found, key=lambda curves: len(next(iter(curves.values())))) if found else None  # the fullest


def _draw_started(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(8.0, 3.0), layout="constrained", dpi=100)
    for k, reynolds in enumerate((40, 550)):
        axes = figure.add_subplot(1, 2, k + 1)
        curves = _curves(rows, "impulsively started cylinder", f"Re {reynolds}")
        if curves:
            axes.plot(curves["t"], curves["cd"], color="C0", alpha=0.5, linewidth=4, label="momentum exchanged")
            axes.plot(curves["t"], curves["box"], "C1--", linewidth=1.2, label="momentum box")
            axes.plot(curves["polar_t"], curves["polar_cd"], "k-", linewidth=0.8, label="polar coordinates")
            axes.plot(curves["data_t"], curves["data_cd"], "k.", label="Koumoutsakos and Leonard 1995")
            late = [c for t, c in zip(curves["t"], curves["cd"], strict=True) if t > 0.3]
            axes.set_ylim(0.8 * min(late), 1.15 * max(late))
            axes.set_xlim(0, max(curves["t"]))
            if k == 0:
                axes.legend(frameon=False, fontsize="small")
        axes.set_title(f"impulsively started cylinder, Re {reynolds}", fontsize="medium")
        axes.set_xlabel("t U / R")
        axes.set_ylabel("drag coefficient")
    return figure


def _draw_cavity(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(8.0, 3.0), layout="constrained", dpi=100)
    left, right = figure.subplots(1, 2)
    for reynolds, colour in ((100, "C0"), (1000, "C1")):
        curves = _curves(rows, "lid-driven cavity", f"Re {reynolds}")
        if curves:
            left.plot(curves["u"], curves["y"], colour, label=f"Re {reynolds}")
            left.plot(curves["data_u"], curves["data_y"], ".", color=colour)
            right.plot(curves["x"], curves["v"], colour)
            right.plot(curves["data_x"], curves["data_v"], ".", color=colour)
    left.set(xlabel="u over the lid's speed", ylabel="y", title="lid-driven cavity, x = 0.5")
    right.set(xlabel="x", ylabel="v over the lid's speed", title="y = 0.5; dots: Ghia et al. 1982")
    left.legend(frameon=False)
    return figure


def _draw_shaken(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(9.6, 3.0), layout="constrained", dpi=100)
    panels = figure.subplots(1, 3)
    curves = _curves(rows, "cylinder Re 185", "shaken")
    labels = ("mean drag coefficient", "rms lift coefficient", "lift ahead of the motion (deg)")
    for axes, name, label in zip(panels, ("cd", "cl", "phase"), labels, strict=True):
        if curves:
            axes.plot(curves["ratio"], curves[name], "o-", ms=4)
            low, high = np.transpose(curves[f"{name}_range"])
            axes.vlines(curves["ratio"], low, high, color="C0", alpha=0.4, lw=3, label="from period to period")
            if name != "phase":
                axes.axhline(curves[f"held_{name}"], color="k", ls=":", lw=1, label="held")
            if name == "cl":
                axes.legend(frameon=False, fontsize="small")
        axes.axvspan(1.1, 1.12, color="0.85", zorder=0)
        axes.set(xlabel="frequency over that of the held one", ylabel=label)
    panels[0].set_title("cylinder at Re 185, 0.2 D across", fontsize="medium", loc="left")
    panels[1].set_title("grey: a jump is published here", fontsize="medium", loc="left")
    return figure


def _draw_oscillating(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(8.0, 3.0), layout="constrained", dpi=100)
    force, energy = figure.subplots(1, 2)
    curves = _curves(rows, "oscillating cylinder, Re 100, KC 5", "force")
    if curves:
        force.plot(curves["phase"], curves["force"], "C0", label="momentum exchanged")
        force.plot(curves["data_phase"], curves["data_force"], "k.", label="Duetsch et al. 1998")
        force.legend(frameon=False, fontsize="small", loc="upper left")
    force.set(
        xlabel="time over the period", ylabel="force / ($\\rho U^2 D$)", title="oscillating cylinder, Re 100, KC 5"
    )
    found = {r["quantity"]: r["curves"] for r in rows if r["case"] == "energy budget" and "share" in r["curves"]}
    base: np.ndarray = np.zeros(1)
    for quantity, part in found.items():
        share, places = np.array(part["share"]), np.arange(len(part["share"]))
        base = base if base.size == share.size else np.zeros(share.size)
        energy.bar(places, share, 0.6, bottom=base, label=quantity.removeprefix("share of the work: "))
        base = base + share
        energy.set_xticks(places, [str(n) for n in part["cells"]])
    energy.set(xlabel="cells a diameter", ylabel="share of the body's work", title="work of one that shakes in a box")
    if found:
        energy.set_xlim(-0.6, len(base) + 0.6)
        energy.legend(frameon=False, fontsize="small", loc="center right", reverse=True)
    return figure


def _slope(axes: Axes, size: np.ndarray, error: np.ndarray, order: int, label: str) -> None:
    axes.loglog(size, 0.7 * error[-1] * (size[-1] / size) ** order, "k--" if order == 2 else "k:", lw=0.8, label=label)


def _draw_convergence(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(9.6, 3.1), layout="constrained", dpi=100)
    fields, forces, swim = figure.subplots(1, 3)
    for case, part, label in (
        ("Taylor-Green", "order", "Taylor-Green, whole field"),
        ("turning cylinder", "order", "turning cylinder, near the wall"),
    ):
        curves = _curves(rows, case, part)
        if curves:
            fields.loglog(curves["size"], curves["error"], "o-", ms=4, label=label)
            _slope(fields, np.array(curves["size"]), np.array(curves["error"]), 2, "")
    fields.set_ylim(bottom=6e-6)
    fields.set(xlabel="cells a side, a diameter", ylabel="rms error of the velocity", title="fields; dashed: order 2")
    for case, part, sizes, values, exact, label in (
        ("DFG 2D-1", "Cd", "rows", "cd", 5.57953523384, "Cd, DFG 2D-1"),
        ("turning cylinder", "order", "size", "torque", 0.0, "torque, turning cylinder"),
    ):
        curves = _curves(rows, case, part)
        if curves:
            size, value = np.array(curves[sizes]) / (4.1 if sizes == "rows" else 1.0), np.array(curves[values])
            error = np.abs(value / exact - 1) if exact else value
            forces.loglog(size, error, "o-", ms=4, label=label)
            _slope(forces, size, error, 1, "")
    forces.set_ylim(bottom=1e-5)
    forces.set(xlabel="cells a diameter", ylabel="relative error", title="force; dotted: order 1")
    for case in sorted({r["case"] for r in rows if r["case"].startswith("free eel")}):
        curves = _curves(rows, case, "mean speed")
        if curves:
            swim.plot(curves["cells"], curves["speed"], "o-", ms=4, label=case.removeprefix("free eel, "))
    swim.set(xlabel="cells along the body", ylabel="speed (L/T)", title="free eel, last cycle")
    swim.set_ylim(0, 0.8)
    for axes, ticks in ((fields, (16, 32, 64, 128)), (forces, (8, 16, 32, 64, 128)), (swim, (128, 192, 288, 384))):
        axes.set_xticks(ticks, [str(n) for n in ticks])
        axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        if axes.lines:
            axes.legend(frameon=False, fontsize="small", loc="lower left")
    return figure


def write_table(folder: Path, docs: Path, sources: tuple[str, ...] = ()) -> None:
    """Write ``validation.md`` to ``docs`` from the rows that the validation kept in ``folder``, and the ``sources``.

    Raises:
        IncompatibleRecord: there are no rows.
    """
    lines = [
        "# Validation of the flow solver", "",
        "Written by `make validate` (`tests/flow/test_validate_flow.py`); every row is a run of this code.",
        "What the rows mean and where they fall short: [how far it can be trusted](flow_limits.md).", "",
        "| case | quantity | ours | published or exact | difference | grid | domain | source |", "|" + "---|" * 8,
    ]  # fmt: skip
    for row in _rows(folder):
        theirs = row["theirs"]
        number = isinstance(theirs, int | float)
        off = f"{100 * (row['ours'] / theirs - 1):+.1f} %" if number and theirs else ""
        shown = f"{theirs:.4g}" if number else str(theirs)
        lines.append(
            f"| {row['case']} | {row['quantity']} | {row['ours']:.4g} | {shown} | {off} | {row['grid']} "
            f"| {row['domain']} | {row['source']} |"
        )
    if sources:
        lines += ["", "## Sources", "", *(f"- {source}" for source in sources)]
    for name in _FIGURES:
        lines += ["", f"![{name}](pictures/flow_{name}.png)"]
    page = docs / "validation.md"
    part = page.with_name(page.name + ".part")
    part.write_text("\n".join(lines) + "\n", encoding="utf-8")
    part.replace(page)


_FIGURES = {
    "started": _draw_started, "cavity": _draw_cavity, "shaken": _draw_shaken, "oscillating": _draw_oscillating,
    "convergence": _draw_convergence,
}  # fmt: skip


def write_validation(folder: Path, docs: Path, sources: tuple[str, ...] = ()) -> None:
    """Write ``validation.md``, with ``sources``, and its figures to ``docs`` from the rows kept in ``folder``.

    Raises:
        IncompatibleRecord: there are no rows.
    """
    rows = _rows(folder)
    pictures = docs / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    for name, draw in _FIGURES.items():
        draw(rows).savefig(pictures / f"flow_{name}.png")
    write_table(folder, docs, sources)
