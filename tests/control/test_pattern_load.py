"""One drive in water and on land: what the load that is felt adds to it."""

from math import radians, sin

import numpy as np
import pytest
from tests.felt import felt as feels

from suchus.core.errors import InvalidDesign
from suchus.robot.control import LoadRule, PatternGenerator
from suchus.robot.control.pattern_load import LoadDrive
from suchus.robot.design import GRAVITY
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Lake, Run, simulate

ROBOT = ROBOTS["floating_caiman"]
WEIGHT = ROBOT.mass * GRAVITY


def felt(feet, belly=0.0, tail=0.0, runs=1):
    """Return readings in which these shares of the weight are carried, in so many runs alike."""
    return feels(
        ROBOT,
        runs,
        foot_pressure=WEIGHT * feet / 4,
        belly_pressure=WEIGHT * belly / len(feels(ROBOT).belly_pressure[0]),
        tail_pressure=WEIGHT * tail,
    )


@pytest.mark.parametrize(("feet", "belly", "tail", "drive"), [
    (0.0, 0.0, 0.0, 2.0), (0.01, 0.0, 0.0, 1.0), (0.0, 0.01, 0.005, 0.5), (0.02, 0.0, 0.0, 0.0), (0.7, 0.2, 0.1, 0.0),
])  # fmt: skip
def test_the_drive_grows_as_the_load_goes(feet, belly, tail, drive):
    one = LoadDrive([LoadRule(memory=0.0)], [ROBOT], 0.01)
    assert one.drive == pytest.approx([0.0])  # as on land, before anything is felt
    one.feel(felt(feet, belly, tail))
    assert one.drive == pytest.approx([drive], abs=1e-9)


def test_the_load_goes_through_a_low_pass():
    one = LoadDrive([LoadRule(memory=0.4)], [ROBOT], 0.01)
    for _ in range(40):
        one.feel(felt(0.0))
    assert one.load == pytest.approx([np.exp(-1.0)], rel=0.02)


def test_who_has_no_rule_gets_nothing():
    both = LoadDrive([None, LoadRule(memory=0.0)], [ROBOT, ROBOT], 0.01)
    both.feel(felt(0.0, runs=2))
    assert both.drive == pytest.approx([0.0, 2.0])
    assert not LoadDrive([None], [ROBOT], 0.01).has_feedback
    assert PatternGenerator(load=LoadRule()).feels
    assert not PatternGenerator().feels


def test_one_drive_swims_in_water_and_walks_on_land():
    slope, line = radians(8), 1.35

    def gone(rules, duration, **where):
        control = [PatternGenerator(drive=2.0, load=rule) for rule in rules]
        runs = [Run(robot=ROBOT, gait="belly_crawl", control=one, **where) for one in control]
        return simulate(runs, duration=duration, sample_stride=5)

    def change(values, start, end):
        return float(values[round(end / 0.05)] - values[round(start / 0.05)])

    water = {"ground": Ground(uphill=slope), "lake": Lake(level=line * sin(slope))}
    record, unfelt = gone([LoadRule()], 9.0, **water).isel(run=0), gone([None], 3.6, **water).isel(run=0)
    dry = gone([LoadRule(), None], 2.0)
    clock, x = record.limb_phase[:, 0].values, record.centre_of_mass[:, 0].values
    carried = record.foot_force.sum("leg") + record.belly_force.sum("segment") + record.tail_force
    load = carried.sel(xyz="z").values / WEIGHT
    # afloat nothing is felt: the limbs are silent and it swims; the same drive without the rule paddles on
    assert load[round(2.5 / 0.05) : round(3.5 / 0.05)].max() < 0.02
    assert change(clock, 2.5, 3.5) == pytest.approx(0.0, abs=1e-6)
    assert change(unfelt.limb_phase[:, 0].values, 2.5, 3.5) == pytest.approx(0.25, rel=0.05)
    assert change(x, 2.5, 3.5) > 0.06 > 2 * change(unfelt.centre_of_mass[:, 0].values, 2.5, 3.5)
    # on the ground it walks, at the gait's own pace
    assert load[round(7.5 / 0.05) :].mean() > 0.1
    assert change(clock, 7.5, 9.0) == pytest.approx(0.25 * 1.5, rel=0.05)
    assert change(x, 7.5, 9.0) > 0.04
    # on dry land the rule changes nothing: what changes is the load alone
    assert np.array_equal(dry.servo_target[0], dry.servo_target[1])


@pytest.mark.parametrize(("change", "message"), [
    ({"afloat": -1.0}, "load_rule.afloat is -1"),
    ({"touch": 0.0}, "load_rule.touch is 0"),
    ({"memory": float("nan")}, "load_rule.memory is nan"),
])  # fmt: skip
def test_bad_rules_are_refused(change, message):
    with pytest.raises(InvalidDesign, match=message):
        LoadRule(**change)
