"""What was seen of a walk: its mean cycle, its numbers with their spread, and what kind of wave it is."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.stats import t as student

from suchus.capture.angles import bend_angles, joint_bends, standing_index, wrapped
from suchus.capture.cycle import PeriodicFit, find_period, fit, harmonics_for
from suchus.capture.feet import GRID, FootContact, FootSweep, contact, forward_path, steps, sweep
from suchus.capture.swings import Clock, paced
from suchus.capture.tracks import Tracks, UnusableTracks, check_sides, check_tracks, without_jumps
from suchus.design import LEGS
from suchus.design.checks import require

UNSURE = 0.1
"""Half the width of the interval of a duty factor from which on a foot does not count for the gait's [-]."""
_BLIND = 0.25  # the same from which on a walk is refused, if no foot is better
_STRAIGHT = 1e-6  # [rad]; what bends less has no phase
_BINS = 20  # of phase, for the spread
_SHARP = 3.0  # a joint bends if its amplitude exceeds so many of its standard errors
_TOGETHER = 0.25  # least share of frames in which all points of a signal are seen
_ADVANCE = 0.3  # share of the distance that feet sweep below which the body does not advance


class Seen(NamedTuple):
    """A number that was seen."""

    value: float
    """Over all cycles."""
    spread: float
    """Standard deviation from cycle to cycle; NaN if fewer than two were seen."""
    error: float
    """Half the width of the interval about the value that holds the truth in 95 of 100 walks; NaN if fewer than two
    cycles were seen."""
    unit: str
    """SI unit, ``-`` for none, ``cycle``, or ``trunk`` for lengths of the trunk from hip to shoulder."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Walk:
    """A walk as it was seen; nothing in it knows of a robot.

    Bends are what the body did, not what was commanded: on film a robot's trunk bends by the angle that its
    servos reached.
    """

    source: str
    """File that the tracks are from."""
    cycles: float
    """Number of cycles that were seen [-]."""
    upright: bool
    """Whether heights were seen."""
    tail_share: float
    """Where along the tail its lateral angle was taken, 1 at the tip [-]."""
    numbers: Mapping[str, Seen]
    """Every number by name; see ``docs/capture.md``."""
    bends: Mapping[str, complex]
    """First harmonic of each of the four angles: the angle is its steady part and the real part of this times
    ``exp(2 pi i phase)`` [rad]."""
    notes: tuple[str, ...]
    """What the tracks do not show, a sentence each."""
    cycle: xr.Dataset
    """The mean cycle over ``phase`` and ``leg``: the four angles with ``<name>_spread``, ``foot_speed``, ``stance``.
    Phase 0 is where a gait of this footfall begins: LF starts to swing."""

    def value(self, name: str) -> float:
        """Return a number without its spread."""
        return self.numbers[name].value


class _Reading(NamedTuple):
    """Quantities read from one stretch of time."""

    angles: dict[str, PeriodicFit]
    sweeps: dict[str, FootSweep]
    advance: float  # of the body in one cycle [m or px]
    trunk: float  # [m or px]
    period: float
    tail_share: float


def observe(tracks: Tracks, *, tail_share: float = 1.0) -> Walk:
    """Read a walk from tracks.

    Args:
        tracks: of one body that walks with a steady gait.
        tail_share: where along the tail its lateral angle is taken, 1 at the tip [-]; for a robot whose tail's end is
            passive, the share that its servo bends.

    Raises:
        InvalidDesign: ``tail_share`` is no share.
        UnusableTracks: points are missing or lost, left and right are swapped, units are wrong, nothing repeats, less
            than one cycle was seen, noise hides the steps, or the camera goes along.
    """
    require("observe", "tail_share", tail_share, 0.05, 1.0, "")
    check_tracks(tracks)
    tracks = without_jumps(tracks.ahead())
    check_tracks(tracks)
    check_sides(tracks)
    signals = _swinging(tracks)
    _check_signals(signals, tracks.source)
    rough = find_period(tracks.time, signals, tracks.source)
    clock = paced({leg: steps(tracks, leg, rough) for leg in LEGS}, rough)
    tracks, period = replace(tracks, time=clock.read(tracks.time)), clock.period
    whole = _read(tracks, period, tail_share)
    feet: dict[str, FootContact] = {leg: contact(tracks, leg, period) for leg in LEGS}
    _check_advance(whole, tracks.source)
    _check_feet(feet, tracks.source)
    zero = _zero(feet)
    numbers = _seen(tracks, whole, feet, zero, clock)
    for name, chain in _chains(tracks).items():
        numbers[f"standing_{name}"] = Seen(_index(tracks, chain, period), float("nan"), float("nan"), "-")
    return Walk(
        source=tracks.source,
        cycles=float((tracks.time[-1] - tracks.time[0]) / period),
        upright=tracks.upright,
        tail_share=tail_share,
        numbers=numbers,
        bends={name: complex(_first(whole.angles[name], zero)) for name in whole.angles},
        notes=_unknown(feet),
        cycle=_mean_cycle(tracks, whole, feet, zero),
    )


def _seen(
    tracks: Tracks, whole: _Reading, feet: Mapping[str, FootContact], zero: float, clock: Clock
) -> dict[str, Seen]:
    """Return every number with its spread and its interval."""
    count = int((tracks.time[-1] - tracks.time[0]) / whole.period + 0.05)
    each = [
        _numbers(_read(_cycle(tracks, i, whole.period), whole.period, whole.tail_share), zero) for i in range(count)
    ]
    each = each if count >= 2 else []
    numbers = {}
    for name, value in _numbers(whole, zero).items():
        spread, n = _spread(name, value, each)
        error = _times(n) * spread / np.sqrt(n) if n > 1 else float("nan")
        if name == "spine_rightmost":  # its phase counts from a foot
            duties = np.mean([foot.duty_error for foot in feet.values()]) / 2
            error = float(np.linalg.norm(np.array([error, feet["LF"].middle_error, duties], dtype=float)))
        numbers[name] = Seen(value, spread, error, _unit(name))
    first = feet["LF"]
    for leg, foot in feet.items():
        numbers[f"duty_{leg}"] = Seen(foot.duty, foot.scatter, foot.duty_error, "-")
        error = float(np.hypot(first.middle_error, foot.middle_error)) if leg != "LF" else 0.0
        numbers[f"phase_{leg}"] = Seen((first.middle - foot.middle) % 1.0, float("nan"), error, "cycle")
    lasts = np.diff(clock.seconds(tracks.time[0] / whole.period + np.arange(count + 1)))
    spread = float(np.std(lasts, ddof=1)) if count >= 2 else float("nan")
    error = _times(count) * spread / np.sqrt(count) if count >= 2 else float("nan")
    numbers["period"] = Seen(whole.period, spread, error, "s")
    return numbers


def _times(n: int) -> float:
    """Return how many standard errors of n cycles hold the truth in 95 of 100 cases."""
    return float(student.ppf(0.975, n - 1))


def _check_feet(feet: Mapping[str, FootContact], source: str) -> None:
    """Refuse feet of which it cannot be seen whether they stand or swing."""
    known = {leg: foot.duty_error for leg, foot in feet.items() if np.isfinite(foot.duty_error)}
    if known and min(known.values()) > _BLIND:
        leg = min(known, key=lambda name: known[name])
        raise UnusableTracks(
            f"in {source} noise hides the steps: even the duty factor of {leg} is known to ±{known[leg]:.2f} only, at "
            f"most ±{_BLIND:g} may be; film more cycles, faster, or nearer."
        )


def _unknown(feet: Mapping[str, FootContact]) -> tuple[str, ...]:
    """Say of which feet too little is seen."""
    notes = []
    for leg, foot in feet.items():
        if foot.duty_error > UNSURE:
            why = f"is hidden in {100 * foot.hidden:.0f} % of every cycle" if foot.hidden > 0.1 else "is seen too badly"
            unsure = f"±{foot.duty_error:.2f} of the cycle"
            notes.append(f"{leg} {why}: when it lifts off and touches down is known to {unsure} only")
    return tuple(notes)


def _swinging(tracks: Tracks) -> np.ndarray:
    """Signals that swing once a cycle: trunk and tail, and each foot along the body."""
    angles = bend_angles(tracks)
    return np.array([angles.spine_lateral, angles.tail_lateral, *(forward_path(tracks, leg) for leg in LEGS)])


def _check_signals(signals: np.ndarray, source: str) -> None:
    """Points that are lost in turns may leave no frame in which a bend can be seen."""
    names = ("the spine's bend", "the tail's bend", *(f"the path of {leg}" for leg in LEGS))
    for name, seen in zip(names, np.isfinite(signals).mean(axis=1), strict=True):
        if seen < _TOGETHER:
            raise UnusableTracks(
                f"in {source} {name} can be seen in {100 * seen:.0f} % of the frames, at least {100 * _TOGETHER:.0f} % "
                "are needed: its points are lost in turns; track them again."
            )


def _read(tracks: Tracks, period: float, tail_share: float) -> _Reading:
    angles = bend_angles(tracks, tail_share)._asdict()
    fits = {}
    for name, series in angles.items():
        seen = int(np.isfinite(series).sum())
        if seen:
            fits[name] = fit(tracks.time, series, period, harmonics=harmonics_for(seen, tracks.rate * period, most=6))
    advanced = [fit(tracks.time, tracks.at("hip")[:, i], period, harmonics=2, drift=1).drift[0] for i in (0, 1)]
    return _Reading(
        fits,
        {leg: sweep(tracks, leg, period) for leg in LEGS},
        float(np.hypot(*advanced)) * period,
        tracks.trunk_length(),
        period,
        tail_share,
    )


def _numbers(reading: _Reading, zero: float) -> dict[str, float]:
    spine, tail = (_first(reading.angles[name], zero) for name in ("spine_lateral", "tail_lateral"))
    numbers = {"stride": reading.advance / reading.trunk}
    for leg, path in reading.sweeps.items():
        numbers |= {
            f"retraction_{leg}": path.retraction,
            f"stroke_{leg}": path.stroke / reading.trunk,
            f"outward_{leg}": path.outward / reading.trunk,
            f"ahead_{leg}": float(path.forward.mean()) / reading.trunk,
            f"lift_{leg}": path.lift / reading.trunk,
        }
    for name, angle in reading.angles.items():
        numbers |= {name: float(abs(angle.harmonics[0])), f"{name}_steady": angle.mean}
        numbers[f"{name}_overtones"] = float(np.linalg.norm(angle.harmonics[1:]) / max(abs(angle.harmonics[0]), 1e-12))
    if abs(spine) > _STRAIGHT:
        numbers["spine_rightmost"] = float(-np.angle(spine) / (2 * np.pi)) % 1.0
        if abs(tail) > _STRAIGHT:
            numbers["tail_lag"] = float(np.angle(spine / tail) / (2 * np.pi)) % 1.0
    return {name: value for name, value in numbers.items() if np.isfinite(value)}


def _zero(feet: Mapping[str, FootContact]) -> float:
    """Phase of the tracks' clock at which the gait begins: LF's mid-stance, back by swing and half of stance."""
    duty = float(np.mean([foot.duty for foot in feet.values()]))
    return feet["LF"].touch_down + feet["LF"].duty / 2 - (1.0 - duty / 2)


def _first(one: PeriodicFit, zero: float) -> complex:
    return complex(one.harmonics[0] * np.exp(2j * np.pi * zero))


def _cycle(tracks: Tracks, number: int, period: float) -> Tracks:
    start = tracks.time[0] + number * period
    return tracks.between(start, start + period)


def _spread(name: str, value: float, each: list[dict[str, float]]) -> tuple[float, int]:
    values = np.array([numbers[name] for numbers in each if name in numbers])
    if len(values) < 2:
        return float("nan"), len(values)
    apart = values - value
    if _unit(name) == "cycle":
        apart = wrapped(2 * np.pi * apart) / (2 * np.pi)
    return float(np.std(apart, ddof=1)), len(values)


def _unit(name: str) -> str:
    stem = name.partition("_")[0]
    if stem in ("phase",) or name in ("spine_rightmost", "tail_lag"):
        return "cycle"
    if stem in ("stroke", "outward", "ahead", "lift", "stride"):
        return "trunk"
    return "-" if stem in ("duty", "retraction") or name.endswith("overtones") else "rad"


def _chains(tracks: Tracks) -> dict[str, tuple[str, ...]]:
    trunk, tail = tracks.trunk_chain, tracks.tail_chain
    return {"trunk": trunk, "tail": tail, "body": (*trunk, *tail[2:])}


def _index(tracks: Tracks, chain: tuple[str, ...], period: float) -> float:
    """Standing index of a chain, over the joints whose bend stands out of the noise; NaN with fewer than two."""
    amplitude, phase = [], []
    for series in joint_bends(tracks, chain):
        bend = fit(tracks.time, series, period, harmonics=3)
        if abs(bend.harmonics[0]) > _SHARP * bend.error:
            amplitude.append(abs(bend.harmonics[0]))
            phase.append(np.angle(bend.harmonics[0]))
    return standing_index(amplitude, phase) if len(amplitude) > 1 else float("nan")


def _check_advance(reading: _Reading, source: str) -> None:
    """On ground at rest the body goes farther in a cycle than a foot sweeps back."""
    swept = 2 * float(np.mean([path.stroke for path in reading.sweeps.values()]))
    if reading.advance < _ADVANCE * swept:
        raise UnusableTracks(
            f"in {source} the body advances by {reading.advance / reading.trunk:.2f} of its trunk's length in a cycle "
            f"while its feet sweep {swept / reading.trunk:.2f} of it: it walks on a belt, on the spot, or the camera "
            "goes along; standing feet can only be recognised over ground that rests in the picture."
        )


def _mean_cycle(tracks: Tracks, reading: _Reading, feet: Mapping[str, FootContact], zero: float) -> xr.Dataset:
    phase = np.arange(GRID) / GRID
    time = (phase + zero) * reading.period
    data = xr.Dataset(coords={"phase": ("phase", phase, {"units": "1"}), "leg": list(LEGS)})
    for name, angle in reading.angles.items():
        attrs = {"units": "rad", "long_name": f"{name.replace('_', ' ')}, {_positive(name)} positive"}
        data[name] = ("phase", angle.mean + angle.swing(time), attrs)
        data[f"{name}_spread"] = (
            "phase",
            _left_over(tracks, angle, phase, zero),
            {"units": "rad", "long_name": "standard deviation of the frames about the mean, camera noise included"},
        )
    back = -round(zero * GRID)
    for name, field, unit in (("foot_speed", "speed", f"{tracks.unit}/s"), ("stance", "stance", "1")):
        rows = [np.roll(getattr(feet[leg], field), back) for leg in LEGS]
        data[name] = (("leg", "phase"), np.array(rows), {"units": unit})
    return data


def _positive(name: str) -> str:
    return "right" if name.endswith("lateral") else "down"


def _left_over(tracks: Tracks, one: PeriodicFit, phase: np.ndarray, zero: float) -> np.ndarray:
    """Standard deviation of the frames about the mean cycle, in bins of phase, drawn through [rad]."""
    phases = np.mod(tracks.time / one.period - zero, 1.0)
    bins = np.minimum((phases * _BINS).astype(int), _BINS - 1)
    use = np.isfinite(one.residual)
    count = np.bincount(bins[use], minlength=_BINS)
    power = np.bincount(bins[use], weights=one.residual[use] ** 2, minlength=_BINS)
    spread = np.where(count > 1, np.sqrt(power / np.maximum(count, 1)), one.noise)
    return np.asarray(np.interp(phase, (np.arange(_BINS) + 0.5) / _BINS, spread, period=1.0))
