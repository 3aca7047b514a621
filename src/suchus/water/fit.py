"""Waves that the joints are asked to make: (20) in each of its readings, the eel of the literature, and their fit.

The article commands a continuous wave; the robot has three yaw joints and one cable. So the wave's tangent angles are
fitted by least squares, and what remains is reported.
"""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from suchus.design import Crocodile, cable_joints
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.kinematics import wave as wave_kinematics
from suchus.kinematics.wave import READINGS, Wave
from suchus.motion import Swim, bends
from suchus.motion.swim import YAWS
from suchus.water.outline import Base, Outline

_TIMES = 48
"""Instants of a cycle at which wave and joints are compared [-]."""
_FINE = 2049
"""Points along a wave from which its arc length is found [-]."""


@runtime_checkable
class BodyWave(Protocol):
    """A midline that is given as a curve, x from the snout towards the tail."""

    @property
    def period(self) -> float:
        """Of one cycle [s]."""

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis, to the right positive [m]."""

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedWave:
    """(20) on a robot, from the snout or from the root of the tail on; ahead of that the body stays straight.

    Paper: Eq. (20).
    """

    wave: Wave
    """Its constants in SI units."""
    origin: float
    """Where x of the wave begins, from the snout [m]."""

    @property
    def period(self) -> float:
        """Of one cycle [s]."""
        return 2 * np.pi / self.wave.angular_frequency

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis [m]."""
        return wave_kinematics.displacement(self.wave, np.maximum(x - self.origin, 0.0), time)

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""
        inside = wave_kinematics.slope(self.wave, np.maximum(x - self.origin, 0.0), time)
        return np.where(x >= self.origin, inside, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class EelWave:
    """The eel of the flow literature: ``0.125 (x + 0.03125) / 1.03125 sin 2 pi (x - t)`` in lengths and periods.

    Source: IBAMR examples, ConstraintIB eel2d; Carling, Williams and Bowtell 1998, J. Exp. Biol. 201, 3143.
    """

    length: float
    """Of the body [m]."""
    frequency: float
    """[Hz]."""

    @property
    def period(self) -> float:
        """Of one cycle [s]."""
        return 1.0 / self.frequency

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis [m]."""
        part = x / self.length
        phase = 2 * np.pi * (part - self.frequency * time)
        return np.asarray(self.length * 0.125 * (part + 0.03125) / 1.03125 * np.sin(phase))

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""
        part = x / self.length
        phase = 2 * np.pi * (part - self.frequency * time)
        grown = 2 * np.pi * (part + 0.03125) * np.cos(phase)
        return np.asarray(0.125 / 1.03125 * (np.sin(phase) + grown))


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


def printed_wave(
    robot: Crocodile, reading: str = "I", *, frequency: float = 1.0, sign: int = -1, waves_per_body: float = 1.0
) -> PrintedWave:
    """Return (20) on a robot in one of its readings.

    Args:
        robot: whose body it runs along.
        reading: letter of ``kinematics.wave.READINGS``.
        frequency: which the article does not give [Hz].
        sign: -1 runs from head to tail; 1 as printed.
        waves_per_body: of reading I [-].

    Raises:
        UnknownName: there is no such reading.
    """
    wave = wave_kinematics.reading(
        reading,
        length=robot.length,
        angular_frequency=2 * np.pi * frequency,
        sign=sign,
        waves_per_body=waves_per_body,
    )
    root = robot.head.snout + robot.spine.length + robot.tail.offset
    return PrintedWave(wave=wave, origin=root if READINGS[reading].tail_only else 0.0)


def fit(robot: Crocodile, wave: BodyWave, *, name: str = "wave", most: float = 0.25) -> Fit:
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
    heading, x, y = _along(wave, outline.s, time)
    turning = np.exp(-2j * np.pi * time / wave.period)
    harmonic = 2.0 * turning @ heading / _TIMES
    basis = np.column_stack([np.ones_like(outline.s), outline.bending_at(outline.s)])
    found = np.linalg.lstsq(basis.astype(complex), harmonic, rcond=None)[0]
    late = [float(round(-np.angle(value) / (2 * np.pi), 12)) for value in found[1:]]
    asked = _asked(outline, heading)
    _check_amplitudes(robot, name, np.abs(found[1:]))
    swim = Swim(
        name=name,
        frequency=1.0 / wave.period,
        yaw=(float(abs(found[1])), float(abs(found[2])), float(abs(found[3]))),
        yaw_late=(late[0], late[1], late[2]),
        tail=float(abs(found[4])),
        tail_late=late[3],
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


def _along(wave: BodyWave, s: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return heading and place of a wave at equal arc lengths, each of shape (time, station)."""
    x = np.linspace(0.0, s[-1], _FINE)
    step = x[1] - x[0]
    heading, across, along = (np.empty((len(time), len(s))) for _ in range(3))
    for i, t in enumerate(time):
        stretch = np.sqrt(1.0 + wave.slope(x, t) ** 2)
        arc = np.concatenate([[0.0], np.cumsum(0.5 * step * (stretch[1:] + stretch[:-1]))])
        along[i] = np.interp(s, arc, x)  # arc lengths grow faster than x, so that s ends within
        heading[i] = np.arctan(wave.slope(along[i], t))
        across[i] = wave.displacement(along[i], t)
    return heading, along, across


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


def _limits(robot: Crocodile) -> np.ndarray:
    low, high = robot.spine.yaw_range
    count = len(cable_joints(robot))
    cable, passive = robot.tail.bend_limit / count, 1.2  # [rad]; the model stops a passive joint there
    return np.array([*3 * [min(-low, high)], *count * [cable], *robot.tail.fin_segments * [passive]])


def _joints(robot: Crocodile) -> tuple[str, ...]:
    return (*YAWS, *cable_joints(robot), *(f"fin_yaw_{i + 1}" for i in range(robot.tail.fin_segments)))


def _check_amplitudes(robot: Crocodile, name: str, amplitudes: np.ndarray) -> None:
    low, high = robot.spine.yaw_range
    limits = [*3 * [min(-low, high)], robot.tail.bend_limit]
    for joint, amplitude, limit in zip((*YAWS, "tail_cable"), amplitudes, limits, strict=True):
        if amplitude > limit:
            raise OutsideLimits(
                f"the joints of robot {robot.name!r} cannot make {name!r}: it asks {joint} for {amplitude:.2f} rad to "
                f"either side, {amplitude - limit:.2f} rad more than the {limit:.2f} rad it has: take a longer or a "
                "flatter wave."
            )
