"""A form of a body: nothing by default, what tapers sheds, and drag of head, blunt end and limbs."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign
from suchus.core.water_table import column
from suchus.robot.design import BodyForm
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.form import NOSE_DRAG, formed, shed_momenta
from suchus.robot.design.pieces import pieces
from suchus.robot.motion.swim import swimming_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.lake import lake_text

FISH = Drawing(
    name="fish", length=0.4, mass=0.2, density=998.0, stations=(0.0, 0.1, 0.6, 1.0),
    half_width=(0.02, 0.04, 0.04, 0.02), half_height=(0.02, 0.05, 0.05, 0.02), joints=(0.35, 0.6, 0.8),
)  # fmt: skip
FINNED = replace(
    FISH, name="finned", stations=(0.0, 0.1, 0.5, 0.8, 1.0), half_width=(0.02, 0.04, 0.04, 0.02, 0.02),
    half_height=(0.02, 0.05, 0.05, 0.02, 0.08),
)  # fmt: skip


def momenta(robot):
    table = pieces(robot)
    last = int(np.flatnonzero(column(table, "shed")[:, 0])[-1])
    return pi * column(table, "half")[: last + 1, 1] ** 2


@pytest.mark.parametrize("name", ["caiman", "floating_caiman", "swimmer", "salamander"])
def test_the_default_form_is_the_table_as_it_is(name):
    table = pieces(ROBOTS[name])
    np.testing.assert_allclose(formed(table, BodyForm()), table, rtol=1e-12, atol=0.0)


def test_what_tapers_sheds_its_share_where_it_is_lost():
    robot = FISH.robot()
    momentum = momenta(robot)
    shed = shed_momenta(pieces(robot), BodyForm(edge_shedding=0.8, taper_shedding=0.5))
    assert shed[-1] == pytest.approx(0.8 * momentum[-1])
    greatest = momentum[len(momentum) // 2 :].max()
    assert shed[:-1].sum() == pytest.approx(0.5 * (greatest - momentum[-1]))
    assert shed[: len(shed) // 2].max() == 0.0
    assert np.count_nonzero(shed) > 5
    table = formed(pieces(robot), BodyForm(taper_shedding=0.5))
    sheds = np.flatnonzero(column(table, "shed")[:, 0])
    assert np.array_equal(column(table, "shed_at")[sheds, 0], -column(table, "half")[sheds, 2])
    assert np.array_equal(column(table, "shed")[:, 1], column(pieces(robot), "shed")[:, 1])


def test_a_fin_that_rises_sheds_at_its_edge_alone():
    """Momentum that a narrow stalk loses is the fin's again."""
    robot = FINNED.robot()
    shed = shed_momenta(pieces(robot), BodyForm(taper_shedding=1.0))
    assert np.flatnonzero(shed).tolist() == [len(shed) - 1]


def test_head_blunt_end_and_limbs_have_drag_areas():
    robot = ROBOTS["salamander"]
    plain = column(pieces(robot), "end")[:, 0]
    form = BodyForm(head_drag=0.3, base_drag=0.2, limb_drag=0.5)
    more = column(formed(pieces(robot), form), "end")[:, 0] - plain
    half = column(pieces(robot), "half")
    last = int(np.flatnonzero(column(pieces(robot), "shed")[:, 0])[-1])
    assert more[0] == pytest.approx((0.3 / NOSE_DRAG - 1.0) * plain[0])
    assert more[last] == pytest.approx(0.2 * pi * half[last, 0] * half[last, 1])
    limbs = [girdle.limb for girdle in robot.girdles]
    rods = 2.0 * sum(pi * max(link.radius for link in limb.links) ** 2 for limb in limbs)
    assert more[last + 1 :].sum() == pytest.approx(0.5 * rods)
    assert np.count_nonzero(more[last + 1 :]) == 2 * len(limbs)


@pytest.mark.parametrize(("name", "value"), [("head_drag", -0.1), ("limb_drag", 11.0), ("taper_shedding", 2.1)])
def test_a_form_refuses_coefficients_out_of_range(name, value):
    with pytest.raises(InvalidDesign, match=f"form.{name}"):
        BodyForm(**{name: value})


def fish_run(lake, amplitude):
    """Return the run of a fish whose joints swing by an amplitude [rad]."""
    robot = FISH.robot()
    gait = swimming_gait(robot, name="wave", frequency=2.0, amplitude=3 * (amplitude,), lag=(0.0, 0.25, 0.5))
    return Run(robot=robot, gait=gait, lake=lake)


def test_a_lake_gives_the_form_to_the_runs_that_have_it():
    stream = Lake(level=1.0, current=(0.5, 0.0))
    forms = (None, BodyForm(), BodyForm(head_drag=2.0), BodyForm(base_drag=10.0))
    drifting = [replace(fish_run(replace(stream, form=form), 0.0), label=str(i)) for i, form in enumerate(forms)]
    still = Lake(level=1.0)
    swimming = [
        replace(fish_run(replace(still, form=form), 0.4), label=str(i))
        for i, form in enumerate((None, BodyForm(taper_shedding=0.8)))
    ]
    x = simulate([*drifting, *swimming], duration=2.0).centre_of_mass.sel(xyz="x")
    plain, same, blunt, base, swum, shedding = (float(way) for way in (x.isel(time=-1) - x.isel(time=0)).values)
    assert same == pytest.approx(plain, rel=1e-9)
    assert min(blunt, base) > 1.2 * plain > 0.0
    assert shedding > 1.05 * swum > 0.0
    alone = simulate([drifting[2]], duration=2.0).centre_of_mass.sel(xyz="x").isel(run=0)
    assert float(alone[-1] - alone[0]) == pytest.approx(blunt, rel=1e-6)
    assert '"form"' not in lake_text(still)
    assert '"head_drag": 2.0' in lake_text(drifting[2].lake)
