"""A measured walk: its mean cycle, its numbers with their spread, and the kind of its wave."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.animals.capture.angles import azimuth, bend_angles, joint_bends, standing_index, wrapped
from suchus.animals.capture.camera import GroundMotion, rest_ground
from suchus.animals.capture.cycle import PeriodicFit, find_period, fit, harmonics_for
from suchus.animals.capture.feet import GRID, FootContact, FootSweep, contact, continuous, forward_path, steps, sweep
from suchus.animals.capture.late import find_late_keypoints
from suchus.animals.capture.names import check_feet, check_trunk, unused_text
from suchus.animals.capture.pauses import longest_bout
from suchus.animals.capture.screen import screen_tracks
from suchus.animals.capture.strides import half_width, over_phase, per_stride, times
from suchus.animals.capture.surface import level_surface
from suchus.animals.capture.swings import Clock, walk_clock
from suchus.animals.capture.tracks import (
    Tracks,
    UnusableTracks,
    check_size,
    check_tracks,
    lacking,
    with_gaps,
    without_absurd_positions,
)
from suchus.core.checks import require
from suchus.robot.design import LEGS

UNSURE = 0.1
"""Half width of a duty factor's interval above which the foot is left out of the gait's duty factor [-]."""
_BLIND = 0.25  # the same above which a walk is refused, if all feet exceed it
_STRAIGHT = 1e-6  # [rad]; smaller bends have no phase
_BINS = 20  # bins of phase, for the spread
_SHARP = 3.0  # least amplitude of a bend over its standard error
_MIN_VISIBLE_FRACTION = 0.25  # least fraction of frames with all points of a signal
_MIN_BENDING_POINTS = 4  # points of a midline, from more on its bends show the period
_MIN_LAG = 0.015  # [cycle]; phase lag of a foot that may be late in the film
_LAG_TOLERANCE = 0.35  # relative difference between its phase lag and its lag in position
_PLACE_ERROR = 0.005  # error of a step by the unknown shape of the swing, over its length
_PLACES = 0.8  # least fraction of frames with a point, for its advance in a cycle
_MAX_CYCLE_GAP = 0.25  # greatest fraction of a cycle in which an angle is not seen, for its reading in that cycle
_TURNS = 0.1  # [rad per cycle]; turning from which on the advance is taken along the path
_ADVANCE = 0.3  # least advance of the body over the distance that feet sweep


class Measurement(NamedTuple):
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
    has_heights: bool
    """Whether heights were seen."""
    tail_share: float
    """Where along the tail its lateral angle was taken, 1 at the tip [-]."""
    numbers: Mapping[str, Measurement]
    """Every number by name; see ``docs/capture.md``."""
    bends: Mapping[str, complex]
    """First harmonic of each of the four angles: the angle is its steady part and the real part of this times
    ``exp(2 pi i phase)`` [rad]."""
    wrong: tuple[str, ...]
    """Keypoints that were tracked and are not to be trusted; ``notes`` say why."""
    lacks: tuple[str, ...]
    """Keypoints that a gait is read from and that were not tracked, or not to be trusted."""
    notes: tuple[str, ...]
    """What is wrong with keypoints, and what the tracks do not show, a sentence each."""
    strides: xr.Dataset
    """Every stride by itself, over ``stride`` and ``leg``, with intervals: see ``strides.per_stride``."""
    phases: xr.Dataset
    """Angles and curvature over ``phase``, ``leg`` and ``place``, with intervals: see ``strides.over_phase``."""
    cycle: xr.Dataset
    """The mean cycle over ``phase`` and ``leg``: the four angles with ``<name>_spread``, ``foot_speed``, ``stance``.
    Phase 0 is where a gait of this footfall begins: LF starts to swing."""

    slope: float = 0.0
    """Angle of the surface on which the animal walks against level, pi/2 on a wall, pi on a ceiling; 0 where it is
    nearly level or not seen [rad]."""

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
        UnusableTracks: too few keypoints are there or can be trusted, some are exchanged, units are wrong, the animal
            stands, nothing repeats, less than one cycle was seen, noise hides the steps, or the camera goes along.
    """
    require("observe", "tail_share", tail_share, 0.05, 1.0, "")
    check_trunk(tracks)
    check_tracks(tracks)
    check_feet(tracks)
    unused = unused_text(tracks.points)
    tracks = with_gaps(without_absurd_positions(tracks))
    surface = level_surface(tracks)
    tracks, pauses = longest_bout(surface.tracks)
    screening = screen_tracks(tracks)
    ground = _rest_ground(screening.tracks)
    screening = screening._replace(tracks=ground.tracks)
    faults = dict(screening.wrong)
    tail_end = tracks.tail_chain[-2:]
    while True:
        if len(tail_end) == 2 and tail_end[0] in faults and tail_share > 0.5 and "tail_tip" not in faults:
            faults["tail_tip"] = f"does not show how the tail bends without {tail_end[0]}"
        trusted_tracks = screening.tracks.without(faults)
        tracks, clock, period = _timed(trusted_tracks)
        runs_late = find_late_keypoints(tracks, clock, trusted_tracks.time)
        if not runs_late:
            break
        faults |= runs_late
        if len(screening.tracks.without(faults).trunk_chain) < 2:
            names = ", ".join(f"{name} {reason}" for name, reason in runs_late.items())
            raise UnusableTracks(f"in {tracks.source} frames of one keypoint are not those of others: {names}.")
    mean_reading = _fit_reading(tracks, period, tail_share)
    feet: dict[str, FootContact] = {}
    for leg in tracks.legs:
        foot_contact = contact(tracks, leg, period)
        if foot_contact is None:
            faults[leg] = (
                "makes no step that can be seen from one stance to the next: film more cycles, or track it again"
            )
        else:
            feet[leg] = foot_contact
    tracks = tracks.without(faults)
    count = int((tracks.time[-1] - tracks.time[0]) / period + 0.05)
    cycle_readings = [
        _fit_reading(_cycle(tracks, i, period), period, tail_share, max_gap=_MAX_CYCLE_GAP) for i in range(count)
    ]
    advances = [cycle_reading.advance for cycle_reading in cycle_readings if np.isfinite(cycle_reading.advance)] or [
        mean_reading.advance
    ]
    mean_reading = mean_reading._replace(advance=float(np.mean(advances)))  # along a path that may be curved
    _check_advance(mean_reading, tracks.source)
    _check_feet(feet, tracks.source)
    zero = _zero(feet)
    strides = per_stride(tracks, clock, feet, zero)
    mean_reading = mean_reading._replace(advance=_advance_on_curve(strides, mean_reading.advance))
    numbers = _measurements(mean_reading, cycle_readings, feet, zero, clock, tracks.time[0])
    if np.isfinite(mean_reading.trunk):
        lengths = np.array(
            [cycle_reading.trunk for cycle_reading in cycle_readings if np.isfinite(cycle_reading.trunk)]
        )
        spread = float(np.std(lengths, ddof=1)) if len(lengths) > 1 else float("nan")
        numbers["trunk_length"] = Measurement(
            mean_reading.trunk, spread, float(half_width(mean_reading.trunk, lengths, 0.0)), tracks.unit
        )
    numbers |= _paced(strides, numbers["period"], mean_reading, tracks.unit)
    _widen_by_ground(numbers, ground.error, mean_reading)
    unsure = 0.0  # of where the cycle begins
    if feet:
        lead = feet.get("LF") or next(iter(feet.values()))
        duties = float(np.mean([foot.duty_error for foot in feet.values()])) / 2
        unsure = float(np.hypot(lead.middle_error, duties))
    unlike = _widen_late_phases(numbers)
    for name, chain in _chains(tracks).items():
        numbers[f"standing_{name}"] = Measurement(_index(tracks, chain, period), float("nan"), float("nan"), "-")
    return Walk(
        source=tracks.source,
        cycles=float((tracks.time[-1] - tracks.time[0]) / period),
        has_heights=tracks.has_heights,
        tail_share=tail_share,
        numbers=numbers,
        bends={name: complex(_first_harmonic(mean_reading.angles[name], zero)) for name in mean_reading.angles},
        wrong=tuple(faults),
        lacks=lacking(tracks.points),
        notes=(
            *(f"{name} {reason}" for name, reason in faults.items()),
            *surface.notes,
            *pauses,
            *ground.notes,
            *([unused] if unused else ()),
            *_missing_point_notes(tracks),
            *screening.notes,
            *unlike,
            *_uncertain_feet_notes(feet, (tracks.time[-1] - tracks.time[0]) / period),
        ),
        strides=strides,
        phases=over_phase(
            tracks,
            mean_reading.angles,
            mean_reading.sweeps,
            [(cycle_reading.angles, cycle_reading.sweeps) for cycle_reading in cycle_readings],
            period,
            zero,
            unsure,
        ),
        cycle=_mean_cycle(tracks, mean_reading, feet, zero),
        slope=surface.slope,
    )


def _rest_ground(tracks: Tracks) -> GroundMotion:
    """Return the tracks over ground at rest; as they are where nothing repeats, which is refused later."""
    try:
        period = find_period(tracks.time, np.array(list(_swinging(tracks).values())), tracks.source)
    except UnusableTracks:
        return GroundMotion(tracks, 0.0, ())
    return rest_ground(tracks, period)


def _widen_by_ground(numbers: dict[str, Measurement], error: float, reading: _Reading) -> None:
    """Widen the intervals of lengths over the ground by the uncertainty of the ground's velocity [m/s or px/s]."""
    scales = {"stride": reading.period / reading.trunk, "stride_length": reading.period, "speed": 1.0}
    for name, number in list(numbers.items()):
        scale = scales.get(name, reading.period if name.startswith("step_length") else 0.0)
        if error and scale:
            numbers[name] = number._replace(error=float(np.hypot(number.error, error * scale)))


def _timed(tracks: Tracks) -> tuple[Tracks, Clock, float]:
    """Return the tracks on a clock with equal strides, that clock, and the period [s]."""
    check_size(tracks)
    tracks = tracks.ahead()
    signals = _swinging(tracks)
    rough_period = find_period(tracks.time, np.array(list(signals.values())), tracks.source)
    clock = walk_clock({leg: steps(tracks, leg, rough_period) for leg in tracks.legs}, rough_period)
    return replace(tracks, time=clock.read(tracks.time)), clock, clock.period


_KEYPOINTS_NEEDED = {
    "the spine's bend": ("neck or snout", "shoulder", "hip", "tail_base"),
    "the tail's bend": ("hip", "tail_base", "tail_tip"),
    "the trunk's length, and lengths in trunk lengths": ("shoulder", "hip"),
    "phases, which count from LF": ("LF",),
}


def _missing_point_notes(tracks: Tracks) -> list[str]:
    """Return sentences on what is unknown because keypoints are missing."""
    missing = set(lacking(tracks.points))
    missing |= {"neck or snout"} if "neck (or snout)" in missing else set()
    notes, footless = [], not tracks.legs
    for quantity, points in _KEYPOINTS_NEEDED.items():
        missing_points = [name for name in points if name in missing]
        if missing_points and not (footless and missing_points == ["LF"]):
            notes.append(f"without {' and '.join(missing_points)}, unknown: {quantity}")
    if footless:
        notes.append(
            "no foot is tracked, as of a body without limbs or one that swims: phases count from the film's beginning"
        )
    for leg in LEGS:
        if leg in missing and not footless:
            notes.append(f"without {leg}, unknown: when it stands, its duty factor and its phase")
    if tracks.view == "side":
        notes.append("seen from the side, unknown: bends to the sides, and how far the body turns")
    return notes


def _measurements(
    mean_reading: _Reading,
    cycle_readings: Sequence[_Reading],
    feet: Mapping[str, FootContact],
    zero: float,
    clock: Clock,
    start: float,
) -> dict[str, Measurement]:
    """Return every number with its spread and its interval."""
    count, cycle_numbers, numbers = (
        len(cycle_readings),
        [_numbers(cycle_reading, zero) for cycle_reading in cycle_readings],
        {},
    )
    for name, value in _numbers(mean_reading, zero).items():
        deviations = _deviations(name, value, cycle_numbers)
        spread = float(np.std(deviations, ddof=1)) if len(deviations) > 1 else float("nan")
        error = float(half_width(0.0, deviations, 0.0))
        if name == "spine_rightmost":  # its phase counts from a foot
            if "LF" not in feet:
                continue
            duties = np.mean([foot.duty_error for foot in feet.values()]) / 2
            error = float(np.linalg.norm(np.array([error, feet["LF"].middle_error, duties], dtype=float)))
        numbers[name] = Measurement(value, spread, error, _unit(name))
    for leg, foot in feet.items():
        numbers[f"duty_{leg}"] = Measurement(foot.duty, foot.scatter, foot.duty_error, "-")
        if "LF" not in feet:
            continue
        lead_foot = feet["LF"]
        error = float(np.hypot(lead_foot.middle_error, foot.middle_error)) if leg != "LF" else 0.0
        numbers[f"phase_{leg}"] = Measurement((lead_foot.middle - foot.middle) % 1.0, float("nan"), error, "cycle")
    durations = np.diff(clock.seconds(start / mean_reading.period + np.arange(count + 1)))
    spread = float(np.std(durations, ddof=1)) if count >= 2 else float("nan")
    error = times(count) * spread / np.sqrt(count) if count >= 2 else float("nan")
    numbers["period"] = Measurement(mean_reading.period, spread, error, "s")
    return numbers


def _widen_late_phases(numbers: dict[str, Measurement]) -> list[str]:
    """Widen the intervals of the phases of feet that may be late in the film, and return notes.

    A foot with late frames has a late phase, and lies behind its partner by the distance that the body advances in that
    time.
    """
    notes = []
    for left_leg, right_leg in (LEGS[:2], LEGS[2:]):
        phase_names, offset_names = (
            [f"phase_{leg}" for leg in (left_leg, right_leg)],
            [f"ahead_{leg}" for leg in (left_leg, right_leg)],
        )
        if not {*phase_names, *offset_names, "stride"} <= set(numbers):
            continue
        phase_lead = (numbers[phase_names[1]].value - numbers[phase_names[0]].value) % 1.0 - 0.5
        error = max(numbers[name].error for name in phase_names)
        relative_offset = (numbers[offset_names[1]].value - numbers[offset_names[0]].value) / max(
            numbers["stride"].value, 1e-9
        )
        if (
            abs(phase_lead) > max(_MIN_LAG, 3 * error)
            and abs(phase_lead - relative_offset) < _LAG_TOLERANCE * abs(phase_lead) + error
        ):
            late_leg, partner = (right_leg, left_leg) if phase_lead < 0 else (left_leg, right_leg)
            notes.append(
                f"{late_leg} steps {abs(phase_lead):.3f} cycles after half a cycle from {partner} and lies as far "
                "behind it as "
                f"the body goes on in that time: either it limps, or the frames of {late_leg} or {partner} are not "
                "those of the other keypoints; phases are that uncertain"
            )
            affected_names = (
                (*(f"phase_{leg}" for leg in LEGS[1:]), "spine_rightmost")
                if "LF" in (left_leg, right_leg)
                else phase_names
            )
            for name in affected_names:
                if name in numbers:
                    numbers[name] = numbers[name]._replace(error=float(numbers[name].error + 1.2 * abs(phase_lead)))
    return notes


def _advance_on_curve(strides: xr.Dataset, advance: float) -> float:
    """Return the advance in a cycle: along the path of the strides if the animal turns [m or px]."""
    if "turning" not in strides or "stride_length" not in strides:
        return advance
    turns, lengths = strides.turning.values, strides.stride_length.values
    lengths = lengths[np.isfinite(lengths)]
    is_turning = np.isfinite(turns).any() and abs(float(np.nanmean(turns))) > _TURNS
    return float(np.mean(lengths)) if is_turning and len(lengths) else advance


def _paced(strides: xr.Dataset, period: Measurement, mean_reading: _Reading, unit: str) -> dict[str, Measurement]:
    """Return how far and how fast the body goes, and how it turns: means over all cycles, intervals over strides."""
    numbers, advance = {}, mean_reading.advance
    for name, size in (("stride_length", unit), ("speed", f"{unit}/s"), ("turning", "rad")):
        if name in strides:
            stride_values = strides[name].values
            stride_values = stride_values[np.isfinite(stride_values)]
            mean = float(np.mean(stride_values))
            value = {"stride_length": advance, "speed": advance / period.value}.get(name, mean)
            spread = float(np.std(stride_values, ddof=1)) if len(stride_values) > 1 else float("nan")
            error = float(half_width(value, stride_values, 0.0))
            if name == "speed":  # the mean of the speeds of strides is not the mean speed
                error = float(np.hypot(error, value * period.error / period.value))
            numbers[name] = Measurement(value, spread, error, size)
    for leg in strides.leg.values if "step_length" in strides else ():
        stride_values = strides.step_length.sel(leg=leg).values
        stride_values = stride_values[np.isfinite(stride_values)]
        if len(stride_values):
            error = float(
                np.hypot(
                    half_width(float(np.mean(stride_values)), stride_values, 0.0), _PLACE_ERROR * np.mean(stride_values)
                )
            )
            spread = float(np.std(stride_values, ddof=1)) if len(stride_values) > 1 else float("nan")
            numbers[f"step_length_{leg}"] = Measurement(float(np.mean(stride_values)), spread, error, unit)
    return numbers


def _check_feet(feet: Mapping[str, FootContact], source: str) -> None:
    """Refuse tracks in which noise hides stance and swing of all feet."""
    duty_errors = {leg: foot.duty_error for leg, foot in feet.items() if np.isfinite(foot.duty_error)}
    if duty_errors and min(duty_errors.values()) > _BLIND:
        leg = min(duty_errors, key=lambda name: duty_errors[name])
        raise UnusableTracks(
            f"in {source} noise hides the steps: even the duty factor of {leg} is known to ±{duty_errors[leg]:.2f} "
            f"only, at most ±{_BLIND:g} may be; film more cycles, faster, or nearer."
        )


def _uncertain_feet_notes(feet: Mapping[str, FootContact], cycles: float) -> tuple[str, ...]:
    """Return sentences on feet with uncertain steps, and the number of cycles that would be enough."""
    notes = []
    single_step_legs = [leg for leg, foot in feet.items() if not np.isfinite(foot.duty_error)]
    if single_step_legs:
        leg_names = " and ".join(single_step_legs)
        notes.append(
            f"one step of {leg_names} was filmed from stance to stance, which has no interval: film one more cycle"
        )
    for leg, foot in feet.items():
        if foot.duty_error > UNSURE:
            reason = (
                f"is hidden in {100 * foot.hidden:.0f} % of every cycle" if foot.hidden > 0.1 else "is seen too badly"
            )
            unsure = f"±{foot.duty_error:.2f} of the cycle"
            extra_cycles = int(np.ceil(cycles * ((foot.duty_error / UNSURE) ** 2 - 1)))
            extra_text = "" if foot.hidden > 0.1 else f"; about {extra_cycles} more cycles would make that ±{UNSURE:g}"
            notes.append(f"{leg} {reason}: when it lifts off and touches down is known to {unsure} only{extra_text}")
    return tuple(notes)


def _swinging(tracks: Tracks) -> dict[str, np.ndarray]:
    """Return signals that swing once a cycle: bends of trunk and tail, and the path of each foot along the body.

    Points that are lost in turns may leave no frame in which a bend can be seen.
    """
    angles = bend_angles(tracks)
    is_top_view = tracks.view == "top"
    signals = {
        "the spine's bend": angles.spine_lateral if is_top_view else angles.spine_vertical,
        "the tail's bend": angles.tail_lateral if is_top_view else angles.tail_vertical,
        **{f"the path of {leg}": forward_path(tracks, leg) for leg in tracks.legs},
    }
    has_points = {
        "the spine's bend": tracks.thorax and tracks.pelvis,
        "the tail's bend": tracks.pelvis and tracks.has("tail_tip"),
    }
    visible_signals = {}
    for name, series in signals.items():
        visible_fraction = np.isfinite(series).mean()
        if visible_fraction >= _MIN_VISIBLE_FRACTION:
            visible_signals[name] = series
        elif has_points.get(name, True):
            raise UnusableTracks(
                f"in {tracks.source} {name} can be seen in {100 * visible_fraction:.0f} % of the frames, at least "
                f"{100 * _MIN_VISIBLE_FRACTION:.0f} % are needed: its points are lost in turns; track them again."
            )
    if not visible_signals:  # a midline without girdles and feet: it bends, or its direction sways
        chain = tracks.midline
        bends = zip(chain[1:-1], joint_bends(tracks, chain), strict=True) if len(chain) > _MIN_BENDING_POINTS else ()
        visible_signals = {
            f"the bend at {name}": bend for name, bend in bends if np.isfinite(bend).mean() >= _MIN_VISIBLE_FRACTION
        }
    if not visible_signals:
        front, rear = tracks.line
        visible_signals["the trunk's direction"] = continuous(azimuth(tracks, front, rear))
    return visible_signals


def _fit_reading(tracks: Tracks, period: float, tail_share: float, *, max_gap: float = 1.0) -> _Reading:
    """Fit the angles, the advance and the foot paths of tracks over their mean cycle.

    Args:
        tracks: the keypoints, by the clock.
        period: of the cycle [s].
        tail_share: fraction of the tail's length at which its lateral angle is taken [-].
        max_gap: greatest fraction of successive frames in which an angle is not seen; in a single cycle a fit would go
            anywhere there [-].
    """
    angles = bend_angles(tracks, tail_share)._asdict()
    fits = {}
    for name, series in angles.items():
        frame_count = int(np.isfinite(series).sum())
        if frame_count and _longest_gap(series) <= max_gap * len(series):
            fits[name] = fit(
                tracks.time, series, period, harmonics=harmonics_for(frame_count, tracks.rate * period, max_harmonics=6)
            )
    place, advance = tracks.at(tracks.line[1]), float("nan")
    if np.isfinite(place[:, 0]).mean() >= _PLACES:
        advanced = [fit(tracks.time, place[:, i], period, harmonics=2, drift=1).drift[0] for i in (0, 1)]
        advance = float(np.hypot(*advanced)) * period
    sweeps = {leg: sweep(tracks, leg, period) for leg in tracks.legs}
    return _Reading(
        fits,
        {leg: foot_sweep for leg, foot_sweep in sweeps.items() if foot_sweep is not None},
        advance,
        tracks.trunk_length(),
        period,
        tail_share,
    )


def _longest_gap(series: np.ndarray) -> int:
    """Return the greatest number of successive frames in which a quantity is not seen."""
    seen_frames = np.flatnonzero(np.isfinite(series))
    edges = np.concatenate([[-1], seen_frames, [len(series)]])
    return int(np.max(np.diff(edges))) - 1


def _numbers(reading: _Reading, zero: float) -> dict[str, float]:
    """Return the numbers of a reading by name: lengths over the trunk's [-], angles [rad], phases [cycle].

    Args:
        reading: fits over the mean cycle.
        zero: phase of the tracks' clock at which the gait begins [cycle].
    """
    bends = {name: _first_harmonic(reading.angles[name], zero) for name in reading.angles}
    spine, tail = (bends.get(name, 0j) for name in ("spine_lateral", "tail_lateral"))
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
    """Return the phase of the tracks' clock at which the gait begins [cycle].

    It is the mid-stance of LF minus the swing and half of the stance. Without LF the first tracked foot takes its
    place. Without feet it is 0.
    """
    if not feet:
        return 0.0
    duty = float(np.mean([foot.duty for foot in feet.values()]))
    lead_foot = feet.get("LF") or next(iter(feet.values()))
    return lead_foot.touch_down + lead_foot.duty / 2 - (1.0 - duty / 2)


def _first_harmonic(angle_fit: PeriodicFit, zero: float) -> complex:
    return complex(angle_fit.harmonics[0] * np.exp(2j * np.pi * zero))


def _cycle(tracks: Tracks, number: int, period: float) -> Tracks:
    start = tracks.time[0] + number * period
    return tracks.between(start, start + period)


def _deviations(name: str, value: float, cycle_numbers: Sequence[Mapping[str, float]]) -> np.ndarray:
    """Return the differences between a number of each cycle and that of all cycles; phases are wrapped."""
    deviations = np.array([numbers[name] for numbers in cycle_numbers if name in numbers]) - value
    return wrapped(2 * np.pi * deviations) / (2 * np.pi) if _unit(name) == "cycle" else deviations


def _unit(name: str) -> str:
    """Return the unit of a number of ``_numbers``."""
    stem = name.partition("_")[0]
    if stem in ("phase",) or name in ("spine_rightmost", "tail_lag"):
        return "cycle"
    if stem in ("stroke", "outward", "ahead", "lift", "stride"):
        return "trunk"
    return "-" if stem in ("duty", "retraction") or name.endswith("overtones") else "rad"


def _chains(tracks: Tracks) -> dict[str, tuple[str, ...]]:
    trunk, tail = tracks.trunk_chain, tracks.tail_chain
    return {"trunk": trunk, "tail": tail, "body": tuple(dict.fromkeys((*trunk, *tail)))}


def _index(tracks: Tracks, chain: tuple[str, ...], period: float) -> float:
    """Return the standing index of a chain, over joints whose bend exceeds the noise; NaN with fewer than two."""
    amplitude, phase = [], []
    for series in joint_bends(tracks, chain):
        bend = fit(tracks.time, series, period, harmonics=3)
        if abs(bend.harmonics[0]) > _SHARP * bend.error:
            amplitude.append(abs(bend.harmonics[0]))
            phase.append(np.angle(bend.harmonics[0]))
    return standing_index(amplitude, phase) if len(amplitude) > 1 else float("nan")


def _check_advance(reading: _Reading, source: str) -> None:
    """Refuse tracks in which the body advances less per cycle than a foot sweeps back."""
    if not reading.sweeps:
        return
    swept = 2 * float(np.mean([path.stroke for path in reading.sweeps.values()]))
    if reading.advance < _ADVANCE * swept:
        raise UnusableTracks(
            f"in {source} the body advances by {reading.advance / reading.trunk:.2f} of its trunk's length in a cycle "
            f"while its feet sweep {swept / reading.trunk:.2f} of it: it walks on a belt, on the spot, or the camera "
            "goes along; standing feet can only be recognised over ground that rests in the picture."
        )


def _mean_cycle(tracks: Tracks, reading: _Reading, feet: Mapping[str, FootContact], zero: float) -> xr.Dataset:
    """Return angles, foot speeds and stance over the phase of the mean cycle, with the scatter of the frames.

    Args:
        tracks: the keypoints, by the clock.
        reading: fits over the mean cycle.
        feet: contact of each foot.
        zero: phase of the tracks' clock at which the gait begins [cycle].
    """
    phase = np.arange(GRID) / GRID
    time = (phase + zero) * reading.period
    data = xr.Dataset(coords={"phase": ("phase", phase, {"units": "1"}), "leg": list(feet)})
    for name, angle in reading.angles.items():
        attrs = {"units": "rad", "long_name": f"{name.replace('_', ' ')}, {_positive(name)} positive"}
        data[name] = ("phase", angle.mean + angle.swing(time), attrs)
        data[f"{name}_spread"] = (
            "phase",
            _residual_spread(tracks, angle, phase, zero),
            {"units": "rad", "long_name": "standard deviation of the frames about the mean, camera noise included"},
        )
    back = -round(zero * GRID)
    for name, field, unit in (("foot_speed", "speed", f"{tracks.unit}/s"), ("stance", "stance", "1")):
        rows = [np.roll(getattr(feet[leg], field), back) for leg in feet]
        data[name] = (("leg", "phase"), np.array(rows).reshape(-1, GRID), {"units": unit})
    return data


def _positive(name: str) -> str:
    return "right" if name.endswith("lateral") else "down"


def _residual_spread(tracks: Tracks, angle_fit: PeriodicFit, phase: np.ndarray, zero: float) -> np.ndarray:
    """Return the standard deviation of the frames about the mean cycle, over the phase [rad]."""
    phases = np.mod(tracks.time / angle_fit.period - zero, 1.0)
    bins = np.minimum((phases * _BINS).astype(int), _BINS - 1)
    use = np.isfinite(angle_fit.residual)
    count = np.bincount(bins[use], minlength=_BINS)
    power = np.bincount(bins[use], weights=angle_fit.residual[use] ** 2, minlength=_BINS)
    spread = np.where(count > 1, np.sqrt(power / np.maximum(count, 1)), angle_fit.noise)
    return np.asarray(np.interp(phase, (np.arange(_BINS) + 0.5) / _BINS, spread, period=1.0))
