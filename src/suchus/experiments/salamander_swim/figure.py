"""An animal's swim on its model: how far it comes in a cycle, and how far the body swings along its length."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.figures.style import COLOURS, captioned, panels, styled


def draw_strides(record: xr.Dataset, animal: float) -> Figure:
    """Draw the stride over the frequency beside the animal's, with the spread over other waters at the highest.

    Args:
        record: with ``frequency`` and ``stride`` of each swim, and ``stride_other`` in other waters.
        animal: the animal's stride [body length].
    """
    frequency, stride, other = record.frequency.values, record.stride.values, record.stride_other.values
    with styled():
        figure, axes = panels(1, 1, width=7.0, height=4.2)
        ax = axes[0, 0]
        ax.axhline(animal, color=COLOURS["neutral"], linewidth=1.2, linestyle=(0, (5, 2)), label="the animal, mean")
        ax.plot(frequency, stride, "o-", color=COLOURS["coordinated"], label="its angles on the model")
        spread = [[stride[-1] - other.min()], [other.max() - stride[-1]]]
        ax.errorbar(frequency[-1:], stride[-1:], yerr=spread, color=COLOURS["coordinated"], capsize=4)
        ax.set(xlabel="frequency [Hz]", ylabel="stride [body lengths a cycle]")
        ax.set_ylim(0.0, 1.15 * max(animal, float(other.max()), float(stride.max())))
        ax.legend(loc="lower left")
    return captioned(
        figure,
        "How far the model comes in a cycle when it plays the swimming animal's joint angles, beside the animal. The "
        "bar is the spread over other coefficients of the water.",
    )


def draw_envelope(record: xr.Dataset) -> Figure:
    """Draw how far the body swings from end to end over the place behind the snout, a line for each frequency.

    Args:
        record: with ``frequency`` and ``swing`` of each swim, and ``place``.
    """
    shades = np.linspace(0.35, 1.0, record.sizes["swim"])
    with styled():
        figure, axes = panels(1, 1, width=7.0, height=4.2)
        ax = axes[0, 0]
        for swing, frequency, shade in zip(record.swing.values, record.frequency.values, shades, strict=True):
            ax.plot(record.place, swing, "o-", color=COLOURS["coordinated"], alpha=shade, label=f"{frequency:g} Hz")
        ax.set(xlabel="behind the snout [body length]", ylabel="swing from end to end [body length]")
        ax.set_ylim(bottom=0.0)
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "How far snout, joints of the axis and tail tip swing across the mean course, from end to end, when the model "
        "plays the swimming animal's joint angles.",
    )
