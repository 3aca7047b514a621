"""Pictures of the closed loop: limbs that find their gait, what each rule gains, where a disturbed robot goes.

And the topology of the article's Fig. 10: sensors, controllers and what they share, as the code has them.
"""

from collections.abc import Mapping, Sequence
from math import ceil
from types import MappingProxyType
from typing import Any, Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from suchus.robot.control.shared import OWNERS
from suchus.robot.control.topology import ControlPart
from suchus.robot.motion import Gait
from suchus.visual.figures.style import COLOURS, DIVERGING, captioned, new, panels, styled

_LAWS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "off": ("no feedback", COLOURS["neutral"]),
        "own_load": ("own foot's load", COLOURS["tail_drag"]),
        "cross_load": ("loads of all feet", COLOURS["coordinated"]),
        "body_limb": ("torque of the trunk", COLOURS["spine_only"]),
        "wrong_sign": ("wrong sign", COLOURS["alarm"]),
        "closed_noisy": ("all rules, noisy feet", COLOURS["coordinated"]),
    }
)
_ARMS: Final[Mapping[str, tuple[str, str, Any]]] = MappingProxyType(
    {
        "open": ("no feedback", COLOURS["limbs_only"], (0, (5, 2))),
        "closed": ("three rules", COLOURS["coordinated"], "-"),
        "steered": ("three rules and heading loop", COLOURS["tail_drag"], (0, (5, 1.5, 1, 1.5))),
    }
)
_RULES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "open": "none",
        "limbs": "limbs",
        "spine": "spine",
        "tail": "tail",
        "closed": "all three",
        "steered": "+ heading",
    }
)
_DISTURBANCE_LABELS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "none": "undisturbed",
        "kick": "limbs kicked out of phase",
        "locked_spine": "middle spine joint stuck",
        "uphill": "uphill",
        "downhill": "downhill",
        "side_slope": "slope, left side up",
        "other_side": "slope, right side up",
        "push": "push from the right",
        "limp_yaw": "front yaw limp",
        "load_noise": "noisy feet",
    }
)


def draw_fans(error: xr.DataArray, tolerance: float) -> Figure:
    """Draw the phase error of every start over the cycles, one panel per law.

    Args:
        error: error with the dimensions ``law``, ``start`` and ``time`` (in cycles) [cycle].
        tolerance: what counts as coordinated [cycle].
    """
    with styled():
        figure, axes = panels(2, 3, width=10.5, height=5.6, sharex=True, sharey=True)
        laws = [law for law in _LAWS if bool(error.sel(law=law).notnull().any())]
        for ax in axes.flat[len(laws) :]:
            ax.set_axis_off()
        for ax, law in zip(axes.flat, laws, strict=False):
            label, colour = _LAWS[law]
            errors = error.sel(law=law).transpose("time", "start").dropna("time", how="all").dropna("start", how="all")
            ax.axhspan(0.0, tolerance, color=COLOURS["grid"], linewidth=0)
            ax.plot(errors.time, errors, color=colour, linewidth=0.8, alpha=0.5, label="_each start")
            ax.plot(
                errors.time,
                errors.median("start", skipna=False),
                color="black",
                linewidth=2.0,
                label="_median of the starts",
            )
            ax.set_title(label)
            ax.set_xlim(0.0, float(error.time[-1]))
            ax.set_ylim(0.0, 0.52)
        for ax in axes[-1]:
            ax.set_xlabel("cycles since the start")
        for ax in axes[:, 0]:
            ax.set_ylabel("phase error [cycle]")
    return captioned(
        figure,
        "How far the limbs are from the gait, from random starts under each law, with more and shorter starts where "
        "the fraction that converges is judged; the black line is the median, the grey band counts as coordinated. "
        "Noisy feet: 30 % noise on every load, spine and tail rules on. A line that ends early is of a start of which "
        "it is known by then whether it converges.",
    )


def draw_onset(phase: xr.DataArray, gait: Gait) -> Figure:
    """Draw which feet are commanded to stand from the first random start, without and with feedback.

    Args:
        phase: phase of the limbs over ``law``, ``start``, ``start_time`` (in cycles) and ``leg`` [cycle].
        gait: gait that the robot walks.
    """
    with styled(axes__grid=False):
        figure, axes = panels(3, 1, height=5.4, sharex=True)
        for ax, law in zip(axes.flat, ("off", "own_load", "cross_load"), strict=True):
            phases = phase.sel(law=law).isel(start=0).transpose("start_time", "leg")
            stands = np.mod(phases.values, 1.0) >= 1.0 - gait.duty_factor
            _bars(ax, phases.start_time.values, stands, [str(leg) for leg in phases.leg.values])
            ax.set_title(_LAWS[law][0])
        axes[-1, 0].set_xlabel("cycles since the start")
    return captioned(
        figure,
        "Feet that are commanded to stand (bars) from one random start, without feedback and under two laws. Blue: one "
        "diagonal pair of limbs, orange: the other; in the gait the pairs take turns.",
    )


def _bars(ax: Axes, time: np.ndarray, stands: np.ndarray, legs: Sequence[str]) -> None:
    """Draw a bar for each interval in which a foot is commanded to stand, one row per leg.

    Args:
        ax: axes to draw on.
        time: equidistant times [cycle].
        stands: whether each foot is commanded to stand, shape (time, leg).
        legs: names of the legs.
    """
    width = float(time[1] - time[0])
    for row in range(len(legs)):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], stands[:, row].astype(int), [0]])))
        spans = [(time[a], width * (b - a)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
        colour = COLOURS["coordinated"] if (row % 2 + row // 2) % 2 == 0 else COLOURS["RH"]
        ax.broken_barh(spans, (row - 0.36, 0.72), facecolors=colour)
    ax.set_yticks(range(len(legs)), legs)
    ax.set_ylim(len(legs) - 0.4, -0.6)
    ax.set_xlim(max(0.0, float(time[0])), float(time[-1]))


def draw_gain(distance: xr.DataArray) -> Figure:
    """Draw the distance after each disturbance under each rule, over the undisturbed distance without feedback.

    Args:
        distance: distance with the dimensions ``disturbance`` and ``arm`` [m].
    """
    ratio = (distance / distance.sel(disturbance="none", arm="open").item()).transpose("disturbance", "arm")
    rules = [rule for rule in _RULES if rule in ratio.arm.values]
    names = [name for name in _DISTURBANCE_LABELS if name in ratio.disturbance.values]
    ratio = ratio.sel(arm=rules, disturbance=names)
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=8.2, height=5.2)
        ax = axes[0, 0]
        min_percent, max_percent = min(20, int(100 * ratio.min())), max(140, ceil(100 * ratio.max()))
        scale = TwoSlopeNorm(100.0, vmin=min_percent, vmax=max_percent)
        mesh = ax.pcolormesh(100 * ratio.values, cmap=DIVERGING, norm=scale, edgecolors="white", linewidth=2)
        for (row, column), value in np.ndenumerate(ratio.values):
            if np.isnan(value):  # nothing is measured of this rule here, and it does not walk
                continue
            is_dark = not 0.5 < value < 1.3
            ax.text(
                column + 0.5,
                row + 0.5,
                f"{100 * value:.0f}",
                ha="center",
                va="center",
                color="white" if is_dark else "black",
            )
        ax.set_xticks(np.arange(len(rules)) + 0.5, [_RULES[rule] for rule in rules])
        ax.set_yticks(np.arange(len(names)) + 0.5, [_DISTURBANCE_LABELS[name] for name in names])
        ax.tick_params(length=0)
        ax.invert_yaxis()
        ax.set_xlabel("which rules are on")
        for side in ax.spines.values():
            side.set_visible(False)
        figure.colorbar(
            mesh,
            ax=ax,
            label="displacement forward [%]",
            pad=0.02,
            ticks=range(20 * (min_percent // 20), max_percent + 1, 20),
        )
    return captioned(
        figure,
        "Displacement in the cycles after a disturbance, in percent of that without disturbance and feedback; "
        "the last column adds the heading loop to all three rules.",
    )


def draw_tracks(record: xr.Dataset, disturbances: Sequence[str]) -> Figure:
    """Draw the path of the robot after each disturbance from above.

    Args:
        record: ``x`` and ``y`` over ``disturbance``, ``arm`` and ``time`` [m], from the disturbance on.
        disturbances: names of the disturbances, one panel each.
    """
    size = float((record.x - record.x.isel(time=0)).max())
    with styled():
        figure, axes = panels(1, len(disturbances), width=10.5, height=4.8)
        for ax, name in zip(axes.flat, disturbances, strict=True):
            for arm, (label, colour, dashes) in _ARMS.items():
                track = record.sel(disturbance=name, arm=arm)
                x, y = track.x - track.x.isel(time=0), track.y - track.y.isel(time=0)
                ax.plot(-y, x, color=colour, linestyle=dashes, label=label)
                ax.plot(-y[-1], x[-1], "o", color=colour, label=f"_end, {label}")
            ax.plot(0, 0, "s", color="black", label="_start")
            ax.set_aspect("equal", adjustable="datalim")
            if size > 0.5:  # [m]; a small robot gets no farther than a few hundredths
                ax.xaxis.set_major_locator(MultipleLocator(0.5))
                ax.yaxis.set_major_locator(MultipleLocator(0.5))
            ax.set_title(_DISTURBANCE_LABELS[name])
            ax.set_xlabel("to the right [m]")
        axes[0, 0].set_ylabel("forward [m]")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return captioned(
        figure,
        "The centre of mass from above, from the disturbance (square) on. The three rules do not feel a direction; "
        "the heading loop does and walks with longer strokes on one side.",
    )


_ROLES = {"limbs": "LF", "spine": "spine", "tail": "tail", "heading": "RH"}
_SENSORS, _CONTROLLERS, _SHARED = 2.0, 1.0, 0.0  # heights of the three rows
_BOX = {"boxstyle": "round,pad=0.45", "facecolor": "white", "linewidth": 1.4}


def draw_topology(controllers: Sequence[ControlPart]) -> Figure:
    """Draw which sensors each controller reads, which shared variables it writes, and which ones it reads.

    Args:
        controllers: controllers of ``control.topology``.
    """
    sensors = sorted({name for controller in controllers for name in controller.feels})
    positions = {
        **{f"feels {name}": (x, _SENSORS) for name, x in zip(sensors, _spread(len(sensors)), strict=True)},
        **{
            controller.name: (x, _CONTROLLERS)
            for controller, x in zip(controllers, _spread(len(controllers)), strict=True)
        },
        **{f"shared {name}": (x, _SHARED) for name, x in zip(OWNERS, _spread(len(OWNERS)), strict=True)},
    }
    with styled():
        figure = new(width=11.0, height=5.4)
        ax = figure.add_subplot()
        boxes = {name: _box(ax, name, position) for name, position in positions.items()}
        for controller in controllers:
            colour = _colour(controller.name)
            for name in sorted(controller.feels):
                _arrow(ax, boxes[f"feels {name}"], boxes[controller.name], colour, "-")
            for name in sorted(controller.writes):
                _arrow(ax, boxes[controller.name], boxes[f"shared {name}"], colour, "-")
            for name in sorted(controller.hears - controller.writes):
                _arrow(ax, boxes[f"shared {name}"], boxes[controller.name], colour, (0, (4, 2)))
        for y, text in ((_SENSORS, "sensors"), (_CONTROLLERS, "controllers"), (_SHARED, "shared")):
            ax.text(-0.08, y, text, ha="right", va="center", color=COLOURS["neutral"])
        ax.set(xlim=(-0.2, 1.05), ylim=(-0.4, 2.4))
        ax.set_axis_off()
    return captioned(figure, _caption(controllers))


def _caption(parts: Sequence[ControlPart]) -> str:
    """Return the caption of the topology, with the controllers that use no shared variables."""
    isolated = [controller.name for controller in parts if not controller.hears and not controller.writes]
    isolated_text = f" Apart from the shared variables: {', '.join(isolated)}." if isolated else ""
    return (
        "What each controller reads and writes, in the form of the article's Fig. 10. Arrows from sensors: what it "
        "senses; solid arrows down: the shared variables that it writes; dashed arrows up: those of others that it "
        "reads." + isolated_text
    )


def _colour(controller: str) -> str:
    """Return the colour of a controller."""
    return COLOURS[_ROLES.get(controller, "neutral")]


def _box(ax: Any, name: str, position: tuple[float, float]) -> Any:
    """Draw the box of a sensor, a controller or a shared variable, in the colour of its controller.

    Args:
        ax: axes to draw on.
        name: ``feels SENSOR``, ``shared VARIABLE`` or the name of a controller.
        position: centre of the box [axis units].

    Returns:
        The text artist of the box.
    """
    kind, _, quantity = name.partition(" ")
    owner = OWNERS[quantity] if kind == "shared" else "" if kind == "feels" else name
    style = _BOX | {"edgecolor": _colour(owner)}
    weight = "normal" if quantity else "bold"
    return ax.text(
        *position, (quantity or name).replace("_", "\n"), ha="center", va="center", bbox=style, fontweight=weight
    )


def _arrow(ax: Any, start: Any, end: Any, colour: str, dashes: Any) -> None:
    """Draw an arrow between two boxes that ``_box`` returned."""
    ends = {"patchA": start.get_bbox_patch(), "patchB": end.get_bbox_patch(), "shrinkA": 3, "shrinkB": 3}
    style = {"arrowstyle": "-|>", "color": colour, "linestyle": dashes, "linewidth": 1.5, **ends}
    ax.annotate("", end.get_position(), start.get_position(), arrowprops=style)


def _spread(count: int) -> list[float]:
    """Return horizontal positions of a row of boxes, evenly spread over 0 to 1."""
    return [float(x) for x in (np.arange(count) + 0.5) / max(count, 1)]
