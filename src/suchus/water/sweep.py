"""Many swimming motions by the slender-body models: speed, efficiency, Strouhal number and slip of each."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from suchus.design import GRAVITY, Robot
from suchus.design.water import Water
from suchus.errors import OutsideLimits
from suchus.motion import Swim, check_swim
from suchus.water.measures import efficiency
from suchus.water.outline import Outline
from suchus.water.slender import Model, cruise, cycle
from suchus.water.swimming import MODELS, displaced, wave_speed
from suchus.water.undulation import STILL, undulation

VALUES = {"speed": "m/s", "efficiency": "1", "cost_of_transport": "1", "strouhal": "1", "slip": "1"}
"""Quantities that are computed for each motion, with units."""


def scaled(motion: Swim, amplitude: float, frequency: float) -> Swim:
    """Return a motion with its angles multiplied, at another frequency.

    Args:
        motion: to be changed.
        amplitude: factor of every angle [-].
        frequency: [Hz].
    """
    first, second, third = (amplitude * angle for angle in motion.yaw)
    return replace(motion, yaw=(first, second, third), tail=amplitude * motion.tail, frequency=frequency)


def survey(robot: Robot, motions: Sequence[Swim], *, water: Water | None = None, stations: int = 65) -> xr.Dataset:
    """Return what both slender-body models say of motions, and which of them the robot can follow.

    Args:
        robot: who swims.
        motions: how.
        water: fresh water if None.
        stations: points along the midline; 65 change the speed by less than 1 % from 257.

    Returns:
        ``VALUES`` along ``model`` and ``motion``, and ``possible`` along ``motion``: joints and servos can follow it.
    """
    outline, still = Outline(robot, stations), water or Water()
    found = np.array([[_one(outline, motion, model, still) for motion in motions] for model in MODELS.values()])
    data = {name: (("model", "motion"), found[:, :, i], {"units": VALUES[name]}) for i, name in enumerate(VALUES)}
    possible = [_possible(robot, motion) for motion in motions]
    return xr.Dataset({**data, "possible": ("motion", possible, {"units": "1"})}, coords={"model": list(MODELS)})


def greatest(robot: Robot, motion: Swim, *, most: float = 4.0) -> float:
    """Return the greatest factor of every angle at which joints and servos still follow a motion, to 1e-4 [-].

    Args:
        robot: who swims.
        motion: how.
        most: factor that is not gone beyond [-].
    """
    largest = max(*motion.yaw, motion.tail)
    low, high = 0.0, min(most, np.pi / largest) if largest > 0 else most  # no angle beyond half a turn
    if _possible(robot, scaled(motion, high, motion.frequency)):
        return high
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        if _possible(robot, scaled(motion, middle, motion.frequency)):
            low = middle
        else:
            high = middle
    return low


def _one(outline: Outline, motion: Swim, model: Model, water: Water) -> tuple[float, ...]:
    """Return ``VALUES`` of one motion by one model."""
    free = cruise(outline, motion, model, water)
    if free.speed == 0.0:
        return 0.0, 0.0, float("nan"), float("nan"), 0.0
    curve = cycle(outline, motion, free.sway, free.turn)
    straight = undulation(outline, replace(STILL, frequency=motion.frequency))
    drag = -model(outline, cycle(outline, straight), free.speed, water).thrust * float(np.sign(free.speed))
    swing = float(np.ptp(curve.y[:, -1]))
    return (
        free.speed,
        efficiency(drag, free.speed, free.power),
        free.power / (GRAVITY * displaced(outline, water.density) * abs(free.speed)),
        motion.frequency * swing / abs(free.speed),
        free.speed / wave_speed(outline, motion, curve),
    )


def _possible(robot: Robot, motion: Swim) -> bool:
    try:
        check_swim(robot, motion)
    except OutsideLimits:
        return False
    return True
