import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.flow import immerse, multigrid, patch, poisson, scheme, stencil
from suchus.flow.compiled import PAD, compiled
from suchus.flow.immerse import close_faces
from suchus.flow.slab import inner_strides

median, limited_quick, moment0, moment1, apply_slabs, seal_slab = (
    compiled(part.py_func)
    for part in (
        scheme.median,
        scheme.limited_quick,
        immerse.moment0,
        immerse.moment1,
        stencil.apply_slabs,
        stencil.seal_slab,
    )
)
"""Parts of kernels, compiled by themselves."""

number = st.floats(-1e3, 1e3)


@given(number, number, number)
def test_median_is_the_middle_one(a, b, c):
    assert median(a, b, c) == sorted([a, b, c])[1]


@given(number, number)
def test_quick_is_exact_on_straight_lines(value, slope):
    assert limited_quick(value - slope, value, value + slope) == pytest.approx(value + slope / 2, abs=1e-9)


@given(number, number, number)
def test_limited_face_value_lies_between_its_neighbours(a, b, c):
    low, high = min(b, c), max(b, c)
    assert low - 1e-9 <= limited_quick(a, b, c) <= high + 1e-9


def test_quick_of_a_parabola_by_hand():
    assert limited_quick(1.0, 4.0, 9.0) == pytest.approx(6.25)  # 2.5 squared


def test_moments_are_the_integrals_of_the_kernel():
    y = np.linspace(-1, 1, 200_001)
    kernel = 0.5 * (1 + np.cos(np.pi * y))
    for d in (-0.7, -0.2, 0.0, 0.4, 0.9):
        wet = y > -d
        assert moment0(d) == pytest.approx(np.trapezoid(np.where(wet, kernel, 0), y), abs=1e-5)
        assert moment1(d) == pytest.approx(np.trapezoid(np.where(wet, y * kernel, 0), y), abs=1e-5)
    assert (moment0(-1.0), moment0(1.0), moment1(1.0), moment1(-1.0)) == (0, 1, 0, 0)


def _body(cx, cy, thin):
    ny, nx = cx.shape
    for c, ox, oy in ((cx, 0, 0.5), (cy, 0.5, 0)):
        for j in range(ny):
            for i in range(nx):
                across = abs((j + oy) - (34 + 0.2 * (i + ox - 50))) - thin
                c[j, i] = max(moment0(max(across, abs(i + ox - 50) - 20)), 1e-3)


@pytest.mark.parametrize(
    ("real", "limit"),
    [(np.float32, 1e-5), pytest.param(np.float64, 1e-9, marks=pytest.mark.slow("the second precision"))],
)
@pytest.mark.parametrize("thin", [None, 6.0, 1.5])
def test_the_pressure_solver_solves(thin, real, limit):
    """With so few cycles for each digit, and to a hundred times the mean that is left, whatever the precision."""
    ny, nx, inner, repeats = 64, 96, inner_strides((96, 64)), (False, False)
    layout = poisson.levels((nx, ny))
    store = poisson.make_store(layout, real)
    faces = multigrid.faces_of(store, layout, inner, 0)
    if thin is not None:
        _body(*faces, thin)
        poisson.place_window(layout, (20, 50, 20, 82))
        multigrid.coarsen(store, layout, inner)
    patches = patch.patch_layouts(layout, repeats)
    room = patch.allocate_buffer(np.zeros((patch.FACES + 2, 0), real), patches)
    multigrid.copy_coefficients(store, layout, room, patches, inner)
    rng = np.random.default_rng(0)
    b = multigrid.level(store, layout, inner, multigrid.B, 0)
    u, v = faces[0] * rng.standard_normal(b.shape), faces[1] * rng.standard_normal(b.shape)
    u[:, [PAD, -PAD]] = 0
    v[[PAD, -PAD]] = 0
    inner_cells = np.s_[PAD:-PAD, PAD:-PAD]
    b[inner_cells] = u[inner_cells] - u[PAD:-PAD, PAD + 1 : -PAD + 1] + v[inner_cells] - v[PAD + 1 : -PAD + 1, PAD:-PAD]
    for j in range(ny + 2 * PAD):
        seal_slab(b, j, inner, repeats)
    wanted = b[inner_cells].copy()
    x, d, q = (np.zeros(b.shape, real) for _ in range(3))
    sums = np.zeros((ny + 2 * PAD, 4))
    cycles, _, _, a, c = poisson.solve(
        x, d, q, store, layout, room, patches, inner, repeats, sums, limit, 10 * limit, 1, 60
    )
    x = a * d + c * multigrid.level(store, layout, inner, multigrid.X, 0)
    assert cycles < (12 if thin is None else 30) * np.log(limit) / np.log(1e-9)
    out = np.empty((1, nx + 2 * PAD), real)
    for j in range(ny):  # the answer is checked with the operator, not with the solver's own residual
        apply_slabs(out, 0, x, j + PAD - 1, j + PAD, j + PAD + 1, faces, layout[0], j + PAD, inner)
        assert np.abs(out[0, PAD:-PAD] - wanted[j]).max() < 100 * limit


@pytest.mark.parametrize(
    ("cells", "most"),
    [
        ((17, 11), multigrid.MAX_RESIDUAL_RATIO),
        ((9, 27, 11), multigrid.MAX_RESIDUAL_RATIO),
        ((128, 4), multigrid.MAX_RESIDUAL_RATIO),
        ((288, 192), 0.2),
    ],
)
@pytest.mark.parametrize("waves", [1, 2, 3])
def test_a_cycle_leaves_little_of_smooth_errors(cells, most, waves):
    """Of each alone, along each axis: all but the last grid are a coarsest level by themselves."""
    axes, inner, repeats = len(cells), inner_strides(cells), (False,) * len(cells)
    layout = poisson.levels(cells)
    store = poisson.make_store(layout, np.float32)
    patches = patch.patch_layouts(layout, repeats)
    room = patch.allocate_buffer(np.zeros((patch.FACES + axes, 0), np.float32), patches)
    b = multigrid.level(store, layout, inner, multigrid.B, 0)
    shape = tuple(n + 2 * PAD for n in reversed(cells))
    for axis, n in enumerate(cells):
        along = np.cos(np.pi * waves * (np.arange(n) + 0.5) / n)
        b[:] = 0
        b.reshape(shape)[(slice(PAD, -PAD),) * axes] = along.reshape((-1,) + (1,) * axis)
        x, d, q = (np.zeros_like(b) for _ in range(3))
        *_, share, _ = poisson.solve(
            x, d, q, store, layout, room, patches, inner, repeats, np.zeros((b.shape[0], 4)), 0.0, 0.0, 1, 1
        )
        assert abs(1 - 1 / share) <= most


@given(st.lists(st.floats(0.1, 0.95), min_size=3, max_size=12), st.floats(0, 6))
def test_no_path_from_cell_to_cell_crosses_a_closed_line(radii, turn):
    """What is wet from the middle of a closed line stays inside it, however it lies on the grid."""
    n, h = 24, 1 / 10
    angle = turn + np.linspace(0, 2 * np.pi, len(radii) + 1)
    r = np.array([*radii, radii[0]])
    x, y = r * np.cos(angle) + 0.0137, r * np.sin(angle) + 0.0071  # or it may pass right through centres
    centre = (np.arange(n) - n / 2 + 0.5) * h
    across, along = np.ones((n, n + 1)), np.ones((n + 1, n))
    pieces = np.stack([np.stack([x, y])[:, :-1], np.stack([x, y])[:, 1:]])
    for c, passage in enumerate((across, along)):
        close_faces(passage, c, pieces, centre[[0, 0]], h)
    wet = np.hypot(*np.meshgrid(centre, centre)) > 1.0
    for _ in range(n * n):
        more = wet.copy()
        more[:, 1:] |= wet[:, :-1] & (across[:, 1:-1] == 1)
        more[:, :-1] |= wet[:, 1:] & (across[:, 1:-1] == 1)
        more[1:] |= wet[:-1] & (along[1:-1] == 1)
        more[:-1] |= wet[1:] & (along[1:-1] == 1)
        if (more == wet).all():
            break
        wet = more
    inside = np.zeros((n, n), bool)
    for ax, ay, bx, by in zip(x[:-1], y[:-1], x[1:], y[1:], strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):
            cut = ax + (centre - ay) * (bx - ax) / (by - ay)
        inside ^= (((ay <= centre) != (by <= centre))[:, None]) & (centre[None, :] < cut[:, None])
    assert not (wet & inside).any()
