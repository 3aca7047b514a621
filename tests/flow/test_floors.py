"""Bodies near walls: added mass, and the flow of a body and its mirror image."""

import numpy as np
import pytest

from suchus import flow
from suchus.flow.sides import NAMES

CIRCLE = flow.Cylinder(diameter=1.0)


# --- water between a body and a wall ---------------------------------------------------------------------------


def images(height, radius=0.5):
    """Added mass of a circle beside a wall over that of its water: the series of image doublets."""
    place, strength, total = 0.0, 1.0, 1.0
    for _ in range(4000):
        distance = 2 * height - place
        place, strength = radius**2 / distance, strength * (radius / distance) ** 2
        total += 2 * strength
    return total


def test_the_series_of_images_is_that_of_a_circle_that_touches_the_wall():
    assert images(0.5) == pytest.approx(np.pi**2 / 3 - 1, rel=1e-3)


@pytest.mark.parametrize("side", ["bottom", "top", "left", "right"])
@pytest.mark.parametrize("gap", [4.0, 2.0])
def test_added_mass_beside_a_wall_is_that_of_the_images(side, gap):
    """On 16 cells a diameter, the gap in cells; the other sides are 4 diameters away."""
    cell, inward = 1 / 16, 1 if side in ("bottom", "left") else -1
    axis = 0 if side in ("left", "right") else 1
    ends = [(-4.0, 4.0), (-4.0, 4.0)]
    ends[axis] = (0.0, 6.0) if inward > 0 else (-6.0, 0.0)
    sides = flow.Sides(**{side: flow.Slip()})
    grid = flow.Grid.covering(*ends, cell=cell, sides=sides)
    position = [0.0, 0.0]
    position[axis] = inward * (0.5 + gap * cell)
    body = flow.Body(shape=CIRCLE, motion=flow.Pose(position=tuple(position)))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-9, bodies=(body,), sides=sides, coarse=True))
    outline = CIRCLE.markers(0.0, body.motion, cell)
    mass = flow.added_mass(sim.water, outline, tuple(position), 1.0) / (np.pi / 4)
    exact = images(0.5 + gap * cell)
    assert np.diag(mass)[:2] == pytest.approx(exact, rel=0.03)
    assert abs(mass[0, 1]) < 1e-3


@pytest.mark.parametrize("gap", [3.0, 1.0])
def test_beside_a_wall_without_friction_there_is_the_flow_of_two_bodies(gap):
    """A body whose mirror image is a second body, in the plane: the half has the forces of the whole."""
    cell, end = 1 / 12, 2.5

    def moving(sense):
        def pose(time):
            swing, rate = 0.05 * np.sin(3 * time), 0.15 * np.cos(3 * time)
            height = 0.5 + gap * cell + 0.05
            return flow.Pose(
                position=(0.3 * time, sense * (height + swing)), velocity=(0.3, sense * rate), angle=sense * 0.4 * time,
                spin=sense * 0.4,
            )  # fmt: skip

        return pose

    shape = flow.Cylinder(diameter=1.0)
    open_sides = flow.Sides(**dict.fromkeys(NAMES, flow.Stream(unbounded=False)))
    half_sides = flow.Sides(**{**dict.fromkeys(NAMES, flow.Stream(unbounded=False)), "bottom": flow.Slip()})
    records = []
    for sides, low, senses in ((half_sides, 0.0, (1,)), (open_sides, -end, (1, -1))):
        grid = flow.Grid(cells=(48, round((end - low) / cell) // 2 * 2), cell=cell, origin=(-2.0, low))
        bodies = tuple(flow.Body(shape=shape, motion=moving(s), name=f"{s}") for s in senses)
        setup = flow.Setup(
            grid=grid, viscosity=0.01, bodies=bodies, sides=sides, coarse=True, step=0.05, tolerance=1e-6
        )  # fmt: skip
        records.append(flow.Simulation(setup).run(0.5, progress=False))
    half, whole = records
    for column in ("force_x", "force_y", "torque"):
        values = whole.column(column, "1")
        assert half.column(column, "1") == pytest.approx(values, abs=3e-3 * np.abs(values).max() + 1e-6), column
