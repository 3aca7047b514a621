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
_UPRIGHT_PERIOD = 0.5  # of the walk's: two feet below the body hold it up only for as long as it takes to tip over
_UNDER_HIP = 20.0  # weight of a foot's distance from below its hip, in reaches, beside angles from the middle in rad
_LIFT = 0.6  # of the stroke
_CLOUD = 4000  # postures among which the middle of the stance is looked for
_FROM_MIDDLE = 1e-3  # weight of angles beside lengths in reaches: of two postures that do, the one near the middle
_OFF, _MARGIN, _JUMP = 0.02, 0.02, 0.9  # reaches off the path; rad from a stop; rad between two samples
_NEEDED = 2
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
        robot: whose limbs have servos at two hinges or more.
        name: of the gait.
        period: of one cycle [s].
        duty_factor: share of the cycle in which a foot stands [-].
        phases: of the limbs when the walk begins [cycle].
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
            found: list[np.ndarray] = []
            for girdle in girdles:
                angles = _followed(girdle.limb, path, stroke, hips + girdle.above - girdle.limb.foot.radius)
                if angles is None:
                    break
                found.append(angles)
            if len(found) == len(girdles):
                table = _tabled(robot, name, period, duty_factor, phases, axis, found)
                if suits(robot, table):
                    return table
    raise OutsideLimits(
        f"no walk was found for robot {robot.name!r}: its limbs bring their feet along no path of {_STROKES[-1]:g} of "
        "their reach within their ranges; widen the ranges, or write a gait of its own."
    )


def _check_hinges(robot: Robot, girdle: Girdle) -> None:
    driven = [hinge for hinge in girdle.limb.hinges if hinge.servo is not None]
    limbs = f"limbs L{girdle.name} and R{girdle.name}"
    if len(driven) < _NEEDED or any(isinstance(hinge.drive, Crank) for hinge in driven):
        raise OutsideLimits(
            f"no walk was found for robot {robot.name!r}: {limbs} have {len(driven)} driven hinges, cranks counted, "
            f"and a foot needs {_NEEDED} without cranks to be lifted and brought forward; drive more of them, leave "
            "these limbs out, or write a gait of its own."
        )
    turns = {hinge.turn for hinge in driven}
    if turns in ({"yaw"}, {"pitch"}):
        lacking = "lifts" if turns == {"yaw"} else "brings forward"
        raise OutsideLimits(
            f"no walk was found for robot {robot.name!r}: all hinges of {limbs} turn by {turns.pop()}, and none "
            f"{lacking} the foot; give them a hinge that does, leave these limbs out, or write a gait of its own."
        )


def is_upright(limb: Limb) -> bool:
    """Return whether all of a limb's hinges that move swing its foot fore and aft, as hip and knee of a dog do."""
    return all(hinge.turn == "roll" for hinge in limb.hinges if hinge.servo is not None)


def _followed(limb: Limb, path: np.ndarray, stroke: float, down: float) -> np.ndarray | None:
    """Return the angles along a path at a depth below the hip, (sample, hinge) [rad]; None if the limb cannot."""
    low, high = np.array([hinge.range or (-np.pi, np.pi) for hinge in limb.hinges]).T
    driven = np.array([hinge.servo is not None for hinge in limb.hinges])
    low, high = low + _MARGIN, high - _MARGIN
    if (low >= high)[driven].any():
        return None
    middle = np.where(driven, (low + high) / 2, 0.0)
    drawn = np.random.default_rng(0).uniform(low, high, (_CLOUD, len(low)))
    cloud = np.where(driven, np.vstack([middle[None], drawn]), 0.0)
    feet = limb_kinematics.forward(limb, cloud)
    low, high = low[driven], high[driven]

    def placed(angles: np.ndarray) -> np.ndarray:
        whole = np.zeros(len(driven))
        whole[driven] = angles
        return np.asarray(limb_kinematics.forward(limb, whole[None])[0])

    # the middle of the stance lies where the limb is near the middle of its ranges, of an upright one below its hip
    apart = np.abs(feet[:, 2] + down) / limb.reach
    under = _UNDER_HIP * np.abs(feet[:, 0]) / limb.reach if is_upright(limb) else 0.0
    cost = np.where(apart < _OFF, np.abs(cloud - middle).sum(axis=1) + under, np.inf)
    if not np.isfinite(cost).any():
        return None
    start = cloud[np.argmin(cost)][driven]
    ahead = 0.0 if is_upright(limb) else float(feet[np.argmin(cost), 0])
    wanted = np.stack([ahead + stroke * limb.reach * path[0], _LIFT * stroke * limb.reach * path[1] - down], axis=1)
    return _solved(placed, wanted / limb.reach, limb.reach, start, (low, high), driven)


def _solved(
    placed: Callable[[np.ndarray], np.ndarray],
    wanted: np.ndarray,
    reach: float,
    start: np.ndarray,
    ends: tuple[np.ndarray, np.ndarray],
    driven: np.ndarray,
) -> np.ndarray | None:
    """Return the angles sample by sample, each from the one before; the second round closes the cycle."""
    low, high = ends
    middle, angles = (low + high) / 2, np.clip(start, low + 1e-9, high - 1e-9)
    found = np.zeros((len(wanted), len(driven)))
    for _ in range(2):
        for i, (x, z) in enumerate(wanted):

            def off(q: np.ndarray, x: float = x, z: float = z) -> np.ndarray:
                foot = placed(q) / reach
                return np.array([foot[0] - x, foot[2] - z, *(_FROM_MIDDLE * (q - middle))])

            done = least_squares(off, angles, bounds=(low, high), xtol=1e-8, ftol=1e-8)
            if np.abs(done.fun[:2]).max() > _OFF:
                return None
            angles = np.clip(done.x, low + 1e-9, high - 1e-9)
            found[i, driven] = angles
    jump = np.abs(np.diff(found, axis=0, append=found[:1])).max()
    return found if jump < _JUMP else None


def _tabled(
    robot: Robot,
    name: str,
    period: float,
    duty_factor: float,
    phases: tuple[float, ...],
    axis: tuple[Bend, ...],
    limbs: list[np.ndarray],
) -> Gait:
    """Return the gait of the limbs' angles at their phases, with the axis bent as it is said."""
    place, parts, count = layout(robot), servo_parts(robot), len(limbs[0])
    targets = np.zeros((count, len(place.servos)))
    for i, limb in enumerate(place.limbs):
        driven = [hinge.servo is not None for hinge in limb.girdle.limb.hinges]
        mine = limbs[limb.number][:, driven]
        targets[:, limb.servos] = np.roll(mine, -round(phases[i] * count), axis=0)
    curves = tuple(
        Curve(servo=servo, part="limb", angles=tuple(float(round(angle, 6)) for angle in column))
        for servo, column in zip(place.servos, targets.T, strict=True)
        if parts[servo] == "limb"
    )
    return Gait(name=name, period=period, duty_factor=duty_factor, limb_phases=phases, axis=axis, curves=curves)
