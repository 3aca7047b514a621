"""The robot's body in three dimensions: its speed beside slice and models, its wake, higher tails, joint torques."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from suchus.experiments.catalog._taken import AS_TAKEN
from suchus.visual.figures.fields import VORTICITY, span
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_DOTS = ((0, (1, 1.5)), (0, (3, 1, 1, 1)))


def drive_caption(record: xr.Dataset) -> str:
    """Return a clause for captions if the robot's own joints move the body; otherwise nothing."""
    return ", moved by its own joints," if record.attrs["joints"] else ""


def draw_speeds(record: xr.Dataset) -> Figure:
    """Draw the mean speed of each cycle on every grid, beside the slice and the slender-body models.

    Args:
        record: record of the experiment ``swim_3d``.
    """
    shades = np.linspace(0.4, 1.0, record.sizes["grid"])
    with styled():
        figure, axes = panels(1, 1, width=8.0, height=5.0)
        ax = axes[0, 0]
        ax.plot(record.cycle, 1e3 * record.slice_speed, "s-", color=COLOURS["tail"], label="slice of unlimited depth")
        for model, dots in zip(record.model.values, _DOTS, strict=True):
            speed = 1e3 * float(record.model_speed.sel(model=model))
            ax.axhline(speed, color=COLOURS["neutral"], linestyle=dots, label=f"{model} model")
        for speed, cells, shade in zip(record.speed.values, record.cells.values, shades, strict=True):
            ax.plot(record.cycle, 1e3 * speed, "o-", color=COLOURS["ours"], alpha=shade, label=f"body, {cells} cells")
        ax.set_yscale("log")
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
        ax.set(xlabel="cycle [-]", ylabel="mean speed [mm/s]")
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=11)
    reference_text = (
        "the slice and the slender-body models of the round body" + ", which are commanded" * record.attrs["joints"]
    )
    return captioned(
        figure,
        f"Mean speed of each cycle from rest, at f L² / ν = {float(record.reynolds):.0f}: the robot's body in three "
        f"dimensions{drive_caption(record)} on grids of so many cells a length, and {reference_text}.",
    )


def draw_wake(record: xr.Dataset) -> Figure:
    """Draw the wake at the end: vorticity in the plane of symmetry, and the vortices seen from above and the side.

    Args:
        record: record of the experiment ``swim_3d``.
    """
    limit = span(record.vorticity.values, 0.985)
    vortex_limit = float(np.quantile(record.vortices_above.values, 0.985))
    panel_width, panel_height = float(np.ptp(record.y.values)), 2.0 * float(record.z.max())  # one scale in all panels
    with styled(axes__grid=False):
        figure, axes = panels(
            3, 1, width=9.0, height=10.5, sharex=True, height_ratios=[panel_width, panel_width, panel_height]
        )
        ax = axes[0, 0]
        image = ax.pcolormesh(record.x, record.y, record.vorticity, vmin=-limit, vmax=limit, cmap=VORTICITY)
        figure.colorbar(image, ax=ax, label="vorticity about z [1/s]", extend="both")
        ax.set_title("In the plane of symmetry", fontsize=12)
        for ax, name, title in (
            (axes[1, 0], "vortices_above", "Vortices from above"), (axes[2, 0], "vortices_beside", "and from the side"),
        ):  # fmt: skip
            values, dimension = record[name].values, record[name].dims[0]
            positions = record[str(dimension)].values
            if dimension == "z":  # the other half is the image
                values, positions = (
                    np.concatenate([values[::-1], values]),
                    np.concatenate([-positions[::-1], positions]),
                )
            image = ax.pcolormesh(record.x, positions, values, vmin=0.0, vmax=vortex_limit, cmap="Purples")
            figure.colorbar(image, ax=ax, label="Q [1/s²]", extend="both")
            ax.set_title(title, fontsize=12)
        for ax in axes[:2, 0]:
            _draw_body_above(ax, record)
            ax.set_ylabel("y [m]")
        x, half_height = record.midline_x.values, record.half_height.values
        axes[2, 0].fill_between(x, -half_height, half_height, color="#6b705c", linewidth=0)
        axes[2, 0].set(xlabel="x [m], head to tail", ylabel="z [m]")
        for ax in axes[:, 0]:
            ax.set_aspect("equal")
    return captioned(
        figure,
        f"The water around the body at the end, on {int(record.cells[-1])} cells a length at f L² / ν "
        f"= {float(record.reynolds):.0f}: vorticity in the plane of symmetry, and the greatest second invariant Q of "
        "the velocity's gradient along the line of sight, from above and from the side.",
    )


def _draw_body_above(ax: Axes, record: xr.Dataset) -> None:
    """Draw the body as seen from above."""
    x, y = record.midline_x.values, record.midline_y.values
    heading, half_width = record.midline_heading.values, record.midline_half_width.values
    nx, ny = -np.sin(heading) * half_width, np.cos(heading) * half_width
    ax.fill(np.concatenate([x + nx, (x - nx)[::-1]]), np.concatenate([y + ny, (y - ny)[::-1]]), color="#6b705c")


def draw_tails(record: xr.Dataset) -> Figure:
    """Draw the speed over the cycles for every height of the tail, and that of the motions beside it.

    Args:
        record: record of the experiment ``swim_3d``.
    """
    names = [str(name) for name in record.compared.values]
    colours: dict[tuple[Axes, str], object] = {}
    has_midlines = any(name.endswith(AS_TAKEN) for name in names)
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=5.6, sharey=True)
        for name in names:
            motion_record, motion = record.sel(compared=name), name.removesuffix(AS_TAKEN)
            height, is_reference = float(motion_record.tail_height), name == "trunk and tail"
            label = f"last third {height:g} m high" if height else "the robot's tail" if is_reference else name
            for ax, is_in_panel in zip(axes[0], (height > 0 or is_reference, height == 0), strict=True):
                if is_in_panel:
                    (line,) = ax.plot(
                        record.compared_cycle, 1e3 * motion_record.compared_speed, "o-" if name == motion else "o--",
                        label=label, color=colours.get((ax, motion)),
                        markerfacecolor=None if name == motion else "white",
                    )  # fmt: skip
                    colours.setdefault((ax, motion), line.get_color())
        for ax in axes[0]:
            ax.axhline(0.0, color="#999999", linewidth=0.8)
            ax.xaxis.set_major_locator(MaxNLocator(integer=True))
            ax.set_xlabel("cycle [-]")
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, fontsize=11)
        axes[0, 0].set_ylabel("mean speed [mm/s]")
    right = ["the motions of trunk and tail alone", "the printed direction of (20)", "the limbs folded back"]
    right += ["the midline that is commanded, where the others are moved by their own joints"] * record.attrs["joints"]
    return captioned(
        figure,
        f"Mean speed of each cycle on {float(record.compared_cells):.0f} cells a length at f L² / ν = "
        f"{float(record.reynolds):.0f}. Left: the last third of the body raised to a fin as thick as the tail. Right: "
        f"{', '.join(right[:-1])}, and {right[-1]}."
        + " Dashed: the midline that the joints take of the same commands in six degrees of freedom."
        * has_midlines,
    )


def draw_joints(record: xr.Dataset) -> Figure:
    """Draw the torque of the water about each joint over the last cycle.

    Args:
        record: record of the experiment ``swim_3d``.
    """
    order = np.argsort(record.joint_place.values)
    torque = record.joint_torque.values[:, order]
    with styled():
        figure, axes = panels(1, 1, width=8.0, height=4.2)
        ax = axes[0, 0]
        ax.plot(record.joint_place.values[order], np.abs(torque).max(axis=0), "o-", color=COLOURS["ours"], label="peak")
        root_mean_square = np.sqrt((torque**2).mean(axis=0))
        ax.plot(record.joint_place.values[order], root_mean_square, "s--", color=COLOURS["neutral"],
                label="root mean square")  # fmt: skip
        ax.set(xlabel="joint, behind the snout [m]", ylabel="torque of the water [N m]")
        ax.set_ylim(bottom=0.0)
        ax.legend()
    return captioned(
        figure,
        "Torque about each joint of what the water does behind it, over the last cycle on the finest grid, at f L² / ν "
        f"= {float(record.reynolds):.0f}. A yaw servo's limit is {float(record.servo_limit[0]):g} N m.",
    )
