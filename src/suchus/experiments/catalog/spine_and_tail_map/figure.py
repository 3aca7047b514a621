"""The map: for each condition what spine and tail change, with sign and interval."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from suchus.experiments.experiment import Measure
from suchus.visual.figures.style import COLOURS, panels, styled

SIGNS = {"pays": COLOURS["coordinated"], "costs": COLOURS["limbs_only"], "undecided": COLOURS["neutral"]}
"""Colour of each word."""


def draw_map(
    labels: Mapping[str, str],
    quantities: Sequence[tuple[str, str, float]],
    words: Mapping[str, str],
    measures: Mapping[str, Measure],
) -> Figure:
    """Draw each difference with its interval, a panel for each quantity and a row for each condition.

    Args:
        labels: labels of the conditions, by name.
        quantities: name of each quantity, label of its axis with its unit, and the value at which the groups are equal.
        words: word for each measure, a key of ``SIGNS``.
        measures: numbers with ``_low`` and ``_high``, as ``QUANTITY_CONDITION``.
    """
    rows = np.arange(len(labels))[::-1]
    with styled():
        figure, axes = panels(1, len(quantities), width=3.4 * len(quantities), height=1.4 + 0.34 * len(labels))
        for column, (quantity, label, equal) in enumerate(quantities):
            ax = axes[0, column]
            ax.axvline(equal, color=COLOURS["neutral"], linewidth=1.0, label="_equal")
            for row, cell in zip(rows, labels, strict=True):
                name = f"{quantity}_{cell}"
                value, low, high = (measures[f"{name}{end}"].value for end in ("", "_low", "_high"))
                colour = SIGNS[words[name]]
                ax.plot([low, high], [row, row], color=colour, linewidth=2.4, label=f"_{labels[cell]}, interval")
                ax.plot([value], [row], marker="o", color=colour, label=f"_{labels[cell]}")
            ax.set_xlabel(label)
            ax.set_ylim(-0.6, len(labels) - 0.4)
            ax.set_yticks(rows, list(labels.values()) if column == 0 else [""] * len(labels))
        axes[0, 0].set_ylabel("condition")
        for word, colour in SIGNS.items():
            axes[0, 0].plot([], [], marker="o", color=colour, label=word)
        figure.legend(loc="outside upper center", ncols=len(SIGNS))
    return figure
