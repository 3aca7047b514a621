"""Bodies inside closed meshes: distance, normals, mass and skin are those of the solid; what is no body is refused."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from test_space import ball

from suchus import flow
from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.flow.mesh import TriangleMesh

BOX = trimesh.creation.box(extents=(0.8, 0.3, 0.5))
POSE = flow.Pose(position=(0.2, -0.1, 0.3), angle=0.5, pitch=-0.3, roll=0.9, velocity=(1.0, 0.5, -0.2), spin=0.7)
UPRIGHT = flow.Pose(position=(0.0, 0.0, 0.0))
REACH = 0.15


def of(mesh):
    return TriangleMesh(vertices=mesh.vertices, faces=mesh.faces)


def elbow():
    """Two boxes at a right angle, one body with a re-entrant edge: an L, 0.2 high."""
    corners = np.array([[0, 0], [0.6, 0], [0.6, 0.2], [0.2, 0.2], [0.2, 0.6], [0, 0.6]], float)
    top, low = (np.column_stack([corners, np.full(6, z)]) for z in (0.1, -0.1))
    lid = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]
    sides = [f for k in range(6) for f in ([6 + k, 6 + (k + 1) % 6, k], [6 + (k + 1) % 6, (k + 1) % 6, k])]
    return TriangleMesh(
        vertices=np.concatenate([top, low]), faces=np.array([*lid, *(6 + np.array(lid)[:, ::-1]), *sides])
    )


def in_box(x, y, z, half):
    """Signed distance of points from a box, from its formula."""
    q = np.abs(np.stack([x, y, z])) - half[:, None]
    return np.sqrt((np.maximum(q, 0) ** 2).sum(axis=0)) + np.minimum(q.max(axis=0), 0)


def window(shape, pose, n=40):
    ends = np.array(shape.bounds(0.0, pose)).reshape(3, 2) + 0.2 * np.array([-1, 1])
    h = float(np.ptp(ends, axis=1).max()) / n
    return [np.arange(low, high, h) for low, high in ends]


def test_the_distance_of_a_box_is_exact_in_any_attitude():
    shape = of(BOX)
    x, y, z = window(shape, POSE)
    found = shape.measure((x, y, z), 0.0, POSE, REACH)
    wz, wy, wx = np.meshgrid(z, y, x, indexing="ij")
    exact = in_box(*(part.ravel() for part in POSE.to_body((wx, wy, wz))), np.array([0.4, 0.15, 0.25])).reshape(
        wx.shape
    )
    near = np.abs(exact) < REACH
    np.testing.assert_allclose(found.distance[near], exact[near], atol=1e-12)
    np.testing.assert_array_equal(np.sign(found.distance[~near]), np.sign(exact[~near]))
    assert np.abs(found.distance[~near]).min() == REACH
    slope = np.gradient(exact, x[1] - x[0])
    steep = near & (np.abs(exact) > 0.01) & (np.abs(sum(part**2 for part in slope) - 1) < 1e-6)
    for normal, part in zip(found.normal, slope[::-1], strict=True):
        np.testing.assert_allclose(normal[steep], part[steep], atol=1e-3)
    for rate, part in zip(found.velocity, POSE.velocity_at((wx, wy, wz)), strict=True):
        np.testing.assert_allclose(rate, part, atol=1e-12)


def test_at_a_re_entrant_edge_inside_is_inside():
    shape = elbow()
    x, y, z = window(shape, UPRIGHT, 50)
    found = shape.measure((x, y, z), 0.0, UPRIGHT, 0.12).distance
    wz, wy, wx = np.meshgrid(z, y, x, indexing="ij")
    inside = (np.abs(wz) < 0.1) & (wx > 0) & (wy > 0) & (((wx < 0.6) & (wy < 0.2)) | ((wx < 0.2) & (wy < 0.6)))
    np.testing.assert_array_equal(found < 0, inside)


@given(st.integers(0, 2**31))
def test_inside_a_crooked_body_is_negative_and_outside_positive(seed):
    """A ball whose corners are moved at random: inside is where rays leave through an odd number of faces."""
    rng = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.5)
    mesh.vertices *= rng.uniform(0.4, 1.3, (len(mesh.vertices), 1))
    shape = of(mesh)
    x, y, z = (np.linspace(-0.7, 0.7, 9) + shift for shift in rng.uniform(-0.05, 0.05, 3))
    found = shape.measure((x, y, z), 0.0, UPRIGHT, 2.0).distance
    points = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1).reshape(-1, 3)
    a, b, c = (mesh.triangles[:, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(one, axis=2) for one in (a, b, c))
    volume = np.einsum("pfd,pfd->pf", a, np.cross(b, c))
    below = la * lb * lc + (a * b).sum(2) * lc + (b * c).sum(2) * la + (c * a).sum(2) * lb
    winding = np.arctan2(volume, below).sum(axis=1) / (2 * np.pi)  # solid angles (van Oosterom and Strackee 1983)
    np.testing.assert_array_equal(found.ravel() < 0, winding > 0.5)


@pytest.mark.parametrize("mesh", [BOX, trimesh.creation.icosphere(subdivisions=2, radius=0.4)], ids=["box", "ball"])
def test_mass_and_skin_are_those_of_the_mesh(mesh):
    moved = mesh.copy()
    moved.apply_transform(trimesh.transformations.euler_matrix(0.3, 0.4, 0.5))
    moved.apply_translation((0.2, -0.3, 0.1))
    shape = of(moved)
    mass, skin = shape.mass(0.0), shape.markers(0.0, POSE, 0.05)
    assert mass.volume == pytest.approx(moved.volume)
    assert mass.centre == pytest.approx(moved.center_mass)
    np.testing.assert_allclose(mass.moments, moved.moment_inertia, rtol=1e-9, atol=1e-12)
    assert skin.weight.sum() == pytest.approx(moved.area)
    assert np.sqrt(skin.weight).max() < 0.05
    facing = skin.weight * skin.normals
    np.testing.assert_allclose(facing.sum(axis=1), 0.0, atol=1e-12)
    assert (facing * skin.points).sum() / 3 == pytest.approx(moved.volume)
    np.testing.assert_allclose(skin.velocities, np.stack(POSE.velocity_at(skin.points)), atol=1e-12)
    off = shape.measure([np.array([p, p + 1e-3]) for p in skin.points[:, 7]], 0.0, POSE, 0.1).distance[0, 0, 0]
    assert abs(off) < 1e-12


@pytest.mark.parametrize(
    ("mesh", "thick"),
    [
        (BOX, 0.3),
        (trimesh.creation.icosphere(subdivisions=3, radius=0.4), 0.8),
        (trimesh.creation.box((1.0, 0.6, 0.02)), 0.02),
    ],
)
def test_its_thickness_is_that_of_the_largest_ball_inside(mesh, thick):
    assert of(mesh).thickness(0.0)[1][0] == pytest.approx(thick, rel=0.05)
    assert of(mesh).thickness(0.0)[1][0] <= thick * (1 + 1e-9)


def test_it_knows_its_symmetries_and_whether_it_is_blunt():
    assert of(BOX).mirror_symmetry == (True, True, True)
    assert elbow().mirror_symmetry == (False, False, True)
    assert not of(BOX).is_compact
    assert of(trimesh.creation.icosphere()).is_compact


def test_a_sphere_of_triangles_is_pushed_as_a_sphere():
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    forces = [
        ball(bodies=(flow.Body(shape=shape, motion=flow.Pose(position=(0.0, 0.0, 0.0))),), steps=5).record.force()[-1]
        for shape in (of(mesh), flow.Sphere(diameter=(6 * mesh.volume / np.pi) ** (1 / 3)))
    ]
    assert forces[0][0] == pytest.approx(forces[1][0], rel=0.005)
    assert np.abs(forces[0][1:]).max() < 1e-3 * forces[0][0]


def test_what_a_function_says_is_inside_becomes_a_body_in_space():
    """An ellipsoid and a torus by functions whose gradient is not 1."""
    shape = flow.from_sdf(lambda x, y, z: 3 * ((x / 0.5) ** 2 + (y / 0.2) ** 2 + (z / 0.3) ** 2 - 1), (-0.6, 0.6) * 3)
    exact = flow.Ellipsoid(length=1.0, width=0.4, height=0.6)
    assert shape.volume(0.0) == pytest.approx(exact.volume(0.0), rel=2e-3)
    np.testing.assert_allclose(shape.mass(0.0).moments, exact.mass(0.0).moments, rtol=4e-3, atol=1e-6)
    x, y, z = window(exact, POSE)
    (found, true), reach = (one.measure((x, y, z), 0.0, POSE, 0.05).distance for one in (shape, exact)), 0.05
    near = np.abs(true) < reach
    np.testing.assert_allclose(found[near], true[near], atol=5e-4)
    ring = flow.from_sdf(lambda x, y, z: (np.hypot(x, y) - 0.5) ** 2 + z**2 - 0.04, (-0.8, 0.8, -0.8, 0.8, -0.3, 0.3))
    assert ring.volume(0.0) == pytest.approx(2 * np.pi**2 * 0.5 * 0.04, rel=5e-3)


@pytest.mark.parametrize(
    ("function", "box", "says"),
    [
        (lambda x, y, z: x**2 + 1, (-1, 1, -1, 1, -1, 1), "nowhere negative in x = -1 to 1 m, y = "),
        (lambda x, y, z: x**2 + y**2 + z**2 - 1, (-1, 1, -1, 1, -1, 1), "reaches the sides of its box"),
        (lambda x, y, z: x * np.nan, (-1, 1, -1, 1, -1, 1), "not a finite number"),
        (lambda x, y: x, (-1, 1, -1), "the box has 3 numbers"),
    ],
)
def test_a_function_without_a_body_in_its_box_is_refused(function, box, says):
    with pytest.raises(InvalidDesign, match=says):
        flow.from_sdf(function, box)


def test_a_mesh_from_a_file_is_in_metres(tmp_path):
    BOX.copy().apply_scale(1000.0).export(tmp_path / "box.stl")
    BOX.export(tmp_path / "box.obj")
    for name, scale in (("box.stl", 0.001), ("box.obj", 1.0)):
        shape = flow.from_mesh(tmp_path / name, scale=scale)
        assert len(shape.vertices) == 8
        assert shape.volume(0.0) == pytest.approx(0.12)


def broken(change):
    mesh = BOX.copy()
    change(mesh)
    return mesh


@pytest.mark.parametrize(
    ("faces", "says"),
    [
        (BOX.faces[1:], r"the mesh is open: it has 3 edges with one face, the first from \(.*\) to \(.*\) m. Close it"),
        (BOX.faces[:, ::-1], "look inwards: its volume is -0.12 m3. Turn them round"),
        (
            np.concatenate([BOX.faces[:1, ::-1], BOX.faces[1:]]),
            "go the same way along the edge from .* Wind them evenly",
        ),
        (BOX.faces[:2], "give at least four rows"),
        (BOX.faces + 1, "a face names vertex 8, and there are 8 from 0 on"),
        (BOX.faces.astype(float), "rows of three whole numbers"),
    ],
)
def test_what_is_no_body_is_refused_with_the_remedy(faces, says):
    with pytest.raises(InvalidDesign, match=says):
        TriangleMesh(vertices=BOX.vertices, faces=faces)


def test_corners_that_are_not_finite_and_files_that_are_no_meshes_are_refused(tmp_path):
    with pytest.raises(InvalidDesign, match="rows of three finite numbers"):
        TriangleMesh(vertices=BOX.vertices * np.nan, faces=BOX.faces)
    with pytest.raises(InvalidDesign, match=r"scale is 0\.0 m"):
        flow.from_mesh("fin.stl", scale=0.0)
    with pytest.raises(UnreadableFile, match="no mesh of a format that is read"):
        flow.from_mesh("fin.step")
    with pytest.raises(UnreadableFile, match="there is no file"):
        flow.from_mesh(tmp_path / "fin.stl")
    (tmp_path / "fin.stl").write_text("no fin")
    with pytest.raises(UnreadableFile, match=r"fin\.stl is"):
        flow.from_mesh(tmp_path / "fin.stl")


def test_one_thinner_than_a_cell_is_refused():
    plate = of(trimesh.creation.box(extents=(1.0, 0.6, 0.05)))
    with pytest.raises(InvalidDesign, match=r"is 0\.0\d+ m thick at most, .* cells of .*Take cells of at most"):
        ball(bodies=(flow.Body(shape=plate, motion=replace(UPRIGHT)),))
