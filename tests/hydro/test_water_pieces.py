"""Pieces of a robot: volumes, the union of its shapes, foam."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import qmc

from suchus.core.errors import InvalidDesign
from suchus.core.water_table import BALL, LANES, column, pack_table, unpack_table
from suchus.robot.design import Foam, Hull, Rod, Segment, Shell
from suchus.robot.design.flotation import float_hull
from suchus.robot.design.pieces import masses, pieces, swell, volumes
from suchus.robot.design.profile import profile, stations
from suchus.robot.robots import ROBOTS


@pytest.mark.parametrize("name", ["caiman", "salamandra", "swimmer"])
def test_the_axis_displaces_the_union_of_its_shapes(name):
    robot = replace(ROBOTS[name], hull=None)
    sections = profile(robot, np.linspace(0.0, robot.length, 200))
    wide, high = 1.02 * sections.half_width.max(), 1.5 * sections.half_height.max()
    size = np.array([robot.length, 2 * wide, 2 * high])
    points = size * (qmc.Sobol(3, seed=0).random(2**15) - [0.0, 0.5, 0.5])
    inside = np.zeros(len(points), dtype=bool)
    for segment, (start, _) in zip(robot.axis, stations(robot), strict=True):
        here = points * [-1, 1, 1] + [start + segment.front, 0, 0]
        for shape in segment.shapes:
            inside |= _inside(shape, here)
    counted = inside.mean() * np.prod(size)
    axis = {segment.name for segment in robot.axis}
    ours = sum(volume for body, volume in volumes(robot).items() if body in axis)
    assert ours == pytest.approx(counted, rel=0.01)


def _inside(shape, p):
    if isinstance(shape, Shell):
        return (((p - shape.at) / shape.half) ** 2).sum(axis=1) <= 1
    assert isinstance(shape, Rod)
    a, b = np.array(shape.start), np.array(shape.end)
    along = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return ((p - a - along[:, None] * (b - a)) ** 2).sum(axis=1) <= shape.radius**2


def test_sections_of_a_cylinder_are_exact_and_off_centre_rods_add_up():
    rod = Rod(name="a", start=(-0.2, 0.0, 0.0), end=(0.2, 0.0, 0.0), radius=0.05, mass=1.0)
    beside = replace(rod, name="b", start=(-0.2, 0.2, 0.01), end=(0.2, 0.2, 0.01))
    for shapes, area, middle in (((rod,), 1, 0.0), ((rod, beside), 2, 0.005), ((rod, rod), 1, 0.0)):
        segment = Segment(name="one", front=0.2, rear=0.2, shapes=shapes)
        found = profile(SimpleNamespace(axis=(segment,)), np.array([0.1, 0.2]))
        assert found.area == pytest.approx(area * np.pi * 0.05**2, rel=2e-3)
        assert found.centre_height == pytest.approx(middle, abs=1e-5)


def test_a_hull_adds_its_volume_its_mass_and_its_height():
    bare = ROBOTS["caiman"]
    foamed = replace(bare, hull=Hull(foam=(Foam(body="pelvis", volume=5e-4, raised=0.02),), density=50.0, air=2e-4))
    assert foamed.mass == pytest.approx(bare.mass + 0.025)
    assert sum(volumes(foamed).values()) == pytest.approx(sum(volumes(bare).values()) + 5e-4)
    table = pieces(foamed)
    assert column(table, "air").sum() == pytest.approx(2e-4)
    mine = column(table, "air")[:, 0] > 0
    own = volumes(bare)["pelvis"]
    assert column(table, "at")[mine, 2] == pytest.approx(0.02 * 5e-4 / (own + 5e-4))


def test_swollen_pieces_keep_their_shape():
    table = pieces(ROBOTS["caiman"])
    out = swell(table, 8.0)
    ball = table[:, 1] == BALL
    assert column(out, "half")[ball] == pytest.approx(2 * column(table, "half")[ball])
    assert column(out, "half")[~ball][:, 2] == pytest.approx(column(table, "half")[~ball][:, 2])
    for name in ("volume", "added"):
        assert column(out, name) == pytest.approx(8 * column(table, name))
    assert column(out, "area")[ball] == pytest.approx(4 * column(table, "area")[ball])
    assert column(out, "area")[~ball] == pytest.approx(8**0.5 * column(table, "area")[~ball])


def test_the_hull_that_floats_has_the_volume_that_it_needs():
    bare = ROBOTS["caiman"]
    hull = float_hull(bare, freeboard_fraction=0.2)
    whole = replace(bare, hull=hull)
    assert whole.mass / 1000.0 / sum(volumes(whole).values()) == pytest.approx(0.8, rel=1e-12)
    light = {body for body, mass in masses(bare).items() if mass / 800.0 <= volumes(bare)[body]}
    assert light.isdisjoint(one.body for one in hull.foam)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda r: float_hull(r, freeboard_fraction=0.95), "above is 0.95; 0 to 0.9 is allowed"),
        (lambda r: float_hull(r, freeboard_fraction=0.88), "more than three times as thick"),
        (lambda r: float_hull(replace(r, hull=float_hull(r))), "has a hull; take it off"),
        (lambda r: float_hull(ROBOTS["pleurobot"]), "without any foam: ask for a greater share"),
        (lambda r: Foam(body="pelvis", volume=-1.0), "volume is -1 m3"),
        (lambda r: Hull(foam=(Foam(body="a", volume=1e-4), Foam(body="a", volume=1e-4))), "names a more than once"),
        (
            lambda r: pieces(replace(r, hull=Hull(foam=(Foam(body="wing", volume=1e-4),)))),
            "no such body; it has pelvis",
        ),
        (
            lambda r: pieces(replace(r, hull=Hull(foam=(Foam(body="pelvis", volume=1e-4),), air=2e-4))),
            "at most all of it can be a bladder",
        ),
    ],
)
def test_impossible_hulls_are_refused(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make(ROBOTS["caiman"])


def test_a_packed_table_has_room():
    table = pieces(ROBOTS["caiman"])
    row = pack_table(table, 1.0, len(table) + LANES)
    assert len(row) == len(pack_table(table, 1.0)) + LANES * table.shape[1]
    assert row[1] == len(table)
    assert unpack_table(row)[:, :-1] == pytest.approx(table[:, :-1], abs=0.0)
