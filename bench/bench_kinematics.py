"""How fast is the kinematics? Each inverse beside its forward, and ikpy and roboticstoolbox where they are installed.

Ratios are of the time for each point, in the same run.

Usage: python bench/bench_kinematics.py [points]
"""

import platform
import sys
import time
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from form import in_form
from suchus.robot.design import joint_names
from suchus.robot.kinematics import landmarks, leg, limb, spine
from suchus.robot.robots import ROBOTS

ROBOT = ROBOTS["caiman"]
HIND = ROBOT.hind_leg
FEW = in_form(200, 5)  # points for the iterative solvers


def best_of(action: Callable[[], Any], repeats: int = 7) -> float:
    """Return the shortest of several times of the processor [s]: what else the machine does counts little."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def optional(name: str) -> ModuleType | None:
    """Return a module, or None with a line that says so."""
    try:
        return import_module(name)
    except Exception as error:  # an installed package may fail to import for reasons of its own
        print(f"{name:28s} left out: {type(error).__name__}: {error}")
        return None


def shell(count: int) -> np.ndarray:
    """Return points spread evenly over what the foot can reach [m]."""
    rng = np.random.default_rng(0)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    near, far = HIND.reach
    return np.array([HIND.hip_offset, 0, 0]) + way * np.cbrt(rng.uniform(near**3, far**3, (count, 1)))


def report(what: str, seconds: float, count: int, note: str = "") -> float:
    """Print one line, and return the time for each point [s]."""
    print(f"{what:28s} {seconds * 1e3:9.1f} ms for {count:8d}   {seconds / count * 1e9:12.1f} ns each   {note}")
    return seconds / count


def report_ratio(what: str, each: float, base: str, base_each: float) -> None:
    """Print the time for each point of one function over that of another."""
    print(f"{what:28s} {each / base_each:.2f} of {base}")


def ours(count: int) -> float:
    """Time our own functions, and return the time of the inverse of a leg for each point [s]."""
    foot = shell(count)
    angles = leg.inverse(HIND, foot)
    error = float(np.abs(leg.forward(HIND, angles) - foot).max())
    seconds = best_of(lambda: leg.inverse(HIND, foot))
    verdict = "" if count < 1_000_000 else "target 150 ms: " + ("met" if seconds < 0.15 else "MISSED")
    inverse = report("leg.inverse", seconds, count, f"error {error:.1e} m  {verdict}")
    forward = report("leg.forward", best_of(lambda: leg.forward(HIND, angles)), count)
    jacobian = report("leg.jacobian", best_of(lambda: leg.jacobian(HIND, angles), 3), count)
    report_ratio("leg.inverse", inverse, "leg.forward", forward)
    report_ratio("leg.jacobian", jacobian, "leg.forward", forward)
    arms(in_form(10_000, 100))
    fewer = count // 10
    bends = np.random.default_rng(1).uniform(-0.7, 0.7, (fewer, 5))
    T = spine.forward(ROBOT.spine, bends)
    azimuth = np.arctan2(T[:, 1, 0], T[:, 0, 0])
    forward = report("spine.forward", best_of(lambda: spine.forward(ROBOT.spine, bends), 3), fewer)
    closed = best_of(lambda: spine.inverse(ROBOT.spine, T[:, :3, 3], azimuth, first_yaw=bends[:, 0]), 3)
    inverse_of_spine = report("spine.inverse", closed, fewer)
    report_ratio("spine.inverse", inverse_of_spine, "spine.forward", forward)
    least = slice(0, max(fewer // 100, 1))
    seconds = best_of(lambda: spine.least_bending(ROBOT.spine, T[least, :3, 3], azimuth[least]), 3)
    report("spine.least_bending", seconds, least.stop)
    posture = np.random.default_rng(2).uniform(-0.5, 0.5, (fewer, len(joint_names(ROBOT))))
    report("landmarks of a robot", best_of(lambda: landmarks(ROBOT, posture), 3), fewer)
    return inverse


def arms(count: int) -> None:
    """Time limbs of four joints: in closed form by the plane of the limb."""
    arm = ROBOTS["salamander"].girdles[0].limb
    rng = np.random.default_rng(3)
    angles = rng.uniform(-0.6, 0.6, (count, 4)) + np.array([0.0, 0.3, 0.0, 1.0])
    foot = limb.forward(arm, angles)
    found = limb.inverse(arm, foot, swivel=0.2)
    error = float(np.abs(limb.forward(arm, found) - foot).max()) / arm.reach
    seconds = best_of(lambda: limb.inverse(arm, foot, swivel=0.2))
    verdict = "target 20 ms: " + ("met" if seconds < 0.02 else "MISSED")
    inverse = report("limb.inverse, four joints", seconds, count, f"error {error:.1e} of the reach  {verdict}")
    forward = report("limb.forward, four joints", best_of(lambda: limb.forward(arm, angles)), count)
    report_ratio("limb.inverse", inverse, "limb.forward", forward)


def with_ikpy(closed: float) -> None:
    """Time ikpy on the same leg: yaw about z, pitch and knee about -y, numerically from the sprawled posture."""
    if optional("ikpy") is None:
        return
    chain, link = import_module("ikpy.chain"), import_module("ikpy.link")
    a0, a2, a3 = HIND.hip_offset, HIND.femur, HIND.tibia

    def hinge(name: str, x: float, axis: list[float] | None) -> Any:
        joint = "fixed" if axis is None else "revolute"
        return link.URDFLink(
            name=name, origin_translation=[x, 0, 0], origin_orientation=[0, 0, 0], rotation=axis, joint_type=joint
        )

    hinges = [
        hinge("yaw", a0, [0, 0, 1]),
        hinge("pitch", 0, [0, -1, 0]),
        hinge("knee", a2, [0, -1, 0]),
        hinge("foot", a3, None),
    ]
    arm = chain.Chain([link.OriginLink(), *hinges], active_links_mask=[False, True, True, True, False])
    foot = shell(FEW)
    start = [0.0, 0.0, 0.0, 1.5, 0.0]
    seconds = best_of(lambda: [arm.inverse_kinematics(p, initial_position=start) for p in foot], 1)
    ends = [arm.forward_kinematics(arm.inverse_kinematics(p, initial_position=start))[:3, 3] for p in foot]
    each = report("ikpy", seconds, FEW, f"median error {np.median(np.linalg.norm(ends - foot, axis=1)):.1e} m")
    report_ratio("ikpy", each, "leg.inverse", closed)


def with_roboticstoolbox(closed: float) -> None:
    """Time roboticstoolbox on the same modified D-H chain, position only."""
    rtb = optional("roboticstoolbox")
    if rtb is None:
        return
    mask = [1, 1, 1, 0, 0, 0]
    links = [
        rtb.RevoluteMDH(a=HIND.hip_offset, alpha=0.0),
        rtb.RevoluteMDH(a=0.0, alpha=np.pi / 2),
        rtb.RevoluteMDH(a=HIND.femur, alpha=0.0),
    ]
    se3 = import_module("spatialmath").SE3
    arm = rtb.DHRobot(links, tool=se3(HIND.tibia, 0, 0))
    foot = shell(FEW)
    seconds = best_of(lambda: [arm.ikine_LM(se3(*p), mask=mask) for p in foot], 1)
    found = [arm.ikine_LM(se3(*p), mask=mask) for p in foot]
    solved = np.mean([bool(f.success) for f in found])
    each = report("roboticstoolbox", seconds, FEW, f"solved {solved:.0%}")
    report_ratio("roboticstoolbox", each, "leg.inverse", closed)


def main() -> None:
    """Print the settings, then all times."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else in_form(1_000_000, 1_000)
    print(f"python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}, one thread, best of 7")
    closed = ours(count)
    with_ikpy(closed)
    with_roboticstoolbox(closed)


if __name__ == "__main__":
    main()
