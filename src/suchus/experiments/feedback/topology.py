"""The topology of the article's Fig. 10: sensors, controllers and what they share, as the code has them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from suchus.control.shared import OWNERS
from suchus.control.topology import ControlPart
from suchus.figures.style import COLOURS, captioned, new, styled

_ROLES = {"limbs": "LF", "spine": "spine", "tail": "tail", "heading": "RH"}
_SENSORS, _CONTROLLERS, _SHARED = 2.0, 1.0, 0.0  # heights of the three rows
_BOX = {"boxstyle": "round,pad=0.45", "facecolor": "white", "linewidth": 1.4}


def draw_topology(parts: Sequence[ControlPart]) -> Figure:
    """Draw which sensors each controller feels, which shared variables it writes, and whose it hears.

    Args:
        parts: of ``control.topology``.
    """
    sensors = sorted({name for part in parts for name in part.feels})
    places = {
        **{f"feels {name}": (x, _SENSORS) for name, x in zip(sensors, _spread(len(sensors)), strict=True)},
        **{part.name: (x, _CONTROLLERS) for part, x in zip(parts, _spread(len(parts)), strict=True)},
        **{f"shared {name}": (x, _SHARED) for name, x in zip(OWNERS, _spread(len(OWNERS)), strict=True)},
    }
    with styled():
        figure = new(width=11.0, height=5.4)
        ax = figure.add_subplot()
        boxes = {name: _box(ax, name, place) for name, place in places.items()}
        for part in parts:
            colour = _colour(part.name)
            for name in sorted(part.feels):
                _arrow(ax, boxes[f"feels {name}"], boxes[part.name], colour, "-")
            for name in sorted(part.writes):
                _arrow(ax, boxes[part.name], boxes[f"shared {name}"], colour, "-")
            for name in sorted(part.hears - part.writes):
                _arrow(ax, boxes[f"shared {name}"], boxes[part.name], colour, (0, (4, 2)))
        for y, text in ((_SENSORS, "sensors"), (_CONTROLLERS, "controllers"), (_SHARED, "shared")):
            ax.text(-0.08, y, text, ha="right", va="center", color=COLOURS["neutral"])
        ax.set(xlim=(-0.2, 1.05), ylim=(-0.4, 2.4))
        ax.set_axis_off()
    return captioned(figure, _caption(parts))


def _caption(parts: Sequence[ControlPart]) -> str:
    deaf = [part.name for part in parts if not part.hears and not part.writes]
    apart = f" Apart from the shared variables: {', '.join(deaf)}." if deaf else ""
    return (
        "What each controller reads and writes, in the form of the article's Fig. 10. Arrows from sensors: what it "
        "senses; solid arrows down: the shared variables that it writes; dashed arrows up: those of others that it "
        "reads." + apart
    )


def _colour(controller: str) -> str:
    return COLOURS[_ROLES.get(controller, "neutral")]


def _box(ax: Any, name: str, place: tuple[float, float]) -> Any:
    kind, _, what = name.partition(" ")
    owner = OWNERS[what] if kind == "shared" else "" if kind == "feels" else name
    style = _BOX | {"edgecolor": _colour(owner)}
    weight = "normal" if what else "bold"
    return ax.text(*place, (what or name).replace("_", "\n"), ha="center", va="center", bbox=style, fontweight=weight)


def _arrow(ax: Any, start: Any, end: Any, colour: str, dashes: Any) -> None:
    ends = {"patchA": start.get_bbox_patch(), "patchB": end.get_bbox_patch(), "shrinkA": 3, "shrinkB": 3}
    style = {"arrowstyle": "-|>", "color": colour, "linestyle": dashes, "linewidth": 1.5, **ends}
    ax.annotate("", end.get_position(), start.get_position(), arrowprops=style)


def _spread(count: int) -> list[float]:
    return [float(x) for x in (np.arange(count) + 0.5) / max(count, 1)]
