"""One browser that watches a swim in three dimensions: the body, and surfaces around its vortices."""

from html import escape
from threading import Event
from time import monotonic
from typing import Any

import numpy as np
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from suchus.figures import vortices
from suchus.skin.mesh import Mesh
from suchus.viewer.stage import light
from suchus.viewer.swim_page import draw_curve
from suchus.viewer.vortices import VortexFilm

_TURN = 0.05  # [s]; how often the page looks what it should show
_CYCLE = 4.0  # [s]; in which a cycle is played at speed 1
_BOTH, _LOWER, _NONE = "both halves", "lower half", "none"


class VortexPage:
    """A browser and its own player of a swim in three dimensions.

    Surfaces are made when they are first shown and stay in the browser, so that the second cycle plays smoothly.

    Args:
        client: viser's handle of the browser.
        film: the last cycle of the swim.
    """

    def __init__(self, client: Any, film: VortexFilm) -> None:
        self._client, self._film, self._closed = client, film, Event()
        self._count, self._place = len(film.phase), 0.0
        gui = client.gui
        self._status = gui.add_html("")
        with gui.add_folder("Replay"):
            self._frame = gui.add_slider("frame", 1, max(self._count, 2), 1, 1, disabled=self._count == 1)
            self._pause = gui.add_checkbox("pause", initial_value=False)
            self._back = gui.add_button("step back")
            self._on = gui.add_button("step forward")
            self._speed = gui.add_slider("playback speed [x]", 0.05, 4.0, 0.05, 1.0)
        with gui.add_folder("Vortices"):
            low, high = film.levels
            self._halves = gui.add_dropdown(
                "surfaces", (_BOTH, _LOWER, _NONE), hint="The half above the plane of symmetry hides the body."
            )
            self._level = gui.add_slider(
                "Q [1/s²]", low, high, 0.05 * film.level, film.level,
                hint="Second invariant of the velocity's gradient on the surfaces; lower ones lie farther out.",
            )  # fmt: skip
        gui.main_panel.dock_right()
        gui.main_panel.set_width(330)
        self._frame.on_update(self._seek)
        self._back.on_click(lambda _: self.step(-1))
        self._on.on_click(lambda _: self.step(1))
        if curves := film.curves():
            panel = gui.add_panel()
            with panel.add_tab("Measured"):
                for curve in curves:
                    draw_curve(gui, curve)
            panel.dock_left()
            panel.set_width(370)
        light(client.scene)
        skin = film.body(0)
        red, green, blue = (round(255 * part) for part in vortices.SKIN)
        self._body = client.scene.add_mesh_simple(
            "/body", skin.vertices.astype(np.float32), skin.faces.astype(np.uint32), color=(red, green, blue),
            cast_shadow=False,
        )  # fmt: skip
        self._made: dict[int, Any] = {}
        self._of: tuple[float, str] = (film.level, _BOTH)
        self._blocks = film.blocks(film.level)
        self._shown: tuple[float, str, int] | None = None

    def close(self) -> None:
        """End the replay."""
        self._closed.set()

    def run(self) -> None:
        """Play until closed."""
        before = monotonic()
        while not self._closed.is_set():
            start = monotonic()
            if not self._pause.value:
                share = min(start - before, _CYCLE / self._count) / _CYCLE  # no frame is left out, however slow
                self._place = (self._place + self._speed.value * share) % 1.0
            before = start
            self.show()
            self._closed.wait(max(0.01, _TURN - (monotonic() - start)))

    def step(self, frames: int) -> None:
        """Pause, and go on or back by frames."""
        self._pause.value = True
        self._go(self.frame + frames)

    @property
    def frame(self) -> int:
        """Number of the frame that is due, from 0."""
        return min(int(self._place * self._count), self._count - 1)

    def show(self) -> None:
        """Draw the frame that is due, unless it is what the browser shows."""
        due = (self._film.within(float(self._level.value)), str(self._halves.value), self.frame)
        if due == self._shown:
            return
        level, halves, frame = due
        with self._client.atomic():
            if (level, halves) != self._of:
                self._forget(level, halves)
            for number, surface in self._made.items():
                surface.visible = number == frame
            if halves != _NONE and frame not in self._made:
                self._made[frame] = self._drawn(frame)
            self._body.vertices = self._film.body(frame).vertices.astype(np.float32)
            self._frame.value = frame + 1
            self._status.content = status_text(self._film, frame, level, self._blocks)
        self._shown = due

    def _seek(self, event: Any) -> None:
        if event.client is not None:
            value = float(self._frame.value)
            self._go(round(value) - 1 if np.isfinite(value) else 0)

    def _go(self, frame: int) -> None:
        self._place = (frame % self._count + 0.5) / self._count

    def _forget(self, level: float, halves: str) -> None:
        for surface in self._made.values():
            surface.remove()
        self._made.clear()
        if level != self._of[0]:
            self._blocks = self._film.blocks(level)
        self._of = level, halves

    def _drawn(self, frame: int) -> Any:
        level, halves = self._of
        mesh = self._film.surfaces(frame, level, blocks=self._blocks, lower=halves == _LOWER)
        return self._client.scene.add_mesh_trimesh(
            f"/vortices/{level:.6g}_{halves[:4]}_{frame}", _coloured(mesh), cast_shadow=False, receive_shadow=False
        )


def _coloured(mesh: Mesh) -> trimesh.Trimesh:
    """Return surfaces as the browser takes them; a speck where there are none, since it takes no empty ones."""
    if not len(mesh.faces):
        return trimesh.Trimesh(np.zeros((3, 3)), [[0, 1, 2]], process=False)
    dull = TextureVisuals(material=PBRMaterial(metallicFactor=0.0, roughnessFactor=0.8, doubleSided=True))
    linear = np.where(mesh.colours > 0.04045, ((mesh.colours + 0.055) / 1.055) ** 2.4, mesh.colours / 12.92)  # of sRGB
    opaque = np.ones((len(linear), 1))
    dull.vertex_attributes["color"] = np.round(255.0 * np.concatenate([linear, opaque], axis=1)).astype(np.uint8)
    return trimesh.Trimesh(mesh.vertices, mesh.faces, visual=dull, process=False)


def status_text(film: VortexFilm, frame: int, level: float, blocks: int) -> str:
    """Return the head of the page as HTML: which frame, which surfaces, and what their colours mean."""
    inks = np.round(255.0 * vortices.colours(np.linspace(-1.0, 1.0, 9), 1.0)).astype(int)
    stops = ",".join("rgb({},{},{})".format(*ink) for ink in inks)
    where = f"frame {frame + 1} of {len(film.phase)}, phase {film.phase[frame]:.2f} of the last cycle"
    of = f", of blocks of {blocks} cells" if blocks > 1 else ""
    return (
        f'<div style="padding:4px 12px;font:13px sans-serif"><b>{escape(film.about() or "a swim")}</b>'
        f'<div data-suchus="frame" style="color:#444">{where}</div>'
        f'<div data-suchus="level" style="color:#444">surfaces of Q = {level:.3g} 1/s²{of}</div>'
        '<div style="margin-top:8px;font-weight:600">vorticity about the vertical [1/s]</div>'
        f'<div style="height:14px;border-radius:2px;background:linear-gradient(90deg,{stops})"></div>'
        f'<div style="display:flex;justify-content:space-between"><span>{-film.limit:.3g}</span><span>0</span>'
        f'<span>{film.limit:.3g}</span></div><div style="display:flex;justify-content:space-between;color:#666;'
        'font-size:11px"><span>clockwise from above</span><span>counter-clockwise</span></div></div>'
    )
