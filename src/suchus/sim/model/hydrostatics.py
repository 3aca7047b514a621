"""Hydrostatics of a robot at rest, as naval architects draw them: draft, trim, metacentric height, righting curve."""

from dataclasses import dataclass
from math import atan2, cos, isnan, nan, radians, sin
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.core.water_table import column, unpack_table
from suchus.robot.design import WATER_DENSITY, Robot, layout, servo_names
from suchus.robot.design.pieces import pieces
from suchus.sim.hydro.forces import hydrostatic
from suchus.sim.model.build import TIMESTEP, joint_addresses
from suchus.sim.model.wet import wet_model

AirFractions = tuple[float, float]
"""Shares of the air that are kept in the front and in the rear chambers [-]."""
_STEEPEST = radians(80)
_SMALL = radians(0.5)


@dataclass(frozen=True, slots=True, kw_only=True)
class Hydrostatics:
    """How a robot floats, rigid in a posture."""

    mass: float
    """Mass with the foam [kg]."""
    volume: float
    """Volume with the foam, all of it under water [m3]."""
    is_floating: bool
    """Whether it is lighter than the water that it can displace."""
    missing_volume: float
    """Volume that it lacks to float with nothing above the surface; negative where it has some to spare [m3]."""
    surplus_mass: float
    """Mass by which it is too heavy; negative where it could carry more [kg]."""
    draft: float
    """Distance from the surface down to its lowest point, upright; NaN if it sinks or no trim balances it [m]."""
    trim: float
    """Pitch at rest, upright, nose down positive; NaN if it sinks, or none up to 80 degrees balances it [rad]."""
    trim_submerged: float
    """Pitch at which, wholly under water, its centre of buoyancy is above that of mass, nose down positive [rad]."""
    metacentric_height: float
    """Transverse: slope of the righting lever where it is upright; under water, the centre of buoyancy over that of
    mass [m]."""
    heel: Float[np.ndarray, " heel"]
    """Angles of heel [rad]."""
    lever: Float[np.ndarray, " heel"]
    """Righting lever GZ at each, trim and draft free, under water the trim held level; positive rights it; NaN where
    no trim balances it [m]."""

    @property
    def vanishing(self) -> float:
        """Least heel beyond which it does not right itself; that of the end of the curve if it does all along [rad]."""
        unstable = np.flatnonzero((self.lever <= 0.0) & (self.heel > 0.0))
        if not unstable.size:
            return float(self.heel[-1])
        first_unstable = int(unstable[0])
        if first_unstable == 0 or self.lever[first_unstable - 1] <= 0.0:
            return float(self.heel[max(first_unstable - 1, 0)])
        fraction = self.lever[first_unstable - 1] / (self.lever[first_unstable - 1] - self.lever[first_unstable])
        return float(
            self.heel[first_unstable - 1] + fraction * (self.heel[first_unstable] - self.heel[first_unstable - 1])
        )


class _Rigid:
    """A robot frozen in a posture: its pieces, its weight and its centre of mass, root at the origin."""

    def __init__(self, robot: Robot, servo_angles: np.ndarray, density: float, air_fraction: AirFractions) -> None:
        """Compute positions, mass and volume of the robot in its posture."""
        table = np.array(pieces(robot))
        model = wet_model(robot, TIMESTEP, None, len(table))
        self.data = data = mujoco.MjData(model)
        data.qpos[:3] = 0.0  # the model begins at a height that may be beyond the reach of a small robot
        _bend(model, data, robot, servo_angles)
        mujoco.mj_fwdPosition(model, data)
        self.table = unpack_table(model.numeric_data)
        self.centre, self.mass = np.array(data.subtree_com[0]), float(model.body_subtreemass[0])
        air = float(column(table, "air").sum(axis=0) @ (1.0 - np.array(air_fraction)))
        self.volume, self.air_fraction, self.density = float(column(table, "volume").sum()) - air, air_fraction, density
        length, extent = float(robot.length), float(np.linalg.norm(data.xpos[1:], axis=1).max())
        self.reach = 2.0 * length if extent <= length else 2.0 * (length + extent)  # limbs may be longer than the body
        self.sunk = self.volume <= self.mass / density

    def lever_at(self, heel: float, nose_up: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Return the lever from the centre of mass to that of buoyancy at an attitude and its own draft.

        Args:
            heel: angle of heel [rad].
            nose_up: pitch, nose up positive [rad].

        Returns:
            The upward unit vector in the body's frame, shape (3,) [-]; the lever in the body's frame, shape (3,) [m];
            and the height of the water's surface along the upward vector, from the body's origin [m].
        """
        up_axis = np.array([sin(nose_up), cos(nose_up) * sin(heel), cos(nose_up) * cos(heel)])

        def surplus_volume(height: float) -> float:
            return float(self._statics(up_axis, height)[0] - self.mass / self.density)

        surface_height = self.reach if self.sunk else brentq(surplus_volume, -self.reach, self.reach, xtol=1e-10)
        sums = self._statics(up_axis, surface_height)
        return up_axis, sums[1:4] / sums[0] - self.centre, surface_height

    def _statics(self, up_axis: np.ndarray, surface_height: float) -> np.ndarray:
        return np.asarray(
            hydrostatic(self.table, self.data.xpos, self.data.xmat, up_axis, surface_height, self.air_fraction)
        )

    def trim_submerged(self) -> float:
        """Return the pitch at which the centre of buoyancy is above that of mass, under water, nose down [rad]."""
        sums = self._statics(np.array([0.0, 0.0, 1.0]), 2.0 * self.reach)
        arm = sums[1:4] / sums[0] - self.centre
        return -atan2(arm[0], arm[2]) + 0.0  # no -0

    def balance(self, heel: float, nose_up_guess: float) -> tuple[float, float, float]:
        """Return pitch [rad], righting lever [m] and height of the surface [m] at a heel.

        Afloat, the pitch is that of equilibrium. All three are NaN where no pitch up to 80 degrees is an equilibrium:
        the body would float on end. A body that sinks keeps the pitch 0.

        Args:
            heel: angle of heel [rad].
            nose_up_guess: pitch at which the search begins, nose up positive [rad].
        """

        def trim_moment(nose_up: float) -> float:
            up_axis, arm, _ = self.lever_at(heel, nose_up)
            forward = np.array([1.0, 0.0, 0.0]) - up_axis[0] * up_axis
            return float(arm @ forward)

        nose_up = 0.0 if self.sunk else _root(trim_moment, nose_up_guess)
        if isnan(nose_up):
            return nan, nan, nan
        up_axis, arm, surface_height = self.lever_at(heel, nose_up)
        forward = np.array([1.0, 0.0, 0.0]) - up_axis[0] * up_axis
        leftward = np.cross(up_axis, forward / np.linalg.norm(forward))
        return nose_up, -float(arm @ leftward), surface_height


def _root(function: Any, guess: float) -> float:
    """Return the zero nearest to a guess, by widening brackets around it; NaN if there is none up to the steepest."""
    for width in np.geomspace(radians(0.5), 2 * _STEEPEST, 12):
        lower_bound, upper_bound = max(guess - width, -_STEEPEST), min(guess + width, _STEEPEST)
        if function(lower_bound) * function(upper_bound) <= 0:
            return float(brentq(function, lower_bound, upper_bound, xtol=1e-7))
    return float("nan")


def _bend(model: Any, data: Any, robot: Robot, servo_angles: np.ndarray) -> None:
    robot_layout = layout(robot)
    direct = [i for i in range(len(robot_layout.servos)) if i not in robot_layout.cables]
    data.qpos[joint_addresses(model, [robot_layout.servos[i] for i in direct])] = servo_angles[direct]


def hydrostatics(
    robot: Robot,
    servo_angles: Float[np.ndarray, " servo"] | None = None,
    *,
    density: float = WATER_DENSITY,
    air_fraction: float | AirFractions = 1.0,
    heel_count: int = 37,
) -> Hydrostatics:
    """Return how a robot floats, rigid in a posture with its cables straight.

    Args:
        robot: the design.
        servo_angles: angles of its servos [rad]; zeros if None.
        density: density of the water [kg/m3].
        air_fraction: share of the hull's air that is kept, or those of its front and rear chambers [-].
        heel_count: number of angles of heel, from 0 to 180 degrees, at which the lever is computed [-].

    Raises:
        InvalidDesign: a density or air fraction that cannot be, or another number of servo angles.
    """
    require("hydrostatics", "density", density, 1.0, 2e4, "kg/m3")
    fractions = _fraction_pair(air_fraction)
    require("hydrostatics", "heel_count", heel_count, 3, 1000, "")
    posture = np.zeros(len(servo_names(robot))) if servo_angles is None else np.asarray(servo_angles, dtype=float)
    if len(posture) != len(servo_names(robot)):
        raise InvalidDesign(
            f"{len(posture)} servo angles are given and robot {robot.name!r} has {len(servo_names(robot))} servos."
        )
    body = _Rigid(robot, posture, density, fractions)
    is_floating = body.volume * density > body.mass
    nose_up, _, surface_height = body.balance(0.0, 0.0)
    heel = np.linspace(0.0, np.pi, int(heel_count))
    lever, nose_up_guess = np.zeros(len(heel)), 0.0 if isnan(nose_up) else nose_up
    for i, heel_angle in enumerate(heel):
        balanced_nose_up, lever[i], _ = body.balance(float(heel_angle), nose_up_guess)
        nose_up_guess = nose_up_guess if isnan(balanced_nose_up) else balanced_nose_up
    nose_up_guess = 0.0 if isnan(nose_up) else nose_up
    slope = (body.balance(_SMALL, nose_up_guess)[1] - body.balance(-_SMALL, nose_up_guess)[1]) / (2 * _SMALL)
    lowest = nan if isnan(nose_up) else _lowest_point(body, body.lever_at(0.0, nose_up)[0])
    return Hydrostatics(
        mass=body.mass,
        volume=body.volume,
        is_floating=bool(is_floating),
        missing_volume=body.mass / density - body.volume,
        surplus_mass=body.mass - density * body.volume,
        draft=surface_height - lowest if is_floating else float("nan"),
        trim=-nose_up + 0.0 if is_floating else float("nan"),  # no -0
        trim_submerged=body.trim_submerged(),
        metacentric_height=float(slope),
        heel=heel,
        lever=lever,
    )


def _fraction_pair(air_fraction: float | AirFractions) -> AirFractions:
    """Return the shares of the air in front and rear chambers."""
    if isinstance(air_fraction, tuple):
        for name, fraction in zip(("front", "rear"), air_fraction, strict=True):
            require("hydrostatics", f"air_fraction ({name})", fraction, 0.0, 1.0, "")
        return air_fraction
    require("hydrostatics", "air_fraction", air_fraction, 0.0, 1.0, "")
    return float(air_fraction), float(air_fraction)


def _lowest_point(body: _Rigid, up_axis: np.ndarray) -> float:
    """Return the height of the lowest point of the pieces [m]."""
    ids = body.table[:, 0].astype(int)
    turn = body.data.xmat[ids].reshape(-1, 3, 3)
    centres = body.data.xpos[ids] + np.einsum("nij,nj->ni", turn, column(body.table, "at"))
    extent = [
        (np.einsum("nij,nj->ni", turn, column(body.table, axis)) @ up_axis) * column(body.table, "half")[:, k]
        for k, axis in enumerate(("across", "upward", "forward"))
    ]
    return float((centres @ up_axis - np.sqrt(np.sum(np.square(extent), axis=0))).min())
