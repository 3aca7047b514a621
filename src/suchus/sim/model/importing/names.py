"""What the names of bodies and joints say of directions: front or hind, left or right.

Names are cut into words at underscores, digits and capital letters. Short forms as ``FL``, ``lf``, ``RH`` or
``j_c1_lm`` are read as the files of other tools use them.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from suchus.sim.model.importing.tree import Tree

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_JOINED_CODE = re.compile(r"^(?:F[LR]|R[FLR]|L[FHMR]|H[LR]|B[LR]|[RL]B|RH|RM|M[LR])(?=[a-z_\d]|[A-Z][a-z]|$)")
_FRONT_START, _HIND_START = ("front", "fore", "anterior", "cranial", "rostral"), ("hind", "rear", "posterior", "caudal")
_FRONT_WORDS = frozenset({"head", "snout", "neck", "nose", "jaw", "face", "chest", "thorax", "shoulder", "skull"})
_HIND_WORDS = frozenset({"tail", "pelvis", "abdomen", "sacrum"})
_FIN_WORDS = frozenset(
    {
        "fin",
        "fins",
        "pectoral",
        "pelvic",
        "wing",
        "wings",
        "antenna",
        "antennae",
        "ear",
        "ears",
        "eye",
        "eyes",
        "whisker",
    }
)
_SIDE_WORDS = {"left": 1, "lft": 1, "right": -1, "rgt": -1, "rt": -1, "l": 1, "r": -1}
_OTHER_WORDS = ("upright", "cleft")  # end as a side does
_LETTERS = frozenset("fhbmlr")
_CODES = {
    **dict.fromkeys(("fl", "lf"), (1, 1)), **dict.fromkeys(("fr", "rf"), (1, -1)),
    **dict.fromkeys(("hl", "lh", "rl", "lr", "bl", "lb"), (-1, 1)),
    **dict.fromkeys(("hr", "rh", "rr", "br", "rb"), (-1, -1)),
    **dict.fromkeys(("ml", "lm"), (0, 1)), **dict.fromkeys(("mr", "rm"), (0, -1)),
}  # fmt: skip
"""Ends and sides of two letters: ``rl`` and ``lr`` are rear and left, since ``l`` can be left alone."""


@dataclass(frozen=True, slots=True)
class NameDirection:
    """What one name says of directions; zero where it says nothing."""

    end: int
    """1 for front, -1 for hind."""
    side: int
    """1 for left, -1 for right."""
    is_weak: bool = False
    """Whether only a part of the body says the end, as ``head`` or ``shoulder``."""


def name_words(name: str) -> list[str]:
    """Return the words of a name in lower case; letters for ends and sides that follow each other are one word."""
    code = _JOINED_CODE.match(name)
    pieces = [code[0], *_WORDS.findall(name[code.end() :])] if code else _WORDS.findall(name)
    words: list[str] = []
    for is_letter, group in groupby((piece.lower() for piece in pieces), key=lambda piece: piece in _LETTERS):
        members = list(group)
        words += ["".join(members)] if is_letter else members
    return words


def direction_of(name: str) -> NameDirection:
    """Return what a name says of front, hind, left and right."""
    words = name_words(name)
    end = side = weak_end = 0
    for word in words:
        code = _CODES.get(word)
        if code is not None:
            end, side = end or code[0], side or code[1]
            continue
        end = end or _end_of(word)
        side = side or _side_of(word)
        weak_end = weak_end or (word in _FRONT_WORDS) - (word in _HIND_WORDS)
    if not weak_end and not side and "fin" in words:  # a fin in the middle belongs to the tail
        weak_end = -1
    return NameDirection(end or weak_end, side, is_weak=not end)


def is_fin_name(name: str) -> bool:
    """Return whether a name is that of a fin, a wing or a sense organ, which carries no body."""
    return any(word in _FIN_WORDS for word in name_words(name))


def _end_of(word: str) -> int:
    """Return 1 for a word that says front, -1 for one that says hind, else 0."""
    core = re.sub(r"^(left|right)|(left|right)$", "", word)
    if core in ("back", "backleg", "backfoot", "backlimb"):
        return -1
    return int(core.startswith(_FRONT_START)) - int(core.startswith(_HIND_START))


def _side_of(word: str) -> int:
    """Return 1 for a word that says left, -1 for one that says right, else 0."""
    if word in _SIDE_WORDS or word in _OTHER_WORDS:
        return _SIDE_WORDS.get(word, 0)
    for text, side in (("left", 1), ("right", -1)):
        if word.startswith(text) or word.endswith(text):
            return side
    return 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NamedFrame:
    """Directions in the file's horizontal plane that names give, each a unit vector of shape (2,) or None."""

    forward_axis: np.ndarray | None
    """From what is called hind to what is called front."""
    left_axis: np.ndarray | None
    """From what is called right to what is called left."""

    @property
    def heading(self) -> float | None:
        """Direction of forward, from the file's x axis to the left [degree]; None where names do not say it."""
        if self.forward_axis is not None:
            return float(np.degrees(np.arctan2(self.forward_axis[1], self.forward_axis[0])))
        if self.left_axis is not None:
            return float(np.degrees(np.arctan2(-self.left_axis[0], self.left_axis[1])))
        return None

    @property
    def is_mirrored(self) -> bool:
        """Whether the left of the names lies to the right of their front."""
        if self.forward_axis is None or self.left_axis is None:
            return False
        return bool(self.forward_axis[0] * self.left_axis[1] - self.forward_axis[1] * self.left_axis[0] < -_MIN_TURN)


_MIN_TURN = 0.5  # sine of the angle from forward to left; sides that lie less across the front say nothing
_MIN_DISTANCE = 0.02  # of the robot's size; named groups that are nearer to each other say nothing


def frame_by_names(tree: Tree) -> NamedFrame:
    """Return the directions that the names of a tree's bodies and hinges give.

    Names as ``front`` or ``FL`` decide before parts of the body, as ``head`` or ``shoulder``. A single letter ``l``
    counts only where there is an ``r`` too.

    Args:
        tree: the parts, upright.
    """
    directions = [(direction_of(name), position) for name, position in _named_positions(tree)]
    strong_ends = {direction.end for direction, _ in directions if not direction.is_weak} - {0}
    is_strong = bool(strong_ends)
    fronts = [p for d, p in directions if d.end > 0 and not (is_strong and d.is_weak)]
    hinds = [p for d, p in directions if d.end < 0 and not (is_strong and d.is_weak)]
    lefts = [position for direction, position in directions if direction.side > 0]
    rights = [position for direction, position in directions if direction.side < 0]
    forward_axis = None
    if fronts or hinds:
        forward_axis = _horizontal(_mean(fronts, tree.com) - _mean(hinds, tree.com), tree.size)
    left_axis = _horizontal(_mean(lefts, tree.com) - _mean(rights, tree.com), tree.size) if lefts and rights else None
    return NamedFrame(forward_axis=forward_axis, left_axis=left_axis)


def _named_positions(tree: Tree) -> Iterable[tuple[str, np.ndarray]]:
    """Yield each name of a body or hinge with its place in the file's frame [m]."""
    for tree_part in tree.parts:
        yield from zip(tree_part.names, tree_part.centres, strict=True)
        for joint in tree_part.joints:
            yield joint.name, joint.anchor


def _mean(positions: list[np.ndarray], default: np.ndarray) -> np.ndarray:
    return np.mean(positions, axis=0) if positions else default


def _horizontal(offset: np.ndarray, size: float) -> np.ndarray | None:
    """Return the direction of an offset in the horizontal plane; None where it is too short to say anything."""
    length = float(np.linalg.norm(offset[:2]))
    return offset[:2] / length if length > _MIN_DISTANCE * size else None
