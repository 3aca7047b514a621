"""Tracks: where the keypoints of a body are in every frame, what they must be to be of use, and points that jump."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from suchus.design import LEGS
from suchus.errors import SuchusError

NEEDED = ("shoulder", "hip", "tail_base", "tail_tip", *LEGS)
"""Keypoints that every file must hold, besides ``neck`` or ``snout``."""

UNITS: Mapping[str, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001, "px": float("nan")}
"""Units of length and what they are in metres; pixels are of unknown size."""

_RATE = (5.0, 5000.0)  # [1/s]; slower cannot show a step, faster is no camera
_TRUNK = (0.01, 5.0)  # [m]; from a hatchling lizard to a crocodile longer than any measured
_JUMPED = 3.0  # times the usual length of a link; longer, and one of its points is somewhere else
_LOST = 0.5  # share of lost frames beyond which a point is useless


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

    def at(self, point: str) -> Float[np.ndarray, "frame axis"]:
        """Return the track of one point."""
        return np.asarray(self.position[:, self.points.index(point)])

    @property
    def rate(self) -> float:
        """Frames per second [1/s]."""
        return float(1.0 / np.median(np.diff(self.time)))

    @property
    def upright(self) -> bool:
        """Whether heights were seen."""
        return self.position.shape[-1] == 3

    @property
    def thorax(self) -> tuple[str, str]:
        """The two points that show the heading of the front girdle, the front one first."""
        return ("neck" if "neck" in self.points else "snout"), "shoulder"

    @property
    def trunk_chain(self) -> tuple[str, ...]:
        """Midline points from the front girdle to the tail's base, front to back."""
        return (*self.thorax, *self._numbered("spine")[::-1], "hip", "tail_base")

    @property
    def tail_chain(self) -> tuple[str, ...]:
        """Midline points from the hind girdle to the tail's tip, front to back."""
        return ("hip", "tail_base", *self._numbered("tail"), "tail_tip")

    def between(self, start: float | None, end: float | None) -> "Tracks":
        """Return the frames from ``start`` to ``end`` [s]."""
        keep = np.ones(len(self.time), dtype=bool)
        if start is not None:
            keep &= self.time >= start - 1e-9
        if end is not None:
            keep &= self.time <= end + 1e-9
        return replace(self, time=self.time[keep], position=self.position[keep])

    def ahead(self) -> "Tracks":
        """Return the tracks turned so that the body faces along x on average: no number depends on the camera then."""
        d = self.at("shoulder") - self.at("hip")
        facing = np.angle(np.nanmean(np.exp(1j * np.arctan2(d[:, 1], d[:, 0]))))
        c, s = np.cos(facing), np.sin(facing)
        position = self.position.copy()
        position[..., :2] = position[..., :2] @ np.array([[c, -s], [s, c]])
        return replace(self, position=position)

    def trunk_length(self) -> float:
        """Return the length of the trunk from hip to shoulder along the points between, in the unit of the tracks."""
        chain = ("shoulder", *self._numbered("spine")[::-1], "hip")
        links = [self.at(a) - self.at(b) for a, b in pairwise(chain)]
        if len(links) > 1:
            return sum(_length(link) for link in links)
        # a chord without points between is as long as the trunk only while the trunk is straight
        return float(np.nanpercentile(np.linalg.norm(links[0], axis=-1), 95))

    def _numbered(self, stem: str) -> tuple[str, ...]:
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
    usual = float(np.nanmedian(size))
    kept = np.where((size <= _JUMPED * usual)[:, None], link, np.nan)
    later = [np.sum(kept[ahead:] * kept[:-ahead], axis=-1) for ahead in (1, 2)]
    one, two = (float(np.nanmean(seen)) if np.isfinite(seen).any() else np.nan for seen in later)
    square = (4 * one - two) / 3
    return float(np.sqrt(square)) if square > 0 else usual


def known_name(name: str) -> str:
    """Return our spelling of a keypoint's name: ``Tail Base``, ``tailBase`` and ``TAIL-BASE`` are ``tail_base``."""
    if name.upper() in LEGS:
        return name.upper()
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z0-9])", "_", name.strip())
    return re.sub(r"[\s\-_]+", "_", spaced).lower()


def renamed(points: tuple[str, ...], names: Mapping[str, str], source: str) -> tuple[str, ...]:
    """Return our names of a file's keypoints.

    Args:
        points: as the file calls them.
        names: our name of some, by the file's name.
        source: for messages.

    Raises:
        UnusableTracks: a name that the file does not hold, or two keypoints of one name.
    """
    unknown = [name for name in names if name not in points]
    if unknown:
        raise UnusableTracks(f"{source} holds no keypoint {unknown[0]!r}; it holds {', '.join(points)}.")
    ours = tuple(names.get(name) or known_name(name) for name in points)
    twice = sorted({name for name in ours if ours.count(name) > 1})
    if twice:
        raise UnusableTracks(f"{source} holds more than one keypoint {twice[0]!r}; each needs a name of its own.")
    return ours


def check_tracks(tracks: Tracks) -> None:
    """Refuse tracks that no gait can be read from; left and right are looked at elsewhere.

    Raises:
        UnusableTracks: points are missing or mostly lost, time or size make no sense.
    """
    _check_points(tracks)
    _check_time(tracks)
    _check_seen(tracks)
    if tracks.unit == "m":
        length = tracks.trunk_length()
        if not _TRUNK[0] <= length <= _TRUNK[1]:
            raise UnusableTracks(
                f"in {tracks.source} the trunk measures {length:.4g} m from hip to shoulder; {_TRUNK[0]:g} to "
                f"{_TRUNK[1]:g} m is expected: the unit is wrong, give m, cm, mm or px."
            )


def _check_points(tracks: Tracks) -> None:
    missing = [name for name in NEEDED if name not in tracks.points]
    if not {"neck", "snout"} & set(tracks.points):
        missing.insert(0, "neck (or snout)")
    if missing:
        raise UnusableTracks(
            f"{tracks.source} lacks the keypoint{'s' * (len(missing) > 1)} {', '.join(missing)}; it holds "
            f"{', '.join(tracks.points)}: rename with --names THEIRS=OURS, or track them."
        )


def _check_time(tracks: Tracks) -> None:
    n = len(tracks.time)
    if n < 2:
        raise UnusableTracks(f"{tracks.source} holds {n} frame{'s' * (n != 1)}; at least one cycle is needed.")
    steps = np.diff(tracks.time)
    if not (np.isfinite(tracks.time).all() and np.all(steps > 0)):
        at = int(np.argmin(np.where(np.isfinite(steps), steps, -np.inf))) + 1
        raise UnusableTracks(
            f"in {tracks.source} the time does not increase from frame {at} to frame {at + 1}; every frame needs a "
            "later time than the one before."
        )
    if not _RATE[0] <= tracks.rate <= _RATE[1]:
        raise UnusableTracks(
            f"in {tracks.source} frames are {np.median(steps):.4g} s apart; {1 / _RATE[1]:g} to {1 / _RATE[0]:g} s is "
            "allowed: the time seems to be in milliseconds or frames, seconds are needed."
        )


def _check_seen(tracks: Tracks) -> None:
    for name in (*tracks.trunk_chain, *tracks.tail_chain, *LEGS):
        lost = float(np.mean(np.isnan(tracks.at(name)).any(axis=-1)))
        if lost > _LOST:
            raise UnusableTracks(
                f"in {tracks.source} the keypoint {name} is lost in {100 * lost:.0f} % of the frames; at most "
                f"{100 * _LOST:.0f} % may be: track it again, or lower the confidence that is asked for."
            )


_AROUND = 3  # frames before and after, whose median a point is held against
_FAR = 0.2  # [trunk]; less is noise, which the fits take care of
_USUAL, _SHARE = 3.0, 90.0  # times what is not exceeded in so many per cent of the frames


def without_jumps(tracks: Tracks) -> Tracks:
    """Return the tracks with points lost where they are far from where they were just before and just after.

    Far is beyond a fifth of the trunk, and beyond three times what 90 % of the frames of that point stay below, so that
    a fast foot in a slow film is none. This is Hampel's identifier with a window of seven frames and a quantile that
    holds where a foot stands still most of the time. Longer mistakes, as two feet exchanged for a while, are no jumps.
    """
    position = tracks.position.copy()
    padded = np.pad(position, ((_AROUND, _AROUND), (0, 0), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _AROUND + 1, axis=0)
    seen = np.isfinite(windows).all(axis=2).sum(axis=-1)  # (frame, point)
    usual = np.full_like(position, np.nan)
    known = seen >= _AROUND
    usual[known] = np.nanmedian(windows[known], axis=-1)
    apart = np.linalg.norm(position - usual, axis=-1)
    for i in range(position.shape[1]):
        far = apart[:, i]
        if np.isfinite(far).any():
            most = max(_FAR * tracks.trunk_length(), _USUAL * float(np.nanpercentile(far, _SHARE)))
            position[far > most, i] = np.nan
    return replace(tracks, position=position)


_ALWAYS = 0.9  # share of the frames that counts as always
_IN_A_ROW = 0.5  # share of these frames that follow each other, below which it is noise
_OFTEN = 0.1  # share of the frames in which noise may do so
_SOMETIMES = 0.02  # share that a point's noise does not explain


def check_sides(tracks: Tracks) -> None:
    """Refuse tracks in which a left foot lies right of its right neighbour, seen along the body.

    Raises:
        UnusableTracks: it names the pair, or says that the whole picture is mirrored, and gives the frames.
    """
    front, hind = _crossed(tracks, "LF", "RF", *tracks.thorax), _crossed(tracks, "LH", "RH", "hip", "tail_base")
    shares = float(np.nanmean(front)), float(np.nanmean(hind))
    if min(shares) > _ALWAYS:
        raise UnusableTracks(
            f"in {tracks.source} LF and LH lie on the right of the body, RF and RH on the left: left and right are "
            "swapped in both pairs, or y points the other way; rename the feet, or give --y-axis up or down "
            "(images have it down)."
        )
    for (left, right), crossed, share in zip((("LF", "RF"), ("LH", "RH")), (front, hind), shares, strict=True):
        if share > _ALWAYS:
            raise UnusableTracks(
                f"in {tracks.source} {left} lies on the right of the body and {right} on the left, in "
                f"{100 * share:.0f} % of the frames: left and right of this pair are swapped; give --names "
                f"{left}={right} {right}={left}."
            )
        if share > _SOMETIMES:
            frames = np.flatnonzero(crossed == 1)
            if np.mean(np.diff(frames) == 1) < _IN_A_ROW:
                _check_noise(tracks, left, right, share)
                continue
            raise UnusableTracks(
                f"in {tracks.source} {left} and {right} are swapped in {len(frames)} frames, first in frame "
                f"{frames[0] + 1} at {tracks.time[frames[0]]:.2f} s and last in frame {frames[-1] + 1}: exchange "
                "them there."
            )


def _check_noise(tracks: Tracks, left: str, right: str, share: float) -> None:
    """Refuse feet that change sides from frame to frame, if they do so often."""
    if share > _OFTEN:
        raise UnusableTracks(
            f"in {tracks.source} {left} lies right of {right} in {100 * share:.0f} % of the frames, now here and now "
            f"there; up to {100 * _OFTEN:.0f} % is allowed: noise hides the feet; track them again, or film nearer."
        )


def _crossed(tracks: Tracks, left: str, right: str, ahead: str, behind: str) -> np.ndarray:
    """Return 1 in frames in which the left foot lies right of the right one, 0 where it does not, NaN where lost."""
    look = tracks.at(ahead) - tracks.at(behind)
    across = tracks.at(left) - tracks.at(right)
    side = look[:, 0] * across[:, 1] - look[:, 1] * across[:, 0]
    return np.where(np.isnan(side), np.nan, side < 0)
