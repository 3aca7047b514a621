"""Points that jump: a tracker that took something else for the point, for a frame or two."""

from dataclasses import replace

import numpy as np

from suchus.capture.tracks import Tracks

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
