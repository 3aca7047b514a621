"""Sides in water without end, against vortices, sources and bodies whose far field is known."""

import warnings

import flow_cases as cases
import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import Doubtful
from suchus.flow import signals
from suchus.flow.compiled import PAD
from suchus.flow.farfield import FADE_FRACTION, Fading, OpenWater, fade_length
from suchus.flow.watch import Watch

NO_BODY = (PAD, PAD, PAD, PAD)


def swirl(x, y, at, circulation, radius):
    """Velocity (u, v) of a vortex with a Gaussian core."""
    dx, dy = x - at[0], y - at[1]
    square = np.maximum(dx**2 + dy**2, 1e-12)
    turn = circulation / (2 * np.pi * square) * (1 - np.exp(-square / radius**2))
    return -turn * dy, turn * dx


def fields(nx, ny, velocity):
    """Velocity ``velocity(x, y)`` in cells from the corner, on the padded faces."""
    faces_x, faces_y = np.arange(nx + 2 * PAD) - PAD, np.arange(ny + 2 * PAD) - PAD
    u = velocity(*np.meshgrid(faces_x, faces_y + 0.5))[0]
    v = velocity(*np.meshgrid(faces_x + 0.5, faces_y))[1]
    return u.astype(np.float32), v.astype(np.float32)  # the solver's own type, or the kernels are compiled twice


def inward(nx, ny, velocity):
    """The same into the domain on the faces of the four sides."""
    x, y = np.arange(nx) + 0.5, np.arange(ny) + 0.5
    return [
        velocity(np.zeros(ny), y)[0], -velocity(np.full(ny, nx), y)[0],
        velocity(x, np.zeros(nx))[1], -velocity(x, np.full(nx, ny))[1],
    ]  # fmt: skip


def test_what_a_vortex_induces_on_the_sides():
    nx, ny = 96, 64

    def velocity(x, y):
        return swirl(x, y, (37.3, 29.1), 5.0, 4.0)

    got = OpenWater((nx, ny)).inward(fields(nx, ny, velocity), NO_BODY, [])
    for ours, exact in zip(got, inward(nx, ny, velocity), strict=True):
        assert ours == pytest.approx(exact, abs=2e-4)  # of up to 0.03


def test_what_swells_pushes_the_sides_out():
    nx, ny = 64, 96

    def velocity(x, y):
        u, v = swirl(x, y, (27.4, 61.7), 5.0, 4.0)
        return v, -u  # outwards instead of around

    got = OpenWater((nx, ny)).inward(fields(nx, ny, velocity), (PAD, PAD + ny, PAD, PAD + nx), [])
    for ours, exact in zip(got, inward(nx, ny, velocity), strict=True):
        assert ours == pytest.approx(exact, abs=2e-4)


def test_a_wake_that_leaves_acts_like_a_source():
    """A uniform wake behind x = 40, carried out on the right: afar it is a source of its defect's flow."""
    nx, ny, depth, width = 256, 128, 0.1, 6.0

    def wake(x, y):
        return -depth * np.exp(-(((y - 64.0) / width) ** 2)) / (1 + np.exp(-(x - 40.0))), 0 * x

    defect = depth * width * np.pi**0.5

    def source(x, y):
        square = (x - 40.0) ** 2 + (y - 64.0) ** 2
        return defect * (x - 40.0) / (2 * np.pi * square), defect * (y - 64.0) / (2 * np.pi * square)

    u, v = fields(nx, ny, wake)
    got = OpenWater((nx, ny)).inward((u, v), NO_BODY, [Fading(0, False, 1.0, FADE_FRACTION * nx)])
    exact = inward(nx, ny, source)
    assert got[0] == pytest.approx(exact[0], abs=0.02 * np.abs(exact[0]).max())
    assert got[3][:160] == pytest.approx(exact[3][:160], abs=0.05 * np.abs(exact[3]).max())
    turned = OpenWater((ny, nx)).inward((v.T.copy(), u.T.copy()), NO_BODY, [Fading(1, False, 1.0, FADE_FRACTION * nx)])
    assert turned[2] == pytest.approx(exact[0], abs=0.05 * np.abs(exact[0]).max())


def test_a_vortex_pair_travels_as_in_water_without_end():
    """Close to the sides of a small box: half its speed would be the images' if the sides were held."""
    n, gap, circulation = 96, 0.5, 1.0
    grid = flow.Grid(cells=(n, n), cell=2 / n, origin=(-1.0, -1.0))
    travelled = []
    for endless in (True, False):
        side = flow.Stream(unbounded=endless)
        sides = flow.Sides(left=side, right=side, bottom=side, top=side)
        sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-4, sides=sides, courant=0.5))

        def velocity(x, y):
            h, parts = 2 / n, []
            for place, sign in ((-gap / 2, 1), (gap / 2, -1)):
                parts.append(swirl(x * h - 1, y * h - 1, (place, 0.0), sign * circulation, 0.12))
            return parts[0][0] + parts[1][0], parts[0][1] + parts[1][1]

        sim.water.u[:], sim.water.v[:] = fields(n, n, velocity)
        sim.run(0.6, progress=False)
        spin = np.maximum(sim.vorticity[:, : n // 2], 0)
        travelled.append((spin.sum(axis=1) * grid.faces(PAD + 1, PAD + n, 1)).sum() / spin.sum())
    expected = 0.6 * circulation / (2 * np.pi * gap)
    assert travelled[0] == pytest.approx(expected, rel=0.04)
    assert abs(travelled[1] / expected - 1) > 0.1


@pytest.mark.parametrize("half", [1.5, 3.0])
def test_added_mass_does_not_hang_on_the_domain(half):
    circle = cases.added(flow.Cylinder(diameter=1.0), 32, half=half)
    assert np.diag(circle)[:2] == pytest.approx([np.pi / 4, np.pi / 4], rel=0.01)
    ellipse = cases.added(flow.Ellipse(length=2.0, width=1.0), 32, half=half)
    assert np.diag(ellipse) == pytest.approx([np.pi / 4, np.pi, np.pi / 8 * 0.75**2], rel=0.01)


def started(half, endless, **changes):
    side = flow.Stream(unbounded=endless)
    grid = flow.Grid.covering((-half, half), (-half, half), cell=1 / 32)
    settings = {"viscosity": 1e-6, "coarse": True, "stream": (1.0, 0.0), "tolerance": 1e-6, **changes}
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, density=1.0, bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0)),),
            sides=flow.Sides(left=side, right=side, bottom=side, top=side), **settings,
        )
    )  # fmt: skip
    sim.advance(1e-4)
    return sim


def test_a_body_that_starts_at_once_moves_the_far_water_as_a_dipole():
    sim = started(1.5, True)
    impulse = sim.record.force()[0, 0] * 1e-4
    assert impulse == pytest.approx(np.pi / 2, rel=0.01)  # its own area and the added mass
    left = sim.water.border.edges[0].prescribed
    y = sim.setup.grid.y
    exact = 1 - 0.25 * (1.5**2 - y**2) / (1.5**2 + y**2) ** 2
    assert left == pytest.approx(exact, abs=2e-3)
    held = started(1.5, False)
    assert held.record.force()[0, 0] * 1e-4 > 1.1 * np.pi / 2
    assert np.array_equal(held.water.border.edges[0].prescribed, np.ones(y.size, np.float32))


def test_a_symmetric_flow_stays_symmetric():
    sim, _, force = cases.cylinder(16, 40, x=(-2, 4), y=(-2, 2), until=1.5)
    assert np.abs(force[20:, 1]).max() < 1e-3 * np.abs(force[-1, 0])
    assert np.abs(sim.vorticity + sim.vorticity[::-1]).max() < 2e-3 * np.abs(sim.vorticity).max()


def test_the_started_cylinder_drags_the_same_in_any_domain():
    drags = [
        cases.cylinder(16, 40, x=(-half, half + 2), y=(-half, half), until=1.0)[2][-1, 0] for half in (2.0, 3.5)
    ]  # fmt: skip
    assert drags[0] == pytest.approx(drags[1], rel=3e-3)


def street(end, *, cells=8, until=50.0):
    """Drag, amplitude of the lift and Strouhal number of a cylinder at Re 100, the right side this far behind it."""
    grid = flow.Grid.covering((-4.0, end), (-4.0, 4.0), cell=1 / cells)

    def start(x, y):
        return np.ones_like(x), 0.4 * np.exp(-((x - 1.5) ** 2 + y**2))

    body = flow.Body(shape=flow.Cylinder(diameter=1.0))
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=0.01, stream=(1.0, 0.0), start=start, bodies=(body,), coarse=True)
    )
    late = sim.run(until, progress=False).select_after(until - 20.0)
    drag, lift = 2 * late.force().T
    rises = signals.rises(late.time, lift)
    return drag.mean(), 0.5 * np.ptp(lift), (len(rises) - 1) / (rises[-1] - rises[0])


def test_a_vortex_street_does_not_depend_on_where_the_box_ends():
    """The lift was 0.25, 0.35 and 0.29 when the wake was faded over a quarter of the domain."""
    boxes = np.array([street(end) for end in (12.0, 16.0)])
    assert boxes[0] == pytest.approx(boxes[1], rel=0.015)


def test_a_fade_does_not_jump_with_the_cells_that_a_body_covers():
    """A window that grew by one cell gave the force of an undulating eel a peak of a tenth of itself."""
    body = flow.Body(shape=flow.Cylinder(diameter=1.0))
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid.covering((-2, 6), (-2, 2), cell=1 / 8), viscosity=0.1, stream=(1.0, 0.0), bodies=(body,)
        )
    )
    edge = next(e for e in sim.water.border.edges if e.axis == 0 and not e.is_lower_side)
    at_first = (PAD + 8, PAD + 24, PAD + 8, PAD + 24)
    wider, narrower = (PAD + 6, PAD + 26, PAD + 8, PAD + 25), (PAD + 9, PAD + 23, PAD + 8, PAD + 24)
    lengths = []
    for window in (at_first, narrower, *[wider] * 200, narrower):
        edge.shorten_fade(window)
        lengths.append(edge.fade_length)
    ends = [fade_length(window, 0, is_lower_side=False, cells=edge.cells) for window in (at_first, wider)]
    assert ends[1] < ends[0] - 1.0
    assert lengths[0] == lengths[1] == ends[0]
    assert lengths[-1] == pytest.approx(ends[1])
    changes = -np.diff(lengths)
    assert changes.min() >= 0.0
    assert changes.max() < 0.1 * (ends[0] - ends[1])


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.03, -0.02)])
def test_a_wake_is_faded_over_the_same_way_at_any_size_of_the_cells(place):
    """A patch of fine cells and fine cells everywhere differed by it in the lift of a cylinder."""
    lengths = []
    for cells in (12, 24):
        body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(position=place))
        grid = flow.Grid.covering((-5, 11), (-4, 4), cell=1 / cells)
        sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.1, stream=(1.0, 0.0), bodies=(body,), coarse=True))
        sim.advance(0.001)
        lengths.append(max(edge.fade_length for edge in sim.water.border.edges) / cells)
    assert lengths[0] == pytest.approx(lengths[1], rel=0.02)


def test_a_fade_that_shortens_goes_on_from_a_snapshot_to_the_same_bytes():
    body = flow.Body(shape=flow.eel(1.0, stations=65))
    grid = flow.Grid.covering((-0.5, 2.0), (-0.6, 0.6), cell=1 / 32)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-3, stream=(0.4, 0.0), bodies=(body,), coarse=True))
    sim.run(0.3, progress=False)
    lengths = [edge.fade_length for edge in sim.water.border.edges]
    snapshot = sim.snapshot()
    sim.run(0.4, progress=False)
    assert [edge.fade_length for edge in sim.water.border.edges] != lengths
    velocity = sim.water.velocity.copy()
    sim.restore(snapshot)
    assert [edge.fade_length for edge in sim.water.border.edges] == lengths
    sim.run(0.4, progress=False)
    assert np.array_equal(sim.water.velocity, velocity)


def beside(gap, motion, *, stream=(0.0, 0.0), until, step=0.03):
    """Force on a cylinder with open sides at a distance."""
    half = 0.5 + gap
    grid = flow.Grid.covering((-half, max(half, 2.5)), (-half, half), cell=1 / 16)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.01, stream=stream, bodies=(body,), coarse=True, step=step))
    return 2 * sim.run(until, progress=False).force()[:, 0]


def test_open_sides_close_to_a_blunt_body_are_stable():
    """The drag grew without bounds, from step to step with another sign."""
    drag = beside(0.33, flow.Pose(), stream=(1.0, 0.0), until=2.0, step=None)[20:]
    assert np.abs(np.diff(drag, 2)).mean() < 2e-3 * drag.mean()


def test_open_sides_answer_fast_oscillations_at_once():
    """A cylinder that shakes once in 20 steps, with sides at three quarters of its diameter and far away."""
    rate = 2 * np.pi / 0.6

    def shaken(time):
        return flow.Pose(
            position=(0.02 * (1 - np.cos(rate * time)), 0.0), velocity=(0.02 * rate * np.sin(rate * time), 0.0)
        )

    near, far = (beside(gap, shaken, until=1.2) for gap in (0.75, 3.0))
    assert np.abs(near - far)[4:].max() < 0.06 * np.abs(far).max()


def test_a_wake_that_leaves_too_near_behind_a_body_is_said():
    grid = flow.Grid.covering((-2.0, 3.0), (-2.0, 2.0), cell=1 / 8)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0))

    def wake(viscosity, until):
        sim = flow.Simulation(
            flow.Setup(grid=grid, viscosity=viscosity, stream=(1.0, 0.0), bodies=(body,), coarse=True)
        )
        sim.run(until, progress=False)

    message = (
        r"the wake leaves through the right side of the domain, 2\.\d+ m behind .* at least 1\d\.?\d* m behind them"
    )
    with pytest.warns(Doubtful, match=message):
        wake(0.01, 8.0)
    with pytest.warns(Doubtful, match=r"the drag depends on that side. Put it at least 3\.?\d* m behind"):
        wake(0.03, 12.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        wake(0.01, 1.0)  # it has not come there yet


def test_a_wake_leaves_only_through_a_side_to_which_the_far_water_has_carried_it():
    grid = flow.Grid.covering((-1.5, 1.5), (-1.0, 1.0), cell=1 / 16)

    def start(x, y):  # a vortex at the top side
        size = np.exp(-((x - 0.9) ** 2 + (y - 0.9) ** 2) / 0.02)
        return -(y - 0.9) * size, 1.0 + (x - 0.9) * size

    body = flow.Body(shape=flow.Ellipse(length=1.0, width=0.25))
    setup = flow.Setup(
        grid=grid, viscosity=0.002, stream=(0.0, 1.0), start=start, bodies=(body,), coarse=True, step=0.005
    )
    sim = flow.Simulation(setup)
    sim.advance(0.005)
    watch = Watch(setup)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        watch.wakes(sim.water, 0.5)  # half a metre, and 0.9 m lie between the body and the side
    with pytest.warns(Doubtful, match="the wake leaves through the top side"):
        watch.wakes(sim.water, 1.0)
