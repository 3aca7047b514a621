"""The look of every figure: colours by role, sizes, and how a figure is made and saved.

Colours are those of Okabe and Ito, which people with any colour vision tell apart; each role of ``LINES`` has
a dash pattern of its own as well, so that a print in grey still reads.
"""

from collections.abc import Mapping
from contextlib import AbstractContextManager
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure

from suchus.core.writing import write
from suchus.visual.figures.data import table
from suchus.visual.figures.uncover import UncoveredLegendLayout

if TYPE_CHECKING:
    from suchus.robot.design import Robot

COLOURS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "coordinated": "#0072B2",
        "limbs_only": "#D55E00",
        "tail_drag": "#009E73",
        "spine_only": "#B0558A",
        "tail_still": "#56B4E9",
        "limbs_tail_lifted": "#E69F00",
        "policy": "#5B4A9E",
        "ours": "#0072B2",
        "printed": "#333333",
        "neutral": "#767676",
        "grid": "#DDDDDD",
        "ground": "#8C7B66",
        "water": "#56B4E9",
        "alarm": "#C0392B",
        "LF": "#0072B2",
        "RF": "#D55E00",
        "LH": "#56B4E9",
        "RH": "#E69F00",
        "spine": "#009E73",
        "tail": "#B0558A",
    }
)
"""Colour of each role: the four arms, ours and the article's, the legs, spine and tail."""

_EXTRA_COLOURS: Final = ("#009E73", "#B0558A", "#56B4E9", "#E69F00", "#767676", "#333333")


def limb_colours(robot: "Robot") -> list[tuple[str, str]]:
    """Return each limb of a robot with its colour: those of the article's legs, then others in turn."""
    from suchus.robot.design import LEGS, layout  # noqa: PLC0415  a figure of a flow needs no robot

    names = layout(robot).limb_names
    spare = iter(_EXTRA_COLOURS * (len(names) // len(_EXTRA_COLOURS) + 1))
    return [(name, COLOURS[name] if name in LEGS else next(spare)) for name in names]


LINES: Final[Mapping[str, Mapping[str, Any]]] = MappingProxyType(
    {
        role: MappingProxyType({"color": COLOURS[role], "linestyle": dashes, "label": label})
        for role, dashes, label in (
            ("coordinated", "-", "spine and tail"),
            ("limbs_only", (0, (5, 2)), "limbs only"),
            ("limbs_tail_lifted", (0, (3, 1.2)), "limbs only, tail lifted"),
            ("tail_still", (0, (8, 1.5)), "spine, tail dragged still"),
            ("spine_only", (0, (5, 1.5, 1, 1.5)), "spine only, tail lifted"),
            ("tail_drag", (0, (1, 1.2)), "tail only, trunk straight"),
            ("policy", (0, (6, 1, 1, 1, 1, 1)), "trained policy"),
            ("ours", "-", "ours"),
            ("printed", (0, (4, 2)), "as printed"),
            ("neutral", "-", None),
        )
    }
)
"""Colour, dashes and label of a line by role: ``axes.plot(x, y, **LINES["coordinated"])``."""

SEQUENTIAL: Final = "cividis"
"""Colour map for a quantity that grows from nothing."""
DIVERGING: Final = "PuOr"
"""Colour map for a quantity with a meaningful zero."""

WIDTH: Final = 7.2
"""Width of a figure that fills the page's column [inch]."""

STYLE: Final[Mapping[Any, Any]] = MappingProxyType(
    {
        "axes.axisbelow": True,
        "axes.edgecolor": "#555555",
        "axes.grid": True,
        "axes.labelsize": 12,
        "axes.linewidth": 0.9,
        "axes.prop_cycle": cycler(color=["#0072B2", "#D55E00", "#009E73", "#B0558A", "#E69F00", "#56B4E9"]),
        "axes.spines.right": False,
        "axes.spines.top": False,
        "axes.titlelocation": "left",
        "axes.titlesize": 12,
        "figure.constrained_layout.use": True,
        "figure.dpi": 100,
        "figure.facecolor": "white",
        "font.family": "DejaVu Sans",
        "font.size": 12,
        "grid.color": COLOURS["grid"],
        "grid.linewidth": 0.7,
        "image.cmap": SEQUENTIAL,
        "legend.fontsize": 11,
        "legend.edgecolor": "white",
        "legend.framealpha": 0.85,
        "lines.linewidth": 1.9,
        "lines.markersize": 5,
        "savefig.dpi": 160,
        "savefig.facecolor": "white",
        "svg.fonttype": "path",
        "xtick.labelsize": 11,
        "ytick.labelsize": 11,
    }
)
"""Matplotlib settings of every figure, applied by ``styled``."""


DATA: Final = ".data.csv"
"""Ending of the file name of a figure's table, in place of ``.svg``."""


def styled(**settings: Any) -> AbstractContextManager[None]:
    """Return a context in which matplotlib follows ``STYLE``; what is drawn inside it looks like the rest.

    Args:
        **settings: further matplotlib settings, dots written as double underscores.
    """
    extra: dict[Any, Any] = {name.replace("__", "."): value for name, value in settings.items()}
    return mpl.rc_context({**STYLE, **extra})


def new(*, width: float = WIDTH, height: float = 3.8) -> Figure:
    """Return an empty figure whose legends move off its data; add axes to it inside ``styled()``.

    Args:
        width: [inch].
        height: [inch].
    """
    with styled():
        return Figure(figsize=(width, height), layout=UncoveredLegendLayout())


def panels(
    rows: int = 1, columns: int = 1, *, width: float = WIDTH, height: float | None = None, **options: Any
) -> tuple[Figure, np.ndarray[Any, np.dtype[Any]]]:
    """Return a figure and its axes, shape (rows, columns).

    Args:
        rows: number of rows.
        columns: number of columns.
        width: [inch].
        height: [inch]; by default it grows with the number of rows.
        **options: passed to ``Figure.subplots``, such as ``sharex=True`` or ``height_ratios=[2, 1]``.
    """
    figure = new(width=width, height=height if height is not None else 1.2 + 2.4 * rows)
    with styled():
        return figure, figure.subplots(rows, columns, squeeze=False, **options)


def captioned(figure: Figure, text: str) -> Figure:
    """Attach a caption, also read out to those who cannot see the figure, and return the figure."""
    figure.suchus_caption = " ".join(text.split())  # type: ignore[attr-defined]
    return figure


def caption(figure: Figure) -> str:
    """Return the caption of a figure, empty if it has none."""
    return str(getattr(figure, "suchus_caption", ""))


def places(folder: str | Path, stem: str) -> tuple[Path, Path, Path]:
    """Return where ``save`` writes a figure: as SVG, as PNG, and its numbers."""
    folder = Path(folder)
    return folder / f"{stem}.svg", folder / f"{stem}.png", folder / f"{stem}{DATA}"


def save(figure: Figure, folder: str | Path, stem: str) -> tuple[Path, Path]:
    """Write a figure as SVG and as PNG and return both paths; equal figures give equal bytes.

    The numbers that it shows stand beside it, as ``STEM.data.csv``; see ``figures.data``.

    Raises:
        Unwritable: the place cannot be written to.
    """
    svg, png, data = places(folder, stem)
    svg_metadata = {"Date": None, "Creator": None, "Description": caption(figure)}
    layout = figure.get_layout_engine()
    with styled(svg__hashsalt=stem, figure__constrained_layout__use=False):
        for path, kind, metadata in ((svg, "svg", svg_metadata), (png, "png", {"Software": None})):
            buffer = BytesIO()
            figure.savefig(buffer, format=kind, metadata=metadata)
            figure.set_layout_engine(None)  # the second file keeps the layout of the first
            write(path, buffer.getvalue())
    figure.set_layout_engine(layout)
    if csv_text := table(figure):
        write(data, csv_text)
    return svg, png
