"""A patch of fine cells nested in coarser ones: what the whole fine grid gives, and nothing lost in between."""

from dataclasses import replace

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow import nest
from suchus.flow.compiled import PAD

WHOLE = flow.Grid.covering((-3.0, 5.0), (-2.0, 2.0), cell=1 / 8)
PATCH = WHOLE.patch((-1.5, 2.0), (-1.5, 1.5), ratio=2)
CYLINDER = flow.Body(shape=flow.Cylinder(diameter=1.0))
STREAM = flow.Setup(
    grid=PATCH, coarse_grid=WHOLE, viscosity=0.01, stream=(1.0, 0.0), bodies=(CYLINDER,), coarse=True, step=0.02
)
"""A cylinder in a stream at a Reynolds number of 100, 16 fine cells across."""


def uniform(setup: flow.Setup) -> flow.Setup:
    """Return the same flow on fine cells everywhere."""
    around = setup.coarse_grid
    ratio = round(around.cell / setup.grid.cell)
    cells = tuple(ratio * n for n in around.cells)
    return replace(setup, grid=flow.Grid(cells=cells, cell=setup.grid.cell, origin=around.origin), coarse_grid=None)


def ran(setup: flow.Setup, until: float) -> flow.Simulation:
    """Return a simulation that has come to a time [s]."""
    sim = flow.Simulation(setup)
    sim.run(until, progress=False)
    return sim


def divergence(water) -> np.ndarray:
    """Return what leaves each cell of the domain [m/s]."""
    cells = (slice(PAD, -PAD),) * water.ndim
    total = np.zeros(tuple(reversed(water.grid.cells)))
    for d, part in enumerate(water.velocity):
        at = water.ndim - 1 - d
        behind = tuple(slice(PAD + 1, 1 - PAD) if n == at else slice(PAD, -PAD) for n in range(water.ndim))
        total += part[behind].astype(float) - part[cells]
    return total


def place(sim: flow.Simulation) -> tuple[slice, slice]:
    """Return where the patch lies among the cells of the coarse water."""
    grid, around = sim.setup.grid, sim.setup.coarse_grid
    ratio = round(around.cell / grid.cell)
    first = [round((a - b) / around.cell) for a, b in zip(grid.origin, around.origin, strict=True)]
    return tuple(slice(a, a + n // ratio) for a, n in zip(first[::-1], grid.cells[::-1], strict=True))


@pytest.fixture(scope="module")
def nested() -> flow.Simulation:
    return ran(STREAM, 1.0)


@pytest.fixture(scope="module")
def fine() -> flow.Simulation:
    return ran(uniform(STREAM), 1.0)


def test_its_force_is_that_of_fine_cells_everywhere(nested, fine):
    a, b = nested.record.force()[:, 0], fine.record.force()[:, 0]
    assert a[0] == pytest.approx(b[0], rel=3e-3)  # the impulse of the start
    assert np.sqrt(np.mean((a[10:] / b[10:] - 1) ** 2)) < 2e-3
    assert a[10:] == pytest.approx(b[10:], rel=5e-3)
    coarse = ran(replace(STREAM, grid=WHOLE, coarse_grid=None), 0.3).record.force()[10:, 0]
    assert np.abs(coarse / b[10 : len(coarse) + 10] - 1).min() > 0.01  # what coarse cells alone give would be noticed


def roughness(least: int | None) -> float:
    """Return the largest change of slope of the drag of a started cylinder from step to step over four of its mean."""
    whole = flow.Grid.covering((-2.5, 3.5), (-2.0, 2.0), cell=1 / 48)
    patch = whole.patch((-0.8, 2.0), (-0.85, 0.85), ratio=2)
    sim = flow.Simulation(replace(STREAM, grid=patch, coarse_grid=whole, viscosity=1e-3, step=None))
    if least is not None:
        sim.water.coarse.min_cycles = least
    for _ in range(60):
        sim.advance()
    drag = sim.record.force()[30:, 0]
    return float(np.abs(np.diff(drag, 2)).max() / (4 * drag.mean()))


def test_the_force_is_smooth_on_a_long_patch():
    """136 coarse cells long: with one cycle a stage errors at its sides grow from step to step."""
    assert roughness(None) < 0.002
    assert roughness(1) > 0.006


@pytest.mark.parametrize(("longest", "cycles"), [(4, 1), (31, 1), (32, 2), (628, 2), (629, 3)])
def test_a_longer_patch_takes_more_cycles(longest, cycles):
    assert nest.min_pressure_cycles(longest) == cycles


@pytest.mark.parametrize("ratio", [2, 4, 8])
def test_water_at_the_speed_of_the_stream_stays_so(ratio):
    whole = flow.Grid.covering((0.0, 4.0), (0.0, 4.0), cell=1 / 8)
    setup = flow.Setup(
        grid=whole.patch((1.0, 3.0), (1.0, 3.0), ratio=ratio), coarse_grid=whole, viscosity=0.01, stream=(0.7, -0.4)
    )
    sim = ran(setup, 0.2)
    for speed, *parts in zip((0.7, -0.4), sim.velocity, sim.domain.velocity, strict=True):
        for part in parts:
            assert part == pytest.approx(np.full(part.shape, speed), abs=2e-6)


def test_a_coarse_face_passes_what_its_fine_faces_pass_and_no_cell_keeps_water(nested):
    water, coarse, where = nested.water, nested.water.layers[-1], place(nested)
    rows, columns = (slice(s.start + PAD, s.stop + PAD) for s in where)
    for k, column in enumerate((columns.start, columns.stop)):
        fine = water.velocity[0][PAD:-PAD, PAD + k * water.grid.cells[0]].reshape(-1, 2).mean(axis=1)
        assert coarse.velocity[0][rows, column] == pytest.approx(fine, abs=1e-6)
    for k, row in enumerate((rows.start, rows.stop)):
        fine = water.velocity[1][PAD + k * water.grid.cells[1], PAD:-PAD].reshape(-1, 2).mean(axis=1)
        assert coarse.velocity[1][row, columns] == pytest.approx(fine, abs=1e-6)
    assert np.abs(divergence(water)).max() < 2e-4
    assert np.abs(divergence(coarse)).max() < 2e-4
    inside = water.velocity[0][PAD:-PAD, PAD + 2 : PAD + water.grid.cells[0] : 2]
    means = inside.reshape(inside.shape[0] // 2, 2, -1).mean(axis=1)
    assert coarse.velocity[0][rows, columns.start + 1 : columns.stop] == pytest.approx(means, abs=1e-6)


def test_the_force_is_what_leaves_the_water_of_the_whole_domain(nested):
    """What a box all around the patch loses of momentum is the body's force: little is lost at the patch's sides."""
    sim = ran(STREAM, 0.5)
    coarse = sim.water.layers[-1]
    box = flow.force.ControlVolume((PAD + 2, coarse.grid.cells[1] + PAD - 2, PAD + 2, coarse.grid.cells[0] + PAD - 2))
    forces, steps = [], 20
    box.force(coarse, 0.02, (0.0, 0.0), 1.0)
    for _ in range(steps):
        sim.advance()
        forces.append(box.force(coarse, 0.02, (0.0, 0.0), 1.0))
    told = sim.record.force()[-steps:, 0]
    assert np.mean(forces, axis=0)[0] == pytest.approx(told.mean(), rel=2e-3)  # 0.8e-3 on fine cells everywhere


def vortices(n: int, *, patch: bool) -> float:
    """Return the rms error on coarse cells of the decaying vortices in the unit square, some of it on a patch [m/s]."""
    k, viscosity, until = 2 * np.pi, 0.02, 0.1
    whole = flow.Grid(cells=(n, n), cell=1 / n)

    def start(x, y):
        return np.sin(k * x) * np.cos(k * y), -np.cos(k * x) * np.sin(k * y)

    setup = flow.Setup(
        grid=whole.patch((0.3, 0.8), (0.25, 0.7), ratio=2) if patch else whole, coarse_grid=whole if patch else None,
        viscosity=viscosity, sides=flow.Sides.periodic(), start=start, courant=0.5, tolerance=1e-6,
    )  # fmt: skip
    sim = ran(setup, until)
    water = sim.water.layers[-1]
    x, y = np.meshgrid(whole.faces(PAD, PAD + n, 0), whole.centres(PAD, PAD + n, 1))
    exact = np.exp(-2 * viscosity * k**2 * until) * start(x, y)[0]
    return float(np.sqrt(np.mean((water.velocity[0][PAD:-PAD, PAD:-PAD] - exact) ** 2)))


def test_vortices_decay_through_the_patch_at_second_order():
    """And on 96 coarse cells a side by less error than without it; on 64 its sides add more than it takes away."""
    errors = [vortices(n, patch=True) for n in (48, 96)]
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert errors[1] < vortices(96, patch=False)


def test_a_patch_may_end_on_walls_and_on_periodic_sides():
    """Water sheared between two walls stays as it is, exactly."""
    sides = flow.Sides(
        left=flow.Periodic(), right=flow.Periodic(), bottom=flow.Wall(speed=-1.0), top=flow.Wall(speed=1.0)
    )  # fmt: skip
    whole = flow.Grid(cells=(16, 32), cell=1 / 16)
    patch = whole.patch((0.0, 1.0), (0.0, 1.0), ratio=2)
    setup = flow.Setup(
        grid=patch, coarse_grid=whole, sides=sides, viscosity=0.2, start=lambda x, y: (y - 1.0, 0.0 * y), coarse=True
    )  # fmt: skip
    sim = ran(setup, 0.1)
    for water, velocity in ((sim.water, sim.velocity), (sim.water.layers[-1], sim.domain.velocity)):
        assert velocity[0] == pytest.approx(np.broadcast_to(water.grid.y[:, None] - 1.0, velocity[0].shape), abs=1e-6)
        assert velocity[1] == pytest.approx(0.0, abs=1e-6)


def test_added_mass_is_that_of_open_water():
    found = []
    for setup in (STREAM, uniform(STREAM)):
        sim = flow.Simulation(setup)
        markers = CYLINDER.shape.markers(0.0, flow.Pose(), setup.grid.cell)
        found.append(flow.added_mass(sim.water, markers, (0.0, 0.0), 1.0))
    assert found[0] == pytest.approx(found[1], rel=4e-3, abs=2e-3)
    assert found[0][0, 0] == pytest.approx(np.pi / 4, rel=0.02)


def test_a_body_on_a_spring_rings_as_on_fine_cells_everywhere():
    body = flow.FreeBody(shape=flow.Cylinder(diameter=1.0), density=2.0, springs=(6.0, 6.0, 0.0), velocity=(0.5, 0.0))
    setup = replace(STREAM, bodies=(body,), stream=(0.0, 0.0))
    places = [ran(one, 1.2).record.column("x") for one in (setup, uniform(setup))]
    assert places[0] == pytest.approx(places[1], abs=5e-4)
    assert np.ptp(places[1]) > 0.05


def test_a_body_that_is_accelerated_after_a_step_takes_the_water_along():
    """With the velocity that it would have had anyway, the step is the one that knew it from the beginning."""

    def moving(speed):
        return flow.Body(
            shape=flow.Cylinder(diameter=1.0),
            motion=lambda t: flow.Pose(position=(0.0, 0.0), velocity=(speed if t > 0 else 0.0, 0.0)),
        )

    forces = {}
    for name, setup in (("patch", STREAM), ("fine", uniform(STREAM))):
        sim = flow.Simulation(replace(setup, stream=(0.0, 0.0), bodies=(moving(0.0),)))
        sim.advance(0.02)
        push = flow.Twists(reference_points=np.zeros((1, 2)), linear=np.array([[0.1, 0.0]]), angular=np.zeros((1, 1)))
        sim.accelerate({"body": push})
        forces[name] = float(sim.record.force()[-1, 0])
    assert forces["patch"] == pytest.approx(forces["fine"], rel=3e-3)
    assert forces["fine"] < -3.0  # a body of its own size of water, at 5 m/s^2


@pytest.mark.parametrize("across", [(0.0, 1.0), (0.2, 0.8)], ids=["walls", "inside"])
def test_small_accelerations_count_as_much_as_large_ones(across):
    """On a patch that ends on a channel's walls or inside it, as on fine cells everywhere, down to 1e-7 m/s."""
    whole = flow.Grid.covering((0.0, 2.0), (0.0, 1.0), cell=1 / 24)
    body = flow.Body(shape=flow.Ellipse(length=0.4, width=0.25), motion=flow.Pose(position=(0.9, 0.48)), name="ellipse")
    setup = flow.Setup(
        grid=whole.patch((0.4, 1.5), across, ratio=2), coarse_grid=whole, viscosity=2e-3, bodies=(body,), coarse=True,
        sides=flow.Sides(
            left=flow.Inflow(profile=lambda y: 6 * y * (1 - y)), right=flow.Outflow(), bottom=flow.Wall(),
            top=flow.Wall(),
        ),
    )  # fmt: skip
    push = flow.Twists(
        reference_points=np.array([[0.9, 0.48]]), linear=np.array([[0.02, 0.03]]), angular=np.array([[0.1]])
    )
    found = {}
    for name, one in (("patch", setup), ("fine", uniform(setup))):
        sim = flow.Simulation(one)
        for _ in range(3):
            sim.advance(0.01)
        begun = sim.snapshot()
        for size in (1.0, 1e-3, 1e-6):
            sim.restore(begun)
            sim.advance(0.01)
            before = sim.last_loads("ellipse").total
            sim.accelerate({"ellipse": push * size})
            after = sim.last_loads("ellipse").total
            found[name, size] = np.array([*(after.force - before.force), *(after.moment - before.moment)]) / size
    for size in (1.0, 1e-3, 1e-6):
        assert found["patch", size] == pytest.approx(found["fine", 1.0], rel=5e-3, abs=5e-4)


def test_the_first_step_taken_again_is_the_same():
    sim = flow.Simulation(STREAM)
    begun = sim.snapshot()
    sim.advance()
    first = sim.water.velocity.copy()
    sim.restore(begun)
    sim.advance()
    assert sim.water.velocity.tobytes() == first.tobytes()


@pytest.mark.parametrize("how", ["checkpoint", "snapshot"])
def test_what_was_kept_goes_on_to_the_same_bytes(how, tmp_path):
    setup = replace(STREAM, step=None)
    whole = flow.Simulation(setup)
    for _ in range(8):
        whole.advance()
    again = flow.Simulation(setup)
    for _ in range(4):
        again.advance()
    if how == "snapshot":
        kept = again.snapshot()
        again.advance()
        again.restore(kept)
    else:
        flow.checkpoint.save(again, tmp_path / "kept")
        again = flow.Simulation(setup)
        flow.checkpoint.load(again, tmp_path / "kept")
    for _ in range(4):
        again.advance()
    assert again.water.velocity.tobytes() == whole.water.velocity.tobytes()
    assert again.water.layers[-1].p.tobytes() == whole.water.layers[-1].p.tobytes()


def test_a_patch_ends_on_a_mirror_that_cuts_the_body():
    sides = flow.Sides(low=flow.Mirror())
    whole = flow.Grid.covering((-3.0, 3.0), (-3.0, 3.0), (0.0, 3.0), cell=1 / 4, sides=sides)
    setup = flow.Setup(
        grid=whole.patch((-1.75, 1.75), (-1.75, 1.75), (0.0, 1.75), ratio=2),
        coarse_grid=whole,
        sides=sides,
        viscosity=0.02,
        stream=(1.0, 0.0, 0.0),
        bodies=(flow.Body(shape=flow.Sphere(diameter=0.8)),),
        coarse=True,
        step=0.05,
    )
    a, b = (ran(one, 0.3).record.force() for one in (setup, uniform(setup)))
    assert a[1:, 0] == pytest.approx(b[1:, 0], rel=0.01)
    assert np.abs(a[:, 2]).max() < 1e-4


def test_it_travels_with_the_body():
    """In still water the same force acts on a body that a travelling patch follows as on one that the stream meets."""
    glide = replace(CYLINDER, motion=flow.Glide(start=(0.0, 0.0), velocity=(-1.0, 0.0)))
    follows = ran(replace(STREAM, stream=(0.0, 0.0), bodies=(glide,), follow="body"), 0.4)
    rests = ran(STREAM, 0.4)
    assert follows.record.force()[3:, 0] == pytest.approx(rests.record.force()[3:, 0], rel=1e-3)
    assert follows.frame[0, 0] == pytest.approx(-0.4, abs=1e-6)


def test_points_are_read_where_they_lie(nested, fine):
    points = np.array([(0.9, 0.2), (3.0, 0.3), (-2.5, -1.0), (1.9, 1.4)])
    a, b = nested.probe(points), fine.probe(points)
    assert a.velocity == pytest.approx(b.velocity, abs=0.01)
    assert a.pressure == pytest.approx(b.pressure, abs=0.01)
    with pytest.raises(InvalidDesign, match="is outside the domain"):
        nested.probe((9.0, 0.0))
    assert nested.domain.pressure.shape == (32, 64)
    assert flow.snapshot(nested.domain).sizes["x"] == 64


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"grid": flow.Grid(cells=(32, 32), cell=1 / 24, origin=(-0.5, -0.5))}, r"does not fill whole cells.*patch\("),
        ({"grid": flow.Grid(cells=(32, 32), cell=1 / 16, origin=(-1.03, -1.0))}, r"does not fill whole cells"),
        ({"grid": flow.Grid(cells=(32, 32), cell=1 / 16, origin=(4.0, -1.0))}, r"4 to 6 m reaches out.*from -3 to 5 m"),
        ({"grid": WHOLE.patch((-2.75, 1.0), (-1.0, 1.0), ratio=2)}, r"within 0\.25 m of the left side.*0\.5 m away"),
        ({"grid": WHOLE.patch((-3.0, 1.0), (-1.0, 1.0), ratio=2)}, r"within 0 m of the left side"),
        ({"grid": WHOLE.patch((-0.9, 1.0), (-1.0, 1.0), ratio=2)}, r"within 3 fine cells of the left side.*0.0625 m"),
    ],
)  # fmt: skip
def test_a_patch_that_cannot_be_is_refused(change, message):
    with pytest.raises(InvalidDesign, match=message):
        flow.Simulation(replace(STREAM, **change))


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"x": (-1.0, 9.0), "y": (-1.0, 1.0)}, r"along x the patch reaches from -1 to 9 m and the grid from -3 to 5 m"),
        ({"x": (1.0, -1.0), "y": (-1.0, 1.0)}, r"give rising places"),
        ({"x": (-1.0, 1.0), "y": (-1.0, 1.0), "z": (0.0, 1.0)}, r"the grid has 2 axes and the patch 3"),
        ({"x": (-1.0, 1.0), "y": (-1.0, 1.0), "ratio": 3}, r"the ratio is 3; give 2, 4 or 8"),
        ({"x": (-1.0, 1.0), "y": (-1.0, 1.0), "ratio": 2.0}, r"the ratio is 2.0; give 2, 4 or 8"),
        ({"x": ("a", 1.0), "y": (-1.0, 1.0)}, r"give a pair of finite numbers for each axis"),
        ({"x": 1.0, "y": (-1.0, 1.0)}, r"give a pair of finite numbers for each axis"),
    ],
)
def test_a_patch_that_a_grid_cannot_hold_is_refused(asked, message):
    with pytest.raises(InvalidDesign, match=message):
        WHOLE.patch(**asked)


def test_a_patch_covers_what_is_asked_and_fills_whole_cells():
    for ratio in (2, 4, 8):
        patch = WHOLE.patch((-0.93, 1.61), (-0.7, 0.9), ratio=ratio)
        assert patch.cell * ratio == WHOLE.cell
        for d, (low, high) in enumerate(((-0.93, 1.61), (-0.7, 0.9))):
            assert patch.origin[d] <= low
            assert high <= patch.origin[d] + patch.size[d]
            assert (patch.origin[d] - WHOLE.origin[d]) / WHOLE.cell % 1 == pytest.approx(0, abs=1e-9)
