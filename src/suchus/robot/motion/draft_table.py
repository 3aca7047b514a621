"""A first walk for limbs that cannot put their feet on any path, as those of two hinges: a curve for each servo.

The foot's place ahead and its height follow a path; how far outside it stands is left to the limb. Upright limbs,
all of whose hinges swing the foot fore and aft as hip and knee of a dog do, stand with the feet below the hips and
trot: with feet ahead of the hips the mass lies behind the feet that stand, and the body falls back onto the others.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from suchus.core.errors import OutsideLimits
from suchus.robot.design import Crank, Girdle, Limb, Robot, layout
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.limits import servo_parts, suits
from suchus.robot.motion.parts import Bend, Curve

_STROKES = (0.25, 0.18, 0.12, 0.08)  # of the limb's reach, the longest that all girdles can take is taken
_DEPTHS = (0.5, 0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9)  # of the hindmost limbs' reach, the first that fits
_UPRIGHT_STROKES = (0.2, 0.16, 0.12, 0.08)
_UPRIGHT_DEPTHS = (0.75, 0.8, 0.7, 0.85, 0.9, 0.95, 0.65, 0.6, 0.5, 0.4)
_UPRIGHT_PERIOD = 0.5  # of the walk's period: on two feet below the body the robot tips over in a longer step
_UNDER_HIP = 20.0  # weight of a foot's distance from below its hip [rad/limb reach], against angles from the middle
_LIFT = 0.6  # of the stroke
_CLOUD = 4000  # random postures among which the middle of the stance is chosen
_FROM_MIDDLE = 1e-3  # weight of angles [limb reach/rad]: of two feasible postures the one near the middle is taken
_PATH_TOLERANCE, _MARGIN, _JUMP = (
    0.02,
    0.02,
    0.9,
)  # path error [limb reach]; distance from a stop [rad]; jump between two samples [rad]
_MIN_HINGES = 2
"""Hinges without which a foot cannot be lifted and brought forward."""


def table_walk(
    robot: Robot,
    *,
    name: str,
    period: float,
    duty_factor: float,
    phases: tuple[float, ...],
    axis: tuple[Bend, ...],
    path: Float[np.ndarray, "2 sample"],
) -> Gait:
    """Return a walk of curves, whose feet follow a path ahead and up as far as each limb's hinges let them.

    Args:
        robot: robot whose limbs have servos at two hinges or more.
        name: name of the gait.
        period: period of one cycle [s].
        duty_factor: share of the cycle in which a foot stands [-].
        phases: phases of the limbs when the walk begins [cycle].
        axis: how the axis bends.
        path: ahead and up over one cycle, with stroke 1 and lift 1 [-].

    Raises:
        OutsideLimits: a limb has too few hinges, or none of the paths that are tried is in reach.
    """
    place = layout(robot)
    girdles = place.robot.girdles
    for girdle in girdles:
        _check_hinges(robot, girdle)
    hind, upright = girdles[-1], any(is_upright(girdle.limb) for girdle in girdles)
    period = period * _UPRIGHT_PERIOD if upright else period
    for stroke in _UPRIGHT_STROKES if upright else _STROKES:
        for depth in _UPRIGHT_DEPTHS if upright else _DEPTHS:
            hips = depth * hind.limb.reach + hind.limb.foot.radius - hind.above  # height of the root's axis
            limb_angles: list[np.ndarray] = []
            for girdle in girdles:
                angles = _path_angles(girdle.limb, path, stroke, hips + girdle.above - girdle.limb.foot.radius)
                if angles is None:
                    break
                limb_angles.append(angles)
            if len(limb_angles) == len(girdles):
                table = _tabled(robot, name, period, duty_factor, phases, axis, limb_angles)
                if suits(robot, table):
                    return table
    raise OutsideLimits(
        f"no walk was found for robot {robot.name!r}: its limbs bring their feet along no path of {_STROKES[-1]:g} of "
        "their reach within their ranges; widen the ranges, or write a gait of its own."
    )


def _check_hinges(robot: Robot, girdle: Girdle) -> None:
    """Refuse limbs whose driven hinges cannot both lift a foot and bring it forward."""
    driven_hinges = [hinge for hinge in girdle.limb.hinges if hinge.servo is not None]
    limbs = f"limbs L{girdle.name} and R{girdle.name}"
    if len(driven_hinges) < _MIN_HINGES or any(isinstance(hinge.drive, Crank) for hinge in driven_hinges):
        raise OutsideLimits(
            f"no walk was found for robot {robot.name!r}: {limbs} have {len(driven_hinges)} driven hinges, cranks "
            f"counted, and a foot needs {_MIN_HINGES} without cranks to be lifted and brought forward; drive more of "
            "them, leave these limbs out, or write a gait of its own."
        )
    turns = {hinge.turn for hinge in driven_hinges}
    if turns in ({"yaw"}, {"pitch"}):
        lacking = "lifts" if turns == {"yaw"} else "brings forward"
        raise OutsideLimits(
            f"no walk was found for robot {robot.name!r}: all hinges of {limbs} turn by {turns.pop()}, and none "
            f"{lacking} the foot; give them a hinge that does, leave these limbs out, or write a gait of its own."
        )


def is_upright(limb: Limb) -> bool:
    """Return whether all of a limb's hinges that move swing its foot fore and aft, as hip and knee of a dog do."""
    return all(hinge.turn == "roll" for hinge in limb.hinges if hinge.servo is not None)


def _path_angles(limb: Limb, path: np.ndarray, stroke: float, down: float) -> np.ndarray | None:
    """Return the angles along a path at a depth below the hip, (sample, hinge) [rad]; None if the limb cannot.

    Args:
        limb: the design.
        path: ahead and up over one cycle, stroke 1 and lift 1 [-].
        stroke: half of the path's length [limb reach].
        down: depth of the stance below the hip [m].
    """
    lower_bound, upper_bound = np.array([hinge.range or (-np.pi, np.pi) for hinge in limb.hinges]).T
    is_driven = np.array([hinge.servo is not None for hinge in limb.hinges])
    lower_bound, upper_bound = lower_bound + _MARGIN, upper_bound - _MARGIN
    if (lower_bound >= upper_bound)[is_driven].any():
        return None
    center = np.where(is_driven, (lower_bound + upper_bound) / 2, 0.0)
    samples = np.random.default_rng(0).uniform(lower_bound, upper_bound, (_CLOUD, len(lower_bound)))
    cloud = np.where(is_driven, np.vstack([center[None], samples]), 0.0)
    feet = limb_kinematics.forward(limb, cloud)
    lower_bound, upper_bound = lower_bound[is_driven], upper_bound[is_driven]

    def foot_of(angles: np.ndarray) -> np.ndarray:
        all_angles = np.zeros(len(is_driven))
        all_angles[is_driven] = angles
        return np.asarray(limb_kinematics.forward(limb, all_angles[None])[0])

    # the middle of the stance lies where the limb is near the middle of its ranges, of an upright one below its hip
    path_error = np.abs(feet[:, 2] + down) / limb.reach
    offset_cost = _UNDER_HIP * np.abs(feet[:, 0]) / limb.reach if is_upright(limb) else 0.0
    cost = np.where(path_error < _PATH_TOLERANCE, np.abs(cloud - center).sum(axis=1) + offset_cost, np.inf)
    if not np.isfinite(cost).any():
        return None
    start = cloud[np.argmin(cost)][is_driven]
    forward_offset = 0.0 if is_upright(limb) else float(feet[np.argmin(cost), 0])
    targets = np.stack(
        [forward_offset + stroke * limb.reach * path[0], _LIFT * stroke * limb.reach * path[1] - down], axis=1
    )
    return _solve_path(foot_of, targets / limb.reach, limb.reach, start, (lower_bound, upper_bound), is_driven)


def _solve_path(
    foot_of: Callable[[np.ndarray], np.ndarray],
    targets: np.ndarray,
    reach: float,
    start: np.ndarray,
    ends: tuple[np.ndarray, np.ndarray],
    is_driven: np.ndarray,
) -> np.ndarray | None:
    """Return the angles sample by sample, each from the last; a second pass closes the cycle. None without a solution.

    Args:
        foot_of: returns the foot's position for angles of the driven hinges [m].
        targets: ahead and up of the foot at each sample [limb reach].
        reach: reach of the limb [m].
        start: angles of the first sample [rad].
        ends: lower and upper bounds of the driven hinges [rad].
        is_driven: which hinges have a servo.
    """
    lower_bound, upper_bound = ends
    center, angles = (lower_bound + upper_bound) / 2, np.clip(start, lower_bound + 1e-9, upper_bound - 1e-9)
    solution = np.zeros((len(targets), len(is_driven)))
    for _ in range(2):
        for i, (x, z) in enumerate(targets):

            def residuals(q: np.ndarray, x: float = x, z: float = z) -> np.ndarray:
                foot = foot_of(q) / reach
                return np.array([foot[0] - x, foot[2] - z, *(_FROM_MIDDLE * (q - center))])

            fit = least_squares(residuals, angles, bounds=(lower_bound, upper_bound), xtol=1e-8, ftol=1e-8)
            if np.abs(fit.fun[:2]).max() > _PATH_TOLERANCE:
                return None
            angles = np.clip(fit.x, lower_bound + 1e-9, upper_bound - 1e-9)
            solution[i, is_driven] = angles
    jump = np.abs(np.diff(solution, axis=0, append=solution[:1])).max()
    return solution if jump < _JUMP else None


def _tabled(
    robot: Robot,
    name: str,
    period: float,
    duty_factor: float,
    phases: tuple[float, ...],
    axis: tuple[Bend, ...],
    limbs: list[np.ndarray],
) -> Gait:
    """Return the gait whose curves are the limbs' angles at their phases.

    Args:
        robot: the design.
        name: name of the gait.
        period: period of a cycle [s].
        duty_factor: fraction of the cycle in which a foot stands [-].
        phases: phases of the limbs [cycle].
        axis: bends of the axis.
        limbs: angles of each girdle's limb over a cycle, shape (sample, hinge) [rad].
    """
    place, parts, count = layout(robot), servo_parts(robot), len(limbs[0])
    targets = np.zeros((count, len(place.servos)))
    for i, limb in enumerate(place.limbs):
        is_driven = [hinge.servo is not None for hinge in limb.girdle.limb.hinges]
        servo_angles = limbs[limb.number][:, is_driven]
        targets[:, limb.servos] = np.roll(servo_angles, -round(phases[i] * count), axis=0)
    curves = tuple(
        Curve(servo=servo, part="limb", angles=tuple(float(round(angle, 6)) for angle in column))
        for servo, column in zip(place.servos, targets.T, strict=True)
        if parts[servo] == "limb"
    )
    return Gait(name=name, period=period, duty_factor=duty_factor, limb_phases=phases, axis=axis, curves=curves)
