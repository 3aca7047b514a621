"""One browser that watches a swim from above: the body, vorticity or pressure of the water, forces and speeds."""

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from suchus.viewer.cycle_page import CyclePage, colour_bar, frame_text, status
from suchus.viewer.stage import rgb
from suchus.viewer.swim import Film, PlottedCurve, colours

CAMERA = ((0.75, -0.05, 3.3), (0.75, 0.0, 0.0))
"""Where the camera is at first and where it looks [m]."""
_SKIN, _EDGE = "#C9DCCB", "#2F4737"
_WORDS = {"vorticity": ("turns clockwise", "counter-clockwise"), "pressure": ("suction", "pressure")}


class SwimPage(CyclePage):
    """A browser and its own player of a swim.

    Args:
        client: viser's handle of the browser.
        films: the swims of the record.
        curves: what was measured.
    """

    def __init__(self, client: Any, films: Sequence[Film], curves: Sequence[PlottedCurve]) -> None:
        super().__init__(client)
        self._films = {film.title: film for film in films}
        gui = client.gui
        with gui.add_folder("Replay"):
            self._phase = gui.add_slider("phase [cycle]", 0.0, 1.0, 0.01, 0.0)
            self._add_player()
        with gui.add_folder("Record"):
            self._film = gui.add_dropdown("swim", tuple(self._films), initial_value=films[-1].title)
            self._field = gui.add_dropdown("field", ("vorticity", "pressure", "none"))
        self._phase.on_update(self._seek)
        self._dock(curves)
        scene = client.scene
        scene.configure_environment_map(None)
        self._image: Any = None
        self._body = scene.add_mesh_simple(
            "/body", np.zeros((3, 3)), np.array([[0, 1, 2]]), color=rgb(_SKIN), side="double", cast_shadow=False
        )
        self._edge = scene.add_line_segments("/edge", np.zeros((1, 2, 3)), rgb(_EDGE), thickness=0.006)
        self._shown: tuple[str, str, int] = ("", "", -1)

    def show(self) -> None:
        """Draw the frame that is due, unless it is what the browser shows."""
        if not self._pause.value:
            self._phase.value = round(self._place, 2)
        film = self._films[self._film.value]
        frame = int(np.argmin(np.abs((film.phase - self._place + 0.5) % 1.0 - 0.5)))
        now = film.title, str(self._field.value), frame
        if now != self._shown:
            self._show(film, now[1], frame, anew=now[:2] != self._shown[:2])
            self._shown = now

    def _seek(self, event: Any) -> None:
        if event.client is not None:
            self.place(float(self._phase.value))

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
        inks = colours(field, np.linspace(-1.0, 1.0, 9))
        bar = colour_bar(f"{field} [{escape(film.units[field])}]", inks, film.limit(field), *_WORDS[field])
    return status(film.title, [("frame", frame_text(frame, film.phase))], bar)
