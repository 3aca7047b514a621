"""The scene of one browser: ground, robot, forces, support, track; the camera may follow.

Forces and edges are rods: a browser moves the bones of a skinned mesh at once, while a line or an arrow of viser's is
built anew at every change.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import log10, sqrt
from typing import Any

import numpy as np
from mjviser.conversions import create_primitive_mesh

from suchus.apps.viewer.bodies import support
from suchus.apps.viewer.drawn import BodyGeometry, DrawnRobot
from suchus.core.rotation import rotate
from suchus.robot.design import GRAVITY, Robot, front_segment, layout
from suchus.robot.design.ground import Relief, heights, slope
from suchus.robot.robots import size_relative_to_article
from suchus.sim.fault import Fault
from suchus.sim.metrics.gait import LOADED_SHARE
from suchus.sim.model import compile_model
from suchus.visual.figures import COLOURS
from suchus.visual.figures.style import limb_colours

_ROD_SIDES = 12  # sides of a rod's cross-section


@dataclass(frozen=True, slots=True)
class RodShape:
    """How thick a rod is, and whether it ends in a head."""

    radius: float
    """Radius of the shaft [m]."""
    head: float = 0.0
    """Length of the head [m]; 0 for a plain rod."""
    head_radius: float = 0.0
    """Radius of the head [m]."""


def rod(shape: RodShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices [m], faces and weights of a rod from 0 to 1 along z; its two bones are its ends.

    Args:
        shape: of the rod.
    """
    turn = 2 * np.pi * np.arange(_ROD_SIDES) / _ROD_SIDES
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(_ROD_SIDES)])
    axis = np.array([0.0, 0.0, 1.0])
    rings = [shape.radius * ring, shape.radius * ring + (1.0 - 0.9 * shape.head) * axis]
    if shape.head > 0.0:
        rings += [shape.head_radius * ring + (1.0 - shape.head) * axis]
    vertices = np.concatenate([*rings, [0.0 * axis], [axis], [(1.0 - shape.head) * axis]])
    bottom, top, collar = len(vertices) - 3, len(vertices) - 2, len(vertices) - 1
    i = np.arange(_ROD_SIDES)
    j = (i + 1) % _ROD_SIDES
    last_ring = 2 * _ROD_SIDES if shape.head > 0.0 else _ROD_SIDES
    faces = [
        np.column_stack([i, j, _ROD_SIDES + j]),
        np.column_stack([i, _ROD_SIDES + j, _ROD_SIDES + i]),
        np.column_stack([j, i, np.full(_ROD_SIDES, bottom)]),
        np.column_stack([last_ring + i, last_ring + j, np.full(_ROD_SIDES, top)]),
    ]
    if shape.head > 0.0:
        faces.append(np.column_stack([last_ring + j, last_ring + i, np.full(_ROD_SIDES, collar)]))
    weights = np.zeros((len(vertices), 2))
    base_vertices = np.r_[0:_ROD_SIDES, bottom]
    weights[:, 1] = 1.0
    weights[base_vertices] = (1.0, 0.0)
    return vertices, np.concatenate(faces), weights


def upright(direction: np.ndarray) -> np.ndarray:
    """Return the orientation wxyz that turns +z into a direction, a unit vector."""
    x, y, z = direction
    if z < -1.0 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    w = sqrt((1.0 + z) / 2)
    return np.array([w, -y / (2 * w), x / (2 * w), 0.0])


class DrawnRod:
    """A rod in the scene of one browser, not seen until it is put somewhere.

    Args:
        scene: viser's scene of that browser.
        name: name of its node.
        shape: how thick.
        colour: red, green, blue of 255.
    """

    def __init__(self, scene: Any, name: str, shape: RodShape, colour: tuple[int, int, int]) -> None:
        vertices, faces, weights = rod(shape)
        self._handle = scene.add_mesh_skinned(
            name,
            vertices,
            faces,
            bone_wxyzs=np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)),
            bone_positions=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
            skin_weights=weights,
            color=colour,
            visible=False,
            cast_shadow=False,
            receive_shadow=False,
        )

    def set_ends(self, start: np.ndarray, end: np.ndarray) -> None:
        """Show the rod from one point to another [m]."""
        axis = np.asarray(end, dtype=float) - start
        length = float(np.linalg.norm(axis))
        if length < 1e-6:
            self.hide()
            return
        orientation = upright(axis / length)
        self._handle.visible = True
        for bone, position in zip(self._handle.bones, (start, end), strict=True):
            bone.position, bone.wxyz = position, orientation

    def hide(self) -> None:
        """Hide the rod."""
        self._handle.visible = False


CAMERA = (0.8, -1.4, 0.8)
"""First position of the camera, for a robot as long as the article's [m]."""
LOOKS_AT = (-0.02, 0.0, 0.0)
"""First target of the camera, for a robot as long as the article's [m]."""
_WEIGHT_LENGTH = 0.276  # [m]; how long the weight of a robot as long as the article's is, as long as its trunk
_TIP, _COM, _STEP = 0.06, 0.014, 0.005  # [m]; of a push above its body, radius of a ball, between points of the track
_PAINT_HEIGHT = 0.003  # [m]; what is painted on the ground lies so far above it
WORLD = "/world"
"""Node of the scene that turns and moves with the ground."""
_ARROW = RodShape(radius=0.006, head=0.028, head_radius=0.014)
_PUSH = RodShape(radius=0.010, head=0.042, head_radius=0.021)
_EDGE = RodShape(radius=0.0035)
_PLUMB = RodShape(radius=0.0018)
_STANDS = 0.12  # [m]; height of the centre of mass of the article's robot as it walks
_LAKE = 12.0  # [m]; how far the water reaches that is drawn
_STEPS = 400  # maximum number of stored points of the track


def rgb(colour: str) -> tuple[int, int, int]:
    """Return a colour written as #rrggbb."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def camera(robot: Robot) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return where the camera is at first and where it looks, to have a robot in view [m]."""
    (a, b, c), (x, y, z), scale = CAMERA, LOOKS_AT, size_relative_to_article(robot).length
    return (scale * a, scale * b, scale * c), (scale * x, scale * y, scale * z)


def light(scene: Any) -> None:
    """Light a scene by the sky and one sun, so that colours come out as they are meant."""
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_hemisphere("/sky", sky_color=(255, 255, 255), ground_color=(190, 180, 165), intensity=1.7)
    scene.add_light_directional(
        "/sun", color=(255, 250, 240), intensity=2.0, position=(1.2, -0.9, 2.4), cast_shadow=True
    )


class WalkScene:
    """Everything that is seen in one browser.

    Args:
        scene: viser's scene of that browser.
        robot: robot that walks.
    """

    def __init__(self, scene: Any, robot: Robot) -> None:
        self._scene, self._size = scene, size_relative_to_article(robot).length
        weight = robot.mass * GRAVITY
        self._per_newton, self._load_threshold = self._size * _WEIGHT_LENGTH / weight, LOADED_SHARE * weight
        robot_layout = layout(robot)
        self._radii = np.array([limb.girdle.limb.foot.radius for limb in robot_layout.limbs])
        self._front = front_segment(robot)
        light(scene)
        self._world = scene.add_frame(WORLD, show_axes=False)
        self.robot = DrawnRobot(scene, f"{WORLD}/robot", robot)
        self.ghost: DrawnRobot | None = None
        self._relief: Any = None
        self._grid: Any = None
        self.set_relief(None)
        self._forces = [self._rod(f"force_{limb}", _ARROW, colour) for limb, colour in limb_colours(robot)]
        self._push = self._rod("push", _PUSH, COLOURS["printed"])
        self._support = [self._rod(f"support_{i}", _EDGE, COLOURS["spine"]) for i in range(len(robot_layout.limbs))]
        self._com = scene.add_icosphere(f"{WORLD}/centre_of_mass", self._size * _COM, color=rgb(COLOURS["tail"]))
        self._plumb = self._rod("plumb", _PLUMB, COLOURS["tail"])
        self._track = scene.add_line_segments(
            f"{WORLD}/track", np.zeros((1, 2, 3)), rgb(COLOURS["neutral"]), thickness=0.004 * self._size, visible=False
        )
        self._water: Any = None
        self._path: list[np.ndarray] = []
        self.visible_overlays = {"forces": True, "support": True, "track": True}

    def _rod(self, name: str, shape: RodShape, colour: str) -> DrawnRod:
        lengths = {field.name: self._size * getattr(shape, field.name) for field in fields(shape)}
        return DrawnRod(self._scene, f"{WORLD}/{name}", RodShape(**lengths), rgb(colour))

    def set_relief(self, relief: Relief | None) -> None:
        """Lay the ground, even or with what stands up from it."""
        for drawn_robot in (self.robot, self.ghost):
            if drawn_robot is not None:
                drawn_robot.relief = relief
        for handle in (self._relief, self._grid):
            if handle is not None:
                handle.remove()
        model = compile_model(self.robot.posture.robot, relief=relief)
        decade = 10.0 ** round(log10(self._size))
        self._grid = self._scene.add_grid(
            f"{WORLD}/grid",
            infinite_grid=True,
            cell_size=0.1 * decade,
            section_size=0.5 * decade,
            cell_color=(205, 200, 190),
            section_color=(165, 158, 146),
            plane_color=(236, 232, 224),
            plane_opacity=1.0,
            fade_distance=9.0 * self._size,
            shadow_opacity=0.3,
            position=(0.0, 0.0, float(model.geom("ground").pos[2])),
        )
        self._relief = None
        if relief is not None:
            geom = model.geom("relief")
            mesh = create_primitive_mesh(model, geom.id)
            self._relief = self._scene.add_mesh_simple(
                f"{WORLD}/relief",
                np.asarray(mesh.vertices),
                np.asarray(mesh.faces),
                color=(214, 205, 186),
                side="double",
                position=np.array(geom.pos),
            )

    def compare(self, robot: Robot) -> None:
        """Add a ghost for comparison."""
        self.ghost = DrawnRobot(self._scene, f"{WORLD}/ghost", robot, ghost=True)
        self.ghost.relief = self.robot.relief

    def show_geometry(self, geometry: BodyGeometry) -> None:
        """Show skins or collision geoms."""
        for drawn_robot in (self.robot, self.ghost):
            if drawn_robot is not None:
                drawn_robot.show_geometry(geometry)

    def set_pose(self, state: Mapping[str, np.ndarray], tilt: tuple[float, float], *, follow: bool) -> None:
        """Turn the world by its slope, and move it so that a camera that follows keeps the robot in view.

        In water it follows up and down too, from the height of the centre of mass of a robot that stands.

        Args:
            state: the instant, by the names of ``record.VARIABLES``.
            tilt: slopes of the ground, uphill and left side up [rad].
            follow: whether the camera follows.
        """
        orientation = slope(*tilt)
        self._world.wxyz = orientation
        x, y, z = state["centre_of_mass"]
        height = 0.0 if self._water is None or not self._water.visible else max(float(z) - self._size * _STANDS, 0.0)
        centre = np.array([x, y, height]) if follow else np.zeros(3)
        self._world.position = -rotate(orientation, centre)

    def show(self, state: Mapping[str, np.ndarray], push_force: tuple[float, float, float] | None = None) -> None:
        """Show an instant, by the names of ``record.VARIABLES``, and a push that lasts."""
        self.robot.show(state)
        feet, forces, com = state["foot_position"], state["foot_force"], state["centre_of_mass"]
        ground = feet - np.array([0.0, 0.0, 1.0]) * self._radii[:, None]
        loaded = forces[:, 2] > self._load_threshold
        for arrow, foot, force, stands in zip(self._forces, ground, forces, loaded, strict=True):
            if self.visible_overlays["forces"] and stands:
                arrow.set_ends(foot, foot + self._per_newton * force)
            else:
                arrow.hide()
        if push_force is None:
            self._push.hide()
        else:
            tip = self.robot.posture.body(self._front)[0] + np.array([0.0, 0.0, self._size * _TIP])
            self._push.set_ends(tip - self._per_newton * np.array(push_force), tip)
        self._draw_support(ground, loaded, com)

    def flood(self, level: float | None) -> None:
        """Draw the surface of the water, level where the ground slopes.

        Args:
            level: above the world's origin, against gravity [m]; None on dry land.
        """
        if level is None:
            if self._water is not None:
                self._water.visible = False
            return
        if self._water is None:
            self._water = self._scene.add_box(
                "/water", dimensions=(_LAKE, _LAKE, 0.001), color=rgb(COLOURS["water"]), opacity=0.35
            )
        self._water.visible = True
        self._water.position = np.array([0.0, 0.0, level + float(np.asarray(self._world.position)[2])])

    def _draw_support(self, feet: np.ndarray, loaded: np.ndarray, com: np.ndarray) -> None:
        """Draw the support polygon, the projected centre of mass and the plumb line between.

        Args:
            feet: points of the feet on the ground, (limb, 3) [m].
            loaded: which feet carry load, (limb,).
            com: centre of mass, (3,) [m].
        """
        paint_height = self._size * _PAINT_HEIGHT
        corners = support(feet, loaded) + np.array([0.0, 0.0, paint_height])
        floor = float(feet[loaded, 2].mean()) if loaded.any() else 0.0
        ground_point = np.array([com[0], com[1], floor + paint_height])
        sides = len(corners) if len(corners) > 2 else len(corners) - 1
        for i, edge in enumerate(self._support):
            if self.visible_overlays["support"] and i < sides:
                edge.set_ends(corners[i], corners[(i + 1) % len(corners)])
            else:
                edge.hide()
        self._com.visible = bool(self.visible_overlays["support"])
        self._com.position = ground_point
        if self.visible_overlays["support"]:
            self._plumb.set_ends(ground_point, com)
        else:
            self._plumb.hide()

    def extend_track(self, com: np.ndarray) -> None:
        """Lengthen the track on the ground to where the centre of mass is now."""
        track_point = np.array([com[0], com[1], 0.0])
        if self._path and np.linalg.norm(track_point - self._path[-1]) < self._size * _STEP:
            return
        self._path = [*self._path, track_point][-_STEPS:]
        self.draw_track(np.array(self._path))

    def draw_track(self, path: np.ndarray) -> None:
        """Draw a track on the ground, (point, 3) [m], at whatever height its points are."""
        self._track.visible = bool(self.visible_overlays["track"] and len(path) > 1)
        if len(path) > 1:
            level = heights(self.robot.relief, path[:, 0], path[:, 1]) + self._size * _PAINT_HEIGHT
            path = np.column_stack([path[:, :2], level])
            self._track.points = np.stack([path[:-1], path[1:]], axis=1).astype(np.float32)

    def forget(self) -> None:
        """Forget the track."""
        self._path = []
        self._track.visible = False

    def mark(self, faults: Sequence[Fault]) -> None:
        """Mark the joints and legs that are broken."""
        self.robot.mark(faults)
