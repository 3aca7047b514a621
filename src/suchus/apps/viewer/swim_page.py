"""One browser that watches a cycle of a swim again and again, in the plane from above or in space."""

from abc import abstractmethod
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial
from viser import uplot

from suchus.apps.viewer.plots import AXIS, PLOTS, Line, legend, series
from suchus.apps.viewer.server import BrowserPage
from suchus.apps.viewer.stage import light, rgb
from suchus.apps.viewer.swim import Film, PlottedCurve, VortexFilm, colours
from suchus.visual.figures import COLOURS, vortices
from suchus.visual.skin.mesh import Mesh

_CYCLE_DURATION = 4.0  # [s]; in which a cycle is played at speed 1
_INKS = (COLOURS["ours"], COLOURS["limbs_only"], COLOURS["tail"], COLOURS["limbs_tail_lifted"])


class CyclePage(BrowserPage):
    """A browser and its own player of a cycle.

    Args:
        client: viser's handle of the browser.
    """

    def __init__(self, client: Any) -> None:
        super().__init__(client)
        self._phase = 0.0

    @abstractmethod
    def show(self) -> None:
        """Draw the frame that is due, unless the browser shows it already."""

    @property
    def frames(self) -> int:
        """Frames of the cycle; none is left out, however slow the browser [-]."""
        return 1

    def set_phase(self, phase: float) -> None:
        """Go to a phase of the cycle, 0 to 1; a value that is no number becomes 0 [-]."""
        self._phase = min(max(phase, 0.0), 1.0) if np.isfinite(phase) else 0.0

    def draw(self, clock: float, elapsed: float) -> None:
        """Advance the phase unless paused, and draw the frame that is due."""
        del clock
        if not self._pause.value:
            self._phase = (self._phase + self._speed.value * min(elapsed / _CYCLE_DURATION, 1.0 / self.frames)) % 1.0
        self.show()

    def _add_player(self) -> None:
        """Add pause and playback speed to the open folder."""
        self._pause = self._client.gui.add_checkbox("pause", initial_value=False)
        self._speed = self._client.gui.add_slider("playback speed [x]", 0.05, 4.0, 0.05, 1.0)

    def _measured(self, curves: Sequence[PlottedCurve]) -> None:
        """Plot the measured curves to the left of the scene."""
        if curves:
            gui = self._client.gui
            panel = gui.add_panel()
            with panel.add_tab("Measured"):
                for curve in curves:
                    _draw_curve(gui, curve)
            panel.dock_left()
            panel.set_width(PLOTS)


def status(title: str, lines: Sequence[tuple[str, str]], bar: str = "") -> str:
    """Return the head of a page as HTML: a title, lines with their names, and what the colours mean."""
    rows = "".join(f'<div data-suchus="{name}" style="color:#444">{line}</div>' for name, line in lines)
    return f'<div style="padding:4px 12px;font:13px sans-serif"><b>{escape(title)}</b>{rows}{bar}</div>'


def colour_bar(quantity: str, inks: np.ndarray, limit: float, low_label: str, high_label: str) -> str:
    """Return a colour bar as HTML.

    Args:
        quantity: what the colours show, with its unit.
        inks: colours from the lower to the upper end, (n, 3), 0 to 255.
        limit: value at the upper end; the lower end is its negative.
        low_label: what the lower end means.
        high_label: what the upper end means.
    """
    stops = ",".join("rgb({},{},{})".format(*ink) for ink in inks)
    return (
        f'<div style="margin-top:8px;font-weight:600">{quantity}</div>'
        f'<div style="height:14px;border-radius:2px;background:linear-gradient(90deg,{stops})"></div>'
        f'<div style="display:flex;justify-content:space-between"><span>{-limit:.3g}</span><span>0</span>'
        f'<span>{limit:.3g}</span></div><div style="display:flex;justify-content:space-between;color:#666;'
        f'font-size:11px"><span>{low_label}</span><span>{high_label}</span></div>'
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


CAMERA = ((0.75, -0.05, 3.3), (0.75, 0.0, 0.0))
"""First position and target of the camera [m]."""
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
            self._phase_slider = gui.add_slider("phase [cycle]", 0.0, 1.0, 0.01, 0.0)
            self._add_player()
        with gui.add_folder("Record"):
            self._film = gui.add_dropdown("swim", tuple(self._films), initial_value=films[-1].title)
            self._field = gui.add_dropdown("field", ("vorticity", "pressure", "none"))
        self._phase_slider.on_update(self._seek)
        self._dock()
        self._measured(curves)
        scene = client.scene
        scene.configure_environment_map(None)
        self._image: Any = None
        self._body = scene.add_mesh_simple(
            "/body", np.zeros((3, 3)), np.array([[0, 1, 2]]), color=rgb(_SKIN), side="double", cast_shadow=False
        )
        self._edge = scene.add_line_segments("/edge", np.zeros((1, 2, 3)), rgb(_EDGE), thickness=0.006)
        self._shown_frame: tuple[str, str, int] = ("", "", -1)

    def show(self) -> None:
        """Draw the frame that is due, unless the browser shows it already."""
        if not self._pause.value:
            self._phase_slider.value = round(self._phase, 2)
        film = self._films[self._film.value]
        frame = int(np.argmin(np.abs((film.phase - self._phase + 0.5) % 1.0 - 0.5)))
        frame_key = film.title, str(self._field.value), frame
        if frame_key != self._shown_frame:
            self._show(film, frame_key[1], frame, anew=frame_key[:2] != self._shown_frame[:2])
            self._shown_frame = frame_key

    def _seek(self, event: Any) -> None:
        if event.client is not None:
            self.set_phase(float(self._phase_slider.value))

    def _show(self, film: Film, field: str, frame: int, *, anew: bool) -> None:
        """Draw a field and the body of one frame; ``anew`` replaces the picture since its size may differ."""
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
            self._status.content = swim_text(film, field, frame)

    def _body_at(self, sides: np.ndarray) -> None:
        """Move the body's surface and edge to its two sides, (2, station, 2) [m]."""
        left_side, right_side = (np.column_stack([side, np.zeros(len(side))]) for side in sides)
        count = np.arange(len(left_side) - 1)
        side_count = len(left_side)
        self._body.vertices = np.concatenate([left_side, right_side]).astype(np.float32)
        self._body.faces = np.concatenate(
            [
                np.column_stack([count, count + side_count, count + 1]),
                np.column_stack([count + 1, count + side_count, count + side_count + 1]),
            ]
        ).astype(np.uint32)
        ring = np.concatenate([left_side, right_side[::-1], left_side[:1]]) + np.array([0.0, 0.0, 0.004])
        self._edge.points = np.stack([ring[:-1], ring[1:]], axis=1).astype(np.float32)


def swim_text(film: Film, field: str, frame: int) -> str:
    """Return the head of the page as HTML: which frame, and what the colours mean."""
    bar = ""
    if field != "none":
        inks = colours(field, np.linspace(-1.0, 1.0, 9))
        bar = colour_bar(f"{field} [{escape(film.units[field])}]", inks, film.limit(field), *_WORDS[field])
    return status(film.title, [("frame", frame_text(frame, film.phase))], bar)


_BOTH_HALVES, _LOWER_HALF, _NO_SURFACES = "both halves", "lower half", "none"


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
            self._forward = gui.add_button("step forward")
            self._add_player()
        with gui.add_folder("Vortices"):
            min_level, max_level = film.levels
            self._halves = gui.add_dropdown(
                "surfaces",
                (_BOTH_HALVES, _LOWER_HALF, _NO_SURFACES),
                hint="The half above the plane of symmetry hides the body.",
            )
            self._level = gui.add_slider(
                "Q [1/s²]", min_level, max_level, 0.05 * film.level, film.level,
                hint="Second invariant of the velocity's gradient on the surfaces; lower ones lie farther out.",
            )  # fmt: skip
        self._frame.on_update(self._seek)
        self._back.on_click(lambda _: self.step(-1))
        self._forward.on_click(lambda _: self.step(1))
        self._dock()
        self._measured(film.curves())
        light(client.scene)
        skin = film.body(0)
        red, green, blue = (round(255 * component) for component in vortices.SKIN)
        self._body = client.scene.add_mesh_simple(
            "/body", skin.vertices.astype(np.float32), skin.faces.astype(np.uint32), color=(red, green, blue),
            cast_shadow=False,
        )  # fmt: skip
        self._surfaces: dict[int, Any] = {}
        self._surface_settings: tuple[float, str] = (film.level, _BOTH_HALVES)
        self._blocks = film.blocks(film.level)
        self._shown_frame: tuple[float, str, int] | None = None

    @property
    def frames(self) -> int:
        """Frames of the cycle [-]."""
        return self._count

    def step(self, frames: int) -> None:
        """Pause, and go on or back by frames."""
        self._pause.value = True
        self._show_frame(self.frame + frames)

    @property
    def frame(self) -> int:
        """Number of the frame that is due, from 0."""
        return min(int(self._phase * self._count), self._count - 1)

    def show(self) -> None:
        """Draw the frame that is due, unless the browser shows it already."""
        due = (self._film.clip_level(float(self._level.value)), str(self._halves.value), self.frame)
        if due == self._shown_frame:
            return
        level, halves, frame = due
        with self._client.atomic():
            if (level, halves) != self._surface_settings:
                self._forget(level, halves)
            for number, surface in self._surfaces.items():
                surface.visible = number == frame
            if halves != _NO_SURFACES and frame not in self._surfaces:
                self._surfaces[frame] = self._draw_surface(frame)
            self._body.vertices = self._film.body(frame).vertices.astype(np.float32)
            self._frame.value = frame + 1
            self._status.content = vortex_text(self._film, frame, level, self._blocks)
        self._shown_frame = due

    def _seek(self, event: Any) -> None:
        if event.client is not None:
            value = float(self._frame.value)
            self._show_frame(round(value) - 1 if np.isfinite(value) else 0)

    def _show_frame(self, frame: int) -> None:
        self._phase = (frame % self._count + 0.5) / self._count

    def _forget(self, level: float, halves: str) -> None:
        """Remove all surfaces and take over another level and another choice of halves."""
        for surface in self._surfaces.values():
            surface.remove()
        self._surfaces.clear()
        if level != self._surface_settings[0]:
            self._blocks = self._film.blocks(level)
        self._surface_settings = level, halves

    def _draw_surface(self, frame: int) -> Any:
        """Add the surfaces of one frame to the scene and return their handle."""
        level, halves = self._surface_settings
        mesh = self._film.surfaces(frame, level, blocks=self._blocks, lower_half_only=halves == _LOWER_HALF)
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


def vortex_text(film: VortexFilm, frame: int, level: float, blocks: int) -> str:
    """Return the head of the page as HTML: which frame, which surfaces, and what their colours mean."""
    inks = np.round(255.0 * vortices.colours(np.linspace(-1.0, 1.0, 9), 1.0)).astype(int)
    block_text = f", of blocks of {blocks} cells" if blocks > 1 else ""
    lines = [("frame", frame_text(frame, film.phase)), ("level", f"surfaces of Q = {level:.3g} 1/s²{block_text}")]
    bar = colour_bar(
        "vorticity about the vertical [1/s]", inks, film.limit, "clockwise from above", "counter-clockwise"
    )
    return status(film.description() or "a swim", lines, bar)
