"""A gait as servo angles and pulses over time, and as the files that hold them."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.checks import require
from suchus.core.errors import OutsideLimits
from suchus.hardware.servo_map import ServoLine, ServoMap
from suchus.robot.design import Crank, Robot, layout
from suchus.robot.kinematics.tail import bend_of_servo
from suchus.robot.motion import START, Gait, check_limits, intended


class Commands(NamedTuple):
    """Commanded angles of the servos [rad], in the order of the robot's layout; the last sample equals the first."""

    time: Float[np.ndarray, " sample"]
    """Time from the beginning of the first cycle [s]."""
    angles: Float[np.ndarray, "sample servo"]
    """Angles of the joints; for a cable that of its pulley, or the travel of its actuator over ``pulleys`` [rad]."""
    speeds: Float[np.ndarray, "sample servo"]
    """Rate at which the angles change: central differences over the periodic gait [rad/s]."""
    pulses: Float[np.ndarray, "sample servo"]
    """Pulse widths to which the servo map converts the angles [us]."""
    servos: tuple[str, ...]
    """Names of the servos."""
    pulleys: Mapping[str, float] = MappingProxyType({})
    """Of each linear actuator, by name, the radius by which an angle is its travel [m]."""


def commands(robot: Robot, gait: Gait, servo_map: ServoMap, cycles: int = 1) -> Commands:
    """Return the commands of some cycles, which can be repeated without a jump.

    A cycle has the whole number of intervals that is nearest to the map's rate.

    Args:
        robot: robot that walks.
        gait: gait that is walked.
        servo_map: how its servos are mounted.
        cycles: number of cycles.

    Raises:
        OutsideLimits: the joints cannot follow the gait, or the rate gives a cycle fewer than 8 samples.

    Paper: Eq. (18) for the cable.
    """
    require("commands", "cycles", cycles, 1, 1000, "")
    check_limits(robot, gait)
    samples = round(gait.period * servo_map.rate)
    if samples < 8:
        raise OutsideLimits(
            f"gait {gait.name!r} has a cycle of {gait.period:g} s, {samples} samples at {servo_map.rate:g} Hz; "
            f"8 are needed: raise the rate to {8 / gait.period:.3g} Hz."
        )
    cycle_angles = intended(robot, gait, START + np.arange(samples) * gait.period / samples).targets
    turns = _cranks(robot)
    step = gait.period / samples
    next_angles = np.roll(cycle_angles, -1, axis=0)
    next_angles[-1] += turns  # a crank goes on where the others begin anew
    previous_angles = np.roll(cycle_angles, 1, axis=0)
    previous_angles[0] -= turns
    sample_index = np.arange(cycles * samples + 1)
    speed = (next_angles - previous_angles) / (2 * step)
    angles = cycle_angles[sample_index % samples] + turns * (sample_index // samples)[:, None]
    pulses = _pulses(servo_map.ordered(robot), angles)
    pulleys = {cable.name: cable.pulley for cable in robot.cables if cable.linear is not None}
    return Commands(sample_index * step, angles, speed[sample_index % samples], pulses, layout(robot).servos, pulleys)


def _cranks(robot: Robot) -> np.ndarray:
    """Return by how much each servo's angle changes in a cycle: by a turn for a crank, by nothing for others [rad]."""
    place, turn_per_cycle = layout(robot), np.zeros(len(layout(robot).servos))
    for limb in place.limbs:
        driven_hinges = [hinge for hinge in limb.girdle.limb.hinges if hinge.servo is not None]
        for i, hinge in enumerate(driven_hinges):
            if isinstance(hinge.drive, Crank):
                turn_per_cycle[limb.servos.start + i] = -2 * np.pi
    return turn_per_cycle


def _pulses(lines: Sequence[ServoLine], angles: np.ndarray) -> np.ndarray:
    """Return the pulse widths of servos at angles, shape (sample, servo) [us]."""
    direction = np.array([line.direction for line in lines])
    offset = np.array([line.offset for line in lines])
    centre = np.array([line.pulse_centre for line in lines])
    per_radian = np.array([line.pulse_per_radian for line in lines])
    return np.asarray(centre + per_radian * (direction * angles + offset))


def csv_text(samples: Commands) -> str:
    """Return a table: time [s], each servo's angle [rad], its pulse [us], then each linear actuator's travel [m]."""
    names, actuator_names = samples.servos, list(samples.pulleys)
    travels = samples.angles[:, [names.index(n) for n in actuator_names]] * [samples.pulleys[n] for n in actuator_names]
    lines = [
        ",".join(
            ["time_s", *(f"{n}_rad" for n in names), *(f"{n}_us" for n in names), *(f"{n}_m" for n in actuator_names)]
        )
    ]
    for time, angles, pulses, travel in zip(samples.time, samples.angles, samples.pulses, travels, strict=True):
        cells = [
            *(f"{a + 0.0:.6f}" for a in angles),
            *(f"{p:.1f}" for p in pulses),
            *(f"{x + 0.0:.6f}" for x in travel),
        ]
        lines.append(",".join([f"{time:.6f}", *cells]))
    return "\n".join(lines) + "\n"


def trajectory_text(robot: Robot, samples: Commands, *, virtual: bool = False) -> str:
    """Return a ROS 2 ``trajectory_msgs/JointTrajectory`` as YAML, for the joints of the exported URDF.

    The URDF has no cable: all hinges that a cable bends get an equal part of the bend that its pulley gives.

    Args:
        robot: robot that walks.
        samples: the commands.
        virtual: whether each cable is a joint of its own, that of its pulley, as in the URDF of ``hardware.ros``.

    Paper: Eq. (18).
    """
    if virtual:
        return _trajectory(samples.servos, samples.time, samples.angles, samples.speeds)
    place = layout(robot)
    direct = [i for i in range(len(place.servos)) if i not in place.cables]
    names = [place.servos[i] for i in direct]
    places, speeds = samples.angles[:, direct], samples.speeds[:, direct]
    for servo in place.cables:
        hinges = place.cable(servo).hinges
        bend = bend_of_servo(place.cable(servo), samples.angles[:, servo])
        bend_rate = np.gradient(bend, samples.time) if len(bend) > 1 else np.zeros_like(bend)
        closing_interval = samples.time[1] + samples.time[-1] - samples.time[-2]  # the last sample is the first
        bend_rate[[0, -1]] = (bend[1] - bend[-2]) / closing_interval
        places = np.column_stack([places, np.tile(bend[:, None] / len(hinges), len(hinges))])
        speeds = np.column_stack([speeds, np.tile(bend_rate[:, None] / len(hinges), len(hinges))])
        names += hinges
    return _trajectory(names, samples.time, places, speeds)


def _trajectory(names: Sequence[str], times: np.ndarray, places: np.ndarray, speeds: np.ndarray) -> str:
    """Return the message; places [rad] and speeds [rad/s] have the shape (sample, joint)."""
    lines = [
        "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        "  frame_id: ''",
        f"joint_names: [{', '.join(names)}]",
        "points:",
    ]
    for time, angles, rates in zip(times, places, speeds, strict=True):
        nanoseconds = round(time * 1e9)
        lines += [
            f"- positions: [{', '.join(f'{a + 0.0:.9f}' for a in angles)}]",
            f"  velocities: [{', '.join(f'{v + 0.0:.9f}' for v in rates)}]",
            "  accelerations: []",
            "  effort: []",
            f"  time_from_start: {{sec: {nanoseconds // 10**9}, nanosec: {nanoseconds % 10**9}}}",
        ]
    return "\n".join(lines) + "\n"
