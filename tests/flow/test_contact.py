"""The short-range force between bodies that nearly touch."""

import numpy as np
import pytest
from flow_cases import still_setup
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow import contact
from suchus.flow.swimmer import Swimmer

LAW = flow.BodyContact(gap=0.1, pressure=50.0)
ROUND, LONG = flow.Cylinder(diameter=1.0), flow.Ellipse(length=1.4, width=0.6)


def found(poses, shapes=(ROUND, ROUND), law=LAW, spacing=0.02):
    outlines = [s.markers(0.0, p, spacing) for s, p in zip(shapes, poses, strict=True)]
    return contact.forces(law, outlines, [np.array(p.position) for p in poses])


@settings(max_examples=30)
@given(st.floats(0, 6.3), st.floats(0, 6.3), st.floats(-0.05, 0.09))
def test_both_are_pushed_alike_and_apart(where, angle, space):
    direction = np.array([np.cos(where), np.sin(where)])
    poses = (flow.Pose(angle=angle), flow.Pose(position=tuple((1.0 + space) * direction)))
    one, other = found(poses)
    assert one[:2] == pytest.approx(-other[:2], abs=1e-9)
    assert other[:2] @ direction == pytest.approx(np.hypot(*other[:2]), rel=0.01)
    assert abs(other[2]) < 0.05 * np.hypot(*other[:2])


@settings(max_examples=30)
@given(st.floats(0, 6.3), st.floats(0, 6.3))
def test_angular_momentum_is_kept(one, other):
    poses = (flow.Pose(angle=one), flow.Pose(position=(0.9, 0.2), angle=other))
    (fx, fy, torque), (gx, gy, back) = found(poses, (LONG, LONG))
    assert (fx + gx, fy + gy) == pytest.approx((0, 0), abs=1e-9)
    assert torque + back + 0.9 * gy - 0.2 * gx == pytest.approx(0, abs=1e-9)


def test_nothing_acts_beyond_the_gap_and_the_least_within():
    assert (found((flow.Pose(), flow.Pose(position=(1.11, 0.0)))) == 0).all()
    assert found((flow.Pose(), flow.Pose(position=(1.05, 0.0))))[1, 0] > 0


def test_long_plates_side_by_side_feel_the_pressure_that_is_asked_for():
    plate = flow.Plate(length=4.0, thick=0.4)
    push = found((flow.Pose(), flow.Pose(position=(0.0, 0.45))), (plate, plate))[1, 1]
    assert push == pytest.approx(50.0 * 0.25 * 3.6, rel=0.06)


def test_bodies_that_meet_leave_with_the_speed_they_came_with():
    """In a vacuum. The law has a potential but for the width of the outline's edges."""
    bodies = [
        flow.FreeBody(shape=ROUND, start=(x, 0.0), velocity=(u, 0.0), density=2.0) for x, u in ((0.0, 1.0), (1.3, -0.5))
    ]
    swimmers, dt = [Swimmer.from_body(b) for b in bodies], 2e-3
    for swimmer in swimmers:
        swimmer.advance(0.0, dt, 1.0)
    least = np.inf
    for _ in range(400):
        ahead = [flow.Pose(position=tuple(s.coordinates[:2] + 0.5 * dt * s.rate[:2])) for s in swimmers]
        for swimmer, force in zip(swimmers, found(ahead), strict=True):
            swimmer.advance(0.0, dt, 1.0, force)
        least = min(least, swimmers[1].coordinates[0] - swimmers[0].coordinates[0])
    assert 0.9 < least < 1.09
    speeds = [s.rate[0] for s in swimmers]
    assert speeds[0] + speeds[1] == pytest.approx(0.5, abs=1e-9)
    assert speeds[1] - speeds[0] == pytest.approx(1.5, rel=0.02)


def pressed_together(law):
    """Least distance of two cylinders of diameter 0.6 that are pushed towards each other [m]."""
    bodies = tuple(
        flow.FreeBody(shape=flow.Cylinder(diameter=0.6), start=(-0.45 * side, 0.0), density=2.0, name=f"to {side}",
                      free=(True, False, False), force=lambda time, state, side=side: (2.0 * side, 0.0, 0.0))
        for side in (1, -1)
    )  # fmt: skip
    sim = flow.Simulation(still_setup(bodies=bodies, viscosity=0.05, contact=law))
    record = sim.run(0.7, progress=False)
    return float((record.column("x", 1) - record.column("x", 0)).min())


def test_two_bodies_in_the_water_do_not_run_through_each_other():
    assert pressed_together(flow.BodyContact(gap=0.15, pressure=120.0)) > 0.6
    assert pressed_together(None) < 0.5


@pytest.mark.parametrize("values", [{"gap": 0.0, "pressure": 1.0}, {"gap": 1.0, "pressure": float("nan")}])
def test_a_contact_that_cannot_be_is_refused(values):
    with pytest.raises(InvalidDesign, match=r"the contact's .*; a positive number is needed"):
        flow.BodyContact(**values)
