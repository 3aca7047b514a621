"""Motion of a midline over time: by the bends of its joints, or exactly as a wave prescribes.

Both are tangent angles along the body, each a sum of harmonics in time. Positions and velocities are sums of tangents
from the snout. So the midline has a constant length, and velocities are exact derivatives.

A cable fixes only the sum of its joints, and the water bends a passive end. A gait cannot describe that. So a motion
can also be taken from the angles of every lateral joint of a run (``motion_of_record``).
"""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from jaxtyping import Complex, Float

from suchus.core.errors import InvalidDesign
from suchus.robot.design import layout
from suchus.robot.kinematics import tail as tail_kinematics
from suchus.robot.motion import Gait, cycle_targets, movement
from suchus.swimming.water.outline import MidlineCurve, Outline, cumulative_positions
from suchus.swimming.water.waves import BodyWave, wave_at_arc_lengths

_INSTANTS = 96
"""Instants of a cycle from which a wave's harmonics are found [-]; the last harmonic of (20) is 1e-9 of the first."""
HARMONICS = 4
"""Harmonics that are kept, the mean among them [-]; a mean bend would steer, and is left out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExactWave:
    """A wave that the midline follows exactly, independent of joints."""

    name: str
    """Name, as messages, tables and files show it."""
    wave: BodyWave
    """Wave that the midline follows."""

    def __post_init__(self) -> None:
        if not (np.isfinite(self.wave.period) and self.wave.period > 0):
            raise InvalidDesign(f"the period of {self.name!r} is {self.wave.period} s; a positive one is needed.")

    @property
    def frequency(self) -> float:
        """Frequency of the wave [Hz]."""
        return 1.0 / self.wave.period


@dataclass(frozen=True, slots=True, kw_only=True)
class Undulation:
    """A periodic midline. Harmonic k of a value is ``Re(h[k] exp(2 pi i k f t))``, k from 0 on."""

    name: str
    """Name, as messages, tables and files show it."""
    frequency: float
    """f [Hz]."""
    outline: Outline
    """Outline of the body whose midline it is."""
    middles: Complex[np.ndarray, "harmonic middle"]
    """Tangent angle halfway between the stations [rad]."""
    stations: Complex[np.ndarray, "harmonic station"]
    """Tangent angle at the stations [rad]."""
    sway: Complex[np.ndarray, " harmonic"]
    """Way of the snout to the right [m]."""

    def with_head_motion(self, sway: complex = 0j, turn: complex = 0j) -> "Undulation":
        """Return the motion with a first harmonic added to the head's displacement [m] and direction [rad]."""
        middles, stations, snout = self.middles.copy(), self.stations.copy(), self.sway.copy()
        middles[1] += turn
        stations[1] += turn
        snout[1] += sway
        return replace(self, middles=middles, stations=stations, sway=snout)

    def curve(self, time: Float[np.ndarray, "*b"], growth: float = 1.0, growth_rate: float = 0.0) -> MidlineCurve:
        """Return the midline and its velocity at times.

        Args:
            time: [s].
            growth: share of the motion that has grown [-].
            growth_rate: rate of that share [1/s].
        """
        turning, spinning = self._phases(time)
        mixed = growth * spinning + growth_rate * turning
        turning = growth * turning

        def evaluate(harmonics: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return (turning @ harmonics).real, (mixed @ harmonics).real

        (middle, spin), (heading, rate), (y, y_rate) = (
            evaluate(self.middles),
            evaluate(self.stations),
            evaluate(self.sway[:, None]),
        )
        step = self.outline.robot.length / (self.outline.stations - 1)
        snout = np.zeros((4, *y.shape[:-1]))
        snout[1], snout[3] = y[..., 0], y_rate[..., 0]
        forward, aside = step * np.cos(middle), step * np.sin(middle)
        x_positions, y_positions, x_velocities, y_velocities = cumulative_positions(
            snout, np.array([forward, aside, -aside * spin, forward * spin])
        )
        return MidlineCurve(x_positions, y_positions, heading, x_velocities, y_velocities, rate)

    def _phases(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rates = 2j * np.pi * self.frequency * np.arange(len(self.sway))
        turning = np.exp(np.asarray(time)[..., None] * rates)
        return turning, turning * rates


Motion = Gait | ExactWave | Undulation
"""What a body can be asked to do: bend its joints, follow a wave, or bend as was worked out before."""


def undulation(outline: Outline, motion: Motion) -> Undulation:
    """Return the motion of a midline; in a gait the snout stays in place and the head straight.

    Args:
        outline: outline of the robot.
        motion: a gait, or a wave that is followed exactly, or a bend that was worked out before.

    Raises:
        InvalidDesign: a bend that was worked out for other stations.
        OutsideLimits: a gait for other limbs.
    """
    if isinstance(motion, Undulation):
        if motion.outline.stations != outline.stations:
            raise InvalidDesign(
                f"the motion {motion.name!r} has {motion.outline.stations} stations along the midline, and "
                f"{outline.stations} are asked for, in a flow one more than its cells per body length: work it out for "
                "an Outline with so many."
            )
        return motion
    if isinstance(motion, ExactWave):
        return _of_wave(outline, motion)
    return _of_joints(outline, motion.name, motion.frequency, _commanded(outline, motion))


def straight_motion(outline: Outline, frequency: float = 1.0) -> Undulation:
    """Return the motion of a straight body at rest."""
    return _of_joints(outline, "still", frequency, np.zeros((2, len(outline.joints)), complex))


def _of_joints(outline: Outline, name: str, frequency: float, harmonics: np.ndarray) -> Undulation:
    """Return the motion of a midline with given harmonics of its joints, shape (harmonic, joint) [rad]."""
    middle = 0.5 * (outline.s[1:] + outline.s[:-1])
    return Undulation(
        name=name,
        frequency=frequency,
        outline=outline,
        middles=harmonics @ outline.joints_at(middle).T,
        stations=harmonics @ outline.joints_at(outline.s).T,
        sway=np.zeros(len(harmonics), complex),
    )


def _commanded(outline: Outline, gait: Gait) -> Complex[np.ndarray, "harmonic joint"]:
    """Return the harmonics of the joints in a gait, without their means [rad]; joints of a cable bend equally."""
    plan, place = movement(outline.robot, gait), layout(outline.robot)
    harmonics = np.zeros((HARMONICS if gait.curves else 2, len(outline.joints)), complex)
    if gait.curves:
        angles = cycle_targets(outline.robot, gait, np.arange(_INSTANTS) / _INSTANTS)
        for servo in outline.servos:
            number = place.servos.index(servo.name)
            bend = angles[:, number]
            if number in place.cables:
                bend = tail_kinematics.bend_of_servo(place.cable(number), bend) / len(servo.joints)
            harmonics[1:, list(servo.joints)] = _harmonics(bend)[1:HARMONICS, None]
        return harmonics
    hinges = plan.yaw.hinges
    order = [outline.joints.index(name) for name in hinges.names]
    harmonics[1, order] = np.array(hinges.signs) * plan.harmonics()[0]
    return harmonics


def _of_wave(outline: Outline, motion: ExactWave) -> Undulation:
    """Return the harmonics of a midline that follows a wave exactly."""
    time = motion.wave.period * np.arange(_INSTANTS) / _INSTANTS
    points = np.sort(np.concatenate([outline.s, 0.5 * (outline.s[1:] + outline.s[:-1])]))
    heading, _, lateral = wave_at_arc_lengths(motion.wave, points, time)
    harmonics = _harmonics(heading)
    return Undulation(
        name=motion.name,
        frequency=motion.frequency,
        outline=outline,
        middles=harmonics[:, 1::2],
        stations=harmonics[:, ::2],
        sway=_harmonics(lateral[:, :1])[:, 0],
    )


def _harmonics(values: np.ndarray) -> np.ndarray:
    """Return the Fourier coefficients of values over one cycle, shape (time, ...), in the form of ``Undulation``."""
    harmonics = 2.0 * np.fft.rfft(values, axis=0)[: len(values) // 2] / len(values)
    harmonics[0] *= 0.5
    return np.asarray(harmonics)


def motion_of_record(
    outline: Outline, record: xr.Dataset, *, frequency: float, cycles: int, name: str = "as taken"
) -> Undulation:
    """Return the motion of the midline in the last whole cycles of a run, averaged over them.

    Only yaw counts, without its mean, as in a slice of water seen from above. Pitch, heave and roll of the run are left
    out.

    Args:
        outline: outline of the robot without a hull.
        record: record of one run of a robot with these joints.
        frequency: frequency of the motion [Hz].
        cycles: over which is averaged [-].
        name: name of the motion.

    Raises:
        InvalidDesign: the run is shorter, or a cycle has fewer than two samples for each harmonic.
    """
    period, time = 1.0 / frequency, record.time.values.astype(float)
    step = float(time[1] - time[0]) if time.size > 1 else np.inf
    if time[-1] - time[0] < cycles * period - 0.5 * step:
        raise InvalidDesign(
            f"the run lasts {time[-1] - time[0]:.3g} s, and {cycles} cycles of {period:.3g} s are asked for; let it "
            "last longer, or ask for fewer cycles."
        )
    if period < 2 * HARMONICS * step:
        raise InvalidDesign(
            f"a cycle of {period:.3g} s has {period / step:.3g} samples; {2 * HARMONICS} are needed: keep more samples."
        )
    is_in_last_cycles = time > time[-1] - cycles * period + 0.5 * step
    angles = record.joint_angle.sel(joint=list(outline.joints)).transpose("time", "joint").values[is_in_last_cycles]
    turning = np.exp(-2j * np.pi * frequency * np.outer(np.arange(HARMONICS), time[is_in_last_cycles]))
    harmonics = 2.0 * turning @ angles / is_in_last_cycles.sum()
    harmonics[0] = 0.0
    return _of_joints(outline, name, frequency, harmonics)


def unevenness(motion: Undulation, reference: Undulation) -> float:
    """Return the rms difference of the headings of two midlines over the rms heading of the second one [-]."""
    count = max(len(motion.middles), len(reference.middles))
    middles, reference_middles = (
        np.pad(compared_motion.middles, ((0, count - len(compared_motion.middles)), (0, 0)))
        for compared_motion in (motion, reference)
    )
    return float(np.sqrt((np.abs(middles - reference_middles) ** 2).sum() / (np.abs(reference_middles) ** 2).sum()))
