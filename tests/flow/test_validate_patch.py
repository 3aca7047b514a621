"""A patch of fine cells in coarser ones beside fine cells everywhere: 0.3 % is asked for drag, lift and speed."""

from math import radians

import flow_cases as cases
import numpy as np
import pytest
from validation_rows import note

from suchus import flow
from suchus.flow import signals

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

ASKED = 3e-3


def test_the_wake_of_a_cylinder_is_that_of_fine_cells():
    def start(x, y):
        return 1.0 + 0.0 * x, 0.3 * np.exp(-((x - 1.0) ** 2 + y**2))

    whole = flow.Grid.covering((-5.0, 11.0), (-4.0, 4.0), cell=1 / 12)
    cylinder = flow.Body(shape=flow.Cylinder(diameter=1.0))
    setup = flow.Setup(grid=whole, viscosity=0.01, stream=(1.0, 0.0), bodies=(cylinder,), start=start, coarse=True)
    records = cases.in_patch(setup, whole, (-1.5, 6.0), (-2.0, 2.0), until=50.0, ratio=2)
    found = []
    for record in records:
        force = 2 * record.force()
        late = signals.last_periods(record.time, force[:, 1], 4)
        drag, lift, weight = force[late, 0], force[late, 1], record.step[late]
        swing = np.sqrt(np.average((lift - np.average(lift, weights=weight)) ** 2, weights=weight))
        span = record.time[late][-1] - record.time[late][0]
        found.append({"mean drag": np.average(drag, weights=weight), "rms lift": swing, "Strouhal number": 4 / span})
    where = ("24 cells/D, 12 around", "16 D x 8 D", "fine cells everywhere")
    off = {
        name: note("patch: cylinder, Re 100", name, found[1][name], float(found[0][name]), *where) for name in found[0]
    }
    assert max(off.values()) < ASKED


@pytest.mark.parametrize("ratio", [2, 4])
def test_an_oscillating_cylinder_feels_what_it_feels_on_fine_cells(ratio):
    whole = flow.Grid.covering((-6.0, 6.0), (-4.0, 4.0), cell=ratio / 32)
    swings = flow.Oscillation(heave=(0.8, 0.0), frequency=0.2)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=swings)
    setup = flow.Setup(grid=whole, viscosity=0.01, bodies=(body,), coarse=True)
    fine, patch = cases.in_patch(setup, whole, (-2.2, 2.2), (-1.4, 1.4), until=5.0, ratio=ratio)
    late = fine.time > 0.2
    force = fine.force()[late, 0]
    other = np.interp(fine.time[late], patch.time, patch.force()[:, 0])
    off = float(np.sqrt(np.mean((other - force) ** 2) / np.mean(force**2)))
    note(f"patch: oscillating cylinder, {ratio} to 1", "rms difference of the force over its rms", off, "at most 0.003",
         f"32 cells/D, {32 // ratio} around", "12 D x 8 D", "fine cells everywhere")  # fmt: skip
    assert off < ASKED


def test_an_aerofoil_has_the_drag_and_lift_of_fine_cells():
    whole = flow.Grid.covering((-1.7, 4.0), (-1.4, 1.4), cell=1 / 32)
    aerofoil = flow.Body(shape=flow.foil(1.0, thickness=0.12), motion=flow.Pose(angle=radians(-10)))
    setup = flow.Setup(grid=whole, viscosity=1e-3, stream=(1.0, 0.0), bodies=(aerofoil,), coarse=True)
    records = cases.in_patch(setup, whole, (-0.5, 2.0), (-0.6, 0.5), until=4.0, ratio=4)
    for axis, name in enumerate(("drag", "lift")):
        fine, patch = (
            np.average(2 * r.select_after(3.0).force()[:, axis], weights=r.select_after(3.0).step) for r in records
        )
        where = "128 cells/L, 32 around", "5.7 L x 2.8 L", "fine cells everywhere"
        off = note("patch: aerofoil at 10 degrees, Re 1000", f"mean {name}", patch, float(fine), *where)
        assert off < ASKED


@pytest.mark.parametrize("behind", [0.7, 1.6])
def test_an_eel_swims_as_fast_as_in_fine_cells(behind):
    whole = flow.Grid.covering((-2.5, 4.5), (-1.75, 1.75), cell=1 / 48)
    eel = flow.FreeBody(shape=flow.eel(1.0), name="eel")
    setup = flow.Setup(grid=whole, viscosity=0.785 / 5609, bodies=(eel,), follow="eel", coarse=True)
    fine, patch = cases.in_patch(setup, whole, (-0.7, 1.0 + behind), (-0.7, 0.7), until=4.0, ratio=2)
    speeds = [
        -np.average(r.select_after(3.0).column("velocity_x"), weights=r.select_after(3.0).step) for r in (fine, patch)
    ]
    off = note(
        "patch: free eel",
        f"speed in the fourth cycle, {behind:g} L of the wake in the patch [L/T]",
        speeds[1],
        float(speeds[0]),
        "96 cells/L, 48 around",
        "7 L x 3.5 L",
        "fine cells everywhere",
    )
    assert off < ASKED


def test_a_sphere_has_the_drag_of_fine_cells():
    sides = flow.Sides(bottom=flow.Mirror(), low=flow.Mirror())
    whole = flow.Grid.covering((-2.5, 4.0), (0.0, 2.5), (0.0, 2.5), cell=1 / 8, sides=sides)
    sphere = flow.Body(shape=flow.Sphere(diameter=1.0))
    setup = flow.Setup(
        grid=whole, viscosity=0.01, stream=(1.0, 0.0, 0.0), bodies=(sphere,), sides=sides, coarse=True
    )  # fmt: skip
    fine, patch = cases.in_patch(setup, whole, (-1.25, 2.0), (0.0, 1.25), z=(0.0, 1.25), until=3.0, ratio=2)
    drag = [
        np.average(8 / np.pi * r.select_after(2.0).force()[:, 0], weights=r.select_after(2.0).step)
        for r in (fine, patch)
    ]
    off = note(
        "patch: sphere, Re 100",
        "drag at 2 to 3 D of travel",
        drag[1],
        float(drag[0]),
        "16 cells/D, 8 around",
        "a quarter of 6.5 D x 5 D x 5 D",
        "fine cells everywhere",
    )
    assert off < ASKED
