"""A lone rigid body of pieces in water, without ground: what the forces of the water can be checked against."""

from dataclasses import dataclass
from math import pi
from typing import Literal

import mujoco
import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.core.errors import Diverged
from suchus.core.water_table import BALL, COLUMNS, DISC, SLAB, WIDTH, column, unpack_table
from suchus.robot.design import GRAVITY
from suchus.sim.hydro.forces import hydrostatic
from suchus.sim.immersion import wetting
from suchus.sim.immersion.attachment import with_pieces
from suchus.sim.land.lake import Lake
from suchus.sim.land.step_division import divided_step

Point = tuple[float, float, float]
Integrator = Literal["Euler", "implicitfast", "RK4"]
_UP_AXIS = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class FloatBody:
    """A rigid body: an ellipsoid, an elliptic cylinder along its forward axis, or a box, its mass anywhere in it."""

    shape: Literal["ellipsoid", "cylinder", "box"]
    """Shape of the body."""
    half: Point
    """Half of its length, width and height [m]."""
    mass: float
    """[kg]."""
    inertia: Point
    """Principal moments of inertia about the centre of mass: forward, left, up [kg m2]."""
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of mass in the frame of the shape [m]."""
    added_mass_ratio: Point = (0.0, 0.0, 0.0)
    """Added mass over the displaced mass, forward, left, up [-]."""
    parts: int = 1
    """Strips along a cylinder, or columns along each side of a box [-]."""

    def __post_init__(self) -> None:
        """Refuse sizes, masses and inertias outside their ranges."""
        with Checks("float_body", self) as check:
            check.each("half", ("length", "width", "height"), 1e-4, 100.0, "m")
            check.number("mass", 1e-6, 1e6, "kg")
            check.each("inertia", ("forward", "left", "up"), 1e-12, 1e9, "kg m2")
            check.each("added_mass_ratio", ("forward", "left", "up"), 0.0, 100.0, "")
            check.whole("parts", 1, 200)

    @property
    def volume(self) -> float:
        """[m3]."""
        fill = {"ellipsoid": pi / 6, "cylinder": pi / 4, "box": 1.0}[self.shape]
        return 8 * fill * float(np.prod(self.half))

    def table(self) -> Float[np.ndarray, "piece column"]:
        """Return its pieces, on body 1 of a model; no drag."""
        c, a, b = self.half
        axis_a, axis_b, axis_t = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
        positions = (np.arange(self.parts) + 0.5) / self.parts * 2 - 1
        if self.shape == "ellipsoid":
            centres, kind, half = [(0.0, 0.0, 0.0)], BALL, (a, b, c)
        elif self.shape == "cylinder":
            centres, kind, half = [(c * m, 0.0, 0.0) for m in positions], DISC, (a, b, c / self.parts)
        else:
            centres = [(c * m, a * n, 0.0) for m in positions for n in positions]
            kind, half = SLAB, (c / self.parts, a / self.parts, b)
            axis_a, axis_b, axis_t = axis_t, axis_a, axis_b
        added_mass = np.array(self.added_mass_ratio)[
            [("xyz").index("xyz"[int(np.argmax(axis))]) for axis in (axis_a, axis_b, axis_t)]
        ]
        table = np.zeros((len(centres), WIDTH))
        for name, values in (
            ("body", 1), ("kind", kind), ("at", centres), ("across", axis_a), ("upward", axis_b), ("forward", axis_t),
            ("half", half), ("volume", self.volume / len(centres)), ("added", added_mass * self.volume / len(centres)),
        ):  # fmt: skip
            table[:, slice(*COLUMNS[name])] = np.reshape(values, (-1, COLUMNS[name][1] - COLUMNS[name][0]))
        return table


class FloatTank:
    """A body in a lake without a bottom.

    Args:
        body: what floats.
        lake: the water; drag of the body is none whatever its coefficients.
        timestep: time step of the physics [s].
        integrator: MuJoCo's.
    """

    def __init__(
        self, body: FloatBody, lake: Lake, *, timestep: float = 0.002, integrator: Integrator = "implicitfast"
    ) -> None:
        """Build the model of the body with its pieces, and fill the tank."""
        self._body, self._lake = body, lake
        spec = mujoco.MjSpec()
        spec.option.timestep = divided_step(timestep)
        spec.option.gravity = [0.0, 0.0, -GRAVITY]
        spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        # MuJoCo keeps no off-diagonal inertia of a body whose frame is that of its mass, and would lose that of the
        # water: the frame stands beside it.
        frame = spec.worldbody.add_body(name="float", ipos=list(np.add(body.centre, _SHAPE_CENTRE)), mass=body.mass)
        frame.inertia, frame.explicitinertial = list(body.inertia), True
        frame.add_freejoint()
        table = body.table()
        column(table, "at")[:] += _SHAPE_CENTRE
        wetting.install()
        self.model = with_pieces(spec, table, 2 * max(body.half), acting=True)
        self.data = mujoco.MjData(self.model)
        self.data.userdata[:] = lake.numbers(_UP_AXIS)
        self._table = unpack_table(self.model.numeric_data)

    def set_pose(self, centre: Point, turn: Float[np.ndarray, "4"] | None = None, velocity: Point = (0, 0, 0),
              spin: Point = (0, 0, 0)) -> None:  # fmt: skip
        """Put the body somewhere.

        Args:
            centre: middle of its shape [m].
            turn: its orientation, wxyz; upright if None.
            velocity: velocity of the middle of its shape [m/s].
            spin: angular velocity in its own frame [rad/s].
        """
        data = self.data
        data.qpos[3:7] = (1, 0, 0, 0) if turn is None else turn
        data.qvel[3:6] = spin
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, data.qpos[3:7])
        frame_offset = matrix.reshape(3, 3) @ _SHAPE_CENTRE
        data.qpos[:3] = np.array(centre) - frame_offset
        data.qvel[:3] = np.array(velocity) - np.cross(matrix.reshape(3, 3) @ spin, frame_offset)
        mujoco.mj_forward(self.model, data)

    @property
    def centre(self) -> Float[np.ndarray, "3"]:
        """Position of the middle of the shape in the world [m]."""
        return np.array(self.data.xpos[1] + self.data.xmat[1].reshape(3, 3) @ _SHAPE_CENTRE)

    @property
    def acceleration(self) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
        """Acceleration of the frame in the world [m/s2] and of its rotation in the body's frame [rad/s2]."""
        return np.array(self.data.qacc[:3]), np.array(self.data.qacc[3:6])

    def statics(self) -> Float[np.ndarray, "5"]:
        """Return what ``hydro.forces.hydrostatic`` says of the body as it lies."""
        level, air_fraction = self._lake.state_at(self.data.time)
        return np.asarray(
            hydrostatic(self._table, self.data.xpos, self.data.xmat, _UP_AXIS, level, (air_fraction, air_fraction))
        )

    def energy(self) -> float:
        """Return kinetic energy of body and added mass, and potential energy of body and water [J]."""
        data = self.data
        generalized_momentum = np.zeros(self.model.nv)
        mujoco.mj_forward(self.model, data)
        mujoco.mj_mulM(self.model, data, generalized_momentum, data.qvel)
        pull = -float(self.model.opt.gravity[2])
        lifted = self._body.mass * float(data.xipos[1, 2]) + self._lake.water.density * self.statics()[4]
        return float(0.5 * data.qvel @ generalized_momentum + pull * lifted)

    def mass_matrix(self) -> Float[np.ndarray, "6 6"]:
        """Return the inertia of body and added mass for motions along and turns about its forward, left and up axes.

        It refers to the middle of the shape; the first three rows are in kg and kg m, the others in kg m and kg m2.
        """
        data = self.data
        mujoco.mj_forward(self.model, data)
        turn = data.xmat[1].reshape(3, 3)
        moving = np.zeros((6, 6))  # of the frame that stands beside, for each unit motion of the middle
        moving[:3, :3], moving[3:, 3:] = turn, np.eye(3)
        moving[:3, 3:] = np.array([-turn @ np.cross(axis, _SHAPE_CENTRE) for axis in np.eye(3)]).T
        answers = np.zeros((6, 6))
        for motion, answer in zip(np.ascontiguousarray(moving.T), answers, strict=True):
            mujoco.mj_mulM(self.model, data, answer, motion)
        return moving.T @ answers.T

    def momenta(self) -> Float[np.ndarray, "6"]:
        """Return momentum of body and added mass, and its moment about the world's origin [kg m/s], [kg m2/s]."""
        data, generalized_momentum = self.data, np.zeros(self.model.nv)
        mujoco.mj_forward(self.model, data)
        mujoco.mj_mulM(self.model, data, generalized_momentum, data.qvel)
        moment = data.xmat[1].reshape(3, 3) @ generalized_momentum[3:6]
        return np.concatenate([generalized_momentum[:3], moment + np.cross(data.xpos[1], generalized_momentum[:3])])

    def step(self, count: int = 1) -> None:
        """Let some steps pass.

        Raises:
            Diverged: the simulation diverged.
        """
        mujoco.mj_step(self.model, self.data, count)
        if not np.isfinite(self.data.qpos).all():
            raise Diverged(f"the float diverged at {self.data.time:.3f} s.", time=float(self.data.time))

    def watch(self, duration: float, period: float) -> xr.Dataset:
        """Let time pass and return place, orientation, energy and momenta, sample by sample.

        Args:
            duration: [s].
            period: between samples, a whole number of time steps [s].
        """
        steps, samples = round(period / self.model.opt.timestep), round(duration / period)
        rows = []
        for i in range(samples + 1):
            rows.append((self.centre, np.array(self.data.qpos[3:7]), self.energy(), self.momenta()))
            if i < samples:
                self.step(steps)
        middle, turn, energy, momenta = (np.array(column) for column in zip(*rows, strict=True))
        return xr.Dataset(
            {
                "middle": (("time", "xyz"), middle, {"units": "m"}),
                "orientation": (("time", "wxyz"), turn, {"units": "1"}),
                "energy": ("time", energy, {"units": "J"}),
                "momentum": (("time", "xyz"), momenta[:, :3], {"units": "kg m/s"}),
                "angular_momentum": (("time", "xyz"), momenta[:, 3:], {"units": "kg m2/s"}),
            },
            coords={"time": ("time", period * np.arange(samples + 1), {"units": "s"})},
        )


_SHAPE_CENTRE = np.array([0.01, 0.0, 0.0])
"""The middle of the shape in the frame of the body [m]; see ``FloatTank``."""
