"""One browser that watches a cycle of a swim again and again; what it shows, pages of its kind say."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from html import escape
from threading import Event
from time import monotonic
from typing import Any

import numpy as np
from viser import uplot

from suchus.figures import COLOURS
from suchus.viewer.plots import AXIS, Line, legend, series
from suchus.viewer.swim import PlottedCurve

_TURN = 0.05  # [s]; how often a page looks what it should show
_CYCLE = 4.0  # [s]; in which a cycle is played at speed 1
_INKS = (COLOURS["ours"], COLOURS["limbs_only"], COLOURS["tail"], COLOURS["limbs_tail_lifted"])


class CyclePage(ABC):
    """A browser and its own player of a cycle.

    Args:
        client: viser's handle of the browser.
    """

    def __init__(self, client: Any) -> None:
        self._client, self._closed, self._place = client, Event(), 0.0
        self._status = client.gui.add_html("")

    @abstractmethod
    def show(self) -> None:
        """Draw what is due, unless it is what the browser shows."""

    @property
    def frames(self) -> int:
        """Frames of the cycle; none is left out, however slow the browser [-]."""
        return 1

    def place(self, of: float) -> None:
        """Go to a share of the cycle; what is no number is its start [-]."""
        self._place = min(max(of, 0.0), 1.0) if np.isfinite(of) else 0.0

    def close(self) -> None:
        """End the replay."""
        self._closed.set()

    def run(self) -> None:
        """Play until closed."""
        before = monotonic()
        while not self._closed.is_set():
            start = monotonic()
            if not self._pause.value:
                share = min((start - before) / _CYCLE, 1.0 / self.frames)
                self._place = (self._place + self._speed.value * share) % 1.0
            before = start
            self.show()
            self._closed.wait(max(0.01, _TURN - (monotonic() - start)))

    def _add_player(self) -> None:
        """Add what stops the cycle and sets its pace, to the folder that is open."""
        self._pause = self._client.gui.add_checkbox("pause", initial_value=False)
        self._speed = self._client.gui.add_slider("playback speed [x]", 0.05, 4.0, 0.05, 1.0)

    def _dock(self, curves: Sequence[PlottedCurve]) -> None:
        """Put the controls to the right, and what was measured, if anything, to the left."""
        gui = self._client.gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(330)
        if curves:
            panel = gui.add_panel()
            with panel.add_tab("Measured"):
                for curve in curves:
                    _draw_curve(gui, curve)
            panel.dock_left()
            panel.set_width(370)


def status(title: str, lines: Sequence[tuple[str, str]], bar: str = "") -> str:
    """Return the head of a page as HTML: a title, lines with their names, and what the colours mean."""
    told = "".join(f'<div data-suchus="{name}" style="color:#444">{line}</div>' for name, line in lines)
    return f'<div style="padding:4px 12px;font:13px sans-serif"><b>{escape(title)}</b>{told}{bar}</div>'


def colour_bar(quantity: str, inks: np.ndarray, limit: float, low: str, high: str) -> str:
    """Return colours from ``-limit`` to ``limit`` as HTML, with what its ends mean in words."""
    stops = ",".join("rgb({},{},{})".format(*ink) for ink in inks)
    return (
        f'<div style="margin-top:8px;font-weight:600">{quantity}</div>'
        f'<div style="height:14px;border-radius:2px;background:linear-gradient(90deg,{stops})"></div>'
        f'<div style="display:flex;justify-content:space-between"><span>{-limit:.3g}</span><span>0</span>'
        f'<span>{limit:.3g}</span></div><div style="display:flex;justify-content:space-between;color:#666;'
        f'font-size:11px"><span>{low}</span><span>{high}</span></div>'
    )


def frame_text(frame: int, phase: np.ndarray) -> str:
    """Return in words which frame of the cycle is shown."""
    return f"frame {frame + 1} of {len(phase)}, phase {phase[frame]:.2f} of the last cycle"


def _draw_curve(gui: Any, curve: PlottedCurve) -> None:
    """Draw a measured course as a plot of its own, with at most as many lines as there are inks."""
    lines = tuple(Line(name, name, ink) for name, ink in zip(curve.lines, _INKS, strict=False))
    gui.add_uplot(
        data=(np.asarray(curve.x, dtype=float), *(np.asarray(curve.lines[line.column], dtype=float) for line in lines)),
        series=(uplot.Series(label="x"), *(series(uplot, line) for line in lines)),
        title=curve.title,
        scales={"x": uplot.Scale(time=False, auto=True), "y": uplot.Scale(auto=True)},
        axes=(uplot.Axis(**AXIS, size=26), uplot.Axis(**AXIS, size=52)),
        legend=uplot.Legend(show=False),
        padding=(10, 16, 0, 0),
        height=165,
    )  # fmt: skip
    gui.add_html(legend(lines))
