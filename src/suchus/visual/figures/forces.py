"""Forces of an animal that was filmed, over the phase of its mean cycle, with their intervals."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_PARTS = (
    ("vertical", "up", "coordinated", "-"),
    ("foreaft", "forward along the course", "limbs_only", (0, (5, 2))),
    ("sideways", "to the midline", "tail_drag", (0, (1, 1.2))),
)
_RUNGS: dict[str, tuple[str, Any]] = {
    "sections": ("coordinated", "-"),
    "sections, thick water": ("tail_still", (0, (8, 1.5))),
    "slice": ("limbs_only", (0, (5, 2))),
    "space": ("tail_drag", (0, (5, 1.5, 1, 1.5))),
}
_ROWS = (("thrust", "thrust [N]"), ("aside", "to the right [N]"), ("power", "power on\nthe water [W]"))


def ground_forces_figure(data: xr.Dataset) -> Figure:
    """Return the force on every foot over the cycle, beside the greatest of walking salamanders.

    Args:
        data: data as ``forces.walked_forces`` returns it.
    """
    legs = [str(leg) for leg in data.leg.values]
    with styled():
        figure, axes = panels(
            -(-len(legs) // 2), 2, width=10.0, height=1.6 + 2.5 * -(-len(legs) // 2), sharex=True, sharey=True
        )
        for ax, leg in zip(axes.flat, legs, strict=True):
            foot_data = data.sel(leg=leg)
            for name, label, role, dashes in _PARTS:
                _banded(ax, data.phase.values, foot_data, f"{name}_bw", COLOURS[role], dashes, label)
            pair = "fore" if leg.endswith("F") else "hind"
            _mark(ax, data.sel(quantity=f"foot_force_net_{pair}"))
            ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.8)
            ax.set_title(leg)
        for ax in axes[:, 0]:
            ax.set_ylabel("force [body weight]")
        for ax in axes[-1]:
            ax.set_xlabel("phase [cycle], LF lifts off at 0")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, fontsize=10)
    return captioned(
        figure,
        f"{data.attrs['title'].capitalize()}, through the body of {data.attrs['body']}: each foot over the mean cycle. "
        "Bands hold the truth in 95 of 100 choices of what film and body leave open. Grey: greatest net force on a "
        "foot of walking salamanders, two standard deviations of single trials to either side.",
    )


def _mark(ax: Axes, animal_data: xr.Dataset) -> None:
    """Shade the animals' greatest net force, two standard deviations to either side."""
    animal, spread = float(animal_data.animals), float(animal_data.animals_spread)
    ax.axhspan(
        animal - 2 * spread, animal + 2 * spread, color=COLOURS["neutral"], alpha=0.15, linewidth=0.0,
        label="salamanders, net",
    )  # fmt: skip


def water_forces_figure(data: xr.Dataset) -> Figure:
    """Return force and power of the water over the cycle, a line for each model of the water.

    Args:
        data: data as ``forces.swum_forces`` returns it.
    """
    with styled():
        figure, axes = panels(len(_ROWS), 1, width=8.0, height=1.8 + 2.2 * len(_ROWS), sharex=True)
        for ax, (name, label) in zip(axes[:, 0], _ROWS, strict=True):
            for rung in data.rung.values:
                role, dashes = _RUNGS[str(rung)]
                _banded(ax, data.phase.values, data.sel(rung=rung), name, COLOURS[role], dashes, str(rung))
            ax.axhline(0.0, color=COLOURS["neutral"], linewidth=0.8)
            ax.set_ylabel(label)
        axes[-1, 0].set_xlabel("phase [cycle]")
        handles = axes[0, 0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside upper center", ncols=min(4, len(handles[1])), fontsize=10)
    return captioned(
        figure,
        f"{data.attrs['title'].capitalize()}, through the body of {data.attrs['body']}, by each model of the water. "
        "Bands hold the truth in 95 of 100 choices of what film and body leave open; a flow has those of the sections, "
        "in proportion to its forces.",
    )


def _banded(ax: Axes, phase: np.ndarray, data: xr.Dataset, name: str, colour: str, dashes: Any, label: str) -> None:
    ax.fill_between(phase, data[f"{name}_low"], data[f"{name}_high"], color=colour, alpha=0.18, linewidth=0.0)
    ax.plot(phase, data[name], color=colour, linestyle=dashes, label=label)
