"""Left and right: whether the feet lie on the side that their names say."""

import numpy as np

from suchus.capture.tracks import Tracks, UnusableTracks

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
