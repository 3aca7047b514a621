"""Swims in six degrees of freedom: speeds beside models, and how the joints of a cable share its bend."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_GREYS = ("#AAAAAA", "#666666")
_MOTION_LABELS = {"whole": "whole wave", "tail_only": "tail only", "trunk_only": "trunk only", "reversed": "reversed"}


def draw_speeds(speeds: Mapping[str, float], motions: Sequence[str], models: Sequence[str]) -> Figure:
    """Draw the speed of each motion in six degrees of freedom and by models, the band of the coefficients on the first.

    Args:
        speeds: measures ``speed_MOTION``, ``speed_MOTION_stiff``, ``speed_MOTION_MODEL``, and the ends of the band,
            ``speed_low`` and ``speed_high``, where it is known.
        motions: names of the motions.
        models: names of the models.
    """
    bars = (
        ("", "six degrees of freedom", COLOURS["coordinated"], ""),
        ("_stiff", "the same, stiffer joints", COLOURS["tail_still"], "//"),
        *((f"_{model}", f"{model} model", shade, "") for model, shade in zip(models, _GREYS, strict=True)),
    )
    bars = tuple(bar for bar in bars if f"speed_whole{bar[0]}" in speeds)
    with styled():
        figure, axes = panels(1, 1, width=9.0, height=4.2)
        ax, width = axes[0, 0], 0.8 / len(bars)
        for i, (ending, label, colour, hatch) in enumerate(bars):
            positions = np.arange(len(motions)) + (i - (len(bars) - 1) / 2) * width
            values = [speeds[f"speed_{name}{ending}"] for name in motions]
            ax.bar(positions, values, width, color=colour, hatch=hatch, edgecolor="white", label=label)
        if "speed_low" in speeds:
            nominal_speed, min_speed, max_speed = (speeds[name] for name in ("speed_whole", "speed_low", "speed_high"))
            ax.errorbar(
                -(len(bars) - 1) / 2 * width,
                nominal_speed,
                yerr=[[nominal_speed - min_speed], [max_speed - nominal_speed]],
                color="#333333",
                capsize=4,
            )
        ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        ax.set_xticks(range(len(motions)), [_MOTION_LABELS.get(name, name) for name in motions])
        ax.set_ylabel("speed [m/s]")
        ax.legend(loc="lower left")
    spread_text = " The bar on the first is the spread over plausible coefficients of the water."
    return captioned(
        figure,
        "Speed of each motion, forward positive, in six degrees of freedom at the surface and by models whose midline "
        f"is commanded.{spread_text if 'speed_low' in speeds else ''}",
    )


def draw_tail(record: xr.Dataset) -> Figure:
    """Draw the amplitude of each joint of the cable, commanded and taken, and the tracks of the swims.

    Args:
        record: record of runs labelled ``whole``, ``whole_stiff``, ``tail_only``, ``tail_only_stiff`` and ``steered``;
            the tracks alone of a robot without cables.
    """
    labels, cabled = [str(label) for label in record.label.values], len(record.attrs["cable"]) > 0
    with styled():
        figure, axes = panels(1, 1 + cabled, width=12.0 if cabled else 7.0, height=4.2)
        if cabled:
            _draw_shares(axes[0, 0], record, labels)
        ax = axes[0, -1]
        for label, colour, dashes, line_label in (
            ("whole", "coordinated", "-", "whole wave"),
            ("trunk_only", "spine_only", (0, (1, 1.2)), "trunk only"),
            ("reversed", "limbs_only", (0, (5, 2)), "reversed"),
            ("steered", "tail_drag", (0, (5, 1.5, 1, 1.5)), "steered"),
        ):
            if label in labels:
                track = record.centre_of_mass.isel(run=labels.index(label))
                ax.plot(
                    track.sel(xyz="x"), track.sel(xyz="y"), color=COLOURS[colour], linestyle=dashes, label=line_label
                )
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(xlabel="forward [m]", ylabel="to the left [m]")
        ax.legend(loc="best")
    shares = "Amplitude of each joint of the cable while swimming, beside the even share that is meant; and tracks"
    return captioned(figure, f"{shares if cabled else 'Tracks'} of the centre of mass seen from above.")


def _draw_shares(ax: Axes, record: xr.Dataset, labels: Sequence[str]) -> None:
    """Draw the amplitude of each joint of the cable in up to four swims, and the equal amplitude that is commanded."""
    names, excerpt = record.attrs["cable"], record.sel(time=slice(record.attrs["measured_from"] - 1e-9, None))
    number = np.arange(len(names)) + 1
    for label, colour, dashes, line_label in (
        ("whole", "coordinated", "-", "whole wave"),
        ("whole_stiff", "tail_still", (0, (5, 2)), "whole wave, stiffer"),
        ("tail_only", "limbs_only", (0, (1, 1.2)), "tail only"),
        ("tail_only_stiff", "limbs_tail_lifted", (0, (5, 1.5, 1, 1.5)), "tail only, stiffer"),
    ):
        if label not in labels:
            continue
        angles = excerpt.joint_angle.isel(run=labels.index(label)).sel(joint=names).transpose("time", "joint").values
        half = np.degrees(np.ptp(angles, axis=0) / 2)
        ax.plot(number, half, marker="o", color=COLOURS[colour], linestyle=dashes, label=line_label)
    ax.axhline(np.degrees(record.attrs["meant"]), color=COLOURS["neutral"], linewidth=0.9, label="even share")
    ax.set(xlabel="joint of the cable, from the root", ylabel="amplitude [deg]", xticks=number)
    ax.set_ylim(bottom=0.0)
    ax.legend(loc="best")


def draw_below(record: xr.Dataset, swim_labels: Mapping[str, str]) -> Figure:
    """Draw depth and pitch of the swims below the surface over time.

    Args:
        record: record with ``deep_depth`` and ``deep_pitch`` over ``dive`` and ``dive_time``; attributes ``depth`` and
            ``deep_from``.
        swim_labels: what each swim is called.
    """
    looks = (("coordinated", "-"), ("tail_still", (0, (5, 2))), ("spine_only", (0, (5, 1.5, 1, 1.5))),
             ("limbs_only", (0, (1, 1.2))))  # fmt: skip
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.2)
        for name, (colour, dashes) in zip(swim_labels, looks, strict=True):
            if name not in record.dive.values:
                continue
            dive_record, time = record.sel(dive=name), record.dive_time
            for ax, values in ((axes[0, 0], -dive_record.deep_depth), (axes[0, 1], np.degrees(dive_record.deep_pitch))):
                ax.plot(time, values, color=COLOURS[colour], linestyle=dashes, label=swim_labels[name])
        axes[0, 0].axhline(-record.attrs["depth"], color=COLOURS["neutral"], linewidth=0.9)
        axes[0, 1].axhline(0.0, color=COLOURS["neutral"], linewidth=0.9)
        axes[0, 0].set(xlabel="time [s]", ylabel="root above the surface [m]")
        axes[0, 1].set(xlabel="time [s]", ylabel="pitch, nose down positive [deg]")
        axes[0, 1].legend(loc="best")
    return captioned(
        figure,
        "Dives from the surface to a depth that is held by air let out, and pitch on the way: by where the air is, and "
        f"by what holds the pitch. Measured from {record.attrs['deep_from']:.0f} s on.",
    )
