"""Tracks: where the keypoints of a body are in every frame, and what they must be to be of use."""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from jaxtyping import Float

from suchus.core.errors import SuchusError
from suchus.robot.design import LEGS

GAIT_KEYPOINTS = ("shoulder", "hip", "tail_base", "tail_tip", *LEGS)
"""Keypoints that a gait is read from, besides ``neck`` or ``snout``; measurements do with fewer."""

UNITS: Mapping[str, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001, "px": float("nan")}
"""Units of length and what they are in metres; pixels are of unknown size."""

_MIN_FRAMES = 4  # frames; where their steps are even, none is longer than all the rest
_RATE = (5.0, 5000.0)  # [1/s]; slower cannot show a step, faster is no camera
_TRUNK = (0.01, 5.0)  # [m]; from a hatchling lizard to a crocodile longer than any measured
_JUMPED = 3.0  # times the usual length of a link; longer, and one of its points is somewhere else
_MAX_POSITION = 1e9  # [m or px]; what is farther off is no position, but a number for a lost point
MAX_LOST_FRACTION = 0.5
"""Share of lost frames beyond which a point is useless [-]."""
View = Literal["top", "side"]
"""Where a camera stands: above, so that bends to the sides are seen, or beside, so that those up and down are."""


class UnusableTracks(SuchusError, ValueError):
    """Keypoints that no gait can be read from."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tracks:
    """Keypoints of one body over time, seen by a camera that stands still.

    From the front to the back of the midline: ``snout``, ``neck``, ``shoulder``, ``spine_n`` to ``spine_1``, ``hip``,
    ``tail_base``, ``tail_1`` to ``tail_n``, ``tail_tip``; and the feet ``LF``, ``RF``, ``LH``, ``RH``. The axes are
    right-handed, seen from above: x anywhere on the ground, y a quarter turn to the left of it, z up.
    """

    time: np.ndarray
    """Time of each frame, shape (frame,) [s]."""
    points: tuple[str, ...]
    """Names of the keypoints."""
    position: np.ndarray
    """Position of each keypoint, shape (frame, point, axis) with two axes or three; NaN where it was lost [m or px]."""
    unit: str
    """Unit of the positions: ``m``, or ``px`` where the scale is unknown."""
    source: str
    """File that they are from, for messages."""
    view: View = "top"
    """Where the camera stands; from the side, the second axis is up, and the body goes along the first."""

    def has(self, *points: str) -> bool:
        """Return whether all of these points were tracked."""
        return set(points) <= set(self.points)

    @property
    def legs(self) -> tuple[str, ...]:
        """The feet that were tracked, in the order of ``LEGS``."""
        return tuple(leg for leg in LEGS if leg in self.points)

    def without(self, points: Collection[str]) -> "Tracks":
        """Return the tracks of the other points."""
        keep = [i for i, name in enumerate(self.points) if name not in points]
        return replace(self, points=tuple(self.points[i] for i in keep), position=self.position[:, keep])

    def at(self, point: str) -> Float[np.ndarray, "frame axis"]:
        """Return the track of one point."""
        return np.asarray(self.position[:, self.points.index(point)])

    @property
    def rate(self) -> float:
        """Frames per second [1/s]."""
        return float(1.0 / np.median(np.diff(self.time)))

    @property
    def has_heights(self) -> bool:
        """Whether heights were seen."""
        return self.position.shape[-1] == 3

    @property
    def thorax(self) -> tuple[str, str] | None:
        """The two points that show the heading of the front girdle, the front one first; None where one is missing."""
        head = "neck" if "neck" in self.points else "snout"
        return (head, "shoulder") if self.has(head, "shoulder") else None

    @property
    def pelvis(self) -> tuple[str, str] | None:
        """The same of the hind girdle."""
        return ("hip", "tail_base") if self.has("hip", "tail_base") else None

    @property
    def trunk_chain(self) -> tuple[str, ...]:
        """Midline points from the front girdle to the tail's base, front to back."""
        head = "neck" if "neck" in self.points else "snout"
        chain = (head, "shoulder", *self._series_points("spine")[::-1], "hip", "tail_base")
        return tuple(name for name in chain if name in self.points)

    @property
    def tail_chain(self) -> tuple[str, ...]:
        """Midline points from the hind girdle to the tail's tip, front to back."""
        chain = ("hip", "tail_base", *self._series_points("tail"), "tail_tip")
        return tuple(name for name in chain if name in self.points)

    @property
    def midline(self) -> tuple[str, ...]:
        """All midline points, front to back; where both are tracked, the snout is ahead of the neck."""
        snout = ("snout",) if self.has("snout", "neck") else ()
        return tuple(dict.fromkeys((*snout, *self.trunk_chain, *self.tail_chain)))

    @property
    def line(self) -> tuple[str, str]:
        """Two points that show where the trunk heads, the front one first: shoulder and hip, or what comes nearest."""
        trunk_points = ("shoulder", *self._series_points("spine")[::-1], "hip")
        inner = [name for name in trunk_points if name in self.points]
        chain = inner if len(inner) > 1 else self.trunk_chain
        return chain[0], chain[-1]

    def between(self, start: float | None, end: float | None) -> "Tracks":
        """Return the frames from ``start`` to ``end`` [s]."""
        keep = np.ones(len(self.time), dtype=bool)
        if start is not None:
            keep &= self.time >= start - 1e-9
        if end is not None:
            keep &= self.time <= end + 1e-9
        return replace(self, time=self.time[keep], position=self.position[keep])

    def ahead(self) -> "Tracks":
        """Return the tracks turned so that the body faces along x on average: no number depends on the camera then.

        Seen from the side they are mirrored instead, where the body faces the other way: up stays up.
        """
        front, rear = self.line
        d = self.at(front) - self.at(rear)
        facing = np.angle(np.nanmean(np.exp(1j * np.arctan2(d[:, 1], d[:, 0]))))
        position = self.position.copy()
        if self.view == "side":
            position[..., 0] *= 1.0 if abs(facing) <= np.pi / 2 else -1.0
            return replace(self, position=position)
        c, s = np.cos(facing), np.sin(facing)
        position[..., :2] = position[..., :2] @ np.array([[c, -s], [s, c]])
        return replace(self, position=position)

    def trunk_length(self) -> float:
        """Return the length of the trunk from hip to shoulder along the points between, in the unit of the tracks.

        It is NaN where shoulder or hip were not tracked.
        """
        if not self.has("shoulder", "hip"):
            return float("nan")
        chain = ("shoulder", *self._series_points("spine")[::-1], "hip")
        links = [self.at(a) - self.at(b) for a, b in pairwise(chain)]
        if len(links) > 1:
            return sum(_length(link) for link in links)
        # a chord without points between is as long as the trunk only while the trunk is straight
        return float(np.nanpercentile(np.linalg.norm(links[0], axis=-1), 95))

    def _series_points(self, stem: str) -> tuple[str, ...]:
        names = [name for name in self.points if re.fullmatch(rf"{stem}_\d+", name)]
        return tuple(sorted(names, key=lambda name: int(name.rpartition("_")[2])))


def _length(link: np.ndarray) -> float:
    """Return how long a link between two points is, whatever the noise of the camera.

    Noise makes every link longer as it is seen. That of one frame is independent of that of another, so the products
    of a link with itself one and two frames later, ``l**2 cos(a)`` and ``l**2 cos(2 a)`` for a turn by ``a`` from frame
    to frame, hold none of it in the mean; ``(4 cos(a) - cos(2 a)) / 3`` is one up to the fourth order of the turn.
    Frames in which the link is more than three times as long as usual are left out: there a point has jumped.

    Args:
        link: from one point to the other, for each frame (frames, axes); NaN where one was not seen.
    """
    size = np.linalg.norm(link, axis=-1)
    if not np.isfinite(size).any():
        return float("nan")
    median_length = float(np.nanmedian(size))
    valid_links = np.where((size <= _JUMPED * median_length)[:, None], link, np.nan)
    lag_products = [np.sum(valid_links[lag:] * valid_links[:-lag], axis=-1) for lag in (1, 2)]
    first_product, second_product = (
        float(np.nanmean(lag_product)) if np.isfinite(lag_product).any() else np.nan for lag_product in lag_products
    )
    square = (4 * first_product - second_product) / 3
    return float(np.sqrt(square)) if square > 0 else median_length


def known_name(name: str) -> str:
    """Return our spelling of a keypoint's name: ``Tail Base``, ``tailBase`` and ``TAIL-BASE`` are ``tail_base``."""
    if name.upper() in LEGS:
        return name.upper()
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z0-9])", "_", name.strip())
    return re.sub(r"[\s\-_]+", "_", spaced).lower()


def map_keypoint_names(points: tuple[str, ...], names: Mapping[str, str], source: str) -> tuple[str, ...]:
    """Return our names of a file's keypoints.

    Args:
        points: points as the file calls them.
        names: our name of some, by the file's name.
        source: name of the source, for messages.

    Raises:
        UnusableTracks: a name that the file does not hold, or two keypoints of one name.
    """
    spellings = {known_name(name) for name in points}
    unknown = [name for name in names if name not in points and known_name(name) not in spellings]
    if unknown:
        raise UnusableTracks(f"{source} holds no keypoint {unknown[0]!r}; it holds {', '.join(points)}.")
    known_spellings = {known_name(name): keypoint for name, keypoint in names.items() if name not in points}
    point_names = tuple(names.get(name) or known_spellings.get(known_name(name)) or known_name(name) for name in points)
    duplicates = sorted({name for name in point_names if point_names.count(name) > 1})
    if duplicates:
        raise UnusableTracks(f"{source} holds more than one keypoint {duplicates[0]!r}; each needs a name of its own.")
    return point_names


def check_tracks(tracks: Tracks) -> None:
    """Refuse tracks that nothing can be measured on; whether single points are to be trusted is looked at elsewhere.

    Raises:
        UnusableTracks: no two points of the trunk are there, or the time makes no sense.
    """
    if len(tracks.trunk_chain) < 2:
        raise UnusableTracks(
            f"{tracks.source} has fewer than two keypoints of the trunk (neck or snout, shoulder, spine_1, ..., hip, "
            f"tail_base), so that nobody knows where the body heads; it holds {', '.join(tracks.points) or 'none'}: "
            "rename with --names THEIRS=OURS, or track them."
        )
    _check_time(tracks)


def without_absurd_positions(tracks: Tracks) -> Tracks:
    """Return tracks in which numbers that are no position are lost points: infinite, or beyond 1e9 m or px."""
    with np.errstate(invalid="ignore"):
        is_absurd = np.isinf(tracks.position) | (np.abs(tracks.position) > _MAX_POSITION)
    if not is_absurd.any():
        return tracks
    return replace(tracks, position=np.where(is_absurd.any(axis=-1, keepdims=True), np.nan, tracks.position))


def with_gaps(tracks: Tracks) -> Tracks:
    """Return tracks with a frame of lost points for each frame that the file leaves out, so that frames follow evenly.

    Args:
        tracks: with times that increase.
    """
    steps = np.diff(tracks.time)
    missing_frames = np.maximum(np.round(steps / np.median(steps)).astype(int) - 1, 0)
    if not missing_frames.any():
        return tracks
    indices = np.arange(len(tracks.time)) + np.concatenate([[0], np.cumsum(missing_frames)])
    position = np.full((indices[-1] + 1, *tracks.position.shape[1:]), np.nan)
    position[indices] = tracks.position
    time = np.interp(np.arange(indices[-1] + 1), indices, tracks.time)
    return replace(tracks, time=time, position=position)


def check_size(tracks: Tracks) -> None:
    """Refuse an animal whose trunk has a length that no animal has.

    Raises:
        UnusableTracks: the unit must be wrong.
    """
    if tracks.unit == "m" and tracks.has("shoulder", "hip"):
        length = tracks.trunk_length()
        if not _TRUNK[0] <= length <= _TRUNK[1]:
            raise UnusableTracks(
                f"in {tracks.source} the trunk measures {length:.4g} m from hip to shoulder; {_TRUNK[0]:g} to "
                f"{_TRUNK[1]:g} m is expected: the unit is wrong, give m, cm, mm or px."
            )


def lacking(points: Collection[str]) -> tuple[str, ...]:
    """Return the keypoints that a gait is read from and that are not among these."""
    head = () if {"neck", "snout"} & set(points) else ("neck (or snout)",)
    return (*head, *(name for name in GAIT_KEYPOINTS if name not in points))


def _check_time(tracks: Tracks) -> None:
    """Refuse times that do not increase, frame rates out of range, and a gap longer than the rest of the film."""
    n = len(tracks.time)
    if n < 2:
        raise UnusableTracks(f"{tracks.source} holds {n} frame{'s' * (n != 1)}; at least one cycle is needed.")
    steps = np.diff(tracks.time)
    if not (np.isfinite(tracks.time).all() and np.all(steps > 0)):
        frame = int(np.argmin(np.where(np.isfinite(steps), steps, -np.inf))) + 1
        raise UnusableTracks(
            f"in {tracks.source} the time does not increase from frame {frame} to frame {frame + 1}; every frame "
            "needs a later time than the one before."
        )
    if not _RATE[0] <= tracks.rate <= _RATE[1]:
        raise UnusableTracks(
            f"in {tracks.source} frames are {np.median(steps):.4g} s apart; {1 / _RATE[1]:g} to {1 / _RATE[0]:g} s is "
            "allowed: the time seems to be in milliseconds or frames, seconds are needed."
        )
    longest_step = int(steps.argmax())
    if n >= _MIN_FRAMES and steps[longest_step] > np.delete(steps, longest_step).sum():
        frame = longest_step + 1
        raise UnusableTracks(
            f"in {tracks.source} nothing was filmed from frame {frame} to frame {frame + 1}, for {steps.max():.4g} "
            "s, longer "
            "than all the rest lasts: mend that time, or give what is before it and what is behind as two tables."
        )
