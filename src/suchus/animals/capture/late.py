"""Keypoints of the midline whose frames are later than those of the others.

Neighbours have a constant distance. If one of them is late, the distance varies: with the turn of the link in every
cycle, and with the pace from cycle to cycle. Both effects are tested separately, and either half of the film must show
the lag: a path that turns, or a walk that stops, leaves variations that look like lags, but not the same twice. A body
that bends between two keypoints shortens the line between them in the same way in every cycle. That much is allowed,
however many frames there are.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from suchus.animals.capture.angles import joint_bends
from suchus.animals.capture.cycle import fit, harmonics_for
from suchus.animals.capture.screen import midline_neighbours
from suchus.animals.capture.swings import Clock
from suchus.animals.capture.tracks import Tracks

_MIN_LAG, _MAX_LAG = 0.015, 0.3  # [cycle]; range of lags that are reported
_GAIN, _FRAMES = 18.0, 30  # twice the gain of log-likelihood that is significant; least frames
_EXPLAINS = 0.5  # greatest fraction of the distance's variance that may remain at the lag
_CHANCE = 1e-4  # probability that noise in the fitted paths alone makes a distance vary as much, for one link
_GAIN_OF_TWO = 12.0  # the gain for both links of a point at one lag, by turns and pace together
_SHARED_NOISE = 1.5  # variance of twice a point less both neighbours, over that of two links with noise of their own
_MIN_TURN_GAIN = 5.0  # the part of that gain by the turns that is significant without the pace
_EXPLAINS_OF_TWO = 0.75  # greatest fraction of the variance that may remain in both links
_NEARLY = 0.08  # [cycle]; greatest lag by both links: a longer one is significant in one link alone, or noise
_MIN_PACE_Z = 2.5  # lag by the pace that is significant without the turns [standard error]
_MIN_LINK_Z = 1.5  # the same for each link alone
_MIN_END_Z = 5.0  # the same for a point with one link
_BENDS = 5  # greatest power of time in the fit of a path
_HARMONICS = 4  # greatest number of harmonics in the fit of a path
_SKIN = 0.01  # [link]; least standard deviation of a distance
_MAX_LINK = 0.5  # [trunk]; a longer link may bend between its keypoints, which nothing shows
_MAX_CHORD_BEND = 0.05  # [rad]; root mean square of the bend at a longer link that says nothing of the pace
_CHORD = 0.08  # [link]; standard deviation of a chord whose body swings by a radian about a steady bend of more
_PACED_CHORD = 0.3  # fraction of a chord's standard deviation that may vary with the pace
_MAX_HALFWAY = 0.7  # greatest fraction of the gain that is missing at half the lag; a distance that lags has a quarter
_WHITE = 0.3  # mean square of residuals' steps over twice their variance, above which they count as independent
_UNKNOWN = 1e9  # [s]; standard error of a lag with too few frames
_MAX_LAG_RATIO, _MIN_HALF_Z = (
    2.0,
    1.6,
)  # lag in half of a film over that in the whole film; its standard errors, by the pace
_EXACT = 1e-4  # [link]; least error of a keypoint's position
_SMOOTHING_WINDOW = 0.3  # [cycle]; for the velocity of a keypoint


def find_late_keypoints(tracks: Tracks, clock: Clock, time: Float[np.ndarray, " frame"]) -> dict[str, str]:
    """Return the midline points that are later or earlier than the others; none in a view from the side.

    The lag between two neighbours is the one at which their distance varies least.

    Args:
        tracks: the keypoints, by the clock.
        clock: on which strides last equally long.
        time: time of the film, in each frame [s].
    """
    chain, reasons = list(tracks.midline), dict[str, str]()
    if tracks.view == "side":  # bends to the sides shorten what is seen of a link
        return reasons
    lags = _Lags(tracks, clock, time)
    halves = _halves(tracks, clock, time)
    while len(chain) >= 3:
        links = lags.links(list(pairwise(chain)))
        link_lags = {pair: link.lag for pair, link in links.items()}
        lagging_pairs = [pair for pair in link_lags if link_lags[pair]]
        if lagging_pairs:
            point_lags = {
                name: [(1 if pair[1] == name else -1) * link_lags[pair] for pair in link_lags if name in pair]
                for name in chain
            }
            inner_points = [
                name for name in chain if len(point_lags[name]) == 2 and point_lags[name][0] * point_lags[name][1] > 0
            ]
            smallest_pair = min(lagging_pairs, key=lambda pair: abs(link_lags[pair]))
            lagging_points = (
                inner_points[:1]
                or [name for name in lags.inner(chain, links) if name in smallest_pair]
                or [lags.likelier(chain, links, smallest_pair)]
            )
            lag_by_point = {name: max(point_lags[name], key=abs) for name in lagging_points[:1]}
        else:
            lag_by_point = lags.inner(chain, links) or lags.at_an_end(chain)
        lag_by_point = {
            name: lag for name, lag in lag_by_point.items() if all(half.agrees(chain, name, lag) for half in halves)
        }
        if not lag_by_point:
            break
        for name, lag in lag_by_point.items():
            neighbours = " and ".join(midline_neighbours(chain, name))
            reasons[name] = (
                f"runs {abs(lag):.3f} s {'behind' if lag > 0 else 'ahead of'} {neighbours}: its frames are not theirs"
            )
            chain.remove(name)
    return reasons


def _halves(tracks: Tracks, clock: Clock, time: Float[np.ndarray, " frame"]) -> list["_Lags"]:
    """Return the lags in either half of a film, in each of which a keypoint that is late is late by the same time."""
    middle = len(time) // 2
    halves = []
    for part in (slice(None, middle), slice(middle, None)):
        half_tracks = replace(tracks, time=tracks.time[part], position=tracks.position[part])
        if all(np.isfinite(half_tracks.at(name)[:, 0]).sum() >= _FRAMES for name in tracks.midline):
            halves.append(_Lags(half_tracks, clock, time[part]))
    return halves


def _trunk_length(tracks: Tracks) -> float:
    """Return the length of the trunk along its points, or of all links of its midline where it is not known."""
    length = tracks.trunk_length()
    if np.isfinite(length):
        return length
    chain = tracks.trunk_chain
    links = [float(np.nanmedian(np.linalg.norm(tracks.at(a) - tracks.at(b), axis=-1))) for a, b in pairwise(chain)]
    return float(np.nansum(links))


def _independent_fraction(residual: Float[np.ndarray, " frame"]) -> float:
    """Return the fraction of frames whose residual is independent of the last one: 1 for white noise [-]."""
    steps = np.diff(residual)
    steps, values = steps[np.isfinite(steps)], residual[np.isfinite(residual)]
    if len(steps) < _FRAMES or np.var(values) == 0.0:
        return 1.0
    return float(np.clip(np.mean(steps**2) / (2 * _WHITE * np.var(values)), 1.0 / len(values), 1.0))


def _is_near(lag: float, other: float) -> bool:
    """Return whether two lags have one sign and about one size."""
    return lag * other > 0.0 and 1.0 / _MAX_LAG_RATIO < lag / other < _MAX_LAG_RATIO


class _LaggedLink(NamedTuple):
    """Variation of the distance of two neighbours with the lag between them."""

    relative_variance: Float[np.ndarray, " lag"]
    """Variance of their distance over that of noise, by how much later the second one is seen [-]."""
    bend_variance: float
    """What of that a body that bends between the two may add [-]: there the line between them is shorter."""
    lag: float
    """By how much the second one runs behind the first, 0 where that is not sure [s]."""
    frames: float
    """Number of frames with independent residuals: a path that turns or stops leaves residuals that go on [-]."""


class _Paced(NamedTuple):
    """Lag of a point behind its neighbours, estimated from the variation of their distance with the pace."""

    lag: float
    """Lag of the keypoint by its links together [s]."""
    error: float
    """Standard error of that [s]."""
    z_score: float
    """The lag in standard errors [-]."""
    min_z_score: float
    """The same of that link which shows it least, negative where it shows the opposite [-]."""


class _Lags:
    """Lags between the points of links, estimated from their paths over the mean cycle."""

    def __init__(self, tracks: Tracks, clock: Clock, time: np.ndarray) -> None:
        """Fit the path of every keypoint of the midline, and tabulate the lags that are tried.

        Args:
            tracks: the keypoints, by the clock.
            clock: on which all strides have the same duration.
            time: time of the film, in each frame [s].
        """
        self._tracks, period = tracks, clock.period
        cycles = (tracks.time[-1] - tracks.time[0]) / period
        turns = min(_BENDS, 1 + int(cycles / 2))  # of the path
        self._courses = {}
        for name in tracks.midline:
            frame_count = int(np.isfinite(tracks.at(name)[:, 0]).sum())
            count = harmonics_for(frame_count, tracks.rate * period, max_harmonics=_HARMONICS)
            rows = tracks.at(name)[:, :2].T
            self._courses[name] = [fit(tracks.time, row, period, harmonics=count, drift=turns) for row in rows]
        self._max_link = _MAX_LINK * _trunk_length(tracks)
        step = max(1.0 / tracks.rate, 0.01 * period)
        self.lags = step * np.arange(-int(_MAX_LAG * period / step), int(_MAX_LAG * period / step) + 1)
        self._zero_index = len(self.lags) // 2
        is_interior = (time > time[0] + _MAX_LAG * period) & (time < time[-1] - _MAX_LAG * period)
        self._time, self._clock = time[is_interior], clock
        chain = tracks.midline
        bends = np.nanmean(joint_bends(tracks, chain) ** 2, axis=1) if len(chain) > 2 else np.zeros(0)
        self._mean_square_bends = dict(zip(chain[1:-1], bends, strict=True))

    def _places(self, names: Collection[str], lag: float) -> dict[str, np.ndarray]:
        """Return the positions of points at a lag after the frames' times, each of shape (frame, 2)."""
        clock_time = self._clock.read(self._time + lag)
        turn = np.exp(2j * np.pi * np.multiply.outer(clock_time, np.arange(1, _HARMONICS + 1)) / self._clock.period)
        positions = {}
        for name in names:
            courses = self._courses[name]
            harmonics = np.stack([course.harmonics for course in courses], axis=-1)
            swings = (turn[:, : len(harmonics)] @ harmonics).real
            positions[name] = np.stack([course.trend(clock_time) for course in courses], axis=-1) + swings
        return positions

    def links(self, pairs: Sequence[tuple[str, str]]) -> dict[tuple[str, str], _LaggedLink]:
        """Return the variation of each pair's distance with the lag of its second point; none in too short a film."""
        if len(self._time) < _FRAMES:
            return {}
        first_positions = self._places({first_name for first_name, _ in pairs}, 0.0)
        mean_distances, distance_variances = np.empty((2, len(pairs), len(self.lags)))
        for i, lag in enumerate(self.lags):  # the turns of the mean cycle are those of all points
            second_positions = self._places({second_name for _, second_name in pairs}, lag)
            for j, (first_name, second_name) in enumerate(pairs):
                distance = np.linalg.norm(second_positions[second_name] - first_positions[first_name], axis=-1)
                mean_distances[j, i], distance_variances[j, i] = np.mean(distance), np.var(distance)
        return {pair: self._link(pair, mean_distances[j], distance_variances[j]) for j, pair in enumerate(pairs)}

    def _link(
        self,
        pair: tuple[str, str],
        mean_distance: Float[np.ndarray, " lag"],
        distance_variance: Float[np.ndarray, " lag"],
    ) -> _LaggedLink:
        """Return how the distance of a pair varies with the lag, in units of the variance that noise explains.

        Args:
            pair: names of the keypoints.
            mean_distance: mean distance of the keypoints at each lag, shape (lag,) [m or px].
            distance_variance: variance of that distance at each lag, shape (lag,) [m^2 or px^2].
        """
        residual = [course.residual for name in pair for course in self._courses[name]]
        mean_square_bend = np.mean(
            [self._mean_square_bends[name] for name in pair if name in self._mean_square_bends] or [0.0]
        )  # a chord of what bends
        link_length = float(mean_distance[self._zero_index])
        sways = link_length * np.hypot(_SKIN, mean_square_bend / 8)
        noise = sum(float(np.nanvar(series)) for series in residual) / 2 + sways**2
        bend_variance = float((link_length * mean_square_bend / 16) ** 2 / noise)
        if link_length > self._max_link:  # the same in every cycle: more frames do not make it smaller
            bend_variance += (_CHORD * link_length) ** 2 / noise
        frames = len(self._tracks.time) * min(1.0, *(_independent_fraction(series) for series in residual))
        count = max(2 * len(course.harmonics) + len(course.drift) for name in pair for course in self._courses[name])
        relative_variance = distance_variance / noise
        lag = self._significant_lag(relative_variance, bend_variance, frames, count)
        return _LaggedLink(relative_variance, bend_variance, lag, frames)

    def _significant_lag(
        self, relative_variance: Float[np.ndarray, " lag"], bend_variance: float, frames: float, count: int
    ) -> float:
        """Return the lag at which a distance varies least [s], 0 if it is not significant.

        Args:
            relative_variance: variance of the distance over that of noise at each lag, shape (lag,) [-].
            bend_variance: part of that variance that a bend between the points may add [-].
            frames: number of frames with independent residuals.
            count: numbers of the fitted paths, which noise makes vary: of its variance a smaller one is chance.
        """
        floor = count / frames
        best = int(np.argmin(relative_variance))
        variance_drop = float(relative_variance[self._zero_index] - max(float(relative_variance[best]), floor))
        gained = frames * variance_drop
        halfway = (best + self._zero_index) // 2
        is_inside = 0 < best < len(self.lags) - 1  # at an end of the range the least variance is farther off
        is_significant = (
            is_inside
            and frames * relative_variance[self._zero_index] > _max_noise_variance(count)
            and gained > _GAIN
            and variance_drop > bend_variance
            and relative_variance[best] < _EXPLAINS * relative_variance[self._zero_index]
            and relative_variance[halfway] - relative_variance[best] < _MAX_HALFWAY * variance_drop
        )
        lag = float(self.lags[best])
        return lag if is_significant and abs(lag) > _MIN_LAG * self._clock.period else 0.0

    def inner(self, chain: Sequence[str], links: Mapping[tuple[str, str], _LaggedLink]) -> dict[str, float]:
        """Return the inner point of a chain whose lag is significant in both links together, if there is one [s].

        A late point has the same lag behind both neighbours, by the turns and by the pace. All four estimates together
        may be significant where each alone is not. The noise of the point is in both of its links.
        """
        candidates: dict[str, tuple[float, float]] = {}
        for front, name, rear in zip(chain, chain[1:], chain[2:], strict=False) if links else ():
            front_link, rear_link, paced = links[front, name], links[name, rear], self._paced(chain, name)
            variances = front_link.relative_variance, rear_link.relative_variance[::-1]
            turn_gain = min(front_link.frames, rear_link.frames) * (
                sum(row[self._zero_index] - row for row in variances)
                - front_link.bend_variance
                - rear_link.bend_variance
            )
            turn_gain /= _SHARED_NOISE
            turn_gain[self._zero_index] = 0.0
            gained = turn_gain + paced.z_score**2 - ((self.lags - paced.lag) / paced.error) ** 2
            index = int(np.argmax(gained))
            lag, remaining_fraction = (
                float(self.lags[index]),
                sum(row[index] for row in variances) / sum(row[self._zero_index] for row in variances),
            )
            by_turns = (
                turn_gain[index] > _MIN_TURN_GAIN
                and remaining_fraction < _EXPLAINS_OF_TWO
                and abs(lag) < _NEARLY * self._clock.period
            )
            by_turns = by_turns and all(row[index] < row[self._zero_index] for row in variances)
            by_pace = paced.z_score > _MIN_PACE_Z and paced.min_z_score > _MIN_LINK_Z
            if gained[index] > _GAIN_OF_TWO and abs(lag) > _MIN_LAG * self._clock.period and (by_turns or by_pace):
                candidates[name] = lag, float(gained[index])
        if not candidates:
            return {}
        name = max(candidates, key=lambda point_name: candidates[point_name][1])
        return {name: candidates[name][0]}

    def likelier(
        self, chain: Sequence[str], links: Mapping[tuple[str, str], _LaggedLink], pair: tuple[str, str]
    ) -> str:
        """Return the point of a pair whose links all together vary less if it is the late one."""
        index = int(np.argmin(np.abs(self.lags - links[pair].lag)))
        decrease = {}
        for name, other in (pair, pair[::-1]):
            decrease[name] = 0.0
            for neighbour in midline_neighbours(chain, name):
                if neighbour != other:
                    outer_pair = (neighbour, name) if (neighbour, name) in links else (name, neighbour)
                    is_same_sense = (outer_pair[1] == name) == (pair[1] == name)
                    row = links[outer_pair].relative_variance[:: 1 if is_same_sense else -1]
                    decrease[name] += float(row[self._zero_index] - row[index])
        return max(pair, key=lambda name: decrease[name])

    def agrees(self, chain: Sequence[str], name: str, lag: float) -> bool:
        """Return whether the frames here show, too, that a point is late by about a lag [s].

        Either its links vary least at such a lag, or the pace says it. Too few frames show nothing.
        """
        neighbours = midline_neighbours(chain, name)
        links = self.links([(neighbour, name) for neighbour in neighbours])
        if not links:
            return False
        relative_variance = np.sum([link.relative_variance for link in links.values()], axis=0)
        by_turns = float(self.lags[int(np.argmin(relative_variance))])
        index = int(np.argmin(np.abs(self.lags - lag)))
        paced = self._paced(chain, name)
        has_smaller_variance = float(relative_variance[index]) < float(relative_variance[self._zero_index])
        is_by_turns = has_smaller_variance and _is_near(by_turns, lag)
        is_by_pace = paced.z_score > _MIN_HALF_Z and _is_near(paced.lag, lag)
        return is_by_turns or is_by_pace

    def at_an_end(self, chain: Sequence[str]) -> dict[str, float]:
        """Return the first or last point of a chain if its lag by the pace is significant [s]."""
        estimates = {name: self._paced(chain, name) for name in (chain[0], chain[-1]) if len(self._time) >= _FRAMES}
        significant = {
            name: estimate for name, estimate in estimates.items() if abs(estimate.lag) > _MIN_LAG * self._clock.period
        }
        name = max(significant, key=lambda point_name: significant[point_name].z_score, default="")
        return {name: significant[name].lag} if name and significant[name].z_score > _MIN_END_Z else {}

    def _paced(self, chain: Sequence[str], name: str) -> _Paced:
        """Return the lag of a point of a chain behind its neighbours, by the pace.

        A late point is off by its velocity times the lag. At higher speed the link ahead of it is longer, the link
        behind it shorter. The periodic part of length and velocity is removed, so that sliding skin and the chord of a
        bent body do not resemble a lag.
        """
        half = max(2, round(_SMOOTHING_WINDOW * self._clock.period * self._tracks.rate / 2))
        lags, errors = np.transpose(
            [self._by_pace(name, neighbour, half) for neighbour in midline_neighbours(chain, name)]
        )
        weights = errors**-2.0 / np.sum(errors**-2.0)
        shares = weights * errors
        error = float(np.sqrt((shares @ shares + np.sum(shares) ** 2) / 2))  # half the variance of each is the point's
        lag = float(weights @ lags)
        return _Paced(lag, error, abs(lag) / error, float(np.min(np.sign(lag) * lags / errors)))

    def _by_pace(self, name: str, neighbour: str, half: int) -> tuple[float, float]:
        """Return the lag of a point behind one neighbour, by the pace, and its standard error [s]."""
        place = self._tracks.at(name)[:, :2]
        link = self._tracks.at(neighbour)[:, :2] - place
        link_length, link_direction = (
            np.linalg.norm(link, axis=-1),
            _moving_line(link, half)[0],
        )  # smoothed, so that noise is not in both
        axial_velocity = np.sum(
            self._tracks.rate * _moving_line(place, half)[1] * link_direction, axis=-1
        ) / np.linalg.norm(link_direction, axis=-1)
        use = np.isfinite(axial_velocity) & np.isfinite(link_length)
        bend = max(self._mean_square_bends.get(point, 0.0) for point in (name, neighbour))
        is_long = use.any() and float(np.median(link_length[use])) > self._max_link
        if use.sum() < _FRAMES or (is_long and bend > _MAX_CHORD_BEND**2):  # its chord may vary with the pace
            return 0.0, _UNKNOWN
        angle = 2 * np.pi * np.multiply.outer(self._tracks.time[use], np.arange(1, _HARMONICS + 1)) / self._clock.period
        X, _ = np.linalg.qr(np.hstack([np.ones((use.sum(), 1)), np.cos(angle), np.sin(angle)]))
        x, y = (row[use] - X @ (X.T @ row[use]) for row in (axial_velocity, link_length))
        lag = float(x @ y / max(x @ x, 1e-300))
        residual = y - lag * x
        autocorrelation = (
            (residual[1:] @ residual[:-1]) * (x[1:] @ x[:-1]) / max((residual @ residual) * (x @ x), 1e-300)
        )
        variance_inflation = max(
            1.0, (1.0 + autocorrelation) / (1.0 - autocorrelation)
        )  # what is left over may go on from frame to frame
        count = max(1, use.sum() - X.shape[1] - 1)
        noise = max(float(residual @ residual) / count, (_EXACT * float(np.mean(link_length[use]))) ** 2)
        chord = _PACED_CHORD * float(np.mean(link_length[use])) * bend / 16
        variance = variance_inflation * noise + count * chord**2  # that of a chord does not become smaller with frames
        return lag, float(np.sqrt(variance / max(x @ x, 1e-300)))


@cache
def _max_noise_variance(count: int) -> float:
    """Return the variance of a distance over that of noise, times the frames, that noise in paths exceeds rarely.

    Args:
        count: numbers of the fitted paths [-].
    """
    return float(chi2.isf(_CHANCE, count))


def _moving_line(place: Float[np.ndarray, "frame axis"], half: int) -> tuple[np.ndarray, np.ndarray]:
    """Return value and slope [1/frame] of a straight line through each frame and ``half`` frames on either side.

    Missing points are interpolated. Both are NaN at the ends of the film, and where fewer than half of these frames
    were seen.
    """
    frames, (middle, slope) = np.arange(len(place)), np.full((2, *place.shape), np.nan)
    steps = np.arange(-half, half + 1)
    for i, row in enumerate(place.T):
        is_seen = np.isfinite(row)
        filled_row = np.interp(frames, frames[is_seen], row[is_seen])
        has_enough_frames = np.correlate(is_seen.astype(float), np.ones(len(steps)), mode="valid") > half
        mean = np.correlate(filled_row, np.ones(len(steps)), mode="valid") / len(steps)
        middle[half:-half, i] = np.where(has_enough_frames, mean, np.nan)
        slope[half:-half, i] = np.where(
            has_enough_frames, np.correlate(filled_row, steps, mode="valid") / (steps @ steps), np.nan
        )
    return middle, slope
