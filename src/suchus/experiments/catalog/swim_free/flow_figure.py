"""Swims in a flow that is solved with the robot: speeds, joint angles, forces on the links, and energy balance."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.experiments.catalog.swim_free.in_flow import FIN, fins
from suchus.visual.figures.fields import VORTICITY, draw_body, draw_field, move_body, smooth, span
from suchus.visual.figures.film import film
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_LINES = (COLOURS["coordinated"], COLOURS["tail_still"], COLOURS["ours"], COLOURS["neutral"], "#666666", "#AAAAAA")


def draw_in_flow(record: xr.Dataset) -> Mapping[str, Figure]:
    """Draw speeds, forces, residuals and energy balance of the swims in the flow.

    Args:
        record: record of the experiment ``swim_free`` with a flow; see ``in_flow``.
    """
    fin_swims = fins(record)
    fin_figures = {"flow_fin": _fins(record, fin_swims)} if fin_swims.stiffness.size > 1 else {}
    return {
        **fin_figures, "flow_speeds": _speeds(record), "flow_links": _links(record), "flow_residual": _residual(record),
        "flow_balance": _balance(record),
    }  # fmt: skip


def film_slice(record: xr.Dataset) -> Mapping[str, bytes]:
    """Return the last cycle of the first swim in a slice as a film of its vorticity; nothing without fields."""
    if "field_vorticity" not in record:
        return {}
    values, phase = record.field_vorticity.values, record.field_frame.values
    with styled(axes__grid=False, figure__dpi=68):
        figure, axes = panels(1, 1, width=9.6, height=4.3)
        ax = axes[0, 0]
        image = draw_field(ax, record, "field", "vorticity", 0, span(values, 0.97), VORTICITY)
        body = draw_body(ax, record, "field", 0)
        ax.set(xlabel="x [m]; it swims to the left", ylabel="y [m]")
        figure.colorbar(image, ax=ax, label="vorticity [1/s]", shrink=0.85, extend="both")

        def show(i: int) -> None:
            image.set_data(smooth(values[i]))
            move_body(body, record, "field", i)
            ax.set_title(f"t = {phase[i]:.2f} T", fontsize=12)

        caption = (
            f"Vorticity over the last cycle of the whole wave in {_water_text(record)}, red counter-clockwise; the "
            "picture travels with the body."
        )
        return {"swim_in_flow.gif": film(figure, show, len(values), seconds=2.4, caption=caption)}


_MAX_LARGE_NAMES = 16
"""Most names beside a picture that are written in the usual size [-]."""


def _label(name: object) -> str:
    return str(name).replace("_", " ")


def _water_text(record: xr.Dataset) -> str:
    water = "a slice of water" if record.attrs["flow"] == "slice" else "water in space"
    return f"{water} at f L² / ν = {float(record.reynolds):.0f}"


def _speeds(record: xr.Dataset) -> Figure:
    """Draw the mean speed of each cycle by swim, and the joint angles over the last cycle of the first swim."""
    time, period = record.flow_time.values, float(record.flow_period)
    with styled():
        figure, axes = panels(1, 2, width=9.5, height=4.0)
        left_ax, right_ax = axes[0]
        swims = [str(name) for name in record.flow_run.values if FIN not in str(name)]
        samples_per_cycle = max(round(period / float(time[1] - time[0])), 1)
        colours = dict(zip(dict.fromkeys(name.removesuffix("_stiff") for name in swims), _LINES, strict=False))
        for name in swims:
            x = record.flow_centre_of_mass.sel(flow_run=name, xyz="x").values[::samples_per_cycle]
            cycles = np.arange(1, x.size)
            motion = name.removesuffix("_stiff")
            left_ax.plot(
                cycles, np.diff(x) / period, "o-" if name == motion else "s--", color=colours[motion],
                label=_label(motion) + ", stiffer joints" * (name != motion),
            )  # fmt: skip
        left_ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.8)
        left_ax.set(xlabel="cycle", ylabel="speed [m/s]", xticks=cycles)
        left_ax.legend()
        cable = list(record.attrs["cable"]) or [str(name) for name in record.part.values[record.part_kind == "joint"]]
        is_last_cycle = time > time[-1] - period - 1e-9
        for k, name in enumerate(cable):
            angle = record.flow_joint_angle.isel(flow_run=0).sel(joint=name).values[is_last_cycle]
            phase, shade = (time[is_last_cycle] - time[is_last_cycle][0]) / period, str(0.75 - 0.75 * k / len(cable))
            right_ax.plot(phase, np.degrees(angle), color=shade, label=_label(name))
        right_ax.set(xlabel="phase of the last cycle", ylabel="joint angle [degree]")
        right_ax.legend(fontsize="small", ncols=3)
    return captioned(
        figure,
        f"Left: mean speed of each cycle from rest in {_water_text(record)}, robot and flow solved together. "
        "Right: angles that "
        + ("the joints of the cable take in the last cycle; the cable holds their sum alone."
           if record.attrs["cable"] else "the joints take in the last cycle."),
    )  # fmt: skip


def _links(record: xr.Dataset) -> Figure:
    """Draw the force on each link and the moment about each joint over the last cycle of the first swim, as maps."""
    period, time = float(record.flow_period), record.flow_time.values
    is_last_cycle = time > time[-1] - period - 1e-9
    force = record.flow_link_force.isel(flow_run=0).sel(xyz="y").values[is_last_cycle]
    joints = [str(name) for name in record.part.values[record.part_kind.values == "joint"]]
    moment = record.flow_joint_water_torque.isel(flow_run=0).sel(joint=joints).values[is_last_cycle]
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, width=10.5, height=4.4)
        for ax, values, names, unit in (
            (
                axes[0, 0],
                force,
                [str(name).replace("link_", "") for name in record.link.values],
                "force to the left [N]",
            ),
            (axes[0, 1], moment, [name.replace("_", " ") for name in joints], "moment of the water [N m]"),
        ):
            limit = float(np.abs(values).max()) or 1.0
            image = ax.imshow(values.T, aspect="auto", cmap="RdBu_r", vmin=-limit, vmax=limit,
                              extent=(0.0, 1.0, len(names) - 0.5, -0.5), interpolation="nearest")  # fmt: skip
            ax.set_yticks(range(len(names)), names, fontsize="medium" if len(names) <= _MAX_LARGE_NAMES else 5)
            ax.grid(visible=False)
            ax.set_xlabel("phase of the last cycle")
            figure.colorbar(image, ax=ax, label=unit)
        axes[0, 0].set_ylabel("link" if record.attrs["linked"] else "link, from the head on")
    link_text = "rigid link of the robot" if record.attrs["linked"] else "link between two lateral joints"
    return captioned(
        figure,
        f"What the water does to each {link_text}, and about each lateral joint, over the last cycle of the whole wave "
        f"in {_water_text(record)}.",
    )


def _residual(record: xr.Dataset) -> Figure:
    """Draw the rms force by link and the rms moment by joint, in the flow and by the section model, with R2."""
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.4)
        for ax, kind, unit in ((axes[0, 0], "link", "N"), (axes[0, 1], "joint", "N m")):
            kind_record = record.isel(part=np.flatnonzero(record.part_kind.values == kind))
            names = [str(name).replace("_", " ") for name in kind_record.part.values]
            positions = np.arange(len(names))
            ax.bar(positions - 0.2, kind_record.residual_rms, 0.4, color=COLOURS["ours"], label="flow")
            ax.bar(
                positions + 0.2,
                kind_record.residual_rms_sections,
                0.4,
                color=COLOURS["neutral"],
                label="sections, as shipped",
            )
            top = np.maximum(kind_record.residual_rms, kind_record.residual_rms_sections)
            for x, r2, rms in zip(positions, kind_record.residual_r2.values, top, strict=True):
                ax.annotate(f"{r2:.2f}", (x, float(rms)), ha="center", va="bottom", fontsize=7)
            ax.set_xticks(positions, names, rotation=60, ha="right", fontsize=8)
            ax.set_ylabel(f"rms [{unit}]")
            ax.margins(y=0.12)
        axes[0, 0].legend()
    return captioned(
        figure,
        "Root mean square, over the measured cycles, of the force across each link and of the moment about each joint "
        f"in {_water_text(record)}, and what the section model says of "
        "the same motion in the same water. Numbers are R², the share of the variance that the section model explains; "
        "below 0 a constant would be nearer.",
    )


def _fins(record: xr.Dataset, fin_swims: xr.Dataset) -> Figure:
    """Draw speed and cost of transport over the stiffness of the passive end, with the best stiffness marked.

    Args:
        record: record of the experiment ``swim_free`` with a flow.
        fin_swims: swims of ``in_flow.fins``.
    """
    stiffness, speed, cost = fin_swims.stiffness.values, fin_swims.speed.values, fin_swims.cost.values
    with styled():
        figure, axes = panels(1, 2, width=9.5, height=3.8)
        for ax, values, label, best in (
            (axes[0, 0], speed, "speed in the last cycle [m/s]", np.nanmax),
            (axes[0, 1], cost, "cost of transport [-]", np.nanmin),
        ):
            ax.semilogx(stiffness, values, "o-", color=COLOURS["ours"])
            if np.isfinite(values).any():
                best_index = int(np.flatnonzero(values == best(values))[0])
                ax.plot(
                    stiffness[best_index],
                    values[best_index],
                    "o",
                    color=COLOURS["tail_still"],
                    markersize=10,
                    fillstyle="none",
                )
                edge = ", the end of what was tried" if best_index in (0, len(values) - 1) else ""
                ax.set_title(f"best at {stiffness[best_index]:g} N m/rad{edge}", fontsize=11)
            ax.set(xlabel="stiffness of each passive joint [N m/rad]", ylabel=label)
            ax.set_xlim(0.8 * stiffness[0], 1.25 * stiffness[-1])
            ax.set_xticks(stiffness, [f"{tick:g}" for tick in stiffness])
            ax.minorticks_off()
    return captioned(
        figure,
        "How stiff the passive end of the tail is best, in the last cycle of the whole wave from rest in "
        f"{_water_text(record)}: speed, and the servos' power over weight in air times speed.",
    )


def _balance(record: xr.Dataset) -> Figure:
    """Draw the coupling residual before and after the correction, and the errors of energy and power, over time."""
    time, period = record.flow_time.values, float(record.flow_period)
    with styled():
        figure, axes = panels(1, 2, width=9.5, height=4.0)
        left_ax, right_ax = axes[0]
        initial_residual, final_residual = (
            record[name].isel(flow_run=0).values for name in ("coupling_first", "coupling_residual")
        )
        left_ax.semilogy(
            time / period, np.maximum(initial_residual, 1e-7), color=COLOURS["neutral"], label="before the correction"
        )
        left_ax.semilogy(time / period, np.maximum(final_residual, 1e-7), color=COLOURS["ours"], label="after it")
        left_ax.set(xlabel="cycle", ylabel="force left over [-]")
        left_ax.legend()
        for name, colour, label in (
            ("energy_error", COLOURS["ours"], "missing in the robot's balance, over its servos' work"),
            ("power_error", COLOURS["tail_still"], "force times velocity against the flow's own power"),
        ):
            right_ax.plot(time / period, record[name].isel(flow_run=0).values, color=colour, label=label)
        right_ax.set(xlabel="cycle", ylabel="error [-]", ylim=(-0.1, 0.1))
        right_ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.8)
        right_ax.legend(fontsize="small")
    return captioned(
        figure,
        f"How well robot and flow came to terms in {_water_text(record)}: the force that each step left over, as a "
        "share of the greatest so far, and the energy that is missing so far.",
    )
