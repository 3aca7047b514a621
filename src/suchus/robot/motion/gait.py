"""A gait: the periodic movement of any body, on land or in water.

Four parts say all of it: timing, limbs, axis, and curves as they were measured. Lengths are shares of a limb's reach
and bends are those of a part of the body, so that a gait fits a body of another size and another number of joints; only
its period is in seconds.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import pi
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits, UnknownName
from suchus.robot.motion.parts import AxisRegion, Bend, Curve, FixedLimbs, FootPath, Limbs, Sweep, Turn

Ability = Literal["foot paths", "strokes", "wave", "tail pitch", "steering"]
"""What a gait has that may be changed: feet on paths, limbs that stride, an axis that bends sideways, a tail that it
lays down or lifts, and, for whoever changes size, stride and bend while it goes, no measured curves."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """A periodic movement of any body. Phases run from 0 to 1 [cycle]; each limb swings first, then stands."""

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float = 0.5
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, ...] = ()
    """Phase of each limb when the movement begins, in the order of the robot's limbs: left before right, from the front
    [cycle]."""
    limbs: tuple[Limbs, ...] = ()
    """Movement of the limbs of each girdle, from the front one; none where curves say all."""
    height: float = 0.0
    """Height of the hindmost girdle's hips above the ground [reach of its limb]; 0 for a body on its belly."""
    axis: tuple[Bend, ...] = ()
    """Bends of the axis; several of one part and turn add up."""
    curves: tuple[Curve, ...] = ()
    """Measured angles of servos."""
    coupling: tuple[float, ...] = ()
    """Phases of the limbs at which their pulls on the axis add up; those of the gait where empty [cycle].

    In a gait whose limbs are not quite in diagonal pairs the article's law, 0, 1/2, 1/2, 0, lets the axis follow the
    mean of the pairs.
    """

    def __post_init__(self) -> None:
        with Checks("gait", self) as check:
            check.printable([self.name])
            check.number("period", 1e-3, 3600.0, "s")
            check.number("duty_factor", 0.05, 0.95, "")
            check.number("height", 0.0, 2.0, "limb reach")
            for name in ("limb_phases", "coupling"):
                check.each(name, getattr(self, name), -1.0, 1.0, "cycle")
            check.that(
                not self.limbs or len(self.limb_phases) == 2 * len(self.limbs),
                f"gait {self.name} has {len(self.limb_phases)} limb phases for {len(self.limbs)} girdles; each limb "
                "needs one, left before right",
            )
            check.that(
                len(self.coupling) in (0, len(self.limb_phases)),
                f"gait {self.name} has {len(self.coupling)} phases of coupling for {len(self.limb_phases)} limbs; each "
                "limb needs one, or none is given",
            )
            servos = [curve.servo for curve in self.curves]
            duplicate = next((name for name in servos if servos.count(name) > 1), "")
            check.that(not duplicate, f"gait {self.name} has two curves for {duplicate}; leave one")

    def has(self, ability: Ability) -> bool:
        """Return whether a gait has an ability, see ``Ability``."""
        if ability == "foot paths":
            return any(isinstance(limb, FootPath) for limb in self.limbs)
        if ability == "strokes":
            return any(isinstance(limb, Sweep) or (isinstance(limb, FootPath) and limb.stroke) for limb in self.limbs)
        if ability == "wave":
            return any(bend.turn == "yaw" and any(bend.amplitude) for bend in self.axis)
        if ability == "tail pitch":
            return any(bend.turn == "pitch" and bend.part == "tail" for bend in self.axis)
        return not self.curves

    @property
    def frequency(self) -> float:
        """Cycles over time [Hz]."""
        return 1.0 / self.period

    @property
    def erect(self) -> bool:
        """Whether limbs stand erect below their hips, elbows behind and knees ahead; see ``FootPath.swivel``."""
        return any(isinstance(limb, FootPath) and abs(limb.swivel) > pi / 4 for limb in self.limbs)

    def needs_steering(self, consumer: str) -> None:
        """Refuse a gait whose strokes, heights and bends cannot be changed while it goes.

        Args:
            consumer: needs it, as the beginning of a sentence.

        Raises:
            OutsideLimits: it has measured curves.
        """
        if not self.has("steering"):
            raise OutsideLimits(
                f"{consumer} needs a gait of foot paths and bends; gait {self.name!r} has measured curves: choose a "
                "gait without, or an experiment that walks it in open loop."
            )

    def straightened(self, *parts: AxisRegion, name: str = "") -> "Gait":
        """Return the gait with regions of the axis held straight, all of them if none is named; a steady bend stays.

        Args:
            *parts: the regions.
            name: name of the new gait; that of this one if empty.
        """

        def is_selected(region: str) -> bool:
            return not parts or region in parts or "axis" in parts

        if parts and "axis" not in parts and any(bend.part == "axis" and any(bend.amplitude) for bend in self.axis):
            raise OutsideLimits(
                f"gait {self.name!r} bends the whole axis as one part, so that {', '.join(parts)} cannot be held "
                "straight alone: straighten the axis, or give neck, trunk and tail bends of their own."
            )
        return replace(
            self,
            name=name or self.name,
            axis=tuple(replace(bend, amplitude=(0.0,)) if is_selected(bend.part) else bend for bend in self.axis),
            curves=tuple(curve for curve in self.curves if curve.part == "limb" or not is_selected(curve.part)),
        )

    def without(self, region: Literal["axis", "neck", "trunk", "tail", "limbs"], name: str = "") -> "Gait":
        """Return the control group that lacks the motion of a part and differs in nothing else.

        Without ``limbs`` the feet stay at the middle of their stance; limbs with curves are held at their mean angles.
        """
        if region != "limbs":
            return self.straightened(region, name=name)
        held_curves = tuple(
            replace(curve, angles=(sum(curve.angles) / len(curve.angles),)) if curve.part == "limb" else curve
            for curve in self.curves
        )
        return replace(
            self, name=name or self.name, limbs=tuple(_standing(limb) for limb in self.limbs), curves=held_curves
        )

    def lifted(self, angle: float, name: str = "") -> "Gait":
        """Return the gait with another steady pitch of the tail, down positive [rad]."""
        return replace(self.with_numbers(tail_pitch=angle), name=name or self.name)

    def strode(self, fraction: float) -> "Gait":
        """Return the gait with all strokes scaled; held limbs and curves stay as they are.

        Args:
            fraction: factor on the strokes [-].
        """
        return replace(self, limbs=tuple(_strode(limb, fraction) for limb in self.limbs))

    def bent(self, fraction: float) -> "Gait":
        """Return the gait with all lateral bends scaled; a steady bend stays.

        Args:
            fraction: factor on the bends [-].
        """
        return replace(
            self,
            axis=tuple(
                replace(bend, amplitude=tuple(fraction * angle for angle in bend.amplitude))
                if bend.turn == "yaw"
                else bend
                for bend in self.axis
            ),
            curves=tuple(
                curve if curve.part == "limb" else replace(curve, angles=tuple(fraction * a for a in curve.angles))
                for curve in self.curves
            ),
        )

    def lagged(self, lag: float) -> "Gait":
        """Return the gait whose axis follows the limbs later than it does now.

        Args:
            lag: additional phase lag [cycle].
        """
        return replace(
            self,
            axis=tuple(_lagged(bend, lag) for bend in self.axis),
            curves=tuple(curve.lagged(lag) if curve.part != "limb" and lag else curve for curve in self.curves),
        )

    def reversed(self) -> "Gait":
        """Return the gait whose waves run the other way along the axis."""
        reversed_bends = tuple(replace(bend, lag=tuple(0.0 - lag for lag in bend.lag)) for bend in self.axis)
        return replace(self, axis=reversed_bends)

    def mirrored(self) -> "Gait":
        """Return the gait with left and right swapped.

        Raises:
            OutsideLimits: it has measured curves, which say nothing of the other side.
        """
        if self.curves:
            raise OutsideLimits(
                f"gait {self.name!r} has measured curves, which cannot be mirrored: give a gait without."
            )
        phases = tuple(p for pair in zip(self.limb_phases[1::2], self.limb_phases[::2], strict=True) for p in pair)
        # the limbs' clock of the axis begins at the phase of the first limb, which is now another one
        clock = phases[0] - self.limb_phases[0] if phases and not self.coupling else 0.0
        yaw, pitch = (0.0, 0.5) if self.coupling else (0.5 + clock, clock)
        axis = tuple(
            replace(
                _lagged(bend, yaw if bend.turn == "yaw" else pitch),
                offset=0.0 - bend.offset if bend.turn == "yaw" else bend.offset,
            )
            for bend in self.axis
        )
        return replace(self, limb_phases=phases, axis=axis)

    def numbers(self) -> dict[str, str]:
        """Return the names and units of the ``NUMBERS`` that the gait has."""
        return {name: number.unit for name, number in NUMBERS.items() if number.is_present(self)}

    def number(self, name: str) -> float:
        """Return one of the ``NUMBERS`` of the gait.

        Raises:
            UnknownName: there is no such number.
        """
        return _number_of(name).get_value(self)

    def with_numbers(self, **numbers: float) -> "Gait":
        """Return the gait with other ``NUMBERS``, as ``gait.with_numbers(stroke=0.2, axis_lag=0.5)``.

        Raises:
            UnknownName: there is no such number.
            OutsideLimits: the gait has nothing that the number could change.
        """
        new_gait = self
        for name, value in numbers.items():
            if not _number_of(name).is_present(self):
                raise OutsideLimits(
                    f"gait {self.name!r} has nothing that {name!r} could change ({NUMBERS[name].description}): "
                    "choose another number, or a gait that has it."
                )
            new_gait = NUMBERS[name].set_value(new_gait, value)
        return new_gait


class Number(NamedTuple):
    """A number by which sliders, searches, studies and maps speak of a gait."""

    unit: str
    """SI unit, or ``limb reach``."""
    description: str
    """The quantity, in a clause."""
    is_present: Callable[[Gait], bool]
    """Returns whether a gait has it."""
    get_value: Callable[[Gait], float]
    """Returns it."""
    set_value: Callable[[Gait, float], Gait]
    """Returns the gait with another value."""


def _standing(limb: Limbs) -> Limbs:
    if isinstance(limb, FootPath):
        return replace(limb, stroke=0.0, lift=0.0)
    return FixedLimbs(angles=(limb.down,)) if isinstance(limb, Sweep) else limb


def _strode(limb: Limbs, fraction: float) -> Limbs:
    if isinstance(limb, FootPath):
        return replace(limb, stroke=fraction * limb.stroke)
    return replace(limb, stance=fraction * limb.stance) if isinstance(limb, Sweep) else limb


def _lagged(bend: Bend, lag: float) -> Bend:
    """Return a bend with an additional lag, its first lag wrapped to -1/2 to 1/2.

    Args:
        bend: the bend.
        lag: additional phase lag [cycle].
    """
    if lag == 0.0:
        return bend
    turns = round(bend.lag[0] + lag)
    return replace(bend, lag=tuple(value + lag - turns for value in bend.lag))


def _number_of(name: str) -> Number:
    if name not in NUMBERS:
        raise UnknownName("number of a gait", name, NUMBERS)
    return NUMBERS[name]


def _plain(name: str, unit: str, description: str) -> Number:
    """Return a number that is a field of the gait."""
    return Number(
        unit,
        description,
        lambda gait: True,  # noqa: ARG005
        lambda gait: float(getattr(gait, name)),
        lambda gait, value: replace(gait, **{name: value}),  # type: ignore[arg-type]
    )


def _of_limbs(kind: type[FootPath] | type[Sweep], name: str, unit: str, description: str) -> Number:
    """Return a number that all limbs of a kind have; it is that of the foremost, others keep their proportion to it."""

    def matching_limbs(gait: Gait) -> list[Any]:
        return [limb for limb in gait.limbs if isinstance(limb, kind)]

    def current_number(gait: Gait) -> float:
        return float(getattr(matching_limbs(gait)[0], name)) if matching_limbs(gait) else 0.0

    def write(gait: Gait, value: float) -> Gait:
        """Return the gait with another value at the foremost limbs; the other limbs keep their proportion."""
        current = current_number(gait)

        def scaled_limb(limb: Any) -> Any:
            if not isinstance(limb, kind) or current == value:
                return limb
            change: dict[str, Any] = {name: getattr(limb, name) / current * value if current else value}
            return replace(limb, **change)

        return replace(gait, limbs=tuple(scaled_limb(limb) for limb in gait.limbs))

    return Number(unit, description, lambda gait: bool(matching_limbs(gait)), current_number, write)


def _yaw_of(gait: Gait, region: AxisRegion) -> list[Bend]:
    return [bend for bend in gait.axis if bend.turn == "yaw" and bend.part == region]


def _bend_of(region: AxisRegion, description: str) -> Number:
    """Return the amplitude of a part's lateral bend: the mean of its knots, which keep their proportion."""

    def current_amplitude(gait: Gait) -> float:
        return sum(sum(bend.amplitude) / len(bend.amplitude) for bend in _yaw_of(gait, region))

    def write(gait: Gait, value: float) -> Gait:
        """Return the gait with another mean amplitude; the knots keep their proportion."""
        current = current_amplitude(gait)

        def scaled_bend(bend: Bend) -> Bend:
            """Return a bend of the region with scaled amplitudes; other bends stay as they are."""
            if bend.turn != "yaw" or bend.part != region or current == value:
                return bend
            if len(bend.amplitude) == 1 and bend.amplitude[0] == current:
                return replace(bend, amplitude=(value,))
            return replace(bend, amplitude=tuple(a / current * value if current else value for a in bend.amplitude))

        return replace(gait, axis=tuple(scaled_bend(bend) for bend in gait.axis))

    return Number("rad", description, lambda gait: bool(_yaw_of(gait, region)), current_amplitude, write)


def _first_lag(gait: Gait, *parts: AxisRegion) -> float:
    """Return the phase lag of the first lateral bend of some parts behind the limbs [cycle]."""
    return next((float(bend.lag[0]) for bend in gait.axis if bend.turn == "yaw" and bend.part in parts), 0.0)


def _with_lag(gait: Gait, extra_lag: float, *parts: AxisRegion) -> Gait:
    """Return a gait whose lateral bends of some regions lag more.

    Args:
        gait: the gait.
        extra_lag: additional phase lag [cycle].
        *parts: the regions.
    """

    def shifted_bend(bend: Bend) -> Bend:
        if bend.turn != "yaw" or bend.part not in parts or extra_lag == 0.0:
            return bend
        return replace(bend, lag=tuple(lag + extra_lag for lag in bend.lag))

    return replace(gait, axis=tuple(shifted_bend(bend) for bend in gait.axis))


def _axis_lag(gait: Gait) -> float:
    return _first_lag(gait, "trunk", "axis") if _has_yaw(gait, "trunk", "axis") else _first_lag(gait, "neck", "tail")


def _with_axis_lag(gait: Gait, value: float) -> Gait:
    return _with_lag(gait, value - _axis_lag(gait), "neck", "trunk", "tail", "axis")


def _tail_lag(gait: Gait) -> float:
    return _first_lag(gait, "tail") - _first_lag(gait, "trunk")


def _with_tail_lag(gait: Gait, value: float) -> Gait:
    return _with_lag(gait, value - _tail_lag(gait), "tail")


def _has_yaw(gait: Gait, *parts: AxisRegion) -> bool:
    return any(bend.turn == "yaw" and (not parts or bend.part in parts) for bend in gait.axis)


def _waves(gait: Gait) -> float:
    return next((bend.lag[-1] - bend.lag[0] for bend in gait.axis if bend.turn == "yaw" and bend.part == "axis"), 0.0)


def _with_waves(gait: Gait, value: float) -> Gait:
    """Return a gait with another number of wavelengths along the axis; the lag at the snout stays."""

    def stretched_bend(bend: Bend) -> Bend:
        if bend.turn != "yaw" or bend.part != "axis":
            return bend
        return replace(bend, lag=(bend.lag[0], bend.lag[0] + value))

    return replace(gait, axis=tuple(stretched_bend(bend) for bend in gait.axis))


def _steady(gait: Gait, region: AxisRegion, turn: Turn) -> float:
    return sum(bend.offset for bend in gait.axis if bend.turn == turn and bend.part == region)


def _with_steady(gait: Gait, region: AxisRegion, turn: Turn, value: float) -> Gait:
    """Return a gait with another steady bend of a region, in its first bend or in an additional one.

    Args:
        gait: the gait.
        region: region of the axis.
        turn: ``yaw`` or ``pitch``.
        value: the steady bend [rad].
    """
    indices = [i for i, bend in enumerate(gait.axis) if bend.turn == turn and bend.part == region]
    axis = [replace(bend, offset=0.0) if i in indices else bend for i, bend in enumerate(gait.axis)]
    if indices:
        axis[indices[0]] = replace(axis[indices[0]], offset=value)
    else:
        axis.append(Bend(part=region, turn=turn, offset=value))
    return replace(gait, axis=tuple(axis))


def _path_number(name: str, description: str) -> Number:
    return _of_limbs(FootPath, name, "limb reach", description)


NUMBERS: Mapping[str, Number] = MappingProxyType(
    {
        "period": _plain("period", "s", "the period of a cycle"),
        "duty_factor": _plain("duty_factor", "-", "the share of the cycle in which a foot stands"),
        "height": _plain("height", "limb reach", "the height of the hindmost hips"),
        "stroke": _path_number("stroke", "half of the distance that a foot moves back in stance"),
        "lift": _path_number("lift", "the height to which a foot is lifted"),
        "outward": _path_number("outward", "how far a foot stands outside its hip"),
        "ahead": _path_number("ahead", "how far the middle of a foot's path lies ahead of its hip"),
        "crank": _of_limbs(Sweep, "stance", "rad", "the angle that a crank turns through in stance"),
        "trunk_bend": _bend_of("trunk", "the amplitude of the trunk's lateral bend"),
        "tail_bend": _bend_of("tail", "the amplitude of the tail's lateral bend"),
        "axis_bend": _bend_of("axis", "the amplitude of the lateral bend of the whole axis"),
        "axis_lag": Number(
            "cycle", "the phase lag of the trunk's lateral bend behind the limbs", _has_yaw, _axis_lag, _with_axis_lag
        ),
        "tail_lag": Number(
            "cycle",
            "the phase lag of the tail's lateral bend behind the trunk's",
            lambda gait: _has_yaw(gait, "tail"),
            _tail_lag,
            _with_tail_lag,
        ),
        "waves": Number(
            "-", "the wavelengths along the axis", lambda gait: _has_yaw(gait, "axis"), _waves, _with_waves
        ),
        "trunk_offset": Number(
            "rad",
            "the steady lateral bend of the trunk, left positive",
            lambda gait: not gait.curves,
            lambda gait: _steady(gait, "trunk", "yaw"),
            lambda gait, value: _with_steady(gait, "trunk", "yaw", value),
        ),
        "tail_offset": Number(
            "rad",
            "the steady lateral bend of the tail, left positive",
            lambda gait: not gait.curves,
            lambda gait: _steady(gait, "tail", "yaw"),
            lambda gait, value: _with_steady(gait, "tail", "yaw", value),
        ),
        "tail_pitch": Number(
            "rad",
            "the steady pitch of the tail, down positive",
            lambda gait: not gait.curves,
            lambda gait: _steady(gait, "tail", "pitch"),
            lambda gait, value: _with_steady(gait, "tail", "pitch", value),
        ),
    }
)
"""Numbers of a gait by name: the vocabulary of sliders, searches, studies and maps.

``stroke``, ``lift``, ``outward`` and ``ahead`` are those of the foremost limbs with a foot path; other girdles keep
their proportion. Where ``axis_lag`` changes, all other bends keep their lag behind the trunk; with a ``tail_lag`` of
1/2 head and tail swing to opposite sides.
"""
