"""Commands as text: CSV for people and servo boards, a trajectory message for ROS."""

from suchus.design import servo_names
from suchus.hardware.commands import Commands


def csv_text(told: Commands) -> str:
    """Return a table: time [s], then each servo's angle [rad], then each servo's pulse [us]."""
    names = servo_names()
    lines = [",".join(["time_s", *(f"{n}_rad" for n in names), *(f"{n}_us" for n in names)])]
    for time, angles, pulses in zip(told.time, told.angles, told.pulses, strict=True):
        lines.append(
            ",".join([f"{time:.6f}", *(f"{a + 0.0:.6f}" for a in angles), *(f"{p:.1f}" for p in pulses)]),
        )
    return "\n".join(lines) + "\n"


def trajectory_text(told: Commands) -> str:
    """Return a ROS 2 ``trajectory_msgs/JointTrajectory`` as YAML; the joint ``tail_cable`` is the cable's pulley."""
    lines = [
        "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        "  frame_id: ''",
        f"joint_names: [{', '.join(servo_names())}]",
        "points:",
    ]
    for time, angles, speeds in zip(told.time, told.angles, told.speeds, strict=True):
        nanoseconds = round(time * 1e9)
        lines += [
            f"- positions: [{', '.join(f'{a + 0.0:.9f}' for a in angles)}]",
            f"  velocities: [{', '.join(f'{v + 0.0:.9f}' for v in speeds)}]",
            "  accelerations: []",
            "  effort: []",
            f"  time_from_start: {{sec: {nanoseconds // 10**9}, nanosec: {nanoseconds % 10**9}}}",
        ]
    return "\n".join(lines) + "\n"
