"""Other ways to write a gait down: in metres for the article's robot, by places along the body, and as a roll.

Files hold the first two, and the built-in crawls are written in the first; each becomes a ``Gait`` for a robot, and
nothing that simulates, draws or measures knows them.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from math import pi
from typing import Any, Literal, Self

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits
from suchus.robot.design import LEGS, Robot, check_needs
from suchus.robot.motion.axis import Waves, yaw_hinges
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.limits import check_limits, check_speeds
from suchus.robot.motion.parts import Bend, FixedLimbs, FootPath, Limbs, Sweep
from suchus.robot.motion.swim import hold_limb

DIAGONAL = (0.0, 0.5, 0.5, 0.0)
"""Phases at which LF, RF, LH and RH pull on the trunk in the article's law [cycle]."""
_ERECT = (-pi / 2, pi / 2)  # [rad]; the elbow behind, the knee ahead
_METRES = 12  # digits of a metre that a share of the reach gives back
_MAX_WAVES = 10.0  # along the body [-]
_MIN_BEND, _WAVE_TOLERANCE = (
    1e-12,
    1e-6,
)  # [rad], below which a hinge does not bend; [cycle] or [rad], by which a wave may be off
_ALLOWED = {
    "period": (1e-3, 3600.0, "s"),
    "duty_factor": (0.05, 0.95, ""),
    "stroke": (-10.0, 10.0, "m"),
    "lift": (0.0, 10.0, "m"),
    "front_reach": (-10.0, 10.0, "m"),
    "hind_reach": (-10.0, 10.0, "m"),
    "front_ahead": (-10.0, 10.0, "m"),
    "hind_ahead": (-10.0, 10.0, "m"),
    "hip_height": (1e-4, 10.0, "m"),
    "trunk_bend": (0.0, 3.1416, "rad"),
    "spine_phase": (-1.0, 1.0, "cycle"),
    "tail_bend": (0.0, 3.1416, "rad"),
    "tail_phase": (-1.0, 1.0, "cycle"),
    "tail_pitch": (-3.1416, 3.1416, "rad"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitInMetres:
    """A gait of four legs, a trunk and a tail, in metres."""

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, float, float, float]
    """Phase of LF, RF, LH, RH when the walk begins [cycle]."""
    stroke: float
    """Half of the distance that a foot moves back in stance, in its girdle's frame [m]."""
    lift: float
    """Height to which a foot is lifted in swing [m]."""
    front_reach: float
    """Distance by which a front foot stands outside its hip [m]."""
    hind_reach: float
    """Distance by which a hind foot stands outside its hip [m]."""
    front_ahead: float
    """Distance by which the middle of a front foot's path lies ahead of its hip [m]."""
    hind_ahead: float
    """Distance by which the middle of a hind foot's path lies ahead of its hip [m]."""
    legs: Literal["sprawled", "erect"]
    """How legs stand. ``sprawled``: the plane of a leg turns with its foot, as in the article's Fig. 3a. ``erect``: it
    stays upright along the body, the elbow behind and the knee ahead, as in Fig. 3b; both reaches are zero."""
    hip_height: float
    """Height of both girdles' hip axes above the ground [m]."""
    trunk_bend: float
    """Amplitude of the lateral bend of the whole trunk, the sum of its yaw angles [rad]."""
    spine_phase: float
    """Phase lag of the trunk's bend behind the legs [cycle]; 0: each girdle carries its swing foot forward."""
    tail_bend: float
    """Amplitude of the lateral bend of the tail [rad]."""
    tail_phase: float
    """Phase lag of the tail's bend behind the trunk's [cycle]; 0: head and tail swing to opposite sides."""
    tail_pitch: float
    """Steady angle of the tail's pitch joint, down positive [rad]: the ground carries the tail, or it is lifted."""

    def __post_init__(self) -> None:
        with Checks("gait", self) as checks:
            for field, (lower_bound, upper_bound, unit) in _ALLOWED.items():
                checks.number(field, lower_bound, upper_bound, unit)
            checks.each("limb_phases", LEGS, -1.0, 1.0, "cycle")
            checks.that(
                self.legs != "erect" or (self.front_reach, self.hind_reach) == (0.0, 0.0),
                f"gait.front_reach is {self.front_reach:g} m and gait.hind_reach {self.hind_reach:g} m; erect legs "
                "stand below their hips, so that both must be 0 m",
            )

    def gait(self, reaches: Sequence[float]) -> Gait:
        """Return the gait for limbs of these lengths.

        Args:
            reaches: lengths of the front and of the hind limbs [m].
        """
        front, hind = reaches
        swivels = _ERECT if self.legs == "erect" else (0.0, 0.0)
        outward, forward = (self.front_reach, self.hind_reach), (self.front_ahead, self.hind_ahead)
        tail_lag = self.spine_phase + self.tail_phase + 0.5  # behind the limbs; head and tail to opposite sides
        return Gait(
            name=self.name,
            period=self.period,
            duty_factor=self.duty_factor,
            limb_phases=self.limb_phases,
            limbs=tuple(
                FootPath(
                    stroke=self.stroke / reach,
                    lift=self.lift / reach,
                    outward=outward[i] / reach,
                    ahead=forward[i] / reach,
                    swivel=swivels[i],
                )
                for i, reach in enumerate((front, hind))
            ),
            height=self.hip_height / hind,
            axis=(
                Bend(part="trunk", amplitude=(self.trunk_bend,), lag=(self.spine_phase,)),
                Bend(part="tail", amplitude=(self.tail_bend,), lag=(tail_lag,)),
                Bend(part="tail", turn="pitch", offset=self.tail_pitch),
            ),
            coupling=() if _opposite(self.limb_phases) else DIAGONAL,
        )

    @classmethod
    def from_gait(cls, gait: Gait, reaches: Sequence[float]) -> Self:
        """Return a gait in metres with the numbers of a gait, of its first limbs and knots where it has several.

        Args:
            gait: gait of foot paths for two girdles.
            reaches: lengths of the front and of the hind limbs [m].

        Raises:
            OutsideLimits: it has other limbs.
        """
        front, hind = reaches
        paths = [limb for limb in gait.limbs if isinstance(limb, FootPath)]
        if len(paths) != 2 or len(gait.limbs) != 2:
            raise OutsideLimits(
                f"gait {gait.name!r} has no foot paths of two pairs of limbs, which alone can be given in metres: "
                "write limbs and axis instead."
            )
        trunk, tail = (_first_bend(gait, region, "yaw") for region in ("trunk", "tail"))
        return cls(
            name=gait.name,
            period=gait.period,
            duty_factor=gait.duty_factor,
            limb_phases=gait.limb_phases,  # type: ignore[arg-type]
            stroke=round(paths[0].stroke * front, _METRES),
            lift=round(paths[0].lift * front, _METRES),
            front_reach=round(paths[0].outward * front, _METRES),
            hind_reach=round(paths[1].outward * hind, _METRES),
            front_ahead=round(paths[0].ahead * front, _METRES),
            hind_ahead=round(paths[1].ahead * hind, _METRES),
            legs="erect" if abs(paths[0].swivel) > pi / 4 else "sprawled",
            hip_height=round(gait.height * hind, _METRES),
            trunk_bend=trunk.amplitude[0],
            spine_phase=_wrapped(trunk.lag[0]),
            tail_bend=tail.amplitude[0],
            tail_phase=_wrapped(tail.lag[0] - trunk.lag[0] - 0.5),
            tail_pitch=_first_bend(gait, "tail", "pitch").offset,
        )

    def override(self, base: Gait, field_names: Collection[str], reaches: Sequence[float]) -> Gait:
        """Return a gait with some numbers of this one and all others of a base.

        Args:
            base: gait of foot paths for two girdles.
            field_names: fields to take from here.
            reaches: lengths of the front and of the hind limbs [m].
        """
        own_gait = self.gait(reaches)
        fields: dict[str, Any] = {
            name: getattr(own_gait, name) for name in ("period", "duty_factor") if name in field_names
        }
        if "limb_phases" in field_names:
            fields |= {"limb_phases": own_gait.limb_phases, "coupling": own_gait.coupling}
        if "hip_height" in field_names:
            fields["height"] = own_gait.height
        limbs = []
        for girdle, base_limb, own_limb in zip(("front", "hind"), base.limbs, own_gait.limbs, strict=True):
            sources = {"stroke": "stroke", "lift": "lift", "outward": f"{girdle}_reach", "ahead": f"{girdle}_ahead"}
            sources["swivel"] = "legs"
            new_fields = {name: getattr(own_limb, name) for name, source in sources.items() if source in field_names}
            limbs.append(replace(base_limb, **new_fields))
        axis = {(bend.part, bend.turn): bend for bend in base.axis}
        for bend in own_gait.axis:
            base_bend = axis.get((bend.part, bend.turn), Bend(part=bend.part, turn=bend.turn))
            if bend.turn == "pitch":
                new_bend = replace(base_bend, offset=bend.offset) if "tail_pitch" in field_names else base_bend
            else:
                new_bend = (
                    replace(base_bend, amplitude=bend.amplitude) if f"{bend.part}_bend" in field_names else base_bend
                )
                lag_fields = {"spine_phase"} if bend.part == "trunk" else {"spine_phase", "tail_phase"}
                new_bend = replace(new_bend, lag=bend.lag) if lag_fields & set(field_names) else new_bend
            if new_bend != Bend(part=bend.part, turn=bend.turn) or (bend.part, bend.turn) in axis:
                axis[bend.part, bend.turn] = new_bend
        return replace(base, name=self.name, limbs=tuple(limbs), axis=tuple(axis.values()), **fields)


def in_metres(gait: Gait) -> bool:
    """Return whether a gait has exactly the limbs and bends of a gait in metres."""
    bends = [(bend.part, bend.turn) for bend in gait.axis]
    paths = len(gait.limbs) == 2 and all(isinstance(limb, FootPath) for limb in gait.limbs)
    return paths and not gait.curves and bends == [("trunk", "yaw"), ("tail", "yaw"), ("tail", "pitch")]


def _first_bend(gait: Gait, region: str, turn: str) -> Bend:
    """Return the first bend of a part, or none at all."""
    zero_bend = Bend(part=region, turn=turn)  # type: ignore[arg-type]
    return next((bend for bend in gait.axis if (bend.part, bend.turn) == (region, turn)), zero_bend)


def _wrapped(lag: float) -> float:
    """Return a lag of -1 to 1, the same in the cycle [cycle]."""
    return lag - round(lag) if abs(lag) > 1.0 else lag


def _opposite(phases: Sequence[float]) -> bool:
    """Return whether limbs are in diagonal pairs, so that the gait's own phases are those of the article's law."""
    return all((phase - phases[0] - pull) % 1.0 == 0.0 for phase, pull in zip(phases, DIAGONAL, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class AxialWave:
    """How each hinge of the axis bends sideways, by its place along the body.

    A hinge at the place s bends by amplitude(s) cos 2 pi (clock - phase - waves s), with its concave side to the right
    where the value is positive. With ``waves`` 0 it is a standing wave.
    """

    amplitude: tuple[tuple[float, float], ...]
    """Place along the body, 0 at the snout and 1 at the tip of the tail [-], and amplitude of a hinge there [rad]."""
    waves: float
    """Wavelengths along the body; the wave runs from head to tail where positive [-]."""
    phase: float
    """Phase lag [cycle]; 0: concave on the right a quarter of a cycle before the first limb's mid-stance."""
    offset: float = 0.0
    """Steady bend of every hinge, concave on the left where positive, to turn left [rad]."""

    def __post_init__(self) -> None:
        with Checks("wave", self) as check:
            check.number("waves", -_MAX_WAVES, _MAX_WAVES, "")
            check.number("phase", -1.0, 1.0, "cycle")
            check.number("offset", -pi, pi, "rad")
            knots = self.amplitude
            shaped = bool(knots) and all(len(knot) == 2 for knot in knots)
            check.that(
                shaped
                and all(0.0 <= s <= 1.0 and abs(a) <= pi for s, a in knots)
                and all(lower_knot[0] < upper_knot[0] for lower_knot, upper_knot in pairwise(knots)),
                f"wave.amplitude is {str(knots)[:80]}; pairs of a place that increases from 0 to 1 and an angle of "
                "-3.14 to 3.14 rad are needed",
            )

    def bends(self, robot: Robot) -> tuple[Bend, ...]:
        """Return the bends of the parts of a robot's axis, each with a knot for every hinge."""
        places, angles = zip(*self.amplitude, strict=True)
        hinges, region_bends = yaw_hinges(robot), []
        parts: tuple[Literal["neck", "trunk", "tail"], ...] = ("neck", "trunk", "tail")
        for region in parts:
            hinge_indices = hinges.indices_in(region)
            positions = [hinges.axial_positions[k] for k in hinge_indices]
            amplitude = [len(hinge_indices) * float(np.interp(place, places, angles)) for place in positions]
            if not (any(amplitude) or (hinge_indices and self.offset)):
                continue
            lag = [
                self.phase + self.waves * place + (0.5 if a < 0.0 else 0.0)
                for a, place in zip(amplitude, positions, strict=True)
            ]
            region_bends.append(
                Bend(
                    part=region,
                    amplitude=_plain([abs(a) for a in amplitude]),
                    lag=_plain(lag),
                    offset=len(hinge_indices) * self.offset,
                )
            )
        return tuple(region_bends)

    @classmethod
    def from_gait(cls, gait: Gait, robot: Robot) -> Self:
        """Return the wave by which a gait bends the axis of a robot.

        Raises:
            OutsideLimits: its hinges bend as no such wave does.
        """
        hinges = yaw_hinges(robot)
        gait_waves, places = Waves(hinges, "yaw", [gait]), np.array(hinges.axial_positions)
        swings, offsets = (
            gait_waves.swing[0] / gait_waves.hinge_counts[0],
            gait_waves.offset[0] / gait_waves.hinge_counts[0],
        )
        is_bent = np.abs(swings) > _MIN_BEND
        lags = np.where(is_bent, np.mod(-np.angle(-swings) / (2 * pi), 1.0), 0.0)
        waves = _slope(places[is_bent], lags[is_bent])
        steady = float(offsets[0]) if len(offsets) else 0.0
        if waves is None or np.any(np.abs(offsets - steady) > _WAVE_TOLERANCE):
            raise OutsideLimits(
                f"gait {gait.name!r} bends robot {robot.name!r} as no wave of one phase does: give the whole wave, "
                "amplitude, waves and phase."
            )
        phase_lag = float((lags - waves * places)[is_bent][0]) if is_bent.any() else 0.0
        signed = np.abs(swings) * np.where(np.cos(2 * pi * (lags - waves * places - phase_lag)) < 0.0, -1.0, 1.0)
        knots = tuple((float(place), float(angle)) for place, angle in zip(places, signed, strict=True))
        return cls(amplitude=knots or ((0.0, 0.0),), waves=waves, phase=phase_lag - round(phase_lag), offset=steady)


def _slope(places: np.ndarray, lags: np.ndarray) -> float | None:
    """Return the smallest growth of the lag along the body, half cycles aside [cycle]; None if no wave fits.

    Args:
        places: positions of the hinges along the body [body length].
        lags: phase lags of their bends [cycle].
    """
    if len(places) < 2:
        return 0.0
    slopes = np.subtract(lags[1] - lags[0], np.arange(-2, 3) / 2) / (places[1] - places[0])
    for slope in sorted(slopes, key=abs):
        halves = 2 * (lags - lags[0] - slope * (places - places[0]))
        if abs(slope) <= _MAX_WAVES and np.all(np.abs(halves - np.round(halves)) < _WAVE_TOLERANCE):
            return float(slope)
    return None


def _plain(row: list[float]) -> tuple[float, ...]:
    """Return a row of knots, shortened to one knot where all are equal."""
    return (row[0],) if len(set(row)) == 1 else tuple(row)


@dataclass(frozen=True, slots=True, kw_only=True)
class FootPathByPlane:
    """A foot path whose limb is turned by its ``plane``; see ``FootPath``, whose ``swivel`` it is."""

    stroke: float
    """Half of the distance that a foot moves back in stance [limb reach]."""
    lift: float
    """Height to which it is lifted in swing [limb reach]."""
    outward: float
    """Distance by which it stands outside its hip [limb reach]."""
    ahead: float
    """Distance by which the middle of its path lies ahead of its hip [limb reach]."""
    plane: float = 0.0
    """Of a limb of four hinges: how far the elbow is turned forward about the line from hip to foot [rad]."""

    def limbs(self, robot: Robot, girdle: int) -> FootPath:
        """Return the path; a limb of yaw, pitch and knee has no plane."""
        hinges = len(robot.girdles[girdle].limb.hinges)
        swivel = self.plane if hinges > len(("yaw", "pitch", "knee")) else 0.0
        return FootPath(stroke=self.stroke, lift=self.lift, outward=self.outward, ahead=self.ahead, swivel=swivel)


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitByPlaces:
    """A gait of any body: the movement of each girdle's limbs, and a wave by places along the axis."""

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, ...]
    """Phase of each limb when the movement begins, in the order of the robot's limbs [cycle]."""
    girdles: tuple[FootPathByPlane | Sweep | FixedLimbs, ...]
    """Movement of the limbs of each girdle, from the front one."""
    height: float
    """Height of the hindmost girdle's hips above the ground [reach of its limb]; 0 for a body on its belly."""
    wave: AxialWave
    """Wave by which the axis bends."""

    def gait(self, robot: Robot) -> Gait:
        """Return the gait for a robot, whose hinges' places the wave is read at."""
        limbs: list[Limbs] = []
        for i, girdle in enumerate(self.girdles):
            if isinstance(girdle, FootPathByPlane):
                _check_girdles(robot, self.name, len(self.girdles))
                limbs.append(girdle.limbs(robot, i))
            else:
                limbs.append(girdle)
        return Gait(
            name=self.name,
            period=self.period,
            duty_factor=self.duty_factor,
            limb_phases=self.limb_phases,
            limbs=tuple(limbs),
            height=self.height,
            axis=self.wave.bends(robot),
        )

    @classmethod
    def from_gait(cls, gait: Gait, wave: AxialWave) -> Self:
        """Return a gait in this form, with a wave in the place of its bends."""
        return cls(
            name=gait.name,
            period=gait.period,
            duty_factor=gait.duty_factor,
            limb_phases=gait.limb_phases,
            girdles=tuple(
                FootPathByPlane(
                    stroke=limb.stroke, lift=limb.lift, outward=limb.outward, ahead=limb.ahead, plane=limb.swivel
                )
                if isinstance(limb, FootPath)
                else limb
                for limb in gait.limbs
            ),
            height=gait.height,
            wave=wave,
        )


def _check_girdles(robot: Robot, name: str, count: int) -> None:
    """Refuse a robot that has another number of girdles than the gait."""
    girdles = robot.girdles
    if len(girdles) != count:
        raise OutsideLimits(
            f"gait {name!r} is for {count} pairs of limbs; robot {robot.name!r} has {len(girdles)}: choose a gait made "
            "for it."
        )


def limb_reaches(robot: Robot) -> tuple[float, float]:
    """Return the lengths of a robot's front and hind limbs, for gaits in metres [m].

    Raises:
        OutsideLimits: it has not two pairs of limbs.
    """
    girdles = robot.girdles
    if len(girdles) != 2:
        raise OutsideLimits(
            f"a gait in metres is for two pairs of limbs; robot {robot.name!r} has {len(girdles)}: choose a gait made "
            "for it, with limbs and axis."
        )
    return girdles[0].limb.reach, girdles[1].limb.reach


def form_of(data: Mapping[str, Any]) -> type[GaitInMetres | GaitByPlaces] | None:
    """Return the form whose own fields the top of a file names; None if it is that of a ``Gait``."""
    for form in (GaitInMetres, GaitByPlaces):
        if ({field.name for field in fields(form)} - {field.name for field in fields(Gait)}) & set(data):
            return form
    return None


def roll(
    robot: Robot,
    *,
    period: float,
    trunk: tuple[float, float] = (0.0, 0.0),
    tail: tuple[float, float] = (0.0, 0.0),
    lag: float = 0.25,
    tail_lag: float = 0.0,
) -> Gait:
    """Return a death roll: a bend that goes around the body once in a cycle turns the body the other way.

    Trunk and tail each bend by two perpendicular waves, a lateral and a vertical one; limbs are folded back. The trunk
    bends to the left by ``trunk[0] cos 2 pi t`` and down by ``trunk[1] cos 2 pi (t - lag)``, with t in cycles.

    Args:
        robot: robot that rolls.
        period: period of a cycle [s].
        trunk: amplitudes of the trunk's lateral and vertical bend, each of all its hinges together [rad].
        tail: those of the tail [rad].
        lag: phase lag of the vertical bends behind the lateral ones [cycle]; 0.25 and -0.25 roll oppositely.
        tail_lag: phase lag of the tail behind the trunk [cycle]: 0 makes a C of the body, 0.5 an S.

    Raises:
        UnsuitedRobot: it has no hinges for a bend.
        OutsideLimits: a joint would have to leave its range, or a servo to turn faster than it can.
    """
    bends = (
        ("trunk", Bend(part="trunk", amplitude=trunk[:1])),
        ("trunk_pitch", Bend(part="trunk", turn="pitch", amplitude=trunk[1:], lag=(lag,))),
        ("tail_yaw", Bend(part="tail", amplitude=tail[:1], lag=(tail_lag,))),
        ("tail_pitch", Bend(part="tail", turn="pitch", amplitude=tail[1:], lag=(tail_lag + lag,))),
    )
    check_needs(robot, [need for need, bend in bends if any(bend.amplitude)], "a death roll")
    limbs = tuple(hold_limb(girdle.limb, (-pi / 2, 0.0)) for girdle in robot.girdles)
    gait = Gait(
        name="death_roll",
        period=period,
        limb_phases=(0.0,) * (2 * len(limbs)),
        limbs=limbs,
        axis=tuple(bend for _, bend in bends),
    )
    check_limits(robot, gait)
    check_speeds(robot, gait)
    return gait
