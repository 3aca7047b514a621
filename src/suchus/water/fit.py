"""Waves that the joints are asked to make: the motion that comes nearest to them.

The article commands a continuous wave; the robot has three yaw joints and one cable. So the wave's tangent angles are
fitted by least squares, and what remains is reported.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import Robot, cable_joints, layout
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.kinematics.wave import READINGS
from suchus.motion import Swim, bends
from suchus.motion.swim import trunk_yaws
from suchus.water.outline import Base, Outline
from suchus.water.waves import BodyWave, along, printed_wave

_TIMES = 48
"""Instants of a cycle at which wave and joints are compared [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A swimming motion that comes nearest to a wave."""

    swim: Swim
    """The motion."""
    head: complex
    """Harmonic of the head's direction: its angle is ``Re(head exp(2 pi i f t))`` [rad]."""
    misfit: float
    """Rms distance of the joints' midline from the wave's, over the greatest swing of the wave's tail [-]."""
    asked: tuple[float, ...]
    """Greatest bend that the wave asks of each joint where it stands, in the order of ``Outline.places`` [rad]."""


def fit(robot: Robot, wave: BodyWave, *, name: str = "wave", most: float = 0.25) -> Fit:
    """Return the motion of the joints that comes nearest to a wave, least squares on tangent angles.

    Angles are compared at equal arc lengths over one cycle, their first harmonic in time; the head's direction is
    free, the passive end straight.

    Args:
        robot: whose joints.
        wave: to be made.
        name: of the motion.
        most: greatest misfit that still counts as the same wave, see ``Fit.misfit`` [-].

    Raises:
        OutsideLimits: the joints cannot make the wave; the message names the joint and by how much.
        InvalidDesign: the wave's period is not positive.
    """
    if not (np.isfinite(wave.period) and wave.period > 0):
        raise InvalidDesign(f"the wave's period is {wave.period} s; a positive one is needed.")
    outline = Outline(robot)
    time = wave.period * np.arange(_TIMES) / _TIMES
    heading, x, y = along(wave, outline.s, time)
    turning = np.exp(-2j * np.pi * time / wave.period)
    harmonic = 2.0 * turning @ heading / _TIMES
    basis = np.column_stack([np.ones_like(outline.s), outline.bending_at(outline.s)])
    found = np.linalg.lstsq(basis.astype(complex), harmonic, rcond=None)[0]
    lag = [float(round(-np.angle(value) / (2 * np.pi), 12)) for value in found[1:]]
    asked = _asked(outline, heading)
    _check_amplitudes(robot, name, np.abs(found[1:]))
    swim = Swim(
        name=name,
        frequency=1.0 / wave.period,
        yaw=(float(abs(found[1])), float(abs(found[2])), float(abs(found[3]))),
        yaw_lag=(lag[0], lag[1], lag[2]),
        tail=float(abs(found[4])),
        tail_lag=lag[3],
    )
    misfit = _misfit(outline, swim, complex(found[0]), time, x, y)
    if not misfit <= most:
        worst = int(np.argmax(asked / _limits(robot)))
        raise OutsideLimits(
            f"the joints of robot {robot.name!r} cannot make {name!r}: the nearest motion is off by {100 * misfit:.0f} "
            f"% of the tail's swing, and {100 * most:.0f} % is allowed. Where {_joints(robot)[worst]} stands the wave "
            f"bends by {asked[worst]:.2f} rad and the joint by {_limits(robot)[worst]:.2f} rad at most: take a longer "
            "or a flatter wave."
        )
    return Fit(swim=swim, head=complex(found[0]), misfit=misfit, asked=tuple(asked.tolist()))


def head_base(fitted: Fit, time: Float[np.ndarray, "*b"]) -> Base:
    """Return the snout of a fitted wave: it stays in place and turns as the fit says."""
    rate = 2 * np.pi * fitted.swim.frequency
    angle = fitted.head * np.exp(1j * rate * time)
    zero = np.zeros_like(time)
    return Base(zero, zero, angle.real, zero, zero, (1j * rate * angle).real)


def _misfit(outline: Outline, swim: Swim, head: complex, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> float:
    """Return the rms distance over the tail's swing; at every instant the curves lie over each other on the average."""
    base = head_base(Fit(swim=swim, head=head, misfit=0.0, asked=()), time)
    curve = outline.curve(bends(swim, time), base)
    apart = [a - b - (a - b).mean(axis=-1, keepdims=True) for a, b in ((curve.x, x), (curve.y, y))]
    swing = float(np.abs(y[:, -1]).max())
    return float(np.sqrt(np.mean(apart[0] ** 2 + apart[1] ** 2)) / swing) if swing > 0 else 0.0


def _asked(outline: Outline, heading: np.ndarray) -> np.ndarray:
    """Return the greatest bend of a wave over the length that each joint stands for [rad]."""
    half = 0.5 * outline.reaches
    half[:3] *= 2.0  # trunk's yaw joints stand two links apart
    ends = [np.array([np.interp(outline.places + side * half, outline.s, now) for now in heading]) for side in (-1, 1)]
    return np.asarray(np.abs(ends[1] - ends[0]).max(axis=0))


def _limits(robot: Robot) -> np.ndarray:
    low, high = robot.spine.yaw_range
    count = len(cable_joints(robot))
    cable, passive = robot.tail.bend_limit / count, 1.2  # [rad]; the model stops a passive joint there
    return np.array([*3 * [min(-low, high)], *count * [cable], *robot.tail.fin_segments * [passive]])


def _joints(robot: Robot) -> tuple[str, ...]:
    return (*trunk_yaws(robot), *cable_joints(robot), *(f"fin_yaw_{i + 1}" for i in range(robot.tail.fin_segments)))


def _check_amplitudes(robot: Robot, name: str, amplitudes: np.ndarray) -> None:
    low, high = robot.spine.yaw_range
    limits = [*3 * [min(-low, high)], robot.tail.bend_limit]
    place = layout(robot)
    names = (*trunk_yaws(robot), *(place.servos[i] for i in place.cables))
    for joint, amplitude, limit in zip(names, amplitudes, limits, strict=True):
        if amplitude > limit:
            raise OutsideLimits(
                f"the joints of robot {robot.name!r} cannot make {name!r}: it asks {joint} for {amplitude:.2f} rad to "
                f"either side, {amplitude - limit:.2f} rad more than the {limit:.2f} rad it has: take a longer or a "
                "flatter wave."
            )


class Attempt(NamedTuple):
    """A reading that was tried."""

    letter: str
    """Letter of ``kinematics.wave.READINGS``."""
    fitted: Fit | None
    """The nearest motion of the joints, None if they cannot make the wave."""
    refusal: str
    """Why not: the joint and by how much."""


def attempts(robot: Robot, *, frequency: float, sign: int = -1) -> list[Attempt]:
    """Return what a robot's joints make of (20) in each of its readings.

    Args:
        robot: whose joints.
        frequency: which the article does not give [Hz].
        sign: -1 runs from head to tail; 1 as printed.
    """
    found = []
    for letter in READINGS:
        wave = printed_wave(robot, letter, frequency=frequency, sign=sign)
        try:
            found.append(Attempt(letter, fit(robot, wave, name=f"(20), reading {letter}"), ""))
        except OutsideLimits as refused:
            found.append(Attempt(letter, None, str(refused)))
    return found


def readings_table(tried: Iterable[Attempt], thrust: Mapping[str, str]) -> str:
    """Return a Markdown table of readings: units, misfit, what the joints make of it, thrust.

    Args:
        tried: the readings.
        thrust: what was measured of some of them, by letter.
    """
    lines = ["| reading of (20) | units | misfit | joints | thrust |", "|---|---|---|---|---|"]
    for letter, fitted, refusal in tried:
        misfit = "" if fitted is None else f"{100 * fitted.misfit:.1f} %"
        joints = refusal or READINGS[letter].verdict
        lines.append(f"| {letter} | {READINGS[letter].meaning} | {misfit} | {joints} | {thrust.get(letter, '')} |")
    return "\n".join(lines) + "\n"
