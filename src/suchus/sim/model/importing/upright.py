"""Which axis of a file points up, and the tree turned so that it is z.

Modelling tools and games have y or x up; a URDF does not say it. The feet say it: limbs with equally many hinges end at
one height.
"""

from collections import Counter
from dataclasses import replace

import numpy as np

from suchus.core.errors import UnreadableFile
from suchus.sim.model.importing.tree import ShapePiece, Tree, TreePart

UP_AXES = ("z", "y", "x", "-z", "-y", "-x")
"""Axes of a file that may point up."""
_LEVEL_TOLERANCE = 0.1  # of the size; feet whose heights differ by less are level
_MIN_DEPTH = 0.3  # of the size; how far two feet alone must hang below the root to say which axis is up
_MIN_LEGS, _OVERHEAD = 4, 0.1  # feet, and their height above the root [size], from which on z points down
_SIDE_TOLERANCE = 0.02  # of the size; feet that lie less to one side of the root do not say the sense of up
_MAX_SLOPE_COSINE = 0.8  # of the angle between gravity and an axis
_CHAIN_RATIO = 3.0  # height of a chain over its length, above which it stands
_AXES = {"x": np.array([1.0, 0.0, 0.0]), "y": np.array([0.0, 1.0, 0.0]), "z": np.array([0.0, 0.0, 1.0])}
_REFERENCES = {"x": "y", "y": "x", "z": "x"}
"""The horizontal axis from which headings count, by the axis that is up."""


def upright(tree: Tree, up: str | None, gravity: tuple[float, float, float] | None) -> Tree:
    """Return the tree turned so that z is up, with a remark where it had to be turned.

    The axis is that of the option, else that of the file's gravity, else the one along which the feet are level.

    Args:
        tree: tree of the file.
        up: the axis of the file that points up, see ``UP_AXES``; None: find it.
        gravity: gravity of the file [m/s2]; None where it states none.

    Raises:
        UnreadableFile: gravity lies along none of the axes, or nothing says which axis is up.
    """
    if up is not None:
        if up not in UP_AXES:
            raise UnreadableFile(f"--up {up[:20]!r} is no axis; {', '.join(UP_AXES)} are allowed.")
        return _turned(tree, up, f"Up: the file's {up} axis, as asked (--up).") if up != "z" else tree
    by_gravity = None if gravity is None else _up_by_gravity(np.array(gravity))
    if by_gravity is not None:
        if by_gravity == "z":
            return tree
        return _turned(tree, by_gravity, f"Up: the file's {by_gravity} axis, against its gravity; the draft has z up.")
    if _is_vertical_chain(tree):
        raise UnreadableFile(
            "its hinges follow each other along z, which points up: an axis lies from front to rear. If it is a snake "
            "that is drawn standing, say which axis points up instead, --up x or --up y; an arm on a base is no robot "
            "that suchus takes."
        )
    by_feet = _up_by_feet(tree)
    if by_feet == "z":
        return tree
    reason = (
        "all of its feet lie above its root along z"
        if by_feet == "-z"
        else "its feet are level along it and not along z"
    )
    return _turned(
        tree,
        by_feet,
        f"Guess: up is the file's {by_feet} axis, since {reason}; the draft has z up. If that is wrong, say --up z.",
    )


def _up_by_gravity(gravity: np.ndarray) -> str | None:
    """Return the axis against gravity, a slope allowed; None where there is no gravity.

    Raises:
        UnreadableFile: gravity lies along none of the axes.
    """
    strength = float(np.linalg.norm(gravity))
    if strength == 0.0:
        return None
    axis = ("x", "y", "z")[int(np.argmax(np.abs(gravity)))]
    downward = float(gravity @ _AXES[axis])
    if abs(downward) < _MAX_SLOPE_COSINE * strength:
        raise UnreadableFile(
            f"its gravity is ({', '.join(f'{value:g}' for value in gravity)}) m/s2, along none of its axes; an upright "
            "robot is needed: turn it, or say which axis of the file points up, as --up z."
        )
    return axis if downward < 0 else f"-{axis}"


def _is_vertical_chain(tree: Tree) -> bool:
    """Return whether the parts follow each other along z without a branch, as an eel that is drawn standing."""
    if any(len(tree.children(i)) > (2 if i == 0 else 1) for i in range(len(tree.parts))):
        return False
    anchors = np.array([joint.anchor for tree_part in tree.parts for joint in tree_part.joints])
    extent = np.ptp(anchors, axis=0)
    return bool(extent[2] > _CHAIN_RATIO * max(float(extent[0]), float(extent[1]), 1e-9))


def _up_by_feet(tree: Tree) -> str:
    """Return z where the feet are level along it or say nothing, else the axis along which they are."""
    feet = _feet(tree)
    if len(feet) < 2:
        return "z"
    offsets = feet - tree.parts[0].com
    spreads = {axis: float(np.ptp(offsets @ direction)) / tree.size for axis, direction in _AXES.items()}
    if spreads["z"] <= _LEVEL_TOLERANCE:
        min_height = float(np.min(offsets @ _AXES["z"]))
        return "-z" if len(feet) >= _MIN_LEGS and min_height > _OVERHEAD * tree.size else "z"
    axis = min(("y", "x"), key=lambda candidate: (spreads[candidate] > _LEVEL_TOLERANCE, -_depth(offsets, candidate)))
    min_depth = _MIN_DEPTH * tree.size if len(feet) == 2 else 0.0
    if spreads[axis] > _LEVEL_TOLERANCE or _depth(offsets, axis) < min_depth:
        return "z"
    height = float(np.mean(offsets @ _AXES[axis]))
    return f"-{axis}" if height > _SIDE_TOLERANCE * tree.size else axis


def _depth(offsets: np.ndarray, axis: str) -> float:
    """Return how far the feet lie to one side of the root along an axis [m]."""
    return abs(float(np.mean(offsets @ _AXES[axis])))


def _feet(tree: Tree) -> np.ndarray:
    """Return the ends of the limbs, shape (limb, 3) [m]: of branches with the hinge count that most of them have."""
    leaves = [i for i in range(1, len(tree.parts)) if not tree.children(i)]
    hinge_counts = {i: sum(len(tree.parts[k].joints) for k in _ancestors_below_root(tree, i)) for i in leaves}
    counts = Counter(hinge_counts.values())
    if not counts:
        return np.zeros((0, 3))
    common_count = max(counts, key=lambda count: (counts[count], count))
    return np.array([_end(tree.parts[i]) for i in leaves if hinge_counts[i] == common_count])


def _ancestors_below_root(tree: Tree, index: int) -> list[int]:
    """Return the parts from part ``index`` up to the root: ``index`` first, the root left out."""
    path = []
    while index > 0:
        path.append(index)
        index = tree.parts[index].parent
    return path


def _end(tree_part: TreePart) -> np.ndarray:
    """Return the point of a part that is farthest from its hinge, of its shapes and frames [m]."""
    anchor = tree_part.joints[-1].anchor
    ends = np.concatenate([tree_part.points, tree_part.com[None], *(piece.ends for piece in tree_part.pieces)])
    return np.asarray(ends[np.argmax(np.linalg.norm(ends - anchor, axis=1))])


def _turned(tree: Tree, up: str, remark: str) -> Tree:
    """Return a tree whose axis ``up`` is turned to z and its reference axis to x.

    Args:
        tree: tree of the file.
        up: see ``UP_AXES``.
        remark: to add.
    """
    axis = up.removeprefix("-")
    reference = _REFERENCES[axis]
    upward = -_AXES[axis] if up.startswith("-") else _AXES[axis]
    forward = _AXES[reference]
    matrix = np.array([forward, np.cross(upward, forward), upward])
    parts = tuple(
        replace(
            tree_part,
            joints=tuple(
                replace(joint, axis=matrix @ joint.axis, anchor=matrix @ joint.anchor) for joint in tree_part.joints
            ),
            com=matrix @ tree_part.com,
            tensor=matrix @ tree_part.tensor @ matrix.T,
            origin=matrix @ tree_part.origin,
            pieces=tuple(
                ShapePiece(ends=piece.ends @ matrix.T, half=np.abs(matrix) @ piece.half) for piece in tree_part.pieces
            ),
            points=tree_part.points @ matrix.T,
            centres=tree_part.centres @ matrix.T,
        )
        for tree_part in tree.parts
    )
    return replace(tree, parts=parts, remarks=(*tree.remarks, remark), reference_axis=reference)
