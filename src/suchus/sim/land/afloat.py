"""A robot on the water: whether it floats upright, and its posture at the surface in equilibrium."""

import warnings
from functools import lru_cache
from math import isnan
from typing import Literal

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from suchus.core.errors import Doubtful, InvalidDesign
from suchus.core.rotation import from_axis_angle, multiply
from suchus.core.water_table import column, unpack_table
from suchus.robot.design import Robot
from suchus.robot.design.hull import Hull
from suchus.robot.design.pieces import chambers, pieces, volumes
from suchus.sim.hydro.forces import hydrostatic
from suchus.sim.immersion import wetting
from suchus.sim.land.lake import Lake
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.sim.model.wet import wet_model

HEAVIER = 1e-3
"""Share of its mass by which a body that hovers may differ from its water [-]; the water holds one that swims so slowly
down."""
INDIFFERENT = 1e-4
"""Metacentric height over length down to which a body is not said to capsize, if it is below zero [-]."""
AIRBORNE = 0.15
"""Share of the volume in the air from which a swimmer is told so: limbs and tail then beat the air [-]."""
_EMERGED_FRACTION, _BALLAST_FRACTION = 0.05, 0.1
"""Share of the volume that is above the surface once it is mended, and of the mass that is moved to mend it [-]."""


def buoyancy(surplus_mass: float, mass: float) -> Literal["floats", "hovers", "sinks"]:
    """Return what a body does in water; it hovers where it is as heavy as the water that it displaces, to ``HEAVIER``.

    Args:
        surplus_mass: mass by which it is heavier than the water that it displaces wholly under water [kg].
        mass: [kg].
    """
    if abs(surplus_mass) <= HEAVIER * mass:
        return "hovers"
    return "sinks" if surplus_mass > 0.0 else "floats"


def capacity(robot: Robot, lake: Lake) -> tuple[float, float]:
    """Return the volume that a robot displaces fully submerged, and the volume of water that weighs as much as it [m3].

    Args:
        robot: the design; it floats if the first volume is greater than the second.
        lake: the water, as it is at the beginning.
    """
    table = pieces(robot)
    lost_air = (1 - lake.state_at(0.0)[1]) * column(table, "air").sum()
    return float(column(table, "volume").sum() - lost_air), robot.mass / lake.water.density


def hovers(robot: Robot, lake: Lake) -> bool:
    """Return whether a robot can hover in the water by releasing a part of its air."""
    spare = sum(volumes(robot).values()) - robot.mass / lake.water.density
    return 0.0 < spare <= sum(chambers(robot))


def floats(robot: Robot) -> bool:
    """Return whether a robot is lighter than the fresh water that it displaces, its air as it is built."""
    volume, weight = capacity(robot, Lake(level=robot.length))
    return volume >= weight


def check_floats(robot: Robot, lake: Lake) -> None:
    """Refuse a robot that is heavier than the water that it displaces.

    Args:
        robot: the design.
        lake: the water, as it is at the beginning.

    Raises:
        InvalidDesign: it sinks; the message says by how much, and what foam is missing.
    """
    volume, weight = capacity(robot, lake)
    if volume < weight:
        raise InvalidDesign(_sinking_message(robot, lake.water.density, (weight - volume) * lake.water.density))


def check_afloat(robot: Robot, lake: Lake, posture: Float[np.ndarray, " servo"]) -> None:
    """Warn, before it moves, of a swimmer that sinks, capsizes or floats too high; the warning says a remedy.

    Args:
        robot: the design.
        lake: the water, as it is at the beginning.
        posture: the angles of its servos in which it begins [rad].

    Warns:
        Doubtful: it is heavier than its water by ``HEAVIER`` of its mass; upright its metacentric height is below zero
            by ``INDIFFERENT`` of its length; or a share ``AIRBORNE`` of its volume and more is above the surface.
    """
    text = _doubt(robot, lake.water.density, lake.state_at(0.0)[1], tuple(map(float, posture)))
    if text:
        warnings.warn(text, Doubtful, stacklevel=2)


@lru_cache(maxsize=64)
def _doubt(robot: Robot, density: float, air_fraction: float, posture: tuple[float, ...]) -> str:
    """Return a warning about a swimmer at rest as a sentence; empty if it floats upright and deep enough."""
    equilibrium = hydrostatics(robot, np.array(posture), density=density, air_fraction=air_fraction, heel_count=3)
    if buoyancy(equilibrium.surplus_mass, equilibrium.mass) == "sinks":
        return _sinking_message(robot, density, equilibrium.surplus_mass)
    emerged_fraction = 1.0 - equilibrium.mass / (density * equilibrium.volume)
    lever = -equilibrium.metacentric_height
    if isnan(lever):
        return (
            f"robot {robot.name!r} floats on end: no pitch up to 80 degrees balances it; give it foam where it is "
            "heavy, as design.flotation.float_hull does, or move mass along its axis."
        )
    if lever > INDIFFERENT * robot.length:
        return (
            f"robot {robot.name!r} capsizes: upright its metacentric height is {-1e3 * lever:.3g} mm; lower more than "
            f"{mass_text(_BALLAST_FRACTION * equilibrium.mass)} of its mass by "
            f"{1e3 * lever / _BALLAST_FRACTION:.3g} mm, or give its back foam."
        )
    if emerged_fraction >= AIRBORNE:
        lacking = (1.0 - _EMERGED_FRACTION) * density * equilibrium.volume - equilibrium.mass
        spare = equilibrium.volume - equilibrium.mass / ((1.0 - _EMERGED_FRACTION) * density)
        return (
            f"robot {robot.name!r} floats with {emerged_fraction:.0%} of its volume in the air, where it moves no "
            f"water; {mass_text(lacking)} more mass, or {volume_text(spare)} less foam, air or other volume, leaves "
            f"{_EMERGED_FRACTION:.0%} above."
        )
    return ""


def _sinking_message(robot: Robot, density: float, excess_mass: float) -> str:
    """Return the sentence on a robot that is too heavy by a mass [kg], in water of a density [kg/m3]."""
    foam_density = (robot.hull or Hull(foam=())).density
    foam_text = "lighter foam"
    if foam_density < density:
        foam_text = f"at least {volume_text(excess_mass / (density - foam_density))} of foam more"
    return (
        f"robot {robot.name!r} sinks: it is {mass_text(excess_mass)} heavier than the water that it displaces; "
        f"{foam_text}, as design.flotation.float_hull makes, {volume_text(excess_mass / density)} more air, or "
        f"{mass_text(excess_mass)} less mass would carry it."
    )


def mass_text(mass: float) -> str:
    """Return a mass [kg] in words, in kilograms or grams."""
    return f"{mass:.3g} kg" if mass >= 1.0 else f"{1e3 * mass:.3g} g"


def volume_text(volume: float) -> str:
    """Return a volume [m3] in words, in litres or millilitres."""
    return f"{1e3 * volume:.3g} l" if volume >= 1e-4 else f"{1e6 * volume:.3g} ml"


def surfaced(
    robot: Robot, lake: Lake, up_axis: Float[np.ndarray, "3"], qpos: Float[np.ndarray, " q"], timestep: float
) -> Float[np.ndarray, " q"]:
    """Return a posture lifted to the surface, level with it but for its heel, if the robot floats clear of the ground.

    A robot that is heavier than its water, or that would touch the ground, stays as it stands.

    Args:
        robot: the design.
        lake: the water.
        up_axis: against gravity, unit vector.
        qpos: the posture on the ground.
        timestep: time step of the physics [s].
    """
    level, air_fraction = lake.state_at(0.0)
    table = np.array(pieces(robot))
    volume, weight = capacity(robot, lake)
    if volume <= weight:
        return qpos
    wetting.install()
    model = wet_model(robot, timestep, None, len(table), acting=True)
    data = mujoco.MjData(model)
    floating = np.array(qpos)
    floating[3:7] = multiply(
        multiply(_raising(up_axis), from_axis_angle(np.array([1.0, 0.0, 0.0]), lake.heel)), qpos[3:7]
    )
    floating[:3] = 0.0
    data.qpos[:] = floating
    mujoco.mj_kinematics(model, data)
    bodies = unpack_table(model.numeric_data)

    def lacking(height: float) -> float:
        return (
            float(hydrostatic(bodies, data.xpos, data.xmat, up_axis, -height, (air_fraction, air_fraction))[0]) - weight
        )

    reach = float(robot.length)
    height = brentq(lacking, -reach, reach, xtol=1e-9)  # of the root above the surface
    floating[:3] = qpos[:3] + (level + height - float(up_axis @ qpos[:3])) * up_axis
    data.qpos[:] = floating
    mujoco.mj_forward(model, data)
    touching = any(contact.dist < 0.0 for contact in data.contact)
    return qpos if touching else floating


def _raising(up_axis: np.ndarray) -> np.ndarray:
    """Return the shortest turn that takes z to ``up_axis``, as a quaternion wxyz."""
    axis = np.cross([0.0, 0.0, 1.0], up_axis)
    turn = np.array([1.0 + up_axis[2], *axis])
    return np.asarray(turn / np.linalg.norm(turn))
