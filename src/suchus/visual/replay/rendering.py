"""One picture of a robot in the look of the replays, without OpenGL: floor with lines, shadow, skin, water and goal.

Camera, light and colours are those of ``pages/templates/player.js``. Triangles are drawn from far to near.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path as Outline
from matplotlib.transforms import IdentityTransform

from suchus.robot.design import Robot
from suchus.robot.design.ground import Relief, heights
from suchus.visual.figures import COLOURS
from suchus.visual.replay.scene import KEYS
from suchus.visual.skin import Poses, ankles, skin_with_ankles

WIDTH, HEIGHT = 640, 480
"""Width and height of a picture [pixel]."""
_BACK, _LINE = np.array([0.925, 0.925, 0.905]), np.array([0.60, 0.60, 0.57])
_LIGHT = (np.array([-0.35, -0.45, 1.0]) / np.linalg.norm([-0.35, -0.45, 1.0])).astype(np.float32)
_GROUND_LIGHT, _SKY_LIGHT = np.array([[0.42, 0.39, 0.35], [0.55, 0.58, 0.62]], dtype=np.float32)
_AZIMUTH, _ELEVATION, _DISTANCE, _HALF_FIELD = -0.95, 0.36, 1.6, 0.30  # [rad], [rad], [size of the robot], [rad]
_SHADOW, _WATER = 0.22, 0.3  # opacities
_GRID = ((0.1, 0.0006, 0.22), (1.0, 0.002, 0.70))  # distance of lines [m], their width [m], opacity
_FADE = (2.0, 9.0)  # [m]; distances from the camera between which lines fade
_WATER_REACH = 9.0  # robot's lengths around the robot in which water is seen
_SHADE_BYTES = np.full((256, 4), 255, dtype=np.uint8)
_SHADE_BYTES[:, :3] = np.rint(255.0 * (_BACK + np.linspace(0.0, 1.0, 256)[:, None] * (_LINE - _BACK)))
_SHADES = _SHADE_BYTES.view(np.uint32)[:, 0]  # colours between floor and line, one number each
_WATER_COLOUR = np.array(to_rgb(KEYS["water"]), dtype=np.float32)
_WET_SHADES = np.rint((1.0 - _WATER) * np.arange(256.0) + _WATER * 255.0 * _WATER_COLOUR[:, None]).astype(
    np.uint8
)  # what each shade of a colour becomes under water
_RELIEF_POINTS, _RELIEF_REACH = 41, 0.9  # points of relief along each side of what is seen, and its half side [length]
_GOAL_POINTS = 48
_ARROW_LENGTH = 0.3  # of the arrow to a goal that is out of sight [robot's length]
_ROWS = 24  # of pixels that are computed together
_DPI, _TEXT_SIZE = 100, 9.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenery:
    """What a picture shows beside the robot."""

    upward: Float[np.ndarray, "3"]
    """Unit vector against gravity in the frame of the ground."""
    level: float | None = None
    """Level of the water above the world's origin, against gravity [m]; None on dry land."""
    goal: Float[np.ndarray, "2"] | None = None
    """Position of the goal, forward and left [m]; None without a goal."""
    goal_radius: float = 0.0
    """Radius of a goal that is a point; 0 for a line across [m]."""
    relief: Relief | None = None
    """What rises from the ground near the robot."""
    text: str = ""
    """Text above."""


class _View(NamedTuple):
    """A camera: what it looks at and its axes."""

    eye: np.ndarray
    """Position of the camera [m]."""
    axes: np.ndarray
    """Its right, up and backward unit vectors, one a row."""


class Renderer:
    """Draws pictures of one robot; what is the same in each of them is computed once.

    Args:
        robot: the robot.
        width: width of the pictures [pixel].
        height: height of the pictures [pixel].
    """

    def __init__(self, robot: Robot, *, width: int = WIDTH, height: int = HEIGHT) -> None:
        self._robot, self._width, self._height = robot, width, height
        self._skin = skin_with_ankles(robot)
        self._size = max([robot.length, *(2 * girdle.limb.reach for girdle in robot.girdles)])
        aspect = width / height
        self._focal = 1.0 / np.tan(_HALF_FIELD * max(1.0, 0.75 / aspect))
        self._distance = _DISTANCE * self._size * max(0.78, min(1.0, 1.7 / aspect), 1.15 / aspect)
        away = np.array(
            [np.cos(_ELEVATION) * np.cos(_AZIMUTH), np.cos(_ELEVATION) * np.sin(_AZIMUTH), np.sin(_ELEVATION)]
        )
        right = np.cross([0.0, 0.0, 1.0], away) / np.cos(_ELEVATION)
        self._axes = np.stack([right, np.cross(away, right), away]).astype(np.float32)
        skin = self._skin
        self._vertices, self._normals = skin.vertices.astype(np.float32), skin.normals.astype(np.float32)
        self._colours = (skin.colours / 255.0).astype(np.float32)
        self._weights = skin.weights[:, :2, None, None].astype(np.float32)
        self._canvas: Any = RendererAgg(width, height, _DPI)  # type: ignore[no-untyped-call]
        x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        self._rays = (
            np.stack(  # direction through each pixel, at unit distance from the camera
                [(2 * x / width - 1) * aspect / self._focal, (1 - 2 * y / height) / self._focal, -np.ones_like(x)],
                axis=-1,
            )
            @ self._axes
        )
        self._rays = self._rays.astype(np.float32)
        self._prepare_floor()
        self._fall: tuple[np.ndarray, np.ndarray] | None = None  # upward direction, and how far each ray rises along it

    def render(
        self,
        bones: Poses,
        feet: Float[np.ndarray, "limb 3"],
        mass: Float[np.ndarray, "3"],
        scenery: Scenery,
    ) -> UInt8[np.ndarray, "height width 3"]:
        """Return the picture of a posture as red, green and blue.

        Args:
            bones: pose of each body, (bone, ...).
            feet: centres of the feet [m].
            mass: centre of mass, which the camera follows [m].
            scenery: what is seen beside the robot.
        """
        vertices, normals = self._posed(bones, feet, scenery.relief)
        length = self._robot.length
        height = mass[2] if scenery.level is not None else max(0.06 * length, 0.8 * mass[2])
        target = np.array([mass[0], mass[1], height])
        view = _View((target + self._distance * self._axes[2]).astype(np.float32), self._axes)
        self._draw_floor(view)
        screen, depth = self._projected(vertices, view)
        if scenery.relief is None:
            self._cast_shadow(vertices, view)
        else:
            self._draw_relief(scenery.relief, target, view)
        colours = self._lit(self._colours, normals, vertices, view)
        if scenery.level is None:
            self._draw_goal(scenery, mass, view)
            self._draw_faces(self._skin.faces, screen, depth, colours)
        else:
            elevation = vertices @ scenery.upward.astype(np.float32)
            is_wet = elevation[self._skin.faces[:, 0]] < scenery.level
            self._draw_faces(self._skin.faces[is_wet], screen, depth, colours)
            self._flood(scenery, target, view)
            self._draw_goal(scenery, mass, view)
            self._draw_faces(self._skin.faces[~is_wet], screen, depth, colours)
        if scenery.text:
            self._write(scenery.text)
        return np.ascontiguousarray(self._pixels[..., :3])

    def _posed(
        self, bones: Poses, feet: np.ndarray, relief: Relief | None
    ) -> tuple[Float[np.ndarray, "vertex 3"], Float[np.ndarray, "vertex 3"]]:
        """Return vertices [m] and normals of the skin in a posture, each blended of the two bones that it hangs on."""
        all_bones = ankles(self._robot, Poses(bones.positions[None], bones.quaternions[None]), feet[None], relief)
        matrices = _matrices(all_bones.quaternions[0])
        shifts = all_bones.positions[0] - (matrices @ self._skin.rest_origins[..., None])[..., 0]
        joined = np.concatenate([matrices, shifts[..., None]], axis=-1).astype(np.float32)
        indices = self._skin.indices
        blended = self._weights[:, 0] * joined[indices[:, 0]] + self._weights[:, 1] * joined[indices[:, 1]]
        vertices = (blended[..., :3] @ self._vertices[..., None])[..., 0] + blended[..., 3]
        return vertices, (blended[..., :3] @ self._normals[..., None])[..., 0]

    def _projected(self, points: np.ndarray, view: _View) -> tuple[np.ndarray, np.ndarray]:
        """Return the places of points on the picture, from its lower left corner [pixel], and their depth [m]."""
        seen = (points - view.eye) @ view.axes.T
        depth = -seen[..., 2]
        scale = np.float32(0.5 * self._height * self._focal) / np.maximum(depth, np.float32(1e-3 * self._size))
        x = 0.5 * self._width + scale * seen[..., 0]
        return np.stack([x, 0.5 * self._height + scale * seen[..., 1]], axis=-1), depth

    def _draw_floor(self, view: _View) -> None:
        """Draw the empty floor with its lines over everything, some rows at a time, which stay in the cache."""
        canvas = self._pixels.view(np.uint32)[..., 0]
        canvas[: self._floor_rows] = _SHADES[0]
        count = len(self._floor_distance)
        for start in range(0, count, _ROWS):
            rows = slice(start, min(start + _ROWS, count))
            fraction = self._line_fraction(rows, view)
            below = slice(self._floor_rows + rows.start, self._floor_rows + rows.stop)
            np.take(_SHADES, (255.0 * np.minimum(fraction, 1.0)).astype(np.intp), out=canvas[below])

    def _line_fraction(self, rows: slice, view: _View) -> Float[np.ndarray, "row width"]:
        """Return how far the colour of the floor is that of its lines, in some rows from the horizon on [-]."""
        height, fraction = np.float32(view.eye[2]), np.float32(0.0)
        for spacing, width, opacity in _GRID:
            missed = np.float32(1.0)
            for place, footprint, offset in zip(self._floor_places, self._footprints, view.eye[:2], strict=True):
                cells = (height / np.float32(spacing)) * place[rows]
                cells += np.float32(offset / spacing)
                cells -= np.rint(cells)
                np.abs(cells, out=cells)
                cells *= np.float32(spacing)
                cells -= np.float32(0.5 * width)
                cells /= footprint[rows]
                missed = np.minimum(missed, cells)
            missed = np.clip(missed * (np.float32(1.0 / 1.2) / height), np.float32(0.0), np.float32(1.0))
            hit = 1.0 - missed * missed * (3.0 - 2.0 * missed)
            hit *= np.minimum(np.float32(opacity * spacing / 6.0) / height * self._fineness[rows], np.float32(opacity))
            fraction = fraction + hit
        return np.asarray(fraction * (1.0 - _smooth(height * self._floor_distance[rows], *_FADE)))

    def _prepare_floor(self) -> None:
        """Compute where the rays through the pixels meet a floor that is 1 m below the camera."""
        downward = self._rays[..., 2]
        is_floor = (downward < -1e-3).all(axis=1)
        self._floor_rows = int(np.argmax(is_floor)) if is_floor.any() else self._height
        rays = self._rays[self._floor_rows :]
        places = [rays[..., k] / -rays[..., 2] for k in (0, 1)]
        footprints = [
            np.abs(np.gradient(place, axis=0)) + np.abs(np.gradient(place, axis=1)) + 1e-9 for place in places
        ]
        self._floor_places = [place.astype(np.float32) for place in places]
        self._footprints = [footprint.astype(np.float32) for footprint in footprints]
        self._fineness = 1.0 / np.maximum(*self._footprints)
        self._floor_distance = np.hypot(*self._floor_places)

    def _cast_shadow(self, vertices: np.ndarray, view: _View) -> None:
        """Darken the floor where the light does not reach it: under all triangles that face the light."""
        flat = vertices - vertices[:, 2:] / _LIGHT[2] * _LIGHT
        corners = flat[self._skin.faces]
        first, second = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
        is_lit = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] > 0.0
        screen, _ = self._projected(corners[is_lit], view)
        closed = np.concatenate([screen, screen[:, :1]], axis=1).reshape(-1, 2)
        codes = np.tile([Outline.MOVETO, Outline.LINETO, Outline.LINETO, Outline.CLOSEPOLY], len(screen))
        context = self._canvas.new_gc()
        context.set_linewidth(0.0)
        context.set_alpha(_SHADOW)
        self._canvas.draw_path(context, Outline(closed, codes), IdentityTransform(), (0.0, 0.0, 0.0, _SHADOW))

    def _lit(self, colours: np.ndarray, normals: np.ndarray, points: np.ndarray, view: _View) -> np.ndarray:
        """Return the colours of points in the light of the replays.

        Args:
            colours: their own colours, (point, 3) [-].
            normals: unit normals, (point, 3).
            points: positions, (point, 3) [m].
            view: the camera.
        """
        normals = normals / _lengths(normals)
        toward = view.eye - points
        toward /= _lengths(toward)
        middle = toward + _LIGHT
        middle /= _lengths(middle)
        sky = 0.5 + 0.5 * normals[:, 2:]
        facing = np.maximum(np.einsum("ij,ij->i", normals, toward)[:, None], 0.0)
        ambient = _GROUND_LIGHT + sky * (_SKY_LIGHT - _GROUND_LIGHT)
        lit = colours * (ambient + 0.66 * np.maximum(normals @ _LIGHT, 0.0)[:, None] + 0.24 * facing)
        shine = np.maximum(np.einsum("ij,ij->i", normals, middle)[:, None], 0.0)
        for exponent in (4, 7):  # to the power of 28, by multiplications
            shine = shine**exponent
        lit += 0.16 * shine
        return np.clip(lit + 0.10 * (1.0 - facing) ** 3 * sky, 0.0, 1.0)

    @property
    def _pixels(self) -> UInt8[np.ndarray, "height width 4"]:
        """What is on the canvas; a view."""
        return np.asarray(self._canvas.buffer_rgba())

    def _draw_faces(
        self, faces: np.ndarray, screen: np.ndarray, depth: np.ndarray, colours: np.ndarray, *, both_sides: bool = False
    ) -> None:
        """Draw triangles that face the camera, from far to near.

        Args:
            faces: three places of vertices each.
            screen: places of the vertices on the picture [pixel].
            depth: their distance [m].
            colours: their colours.
            both_sides: whether triangles that turn their back to the camera are drawn too.
        """
        corners = screen[faces]
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        chosen = np.flatnonzero((area != 0.0) if both_sides else (area > 0.0))
        order = chosen[np.argsort(-depth[faces[chosen]].sum(axis=1), kind="stable")]
        shades = np.ones((len(order), 3, 4))
        shades[..., :3] = colours[faces[order]]
        context = self._canvas.new_gc()
        self._canvas.draw_gouraud_triangles(context, corners[order].astype(float), shades, IdentityTransform())

    def _draw_relief(self, relief: Relief, target: np.ndarray, view: _View) -> None:
        """Draw the ground around the robot where it is not even."""
        side = _RELIEF_REACH * self._robot.length * np.linspace(-1.0, 1.0, _RELIEF_POINTS)
        x, y = np.meshgrid(target[0] + side, target[1] + side)
        z = heights(relief, x, y)
        points = np.stack([x, y, z], axis=-1)
        step = side[1] - side[0]
        normals = np.stack([-np.gradient(z, step, axis=1), -np.gradient(z, step, axis=0), np.ones_like(z)], axis=-1)
        colours = np.broadcast_to(np.array(to_rgb(KEYS["relief"])), points.shape).reshape(-1, 3)
        flat = points.reshape(-1, 3)
        shades = self._lit(colours, normals.reshape(-1, 3), flat, view)
        screen, depth = self._projected(flat, view)
        corner = (np.arange(_RELIEF_POINTS - 1)[:, None] * _RELIEF_POINTS + np.arange(_RELIEF_POINTS - 1)).ravel()
        faces = np.concatenate(
            [
                np.stack([corner, corner + 1, corner + 1 + _RELIEF_POINTS], axis=1),
                np.stack([corner, corner + 1 + _RELIEF_POINTS, corner + _RELIEF_POINTS], axis=1),
            ]
        )
        raised = faces[(np.abs(flat[faces, 2]) > 1e-9).any(axis=1)]
        if len(raised):
            self._draw_faces(raised, screen, depth, shades)

    def _flood(self, scenery: Scenery, target: np.ndarray, view: _View) -> None:
        """Draw the surface of the water over the picture, where that stands above the ground."""
        assert scenery.level is not None
        if self._fall is None or not np.array_equal(self._fall[0], scenery.upward):
            self._fall = scenery.upward.copy(), self._rays @ scenery.upward.astype(np.float32)
        fall = self._fall[1]
        gap = float(view.eye @ scenery.upward) - scenery.level
        rows = np.flatnonzero((fall * gap < -1e-4 * abs(gap)).all(axis=1))
        if not len(rows):
            return
        reach = np.float32(_WATER_REACH * self._robot.length)
        for start in range(int(rows[0]), int(rows[-1]) + 1, _ROWS):
            window = slice(start, min(start + _ROWS, int(rows[-1]) + 1))
            travel = np.float32(-gap) / fall[window]
            place = [view.eye[k] + travel * self._rays[window, :, k] for k in range(3)]
            distance = np.hypot(place[0] - np.float32(target[0]), place[1] - np.float32(target[1]))
            opacity = np.float32(_WATER) * (1.0 - _smooth(distance / reach, 0.4, 1.0)) * (place[2] >= 0.0)
            below = self._pixels[window, :, :3]
            if opacity.min() > 0.999 * _WATER:
                for channel in range(3):
                    below[..., channel] = _WET_SHADES[channel][below[..., channel]]
                continue
            seen = below.astype(np.float32)
            seen += opacity[..., None] * (255.0 * _WATER_COLOUR - seen)
            below[...] = np.rint(seen)

    def _draw_goal(self, scenery: Scenery, mass: np.ndarray, view: _View) -> None:
        """Draw a ring or a line where the goal is, and an arrow to one that is out of sight."""
        if scenery.goal is None:
            return
        if scenery.goal_radius:
            angle = np.linspace(0.0, 2 * np.pi, _GOAL_POINTS)
            ring = scenery.goal + scenery.goal_radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            middle = scenery.goal
        else:
            side = self._size * np.linspace(-2.0, 2.0, _GOAL_POINTS)
            ring = np.stack([np.full(_GOAL_POINTS, scenery.goal[0]), mass[1] + side], axis=1)
            middle = np.array([scenery.goal[0], mass[1]])
        self._draw_line(self._raised(ring, scenery), view)
        direction = middle - mass[:2]
        distance = float(np.hypot(*direction))
        (x, y), _ = (array[0] for array in self._projected(self._raised(middle[None], scenery), view))
        is_seen = 0.0 < x < self._width and 0.0 < y < self._height
        if is_seen or distance < 1e-9:
            return
        ahead = direction / distance * self._robot.length
        tip = mass[:2] + (0.5 + _ARROW_LENGTH) * ahead
        across = 0.2 * _ARROW_LENGTH * np.array([-ahead[1], ahead[0]])
        barbs = [tip - 0.3 * _ARROW_LENGTH * ahead + across, tip, tip - 0.3 * _ARROW_LENGTH * ahead - across]
        self._draw_line(self._raised(np.array([mass[:2] + 0.5 * ahead, tip]), scenery), view)
        self._draw_line(self._raised(np.array(barbs), scenery), view)

    def _raised(self, points: np.ndarray, scenery: Scenery) -> np.ndarray:
        """Return points of the ground [m], on the water where that stands above them."""
        height = heights(scenery.relief, points[:, 0], points[:, 1])
        if scenery.level is not None:
            surface = (scenery.level - points @ scenery.upward[:2]) / scenery.upward[2]
            height = np.maximum(height, surface)
        return np.column_stack([points, height])

    def _draw_line(self, points: np.ndarray, view: _View) -> None:
        """Draw a line through points of the world that lie before the camera."""
        screen, depth = self._projected(points, view)
        screen = screen[depth > 0.05 * self._size]
        if len(screen) > 1:
            context = self._canvas.new_gc()
            context.set_foreground(COLOURS["limbs_only"])
            context.set_linewidth(2.0)
            self._canvas.draw_path(context, Outline(screen), IdentityTransform())

    def _write(self, text: str) -> None:
        """Write a text at the upper left corner."""
        context = self._canvas.new_gc()
        context.set_foreground("#333333")
        self._canvas.draw_text(context, 10, 22, text, FontProperties(size=_TEXT_SIZE), 0.0)


def _smooth(value: np.ndarray, lower_bound: float, upper_bound: float) -> np.ndarray:
    """Return a smooth step from 0 at the lower bound to 1 at the upper one."""
    fraction = np.clip((value - lower_bound) / (upper_bound - lower_bound), 0.0, 1.0)
    return np.asarray(fraction * fraction * (3.0 - 2.0 * fraction))


def _lengths(vectors: np.ndarray) -> np.ndarray:
    """Return the lengths of vectors, shape (n, 1), none of them 0."""
    return np.maximum(np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None], np.float32(1e-9))


def _matrices(quaternions: Float[np.ndarray, "bone 4"]) -> Float[np.ndarray, "bone 3 3"]:
    """Return the rotation matrices of unit quaternions wxyz."""
    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
