"""Swimming: the pressure around the held body, forces over a cycle, the free swim."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from suchus.figures.style import COLOURS, DIVERGING, captioned, panels, styled

_SKIN, _EDGE = "#C9DCCB", "#2F4737"
_QUARTERS = ("T/4", "T/2", "3T/4", "T")


def draw_pressure(record: xr.Dataset) -> Figure:
    """Draw the pressure around the held body at the four quarters of a cycle, as the article's Fig. 17.

    Args:
        record: of the experiment ``swimming``.
    """
    x, y = record.held_x.values, record.held_y.values
    pressure = record.held_pressure.values
    limit = float(np.quantile(np.abs(pressure), 0.985))
    with styled(axes__grid=False):
        figure, axes = panels(2, 2, width=10.5, height=6.4, sharex=True, sharey=True)
        for i, (ax, name) in enumerate(zip(axes.flat, _QUARTERS, strict=True)):
            image = ax.pcolormesh(x, y, pressure[i], cmap=DIVERGING, vmin=-limit, vmax=limit, shading="gouraud")
            image.set_rasterized(True)
            _body(ax, record, "held", i)
            difference = float(record.held_difference[i])
            ax.set_title(f"{name}: convex side of the tail {difference:+.0f} Pa", fontsize=12)
            ax.set_aspect("equal")
            ax.set_xlim(-0.35, 1.45 * record.held_midline_x.values.max())
            ax.set_ylim(-0.5, 0.5)
        for ax in axes[1]:
            ax.set_xlabel("x [m], head to tail")
        for ax in axes[:, 0]:
            ax.set_ylabel("y [m]")
        figure.colorbar(image, ax=axes, label="pressure [Pa]", shrink=0.8, extend="both")
    return captioned(
        figure,
        "Pressure around the body held at its snout, at the four quarters of (20) as it runs from head to tail. "
        "The numbers are the mean pressure along the convex side of the tail less that along the concave side.",
    )


def draw_forces(record: xr.Dataset) -> Figure:
    """Draw forces over the last cycle, ours and as printed, and what the joints carry.

    Args:
        record: of the experiment ``swimming``.
    """
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.2)
        ax = axes[0, 0]
        ax.axhline(0.0, color="#999999", linewidth=0.8)
        for name, label, colour in (
            ("held", "head to tail", COLOURS["ours"]),
            ("printed", "as printed, tail to head", COLOURS["limbs_only"]),
        ):
            thrust = record[f"{name}_thrust"]
            ax.plot(record[f"{name}_phase"], thrust, color=colour, label=label)
            ax.axhline(float(thrust.mean()), color=colour, linestyle=(0, (4, 2)), linewidth=1.2)
        ax.set_xlabel("phase of the last cycle [T]")
        ax.set_ylabel("force forward [N/m]")
        _room_above(ax)
        ax.legend(loc="upper left", fontsize=10)
        ax = axes[0, 1]
        labels = ("yaw 1, at the pelvis", "yaw 2", "yaw 3, at the neck", "tail root")
        for label, joint in zip(labels, record.joint.values, strict=True):
            ax.plot(record.held_phase, record.held_joint_torque.sel(joint=joint), label=label)
        ax.set_xlabel("phase of the last cycle [T]")
        ax.set_ylabel("moment of the water [N m/m]")
        _room_above(ax)
        ax.legend(loc="upper left", ncols=2, fontsize=10)
        for ax in axes[0]:
            ax.set_xlim(0.0, 1.0)
    return captioned(
        figure,
        "Left: force along the body over the last cycle, dashed its mean; the wave as printed gives a fifth. "
        "Right: moment about each joint of what the water does to the part beyond it. All per metre of depth.",
    )


def draw_free(record: xr.Dataset) -> Figure:
    """Draw the free swim: its wake, its speed over the cycles, and what trunk and tail each do.

    Args:
        record: of the experiment ``swimming``.
    """
    with styled(axes__grid=False):
        figure, axes = panels(2, 1, width=10.5, height=7.6, height_ratios=[1.35, 1])
        ax = axes[0, 0]
        vorticity = record.free_vorticity.values
        limit = float(np.quantile(np.abs(vorticity), 0.97))
        image = ax.pcolormesh(
            record.free_corner_x, record.free_corner_y, vorticity, cmap="RdBu_r", vmin=-limit, vmax=limit,
            shading="gouraud",
        )  # fmt: skip
        image.set_rasterized(True)
        _body(ax, record, "free", None)
        ax.set_aspect("equal")
        ax.set_xlim(-0.4, float(record.free_corner_x[-1]))
        ax.set_ylim(-0.6, 0.6)
        ax.set_xlabel("x [m]; it swims to the left")
        ax.set_ylabel("y [m]")
        figure.colorbar(image, ax=ax, label="vorticity [1/s]", shrink=0.85, extend="both")
        ax = axes[1, 0]
        ax.grid(True)
        cycles = record.cycle.values
        styles = ((COLOURS["ours"], "o"), (COLOURS["spine"], "s"), (COLOURS["tail"], "^"), (COLOURS["limbs_only"], "v"))
        for arm, (colour, marker) in zip(record.arm.values, styles, strict=True):
            ax.plot(cycles, record.arm_speed.sel(arm=arm), color=colour, marker=marker, label=str(arm))
        for model, dashes in zip(record.model.values, ((0, (1, 1.5)), (0, (5, 2))), strict=True):
            speed = float(record.model_speed.sel(model=model))
            ax.axhline(speed, color=COLOURS["neutral"], linestyle=dashes, label=f"{model} model, round body")
        ax.set_xlabel("cycle")
        ax.set_ylabel("mean speed [m/s]")
        ax.axhline(0.0, color="#999999", linewidth=0.8)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, fontsize=11)
    return captioned(
        figure,
        "Free swimming from rest. Above: vorticity at the end, red counter-clockwise. Below: mean speed of each cycle, "
        "forward positive; grey what the cheap models say of the round body.",
    )


def _room_above(ax: Axes) -> None:
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.35 * (high - low))


def _body(ax: Axes, record: xr.Dataset, name: str, instant: int | None) -> None:
    x, y, heading, half = (record[f"{name}_midline_{what}"].values for what in ("x", "y", "heading", "half_width"))
    if instant is not None:
        x, y, heading, half = x[instant], y[instant], heading[instant], half[instant]
    across = np.column_stack([-np.sin(heading), np.cos(heading)]) * half[:, None]
    line = np.column_stack([x, y])
    outline = np.vstack([line + across, (line - across)[::-1]])
    ax.add_patch(Polygon(outline, facecolor=_SKIN, edgecolor=_EDGE, linewidth=1.1, zorder=3))
    ax.plot(x, y, color=_EDGE, linewidth=0.9, linestyle=(0, (4, 2)), zorder=4)
