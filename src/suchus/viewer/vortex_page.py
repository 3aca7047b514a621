"""One browser that watches a swim in three dimensions: the body, and surfaces around its vortices."""

from typing import Any

import numpy as np
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from suchus.figures import vortices
from suchus.skin.mesh import Mesh
from suchus.viewer.cycle_page import CyclePage, colour_bar, frame_text, status
from suchus.viewer.stage import light
from suchus.viewer.vortices import VortexFilm

_BOTH, _LOWER, _NONE = "both halves", "lower half", "none"


class VortexPage(CyclePage):
    """A browser and its own player of a swim in three dimensions.

    Surfaces are made when they are first shown and stay in the browser, so that the second cycle plays smoothly.

    Args:
        client: viser's handle of the browser.
        film: the last cycle of the swim.
    """

    def __init__(self, client: Any, film: VortexFilm) -> None:
        super().__init__(client)
        self._film, self._count = film, len(film.phase)
        gui = client.gui
        with gui.add_folder("Replay"):
            self._frame = gui.add_slider("frame", 1, max(self._count, 2), 1, 1, disabled=self._count == 1)
            self._back = gui.add_button("step back")
            self._on = gui.add_button("step forward")
            self._add_player()
        with gui.add_folder("Vortices"):
            low, high = film.levels
            self._halves = gui.add_dropdown(
                "surfaces", (_BOTH, _LOWER, _NONE), hint="The half above the plane of symmetry hides the body."
            )
            self._level = gui.add_slider(
                "Q [1/s²]", low, high, 0.05 * film.level, film.level,
                hint="Second invariant of the velocity's gradient on the surfaces; lower ones lie farther out.",
            )  # fmt: skip
        self._frame.on_update(self._seek)
        self._back.on_click(lambda _: self.step(-1))
        self._on.on_click(lambda _: self.step(1))
        self._dock(film.curves())
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

    @property
    def frames(self) -> int:
        """Frames of the cycle [-]."""
        return self._count

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
    of = f", of blocks of {blocks} cells" if blocks > 1 else ""
    lines = [("frame", frame_text(frame, film.phase)), ("level", f"surfaces of Q = {level:.3g} 1/s²{of}")]
    bar = colour_bar(
        "vorticity about the vertical [1/s]", inks, film.limit, "clockwise from above", "counter-clockwise"
    )
    return status(film.about() or "a swim", lines, bar)
