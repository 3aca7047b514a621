"""Plausibility of keypoints: tracks are compared with what a body can do, and faults are named.

Neighbours on the midline keep their distance and their order. Feet stay within reach of their girdles. No point jumps
from one frame to the next. A keypoint that violates this throughout is left out. One that violates it in some frames is
treated as lost there, and a sentence reports it. Faults that only the user can correct, such as exchanged names, are
refused.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from suchus.animals.capture.exchange import find_exchange, names_option
from suchus.animals.capture.tracks import MAX_LOST_FRACTION, Tracks, UnusableTracks
from suchus.robot.design import LEGS

_SWAY = 0.1  # fraction of its length by which a link between neighbours may vary: skin slides over bones
_NOISES = 4.0  # standard deviations of noise by which it may vary in addition
_ASTRAY = 0.25  # the same fraction in a single frame
_FOLDED = 0.5  # the same fraction for points that are not neighbours: a body that bends by two radians between them
_ROUNDS = 4  # greatest number of stray keypoints in one frame that can be identified
_STRAY_WINDOW = 25  # frames whose stray keypoints decide between two that may be the stray one in a frame
_MIN_REPORT_FRACTION = 0.02  # fraction of frames with jumps or strays from which on a keypoint is reported
_SHAKES = 3.0  # noise over the usual noise from which on a keypoint is reported
_QUIET = 0.003  # [trunk]; noise that is never reported
_HIDES = 0.15  # [trunk]; noise that hides all motion
_MAX_LINK_NOISE = 0.5  # [link]; noise that hides the direction of a link
_MIN_STUCK_FRACTION = 0.9  # fraction of frames in which a stuck coordinate repeats the last one
_MAX_REPEATED_FRACTION = 0.5  # greatest such fraction of most other keypoints
_MIN_FILM_NOISE = 5e-4  # [trunk]; least noise of what a camera has seen
_MIN_WALKING_FRAMES = 20  # frames of a moving animal; with fewer, all frames count
_MIN_ACTIVITY = 0.3  # displacement of keypoints from frame to frame over its 80th percentile, if the animal moves
_REACH = 2.0  # [trunk]; greatest median distance of a foot from its girdle
_STRETCHED = 2.0  # greatest distance of a foot from its girdle over the median distance
_MAX_LIMB = 1.2  # [trunk]; distance of a foot from its girdle that a long limb at the end of its stance has
_STANDS = 0.15  # [trunk]; least displacement of a body that walks


class Screened(NamedTuple):
    """Plausible tracks, and the faults of the others."""

    tracks: Tracks
    """Without the keypoints that are wrong throughout; others are lost where they are wrong."""
    wrong: Mapping[str, str]
    """Of each keypoint that was left out what is wrong with it: the rest of a sentence that begins with its name."""
    notes: tuple[str, ...]
    """What else was found, a sentence each, which names the keypoints."""


def screen_tracks(tracks: Tracks) -> Screened:
    """Return the plausible part of tracks.

    Raises:
        UnusableTracks: names of keypoints are exchanged, those that are left do not show where the trunk heads, or the
            animal stands.
    """
    source, faults, notes = tracks, _lost_keypoints(tracks), []
    tracks = _trusted_tracks(source, faults)
    noise = {name: _noise(tracks.at(name)) for name in tracks.points}
    if not _scale(tracks) > 0.0:
        raise UnusableTracks(
            f"in {tracks.source} the keypoints of the trunk lie at one place, so that nobody knows where the body "
            "heads; track them again."
        )
    faults |= _stuck_keypoints(tracks, noise)
    tracks = _trusted_tracks(source, faults)
    scale = _scale(tracks)
    faults |= _shaky_keypoints(tracks, noise, scale)
    tracks = _trusted_tracks(source, faults)
    walking = _walking_frames(tracks)
    tracks, leaps = _without_jumps(tracks, scale, walking)
    _check_exchanged(tracks, noise, scale, walking)
    faults |= _unsteady(tracks, noise, scale)
    tracks = _trusted_tracks(source, faults, tracks)
    faults |= _unreachable_feet(tracks, scale)
    tracks = _trusted_tracks(source, faults, tracks)
    tracks, strays = _without_strays(tracks, noise, scale)
    faults |= _lost_keypoints(tracks, "is elsewhere than its neighbours allow, or lost,")
    tracks = _trusted_tracks(source, faults, tracks)
    if tracks.view == "top":
        faults |= _astride(tracks, scale)
        tracks = _trusted_tracks(source, faults, tracks)
        _check_sides(tracks)
    _check_moves(tracks, noise, scale)
    notes += _frame_notes("leap and are left out there", leaps, tracks)
    notes += _frame_notes("are not where their neighbours allow and are left out there", strays, tracks)
    notes += _noisy(tracks, noise, scale)
    return Screened(tracks, faults, tuple(notes))


def _trusted_tracks(source: Tracks, faults: Collection[str], tracks: Tracks | None = None) -> Tracks:
    """Return the tracks without faulty keypoints; the rest must show the direction of the trunk."""
    trusted_tracks = (tracks or source).without(faults)
    if len(trusted_tracks.trunk_chain) < 2:
        reason_text = _reason_text(faults) if isinstance(faults, Mapping) else ""
        raise UnusableTracks(
            f"in {source.source} too few keypoints of the trunk can be trusted to see where the body heads: "
            f"{reason_text or 'track them again'}."
        )
    return trusted_tracks


def _reason_text(faults: Mapping[str, str]) -> str:
    """Return what is wrong with keypoints; those with the same fault share a clause."""
    names_by_reason: dict[str, list[str]] = {}
    for name, reason in faults.items():
        names_by_reason.setdefault(reason, []).append(name)
    return "; ".join(
        f"{names[0]} {reason}" if len(names) == 1 else f"each of {', '.join(names)} {reason}"
        for reason, names in names_by_reason.items()
    )


def _lost_keypoints(tracks: Tracks, phrase: str = "is lost") -> dict[str, str]:
    """Return the keypoints that are hardly ever seen."""
    lost_fractions = {name: float(np.mean(np.isnan(tracks.at(name)).any(axis=-1))) for name in tracks.points}
    return {
        name: f"{phrase} in {100 * lost_fraction:.0f} % of the frames; at most {100 * MAX_LOST_FRACTION:.0f} % may "
        f"be: track it "
        "again, or ask for less with --confidence"
        for name, lost_fraction in lost_fractions.items()
        if lost_fraction > MAX_LOST_FRACTION
    }


def _stuck_keypoints(tracks: Tracks, noise: Mapping[str, float]) -> dict[str, str]:
    """Return the keypoints with a coordinate that stays exactly the same, while noise moves those of the others.

    In a film without noise, such as a simulation, a keypoint may go exactly along an axis.
    """
    typical_noise = float(np.median([level for level in noise.values() if np.isfinite(level)] or [0.0]))
    if typical_noise <= _MIN_FILM_NOISE * _scale(tracks):
        return {}
    repeated = np.full(tracks.position.shape[1:], np.nan)  # fraction of frames, by keypoint and axis
    for i, j in np.ndindex(*repeated.shape):
        series = tracks.position[:, i, j]
        series = series[np.isfinite(series)]
        if len(series) >= _MIN_WALKING_FRAMES:
            repeated[i, j] = np.mean(np.diff(series) == 0.0)
    faults = {}
    for i, name in enumerate(tracks.points):
        for j, axis in enumerate("xyz"[: tracks.position.shape[-1]]):
            others = np.delete(repeated[:, j], i)
            others = others[np.isfinite(others)]
            is_alone = len(others) > 1 and np.mean(others < _MAX_REPEATED_FRACTION) > _MAX_REPEATED_FRACTION
            if repeated[i, j] > _MIN_STUCK_FRACTION and is_alone:
                faults[name] = (
                    f"is stuck: its {axis} stays the same in {100 * repeated[i, j]:.0f} % of the frames; track it "
                    "again, unless the picture was shifted to hold it at one place"
                )
    return faults


def _noise(place: np.ndarray) -> float:
    """Return the standard deviation of a coordinate from frame to frame [m or px]; NaN if too little is seen.

    Each position is compared with the cubic through the two positions before and the two after it.
    """
    if len(place) < 5:
        return float("nan")
    deviation = place[2:-2] - (4 * (place[1:-3] + place[3:-1]) - place[:-4] - place[4:]) / 6
    abs_deviation = np.abs(deviation[np.isfinite(deviation)])
    return float(1.4826 * np.median(abs_deviation) / np.sqrt(70 / 36)) if len(abs_deviation) >= 4 else float("nan")


def _scale(tracks: Tracks) -> float:
    """Return an estimate of the trunk's length that does not depend on any single keypoint [m or px].

    It is the median of the trunk's chord, of the number of its links times the median of all links, and of the distance
    between the middles of front feet and hind feet, as far as they were tracked.
    """
    chain = tracks.midline
    links = [float(np.nanmedian(_distance(tracks, a, b))) for a, b in pairwise(chain)]
    front, rear = tracks.line
    estimates = [float(np.median(links)) * max(1, chain.index(rear) - chain.index(front))]
    estimates.append(float(np.nanmedian(_distance(tracks, front, rear))))
    front_feet = [tracks.at(leg) for leg in tracks.legs if leg.endswith("F")]
    hind_feet = [tracks.at(leg) for leg in tracks.legs if leg.endswith("H")]
    if front_feet and hind_feet:
        feet_vector = np.mean(front_feet, axis=0) - np.mean(hind_feet, axis=0)
        feet_distance = float(np.nanmedian(np.linalg.norm(feet_vector, axis=-1)))
        estimates = [*estimates, feet_distance] if tracks.has("shoulder", "hip") else [feet_distance]
    return float(np.nanmedian(estimates))


def _walking_frames(tracks: Tracks) -> Bool[np.ndarray, " frame"]:
    """Return the frames in which most keypoints move, or all frames where noise hides that."""
    step = max(1, round(len(tracks.time) / 200))
    displacement = np.full(len(tracks.time), np.nan)
    distances = np.linalg.norm(tracks.position[step:] - tracks.position[:-step], axis=-1)
    has_points = np.isfinite(distances).any(axis=1)
    displacement[step:][has_points] = np.nanmedian(distances[has_points], axis=1)
    if not np.isfinite(displacement).any():
        return np.ones(len(tracks.time), dtype=bool)
    with np.errstate(invalid="ignore"):
        is_walking = np.asarray(displacement >= _MIN_ACTIVITY * np.nanpercentile(displacement, 80))
    return is_walking if is_walking.sum() >= _MIN_WALKING_FRAMES else np.ones(len(tracks.time), dtype=bool)


def _distance(tracks: Tracks, first_point: str, second_point: str) -> Float[np.ndarray, " frame"]:
    return np.asarray(np.linalg.norm(tracks.at(first_point) - tracks.at(second_point), axis=-1))


def _typical_noise(noise: Mapping[str, float], scale: float) -> float:
    finite_levels = [level for level in noise.values() if np.isfinite(level)]
    return max(float(np.median(finite_levels)) if finite_levels else 0.0, _QUIET * scale)


def _shaky_keypoints(tracks: Tracks, noise: Mapping[str, float], scale: float) -> dict[str, str]:
    """Return the keypoints whose noise hides their motion, while others are seen well.

    Args:
        tracks: the keypoints.
        noise: noise of each keypoint, by its name [m or px].
        scale: length of the trunk [m or px].
    """
    chain, typical_noise = tracks.midline, _typical_noise(noise, scale)
    link = float(np.median([np.nanmedian(_distance(tracks, a, b)) for a, b in pairwise(chain)]))
    faults = {}
    for name in tracks.points:
        max_noise = min(_HIDES * scale, _MAX_LINK_NOISE * link) if name in chain else _HIDES * scale
        if noise[name] > max(max_noise, _SHAKES * typical_noise):
            faults[name] = (
                f"shakes by {_length(noise[name], tracks)} from frame to frame, others by "
                f"{_length(typical_noise, tracks)}: track it again"
            )
    return faults


def _noisy(tracks: Tracks, noise: Mapping[str, float], scale: float) -> list[str]:
    """Return a sentence that names keypoints with much more noise than usual."""
    typical_noise = _typical_noise(noise, scale)
    loud = [name for name in tracks.points if noise[name] > _SHAKES * typical_noise]
    shakes = ", ".join(f"{name} by {_length(noise[name], tracks)}" for name in loud)
    text = f"{shakes}, the others by {_length(typical_noise, tracks)} or less; intervals are as wide as that makes them"
    return [f"more noise than usual from frame to frame: {text}"] if loud else []


def _length(value: float, tracks: Tracks) -> str:
    return f"{value:.2g} px" if tracks.unit == "px" else f"{1000 * value:.2g} mm"


class _Links:
    """Distances between neighbours on the midline, and between every second point, frame by frame."""

    def __init__(self, tracks: Tracks, noise: Mapping[str, float], scale: float) -> None:
        self._tracks, self._noise, self._scale = tracks, noise, scale
        self._distances: dict[tuple[str, str], np.ndarray] = {}

    def pairs(self, chain: Sequence[str]) -> list[tuple[str, str]]:
        return [*pairwise(chain), *zip(chain[:-2], chain[2:], strict=True)]

    def distance(self, pair: tuple[str, str]) -> np.ndarray:
        if pair not in self._distances:
            self._distances[pair] = _distance(self._tracks, *pair)
        return self._distances[pair]

    def max_deviation(self, pair: tuple[str, str], fraction: float) -> float:
        """Return the tolerance for the distance of a pair about its median."""
        noises = np.nan_to_num([self._noise[name] for name in pair])
        typical_distance = float(np.nanmedian(self.distance(pair)))
        if "tail_tip" not in pair:  # a tail without keypoints between bends, and may be longer than the trunk
            typical_distance = min(typical_distance, self._scale)
        return float(fraction * typical_distance + _NOISES * np.hypot(*noises)) + 1e-9

    def excess(self, pair: tuple[str, str]) -> float:
        """Return the spread of a pair's distance over its tolerance, minus one; 0 within the tolerance [-]."""
        distance = self.distance(pair)
        spread = float(1.4826 * np.nanmedian(np.abs(distance - np.nanmedian(distance))))
        return max(0.0, spread / self.max_deviation(pair, _SWAY) - 1.0)

    def strays(self, pair: tuple[str, str], fraction: float = _ASTRAY) -> Bool[np.ndarray, " frame"]:
        """Return the frames in which the distance of a pair differs from its median by more than a tolerance."""
        distance = self.distance(pair)
        with np.errstate(invalid="ignore"):
            return np.abs(distance - np.nanmedian(distance)) > self.max_deviation(pair, fraction)


def _unsteady(tracks: Tracks, noise: Mapping[str, float], scale: float) -> dict[str, str]:
    """Return the fewest midline points that explain all varying distances between neighbours.

    Raises:
        UnusableTracks: it cannot be told which ones are wrong.
    """
    links, chain, faults = _Links(tracks, noise, scale), list(tracks.midline), dict[str, str]()
    while True:
        excess = {pair: links.excess(pair) for pair in links.pairs(chain)}
        if not any(excess[pair] for pair in pairwise(chain)):
            return faults
        blame = {name: [excess[pair] for pair in excess if name in pair] for name in chain}
        score = {
            name: (sum(pair_excess > 0 for pair_excess in pair_excesses), sum(pair_excesses))
            for name, pair_excesses in blame.items()
        }
        worst_point = max(chain, key=lambda name: score[name])
        a, b = max((pair for pair in pairwise(chain) if excess[pair]), key=lambda pair: excess[pair])
        if len(chain) <= 3 or len(faults) > len(tracks.midline) // 3:
            names = " and ".join(dict.fromkeys((*faults, a, b)))
            raise UnusableTracks(
                f"in {tracks.source} the keypoints {names} do not belong to one body: the distance of {a} and {b} "
                f"varies by {_length(links.max_deviation((a, b), _SWAY) * (1 + excess[a, b]), tracks)}; track them "
                "again."
            )
        faults[worst_point] = (
            "does not move with its neighbours: its distance from "
            f"{' and '.join(midline_neighbours(chain, worst_point))} does not stay; track it again"
        )
        chain.remove(worst_point)


def midline_neighbours(chain: Sequence[str], name: str) -> list[str]:
    """Return the neighbours of a keypoint on the midline, the front one first."""
    index = chain.index(name)
    return [chain[i] for i in (index - 1, index + 1) if 0 <= i < len(chain)]


def _check_exchanged(tracks: Tracks, noise: Mapping[str, float], scale: float, walking: np.ndarray) -> None:
    """Refuse tracks in which names of keypoints are exchanged.

    Raises:
        UnusableTracks: it names them, and the option that gives them their right names.
    """
    exchange = find_exchange(tracks, noise, scale, walking)
    if exchange:
        names = list(exchange.names)
        raise UnusableTracks(
            f"in {tracks.source} the {'feet' if set(names) <= set(LEGS) else 'keypoints'} {' and '.join(names)} are "
            f"exchanged: {exchange.reason}; give {names_option(exchange.names)}."
        )


_MEDIAN_HALF_WINDOW = 3  # frames on either side in the window of the median
_MIN_JUMP = 0.2  # [trunk]; smaller deviations are noise
_JUMP_FACTOR, _JUMP_PERCENTILE = 3.0, 90.0  # jump over this percentile of the deviations


def _without_jumps(tracks: Tracks, scale: float, walking: np.ndarray) -> tuple[Tracks, dict[str, np.ndarray]]:
    """Return the tracks without points that jumped, and the frames of the jumps by keypoint.

    A jump is a distance of more than a fifth of the trunk from the median of the seven frames around it. It must also
    exceed three times the distance that 90 % of the frames with movement stay below, so that a fast foot in a slow film
    is no jump. This is Hampel's identifier with a quantile that is valid for a foot that rests most of the time. Longer
    faults, such as two exchanged feet, are no jumps.
    """
    position = tracks.position.copy()
    padded = np.pad(position, ((_MEDIAN_HALF_WINDOW, _MEDIAN_HALF_WINDOW), (0, 0), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _MEDIAN_HALF_WINDOW + 1, axis=0)
    seen_count = np.isfinite(windows).all(axis=2).sum(axis=-1)  # (frame, point)
    median_position = np.full_like(position, np.nan)
    has_median = seen_count >= _MEDIAN_HALF_WINDOW
    median_position[has_median] = np.nanmedian(windows[has_median], axis=-1)
    deviation = np.linalg.norm(position - median_position, axis=-1)
    jumps = {}
    for i, name in enumerate(tracks.points):
        point_deviation = deviation[:, i]
        jumps[name] = np.zeros(len(point_deviation), dtype=bool)
        if np.isfinite(point_deviation[walking]).any():
            usual_deviation = float(np.nanpercentile(point_deviation[walking], _JUMP_PERCENTILE))
            jumps[name] = point_deviation > max(_MIN_JUMP * scale, _JUMP_FACTOR * usual_deviation)
            position[jumps[name], i] = np.nan
    return replace(tracks, position=position), jumps


def _without_strays(tracks: Tracks, noise: Mapping[str, float], scale: float) -> tuple[Tracks, dict[str, np.ndarray]]:
    """Return the tracks without midline points at a wrong distance from neighbours, and their frames by keypoint.

    In every frame the point with most wrong distances is removed, then the next. Feet much farther from their girdles
    than usual are removed too. Distances between every second point reveal a point that passed its neighbour.
    """
    links, chain = _Links(tracks, noise, scale), tracks.midline
    pairs = links.pairs(chain)
    bad = np.array([links.strays(pair) for pair in pairs])
    member = np.array([[name in pair for name in chain] for pair in pairs], dtype=float)
    adjacent = np.array([pair in set(pairwise(chain)) for pair in pairs])
    surely = np.array([bad[i] if adjacent[i] else links.strays(pair, _FOLDED) for i, pair in enumerate(pairs)])
    is_stray = np.zeros((len(chain), len(tracks.time)), dtype=bool)
    window = np.ones(min(_STRAY_WINDOW, len(tracks.time)))
    window /= len(window)
    for _ in range(_ROUNDS):
        frames = np.flatnonzero(surely.any(axis=0))
        if not len(frames):
            break
        votes = member.T @ bad
        votes += 0.5 * votes / member.sum(axis=0)[:, None]  # of equals who is at fewer pairs
        votes += np.apply_along_axis(np.convolve, 1, votes, window, mode="same")  # and who is in frames around it
        worst_points = np.argmax(votes[:, frames], axis=0)
        is_stray[worst_points, frames] = True
        bad[:, frames] &= member[:, worst_points] == 0
        surely[:, frames] &= member[:, worst_points] == 0
    position, strays = tracks.position.copy(), dict(zip(chain, is_stray, strict=True))
    for leg in tracks.legs:
        girdle = _girdle(tracks, leg)
        foot_distance = np.where(strays[girdle], np.nan, _distance(tracks, leg, girdle))
        with np.errstate(invalid="ignore"):
            max_distance = max(_STRETCHED * np.nanmedian(foot_distance), _MAX_LIMB * scale)
            strays[leg] = foot_distance > max_distance + _NOISES * np.nan_to_num(noise[leg])
    for name, frames in strays.items():
        position[frames, tracks.points.index(name)] = np.nan
    return replace(tracks, position=position), strays


def _girdle(tracks: Tracks, leg: str) -> str:
    """Return the point of the trunk that is nearest to the base of a limb."""
    front = leg.endswith("F")
    girdle_point = "shoulder" if front else "hip"
    return girdle_point if girdle_point in tracks.points else tracks.line[0 if front else 1]


def _frame_notes(phrase: str, frames: Mapping[str, np.ndarray], tracks: Tracks) -> list[str]:
    """Return a sentence on keypoints with a fault in more than a few frames; empty without one."""
    notes = []
    for name, is_affected in frames.items():
        if is_affected.mean() >= _MIN_REPORT_FRACTION / 4 and is_affected.sum() >= 3:
            first_time = tracks.time[np.argmax(is_affected)] if name in tracks.points else np.nan
            since = f", first at {first_time:.2f} s" if is_affected.mean() >= _MIN_REPORT_FRACTION else ""
            notes.append(f"{name} in {100 * is_affected.mean():.1f} % of the frames{since}")
    return [f"keypoints that {phrase}: {'; '.join(notes)}"] if notes else []


def _unreachable_feet(tracks: Tracks, scale: float) -> dict[str, str]:
    """Return the feet that are usually too far from their girdles."""
    faults = {}
    for leg in tracks.legs:
        girdle = _girdle(tracks, leg)
        distance = float(np.nanmedian(_distance(tracks, leg, girdle))) / scale
        if distance > _REACH:
            faults[leg] = (
                f"lies {distance:.1f} trunk lengths from {girdle}, farther than a limb reaches: track it again"
            )
    return faults


def _check_moves(tracks: Tracks, noise: Mapping[str, float], scale: float) -> None:
    """Refuse an animal that moves neither its trunk nor a foot.

    Raises:
        UnusableTracks: it stands.
    """
    names = (*tracks.line, *tracks.legs)
    moves = {name: np.nanpercentile(tracks.at(name), [2, 98], axis=0) for name in names}
    ranges = {
        name: float(np.linalg.norm(upper_bound - lower_bound)) for name, (lower_bound, upper_bound) in moves.items()
    }
    if all(ranges[name] < max(_STANDS * scale, 6 * np.nan_to_num(noise[name])) for name in names):
        raise UnusableTracks(
            f"in {tracks.source} the animal stands: in {tracks.time[-1] - tracks.time[0]:.1f} s no foot and no part of "
            f"the trunk moves by more than {max(ranges.values()) / scale:.2f} trunk lengths; cut out the part in which "
            "it walks, with --start and --end."
        )


_MAX_SIDE_OFFSET = 0.1  # [trunk]; greatest distance of a foot on the wrong side
_ALWAYS = 0.9  # fraction of frames that counts as always
_IN_A_ROW = 0.5  # fraction of successive frames among these; noise has less
_OFTEN = 0.1  # greatest fraction of frames with feet exchanged by noise
_SOMETIMES = 0.02  # fraction of frames that noise does not explain
_MIN_SWAPPED_FRAMES = 3  # least number of them; fewer are jumps
_CLEARLY = 0.3  # distance by which feet are across the body where they are exchanged, over their usual distance


def _check_sides(tracks: Tracks) -> None:
    """Refuse tracks in which a left foot lies right of its right neighbour, seen along the body.

    Raises:
        UnusableTracks: it names the pair, or says that the whole picture is mirrored, and gives the frames.
    """
    girdles = {("LF", "RF"): tracks.thorax, ("LH", "RH"): tracks.pelvis}
    pairs = {pair: girdle or tracks.line for pair, girdle in girdles.items() if tracks.has(*pair)}
    offsets = {pair: _left_offset(tracks, *pair, *segment) for pair, segment in pairs.items()}
    offsets = {pair: offset for pair, offset in offsets.items() if np.isfinite(offset).any()}
    shares = {pair: float(np.mean(offset[np.isfinite(offset)] < 0)) for pair, offset in offsets.items()}
    if len(shares) == 2 and min(shares.values()) > _ALWAYS:
        raise UnusableTracks(
            f"in {tracks.source} LF and LH lie on the right of the body, RF and RH on the left: left and right are "
            "swapped in both pairs, or y points the other way; rename the feet, or give --y-axis up or down "
            "(images have it down)."
        )
    for (left_leg, right_leg), share in shares.items():
        if share > _ALWAYS:
            raise UnusableTracks(
                f"in {tracks.source} {left_leg} lies on the right of the body and {right_leg} on the left, in "
                f"{100 * share:.0f} % of the frames: left and right of this pair are swapped; give --names "
                f"{left_leg}={right_leg} {right_leg}={left_leg}."
            )
        if share > _SOMETIMES:
            offset = offsets[left_leg, right_leg]
            with np.errstate(invalid="ignore"):
                frames = np.flatnonzero(offset < -_CLEARLY * np.nanmedian(np.abs(offset)))
            min_frames = max(_MIN_SWAPPED_FRAMES, _SOMETIMES * len(offset))
            if len(frames) < min_frames or np.mean(np.diff(frames) == 1) < _IN_A_ROW:
                _check_noise(tracks, left_leg, right_leg, share)
                continue
            raise UnusableTracks(
                f"in {tracks.source} {left_leg} and {right_leg} are swapped in {len(frames)} frames, first in frame "
                f"{frames[0] + 1} at {tracks.time[frames[0]]:.2f} s and last in frame {frames[-1] + 1}: exchange "
                "them there."
            )


def _astride(tracks: Tracks, scale: float) -> dict[str, str]:
    """Return the feet that lie on the other side of the body, while their partners are where they belong."""
    front, rear = tracks.line
    trunk_axis = tracks.at(front) - tracks.at(rear)
    trunk_axis = trunk_axis / np.linalg.norm(trunk_axis, axis=-1, keepdims=True)
    lateral_offsets = {}
    for leg in tracks.legs:
        d = tracks.at(leg) - tracks.at(rear)
        left_offset = float(np.nanmedian(trunk_axis[:, 0] * d[:, 1] - trunk_axis[:, 1] * d[:, 0])) / scale
        lateral_offsets[leg] = left_offset if leg.startswith("L") else -left_offset
    faults = {}
    for leg in tracks.legs:
        partner = {"L": "R", "R": "L"}[leg[0]] + leg[1]
        if lateral_offsets[leg] < -_MAX_SIDE_OFFSET and lateral_offsets.get(partner, 1.0) > 0.0:
            side = "right" if leg.startswith("L") else "left"
            faults[leg] = (
                f"lies on the {side} of the body, {-lateral_offsets[leg]:.2f} trunk lengths off: track it again"
            )
    return faults


def _check_noise(tracks: Tracks, left_leg: str, right_leg: str, fraction: float) -> None:
    """Refuse feet that change sides in many frames."""
    if fraction > _OFTEN:
        raise UnusableTracks(
            f"in {tracks.source} {left_leg} lies right of {right_leg} in {100 * fraction:.1f} % of the frames, "
            f"now here and now there; up to {100 * _OFTEN:.0f} % is allowed: noise hides the feet; "
            "track them again, or film nearer."
        )


def _left_offset(tracks: Tracks, left_leg: str, right_leg: str, front: str, rear: str) -> np.ndarray:
    """Return how far the left foot lies left of the right one in each frame, NaN where lost [m or px]."""
    trunk_vector = tracks.at(front) - tracks.at(rear)
    lateral_vector = tracks.at(left_leg) - tracks.at(right_leg)
    side = trunk_vector[:, 0] * lateral_vector[:, 1] - trunk_vector[:, 1] * lateral_vector[:, 0]
    return np.asarray(side / np.linalg.norm(trunk_vector[:, :2], axis=-1))
