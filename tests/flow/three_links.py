"""Kanso's swimmer: three ellipses in a row whose joints move as they are told, and which the water alone moves.

Kanso, Marsden, Rowley and Melli-Huber 2005 (J. Nonlinear Sci. 15, 255-289). In potential flow the momentum of bodies
and water stays nothing, so that where a cycle takes them follows from their added mass alone. Sizes and gait are ours.
"""

import numpy as np
from panels import by_panels

from suchus import flow
from suchus.flow.added import generalised_added_mass
from suchus.flow.twist import Twists, join_twists

HALF, REACH = (0.15, 0.03), 0.18
"""Half of an ellipse's length and width, and from its middle to its joints [m]."""
NAMES = "first", "middle", "last"
"""Links, from the front."""
TOLERANCE = 2e-3
"""Force that a step may leave over, over the greatest so far [-]."""
PERIOD = 1.0
"""Of the gait [s]."""
LENGTH = 4 * REACH + 2 * HALF[0]
"""Length of the straight swimmer [m]."""


def gait(amplitude, time):
    """Return the angles of both joints and their rates: a circle, run through once a period, from rest and straight.

    The first link stands at the first angle, and the last at the second, from the middle one.
    """
    turn, rate = 2 * np.pi * time / PERIOD, 2 * np.pi / PERIOD
    share = min(time / PERIOD, 1.0)
    grown, growing = share**2 * (3 - 2 * share), 6 * share * (1 - share) / PERIOD
    c, s = np.cos(turn), np.sin(turn)
    angles = amplitude * grown * np.array([c, s])
    return angles, amplitude * (growing * np.array([c, s]) + grown * rate * np.array([-s, c]))


def links(root, rate, angles, rates):
    """Return middle and angle of each link, and the rates of both, shape (link, 3); the middle one is ``root``."""
    turn = root[2] + np.array([angles[0], 0.0, angles[1]])
    spin = rate[2] + np.array([rates[0], 0.0, rates[1]])
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    moved = spin[:, None] * np.stack([-way[:, 1], way[:, 0]], axis=1)
    sides = np.array([-1.0, 0.0, 1.0])[:, None] * REACH
    places = root[:2] + sides * (way + way[1])
    moving = rate[:2] + sides * (moved + moved[1])
    return np.column_stack([places, turn]), np.column_stack([moving, spin])


def inertia():
    """Return mass and moment of one ellipse over the density of the water, which is its own [m2, m4]."""
    a, b = HALF
    return np.pi * a * b, np.pi * a * b * (a * a + b * b) / 4


def in_potential_flow(amplitude, first=0, points=40, count=240):
    """Return where a cycle takes the middle link: along, across, and the turn, from a panel method.

    Args:
        amplitude: of the gait [rad].
        first: which cycle, 0 the one in which the gait grows.
        points: steps of a cycle.
        count: panels a link.
    """
    mass, moment = inertia()
    own = np.diag([mass, mass, moment] * 3)

    def rate(time):
        angles, rates = gait(amplitude, time + first * PERIOD)
        places, _ = links(np.zeros(3), np.zeros(3), angles, rates)
        modes = np.array([links(np.zeros(3), unit, angles, 0 * rates)[1].ravel() for unit in np.eye(3)])
        bent = links(np.zeros(3), np.zeros(3), angles, rates)[1].ravel()
        whole = own + by_panels(places, *HALF, count=count)
        return -np.linalg.solve(modes @ whole @ modes.T, modes @ whole @ bent)

    def seen(root, body):
        c, s = np.cos(root[2]), np.sin(root[2])
        return np.array([c * body[0] - s * body[1], s * body[0] + c * body[1], body[2]])

    root, h = np.zeros(3), PERIOD / points
    known = [rate(0.5 * k * h) for k in range(2 * points + 1)]
    for k in range(points):
        first, middle, last = known[2 * k], known[2 * k + 1], known[2 * k + 2]
        k1 = seen(root, first)
        k2 = seen(root + 0.5 * h * k1, middle)
        k3 = seen(root + 0.5 * h * k2, middle)
        root = root + h / 6 * (k1 + 2 * k2 + 2 * k3 + seen(root + h * k3, last))
    return root


class LinkedSwimmer:
    """The three links in water, step by step: Newton's law for the middle link's place, as ``coupling.Swim`` has it."""

    def __init__(self, amplitude, reynolds, cells, box=((-1.1, 1.1), (-0.7, 0.7))):
        self.amplitude, self.time = amplitude, 0.0
        self.root, self.rate, self.push, self.told = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
        self.force, self.greatest, self.steps, self.left = np.zeros(3), 0.0, 0, []
        shape = flow.Ellipse(length=2 * HALF[0], width=2 * HALF[1])
        bodies = tuple(flow.Body(shape=shape, motion=self._motion(k), name=NAMES[k]) for k in range(3))
        self.sim = flow.Simulation(
            flow.Setup(
                grid=flow.Grid.covering(*box, cell=LENGTH / cells), viscosity=LENGTH**2 / (PERIOD * reynolds),
                bodies=bodies, coarse=True,
            ),
            thread_count=1,
        )  # fmt: skip

    def _motion(self, k):
        def pose(time):
            place, moving = (each[k] for each in links(*self._at(time), *gait(self.amplitude, time)))
            return flow.Pose(
                position=tuple(place[:2]), angle=place[2], velocity=tuple(moving[:2]), spin=moving[2]
            )  # fmt: skip

        return pose

    def _at(self, time):
        s = time - self.time
        return self.root + s * self.rate + 0.5 * s * s * self.push, self.rate + s * self.push

    def _about(self, time, acts):
        """Return a force and its moment about the world's origin as those about the middle link."""
        x, y = self._at(time)[0][:2]
        return np.array([acts[0], acts[1], acts[2] - (x * acts[1] - y * acts[0])])

    def _momentum(self, time):
        """Return momentum of the links and that about the world's origin, over the density."""
        places, moving = links(*self._at(time), *gait(self.amplitude, time))
        mass, moment = inertia()
        turning = places[:, 0] * moving[:, 1] - places[:, 1] * moving[:, 0]
        return np.array([*mass * moving[:, :2].sum(axis=0), (mass * turning + moment * moving[:, 2]).sum()])

    def _rigid(self, time):
        """Return how all links move for unit rates of the middle one, (coordinate, link, 3), and where they are."""
        root, angles = self._at(time)[0], gait(self.amplitude, time)[0]
        each = [links(root, unit, angles, np.zeros(2)) for unit in np.eye(3)]
        return np.array([moving for _, moving in each]), each[0][0]

    def step(self, longest):
        """Take one step."""
        sim, start = self.sim, self.time
        h = min(sim.next_step(), longest, PERIOD / 150)
        end, before = start + h, self._momentum(start)
        modes, places = self._rigid(start)
        if self.steps < 2 or self.steps % 8 == 0:
            twists = [_twists(places, mode) for mode in modes]
            outlines = [body.shape.markers(start, body.pose(start), sim.setup.grid.cell) for body in sim.setup.bodies]
            self.added = generalised_added_mass(sim.water, outlines, [join_twists(each) for each in twists], 1.0).matrix
        mass, moment = inertia()
        whole = np.einsum("ikc,jkc,c->ij", modes, modes, np.array([mass, mass, moment])) + self.added
        for _ in range(3):  # the step's end moves a little with what it is told
            told = self.force - self.added @ (self.push - self.told)
            missing = self._about(end, before - self._momentum(end)) / h + told
            self.push = self.push + np.linalg.solve(whole, missing)
        sim.advance(h)
        for made in range(6):
            acts = np.zeros(3)
            for name in NAMES:
                load = sim.last_loads(name)
                (x, y), (fx, fy) = load.reference_point, load.total.force
                acts += [fx, fy, float(load.total.torque) + x * fy - y * fx]
            found = self._about(end, acts)
            missing = self._about(end, before - self._momentum(end)) / h + found
            size, full = (float(np.sqrt((part**2 / np.diag(whole)).sum())) for part in (missing, found))
            self.greatest = max(self.greatest, full)
            if size <= TOLERANCE * self.greatest or made == 5:
                break
            more = np.linalg.solve(whole, missing)
            self.push = self.push + more
            modes, places = self._rigid(end)
            moved = _twists(places, h * np.tensordot(more, modes, 1))
            sim.accelerate(dict(zip(NAMES, moved, strict=True)))
        self.left.append(size / max(self.greatest, 1e-300))
        self.root, self.rate = self._at(end)
        self.force, self.told, self.time, self.steps = found, self.push.copy(), end, self.steps + 1

    def run(self, until):
        """Go on until a time [s]; return the times and places of the middle link after every step."""
        rows = [[self.time, *self.root]]
        while self.time < until * (1 - 1e-9):
            self.step(until - self.time)
            rows.append([self.time, *self.root])
        return np.array(rows)


def _twists(places, moving):
    return [
        Twists(reference_points=place[None, :2], linear=move[None, :2], angular=move[None, 2:])
        for place, move in zip(places, moving, strict=True)
    ]
