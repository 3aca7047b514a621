"""Rates that are not those of their positions, and bodies that leap: refused, and what is right is taken."""

from dataclasses import replace

import numpy as np
import pytest
from flow_cases import still_setup

from suchus import flow
from suchus.core.errors import Diverged, InvalidDesign
from suchus.flow.consistency import MAX_POSITION_ERROR, Consistency, MidlineSource, MotionSource
from suchus.flow.swimmer import Swimmer

EEL = flow.eel(1.0, stations=65)
CELL = 1 / 48
GRID = flow.Grid(cells=(96, 64), cell=CELL, origin=(-0.5, -0.65))
OVAL = flow.Ellipse(length=1.0, width=0.5)


def eel(from_time=0.0, **factors):
    """The eel, some of its rates multiplied from a time on."""

    def spine(time):
        state = EEL.spine(time)
        late = {name: factor * getattr(state, name) for name, factor in factors.items()}
        return replace(state, **(late if time >= from_time else {}))

    return flow.Midline(spine=spine)


def swum(body):
    return flow.Simulation(flow.Setup(grid=GRID, viscosity=1e-3, bodies=(body,), coarse=True, step=0.004))


def given(shape):
    return flow.Body(shape=shape, name="eel")


def free(shape):
    return flow.FreeBody(shape=shape, name="eel", start=(0.5, 0.0))


@pytest.mark.parametrize("body", [given, free])
@pytest.mark.parametrize(("factors", "what"), [
    ({"y_rate": 0.0}, "y"), ({"y_rate": 2.0, "heading_rate": 2.0}, "y"), ({"y_rate": 0.88}, "y"),
    ({"y_rate": 1.13}, "y"),
    ({"heading_rate": 0.0}, "heading"), ({"heading_rate": -1.0}, "heading"),
])  # fmt: skip
def test_rates_of_a_midline_that_are_not_those_of_its_places_are_refused(body, factors, what):
    text = rf"t = 0 s the midline of eel gives the {what}_rate .* at station \d+, and its {what} changes by .*; give"
    with pytest.raises(InvalidDesign, match=text) as caught:
        swum(body(eel(**factors)))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("body", [given, free])
@pytest.mark.parametrize("shape", [
    EEL, eel(y_rate=1.08), eel(y_rate=0.93), flow.Midline(spine=lambda t: EEL.spine(t).thickened(1.75 * CELL)),
    flow.foil(1.0, thickness=0.2),
])  # fmt: skip
def test_right_rates_of_a_midline_are_taken(body, shape):
    sim = swum(body(shape))
    for _ in range(3):
        sim.advance()


def test_a_midline_that_contradicts_itself_later_is_refused_then():
    sim = swum(given(eel(from_time=0.01, y_rate=0.5)))
    with pytest.raises(InvalidDesign, match=r"the midline of eel (gives the y_rate|is .* cannot leap)"):
        sim.run(0.2, progress=False)
    assert sim.time > 0.01


def test_a_half_width_that_swells_says_so():
    """A station's width is a coordinate too, and its rate may be left out only where it hardly changes."""

    def spine(time, told):
        state = EEL.spine(0.0)
        rest = dict.fromkeys(("x_rate", "y_rate", "heading_rate"), 0 * state.x)
        wide = state.half_width * (1 + 2 * time)
        return replace(state, half_width=wide, half_width_rate=2 * state.half_width * told, **rest)

    swum(given(flow.Midline(spine=lambda time: spine(time, 1.0))))
    with pytest.raises(InvalidDesign, match=r"gives the half_width_rate 0 m/s .* half_width changes by 0\.0[78]"):
        swum(given(flow.Midline(spine=lambda time: spine(time, 0.0))))


def test_a_trunk_in_space_is_watched_as_a_midline_is():
    right = flow.eel_in_space(1.0, stations=65)

    def spine(time, factor):
        state = right.spine(time)
        return replace(state, y_rate=factor * state.y_rate, x_rate=factor * state.x_rate)

    grid = flow.Grid(cells=(96, 48, 32), cell=1 / 48, origin=(-0.5, -0.5, -0.33))

    def sim(factor):
        shape = replace(right, spine=lambda time: spine(time + 0.5, factor))
        body = flow.Body(shape=shape, name="eel")
        return flow.Simulation(flow.Setup(grid=grid, viscosity=1e-2, bodies=(body,), coarse=True, step=0.01))

    sim(1.0)
    with pytest.raises(InvalidDesign, match="the midline of eel gives the y_rate"):
        sim(0.5)


def test_stations_that_come_and_go_are_refused():
    body = given(flow.Midline(spine=lambda time: flow.eel(1.0, stations=65 if time < 0.01 else 66).spine(time)))
    with pytest.raises(InvalidDesign, match=r"has 65 stations at t = .* and 66 at .*; give as many at every time"):
        swum(body).run(0.05, progress=False)


@pytest.mark.parametrize("name", ["x", "y", "y_rate"])
def test_stations_that_are_no_numbers_are_refused(name):
    state = EEL.spine(0.0)
    with pytest.raises(InvalidDesign, match=f"{name} of the midline is not finite at station 0"):
        replace(state, **{name: getattr(state, name) * np.nan})


@pytest.mark.parametrize(("pose", "part"), [
    (flow.Pose(velocity=(1.0, 0.0)), r"gives the velocity \(1, 0\) m/s, and its position changes by \(0, 0\)"),
    (flow.Pose(spin=1.0), "gives the spin 1 rad/s, and its angle changes by 0 rad/s"),
])  # fmt: skip
def test_a_pose_that_stays_has_no_rates(pose, part):
    with pytest.raises(InvalidDesign, match=part):
        flow.Simulation(still_setup(bodies=(flow.Body(shape=OVAL, motion=pose),)))


def test_a_circle_may_turn_in_its_place():
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(spin=1.0))
    sim = flow.Simulation(still_setup(bodies=(body,), viscosity=0.05))
    sim.advance()
    assert sim.record.column("power")[0] > 0


def test_a_place_that_is_no_number_is_refused():
    body = flow.Body(shape=OVAL, motion=lambda time: flow.Pose(position=(0.0, 0.0 if time < 0.02 else float("nan"))))
    with pytest.raises(InvalidDesign, match=r"position of a pose is \(0.0, nan\); finite numbers are needed"):
        flow.Simulation(still_setup(bodies=(body,), step=0.01)).run(0.1, progress=False)


@pytest.mark.parametrize("motion", [
    lambda t: flow.Pose(position=(0.0, 0.0 if t < 0.1 else 1.0)),  # a diameter in one step
    lambda t: flow.Pose(angle=0.0 if t < 0.1 else 1.5),
    lambda t: flow.Pose(position=(0.01 * np.floor(t / 0.01), 0.0)),  # stairs of a sixth of a cell
])  # fmt: skip
def test_a_body_that_leaps_is_refused(motion):
    sim = flow.Simulation(still_setup(bodies=(flow.Body(shape=OVAL, motion=motion),), viscosity=0.05, step=0.014))
    with pytest.raises(InvalidDesign, match=r"body is .* m away from where its rates have led it .* cannot leap"):
        sim.run(0.3, progress=False)


@pytest.mark.parametrize("shift", [0.95, 1.05])
def test_a_leap_is_a_cell(shift):
    def motion(time):
        return flow.Pose(position=(0.0, 0.0 if time < 0.1 else shift * MAX_POSITION_ERROR * CELL))

    watched = Consistency(MotionSource("body", motion, 0.5), CELL)
    if shift < 1:
        watched.check_step(0.095, 0.01)
        return
    with pytest.raises(InvalidDesign, match="cannot leap"):
        watched.check_step(0.095, 0.01)


@pytest.mark.parametrize("motion", [
    lambda t: flow.Pose(angle=(6 * t + 3 + np.pi) % (2 * np.pi) - np.pi, spin=6.0),  # whole turns move nothing
    lambda t: flow.Pose(position=(2 * max(t - 0.105, 0.0), 0.0), velocity=(2.0 * (t > 0.105), 0.0)),  # starts at once
    lambda t: flow.Pose(position=(abs((t / 0.1) % 2 - 1) * 0.1, 0.0), velocity=(1 if (t / 0.1) % 2 > 1 else -1, 0.0)),
    flow.Oscillation(frequency=4.0, heave=(0.3, 0.0), pitch=0.4),
])  # fmt: skip
def test_what_turns_starts_at_once_and_returns_does_not_leap(motion):
    watched = Consistency(MotionSource("body", motion, 0.5), 1 / 16)
    for k in range(400):
        watched.check_step(0.0137 * k, 0.0137)


def test_a_midline_may_count_its_heading_anew():
    """Whole turns of the heading move nothing either."""

    def spine(time):
        state = EEL.spine(time)
        return replace(state, heading=state.heading + 2 * np.pi * (time > 0.03))

    watched = Consistency(MidlineSource("eel", spine), CELL)
    for k in range(20):
        watched.check_step(0.004 * k, 0.004)


def test_an_added_mass_that_is_no_number_is_refused():
    swimmer = Swimmer.from_body(flow.FreeBody(shape=OVAL, name="oval", free=(True, True, False)))
    mass = np.diag([1.0, 2.0, np.nan])
    swimmer.set_added_mass(mass, 0.0)
    assert swimmer.added_mass.tolist() == np.diag([1.0, 2.0, 0.0]).tolist()
    mass[0, 1] = np.nan
    with pytest.raises(Diverged, match=r"t = 0.3 s the added mass of oval is nan in a degree of freedom"):
        swimmer.set_added_mass(mass, 0.3)


def test_a_body_that_begins_at_rest_in_thin_water_begins_with_a_step_in_which_it_goes_a_cell_at_most():
    """Water at rest of small viscosity allows steps of a minute; the body swings ten times in that."""

    def motion(t):
        rise = 1 - np.exp(-t)
        return flow.Pose(
            position=(0.0, 0.2 * rise * np.sin(t) ** 2),
            velocity=(0.0, 0.2 * (np.exp(-t) * np.sin(t) ** 2 + rise * np.sin(2 * t))),
        )

    grid, viscosity = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=CELL), 1e-6
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=viscosity, bodies=(body,), coarse=True))
    assert CELL / (4 * viscosity / CELL) > 60.0
    first = sim.next_step()
    assert 0.1 * CELL < motion(first).position[1] < CELL
    sim.run(first)
    assert sim.last_loads("body").total.force[1] < 0.0
