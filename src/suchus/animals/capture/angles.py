"""From keypoints to the article's four bend angles, and to the bend at every point of the midline.

Every segment of the midline points forward: from the rear point to the front point. Lateral angles are taken in the
ground plane, seen from above. Vertical angles are taken against the ground plane and need heights. Bends beyond half a
turn are ambiguous. The phases of the joints show whether the body bends as a standing wave or as a travelling wave.
"""

from itertools import pairwise

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from suchus.animals.capture.tracks import Tracks
from suchus.article.paper import BendAngles, JointSums, to_bend_angles


def azimuth(tracks: Tracks, front: str, rear: str) -> Float[np.ndarray, " frame"]:
    """Return the direction of a segment in the ground plane, a quarter turn from x to y [rad]."""
    d = tracks.at(front) - tracks.at(rear)
    return np.arctan2(d[:, 1], d[:, 0])


def elevation(tracks: Tracks, front: str, rear: str) -> Float[np.ndarray, " frame"]:
    """Return the angle of a segment above the ground plane [rad]; NaN without heights."""
    if not tracks.has_heights:
        return np.full(len(tracks.time), np.nan)
    d = tracks.at(front) - tracks.at(rear)
    return np.arctan2(d[:, 2], np.hypot(d[:, 0], d[:, 1]))


def bend_angles(tracks: Tracks, tail_share: float = 1.0) -> BendAngles:
    """Return the four angles of Figs 11 and 12 in the article's signs, each of shape (frame,) [rad].

    The angle of the spine is that between the front girdle (``neck`` or ``snout`` to ``shoulder``) and the hind girdle
    (``hip`` to ``tail_base``). It equals the sum of the joint angles between them. The lateral angle of the tail is
    that between the tail and the hind girdle, at a fraction of the tail's length. The vertical angle of the tail is
    that of its first segment. Angles of points that were not tracked are NaN. Lateral angles are NaN in a view from the
    side, vertical angles without heights.

    Args:
        tracks: the keypoints.
        tail_share: where along the tail its direction is taken, 1 at the tip [-].
    """
    nan_angles = np.full(len(tracks.time), np.nan)
    thorax, pelvis, root = tracks.thorax, tracks.pelvis, tracks.tail_chain[1:3]
    is_top_view = tracks.view == "top"
    rises = elevation if is_top_view else azimuth  # from the side, what lies in the picture is up and down
    return to_bend_angles(
        JointSums(
            spine_yaw=wrapped(azimuth(tracks, *thorax) - azimuth(tracks, *pelvis))
            if is_top_view and thorax and pelvis
            else nan_angles,
            spine_pitch=rises(tracks, *pelvis) - rises(tracks, *thorax) if thorax and pelvis else nan_angles,
            tail_yaw=_tail_yaw(tracks, tail_share) if is_top_view and pelvis and tracks.has("tail_tip") else nan_angles,
            tail_pitch=rises(tracks, *root) - rises(tracks, *pelvis) if pelvis and len(root) > 1 else nan_angles,
        )
    )


def _tail_yaw(tracks: Tracks, fraction: float) -> Float[np.ndarray, " frame"]:
    """Return the angle of the tail to the left of the girdle, interpolated between its segments [rad]."""
    segments = list(pairwise(tracks.tail_chain[1:]))
    frame_lengths = [np.linalg.norm(tracks.at(a) - tracks.at(b), axis=-1) for a, b in segments]
    if not all(np.isfinite(size).any() for size in frame_lengths):  # a segment was never seen whole
        return np.full(len(tracks.time), np.nan)
    lengths = np.array([np.nanmedian(size) for size in frame_lengths])
    middles = np.cumsum(lengths) - lengths / 2
    distance = fraction * lengths.sum()
    pelvis = azimuth(tracks, "hip", "tail_base")
    rear_index = int(np.clip(np.searchsorted(middles, distance), 0, len(segments) - 1))
    front_index = rear_index if distance >= middles[-1] or rear_index == 0 else rear_index - 1
    front_yaw, rear_yaw = (wrapped(azimuth(tracks, *segments[i]) - pelvis) for i in (front_index, rear_index))
    weight = (
        0.0
        if front_index == rear_index
        else (distance - middles[front_index]) / (middles[rear_index] - middles[front_index])
    )
    return wrapped(front_yaw + weight * wrapped(rear_yaw - front_yaw))


def joint_bends(tracks: Tracks, chain: tuple[str, ...]) -> Float[np.ndarray, "joint frame"]:
    """Return the lateral bend at every point between two segments of a chain, positive to the left [rad].

    Args:
        tracks: the keypoints.
        chain: points of the midline from front to back.
    """
    azimuths = [azimuth(tracks, front, rear) for front, rear in pairwise(chain)]
    return np.array(
        [wrapped(front_azimuth - rear_azimuth) for front_azimuth, rear_azimuth in pairwise(azimuths)]
    ).reshape(-1, len(tracks.time))


def wrapped(angle: np.ndarray) -> np.ndarray:
    """Return the equivalent angle between minus half a turn and half a turn [rad]."""
    return np.asarray(np.mod(angle + np.pi, 2 * np.pi) - np.pi)


STANDING = 0.8
"""Index from which we speak of a standing wave [-]; a salamander's walk has 0.91, its swimming 0.08."""


def standing_index(amplitude: ArrayLike, phase: ArrayLike) -> float:
    """Return 1 for a standing wave, 0 for a travelling one: ``|sum A exp(2 i phi)| / sum A`` [-].

    Joints in antiphase count as in phase, because a standing wave may have a node. A linear fit of the phases cannot
    tell the two waves apart: half a turn at a node resembles a lag.

    Args:
        amplitude: amplitude of the bend at each joint, of any one unit.
        phase: phase of the bend at each joint [rad].

    Returns:
        NaN if nothing bends.
    """
    A, phi = np.asarray(amplitude, dtype=float), np.asarray(phase, dtype=float)
    total = A.sum()
    return float(np.abs((A * np.exp(2j * phi)).sum()) / total) if total > 0 else float("nan")
