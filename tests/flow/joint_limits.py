"""References for joints in the water that know neither the coupling nor the physics' integrator.

``beside`` has a body of the flow solver that the water moves in its three degrees of freedom, while its joints bend as
they are told. ``FreeLinks`` are rigid links at hinges that nothing drives: Lagrange's equations from the places of the
links alone, and each step is taken again from a snapshot until force and motion agree.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from suchus import flow
from suchus.flow.mass import Mass
from suchus.robot.design import Spring
from suchus.sim.model import joint_addresses
from suchus.swimming.coupling.chain import ChainState

SMALL = 1e-5
"""Change of a coordinate over which derivatives are taken [m, rad]."""


def sprung(robot, stiffness, damping):
    """A robot whose axis bends at hinges with springs and dampers alone [N m/rad, N m s/rad], servos as good as these.

    They have no rotors and no friction, and all the torque that they ask for.
    """
    spring = Spring(stiffness=stiffness, damping=damping, armature=0.0)

    def changed(hinge):
        if isinstance(hinge.drive, Spring):
            return replace(hinge, drive=spring)
        servo = replace(
            hinge.drive, kp=max(stiffness, 1e-9), ki=0.0, kd=damping, torque=1e6, speed=1e4, armature=1e-15,
            friction=0.0, damping=0.0, winding=None,
        )  # fmt: skip
        return replace(hinge, drive=servo)

    axis = tuple(replace(one, hinges=tuple(changed(hinge) for hinge in one.hinges)) for one in robot.axis)
    return replace(robot, axis=axis)


class Links:
    """The masses of a robot's links, and where they are in the plane in the coordinates of a chain."""

    def __init__(self, swim):
        self.model = model = swim.stepper.model
        self._data, self._chain = mujoco.MjData(model), swim.chain
        self._joints = joint_addresses(model, swim.chain.joints)
        self.bodies = [k for k in range(1, model.nbody) if model.body_mass[k] > 0.0]
        self.mass = model.body_mass[self.bodies]
        self._start = swim.chain.flow_state(np.zeros(swim.chain.size), np.zeros(swim.chain.size)).position[:2]

    def number(self, name):
        """Which link has a name."""
        return self.bodies.index(self.model.body(name).id)

    def places(self, place):
        """Centres (2, link) and angles of the links [m, rad], and moments of inertia about the vertical [kg m2]."""
        data, model = self._data, self.model
        data.qpos[:] = 0.0
        data.qpos[:2] = self._start - place[:2]  # the flow is the world turned by half a turn
        data.qpos[3], data.qpos[6] = np.cos(0.5 * place[2]), np.sin(0.5 * place[2])
        data.qpos[self._joints] = place[3:]
        mujoco.mj_kinematics(model, data)
        turned = data.xmat[self.bodies].reshape(-1, 3, 3)
        own = data.ximat[self.bodies].reshape(-1, 3, 3)
        inertia = (own[:, 2, :] ** 2 * model.body_inertia[self.bodies]).sum(axis=1)
        centre = self._start[:, None] - data.xipos[self.bodies, :2].T
        return centre, np.arctan2(turned[:, 1, 0], turned[:, 0, 0]), inertia

    def motions(self, place):
        """How centres (2, link, coordinate) and angles (link, coordinate) change with each coordinate."""
        moves, turns = [], []
        for unit in np.eye(place.size):
            (ahead, one, _), (behind, other, _) = (self.places(place + way * SMALL * unit) for way in (1, -1))
            moves.append((ahead - behind) / (2 * SMALL))
            turns.append(np.angle(np.exp(1j * (one - other))) / (2 * SMALL))
        return np.stack(moves, axis=-1), np.stack(turns, axis=-1)

    def inertia(self, place):
        """The mass matrix of the coordinates [kg, kg m, kg m2]."""
        moves, turns = self.motions(place)
        own = self.places(place)[2]
        return np.einsum("l,clj,clk->jk", self.mass, moves, moves) + np.einsum("l,lj,lk->jk", own, turns, turns)

    def bias(self, place, rate):
        """The force that it takes to keep all rates [N, N m]."""
        size = max(float(np.abs(rate).max()), 1e-12)
        ahead, behind = (self.motions(place + way * 1e-3 * rate / size)[0] for way in (1, -1))
        turning = (ahead - behind) @ rate * size / 2e-3
        return np.einsum("l,clj,cl->j", self.mass, self.motions(place)[0], turning)


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
    """A force on one link through its centre, for a while."""

    link: str
    """Name of the link."""
    force: tuple[float, float]
    """Along the axes of the flow [N]."""
    at: float
    """When it begins [s]: a free body of the flow solver knows no added mass in its very first step."""
    duration: float
    """How long it lasts [s]."""

    def share(self, start, end):
        """Share of a time in which it lasts."""
        return max(min(end, self.at + self.duration) - max(start, self.at), 0.0) / (end - start)


class FreeLinks:
    """A robot's links in its water, from rest in a posture: coordinates and rates after each step."""

    def __init__(self, swim, push):
        self.swim, self.links, self.push = swim, Links(swim), push
        self.depth = swim.depth
        self.state = swim.path.posture_at(0.0)
        self.more = np.zeros(swim.chain.size)
        self.retries, self.force, self.left = 0, np.zeros(swim.chain.size), 0.0

    def step(self, h):
        """Take a step, again and again from where it began, until Newton's law holds to 1e-5 of its largest force."""
        swim, sim, start = self.swim, self.swim.sim, self.swim.sim.time
        name, (q, v) = swim.run.robot.name, self.state
        kept, origin = sim.snapshot(), np.array(sim.frame[0])
        modes = swim.chain.modes(q, origin, 2)
        found = sim.added_mass(name, modes)
        inside = swim.chain.unpressed(q, found.internal_pressure, origin)
        added = self.depth * (found.matrix - 0.5 * (inside + inside.T))
        a = self.more
        for _ in range(60):
            end = ChainState(q + h * v + 0.5 * h * h * a, v + h * a)
            swim.path.go(start, ChainState(q, v), start + h, end)
            sim.advance(h)
            middle = 0.5 * (q + end.position)
            force = self.depth * swim.chain.force(middle, sim.last_loads(name), np.array(sim.frame[0]))
            place, rate = q + 0.5 * h * v + 0.125 * h * h * a, v + 0.5 * h * a
            inertia = self.links.inertia(place)
            pushed = self.links.motions(place)[0][:, self.links.number(self.push.link)].T @ self.push.force
            outer = self.push.share(start, start + h) * pushed - self.links.bias(place, rate)
            left = inertia @ a - force - outer
            self.left = float(np.abs(left).max() / max(np.abs(inertia @ a).max(), np.abs(outer).max(), 1e-9))
            self.force = force
            if self.left < 1e-5:
                break
            a = a - np.linalg.solve(inertia + added, left)
            sim.restore(kept)
            self.retries += 1
        else:
            raise AssertionError(f"a force of {self.left:.3g} of the largest is left over")
        self.state, self.more = end, a
        return end


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenJoints(flow.Midline):
    """The midline of a robot about its root, bent as its joints were on a swim, with the mass of the robot's links."""

    weighed: Callable[[float], Mass]
    """Mass of the links at every time, instead of that of the water displaced [s]."""

    def mass(self, time):
        """Mass of the links."""
        return self.weighed(time)


def given_joints(swim, course):
    """The body of a swim whose joints go on a course, a function of time that gives angles and rates [rad, rad/s]."""
    links, chain, density = Links(swim), swim.chain, 1000.0 * swim.depth
    least = swim.water.blunt * swim.run.robot.length / swim.water.cells

    def posture(time):
        return ChainState(*(np.concatenate([np.zeros(3), part]) for part in course(time)))

    def spine(time):
        one = posture(time)
        line = chain.midline(one.position)
        (x, y), (u, v) = line.position, line.jacobian @ one.rate
        bare = flow.MidlineState(
            x=x, y=y, heading=line.heading, half_width=chain.outline.silhouette.half_width, x_rate=u, y_rate=v,
            heading_rate=line.turning @ one.rate,
        )  # fmt: skip
        return bare.thickened(least)

    def mass(time):
        place, rate = posture(time)
        centre, _, own = links.places(place)
        moves, turns = links.motions(place)
        m, moving = links.mass, moves @ rate
        middle, drift = centre @ m / m.sum(), moving @ m / m.sum()
        (x, y), (u, v) = centre - middle[:, None], moving - drift[:, None]
        return Mass(
            volume=float(m.sum()) / density, centre=tuple(middle.tolist()), centre_rate=tuple(drift.tolist()),
            moments=np.array([[float((m * (x * x + y * y) + own).sum()) / density]]),
            swirl=(float((m * (x * v - y * u) + own * (turns @ rate)).sum()) / density,),
        )  # fmt: skip

    return GivenJoints(spine=spine, weighed=mass)


def beside(swim, start, course, force=None):
    """The same water as that of a swim, with a body that the water moves from a place while its joints go a course."""
    setup = swim.sim.setup
    shape = given_joints(swim, course)
    centre = shape.mass(0.0).centre
    body = flow.FreeBody(
        shape=shape, name=setup.bodies[0].name, start=(start[0] + centre[0], start[1] + centre[1]), angle=start[2],
        force=force, density=1000.0,
    )  # fmt: skip
    return flow.Simulation(replace(setup, bodies=(body,)), thread_count=1)
