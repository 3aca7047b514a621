"""Exchanged names: two keypoints that each fit the body better under the name of the other.

Every role of a keypoint has properties that noise, gaits and proportions do not change. Links of the midline keep their
length. The midline does not fold back at a keypoint. A foot lies on its side of the body, nearer to its own girdle, and
moves along the body while the animal walks. The penalty of a role counts by how far its keypoint misses these
properties. Names are exchanged only if the roles of two keypoints miss them together by far, and none of them does with
the two names changed. A keypoint that is wrong by itself satisfies no other role, and accuses nobody.
"""

from collections.abc import Mapping
from itertools import combinations, pairwise, permutations
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.animals.capture.tracks import Tracks
from suchus.robot.design import LEGS

MAX_FALSE_ACCUSATIONS = 0.01
"""Greatest fraction of films without a fault in which names may be called exchanged [-]."""
_MAX_FRAMES = 600  # greatest number of frames that are compared
_MAX_PENALTY = 9.0  # greatest penalty of one property
_MIN_GAIN = 4.0  # least decrease of the penalties if names are exchanged
_MAX_REMAINDER = 1.0  # greatest penalty of one property with the names exchanged
_SWAY, _CHORD = 0.1, 0.25  # fractions of its length by which a short link and a long one may vary
_LONG = 0.5  # [trunk]; a longer link may bend between its keypoints
_FOLD, _FOLD_STEP = np.radians(60.0), np.radians(30.0)  # median bend at a keypoint: without a penalty, and of penalty 1
_MIN_OUTWARD = 0.06  # [trunk]; mean distance of a foot from the trunk's line, without a penalty
_GIRDLE_STEP = 0.2  # [trunk]; by how much nearer to the other girdle a foot has penalty 1
_REACH = 2.0  # [trunk]; distance from its girdle at which a foot has penalty 1
_MIN_SWEEP = 0.05  # [trunk]; standard deviation of a foot's position along the body, without a penalty
_MAX_STILL_PENALTY = 4.0  # of a foot that does not move along the body


class Exchange(NamedTuple):
    """Keypoints whose names are exchanged, and what shows it."""

    names: Mapping[str, str]
    """The right name of each of them."""
    reason: str
    """What is wrong with the names as they are, and right with the others."""


class _Penalty(NamedTuple):
    """Misfit of one property of a role."""

    size: float
    """0 without a misfit, 1 at the border of what may be, up to ``_MAX_PENALTY`` [-]."""
    kind: str
    """Property that is missed: ``link``, ``fold``, ``side``, ``girdle``, ``reach`` or ``still``."""
    roles: tuple[str, ...]
    """Names of the keypoints that the property is of."""


def find_exchange(tracks: Tracks, noise: Mapping[str, float], scale: float, walking: np.ndarray) -> Exchange | None:
    """Return the two keypoints, or the feet, whose names are exchanged; None if the film does not show any.

    Args:
        tracks: without jumps.
        noise: noise of each keypoint from frame to frame [m or px].
        scale: an estimate of the trunk's length [m or px].
        walking: frames in which the animal moves.
    """
    body = _Body(tracks, noise, scale, walking)
    identity = {name: name for name in body.names}
    penalties = body.penalties(identity)
    if sum(penalty.size for penalty in penalties) < _MIN_GAIN:
        return None
    best_gain, best_names = _MIN_GAIN, None
    for names in body.exchanges():
        assignment = identity | {right_name: track for track, right_name in names.items()}
        changed_penalties = body.penalties(assignment)
        affected_penalties = [penalty for penalty in changed_penalties if set(penalty.roles) & set(names)]
        gain = sum(penalty.size for penalty in penalties) - sum(penalty.size for penalty in changed_penalties)
        if gain > best_gain and all(penalty.size <= _MAX_REMAINDER for penalty in affected_penalties):
            best_gain, best_names = gain, names
    if best_names is None or _is_mirrored(best_names):
        return None
    worst_penalty = max(
        (penalty for penalty in penalties if set(penalty.roles) & set(best_names)), key=lambda penalty: penalty.size
    )
    return Exchange(best_names, _reason(worst_penalty))


def _is_mirrored(names: Mapping[str, str]) -> bool:
    """Return whether left and right feet of a pair are exchanged, or of both, as in a picture that is mirrored.

    These are compared frame by frame elsewhere.
    """
    return set(names) <= set(LEGS) and all(leg[1] == name[1] for leg, name in names.items())


def _reason(penalty: _Penalty) -> str:
    """Return the property of an exchanged keypoint that shows the exchange."""
    names = " and ".join(penalty.roles)
    return {
        "link": f"the distance of {names} does not stay, and each keeps its distance from the neighbours of the other",
        "fold": f"the midline folds back at {penalty.roles[len(penalty.roles) // 2]}, and is straight with the names "
        "changed",
        "side": f"{penalty.roles[0]} does not lie on its side of the body, and the other does",
        "girdle": f"{penalty.roles[0]} is nearer to the other girdle, and each is nearer to the other's girdle",
        "reach": f"{penalty.roles[0]} is farther from its girdle than a limb reaches, and the other is not",
        "still": f"{penalty.roles[0]} moves with the trunk, and the other makes the steps",
    }[penalty.kind]


class _Body:
    """Distances, bends and positions of keypoints, and the penalties of an assignment of keypoints to roles."""

    def __init__(self, tracks: Tracks, noise: Mapping[str, float], scale: float, walking: np.ndarray) -> None:
        self._chain, self._legs, self._line = tracks.midline, tracks.legs, tracks.line
        self._view, self._scale = tracks.view, scale
        self.names = tuple(name for name in (*self._chain, *self._legs) if np.isfinite(tracks.at(name)).any())
        self._chain = tuple(name for name in self._chain if name in self.names)
        self._legs = tuple(name for name in self._legs if name in self.names)
        frames = np.flatnonzero(walking)
        frames = frames[:: max(1, len(frames) // _MAX_FRAMES)]
        place = np.stack([_filled(tracks.time, tracks.at(name))[frames] for name in self.names], axis=1)
        self._place = place
        self._noise = np.array([np.nan_to_num(noise[name]) for name in self.names])
        link = place[:, None, :, :] - place[:, :, None, :]  # (frame, from, to, axis)
        size = np.linalg.norm(link, axis=-1)
        self._distance = np.median(size, axis=0)
        deviation = 1.4826 * np.median(np.abs(size - self._distance), axis=0)
        variances = self._noise**2
        pair_variance = variances[:, None] + variances[None, :]
        self._spread = np.sqrt(np.maximum(deviation**2 - pair_variance, 0.0))
        self._pair_noise = np.sqrt(pair_variance)
        self._index = {name: i for i, name in enumerate(self.names)}

    def exchanges(self) -> list[dict[str, str]]:
        """Return the exchanges that are considered: of two keypoints, and every permutation of the feet."""
        pairs = [{first: second, second: first} for first, second in combinations(self.names, 2)]
        orders = [dict(zip(self._legs, order, strict=True)) for order in permutations(self._legs)]
        feet = [{leg: name for leg, name in order.items() if leg != name} for order in orders]
        return pairs + [names for names in feet if len(names) > 2]

    def penalties(self, tracks_of: Mapping[str, str]) -> list[_Penalty]:
        """Return the penalties of all roles.

        Args:
            tracks_of: the keypoint that is taken for each name.
        """
        index = {name: self._index[track] for name, track in tracks_of.items()}
        return [
            *(self._link(pair, index) for pair in pairwise(self._chain)),
            *(self._fold(triple, index) for triple in zip(self._chain, self._chain[1:], self._chain[2:], strict=False)),
            *(penalty for leg in self._legs for penalty in self._foot(leg, index)),
        ]

    def _link(self, pair: tuple[str, str], index: Mapping[str, int]) -> _Penalty:
        """Return the penalty of a link whose length varies."""
        i, j = (index[name] for name in pair)
        distance = self._distance[i, j]
        fraction = _CHORD if distance > _LONG * self._scale else _SWAY
        tolerance = fraction * min(distance, self._scale) + self._pair_noise[i, j] / 2 + 1e-12
        return _Penalty(_limited_power(self._spread[i, j] / tolerance), "link", pair)

    def _fold(self, triple: tuple[str, str, str], index: Mapping[str, int]) -> _Penalty:
        """Return the penalty of a midline that folds back at a keypoint, by the median bend there."""
        i, j, k = (index[name] for name in triple)
        front_link, rear_link = self._place[:, j] - self._place[:, i], self._place[:, k] - self._place[:, j]
        axes = self._place.shape[-1]
        dot = float(np.median(np.sum(front_link * rear_link, axis=-1))) + axes * float(np.square(self._noise[j]))
        cross = np.linalg.norm(np.median(_cross(front_link, rear_link), axis=0))
        angle = float(np.arctan2(cross, dot))
        return _Penalty(_limited_power((angle - _FOLD) / _FOLD_STEP), "fold", triple)

    def _foot(self, leg: str, index: Mapping[str, int]) -> list[_Penalty]:
        """Return the penalties of a foot: on the wrong side, near the wrong girdle, out of reach, or still."""
        front_link, rear_link = self._line
        f, p, q = index[leg], index[front_link], index[rear_link]
        axis = self._place[:, p, :2] - self._place[:, q, :2]
        axis = axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12)
        offset = self._place[:, f, :2] - self._place[:, q, :2]
        left_offset = float(np.median(axis[:, 0] * offset[:, 1] - axis[:, 1] * offset[:, 0])) / self._scale
        outward_offset = left_offset if leg.startswith("L") else -left_offset
        axial_position = np.sum(axis * offset, axis=-1)
        sweep = 1.4826 * float(np.median(np.abs(axial_position - np.median(axial_position))))
        sweep = np.sqrt(max(0.0, np.square(sweep) - np.square(self._pair_noise[f, q]))) / self._scale
        own_girdle, other_girdle = (p, q) if leg.endswith("F") else (q, p)
        girdle_excess = float(self._distance[f, own_girdle] - self._distance[f, other_girdle]) / self._scale
        reach = float(self._distance[f, own_girdle]) / self._scale
        still_penalty = min(_MAX_STILL_PENALTY, 4.0 * max(0.0, 1.0 - sweep / _MIN_SWEEP) ** 2)
        side_penalty = _limited_power(1.0 - outward_offset / _MIN_OUTWARD) if self._view == "top" else 0.0
        return [
            _Penalty(side_penalty, "side", (leg,)),
            _Penalty(_limited_power(girdle_excess / _GIRDLE_STEP), "girdle", (leg,)),
            _Penalty(_limited_power(reach / _REACH, 4), "reach", (leg,)),
            _Penalty(still_penalty, "still", (leg,)),
        ]


def _limited_power(deviation: float, power: int = 2) -> float:
    """Return a power of a deviation, 0 below it and at most ``_MAX_PENALTY``; no number is too large for it."""
    return float(min(min(max(0.0, deviation), _MAX_PENALTY) ** power, _MAX_PENALTY))


def _cross(first: np.ndarray, second: np.ndarray) -> Float[np.ndarray, "frame axis"]:
    """Return the cross product of plane or spatial vectors, with at least one axis."""
    if first.shape[-1] == 2:
        return np.asarray((first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[:, None])
    return np.asarray(np.cross(first, second))


def _filled(time: np.ndarray, place: np.ndarray) -> Float[np.ndarray, "frame axis"]:
    """Return the positions of a keypoint, interpolated in time where it was lost."""
    filled = place.copy()
    for axis in range(place.shape[-1]):
        is_seen = np.isfinite(place[:, axis])
        filled[:, axis] = np.interp(time, time[is_seen], place[is_seen, axis])
    return filled


def names_option(names: Mapping[str, str]) -> str:
    """Return the option that gives keypoints their right names: ``--names A=B B=A``."""
    return "--names " + " ".join(f"{track}={right_name}" for track, right_name in names.items())
