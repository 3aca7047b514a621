"""Steps that are taken again, and bodies that are accelerated after a step, with the water that follows them."""

from dataclasses import replace

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.flow.added import added_mass, generalised_added_mass
from suchus.flow.twist import Twists, held_faces

H = 0.01
"""Length of a step [s]."""
ELLIPSE = flow.Ellipse(length=1.0, width=0.4)
BOX = flow.Sides(left=flow.Slip(), right=flow.Slip(), bottom=flow.Slip(), top=flow.Slip())


class Told:
    """A motion from the start of a step to an end that can be told anew."""

    def __init__(self):
        self.time, self.place, self.rate = 0.0, np.array([0.0, 0.0, 0.3]), np.array([0.4, 0.2, 0.5])
        self.push = np.array([0.3, -2.0, 4.0])

    def __call__(self, time):
        s = time - self.time
        place, rate = self.place + s * self.rate + 0.5 * s * s * self.push, self.rate + s * self.push
        return flow.Pose(position=tuple(place[:2]), angle=place[2], velocity=tuple(rate[:2]), spin=rate[2])

    def step(self, sim):
        sim.advance(H)
        end = self(sim.time)
        self.time, self.place = sim.time, np.array([*end.position, end.angle])
        self.rate = np.array([*end.velocity, end.spin])


def ellipse(told, *, sides=None):
    grid = flow.Grid.covering((-1.0, 1.0), (-1.0, 1.0), cell=1 / 24)
    return flow.Simulation(
        flow.Setup(grid=grid, viscosity=2e-3, bodies=(flow.Body(shape=ELLIPSE, motion=told),), coarse=True,
                   sides=sides or BOX, tolerance=1e-6)
    )  # fmt: skip


def twist(pose, linear, spin):
    return Twists(reference_points=np.array([pose.position]), linear=np.array([linear]), angular=np.array([[spin]]))


def wrench(sim):
    load = sim.last_loads("body").total
    return np.concatenate([load.force, load.moment])


def test_a_step_that_is_taken_again_has_the_same_bytes():
    spine = flow.foil(0.8, thickness=0.4).spine(0.0)
    swing = flow.Oscillation(frequency=1.0, centre=(0.9, 0.0), heave=(0.0, 0.1))
    bodies = (
        flow.FreeBody(shape=ELLIPSE, start=(0.0, 0.5), velocity=(0.5, 0.0), name="free"),
        flow.Body(shape=flow.Midline(spine=lambda _: spine, deforms=False), motion=swing, name="foil"),
    )
    grid = flow.Grid.covering((-1.0, 2.6), (-0.9, 1.4), cell=1 / 16)
    setup = flow.Setup(grid=grid, viscosity=0.01, bodies=bodies, stream=(0.3, 0.0), follow="free", coarse=True)
    sim = flow.Simulation(setup)
    for _ in range(3):
        sim.advance(H)
    kept, seen = sim.snapshot(), []
    for _ in range(3):
        for step in (H, 0.7 * H):
            sim.advance(step)
        seen.append([sim.record.bodies.tobytes(), sim.water.velocity.tobytes(), sim.water.p.tobytes(), sim.time])
        sim.restore(kept)
    assert seen[0] == seen[1] == seen[2]
    assert len(sim.record.time) == 3
    assert sim.snapshot().arrays["velocity"].tobytes() == kept.arrays["velocity"].tobytes()


@pytest.mark.parametrize("change", [(0.02, 0.0, 0.0), (0.0, 0.015, 0.0), (0.0, 0.0, 0.05), (0.01, -0.01, 0.04)])
def test_accelerated_after_a_step_is_a_step_to_another_velocity(change):
    told = Told()
    sim = ellipse(told)
    for _ in range(3):
        told.step(sim)
    kept, other = sim.snapshot(), np.array(change)
    sim.advance(H)
    first, before = wrench(sim), sim.water.velocity.copy()
    pose = sim.pose("body")
    sim.accelerate({"body": twist(pose, change[:2], change[2])})
    ours, field = wrench(sim), sim.water.velocity.copy()
    power = sim.last_loads("body").total.power
    sim.restore(kept)
    told.push = told.push + other / H
    sim.advance(H)
    exact = wrench(sim)
    size = np.linalg.norm(exact - first)
    assert np.linalg.norm(ours - exact) < 0.05 * size  # 0.7 % along, 0.06 % aside, 4 % of the little that turns
    assert np.abs(field - sim.water.velocity).max() < 0.15 * np.abs(before - sim.water.velocity).max()
    assert power == pytest.approx(sim.last_loads("body").total.power, rel=0.03)


def test_the_power_of_an_accelerated_step_is_force_times_velocity():
    told = Told()
    sim = ellipse(told)
    for _ in range(3):
        start = told.rate.copy()
        told.step(sim)
    change = np.array([0.05, -0.08, 0.2])
    before = sim.last_loads("body").total.power
    sim.accelerate({"body": twist(sim.pose("body"), tuple(change[:2]), change[2])})
    load = sim.last_loads("body").total
    mean = 0.5 * (start + told.rate + change)
    assert load.power == pytest.approx(-np.dot([*load.force, *load.moment], mean), rel=0.02)  # 24 cells a length
    assert abs(load.power - before) > 0.2 * abs(before)
    assert sim.record.column("power")[-1] == pytest.approx(load.power)
    assert len(sim.record.time) == 3
    told.rate = told.rate + change
    told.push = np.zeros(3)
    told.step(sim)
    load = sim.last_loads("body").total
    assert load.power == pytest.approx(-np.dot([*load.force, *load.moment], told.rate), rel=0.02)


def test_the_added_mass_of_rigid_modes_is_that_of_the_body():
    sim = ellipse(Told())
    pose = sim.pose("body")
    markers = ELLIPSE.markers(0.0, pose, sim.setup.grid.cell)
    modes = [twist(pose, linear, spin) for linear, spin in (((1.0, 0.0), 0.0), ((0.0, 1.0), 0.0), ((0.0, 0.0), 1.0))]
    whole = added_mass(sim.water, markers, pose.position, 1.0)
    modal = generalised_added_mass(sim.water, [markers], modes, 1.0).matrix
    assert modal == pytest.approx(0.5 * (whole + whole.T), rel=1e-3, abs=1e-4 * whole.max())  # solved less far
    mixed = [modes[0] * 2.0, replace(modes[1], angular=modes[2].angular)]
    way = np.array([[2.0, 0.0, 0.0], [0.0, 1.0, 1.0]])
    found = generalised_added_mass(sim.water, [markers], mixed, 1.0).matrix
    assert found == pytest.approx(way @ modal @ way.T, rel=1e-3, abs=1e-4)


def test_what_cannot_be_accelerated_is_refused():
    told = Told()
    sim = ellipse(told)
    more = twist(sim.pose("body"), (0.1, 0.0), 0.0)
    with pytest.raises(OutsideLimits, match="before any step was taken; call advance first"):
        sim.accelerate({"body": more})
    with pytest.raises(OutsideLimits, match="before any step was taken; call advance"):
        sim.last_loads("body")
    told.step(sim)
    with pytest.raises(UnknownName, match="nobody"):
        sim.accelerate({"nobody": more})
    double = Twists(reference_points=np.zeros((2, 2)), linear=np.zeros((2, 2)), angular=np.zeros((2, 1)))
    with pytest.raises(InvalidDesign, match="body is given the motions of 2 parts, and it has 1"):
        sim.accelerate({"body": double})


def test_a_slice_is_divided_at_its_cuts():
    s = np.linspace(0.0, 1.0, 65)
    zero, wide = 0 * s, 0.08 * np.sqrt(np.sin(np.pi * np.clip(s, 0.02, 0.98)))
    spine = flow.MidlineState(x=s, y=zero, heading=zero, half_width=wide, x_rate=zero, y_rate=zero, heading_rate=zero)
    swing = flow.Oscillation(frequency=1.0, heave=(0.0, 0.1), pitch=0.2)
    grid = flow.Grid.covering((-0.6, 1.6), (-0.7, 0.7), cell=1 / 32)

    def run(cuts):
        shape = flow.Midline(spine=lambda _: spine, deforms=False, cuts=cuts)
        bodies = (flow.Body(shape=shape, motion=swing, name="foil"),)
        sim = flow.Simulation(flow.Setup(grid=grid, viscosity=2e-3, bodies=bodies, coarse=True))
        return sim, sim.run(0.03, progress=False)

    (_, whole), (sim, cut) = run(()), run((0.3, 0.6))
    assert cut.force() == pytest.approx(whole.force(), rel=1e-9)
    assert cut.part_series("force_y").sum(axis=1) == pytest.approx(whole.force()[:, 1], abs=1e-5)
    assert cut.part_series("power").sum(axis=1) == pytest.approx(whole.column("power"), abs=1e-5)
    assert cut.part_series("torque_behind")[:, 0] == pytest.approx(
        whole.torque()[:, 0], abs=1e-4
    )  # about the same point
    assert np.abs(cut.part_series("force_y")).min(axis=0).min() > 0
    assert sim.last_loads("foil").parts.force.sum(axis=0) == pytest.approx(sim.last_loads("foil").total.force)
    with pytest.raises(InvalidDesign, match="cuts of a midline"):
        flow.Midline(spine=lambda _: spine, cuts=(0.4, 0.2))


def test_the_middle_of_a_thick_slice_belongs_to_its_parts():
    s = np.linspace(0.0, 1.0, 65)
    zero, wide = 0 * s, np.minimum(0.25, np.sqrt(np.maximum(0.25**2 - (0.25 - np.minimum(s, 1 - s)) ** 2, 1e-6)))
    spine = flow.MidlineState(x=s, y=zero, heading=zero, half_width=wide, x_rate=zero, y_rate=zero, heading_rate=zero)
    shape = flow.Midline(spine=lambda _: spine, deforms=False, cuts=(0.3, 0.6))
    grid = flow.Grid.covering((-0.5, 1.5), (-0.7, 0.7), cell=1 / 32)
    body = flow.Body(shape=shape, motion=flow.Pose(), name="foil")
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=2e-3, bodies=(body,), coarse=True))
    for faces in held_faces(sim.water):
        inside = faces.body_fraction > 0.5
        x, row = faces.points[0, inside], faces.row[inside]
        assert x.size > 300
        assert row.tolist() == np.searchsorted([0.3, 0.6], x, side="right").tolist()


@pytest.mark.parametrize("turn", [0.0, np.pi / 2])
def test_what_presses_inside_a_part_is_where_the_part_is(turn):
    """Of a pressure of 1 each part has its area and the place of its middle, wherever its ends cut the cells."""
    s = np.linspace(0.0, 1.0, 65)
    zero, wide = 0 * s, np.full(65, 0.12)
    spine = flow.MidlineState(x=s, y=zero, heading=zero, half_width=wide, x_rate=zero, y_rate=zero, heading_rate=zero)
    cuts = tuple(np.linspace(0.11, 0.89, 10))
    shape = flow.Midline(spine=lambda _: spine, deforms=False, cuts=cuts)
    grid = flow.Grid.covering((-0.5, 1.5), (-0.5, 1.5), cell=1 / 32)
    body = flow.Body(shape=shape, motion=flow.Pose(angle=turn), name="bar")
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=2e-3, bodies=(body,), coarse=True))
    found = sim.water.pressures(np.ones_like(sim.water.p), 1.0)[1:-1]
    h, along = grid.cell, 1 + int(turn > 0)
    middles = found[:, along] / found[:, 0] * h + grid.origin[along - 1]
    ends = np.array(cuts)
    assert middles == pytest.approx(0.5 * (ends[1:] + ends[:-1]), abs=0.15 * h)  # half a cell, where faces decide
    assert found[:, 0].mean() * h * h == pytest.approx(0.24 * float(np.diff(ends).mean()), rel=0.05)
