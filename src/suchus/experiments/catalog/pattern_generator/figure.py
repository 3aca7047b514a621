"""A pattern generator: phases and amplitudes over a ramp of its drive, what drives do, locks, and walks on land."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from suchus.robot.control import Oscillators
from suchus.robot.design import Robot
from suchus.visual.figures.style import COLOURS, captioned, limb_colours, panels, styled


def draw_ramp(record: xr.Dataset, robot: Robot) -> Any:
    """Draw drive, output of the limbs' oscillators, bends of the axis and frequencies over a ramp of the drive.

    Args:
        record: record of the experiment, with the variables ``ramp_*``.
        robot: robot whose limbs and axis are driven.
    """
    time, drive = record.ramp_time.values, record.ramp_drive.values
    limb_names = [name for name, _ in limb_colours(robot)]
    are_limbs_active = drive <= record.attrs["silent_above"]
    with styled():
        figure, axes = panels(4, 1, width=10.0, height=9.5, sharex=True, height_ratios=[0.8, 1.6, 2.6, 1.2])
        drive_ax, limb_ax, bend_ax, frequency_ax = axes[:, 0]
        drive_ax.plot(time, drive, color="black")
        drive_ax.set_ylabel("drive")
        output = record.ramp_amplitude * (1.0 + np.cos(2 * np.pi * record.ramp_phase))
        for i, (limb, colour) in enumerate(reversed(limb_colours(robot))):
            limb_ax.fill_between(time, i, i + 0.85 * output.sel(oscillator=limb), color=colour, linewidth=0)
        limb_ax.set_yticks(np.arange(len(limb_names)) + 0.3, limb_names[::-1])
        limb_ax.set_ylim(-0.15, len(limb_names) + 0.1)
        limb_ax.set_ylabel("limbs")
        _draw_waves(bend_ax, record)
        _draw_rates(frequency_ax, record, limb_names[0])
        for ax in axes[:, 0]:
            ax.fill_between(time, 0, 1, where=are_limbs_active, color=COLOURS["ground"], alpha=0.13, linewidth=0,
                            transform=ax.get_xaxis_transform(), zorder=0)  # fmt: skip
            ax.grid(False)
        frequency_ax.set_xlabel("time [s]")
        frequency_ax.set_xlim(time[0], time[-1])
    return captioned(
        figure,
        "Coupled oscillators under a drive that rises and falls again; shaded: drives that move the limbs. From above: "
        "the drive; output of each limb's oscillator; bend of each segment of the axis, to the left upward, the head "
        "on top; frequency of the axis and of a limb.",
    )


def _draw_waves(ax: Axes, record: xr.Dataset) -> None:
    """Draw the bend of every segment on a line of its own, coloured by the girdle that drives it."""
    time, n = record.ramp_time.values, record.sizes["segment"]
    scale = 0.48 / max(float(abs(record.ramp_wave).max()), 1e-9)
    for k in range(n):
        colour = COLOURS["spine"] if int(record.girdle[k]) <= 0 else COLOURS["tail"]
        ax.plot(
            time,
            n - k + scale * record.ramp_wave.isel(segment=k),
            color=colour,
            linewidth=1.5,
            label=f"_segment {k + 1}",
        )
    ax.set_yticks(range(n, 0, -1), [str(k + 1) for k in range(n)])
    ax.set_ylim(0.4, n + 0.7)
    ax.set_ylabel("axis, from the head")


def _draw_rates(ax: Axes, record: xr.Dataset, limb: str) -> None:
    """Draw the frequency of the axis and of one limb over the ramp, as the slope of their phases [Hz]."""
    for name, label, colour, dashes in (
        (str(record.oscillator.values[0]), "axis", COLOURS["spine"], "-"),
        (limb, "limbs", COLOURS["RF"], (0, (4, 1.5))),
    ):
        rate = np.gradient(record.ramp_phase.sel(oscillator=name).values, record.ramp_time.values)
        ax.plot(record.ramp_time, rate, color=colour, linestyle=dashes, label=label)
    ax.set_ylabel("frequency [Hz]")
    ax.set_ylim(bottom=0.0)
    ax.legend(loc="upper left", ncols=2)


def draw_sweep(record: xr.Dataset, oscillators: Oscillators) -> Any:
    """Draw frequency, amplitude and lags over the drive.

    Args:
        record: record of the sweep.
        oscillators: parameters of the oscillators, for the curves that each follows uncoupled.
    """
    drive, scale = record.drive.values, record.attrs["frequency_scale"]
    fine = np.linspace(0.5, 5.5, 1001)
    with styled():
        figure, axes = panels(1, 3, width=12.5, height=4.0)
        for name, law, colour, size in (
            ("axis", oscillators.axis, COLOURS["spine"], 9),
            ("limbs", oscillators.limbs, COLOURS["RF"], 5),
        ):
            for ax, line, quantity in zip(axes[0], law(fine), ("frequency", "amplitude"), strict=False):
                curve = line * (scale if quantity == "frequency" else 1.0)
                ax.plot(
                    fine,
                    np.where(curve > 0.0, curve, np.nan),
                    color=colour,
                    linewidth=1.2,
                    linestyle=(0, (1, 1.2)),
                    label=f"_{name}, each alone",
                )
                ax.plot(drive, record[f"{quantity}_{name}"], "o", color=colour, label=name, markersize=size)
                ax.set_xlabel("drive")
        axes[0, 0].set_ylabel("frequency [Hz]")
        axes[0, 1].set_ylabel("amplitude")
        axes[0, 0].legend(loc="upper left")
        for state, marker in (("walk", "o"), ("swim", "s")):
            drive_record = record.sel(drive=record.attrs[state], method="nearest")
            lag = -np.unwrap(2 * np.pi * drive_record.phase_axis.values) / (2 * np.pi)
            axes[0, 2].plot(record.segment, lag, marker=marker, label=f"drive {record.attrs[state]:g}")
        axes[0, 2].set_xlabel("segment, from the head")
        axes[0, 2].set_ylabel("behind the first [cycle]")
        axes[0, 2].legend(loc="upper left")
    return captioned(
        figure,
        "Settled oscillators over the drive. Points: together; dotted lines: each alone. Left: frequencies; middle: "
        "amplitudes; right: phase lag of each segment of the axis behind the first one at two drives.",
    )


def draw_locks(record: xr.Dataset) -> Any:
    """Draw how the phases of the starts converge to the locked state, at the two drives."""
    with styled():
        figure, axes = panels(1, 2, width=10.0, height=3.8, sharey=True)
        for ax, state in zip(axes[0], ("walk", "swim"), strict=True):
            ax.semilogy(
                record[f"{state}_cycle"],
                record[f"{state}_error"].values.T,
                color=COLOURS["ours"],
                alpha=0.35,
                linewidth=1.0,
                label="_each start",
            )
            ax.axhline(record.attrs["within"], color=COLOURS["RF"], linestyle=(0, (4, 2)), linewidth=1.3)
            ax.set_ylim(1e-4, 4.0)
            ax.set_title(f"drive {record.attrs[state]:g}")
            ax.set_xlabel("time [cycle]")
        axes[0, 0].set_ylabel("greatest distance from its place [rad]")
    count = record.sizes["walk_start"]
    return captioned(
        figure,
        f"From {count} random starts: distance of the farthest oscillator from its place, while the limbs are active "
        "and while they are silent. Dashed: what counts as locked.",
    )


def draw_land(record: xr.Dataset) -> Any:
    """Draw the stride over the drive, and the turning by each kind of steering."""
    strides = ("drive_low", "straight", "drive_high")
    turns = ("straight", "asymmetry", "steering", "steering_right")
    with styled():
        figure, axes = panels(1, 2, width=10.0, height=3.8)
        stride = (record.forward / record.walked / record.attrs["length"]).sel(arm=list(strides))
        turn = np.degrees((record.turned / record.walked).sel(arm=list(turns)))
        for ax, values, names in ((axes[0, 0], stride, strides), (axes[0, 1], turn, turns)):
            ax.bar(range(len(names)), values, color=COLOURS["ours"], width=0.6)
            ax.axhline(0.0, color="black", linewidth=0.8)
            ax.set_xticks(range(len(names)), [name.replace("_", "\n") for name in names])
        axes[0, 0].set_ylabel("stride [body lengths]")
        axes[0, 1].set_ylabel("turn to the left [deg/cycle]")
    return captioned(
        figure,
        "On land. Left: stride at the lowest, a middle and the highest drive that moves the limbs. Right: turning with "
        "an even drive, with a stronger drive on the right, and with the trunk held bent to the left and to the right.",
    )
