"""A robot in a browser's scene, its skin or its collision geoms, and a filmed animal beside it, moved in time."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from mjviser.conversions import create_primitive_mesh

from suchus.apps.viewer.bodies import BodyPoses, pieces
from suchus.apps.viewer.replay import FilmedAnimal
from suchus.robot.design import Robot
from suchus.robot.design.ground import Relief
from suchus.robot.robots import size_relative_to_article
from suchus.sim.fault import Fault

BodyGeometry = Literal["skin", "collision geoms"]
_MARK_RADIUS, _LABEL_HEIGHT = (
    0.026,
    0.035,
)  # [m]; radius of a mark on the article's robot, and how far above it its word is
LIMP, LOCKED = (225, 60, 45), (40, 40, 45)
"""Colours of the marks on joints that have failed."""
GHOST = (120, 140, 200)
"""Colour of a robot that is there for comparison."""


class DrawnRobot:
    """A robot in the scene of one browser.

    Args:
        scene: viser's scene of that browser.
        root: the node under which it stands.
        robot: the robot.
        ghost: whether it is there for comparison: pale, one colour.
    """

    def __init__(self, scene: Any, root: str, robot: Robot, *, ghost: bool = False) -> None:
        self._scene, self._root, self._ghost = scene, root, ghost
        self.posture = BodyPoses(robot)
        self.relief: Relief | None = None
        self._marks: dict[str, Any] = {}
        self._size = size_relative_to_article(robot).length
        self._failed: tuple[Fault, ...] = ()
        self._geometry: BodyGeometry = "skin"
        self._geoms: dict[int, Any] = {}
        skin_pieces = pieces(robot, 1) if ghost else pieces(robot)
        self._skin = [(piece, self._piece(i, piece)) for i, piece in enumerate(skin_pieces)]

    def _geom(self, number: int) -> Any:
        """Add a collision geom of the robot to the scene and return its handle."""
        mesh = create_primitive_mesh(self.posture.model, number)
        colour = tuple(int(255 * component) for component in self.posture.model.geom_rgba[number][:3])
        return self._scene.add_mesh_simple(
            f"{self._root}/geom_{number}",
            np.asarray(mesh.vertices),
            np.asarray(mesh.faces),
            color=GHOST if self._ghost else colour,
            opacity=0.35 if self._ghost else None,
            receive_shadow=False,  # of itself: the scutes would drown in it
        )

    def _piece(self, number: int, piece: Any) -> Any:
        """Add a piece of the skin to the scene and return its handle."""
        identity = np.tile([1.0, 0.0, 0.0, 0.0], (len(piece.bones), 1))
        return self._scene.add_mesh_skinned(
            f"{self._root}/skin_{number}",
            piece.vertices,
            piece.faces,
            bone_wxyzs=identity,
            bone_positions=piece.rest_origins,
            skin_weights=piece.weights,
            color=GHOST if self._ghost else piece.colour,
            opacity=0.35 if self._ghost else None,
            receive_shadow=False,  # of itself: the scutes would drown in it
        )

    def show_geometry(self, geometry: BodyGeometry) -> None:
        """Show the skin or the collision geoms."""
        if geometry != "skin" and not self._geoms:
            self._geoms = {number: self._geom(number) for number in self.posture.geoms()}
        self._geometry = geometry
        for handle in self._geoms.values():
            handle.visible = geometry != "skin"
        for _, handle in self._skin:
            handle.visible = geometry == "skin"

    def show(self, state: Mapping[str, np.ndarray]) -> None:
        """Move to an instant, by the names of ``record.VARIABLES``."""
        self.posture.set_state(state)
        if self._geometry == "skin":
            bones = self.posture.bones(self.relief)
            for piece, handle in self._skin:
                for bone, name in zip(handle.bones, piece.bones, strict=True):
                    bone.position, bone.wxyz = bones[name]
        else:
            for number, handle in self._geoms.items():
                handle.position, handle.wxyz = self.posture.geom(number)
        for joint, (ball, label) in self._marks.items():
            ball.position = self.posture.part_position(joint)
            label.position = ball.position + np.array([0.0, 0.0, self._size * _LABEL_HEIGHT])

    def mark(self, faults: Sequence[Fault]) -> None:
        """Mark the joints and legs that are broken, each with how."""
        if tuple(faults) == self._failed:
            return
        self._failed = tuple(faults)
        for handles in self._marks.values():
            for handle in handles:
                handle.remove()
        self._marks = {fault.part: self._mark(fault) for fault in faults if fault.acts_on != "sensor"}

    def _mark(self, fault: Fault) -> tuple[Any, Any]:
        """Add a ball and a label at the joint or foot that a fault breaks, and return both handles."""
        joint, kind = fault.part, fault.kind()
        position = self.posture.part_position(joint)
        ball = self._scene.add_icosphere(
            f"{self._root}/failed_{joint}",
            self._size * _MARK_RADIUS,
            color=LIMP if kind == "limp" else LOCKED,
            position=position,
            opacity=0.85,
        )
        text = f"{joint} {kind}".replace("_", " ")
        label = self._scene.add_label(f"{self._root}/word_{joint}", text, position=position, anchor="bottom-center")
        return ball, label


_LINE_THICKNESS, _FOOT_RADIUS = 0.008, 0.012
"""Thickness of the lines and radius of the feet, over the animal's length [-]."""


class DrawnAnimal:
    """Lines and balls in the scene of one browser.

    Args:
        scene: viser's scene of that browser.
        root: the node under which it stands.
        animal: the animal.
    """

    def __init__(self, scene: Any, root: str, animal: FilmedAnimal) -> None:
        self._animal = animal
        self._lines = scene.add_line_segments(
            f"{root}/lines", np.zeros((len(animal.bones), 2, 3)), GHOST, thickness=_LINE_THICKNESS * animal.size
        )
        self._feet = [
            scene.add_icosphere(f"{root}/foot_{i}", _FOOT_RADIUS * animal.size, color=GHOST)
            for i in range(len(animal.feet))
        ]

    def show(self, time: float) -> None:
        """Move to a time of the record [s]."""
        positions = self._animal.keypoints_at(time)
        self._lines.points = positions[np.array(self._animal.bones)].astype(np.float32)
        for ball, foot in zip(self._feet, self._animal.feet, strict=True):
            ball.position = positions[foot]
