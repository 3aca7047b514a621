"""Floating bodies with exact answers, and the simulated answers that are compared with them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import acos, pi, radians, sin, sqrt

import numpy as np
import xarray as xr
from scipy.optimize import brentq
from scipy.stats import qmc

from suchus.core import rotation
from suchus.core.water_table import FORCE
from suchus.robot.design import GRAVITY
from suchus.robot.design.water import Water
from suchus.sim.land.float_body import FloatBody, FloatTank, Integrator
from suchus.sim.land.lake import Lake

WATER = Water()
SURFACE_LAKE, DEEP_LAKE = Lake(level=0.0), Lake(level=20.0)
_UNIT_INERTIA = (1.0, 1.0, 1.0)
BOX = FloatBody(
    shape="box", half=(0.3, 0.15, 0.075), mass=13.5, inertia=(0.2, 0.6, 0.7), centre=(0.0, 0.0, -0.03), parts=8
)
"""A box that is half submerged and upright in equilibrium."""
SPHEROID = FloatBody(
    shape="ellipsoid",
    half=(0.3, 0.1, 0.08),
    mass=4e3 / 3 * pi * 0.0024,
    inertia=(0.05, 0.2, 0.22),
    added_mass_ratio=(0.1, 0.7, 1.1),
    centre=(0.01, 0.02, -0.01),
)
"""A neutrally buoyant spheroid whose centre of mass is off its centre."""
KEEL_ACCELERATION = 1.118721
"""Angular acceleration of the keeled hull of MuJoCo's issue 3452 at 45 degrees of heel [rad/s2]."""
BALLAST_MASS = 3.0
"""Ballast of the trimmed float of the same issue [kg]."""
_GYRATION = 0.1
"""Square of the keeled hull's radius of gyration [m2]: an ellipsoid 1 m wide and high, of even mass.

The issue gives the acceleration but not the hull. Any submerged hull with the centre of mass of ``keeled_hull`` has
this acceleration.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownDraft:
    """A body with its exact draft."""

    name: str
    """Name of the body."""
    body: FloatBody
    """The body."""
    exact_draft: float
    """Depth of its lowest point [m]."""


def drafts() -> list[KnownDraft]:
    """Return a sphere, a lying cylinder and a box at several densities, with their exact drafts.

    Depths of sphere and cylinder are roots of the exact volume of a cap and the exact area of a segment.
    """
    radius, known_drafts = 0.1, []
    sphere = FloatBody(shape="ellipsoid", half=(radius, radius, radius), mass=1, inertia=_UNIT_INERTIA)
    cylinder = FloatBody(shape="cylinder", half=(0.3, radius, radius), mass=1, inertia=_UNIT_INERTIA, parts=4)
    for density_ratio in (0.2, 0.5, 0.95):
        sphere_depth = brentq(lambda x, s=density_ratio: x * x * (3 - x) / 4 - s, 0.0, 2.0, xtol=1e-15)
        cylinder_depth = brentq(
            lambda x, s=density_ratio: (acos(1 - x) - (1 - x) * sqrt(x * (2 - x))) / pi - s, 0.0, 2.0, xtol=1e-15
        )
        known_drafts.append(_draft(f"sphere {density_ratio:g}", sphere, density_ratio, radius * sphere_depth))
        known_drafts.append(_draft(f"cylinder {density_ratio:g}", cylinder, density_ratio, radius * cylinder_depth))
        known_drafts.append(
            _draft(
                f"box {density_ratio:g}", replace(BOX, centre=(0, 0, 0)), density_ratio, 2 * BOX.half[2] * density_ratio
            )
        )
    return known_drafts


def _draft(name: str, body: FloatBody, density_ratio: float, exact: float) -> KnownDraft:
    return KnownDraft(
        name=name, body=replace(body, mass=density_ratio * WATER.density * body.volume), exact_draft=exact
    )


def draft_of(body: FloatBody) -> float:
    """Return the draft at which the buoyancy of a physics step equals the weight of a body [m]."""
    tank = FloatTank(body, SURFACE_LAKE)

    def net(depth: float) -> float:
        tank.set_pose((0.0, 0.0, -depth))
        return float(tank.data.userdata[FORCE + 2]) - body.mass * GRAVITY

    half_height = body.half[2] * (1 - 1e-12)
    return float(brentq(net, -half_height, half_height, xtol=1e-12)) + body.half[2]


def simulate_heave(
    added_mass_ratio: float, amplitude: float, periods: int, timestep: float
) -> tuple[xr.Dataset, float]:
    """Return the heave of a half-submerged box that is released above equilibrium, and its exact period [s].

    Args:
        added_mass_ratio: added mass of the water over the mass of the box [-].
        amplitude: height of the release above equilibrium [m].
        periods: duration of the motion [exact period].
        timestep: time step of the physics [s].
    """
    waterline_area = 0.3 * 0.15 * 4
    # half submerged, the box is as heavy as the displaced water, and the added mass counts in the same proportion
    body = replace(
        BOX,
        added_mass_ratio=(0.0, 0.0, added_mass_ratio),
        centre=(0.0, 0.0, 0.0),
        mass=0.5 * WATER.density * BOX.volume,
    )
    exact = 2 * pi * sqrt((1 + added_mass_ratio) * body.mass / (WATER.density * GRAVITY * waterline_area))
    tank = FloatTank(body, SURFACE_LAKE, timestep=timestep)
    tank.set_pose((0.0, 0.0, amplitude))
    return tank.watch(periods * exact, timestep), exact


def heave_period(motion: xr.Dataset) -> float:
    """Return the mean time between downward crossings of the surface [s]."""
    z, t = motion.middle.values[:, 2], motion.time.values
    crossings = np.flatnonzero((z[:-1] > 0) & (z[1:] <= 0))
    times = t[crossings] + (t[1] - t[0]) * z[crossings] / (z[crossings] - z[crossings + 1])
    return float(np.diff(times).mean())


def simulate_rocking(duration: float, integrator: Integrator, timestep: float) -> xr.Dataset:
    """Return the motion of a box that is released heeled and pitched, without drag and added mass.

    Args:
        duration: duration of the motion [s].
        integrator: MuJoCo's integrator.
        timestep: time step of the physics [s].
    """
    tank = FloatTank(BOX, SURFACE_LAKE, timestep=timestep, integrator=integrator)
    quaternion = rotation.multiply(
        rotation.from_axis_angle(np.array([0.0, 1.0, 0.0]), 0.1),
        rotation.from_axis_angle(np.array([1.0, 0.0, 0.0]), 0.4),
    )
    tank.set_pose((0.0, 0.0, 0.02), quaternion)
    return tank.watch(duration, 0.1)


def relative_energy_gain(motion: xr.Dataset) -> float:
    """Return the greatest gain of energy over the initial energy above equilibrium [-].

    Equilibrium is the state of least potential energy: BOX upright and half submerged.
    """
    rest_tank = FloatTank(BOX, SURFACE_LAKE)
    rest_tank.set_pose((0.0, 0.0, 0.0))
    energy = motion.energy.values
    return float((energy.max() - energy[0]) / (energy[0] - rest_tank.energy()))


def simulate_drift(integrator: Integrator, timestep: float) -> xr.Dataset:
    """Return the motion of a spheroid in ideal water without gravity, with velocity and spin about all axes.

    Args:
        integrator: MuJoCo's integrator.
        timestep: time step of the physics [s].
    """
    tank = FloatTank(SPHEROID, DEEP_LAKE, timestep=timestep, integrator=integrator)
    tank.model.opt.gravity[:] = 0.0
    tank.set_pose((0.0, 0.0, 0.0), velocity=(0.5, 0.2, 0.1), spin=(0.8, 0.5, -1.0))
    return tank.watch(2.0, 0.1)


def relative_momentum_drift(motion: xr.Dataset) -> float:
    """Return the greatest change of linear and angular momentum over their initial magnitude [-]."""
    relative_changes = []
    for name in ("momentum", "angular_momentum"):
        values = motion[name].values
        relative_changes.append(np.linalg.norm(values - values[0], axis=1).max() / np.linalg.norm(values[0]))
    return float(max(relative_changes))


def bodies_by_piece() -> dict[str, FloatBody]:
    """Return one body for each kind of piece into which the buoyancy model divides bodies, by that kind.

    All have the same half extents: a cylinder along x of elliptic discs, an ellipsoid of one ball, a box of slabs.
    """
    half_extents = (0.25, 0.1, 0.06)
    return {
        "disc": FloatBody(shape="cylinder", half=half_extents, mass=1, inertia=_UNIT_INERTIA, parts=100),
        "ball": FloatBody(shape="ellipsoid", half=half_extents, mass=1, inertia=_UNIT_INERTIA),
        "slab": FloatBody(shape="box", half=half_extents, mass=1, inertia=_UNIT_INERTIA, parts=48),
    }


def volume_errors(body: FloatBody, poses: int, points: int) -> np.ndarray:
    """Return the error of the submerged volume against counted points, over the whole volume, for each pose [-].

    Args:
        body: body that is made of pieces.
        poses: number of random orientations and depths [-].
        points: number of points of a Sobol sequence, a power of two [-].
    """
    rng = np.random.default_rng(0)
    cube = 2 * qmc.Sobol(3, seed=0).random(points) - 1
    is_inside: dict[str, Callable[[np.ndarray], np.ndarray]] = {
        "ellipsoid": lambda p: (p**2).sum(axis=1) <= 1,
        "cylinder": lambda p: (p[:, 1:] ** 2).sum(axis=1) <= 1,
        "box": lambda p: np.full(len(p), True),
    }
    cloud = cube[is_inside[body.shape](cube)] * body.half
    tank, errors = FloatTank(body, SURFACE_LAKE), []
    for turn, depth in zip(rng.normal(size=(poses, 4)), rng.uniform(-0.12, 0.12, poses), strict=True):
        quaternion = turn / np.linalg.norm(turn)
        tank.set_pose((0.0, 0.0, -depth), quaternion)
        height = rotation.rotate(quaternion, cloud)[:, 2] - depth
        errors.append(tank.statics()[0] / body.volume - float((height < 0).mean()))
    return np.abs(errors)


def public_table() -> dict[str, float]:
    """Return the accelerations and the force of the table in MuJoCo's issue 3452, as this physics computes them.

    The keys are ``neutral`` [m/s2], ``ballast`` [N] and ``keel`` [rad/s2].
    """
    neutral = FloatTank(CENTERED_SPHEROID, DEEP_LAKE)
    neutral.set_pose((0.0, 0.0, 0.0))
    float_ = FloatBody(
        shape="box", half=(0.15, 0.15, 0.15), mass=WATER.density * 0.027 + BALLAST_MASS, inertia=_UNIT_INERTIA
    )
    ballasted = FloatTank(float_, DEEP_LAKE)
    ballasted.set_pose((0.0, 0.0, 0.0))
    hull = keeled_hull()
    keel = FloatTank(hull, DEEP_LAKE)
    keel.set_pose((0.0, 0.0, 0.0), rotation.from_axis_angle(np.array([1.0, 0.0, 0.0]), radians(45)))
    return {
        "neutral": float(neutral.acceleration[0][2]),
        "ballast": float(ballasted.acceleration[0][2]) * float_.mass,
        "keel": -float(keel.acceleration[1][0]),
    }


CENTERED_SPHEROID = replace(SPHEROID, centre=(0.0, 0.0, 0.0), added_mass_ratio=(0.0, 0.0, 0.0))
"""A neutrally buoyant spheroid whose centre of mass is its centre."""


def keeled_hull() -> FloatBody:
    """Return a submerged hull whose keel turns it upright with the issue's angular acceleration."""
    body = FloatBody(shape="ellipsoid", half=(1.0, 0.5, 0.5), mass=1, inertia=_UNIT_INERTIA)
    mass = WATER.density * body.volume
    center_depth = KEEL_ACCELERATION * _GYRATION / (GRAVITY * sin(radians(45)))
    inertia = (mass * _GYRATION, mass * 0.25, mass * 0.25)
    return replace(body, mass=mass, inertia=inertia, centre=(0.0, 0.0, -center_depth))
