"""Bodies at the surface: righting levers, how a robot rolls upright, and forces beside exact answers."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus import rotation
from suchus.figures.style import COLOURS, captioned, panels, styled

_DASHES = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)), (0, (3, 1)))
_SHADES = (COLOURS["coordinated"], COLOURS["limbs_only"], COLOURS["tail_drag"], COLOURS["spine_only"], "#333333")


def draw_righting(record: xr.Dataset) -> Figure:
    """Draw the righting lever over the heel, and the heel over time of robots that were let go.

    Args:
        record: with ``lever`` (hull, heel) [m], and runs with ``orientation``.
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.2)
        ax = axes[0, 0]
        heel = np.degrees(record.heel.values)
        floats = {str(hull): float(record.static_surplus.sel(hull=hull)) < 0 for hull in record.hull.values}
        for hull, dashes, colour in (("floating", "-", "coordinated"), ("bare", (0, (5, 2)), "limbs_only")):
            where = "at the surface" if floats[hull] else "sunk"
            label = f"{'with' if hull == 'floating' else 'without'} its hull, {where}"
            ax.plot(heel, 1e3 * record.lever.sel(hull=hull), color=COLOURS[colour], linestyle=dashes, label=label)
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set(xlabel="heel [deg]", ylabel="righting lever GZ [mm]", xlim=(0, 180), xticks=range(0, 181, 30))
        ax.legend(loc=(0.26, 0.24))
        ax = axes[0, 1]
        for i, label in enumerate(record.label.values):
            turn = record.orientation.isel(run=i).values
            roll = np.degrees(np.arctan2(*(rotation.rotate(turn, np.eye(3)[axis])[:, 2] for axis in (1, 2))))
            ax.plot(record.time, roll, color=_SHADES[i % 5], linestyle=_DASHES[i % 5], label=f"from {label}")
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set(xlabel="time [s]", ylabel="heel [deg]", xlim=(0, min(10.0, float(record.time[-1]))))
        ax.legend(loc="best")
    return captioned(
        figure,
        "Righting lever over the heel with draft and trim free, positive where the water turns the robot upright; and "
        "the heel over time of the robot let go at the surface.",
    )


def draw_checks(record: xr.Dataset) -> Figure:
    """Draw drafts beside exact ones, and the energy of a box that rocks.

    Args:
        record: with ``body_draft`` and ``exact_draft`` (float) [m], ``energy`` (integrator, box_time) [J].
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.2)
        ax = axes[0, 0]
        kinds = [str(name).split()[0] for name in record["float"].values]
        for kind, marker, colour in (("sphere", "o", 0), ("cylinder", "s", 1), ("box", "^", 2)):
            mine = [i for i, one in enumerate(kinds) if one == kind]
            exact, found = 1e3 * record.exact_draft[mine], 1e3 * record.body_draft[mine]
            ax.plot(exact, found, marker, markersize=9, color=_SHADES[colour], label=kind)
        most = 1.1e3 * float(record.exact_draft.max())
        ax.plot([0, most], [0, most], color=COLOURS["neutral"], linewidth=0.9, zorder=0)
        ax.set(xlabel="exact draft [mm]", ylabel="draft in the physics step [mm]", xlim=(0, most), ylim=(0, most))
        ax.legend(loc="upper left")
        ax = axes[0, 1]
        for i, name in enumerate(record.integrator.values):
            energy = record.energy.sel(integrator=name)
            ax.plot(
                record.box_time, 1e3 * (energy - energy[0]), color=_SHADES[i], linestyle=_DASHES[i],
                label=f"{name}, {1e2 * float(record.gained.sel(integrator=name)):.2g} % gained at most",
            )  # fmt: skip
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set(xlabel="time [s]", ylabel="energy less that at the start [mJ]")
        ax.margins(y=0.3)
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "Drafts of floats at three densities beside closed forms, the line being equality; and the energy of a box "
        "without drag that was let go heeled and pitched.",
    )
