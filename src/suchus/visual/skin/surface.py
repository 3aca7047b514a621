"""The whole skin: its parts, how each vertex hangs on the bones, and how it bends."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.rotation import rotate
from suchus.robot.design import MEASURED, Layout, Robot, lacking, layout
from suchus.visual.skin.body import body, shape
from suchus.visual.skin.bones import bone_names, bone_rest
from suchus.visual.skin.head import eyes, jaw, teeth
from suchus.visual.skin.legs import left_leg
from suchus.visual.skin.look import SKIN, Proportions
from suchus.visual.skin.mesh import Mesh, join_meshes, normals
from suchus.visual.skin.paint import smooth
from suchus.visual.skin.plain import axis_mesh, ends, limb_meshes
from suchus.visual.skin.plain import eyes as plain_eyes
from suchus.visual.skin.scutes import left_scutes, middle_scutes

_HANGS = 4  # bones that a vertex may hang on; two are used, viewers expect four


@dataclass(frozen=True, slots=True)
class Skin:
    """The surface of a body and how it follows the bones; the arrays are not to be written to."""

    vertices: np.ndarray
    """Positions at zero posture in the frame of the pelvis, (n, 3) [m]."""
    normals: np.ndarray
    """Unit normals, outward, (n, 3) [-]."""
    faces: np.ndarray
    """Places of three vertices, counterclockwise as seen from outside, (m, 3) int32."""
    colours: np.ndarray
    """Red, green, blue of each vertex, (n, 3) uint8."""
    part_index: np.ndarray
    """Number of the closed part to which each vertex belongs, (n,) int32."""
    bones: tuple[str, ...]
    """Names of the bones, which are bodies of the model."""
    rest_origins: np.ndarray
    """Origins of the bones at zero posture in the frame of the pelvis, (bone, 3) [m]; all are parallel to it."""
    indices: np.ndarray
    """Bones that each vertex hangs on, (n, 4) int32."""
    weights: np.ndarray
    """Weights of these bones, (n, 4) [-]; each row sums to one."""
    plain: bool
    """Whether the skin is a plain hide with rods for limbs and balls for feet, not a crocodile's."""

    def posed(self, positions: np.ndarray, quaternions: np.ndarray) -> np.ndarray:
        """Return the vertices in a posture, (n, 3) [m], by linear blend skinning.

        Args:
            positions: origins of the bones in the world, (bone, 3) [m].
            quaternions: orientations of the bones, (bone, 4), unit quaternions wxyz.

        Raises:
            InvalidDesign: the number of poses is not the number of bones.
        """
        count = len(self.bones)
        if positions.shape != (count, 3) or quaternions.shape != (count, 4):
            raise InvalidDesign(
                f"poses of shape {positions.shape} and {quaternions.shape} were given; this skin has {count} bones: "
                f"give ({count}, 3) positions and ({count}, 4) quaternions."
            )
        posed_vertices = np.zeros_like(self.vertices)
        for i in range(_HANGS):
            if not self.weights[:, i].any():
                continue
            bone = self.indices[:, i]
            arm = self.vertices - self.rest_origins[bone]
            posed_vertices += self.weights[:, i, None] * (positions[bone] + rotate(quaternions[bone], arm))
        return posed_vertices


@lru_cache(maxsize=16)
def skin(robot: Robot) -> Skin:
    """Return the skin of a robot; the same robot gives the same skin again.

    Args:
        robot: any robot; one with the chains of ``design.MEASURED`` is a crocodile, any other a plain hide with
            rods for limbs.
    """
    plain = bool(lacking(robot, MEASURED))
    parts = _plain(layout(robot)) if plain else _crocodile(robot, SKIN)
    hung = [_attach(robot, mesh.vertices, attachment) for mesh, attachment in parts]
    full_mesh = join_meshes([mesh for mesh, _ in parts])
    surface = Skin(
        vertices=full_mesh.vertices,
        normals=normals(full_mesh),
        faces=full_mesh.faces,
        colours=np.round(255 * np.clip(full_mesh.colours, 0.0, 1.0)).astype(np.uint8),
        part_index=np.repeat(np.arange(len(parts), dtype=np.int32), [len(mesh.vertices) for mesh, _ in parts]),
        bones=bone_names(robot),
        rest_origins=bone_rest(robot),
        indices=np.concatenate([indices for indices, _ in hung]),
        weights=np.concatenate([weights for _, weights in hung]),
        plain=plain,
    )
    for array in (
        surface.vertices,
        surface.normals,
        surface.faces,
        surface.colours,
        surface.part_index,
        surface.rest_origins,
        surface.indices,
        surface.weights,
    ):
        array.flags.writeable = False
    return surface


def _crocodile(robot: Robot, proportions: Proportions) -> list[tuple[Mesh, str | int]]:
    """Return the parts of a crocodile, each with the limb that it hangs on, or nothing for the axis."""
    limbs = [(mesh, girdle) for girdle in "FH" for mesh in left_leg(robot, girdle)]
    parts: list[tuple[Mesh, str | int]] = [(mesh, "") for mesh in _axial(robot, proportions)]
    return parts + [(m.mirrored() if side == "R" else m, side + girdle) for m, girdle in limbs for side in "LR"]


def _plain(robot_layout: Layout) -> list[tuple[Mesh, str | int]]:
    """Return the parts of any body, each with the bone that it hangs on, or nothing for the axis."""
    parts: list[tuple[Mesh, str | int]] = [(axis_mesh(robot_layout), "")]
    parts += [(mesh, "") for mesh in plain_eyes(robot_layout)]
    return parts + [limb_mesh for limb in robot_layout.limbs for limb_mesh in limb_meshes(robot_layout, limb)]


def _attach(robot: Robot, vertices: np.ndarray, attachment: str | int) -> tuple[np.ndarray, np.ndarray]:
    """Return the bones on which vertices hang, (n, 4), and their weights, (n, 4).

    Args:
        robot: the robot.
        vertices: vertices at zero posture, (n, 3) [m].
        attachment: number of a bone, name of a leg, or empty for the axis.
    """
    if isinstance(attachment, int):
        indices, weights = (
            np.full((len(vertices), _HANGS), attachment, dtype=np.int32),
            np.zeros((len(vertices), _HANGS)),
        )
        weights[:, 0] = 1.0
        return indices, weights
    return _on_leg(robot, vertices, attachment) if attachment else _on_axis(robot, vertices)


def _axial(robot: Robot, proportions: Proportions) -> list[Mesh]:
    """Return the parts of head, trunk and tail."""
    outline = shape(robot, proportions)
    left_meshes = [*eyes(robot, proportions), *teeth(robot, proportions), *left_scutes(robot, outline, proportions)]
    paired_meshes = [side for mesh in left_meshes for side in (mesh, mesh.mirrored())]
    return [body(robot, proportions), jaw(robot, proportions), *middle_scutes(robot, outline), *paired_meshes]


def _on_axis(robot: Robot, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return bones and weights of vertices on the axis, by their place along the straight body."""
    robot_layout, origins = layout(robot), bone_rest(robot)
    names = [body.name for body in robot_layout.bodies]
    order = [names.index(name) for name in (*reversed(robot_layout.tail), *robot_layout.trunk)]
    # a segment behind the root ends at its own joint, one ahead of it begins there
    tail_count = len(robot_layout.tail)
    joints = [float(origins[bone, 0]) for i, bone in enumerate(order) if i != tail_count]
    front, back = ends(robot_layout)
    return _blended(vertices[:, 0], joints, np.diff([back, *joints, front]), order)


def _on_leg(robot: Robot, vertices: np.ndarray, leg: str) -> tuple[np.ndarray, np.ndarray]:
    """Return bones and weights of vertices on a leg, by their distance from the midline."""
    names, links = bone_names(robot), robot.leg(leg)
    order = [names.index("thorax" if leg.endswith("F") else "pelvis"), names.index(f"{leg}_femur")]
    order.append(names.index(f"{leg}_tibia"))
    joints = [links.hip_offset, links.hip_offset + links.femur]
    lengths = np.array([links.hip_offset, links.femur, links.tibia])
    return _blended(np.abs(vertices[:, 1]), joints, np.minimum(lengths, 4.2 * links.radius), order)


def _blended(
    distances: np.ndarray, joints: list[float], lengths: np.ndarray, order: list[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Return bones and weights of vertices along a chain of bones.

    A vertex at a joint hangs half on either bone; half a segment away from the joint it hangs on one bone alone.

    Args:
        distances: distances of the vertices along the chain, (n,) [m].
        joints: places of the joints along the chain, increasing [m].
        lengths: lengths of the segments, one more than joints [m].
        order: numbers of the bones along the chain.
    """
    fractions = np.ones((len(distances), len(order)))
    for i, (joint, (previous_length, next_length)) in enumerate(zip(joints, pairwise(lengths), strict=True)):
        half = 0.5 * min(previous_length, next_length)
        next_fraction = smooth(distances, joint - half, joint + half)
        fractions[:, : i + 1] *= 1 - next_fraction[:, None]
        fractions[:, i + 1 :] *= next_fraction[:, None]
    bone_order = np.argsort(-fractions, axis=1, kind="stable")[:, :_HANGS]
    if bone_order.shape[1] < _HANGS:
        bone_order = np.pad(bone_order, ((0, 0), (0, _HANGS - bone_order.shape[1])))
    weights = np.take_along_axis(fractions, bone_order, axis=1)
    weights[:, len(order) :] = 0.0
    return np.array(order, dtype=np.int32)[bone_order], weights / weights.sum(axis=1, keepdims=True)
