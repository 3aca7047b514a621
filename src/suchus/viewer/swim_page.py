"""One browser that watches a swim from above: the body, vorticity or pressure of the water, forces and speeds."""

from collections.abc import Sequence
from html import escape
from threading import Event
from time import monotonic
from typing import Any

import numpy as np
from viser import uplot

from suchus.figures import COLOURS
from suchus.viewer.plots import AXIS, Line, legend, series
from suchus.viewer.stage import rgb
from suchus.viewer.swim import Film, PlottedCurve, colours

CAMERA = ((0.75, -0.05, 3.3), (0.75, 0.0, 0.0))
"""Where the camera is at first and where it looks [m]."""
_SKIN, _EDGE = "#C9DCCB", "#2F4737"
_INKS = (COLOURS["ours"], COLOURS["limbs_only"], COLOURS["tail"], COLOURS["limbs_tail_lifted"])
_FRAME = 0.1  # [s]
_CYCLE = 4.0  # [s]; in which a cycle is played at speed 1
_WORDS = {"vorticity": ("turns clockwise", "counter-clockwise"), "pressure": ("suction", "pressure")}


class SwimPage:
    """A browser and its own player of a swim.

    Args:
        client: viser's handle of the browser.
        films: the swims of the record.
        curves: what was measured.
    """

    def __init__(self, client: Any, films: Sequence[Film], curves: Sequence[PlottedCurve]) -> None:
        self._client, self._closed = client, Event()
        self._films = {film.title: film for film in films}
        self._place = 0.0
        gui = client.gui
        self._status = gui.add_html("")
        with gui.add_folder("Replay"):
            self._phase = gui.add_slider("phase [cycle]", 0.0, 1.0, 0.01, 0.0)
            self._pause = gui.add_checkbox("pause", initial_value=False)
            self._speed = gui.add_slider("playback speed [x]", 0.05, 4.0, 0.05, 1.0)
        with gui.add_folder("Record"):
            self._film = gui.add_dropdown("swim", tuple(self._films), initial_value=films[-1].title)
            self._field = gui.add_dropdown("field", ("vorticity", "pressure", "none"))
        gui.main_panel.dock_right()
        gui.main_panel.set_width(330)
        self._phase.on_update(self._seek)
        if curves:
            panel = gui.add_panel()
            with panel.add_tab("Measured"):
                for curve in curves:
                    draw_curve(gui, curve)
            panel.dock_left()
            panel.set_width(370)
        scene = client.scene
        scene.configure_environment_map(None)
        self._image: Any = None
        self._body = scene.add_mesh_simple(
            "/body", np.zeros((3, 3)), np.array([[0, 1, 2]]), color=rgb(_SKIN), side="double", cast_shadow=False
        )
        self._edge = scene.add_line_segments("/edge", np.zeros((1, 2, 3)), rgb(_EDGE), thickness=0.006)
        self._shown: tuple[str, str, int] = ("", "", -1)

    def close(self) -> None:
        """End the replay."""
        self._closed.set()

    def run(self) -> None:
        """Play until closed."""
        before = monotonic()
        while not self._closed.is_set():
            start = monotonic()
            if not self._pause.value:
                self._place = (self._place + self._speed.value * (start - before) / _CYCLE) % 1.0
                self._phase.value = round(self._place, 2)
            before = start
            film = self._films[self._film.value]
            frame = int(np.argmin(np.abs((film.phase - self._place + 0.5) % 1.0 - 0.5)))
            now = film.title, str(self._field.value), frame
            if now != self._shown:
                self._show(film, now[1], frame, anew=now[:2] != self._shown[:2])
                self._shown = now
            self._closed.wait(max(0.01, _FRAME - (monotonic() - start)))

    def _seek(self, event: Any) -> None:
        if event.client is not None:
            value = float(self._phase.value)
            self._place = min(max(value, 0.0), 1.0) if np.isfinite(value) else 0.0

    def _show(self, film: Film, field: str, frame: int, *, anew: bool) -> None:
        field = field if field in film.fields else "none"
        with self._client.atomic():
            if anew and self._image is not None:
                self._image.remove()
                self._image = None
            if field != "none":
                picture = film.picture(field, frame)
                if self._image is None:
                    width, height = float(np.ptp(film.x)), float(np.ptp(film.y))
                    self._image = self._client.scene.add_image(
                        "/field", picture, width, height, format="png",
                        position=(float(film.x.mean()), float(film.y.mean()), -0.01), cast_shadow=False,
                        receive_shadow=False,
                    )  # fmt: skip
                else:
                    self._image.image = picture
            self._body_at(film.sides[frame])
            self._status.content = status_text(film, field, frame)

    def _body_at(self, sides: np.ndarray) -> None:
        left, right = (np.column_stack([side, np.zeros(len(side))]) for side in sides)
        count = np.arange(len(left) - 1)
        across = len(left)
        self._body.vertices = np.concatenate([left, right]).astype(np.float32)
        self._body.faces = np.concatenate(
            [
                np.column_stack([count, count + across, count + 1]),
                np.column_stack([count + 1, count + across, count + across + 1]),
            ]
        ).astype(np.uint32)
        ring = np.concatenate([left, right[::-1], left[:1]]) + np.array([0.0, 0.0, 0.004])
        self._edge.points = np.stack([ring[:-1], ring[1:]], axis=1).astype(np.float32)


def status_text(film: Film, field: str, frame: int) -> str:
    """Return the head of the page as HTML: which frame, and what the colours mean."""
    bar = ""
    if field != "none":
        limit, unit = film.limit(field), film.units[field]
        stops = ",".join("rgb({},{},{})".format(*ink) for ink in colours(field, np.linspace(-1.0, 1.0, 9)))
        low, high = _WORDS[field]
        bar = (
            f'<div style="margin-top:8px;font-weight:600">{field} [{escape(unit)}]</div>'
            f'<div style="height:14px;border-radius:2px;background:linear-gradient(90deg,{stops})"></div>'
            f'<div style="display:flex;justify-content:space-between"><span>{-limit:.3g}</span><span>0</span>'
            f'<span>{limit:.3g}</span></div><div style="display:flex;justify-content:space-between;color:#666;'
            f'font-size:11px"><span>{low}</span><span>{high}</span></div>'
        )
    where = f"frame {frame + 1} of {len(film.phase)}, phase {film.phase[frame]:.2f} of the last cycle"
    return (
        f'<div style="padding:4px 12px;font:13px sans-serif"><b>{escape(film.title)}</b>'
        f'<div data-suchus="frame" style="color:#444">{where}</div>{bar}</div>'
    )


def draw_curve(gui: Any, curve: PlottedCurve) -> None:
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
