"""Commands as text: CSV for people and servo boards, a trajectory message for ROS."""

import numpy as np

from suchus.design import Robot, layout
from suchus.hardware.commands import Commands
from suchus.kinematics.tail import bend_of_servo


def csv_text(samples: Commands) -> str:
    """Return a table: time [s], then each servo's angle [rad], then each servo's pulse [us]."""
    names = samples.servos
    lines = [",".join(["time_s", *(f"{n}_rad" for n in names), *(f"{n}_us" for n in names)])]
    for time, angles, pulses in zip(samples.time, samples.angles, samples.pulses, strict=True):
        lines.append(
            ",".join([f"{time:.6f}", *(f"{a + 0.0:.6f}" for a in angles), *(f"{p:.1f}" for p in pulses)]),
        )
    return "\n".join(lines) + "\n"


def trajectory_text(robot: Robot, samples: Commands) -> str:
    """Return a ROS 2 ``trajectory_msgs/JointTrajectory`` as YAML, for the joints of the exported URDF.

    That has no cable: the bend that the pulley gives the tail is shared evenly by the hinges that the cable bends.

    Paper: Eq. (18).
    """
    place = layout(robot)
    direct = [i for i in range(len(place.servos)) if i not in place.cables]
    names = [place.servos[i] for i in direct]
    places, speeds = samples.angles[:, direct], samples.speeds[:, direct]
    for servo in place.cables:
        hinges = place.cable(servo).hinges
        bend = bend_of_servo(place.cable(servo), samples.angles[:, servo])
        turned = np.gradient(bend, samples.time) if len(bend) > 1 else np.zeros_like(bend)
        around = samples.time[1] + samples.time[-1] - samples.time[-2]  # the last sample is the first
        turned[[0, -1]] = (bend[1] - bend[-2]) / around
        places = np.column_stack([places, np.tile(bend[:, None] / len(hinges), len(hinges))])
        speeds = np.column_stack([speeds, np.tile(turned[:, None] / len(hinges), len(hinges))])
        names += hinges
    lines = [
        "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        "  frame_id: ''",
        f"joint_names: [{', '.join(names)}]",
        "points:",
    ]
    for time, angles, rates in zip(samples.time, places, speeds, strict=True):
        nanoseconds = round(time * 1e9)
        lines += [
            f"- positions: [{', '.join(f'{a + 0.0:.9f}' for a in angles)}]",
            f"  velocities: [{', '.join(f'{v + 0.0:.9f}' for v in rates)}]",
            "  accelerations: []",
            "  effort: []",
            f"  time_from_start: {{sec: {nanoseconds // 10**9}, nanosec: {nanoseconds % 10**9}}}",
        ]
    return "\n".join(lines) + "\n"
