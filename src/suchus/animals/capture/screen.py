"""Which keypoints are to be trusted: what was tracked is held against what a body can do, and what is wrong is named.

Neighbours on the midline keep their distance and follow each other from front to back; feet stay within reach of their
girdles; from one frame to the next nothing leaps. A keypoint that breaks this throughout is left out, one that does so
in some frames is lost there, and a sentence says so. What only the user can mend, as two keypoints whose names are
exchanged, is refused.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise, permutations
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from suchus.animals.capture.tracks import LOST, Tracks, UnusableTracks

_SWAY = 0.1  # share of its length by which a link between neighbours may vary: skin slides over bones
_NOISES = 4.0  # standard deviations of noise that it may vary beyond that
_ASTRAY = 0.25  # the same share in a single frame
_FOLDED = 0.5  # the same of points that are not neighbours: a body that bends by two radians between them
_ROUNDS = 4  # keypoints that may be elsewhere in one frame, and still be told from the others
_TOLD = 0.02  # share of the frames in which a keypoint leaps or is elsewhere from which on it is named
_SHAKES = 3.0  # times the usual noise from which on a keypoint is named
_QUIET = 0.003  # [trunk]; noise that is never named
_HIDES = 0.15  # [trunk]; noise in which nothing is seen
_BLUNT = 0.5  # [link]; noise from which on a link has no direction
_SHORTER = 0.03  # share by which the midline must be shorter if two points change their names
_LONGER = 1.3  # times the midline without two points; with points that belong to it, it is hardly longer
_NEARER = 0.25  # [trunk]; how much nearer feet must be to their girdles if they do
_REACH = 2.0  # [trunk]; no foot is usually farther from its girdle
_STRETCHED = 2.0  # times its usual distance from its girdle; a foot that is farther off is elsewhere
_STANDS = 0.15  # [trunk]; a body that goes and comes by less, over a whole film, stands


class Screened(NamedTuple):
    """Tracks that can be trusted, and what was found to be wrong."""

    tracks: Tracks
    """Without the keypoints that are wrong throughout; others are lost where they are wrong."""
    wrong: Mapping[str, str]
    """Of each keypoint that was left out what is wrong with it: the rest of a sentence that begins with its name."""
    notes: tuple[str, ...]
    """What else was found, a sentence each, which names the keypoints."""


def screened(tracks: Tracks) -> Screened:
    """Return what can be trusted of tracks.

    Raises:
        UnusableTracks: names of keypoints are exchanged, those that are left do not show where the trunk heads, or the
            animal stands.
    """
    source, wrong, notes = tracks, _lost(tracks), []
    tracks = _left(source, wrong)
    noise = {name: _noise(tracks.at(name)) for name in tracks.points}
    scale = _scale(tracks)
    wrong |= _shaken(tracks, noise, scale)
    tracks = _left(source, wrong)
    unsteady = _unsteady(tracks, noise, scale)
    _check_exchanged(tracks, unsteady, noise, scale)
    wrong |= unsteady
    tracks = _left(source, wrong)
    wrong |= _out_of_reach(tracks, scale)
    tracks = _left(source, wrong)
    _check_order(tracks, scale)
    tracks, leaps = _without_jumps(tracks, scale)
    tracks, strays = _without_strays(tracks, noise, scale)
    wrong |= _lost(tracks, "is elsewhere than its neighbours allow, or lost,")
    tracks = _left(source, wrong, tracks)
    if tracks.view == "top":
        wrong |= _astride(tracks, scale)
        tracks = _left(source, wrong, tracks)
        _check_sides(tracks)
    _check_moves(tracks, noise, scale)
    notes += _named("leap and are left out there", leaps, tracks)
    notes += _named("are not where their neighbours allow and are left out there", strays, tracks)
    notes += _noisy(tracks, noise, scale)
    return Screened(tracks, wrong, tuple(notes))


def _left(source: Tracks, wrong: Collection[str], tracks: Tracks | None = None) -> Tracks:
    """Return the tracks of the keypoints that are not wrong; those that are left must show where the trunk heads."""
    left = (tracks or source).without(wrong)
    if len(left.trunk_chain) < 2:
        said = "; ".join(f"{name} {why}" for name, why in wrong.items()) if isinstance(wrong, Mapping) else ""
        raise UnusableTracks(
            f"in {source.source} too few keypoints of the trunk can be trusted to see where the body heads: {said}; "
            "track them again."
        )
    return left


def _lost(tracks: Tracks, how: str = "is lost") -> dict[str, str]:
    """Return the keypoints that are hardly ever seen."""
    share = {name: float(np.mean(np.isnan(tracks.at(name)).any(axis=-1))) for name in tracks.points}
    return {
        name: f"{how} in {100 * lost:.0f} % of the frames; at most {100 * LOST:.0f} % may be: track it again, or lower "
        "the confidence that is asked for"
        for name, lost in share.items()
        if lost > LOST
    }


def _noise(place: np.ndarray) -> float:
    """Return the standard deviation of a coordinate from frame to frame [m or px]; NaN where too little is seen.

    Each place is held against the cubic through the two before and the two after, which a body follows.
    """
    if len(place) < 5:
        return float("nan")
    apart = place[2:-2] - (4 * (place[1:-3] + place[3:-1]) - place[:-4] - place[4:]) / 6
    seen = np.abs(apart[np.isfinite(apart)])
    return float(1.4826 * np.median(seen) / np.sqrt(70 / 36)) if len(seen) >= 4 else float("nan")


def _scale(tracks: Tracks) -> float:
    """Return about how long the trunk is, whatever one keypoint does [m or px]."""
    chain = tracks.midline
    links = [float(np.nanmedian(_apart(tracks, a, b))) for a, b in pairwise(chain)]
    front, rear = tracks.line
    return float(np.median(links)) * max(1, chain.index(rear) - chain.index(front))


def _apart(tracks: Tracks, one: str, other: str) -> Float[np.ndarray, " frame"]:
    return np.asarray(np.linalg.norm(tracks.at(one) - tracks.at(other), axis=-1))


def _usual(noise: Mapping[str, float], scale: float) -> float:
    known = [one for one in noise.values() if np.isfinite(one)]
    return max(float(np.median(known)) if known else 0.0, _QUIET * scale)


def _shaken(tracks: Tracks, noise: Mapping[str, float], scale: float) -> dict[str, str]:
    """Return the keypoints whose noise hides what they do, while others are seen well."""
    chain, usual = tracks.midline, _usual(noise, scale)
    link = float(np.median([np.nanmedian(_apart(tracks, a, b)) for a, b in pairwise(chain)]))
    found = {}
    for name in tracks.points:
        most = min(_HIDES * scale, _BLUNT * link) if name in chain else _HIDES * scale
        if noise[name] > max(most, _SHAKES * usual):
            found[name] = (
                f"shakes by {_length(noise[name], tracks)} from frame to frame, others by {_length(usual, tracks)}: "
                "track it again"
            )
    return found


def _noisy(tracks: Tracks, noise: Mapping[str, float], scale: float) -> list[str]:
    """Name the keypoints that are seen much worse than others."""
    usual = _usual(noise, scale)
    loud = [name for name in tracks.points if noise[name] > _SHAKES * usual]
    shakes = ", ".join(f"{name} by {_length(noise[name], tracks)}" for name in loud)
    told = f"{shakes}, the others by {_length(usual, tracks)} or less; intervals are as wide as that makes them"
    return [f"more noise than usual from frame to frame: {told}"] if loud else []


def _length(value: float, tracks: Tracks) -> str:
    return f"{value:.2g} px" if tracks.unit == "px" else f"{1000 * value:.2g} mm"


class _Links:
    """The distances between neighbours on the midline, and between every other one, frame by frame."""

    def __init__(self, tracks: Tracks, noise: Mapping[str, float], scale: float) -> None:
        self._tracks, self._noise, self._scale = tracks, noise, scale
        self._known: dict[tuple[str, str], np.ndarray] = {}

    def pairs(self, chain: Sequence[str]) -> list[tuple[str, str]]:
        return [*pairwise(chain), *zip(chain[:-2], chain[2:], strict=True)]

    def apart(self, pair: tuple[str, str]) -> np.ndarray:
        if pair not in self._known:
            self._known[pair] = _apart(self._tracks, *pair)
        return self._known[pair]

    def most(self, pair: tuple[str, str], share: float) -> float:
        """Return by how much the distance of a pair may differ from what it usually is."""
        noises = np.nan_to_num([self._noise[name] for name in pair])
        usual = min(float(np.nanmedian(self.apart(pair))), self._scale)
        return float(share * usual + _NOISES * np.hypot(*noises)) + 1e-9

    def excess(self, pair: tuple[str, str]) -> float:
        """Return how far the distance of a pair varies beyond what it may, in units of that; 0 where it does not."""
        seen = self.apart(pair)
        spread = float(1.4826 * np.nanmedian(np.abs(seen - np.nanmedian(seen))))
        return max(0.0, spread / self.most(pair, _SWAY) - 1.0)

    def strays(self, pair: tuple[str, str], share: float = _ASTRAY) -> Bool[np.ndarray, " frame"]:
        """Return in which frames the distance of a pair is not what it usually is, by more than a share of it."""
        seen = self.apart(pair)
        with np.errstate(invalid="ignore"):
            return np.abs(seen - np.nanmedian(seen)) > self.most(pair, share)


def _unsteady(tracks: Tracks, noise: Mapping[str, float], scale: float) -> dict[str, str]:
    """Return the midline points that do not keep their distance from their neighbours: the fewest that explain it.

    Raises:
        UnusableTracks: it cannot be told which ones are wrong.
    """
    links, chain, found = _Links(tracks, noise, scale), list(tracks.midline), dict[str, str]()
    while True:
        excess = {pair: links.excess(pair) for pair in links.pairs(chain)}
        if not any(excess[pair] for pair in pairwise(chain)):
            return found
        blame = {name: [excess[pair] for pair in excess if name in pair] for name in chain}
        score = {name: (sum(one > 0 for one in each), sum(each)) for name, each in blame.items()}
        worst = max(chain, key=lambda name: score[name])
        a, b = max((pair for pair in pairwise(chain) if excess[pair]), key=lambda pair: excess[pair])
        if len(chain) <= 3 or len(found) > len(tracks.midline) // 3:
            named = " and ".join(dict.fromkeys((*found, a, b)))
            raise UnusableTracks(
                f"in {tracks.source} the keypoints {named} do not belong to one body: the distance of {a} and {b} "
                f"varies by {_length(links.most((a, b), _SWAY) * (1 + excess[a, b]), tracks)}; track them again."
            )
        found[worst] = (
            "does not move with its neighbours: its distance from "
            f"{' and '.join(beside(chain, worst))} does not stay; track it again"
        )
        chain.remove(worst)


def beside(chain: Sequence[str], name: str) -> list[str]:
    """Return the neighbours of a keypoint on the midline, the front one first."""
    at = chain.index(name)
    return [chain[i] for i in (at - 1, at + 1) if 0 <= i < len(chain)]


def _check_exchanged(source: Tracks, wrong: Mapping[str, str], noise: Mapping[str, float], scale: float) -> None:
    """Refuse tracks in which a midline point that is wrong would be right under the name of another one.

    Raises:
        UnusableTracks: it names both.
    """
    for name, other in ((one, two) for one in wrong for two in (*wrong, *source.legs) if one != two):
        position = source.position.copy()
        i, j = source.points.index(name), source.points.index(other)
        position[:, [i, j]] = position[:, [j, i]]
        mended = replace(source, position=position).without([one for one in wrong if one not in (name, other)])
        theirs = {**noise, name: noise[other], other: noise[name]}
        links, chain = _Links(mended, theirs, scale), mended.midline
        mine = [pair for pair in links.pairs(chain) if {name, other} & set(pair)]
        if other not in chain and np.nanmedian(_apart(mended, other, _girdle(mended, other))) > _REACH * scale:
            continue
        straight = _chain_length(mended) < _LONGER * _chain_length(mended.without((name, other)))
        if straight and not any(links.excess(pair) for pair in mine):
            raise UnusableTracks(
                f"in {source.source} the keypoints {name} and {other} are exchanged: each keeps its distance from the "
                f"neighbours of the other; give --names {name}={other} {other}={name}."
            )


def _chain_length(tracks: Tracks) -> float:
    return sum(float(np.nanmedian(_apart(tracks, a, b))) for a, b in pairwise(tracks.midline))


def _check_order(tracks: Tracks, scale: float) -> None:
    """Refuse tracks in which two keypoints are exchanged: the midline would be shorter, or feet nearer to girdles.

    Raises:
        UnusableTracks: it names both.
    """
    chain = tracks.midline
    apart = {frozenset(pair): float(np.nanmedian(_apart(tracks, *pair))) for pair in combinations(tracks.points, 2)}

    def long(names: Sequence[str]) -> float:
        return sum(apart[frozenset(pair)] for pair in pairwise(names))

    whole, best, names = long(chain), np.inf, ("", "")
    for a, b in combinations((*chain, *tracks.legs), 2):
        if a in chain:
            other = long([{a: b, b: a}.get(name, name) for name in chain])
            if other < best:
                best, names = other, (a, b)
    if best < (1 - _SHORTER) * whole:
        raise UnusableTracks(
            f"in {tracks.source} the keypoints {names[0]} and {names[1]} are exchanged: with their names changed the "
            f"midline is {100 * (1 - best / whole):.0f} % shorter; give --names {names[0]}={names[1]} "
            f"{names[1]}={names[0]}."
        )
    girdles = {leg: "shoulder" if leg.endswith("F") else "hip" for leg in tracks.legs}
    if len(tracks.legs) < 2 or not tracks.has("shoulder", "hip"):
        return
    cost = {(leg, girdle): apart[frozenset((leg, girdle))] for leg in tracks.legs for girdle in ("shoulder", "hip")}
    mine = sum(cost[leg, girdles[leg]] for leg in tracks.legs)
    orders = [dict(zip(tracks.legs, order, strict=True)) for order in permutations(tracks.legs)]
    best_order = min(
        orders, key=lambda to: (sum(cost[leg, girdles[to[leg]]] for leg in to), sum(a != b for a, b in to.items()))
    )
    if sum(cost[leg, girdles[best_order[leg]]] for leg in best_order) < mine - _NEARER * scale:
        moved = [leg for leg in tracks.legs if best_order[leg] != leg]
        renamed = " ".join(f"{leg}={best_order[leg]}" for leg in moved)
        raise UnusableTracks(
            f"in {tracks.source} the feet {' and '.join(moved)} are exchanged: each is nearer to the other's girdle; "
            f"give --names {renamed}."
        )


_AROUND = 3  # frames before and after, whose median a point is held against
_FAR = 0.2  # [trunk]; less is noise, which the fits take care of
_USUAL, _SHARE = 3.0, 90.0  # times what is not exceeded in so many per cent of the frames


def _without_jumps(tracks: Tracks, scale: float) -> tuple[Tracks, dict[str, np.ndarray]]:
    """Return the tracks with points lost where they are far from where they were just before and just after, and where.

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
    found = {}
    for i, name in enumerate(tracks.points):
        far = apart[:, i]
        found[name] = np.zeros(len(far), dtype=bool)
        if np.isfinite(far).any():
            found[name] = far > max(_FAR * scale, _USUAL * float(np.nanpercentile(far, _SHARE)))
            position[found[name], i] = np.nan
    return replace(tracks, position=position), found


def _without_strays(tracks: Tracks, noise: Mapping[str, float], scale: float) -> tuple[Tracks, dict[str, np.ndarray]]:
    """Return the tracks with midline points lost where they are not at their usual distance from neighbours, and where.

    In every frame the point goes that most of the wrong distances have in common, then the next; so do feet that are
    much farther from their girdles than they usually are, where the girdles are where they belong. A point that its
    neighbour has passed may be as far from it as ever; then it is not as far from the next but one.
    """
    links, chain = _Links(tracks, noise, scale), tracks.midline
    pairs = links.pairs(chain)
    bad = np.array([links.strays(pair) for pair in pairs])
    member = np.array([[name in pair for name in chain] for pair in pairs], dtype=float)
    adjacent = np.array([pair in set(pairwise(chain)) for pair in pairs])
    surely = np.array([bad[i] if adjacent[i] else links.strays(pair, _FOLDED) for i, pair in enumerate(pairs)])
    gone = np.zeros((len(chain), len(tracks.time)), dtype=bool)
    for _ in range(_ROUNDS):
        frames = np.flatnonzero(surely.any(axis=0))
        if not len(frames):
            break
        votes = member.T @ bad[:, frames]
        worst = np.argmax(votes + 0.5 * votes / member.sum(axis=0)[:, None], axis=0)  # of equals who is at fewer pairs
        gone[worst, frames] = True
        bad[:, frames] &= member[:, worst] == 0
        surely[:, frames] &= member[:, worst] == 0
    position, found = tracks.position.copy(), dict(zip(chain, gone, strict=True))
    for leg in tracks.legs:
        girdle = _girdle(tracks, leg)
        far = np.where(found[girdle], np.nan, _apart(tracks, leg, girdle))
        with np.errstate(invalid="ignore"):
            found[leg] = far > _STRETCHED * np.nanmedian(far) + _NOISES * np.nan_to_num(noise[leg])
    for name, frames in found.items():
        position[frames, tracks.points.index(name)] = np.nan
    return replace(tracks, position=position), found


def _girdle(tracks: Tracks, leg: str) -> str:
    """Return the point of the trunk that is nearest to where a limb begins."""
    front = leg.endswith("F")
    wanted = "shoulder" if front else "hip"
    return wanted if wanted in tracks.points else tracks.line[0 if front else 1]


def _named(what: str, frames: Mapping[str, np.ndarray], tracks: Tracks) -> list[str]:
    """Say which keypoints do something in how many frames, where these are more than a few."""
    told = []
    for name, where in frames.items():
        if where.mean() >= _TOLD / 4 and where.sum() >= 3:
            first = tracks.time[np.argmax(where)] if name in tracks.points else np.nan
            since = f", first at {first:.2f} s" if where.mean() >= _TOLD else ""
            told.append(f"{name} in {100 * where.mean():.1f} % of the frames{since}")
    return [f"keypoints that {what}: {'; '.join(told)}"] if told else []


def _out_of_reach(tracks: Tracks, scale: float) -> dict[str, str]:
    """Return the feet that are usually too far from their girdles."""
    found = {}
    for leg in tracks.legs:
        girdle = _girdle(tracks, leg)
        far = float(np.nanmedian(_apart(tracks, leg, girdle))) / scale
        if far > _REACH:
            found[leg] = f"lies {far:.1f} trunk lengths from {girdle}, farther than a limb reaches: track it again"
    return found


def _check_moves(tracks: Tracks, noise: Mapping[str, float], scale: float) -> None:
    """Refuse an animal that neither goes nor moves a foot.

    Raises:
        UnusableTracks: it stands.
    """
    names = (*tracks.line, *tracks.legs)
    moves = {name: np.nanpercentile(tracks.at(name), [2, 98], axis=0) for name in names}
    most = {name: float(np.linalg.norm(high - low)) for name, (low, high) in moves.items()}
    if all(most[name] < max(_STANDS * scale, 6 * np.nan_to_num(noise[name])) for name in names):
        raise UnusableTracks(
            f"in {tracks.source} the animal stands: in {tracks.time[-1] - tracks.time[0]:.1f} s no foot and no part of "
            f"the trunk moves by more than {max(most.values()) / scale:.2f} trunk lengths; cut out the part in which "
            "it walks, with --start and --end."
        )


_BESIDE = 0.1  # [trunk]; so far on the wrong side of the midline a foot is wrong
_ALWAYS = 0.9  # share of the frames that counts as always
_IN_A_ROW = 0.5  # share of these frames that follow each other, below which it is noise
_OFTEN = 0.1  # share of the frames in which noise may do so
_SOMETIMES = 0.02  # share that a point's noise does not explain


def _check_sides(tracks: Tracks) -> None:
    """Refuse tracks in which a left foot lies right of its right neighbour, seen along the body.

    Raises:
        UnusableTracks: it names the pair, or says that the whole picture is mirrored, and gives the frames.
    """
    girdles = {("LF", "RF"): tracks.thorax, ("LH", "RH"): tracks.pelvis}
    pairs = {pair: girdle or tracks.line for pair, girdle in girdles.items() if tracks.has(*pair)}
    crossed = {pair: _crossed(tracks, *pair, *look) for pair, look in pairs.items()}
    shares = {pair: float(np.nanmean(seen)) for pair, seen in crossed.items() if np.isfinite(seen).any()}
    if len(shares) == 2 and min(shares.values()) > _ALWAYS:
        raise UnusableTracks(
            f"in {tracks.source} LF and LH lie on the right of the body, RF and RH on the left: left and right are "
            "swapped in both pairs, or y points the other way; rename the feet, or give --y-axis up or down "
            "(images have it down)."
        )
    for (left, right), share in shares.items():
        if share > _ALWAYS:
            raise UnusableTracks(
                f"in {tracks.source} {left} lies on the right of the body and {right} on the left, in "
                f"{100 * share:.0f} % of the frames: left and right of this pair are swapped; give --names "
                f"{left}={right} {right}={left}."
            )
        if share > _SOMETIMES:
            frames = np.flatnonzero(crossed[left, right] == 1)
            if np.mean(np.diff(frames) == 1) < _IN_A_ROW:
                _check_noise(tracks, left, right, share)
                continue
            raise UnusableTracks(
                f"in {tracks.source} {left} and {right} are swapped in {len(frames)} frames, first in frame "
                f"{frames[0] + 1} at {tracks.time[frames[0]]:.2f} s and last in frame {frames[-1] + 1}: exchange "
                "them there."
            )


def _astride(tracks: Tracks, scale: float) -> dict[str, str]:
    """Return the feet that lie on the other side of the body, while their partners are where they belong."""
    front, rear = tracks.line
    look = tracks.at(front) - tracks.at(rear)
    look = look / np.linalg.norm(look, axis=-1, keepdims=True)
    aside = {}
    for leg in tracks.legs:
        d = tracks.at(leg) - tracks.at(rear)
        left = float(np.nanmedian(look[:, 0] * d[:, 1] - look[:, 1] * d[:, 0])) / scale
        aside[leg] = left if leg.startswith("L") else -left
    found = {}
    for leg in tracks.legs:
        partner = {"L": "R", "R": "L"}[leg[0]] + leg[1]
        if aside[leg] < -_BESIDE and aside.get(partner, 1.0) > 0.0:
            side = "right" if leg.startswith("L") else "left"
            found[leg] = f"lies on the {side} of the body, {-aside[leg]:.2f} trunk lengths off: track it again"
    return found


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
