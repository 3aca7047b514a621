"""The water of the runs on a body whose motion is given: section by section, as in every run with a lake.

The robot's own model without limbs, wholly under water and without weight, is moved along a motion of its joints, and
the kernel of the runs says what the water does (``hydro``). So the section model can be compared to a flow in which the
same body moves in the same manner. Names and signs are those of ``water.resolved`` in space, held and free.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from math import cos, sin, tau
from typing import Any, NamedTuple

import mujoco
import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.integrate import solve_ivp

from suchus.core import water_table as hydro
from suchus.core.water_table import HEADER, WIDTH, column, pack_table, unpack_table
from suchus.robot.design import Robot
from suchus.robot.design.pieces import pieces
from suchus.robot.motion import Gait, movement
from suchus.robot.motion.axis import yaw_hinges
from suchus.sim.immersion import wetting
from suchus.sim.immersion.sea import DEEPEST
from suchus.sim.land.corrected import change_sections
from suchus.sim.land.lake import Lake
from suchus.sim.model.build import SNOUT
from suchus.sim.model.wet import wet_model

INSTANTS = 120
"""Instants of a cycle [-]."""
_GROWS = 0.5
"""Part of the first cycle in which a free swim grows from nothing, as in the flow [cycle]."""
_PLANE = np.array([0, 1, 5])
"""Places among the velocities of the root: along, to the left, about the vertical."""
_TIMESTEP = 0.002


def towed_sections(robot: Robot, speed: float, lake: Lake) -> float:
    """Return the drag of the straight body without limbs that moves forward [N].

    Args:
        robot: robot whose body is meant.
        speed: forward [m/s].
        lake: the water; its level does not matter.
    """
    body = _Submerged(robot, lake)
    body.move(
        body.qpos(np.zeros(3), np.zeros(body.joints)), body.rates(np.array([speed, 0.0, 0.0]), 0.0), body.zero_rates
    )
    return -float(body.force[0])


def held_sections(robot: Robot, gait: Gait, lake: Lake, *, sway: complex = 0j, turn: complex = 0j) -> xr.Dataset:
    """Return the forces over a cycle on a body that swims in place, with a given motion of its head.

    Args:
        robot: robot whose body is meant, without its limbs.
        gait: gait in which it swims.
        lake: the water; its level does not matter.
        sway: harmonic of the snout's displacement to the right, ``Re(h exp(2 pi i f t))`` [m].
        turn: harmonic of the head's direction, counter-clockwise from above [rad].

    Returns:
        ``thrust`` of the water forward, ``aside`` to the right, ``power`` on the water, over ``phase``.
    """
    body, count = _Submerged(robot, lake), INSTANTS
    phase = np.arange(1, count + 1) / count
    turning = np.exp(2j * np.pi * phase)
    amplitude = body.amplitudes(gait)
    angles = (turning[:, None] * amplitude).real
    root = np.array(
        [body.root_at(posture, -(sway * z).real, (turn * z).real) for posture, z in zip(angles, turning, strict=True)]
    )
    coordinates = np.hstack([root, angles])
    rate, bend = (_derived(coordinates, gait.frequency, order) for order in (1, 2))
    loads = np.empty((count, 3))
    for i in range(count):
        body.move(
            body.qpos(root[i], angles[i]), body.rates(rate[i, :3], rate[i, 3:]), body.rates(bend[i, :3], bend[i, 3:])
        )
        loads[i] = body.force[0], -body.force[1], body.power
    names = {"thrust": "N", "aside": "N", "power": "W"}
    series = {name: ("phase", loads[:, k], {"units": unit}) for k, (name, unit) in enumerate(names.items())}
    return xr.Dataset(series, coords={"phase": phase})


def free_sections(robot: Robot, gait: Gait, lake: Lake, cycles: int) -> xr.Dataset:
    """Return a swim from rest in the plane, as heavy as the water that the body displaces, its motion growing at first.

    Args:
        robot: robot whose body is meant, without its limbs.
        gait: gait in which it swims.
        lake: the water; its level does not matter.
        cycles: number of cycles [-].

    Returns:
        Per cycle ``speed`` of the centre of mass forward and ``power`` on the water; over ``phase`` of the last cycle
        ``last_thrust`` forward and ``last_aside`` to the right, along the first course, and ``last_power``.
    """
    body = _Submerged(robot, lake)
    body.fill(lake.water.density)
    joints = _growing(body.amplitudes(gait), gait.frequency)

    def accelerated(time: float, state: np.ndarray) -> np.ndarray:
        (angle, rate, bend), x, v = joints(time), state[:3], state[3:]
        return np.concatenate([v, body.freed(body.qpos(x, angle), body.rates(v, rate), body.rates(np.zeros(3), bend))])

    times = np.arange(cycles * INSTANTS + 1) / INSTANTS / gait.frequency
    solution = solve_ivp(accelerated, (0.0, times[-1]), np.zeros(6), t_eval=times, rtol=1e-6, atol=1e-8,
                     max_step=0.02 / gait.frequency)  # fmt: skip
    power, centre, force = np.empty(times.size), np.empty(times.size), np.empty((times.size, 2))
    for i, (time, state) in enumerate(zip(times, solution.y.T, strict=True)):
        (angle, rate, bend), x, v = joints(float(time)), state[:3], state[3:]
        posture, moving = body.qpos(x, angle), body.rates(v, rate)
        root = body.freed(posture, moving, body.rates(np.zeros(3), bend))
        body.move(posture, moving, body.rates(root, bend))
        power[i], centre[i], force[i] = body.power, body.centre, body.force[:2]
    means = power[1:].reshape(cycles, INSTANTS).mean(axis=1)
    speed = np.diff(centre[::INSTANTS]) * gait.frequency
    return xr.Dataset(
        {
            "speed": ("cycle", speed, {"units": "m/s"}),
            "power": ("cycle", means, {"units": "W"}),
            "last_thrust": ("phase", force[-INSTANTS:, 0], {"units": "N"}),
            "last_aside": ("phase", -force[-INSTANTS:, 1], {"units": "N"}),
            "last_power": ("phase", power[-INSTANTS:], {"units": "W"}),
        },
        coords={"cycle": np.arange(1, cycles + 1), "phase": np.arange(1, INSTANTS + 1) / INSTANTS},
    )


class SectionLoads(NamedTuple):
    """What sections feel along a motion, in the world; arrays along its samples."""

    links: Float[np.ndarray, "sample link 3"]
    """Force along x and y on each link between two lateral joints, and torque about the vertical through the root [N,
    N m]."""
    joints: Float[np.ndarray, "sample joint"]
    """Moment of the water about each lateral joint [N m]."""


def sections_along(
    robot: Robot,
    joints: Sequence[str],
    positions: Float[np.ndarray, "sample coordinate"],
    rate: Float[np.ndarray, "sample coordinate"],
    push: Float[np.ndarray, "sample coordinate"],
    lake: Lake,
) -> SectionLoads:
    """Return the loads of the section model along a motion of root and joints in the plane, such as a recorded one.

    Args:
        robot: robot whose body is meant, without its limbs.
        joints: lateral joints, from the head on.
        positions: positions of the root (x, y, yaw) and of these joints [m, rad].
        rate: their rates.
        push: their accelerations.
        lake: the water; its level does not matter.
    """
    body = _Submerged(robot, lake, joints)
    count = len(positions)
    links, moments = np.zeros((count, len(joints) + 1, 3)), np.zeros((count, len(joints)))
    for i in range(count):
        posture = body.qpos(positions[i, :3], positions[i, 3:])
        moving, gaining = (body.rates(sample_rates[i, :3], sample_rates[i, 3:]) for sample_rates in (rate, push))
        forces = body.joint_forces(posture, moving, gaining)
        moments[i] = forces[3:]
    for link, members in enumerate(body.links(joints)):
        link_body = body.restricted_to(members)
        for i in range(count):
            posture = link_body.qpos(positions[i, :3], positions[i, 3:])
            moving, gaining = (
                link_body.rates(sample_rates[i, :3], sample_rates[i, 3:]) for sample_rates in (rate, push)
            )
            links[i, link] = link_body.joint_forces(posture, moving, gaining)[:3]
    return SectionLoads(links, moments)


def link_bodies(robot: Robot, joints: Sequence[str]) -> list[tuple[str, ...]]:
    """Return the bodies of each link between two lateral joints, from the head on."""
    link_names: list[list[str]] = [[]]
    for segment in robot.axis:
        link_names[-1].append(segment.name)
        if any(hinge.name in joints for hinge in segment.hinges):
            link_names.append([])
    return [tuple(names) for names in link_names]


def _limbless(robot: Robot) -> tuple[Robot, dict[str, str]]:
    """Return a robot without limbs, and the new names of its renamed hinges.

    Without a girdle there is no neck: hinges ahead of the foremost girdle are some more of the trunk's.
    """
    hinge_names = [hinge.name for segment in robot.axis for hinge in segment.hinges]
    new_names: dict[str, str] = {}
    for neck, spine in (("neck_yaw_", "spine_yaw_"), ("neck_pitch_", "spine_pitch_")):
        count = sum(name.startswith(spine) for name in hinge_names)
        new_names |= {
            f"{neck}{k}": f"{spine}{count + k}"
            for k in range(1, sum(hinge_name.startswith(neck) for hinge_name in hinge_names) + 1)
        }
    axis = tuple(
        replace(
            segment,
            hinges=tuple(replace(hinge, name=new_names.get(hinge.name, hinge.name)) for hinge in segment.hinges),
        )
        for segment in robot.axis
    )
    return replace(robot, axis=axis, girdles=(), hull=None), new_names


class _Submerged:
    """The model of a robot without limbs, wholly under water and without weight."""

    def __init__(self, robot: Robot, lake: Lake, joints: Sequence[str] | None = None) -> None:
        """Build it; ``joints`` are the lateral joints that move, from the head on, all driven ones if None."""
        self._robot, (limbless, new_names) = robot, _limbless(robot)
        wetting.install()
        self._model = copy(wet_model(limbless, _TIMESTEP, None, len(pieces(limbless)), acting=True))
        self._model.opt.gravity[:] = 0.0
        if lake.section_change is not None:
            change_sections(self._model, lake.section_change)
        self._data = mujoco.MjData(self._model)
        self._lake = replace(lake, level=DEEPEST)
        self._hinges = yaw_hinges(robot)
        names = self._hinges.names if joints is None else joints
        self._places = [int(self._model.joint(new_names.get(name, name)).qposadr[0]) for name in names]
        self._dofs = [int(self._model.joint(new_names.get(name, name)).dofadr[0]) for name in names]
        self.joints = len(names)
        self.zero_rates = np.zeros(self._model.nv)

    def amplitudes(self, gait: Gait) -> np.ndarray:
        """Return the harmonics of the lateral joints, a cable's bend shared evenly [rad]."""
        return np.asarray(np.array(self._hinges.signs) * movement(self._robot, gait).harmonics()[0])

    def qpos(self, root: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Return a posture: the root in the plane (x, y, yaw) and the lateral joints."""
        posture = np.zeros(self._model.nq)
        posture[:2], posture[3], posture[6] = root[:2], cos(0.5 * root[2]), sin(0.5 * root[2])
        posture[self._places] = angles
        return posture

    def rates(self, root: np.ndarray, joints: Any) -> np.ndarray:
        """Return velocities or accelerations of the root in the plane and of the lateral joints."""
        dof_rates = np.zeros(self._model.nv)
        dof_rates[_PLANE], dof_rates[self._dofs] = root, joints
        return dof_rates

    def root_at(self, angles: np.ndarray, lateral: float, heading: float) -> np.ndarray:
        """Return the root (x, y, yaw) of a body from its snout and head.

        Args:
            angles: angles of the lateral joints [rad].
            lateral: distance of the snout to the left of the world's x axis [m]; its x is 0.
            heading: yaw of the head [rad].
        """
        model, data = self._model, self._data
        data.qpos[:] = self.qpos(np.zeros(3), angles)
        mujoco.mj_kinematics(model, data)
        site = model.site(SNOUT).id
        forward_axis = data.xmat[model.site_bodyid[site]].reshape(3, 3)[:, 0]
        yaw = heading - float(np.arctan2(forward_axis[1], forward_axis[0]))
        x, y = data.site_xpos[site][:2]
        return np.array([-(cos(yaw) * x - sin(yaw) * y), lateral - (sin(yaw) * x + cos(yaw) * y), yaw])

    def move(self, qpos: np.ndarray, qvel: np.ndarray, qacc: np.ndarray) -> None:
        """Compute the water forces on a posture with these velocities and accelerations."""
        data = self._data
        data.qpos[:], data.qvel[:], data.qacc[:] = qpos, qvel, qacc
        data.userdata[:] = self._lake.numbers(np.array([0.0, 0.0, 1.0]))
        mujoco.mj_fwdPosition(self._model, data)
        mujoco.mj_fwdVelocity(self._model, data)

    def joint_forces(self, qpos: np.ndarray, qvel: np.ndarray, qacc: np.ndarray) -> Float[np.ndarray, " coordinate"]:
        """Return the generalised forces of the water alone on root in the plane and lateral joints [N, N m].

        Args:
            qpos: generalised positions.
            qvel: generalised velocities.
            qacc: generalised accelerations.
        """
        forces = []
        for density in (1.0, 0.0):
            self._data.qacc[:] = qacc
            self.move(qpos, qvel, qacc)
            if density == 0.0:
                self._data.userdata[:] = 0.0
                self._data.userdata[hydro.LEVEL] = -DEEPEST
                mujoco.mj_fwdPosition(self._model, self._data)
                mujoco.mj_fwdVelocity(self._model, self._data)
            mass_matrix = np.zeros((self._model.nv, self._model.nv))
            mujoco.mj_fullM(self._model, self._data, mass_matrix)
            forces.append(self._data.qfrc_passive - mass_matrix @ qacc)
        acts: np.ndarray = forces[0] - forces[1]
        return np.concatenate([acts[_PLANE], acts[self._dofs]])

    def links(self, joints: Sequence[str]) -> list[list[int]]:
        """Return the bodies of each link between two of the lateral joints, from the head on."""
        return [[int(self._model.body(name).id) for name in names] for names in link_bodies(self._robot, joints)]

    def restricted_to(self, bodies: Sequence[int]) -> "_Submerged":
        """Return the same where water acts on some of the bodies alone."""
        restricted = copy(self)
        restricted._model = copy(self._model)
        restricted._data = mujoco.MjData(restricted._model)
        numbers = restricted._model.numeric_data
        table = unpack_table(numbers)
        is_removed = ~np.isin(table[:, 0].astype(int), bodies)
        for name in ("volume", "added", "area", "skin", "end", "roll", "shed"):
            column(table, name)[is_removed] = 0.0
        numbers[:] = pack_table(table, float(numbers[2]), (len(numbers) - HEADER) // WIDTH)
        return restricted

    def freed(self, qpos: np.ndarray, qvel: np.ndarray, qacc: np.ndarray) -> Float[np.ndarray, "3"]:
        """Return the acceleration of a free root in the plane, x, y and yaw; that in ``qacc`` does not matter."""
        self.move(qpos, qvel, qacc)
        mass_matrix = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_fullM(self._model, self._data, mass_matrix)
        free_force = self._data.qfrc_passive - self._data.qfrc_bias - mass_matrix[:, self._dofs] @ qacc[self._dofs]
        return np.asarray(np.linalg.solve(mass_matrix[np.ix_(_PLANE, _PLANE)], free_force[_PLANE]))

    def fill(self, density: float) -> None:
        """Give every body the mass of the water that its pieces displace, and its inertia."""
        model, table = self._model, unpack_table(self._model.numeric_data)
        for body in range(1, model.nbody):
            body_pieces = table[table[:, 0] == body]
            if not len(body_pieces):
                continue
            mass, centres, half = (
                density * column(body_pieces, "volume")[:, 0],
                column(body_pieces, "at"),
                column(body_pieces, "half"),
            )
            mass_centre = np.average(centres, axis=0, weights=mass)
            square = (centres - mass_centre) ** 2
            piece_inertia = np.column_stack(
                [half[:, 2] ** 2 / 3, half[:, 0] ** 2 / 4, half[:, 1] ** 2 / 4]
            )  # along x, y and z
            second = (mass[:, None] * (square + piece_inertia)).sum(axis=0)
            model.body_mass[body], model.body_ipos[body] = mass.sum(), mass_centre
            model.body_inertia[body] = second.sum() - second
            model.body_iquat[body] = (1.0, 0.0, 0.0, 0.0)
        mujoco.mj_setConst(model, self._data)

    @property
    def force(self) -> Float[np.ndarray, "3"]:
        """What the water does to the body [N]."""
        return np.array(self._data.userdata[hydro.FORCE : hydro.FORCE + 3])

    @property
    def power(self) -> float:
        """Power that the body gives to the water [W]."""
        return -float(self._data.userdata[hydro.POWER])

    @property
    def centre(self) -> float:
        """How far forward the centre of mass is [m]."""
        return float(self._data.subtree_com[1, 0])


def _growing(amplitude: np.ndarray, frequency: float) -> Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return angles, rates and accelerations over time [s] of joints whose motion grows from nothing."""
    duration, omega = _GROWS / frequency, tau * frequency

    def motion(time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return angles [rad], rates [rad/s] and accelerations [rad/s2] of the joints at a time [s]."""
        p = min(time / duration, 1.0)
        envelope = p**3 * (10 - 15 * p + 6 * p**2)
        envelope_rate = 30 * p**2 * (1 - p) ** 2 / duration
        envelope_acceleration = 60 * p * (1 - p) * (1 - 2 * p) / duration**2
        z = amplitude * np.exp(1j * omega * time)
        rate, bend = 1j * omega * z, -(omega**2) * z
        return (
            np.asarray(envelope * z.real),
            np.asarray((envelope * rate + envelope_rate * z).real),
            np.asarray((envelope * bend + 2 * envelope_rate * rate + envelope_acceleration * z).real),
        )

    return motion


def _derived(values: np.ndarray, frequency: float, order: int) -> np.ndarray:
    """Return a derivative in time of values over one cycle, shape (phase, quantity), by their harmonics."""
    count = len(values)
    turns = np.fft.rfftfreq(count, 1.0 / count)
    turns[-1] = 0.0 if order % 2 else turns[-1]
    factor = (2j * np.pi * frequency * turns) ** order
    return np.asarray(np.fft.irfft(factor[:, None] * np.fft.rfft(values, axis=0), n=count, axis=0))
