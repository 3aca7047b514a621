"""Advection schemes as objects: a user's is compiled into the solver, and each has the order that it is known for."""

from math import exp, log2, pi

import numba
import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.core.fingerprint import fingerprint
from suchus.flow.advect import advance, advance_by
from suchus.flow.compiled import PAD

NU = 1e-3
ALL = flow.QUICK, flow.CENTRAL, flow.UPWIND


def vortices(cells, **settings):
    """Return Taylor's and Green's vortices in a periodic stream of 1 m/s, at the start."""
    grid = flow.Grid(cells=(cells, cells), cell=2 * pi / cells)
    return flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=NU, sides=flow.Sides.periodic(), stream=(1.0, 0.0), start=carried, coarse=True,
            precision="double", tolerance=1e-9, **settings,
        )
    )  # fmt: skip


def carried(x, y, time=0.0):
    """Return the exact velocities."""
    left, fade = x - time, exp(-2 * NU * time)
    return 1 + fade * np.sin(left) * np.cos(y), -fade * np.cos(left) * np.sin(y)


def error(sim, until):
    """Return the largest error of the velocity along x after a run [m/s]."""
    sim.run(until)
    h, n = sim.setup.grid.cell, sim.setup.grid.cells[0]
    x, y = np.meshgrid(h * np.arange(n), h * (np.arange(n) + 0.5))
    return np.abs(sim.water.velocity[0][PAD:-PAD, PAD:-PAD] - carried(x, y, until)[0]).max()


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (lambda x, y: (x, y, x), "gives 3 velocities"),
        (lambda x, y: (x[:3], y), "along x; a finite velocity for each point"),
        (lambda x, y: (x, np.where(y > 1, np.nan, y)), "along y; a finite velocity"),
    ],
)
def test_a_start_that_is_no_velocity_is_refused(start, words):
    with pytest.raises(InvalidDesign, match=words):
        flow.Simulation(flow.Setup(grid=flow.Grid(cells=(32, 32), cell=0.1), viscosity=1.0, start=start))


def test_the_water_begins_as_it_is_told_also_in_space_and_in_a_grid_that_travels():
    def start(x, y, z):
        return 0.1 + 0 * x, 0.2 * y, 0.3 * z

    grid = flow.Grid(cells=(16, 16, 16), cell=0.1)
    body = flow.Body(shape=flow.Sphere(diameter=0.5), name="it",
                     motion=flow.Glide(start=(0.8, 0.8, 0.8), velocity=(0.05, 0.0, 0.0)))  # fmt: skip
    setup = flow.Setup(grid=grid, viscosity=1.0, start=start, bodies=(body,), follow="it")
    u, v, w = flow.Simulation(setup).water.velocity
    assert u[3, 4, 5] == pytest.approx(0.05)  # the grid's own 0.05 m/s less
    assert v[3, PAD + 10, 5] == pytest.approx(0.2 * 1.0)
    assert w[PAD + 5, 3, 4] == pytest.approx(0.3 * 0.5)


def mine(upstream, centre, downstream):
    real = type(centre)
    quick = real(0.75) * centre + real(0.375) * downstream - real(0.125) * upstream
    steepest = real(10.0) * centre - real(9.0) * upstream
    low, high = min(centre, steepest), max(centre, steepest)
    bound = min(max(downstream, low), high)
    return min(max(quick, min(centre, bound)), max(centre, bound))


def test_limited_quick_is_compiled_once_and_for_all():
    assert advance_by(flow.QUICK) is advance
    assert flow.Setup(grid=flow.Grid(cells=(32, 32), cell=0.1), viscosity=1.0).scheme == flow.QUICK


@pytest.mark.slow("the second precision")
def test_a_scheme_that_says_the_same_gives_the_same():
    ours, theirs = vortices(16), vortices(16, scheme=flow.Scheme(mine))
    for sim in (ours, theirs):
        sim.run(0.5)
    np.testing.assert_allclose(theirs.water.velocity, ours.water.velocity, rtol=0, atol=1e-13)
    assert np.abs(vortices(16).water.velocity - ours.water.velocity).max() > 0.1


@pytest.mark.slow("the second precision")
@pytest.mark.parametrize(("scheme", "low", "high"), [(flow.CENTRAL, 1.95, 2.05), (flow.UPWIND, 0.7, 1.05)])
def test_each_scheme_has_its_order(scheme, low, high):
    coarse, fine = (error(vortices(n, scheme=scheme), 1.0) for n in (16, 32))
    assert low < log2(coarse / fine) < high


@pytest.mark.slow("the second precision")
def test_upwind_loses_energy_that_central_differences_keep():
    def energy(sim):
        return float(((sim.water.velocity[:, PAD:-PAD, PAD:-PAD] - np.array([1.0, 0.0])[:, None, None]) ** 2).sum())

    kept = {}
    for scheme in (flow.CENTRAL, flow.UPWIND):
        sim = vortices(32, scheme=scheme)
        before = energy(sim)
        sim.run(1.0)
        kept[scheme.name] = energy(sim) / before
    assert kept["central"] == pytest.approx(exp(-4 * NU), abs=2e-3)
    assert kept["upwind"] < 0.85


def test_another_scheme_is_another_setup_for_a_checkpoint_and_so_is_its_helper():
    def of(half):
        @numba.njit
        def mean(a, b):
            return half * a + (1 - half) * b

        def face(upstream, centre, downstream):
            return mean(centre, downstream)

        return fingerprint(flow.Setup(grid=grid, viscosity=1.0, scheme=flow.Scheme(face)))

    grid = flow.Grid(cells=(32, 32), cell=0.1)
    assert of(0.5) == of(0.5) != of(0.25)
    assert fingerprint(flow.Setup(grid=grid, viscosity=1.0)) == fingerprint(flow.Setup(grid=grid, viscosity=1.0))
    theirs = {fingerprint(flow.Setup(grid=grid, viscosity=1.0, scheme=one)) for one in ALL}
    assert len({of(0.5), *theirs}) == 1 + len(ALL)
    assert fingerprint(flow.Setup(grid=grid, viscosity=1.0, integrator=flow.EULER)) != of(0.5)


def double(upstream, centre, downstream):
    return centre + downstream


def empty(upstream, centre, downstream):
    return centre / (centre - upstream)


def two(upstream, centre):
    return upstream + centre


@pytest.mark.parametrize(
    ("face", "words"),
    [
        (double, "double makes -2 m/s of water that moves at -1 m/s everywhere"),
        (empty, "empty"),
        (two, "two cannot be used"),
        (lambda a, b, c: open("x"), "cannot be used"),  # noqa: SIM115, PTH123
    ],
)
def test_what_is_no_scheme_is_refused_with_its_name(face, words):
    with pytest.raises(InvalidDesign, match=words):
        flow.Setup(grid=flow.Grid(cells=(32, 32), cell=0.1), viscosity=1.0, scheme=flow.Scheme(face))


def test_a_word_is_no_scheme():
    with pytest.raises(InvalidDesign, match="face is 'quick'"):
        flow.Scheme("quick")
    with pytest.raises(InvalidDesign, match=r"scheme is 'quick'; .* is needed"):
        flow.Setup(grid=flow.Grid(cells=(32, 32), cell=0.1), viscosity=1.0, scheme="quick")
