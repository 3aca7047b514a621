"""A measured walk played on a robot: joint angles over the cycle, and foot forces beside the animal's."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.sim.metrics import mean_cycle
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_COLUMNS = 4
_MIN_RANGE = 0.1  # degrees; a servo that is moved by less is not drawn
_DEGREES = 180.0 / np.pi
_PARTS = (
    ("vertical", "-", "coordinated"),
    ("foreaft", (0, (5, 2)), "limbs_only"),
    ("sideways", (0, (1, 1.2)), "tail_drag"),
)
_COMPONENT_LABELS = {"vertical": "vertical", "foreaft": "along the course", "sideways": "to the midline"}


def draw_angles(record: xr.Dataset, cycle_window: tuple[float, float, int]) -> Figure:
    """Draw the mean cycle of every servo that moves, as commanded and as achieved.

    Args:
        record: record of one run.
        cycle_window: start of the first cycle [s], period [s] and number of cycles.
    """
    commanded = mean_cycle(record.servo_target, *cycle_window) * _DEGREES
    achieved = mean_cycle(record.servo_angle, *cycle_window) * _DEGREES
    names = [str(servo) for servo in record.servo.values if np.ptp(commanded.sel(servo=servo).values) > _MIN_RANGE]
    rows = -(-len(names) // _COLUMNS) or 1
    with styled(axes__titlesize=10, xtick__labelsize=9, ytick__labelsize=9):
        figure, axes = panels(rows, _COLUMNS, width=10.0, height=0.8 + 1.5 * rows, sharex=True)
        for ax in axes.flat[len(names) :]:
            ax.set_visible(False)
        for ax, name in zip(axes.flat, names, strict=False):
            for angles, role, dashes, label in (
                (commanded, "printed", (0, (4, 2)), "commanded"),
                (achieved, "ours", "-", "achieved"),
            ):
                ax.plot(angles.phase, angles.sel(servo=name), color=COLOURS[role], linestyle=dashes, label=label)
            ax.set_title(name)
        axes[0, 0].legend(loc="best", fontsize=8)
        figure.supxlabel("phase [cycle]", fontsize=11)
        figure.supylabel("angle [deg]", fontsize=11)
    return captioned(
        figure, f"The mean of {cycle_window[2]} cycles at every servo: commanded (dashed) and achieved (solid)."
    )


def draw_feet(
    force: xr.DataArray, feet: Mapping[str, Sequence[str]], stance_threshold: float, animal: Mapping[str, Any]
) -> Figure:
    """Draw the force on fore and hind feet over the stance, beside the animal's at its greatest net force.

    Args:
        force: mean cycle, ``phase leg part`` [body weight].
        feet: the legs of ``fore`` and ``hind``.
        stance_threshold: vertical force from which a foot stands [body weight].
        animal: published numbers, by the names of the measures.
    """
    with styled():
        figure, axes = panels(1, len(feet), width=10.0, height=4.0, sharey=True)
        for ax, (pair, legs) in zip(axes.flat, feet.items(), strict=True):
            for i, leg in enumerate(legs):
                _draw_foot(ax, force.sel(leg=leg), stance_threshold, label=i == 0)
            _mark_animal(ax, animal, pair)
            ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.8)
            ax.set_title(f"{pair} feet")
            ax.set_xlabel("share of stance [%]")
        axes[0, 0].set_ylabel("force [body weight]")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=4, fontsize=10)
    return captioned(
        figure,
        "The force of the ground on single feet over their mean stance, left and right. Diamonds: the animal's "
        "components at the instant of the greatest net force; bar: its standard deviation over trials, which is "
        "published for the net force.",
    )


def _draw_foot(ax: Axes, force: xr.DataArray, stance_threshold: float, *, label: bool) -> None:
    """Draw the three components of the force on one foot over its stance, from touch-down to lift-off.

    Nothing is drawn of a foot that never stands or never lifts off.

    Args:
        ax: axes to draw on.
        force: mean cycle of the foot, ``phase part`` [body weight].
        stance_threshold: vertical force from which the foot stands [body weight].
        label: whether the lines get entries in the legend.
    """
    vertical = force.sel(part="vertical").values
    turn = int(np.argmax(vertical))
    stands = np.roll(vertical > stance_threshold, -turn)
    if not stands.any() or stands.all():
        return
    samples_after, samples_before = int(np.argmin(stands)), int(np.argmin(stands[::-1]))
    share = 100.0 * (np.arange(samples_before + samples_after) + 0.5) / (samples_before + samples_after)
    for component, dashes, role in _PARTS:
        values = np.roll(force.sel(part=component).values, samples_before - turn)[: samples_before + samples_after]
        ax.plot(
            share, values, color=COLOURS[role], linestyle=dashes, label=_COMPONENT_LABELS[component] if label else None
        )


def _mark_animal(ax: Axes, animal: Mapping[str, Any], pair: str) -> None:
    """Mark the published force components of one pair of feet at their published time in stance.

    Args:
        ax: axes to draw on, time in stance [%] against force [body weight].
        animal: published numbers, by the names of the measures.
        pair: ``fore`` or ``hind``.
    """
    stance_time = 100.0 * animal[f"foot_force_time_{pair}"].value
    spread = animal[f"foot_force_net_{pair}"].spread
    for component, _, role in _PARTS:
        value = animal[f"foot_force_{'peak' if component == 'vertical' else component}_{pair}"].value
        bar = spread if component == "vertical" else None
        label = "animal" if component == "vertical" else None
        ax.errorbar(stance_time, value, yerr=bar, fmt="D", color=COLOURS[role], markeredgecolor="black", markersize=8,
                    capsize=4, label=label)  # fmt: skip
