"""Form drag and friction by their sources: exact shapes, the ends of the ranges, and what a model makes of them."""

from math import log10, pi

import numpy as np
import pytest

from suchus.core.errors import OutsideLimits
from suchus.robot.design.drawing import Drawing
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline, Water, cruise, resistive, swim_of
from suchus.swimming.water.form_drag import (
    FOOT_DRAG,
    LIMB_DRAG,
    MIN_TURBULENT_REYNOLDS,
    form_drag,
    friction_ends,
    resist_form,
)

ROD = Drawing(
    name="rod", length=0.5, mass=pi * 0.02 * 0.02 * 0.5 * 1000.0, stations=(0.0, 1.0), half_width=(0.04, 0.04),
    half_height=(0.04, 0.04), joints=(0.5,), density=1000.0,
)  # fmt: skip


@pytest.mark.parametrize("reynolds", [1e3, 1e5, 1e6])
def test_friction_is_that_of_a_laminar_and_of_a_turbulent_plate(reynolds):
    ends = friction_ends(1.0, 1.0, 1.0 / reynolds)
    assert ends.laminar == pytest.approx(1.328 / reynolds**0.5)
    line = 0.075 / (log10(reynolds) - 2.0) ** 2
    assert ends.turbulent == pytest.approx(line if reynolds > MIN_TURBULENT_REYNOLDS else ends.laminar)
    assert Water(viscosity=1.0 / reynolds, thickening=1.0).friction(1.0, 1.0) >= 0.99 * ends.laminar


def test_no_layer_without_a_reynolds_number():
    with pytest.raises(OutsideLimits, match=r"Reynolds number of a plate is 0\.5"):
        friction_ends(0.5, 1.0, 1.0)


def test_a_rod_has_the_drag_of_its_ends_and_no_limbs():
    drag = form_drag(ROD.robot(), 1.0)
    section = pi * 0.02**2
    assert drag.head.value == pytest.approx(0.1 * section, rel=0.08)
    assert drag.limbs == (0.0, 0.0, 0.0)
    assert 0.0 < drag.base.low < drag.base.value < drag.base.high < 0.2 * section
    assert form_drag(ROD.robot(), 2.0).base.high > drag.base.high  # less friction ahead, more drag of the end
    assert drag.total.value == pytest.approx(drag.head.value + drag.base.value)


@pytest.mark.parametrize("name", ["caiman", "salamander"])
def test_limbs_are_rods_along_the_stream_that_end_in_a_ball(name):
    robot = ROBOTS[name]
    drag = form_drag(robot, 0.3)
    limbs = [girdle.limb for girdle in robot.girdles]
    for k, (rod, foot) in enumerate(zip(LIMB_DRAG, FOOT_DRAG, strict=True)):
        areas = [rod * max(link.radius for link in limb.links) ** 2 + foot * limb.foot.radius**2 for limb in limbs]
        assert drag.limbs[k] == pytest.approx(2.0 * pi * sum(areas))
    assert drag.limbs.low < drag.limbs.value < drag.limbs.high


def test_a_model_with_form_drag_swims_slower():
    robot = ROBOTS["floating_caiman"]
    outline, motion, water = Outline(robot), swim_of(robot, frequency=1.0), Water()
    area = form_drag(robot, 0.2).total.value
    free = cruise(outline, motion, resistive, water)
    slower = cruise(outline, motion, resist_form(resistive, area), water)
    assert 0.0 < slower.speed < 0.97 * free.speed
    assert cruise(outline, motion, resist_form(resistive, 0.0), water).speed == pytest.approx(free.speed)
    assert np.isfinite(slower.power)
