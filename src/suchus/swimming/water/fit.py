"""Fit of a gait to a body wave: the motion of the joints that is nearest to the wave.

The article commands a continuous wave. A robot has a few lateral servos; the article's has three yaw joints and one
cable. So the wave's tangent angles are fitted by least squares, and the misfit is reported.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.robot.design import Robot, check_needs, with_values
from suchus.robot.design.scale import control_period
from suchus.robot.kinematics.wave import READINGS
from suchus.robot.motion import LIMBS_BACK, Gait, lateral_servos, swimming_gait
from suchus.swimming.water.outline import Outline
from suchus.swimming.water.undulation import undulation
from suchus.swimming.water.waves import BodyWave, printed_wave, wave_at_arc_lengths

_TIMES = 48
"""Instants of a cycle at which wave and joints are compared [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """The swimming gait that is nearest to a wave."""

    gait: Gait
    """The gait."""
    head: complex
    """Harmonic of the head's direction: its angle is ``Re(head exp(2 pi i f t))`` [rad]."""
    misfit: float
    """Rms distance of the joints' midline from the wave's, over the greatest swing of the wave's tail [-]."""
    requested_bends: tuple[float, ...]
    """Greatest bend that the wave asks of each joint where it stands, in the order of ``Outline.joints`` [rad]."""


def fit(
    robot: Robot,
    wave: BodyWave,
    *,
    name: str = "wave",
    max_misfit: float = 0.25,
    limbs: tuple[float, float] = LIMBS_BACK,
) -> Fit:
    """Return the gait of the lateral servos that is nearest to a wave, by least squares of tangent angles.

    Angles are compared at equal arc lengths over one cycle, by their first harmonic in time. The direction of the head
    is free, the passive end straight.

    Args:
        robot: robot whose joints are meant.
        wave: to be made.
        name: name of the motion.
        max_misfit: greatest misfit that still counts as the same wave, see ``Fit.misfit`` [-].
        limbs: yaw and pitch at which limbs are held, see ``motion.swimming_gait`` [rad].

    Raises:
        OutsideLimits: the joints cannot make the wave; the message names the joint and by how much.
        InvalidDesign: the wave's period is not positive.
        UnsuitedRobot: no servo bends the robot sideways.
    """
    if not (np.isfinite(wave.period) and wave.period > 0):
        raise InvalidDesign(f"the wave's period is {wave.period} s; a positive one is needed.")
    servos = lateral_servos(robot)
    if not servos:
        raise UnsuitedRobot(f"robot {robot.name!r} has no servo that bends it sideways: choose another robot.")
    outline = Outline(robot)
    time = wave.period * np.arange(_TIMES) / _TIMES
    heading, x, y = wave_at_arc_lengths(wave, outline.s, time)
    turning = np.exp(-2j * np.pi * time / wave.period)
    harmonic = 2.0 * turning @ heading / _TIMES
    basis = np.column_stack([np.ones_like(outline.s), outline.bending_at(outline.s)])
    head, *bends = np.linalg.lstsq(basis.astype(complex), harmonic, rcond=None)[0].tolist()
    amplitudes = [abs(bend) for bend in bends]
    _check_amplitudes(robot, name, amplitudes)
    lags = [round(-float(np.angle(bend)) / (2 * np.pi), 12) for bend in bends]
    # a servo behind the root turns the tip right where its angle is positive, and a gait's bends are to the left
    left_lags = [
        lag if servo.is_ahead_of_root else lag - 0.5 if lag > 0.0 else lag + 0.5
        for servo, lag in zip(outline.servos, lags, strict=True)
    ]
    gait = swimming_gait(
        robot, name=name, frequency=1.0 / wave.period, amplitude=amplitudes, lag=left_lags, limbs=limbs
    )
    misfit, requested_bends = _misfit(outline, gait, head, time, x, y), _requested_bends(outline, heading)
    if not misfit <= max_misfit:
        limits = _limits(outline)
        worst_joint = int(np.argmax(requested_bends / limits))
        raise OutsideLimits(
            f"the joints of robot {robot.name!r} cannot make {name!r}: the nearest motion is off by {100 * misfit:.0f} "
            f"% of the tail's swing, and {100 * max_misfit:.0f} % is allowed. Where {outline.joints[worst_joint]} "
            f"stands "
            "the wave "
            f"bends by {requested_bends[worst_joint]:.2f} rad and the joint by {limits[worst_joint]:.2f} rad at "
            "most: take a longer or a flatter wave."
        )
    return Fit(gait=gait, head=head, misfit=misfit, requested_bends=tuple(requested_bends.tolist()))


def _misfit(outline: Outline, gait: Gait, head: complex, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> float:
    """Return the rms distance of a gait's midline from the wave, over the swing of the tail [-].

    At every instant both curves have the same mean position.
    """
    curve = undulation(outline, gait).with_head_motion(turn=head).curve(time)
    differences = [a - b - (a - b).mean(axis=-1, keepdims=True) for a, b in ((curve.x, x), (curve.y, y))]
    swing = float(np.abs(y[:, -1]).max())
    return float(np.sqrt(np.mean(differences[0] ** 2 + differences[1] ** 2)) / swing) if swing > 0 else 0.0


def _requested_bends(outline: Outline, heading: np.ndarray) -> np.ndarray:
    """Return the greatest bend of a wave over the length that belongs to each joint [rad]."""
    half = 0.5 * outline.spacings
    ends = [
        np.array(
            [
                np.interp(outline.joint_positions + side * half, outline.s, instant_heading)
                for instant_heading in heading
            ]
        )
        for side in (-1, 1)
    ]
    return np.asarray(np.abs(ends[1] - ends[0]).max(axis=0))


def _limits(outline: Outline) -> np.ndarray:
    """Return the greatest bend of each joint to either side; the joints of a cable have equal limits [rad]."""
    robot = outline.robot
    limits = {hinge.name: hinge.range or (-np.pi, np.pi) for hinge in robot.axis_hinges}
    limits |= {name: (0.0, cable.bend_limit / cable.joints) for cable in robot.cables for name in cable.hinges}
    return np.array([_either_side(*limits[name]) for name in outline.joints])


def _either_side(lower_bound: float, upper_bound: float) -> float:
    return min(-lower_bound, upper_bound) if lower_bound < 0.0 else upper_bound


def _check_amplitudes(robot: Robot, name: str, amplitudes: Sequence[float]) -> None:
    """Refuse bends beyond the range of a servo.

    Args:
        robot: the design.
        name: name of the motion, for the message.
        amplitudes: amplitudes of the bend of each lateral servo [rad].
    """
    limits = {hinge.name: _either_side(*(hinge.range or (-np.pi, np.pi))) for hinge in robot.axis_hinges}
    limits |= {cable.name: cable.bend_limit for cable in robot.cables}
    for servo, amplitude in zip(lateral_servos(robot), amplitudes, strict=True):
        if amplitude > limits[servo]:
            raise OutsideLimits(
                f"the joints of robot {robot.name!r} cannot make {name!r}: it asks {servo} for {amplitude:.2f} rad to "
                f"either side, {amplitude - limits[servo]:.2f} rad more than the {limits[servo]:.2f} rad it has: take "
                "a longer or a flatter wave."
            )


_FREQUENCY, _PERIOD = 1.0, 0.01  # [Hz]; of the wave of a robot whose control period is the second [s]


@lru_cache(maxsize=16)
def swim_of(
    robot: Robot,
    *,
    frequency: float | None = None,
    reading: str = "I",
    limbs: tuple[float, float] = LIMBS_BACK,
) -> Gait:
    """Return the default swimming gait of a robot: the wave of (20) on its joints.

    Args:
        robot: any robot whose axis bends sideways; its hull makes no difference.
        frequency: frequency of the wave [Hz]; by default 1 Hz for bodies of 0.4 to 1.6 m, and as many control periods a
            cycle for others.
        reading: letter of the reading of (20), see ``kinematics.wave.READINGS``.
        limbs: yaw and pitch at which limbs are held, see ``motion.swimming_gait`` [rad].

    Raises:
        UnsuitedRobot: no servo bends the robot sideways.
        OutsideLimits: its joints cannot make the wave.
    """
    hull_free_robot = with_values(check_needs(robot, ["axis"], "a swim"), {"hull": None})
    cycles = frequency or _FREQUENCY * _PERIOD / control_period(robot)
    return fit(hull_free_robot, printed_wave(hull_free_robot, reading, frequency=cycles, sign=-1), limbs=limbs).gait


class ReadingFit(NamedTuple):
    """The fit to one reading of (20)."""

    letter: str
    """Letter of ``kinematics.wave.READINGS``."""
    fit: Fit | None
    """The nearest motion of the joints, None if they cannot make the wave."""
    refusal: str
    """Why not: the joint and by how much."""


def fits_of_readings(robot: Robot, *, frequency: float) -> list[ReadingFit]:
    """Return the fit of a robot's joints to (20) in each of its readings.

    Args:
        robot: robot whose joints are meant.
        frequency: which the article does not give [Hz].
    """
    results = []
    for letter in READINGS:
        wave = printed_wave(robot, letter, frequency=frequency)
        try:
            results.append(ReadingFit(letter, fit(robot, wave, name=f"(20), reading {letter}"), ""))
        except OutsideLimits as refused:
            results.append(ReadingFit(letter, None, str(refused)))
    return results


def readings_table(readings: Iterable[ReadingFit], thrust: Mapping[str, str]) -> str:
    """Return a Markdown table of readings: units, misfit, what the joints make of it, thrust.

    Args:
        readings: the readings.
        thrust: what was measured of some of them, by letter.
    """
    lines = ["| reading of (20) | units | misfit | joints | thrust |", "|---|---|---|---|---|"]
    for letter, nearest_fit, refusal in readings:
        misfit = "" if nearest_fit is None else f"{100 * nearest_fit.misfit:.1f} %"
        joints = refusal or READINGS[letter].verdict
        lines.append(f"| {letter} | {READINGS[letter].meaning} | {misfit} | {joints} | {thrust.get(letter, '')} |")
    return "\n".join(lines) + "\n"
