"""The tree of stiff parts and hinges of a loaded model, all joints at zero, in the frame of its file.

Its shapes are those that suchus has: rods with round ends and ellipsoids.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from typing import Any

import mujoco
import numpy as np

from suchus.core.checks import require
from suchus.core.errors import UnreadableFile
from suchus.robot.design.segment import combine_inertias
from suchus.sim.model.export.urdf import MUJOCO
from suchus.sim.model.importing.cleaning import Drive
from suchus.sim.model.importing.loading import Loaded

_CAP_TOLERANCE = 1e-6  # of a rod's size; a ball so near to its end is its round end


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapePiece:
    """A rod, or an ellipsoid whose half axes are those of the frame; a ball has equal ones."""

    ends: np.ndarray
    """Middles of a rod's ends, shape (2, 3), or the centre of an ellipsoid, shape (1, 3) [m]."""
    half: np.ndarray
    """Radius of a rod three times, or half length, width and height, shape (3,) [m]."""

    @property
    def ball(self) -> bool:
        """Whether it is a ball."""
        return len(self.ends) == 1 and bool(np.ptp(self.half) <= 1e-9 * self.half.max())

    @property
    def centre(self) -> np.ndarray:
        """Its middle, shape (3,) [m]."""
        return np.asarray(self.ends.mean(axis=0))

    @property
    def volume(self) -> float:
        """[m3]."""
        round_ends = 4.0 / 3.0 * pi * float(np.prod(self.half))
        length = float(np.linalg.norm(self.ends[-1] - self.ends[0]))
        return round_ends + pi * float(self.half[0]) ** 2 * length

    @property
    def corners(self) -> np.ndarray:
        """Corners of the boxes around its ends, shape (n, 3) [m]."""
        signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
        return np.concatenate([end + signs * self.half for end in self.ends])


def of_body(model: Any, data: Any, body: int) -> tuple[ShapePiece, ...]:
    """Return the shapes of a body, those that touch others if there are any; a rod's round ends are its own."""
    first_geom, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
    geoms = list(range(first_geom, first_geom + count))
    touching = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
    kinds = mujoco.mjtGeom
    plain = (int(kinds.mjGEOM_PLANE), int(kinds.mjGEOM_HFIELD))
    solid_geoms = [g for g in touching or geoms if model.geom_type[g] not in plain]
    pieces = [_piece(model, data, g) for g in solid_geoms]
    rods = [
        _cylinder_as_rod(piece, pieces) if model.geom_type[g] == int(kinds.mjGEOM_CYLINDER) else piece
        for g, piece in zip(solid_geoms, pieces, strict=True)
        if len(piece.ends) == 2
    ]
    return (*rods, *(piece for piece in pieces if len(piece.ends) == 1 and not _is_cap(piece, rods)))


def _piece(model: Any, data: Any, geom: int) -> ShapePiece:
    """Return a geom as a rod or an ellipsoid; other kinds become the ellipsoid of their bounding box."""
    position, turn = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
    size, kind = model.geom_size[geom], mujoco.mjtGeom(int(model.geom_type[geom]))
    kinds = mujoco.mjtGeom
    if kind in (kinds.mjGEOM_CAPSULE, kinds.mjGEOM_CYLINDER) and size[1] > size[0]:
        half_axis = size[1] * turn[:, 2]
        return ShapePiece(ends=np.array([position - half_axis, position + half_axis]), half=np.full(3, size[0]))
    if kind == kinds.mjGEOM_SPHERE:
        return ShapePiece(ends=position[None].copy(), half=np.full(3, size[0]))
    if kind == kinds.mjGEOM_ELLIPSOID:
        return ShapePiece(ends=position[None].copy(), half=np.sqrt((turn * size) ** 2 @ np.ones(3)))
    box_centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
    return ShapePiece(ends=(position + turn @ box_centre)[None], half=np.maximum(np.abs(turn) @ half, 1e-5))


def _cylinder_as_rod(cylinder: ShapePiece, pieces: list[ShapePiece]) -> ShapePiece:
    """Return a cylinder as a rod whose round ends stay inside it; one that ends in balls is a rod already.

    Args:
        cylinder: the cylinder.
        pieces: all pieces of the body; balls among them may already be the round ends.
    """
    if sum(_is_cap(piece, [cylinder]) for piece in pieces) >= 2:
        return cylinder
    first_end, last_end = cylinder.ends
    length = float(np.linalg.norm(last_end - first_end))
    inward = (last_end - first_end) * min(cylinder.half[0] / length, 0.45)
    return ShapePiece(ends=np.array([first_end + inward, last_end - inward]), half=cylinder.half)


def _is_cap(ball: ShapePiece, rods: list[ShapePiece]) -> bool:
    """Return whether a ball is the round end of a rod."""
    return ball.ball and any(
        bool(ball.half[0] <= rod.half[0] * (1 + 1e-9))
        and bool(np.linalg.norm(rod.ends - ball.centre, axis=1).min() <= _CAP_TOLERANCE * max(rod.half[0], 1e-9))
        for rod in rods
    )


MIN_MASS = 1e-9
"""Masses up to this are none: MuJoCo was asked to fill missing ones with a tenth of it [kg]."""
_MAX_SIZE = 100.0  # [m]
_MIN_INERTIA = 1.001 * float(MUJOCO["boundinertia"])  # moments up to this are none
JOINED = 1e-6
"""Hinges nearer than this share of a robot's size sit in one point [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Joint:
    """A hinge as its file has it."""

    name: str
    """Name in the file."""
    axis: np.ndarray
    """Unit vector about which the child turns, shape (3,) [-]."""
    anchor: np.ndarray
    """A point of the axis, shape (3,) [m]."""
    zero: float
    """What the file calls the angle of the posture in which it is drawn [rad]."""
    range: tuple[float, float] | None
    """Limits from that posture [rad]; None if it turns all round."""
    drive: Drive | None
    """What moves it; None if the file says nothing of drives."""
    stiffness: float
    """[N m/rad]."""
    damping: float
    """[N m s/rad]; 0 where the file has none."""
    friction: float
    """Dry friction [N m]; 0 where the file has none."""
    armature: float
    """Rotor inertia at the hinge [kg m2]; 0 where the file has none."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TreePart:
    """What moves as one: bodies without hinges between them."""

    name: str
    """Name of its first body."""
    parent: int
    """Place of the part that carries it; -1 for the root."""
    joints: tuple[Joint, ...]
    """Between its parent and it, from the parent on."""
    mass: float
    """[kg]."""
    com: np.ndarray
    """Centre of mass, shape (3,) [m]."""
    tensor: np.ndarray
    """Tensor of inertia about the centre of mass, shape (3, 3); nothing but zeros where the file has none [kg m2]."""
    origin: np.ndarray
    """Origin of its first body, shape (3,) [m]."""
    pieces: tuple[ShapePiece, ...]
    """Its shapes."""
    points: np.ndarray
    """Origins of its bodies and sites, shape (n, 3) [m]."""
    names: tuple[str, ...]
    """Names of its bodies."""
    centres: np.ndarray
    """Centre of mass of each of its bodies, shape (body, 3) [m]."""

    @property
    def corners(self) -> np.ndarray:
        """Points between which it lies: its anchors, its points, the corners of its shapes, shape (n, 3) [m]."""
        ends = [np.array([[*joint.anchor] for joint in self.joints]).reshape(-1, 3), self.points]
        return np.concatenate([*ends, *(piece.corners for piece in self.pieces)])


@lru_cache(maxsize=4)
def _extent(tree: "Tree") -> float:
    """Return the size of a tree, which is asked for at every plane and limb."""
    corners = np.concatenate([tree_part.corners for tree_part in tree.parts])
    return float(np.ptp(corners, axis=0).max())


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tree:
    """Parts, a parent before its children."""

    parts: tuple[TreePart, ...]
    """The first one is the root."""
    remarks: tuple[str, ...]
    """Notes on what was not taken over, a sentence each."""
    reference_axis: str = "x"
    """The axis of the file from which headings count: x unless x points up."""

    @property
    def size(self) -> float:
        """Greatest extent along an axis [m]."""
        return _extent(self)

    @property
    def mass(self) -> float:
        """Mass of all parts [kg]."""
        return sum(tree_part.mass for tree_part in self.parts)

    @property
    def com(self) -> np.ndarray:
        """Centre of mass, shape (3,) [m]."""
        return np.sum([tree_part.mass * tree_part.com for tree_part in self.parts], axis=0) / self.mass

    def children(self, index: int) -> list[int]:
        """Return the places of the parts that a part carries."""
        return [i for i, tree_part in enumerate(self.parts) if tree_part.parent == index]

    def subtree(self, index: int) -> list[int]:
        """Return the places of a part and of all that hangs on it, parents first."""
        indices = [index]
        for i in range(index + 1, len(self.parts)):
            if self.parts[i].parent in indices:
                indices.append(i)
        return indices


def tree_of(loaded: Loaded) -> Tree:
    """Return the parts and hinges of what was loaded.

    Raises:
        UnreadableFile: masses are missing or absurd.
    """
    model = loaded.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    root, remarks = _root(model)
    parts: list[TreePart] = []
    part_index: dict[int, int] = {}
    for body in range(root, model.nbody):
        parent_body = int(model.body_parentid[body])
        if body != root and parent_body not in part_index:
            continue
        body_part = _body(model, data, body, loaded, root=body == root)
        if body == root or body_part.joints:
            part_index[body] = len(parts)
            parts.append(replace(body_part, parent=-1 if body == root else part_index[parent_body]))
        else:
            part_index[body] = part_index[parent_body]
            parts[part_index[parent_body]] = _fused(parts[part_index[parent_body]], body_part)
    zeros = [model.body(i).name or f"body {i}" for i in part_index if _has_no_inertia(model, i)]
    if zeros:
        names_text = f"{', '.join(zeros[:4])}{f' and {len(zeros) - 4} more' if len(zeros) > 4 else ''}"
        remarks += (
            f"The inertia of {names_text} is zero in the file, which was taken as not filled in: the draft has that of "
            "the shapes.",
        )
    tree = Tree(parts=tuple(_joined(parts)), remarks=(*loaded.remarks, *remarks))
    return _weighed(tree)


def _root(model: Any) -> tuple[int, tuple[str, ...]]:
    """Return the body of the world that carries most hinges, and what else stands there."""
    hinge = int(mujoco.mjtJoint.mjJNT_HINGE)
    count = np.zeros(model.nbody, dtype=int)
    for joint in range(model.njnt):
        count[model.body_rootid[model.jnt_bodyid[joint]]] += model.jnt_type[joint] == hinge
    count[0] = -1
    root = int(np.argmax(count))
    other_names = [
        model.body(b).name or f"body {b}" for b in range(1, model.nbody) if model.body_parentid[b] == 0 and b != root
    ]
    remarks: list[str] = []
    if other_names:
        remarks.append(f"Beside the robot the file holds {', '.join(other_names[:4])}, which was not taken.")
    root_hinges = [
        model.joint(j).name for j in range(model.njnt) if model.jnt_bodyid[j] == root and model.jnt_type[j] == hinge
    ]
    if root_hinges:
        remarks.append(
            f"{', '.join(root_hinges)} hinges the root to the world and was not taken: in suchus the root is a free "
            "body."
        )
    return root, tuple(remarks)


def _body(model: Any, data: Any, body: int, loaded: Loaded, *, root: bool) -> TreePart:
    """Return a body with its hinges, mass, shapes and sites as a part of the tree."""
    first_joint, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    joints = () if root else tuple(_joint(model, data, j, loaded) for j in range(first_joint, first_joint + count))
    sites = [data.site_xpos[s] for s in range(model.nsite) if model.site_bodyid[s] == body]
    name = model.body(body).name or f"body_{body}"
    turn, weighs = data.ximat[body].reshape(3, 3), bool(model.body_mass[body] > MIN_MASS)
    turns = weighs and not _has_no_inertia(model, body)
    return TreePart(
        name=name,
        parent=-1,
        joints=joints,
        mass=float(model.body_mass[body]) if weighs else 0.0,
        com=data.xipos[body].copy(),
        tensor=turn @ np.diag(model.body_inertia[body]) @ turn.T * turns,
        origin=data.xpos[body].copy(),
        pieces=of_body(model, data, body),
        points=np.array([data.xpos[body], *sites]),
        names=(name,),
        centres=data.xipos[body][None].copy(),
    )


def _has_no_inertia(model: Any, body: int) -> bool:
    """Return whether the moments of a body are those that MuJoCo was asked to fill in for zeros."""
    return bool(model.body_mass[body] > MIN_MASS and model.body_inertia[body].max() <= _MIN_INERTIA)


def _joint(model: Any, data: Any, joint: int, loaded: Loaded) -> Joint:
    """Return a hinge with its axis, anchor, range and drive in the frame of the file."""
    name = model.joint(joint).name or f"joint_{joint}"
    zero = float(model.qpos0[model.jnt_qposadr[joint]])
    lower_limit, upper_limit = model.jnt_range[joint] - zero
    dof = int(model.jnt_dofadr[joint])
    return Joint(
        name=name,
        axis=data.xaxis[joint].copy(),
        anchor=data.xanchor[joint].copy(),
        zero=zero,
        range=(float(lower_limit), float(upper_limit)) if model.jnt_limited[joint] else None,
        drive=loaded.drives.get(name),
        stiffness=float(np.ravel(model.jnt_stiffness[joint])[0]),
        damping=float(np.ravel(model.dof_damping[dof])[0]),
        friction=float(model.dof_frictionloss[dof]),
        armature=float(model.dof_armature[dof]),
    )


def _fused(carrier: TreePart, child: TreePart) -> TreePart:
    """Return two parts that move as one."""
    mass, com, tensor = combine_inertias(
        [(tree_part.mass, tree_part.com, tree_part.tensor) for tree_part in (carrier, child)]
    )
    return replace(
        carrier,
        mass=mass,
        com=com,
        tensor=tensor,
        pieces=carrier.pieces + child.pieces,
        points=np.concatenate([carrier.points, child.points]),
        names=carrier.names + child.names,
        centres=np.concatenate([carrier.centres, child.centres]),
    )


def _joined(parts: list[TreePart]) -> list[TreePart]:
    """Put hinges in one point into one joint: of the parts between them nothing is left but those with mass."""
    size = max(float(np.ptp(np.concatenate([tree_part.corners for tree_part in parts]), axis=0).max()), 1e-9)
    new_indices: dict[int, int] = {}
    joined_parts: list[TreePart] = []
    waiting: dict[int, tuple[int, tuple[Joint, ...]]] = {}
    for index, tree_part in enumerate(parts):
        parent_index, earlier_joints = waiting.get(tree_part.parent, (tree_part.parent, ()))
        joints = earlier_joints + tree_part.joints
        children = [candidate for candidate in parts if candidate.parent == index]
        empty = tree_part.mass == 0.0 and len(children) == 1 and index > 0
        if empty and np.linalg.norm(children[0].joints[0].anchor - joints[-1].anchor) < JOINED * size:
            waiting[index] = (parent_index, joints)
            continue
        new_indices[index] = len(joined_parts)
        joined_parts.append(replace(tree_part, joints=joints, parent=new_indices.get(parent_index, -1)))
    return joined_parts


def _weighed(tree: Tree) -> Tree:
    """Refuse masses that are missing or absurd; a few missing ones become a thousandth of the whole."""
    names = [tree_part.name for tree_part in tree.parts if tree_part.mass == 0.0]
    if tree.mass == 0.0 or 2 * len(names) > len(tree.parts):
        raise UnreadableFile(
            f"{len(names)} of {len(tree.parts)} parts have no mass ({', '.join(names[:4])}): no <inertial> and no "
            "shape that is read, as where there are only meshes; give each an <inertial>."
        )
    if tree.size > _MAX_SIZE:
        raise UnreadableFile(
            f"the robot is {tree.size:.4g} m long or wide; at most {_MAX_SIZE:g} m is allowed: its lengths seem to be "
            "in millimetres, metres are needed; scale positions, shapes and meshes by 0.001."
        )
    require("the imported robot", "mass", tree.mass, 1e-6, 1e5, "kg")
    require("the imported robot", "size", tree.size, 1e-3, _MAX_SIZE, "m")
    if not names:
        return tree
    weighted_parts = tuple(replace(tree_part, mass=tree_part.mass or 1e-3 * tree.mass) for tree_part in tree.parts)
    remarks = f"{', '.join(names[:6])} had no mass; the draft gives each a thousandth of the robot's."
    return Tree(parts=weighted_parts, remarks=(*tree.remarks, remarks))
