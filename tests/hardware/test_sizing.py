"""Which servos that are sold are enough: what a servo bears, and families that do, need longer periods, or do not."""

from dataclasses import replace
from math import inf, isnan, radians

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from suchus.core.errors import InvalidDesign, UnknownName, UnsuitedRobot
from suchus.hardware import cases, loads_of_cases, share_at_limit, size, with_better, with_motors
from suchus.hardware.loads import FULL_WOUND, measure_loads, torque_use
from suchus.hardware.parts import sheet
from suchus.hardware.sizing import FACTORS, does, families_of, link_loads, places, use
from suchus.robot.design import Servo, layout, servo_names, with_servos
from suchus.robot.design.motor import COPPER
from suchus.robot.gaits import GAITS
from suchus.robot.motors import motor
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Limp

STS = motor("STS3250")


@pytest.fixture(scope="module")
def bought(robot):
    return with_servos(robot, lambda servo: Servo.from_motor(STS, template=servo))


@pytest.fixture(scope="module")
def quick():
    return replace(GAITS["limbs_only"], name="quick", period=0.8)


def made(robot, torque, speed, target=0.0):
    """Return a record in which all servos give torques at speeds, shape (time,)."""
    count = len(torque)
    names = list(servo_names(robot))

    def each(values):
        return (("time", "servo"), np.repeat(np.broadcast_to(values, count)[:, None], len(names), axis=1))

    torque, speed = np.broadcast_to(torque, count), np.broadcast_to(speed, count)
    use = np.abs(torque) / robot.servo("LF_yaw").available_torque(np.sign(torque) * speed)
    data = {
        "servo_velocity": each(speed), "servo_mean_torque": each(torque), "servo_mean_square_torque": each(torque**2),
        "servo_power": each(torque * speed), "servo_absolute_power": each(np.abs(torque * speed)),
        "servo_peak_torque": each(np.abs(torque)), "servo_torque_use": each(use),
    }  # fmt: skip
    data |= {"servo_target": each(target), "servo_angle": each(0.0)}
    return xr.Dataset(data, coords={"servo": names, "time": 1.0 + 0.01 * np.arange(count)}, attrs={"step": 0.002})


def test_a_servo_is_at_its_limit_in_the_periods_in_which_it_uses_all_of_its_torque(bought):
    servo = bought.servo("LF_yaw")
    speed = 3.0
    given = float(servo.available_torque(np.array(speed)))
    full = made(bought, np.r_[np.full(2, given), np.full(48, 0.9 * given)], np.full(50, speed))
    assert float(share_at_limit(bought, full).sel(servo="LF_yaw")) == pytest.approx(2 / 50)
    assert torque_use(servo, np.full(50, 0.5 * given), np.full(50, speed)) == pytest.approx(0.5)


def test_currents_and_heat_follow_from_torque_and_speed(bought):
    servo, heat = bought.servo("LF_yaw"), STS.heat
    stalled = measure_loads(bought, made(bought, np.full(50, servo.torque), np.zeros(50)))["LF_yaw"]
    assert stalled.current == stalled.peak_current == pytest.approx(STS.idle_current + STS.stall_current)
    assert stalled.steady == inf
    rated = measure_loads(bought, made(bought, np.full(50, STS.continuous_torque), np.zeros(50)))["LF_yaw"]
    assert rated.rms == pytest.approx(STS.continuous_torque)
    assert rated.steady == pytest.approx(STS.temperature_limit)
    turning = measure_loads(bought, made(bought, np.full(50, 1.0), np.full(50, 2.0)))["LF_yaw"]
    assert turning.power == pytest.approx(2.0)
    electric = servo.winding.volts * (turning.current - STS.idle_current)
    assert electric > turning.power  # a motor takes more than it gives
    braking = measure_loads(bought, made(bought, np.full(50, -0.1), np.full(50, 2.0)))["LF_yaw"]
    assert braking.current == pytest.approx(STS.idle_current)  # nothing is given back
    assert braking.power == 0.0
    hot = measure_loads(bought, made(bought, np.full(50, 1.5 * STS.continuous_torque), np.zeros(50)))["LF_yaw"]
    loss = STS.volts * STS.stall_current * (1.5 * STS.continuous_torque / STS.stall_torque) ** 2

    def warms(_, warm):
        return (loss * (1 + COPPER * warm) - warm / heat.resistance) / heat.capacity

    def reached(_, warm):
        return warm[0] - (heat.limit - heat.ambient)

    reached.terminal = True
    found = solve_ivp(warms, (0, 1e4), [0.0], events=reached, rtol=1e-10)
    assert hot.warm_after == pytest.approx(float(found.t_events[0][0]), rel=1e-6)
    cooler = measure_loads(bought, made(bought, np.full(50, 0.999 * STS.continuous_torque), np.zeros(50)))
    assert cooler["LF_yaw"].warm_after == inf


def test_a_servo_without_a_winding_has_no_current_and_no_heat(former):
    robot = former
    load = measure_loads(robot, made(robot, np.full(9, 1.0), np.zeros(9)))["tail_cable"]
    assert isnan(load.current)
    assert isnan(load.steady)
    assert load.tension == pytest.approx(1.0 / robot.tail.pulley)
    assert isnan(measure_loads(robot, made(robot, np.full(9, 1.0), np.zeros(9)))["LF_yaw"].tension)


def test_cases_are_gaits_slopes_faults_standing_and_a_swim(robot, crawl_gait):
    found = cases(robot, [crawl_gait], slopes=[radians(5)], faults=[Limp("LF_yaw")], standing=True)
    assert [case.name for case in found] == [
        "belly_crawl",
        "belly_crawl, 5 degrees uphill",
        "belly_crawl, limp LF_yaw",
        "standing up",
    ]
    assert found[0].end == pytest.approx(9.0)
    assert found[0].slower(2.0).end == pytest.approx(17.0)
    assert found[3].end > 9.0
    (_, swim) = cases(ROBOTS["floating_caiman"], [crawl_gait], water=True)
    assert (swim.name, swim.lake.state_at(0.0)[0]) == ("swimming", ROBOTS["floating_caiman"].length)
    with pytest.raises(UnsuitedRobot, match="strider"):
        cases(ROBOTS["strider"], [GAITS["tripod"]], standing=True)


@pytest.mark.parametrize("name", ["caiman", "strider", "salamandra", "swimmer"])
def test_left_and_right_limbs_get_equal_servos(name):
    body = ROBOTS[name]
    found = places(body)
    assert sorted(one for names in found for one in names) == sorted(layout(body).servos)
    limbs = {one for limb in layout(body).limbs for one in layout(body).servos[limb.servos]}
    assert all(len(names) == (2 if names[0] in limbs else 1) for names in found)
    chosen = dict.fromkeys(layout(body).servos, STS)
    made = with_motors(body, chosen, 11.0)
    assert {made.servo(one).winding.motor for one in layout(body).servos} == {"STS3250"}
    assert {made.servo(one).winding.volts for one in layout(body).servos} == {11.0}


WEAK = replace(STS, name="weak", family="mine", stall_torque=1.2, continuous_torque=0.4, price=(5.0, 5.0))
GOOD = replace(STS, name="good", family="mine", price=(50.0, 50.0))
HOT = replace(GOOD, name="hot", family="hot", continuous_torque=0.05)
SLOW = replace(GOOD, name="slow", family="slow", no_load_speed=2.0)
POOR = replace(WEAK, name="poor", family="poor", stall_torque=0.05, continuous_torque=0.05)


def sized(robot, quick, *sold):
    """Return what servos are enough, of some that are sold."""
    return size(robot, cases(robot, [quick]), motors={one.name: one for one in sold})


def by_name(sized):
    return {family.name: family for family in sized.families}


def test_each_place_gets_the_cheapest_servo_that_does_by_simulation(robot, quick):
    found = sized(robot, quick, WEAK, GOOD)
    family = by_name(found)["mine"]
    assert family.as_asked
    assert {one.name for one in family.chosen.values()} == {"weak", "good"}
    assert found.best is family
    assert found.slower is None
    (walk,) = family.loads.values()
    assert all(does(family.chosen[name], load) for name, load in walk.items())
    assert family.price[0] == sum(one.price[0] for one in family.chosen.values())
    order = [most for _, _, most in family.binding()]
    assert order == sorted(order, reverse=True)
    assert order[0] == use(family.chosen[family.binding()[0][0]], walk[family.binding()[0][0]])
    # one step cheaper and it does no more
    weaker = dict.fromkeys(family.chosen, WEAK)
    (again,) = loads_of_cases(with_motors(robot, weaker, 12.0), cases(robot, [quick]))
    assert not all(does(WEAK, load) for load in again.values())


def test_a_slow_family_does_with_a_longer_period_and_a_hot_or_weak_one_does_not(robot, quick):
    found = sized(robot, quick, replace(GOOD, price=(90.0, 90.0)), SLOW, HOT, POOR)
    slow, hot, poor = (by_name(found)[name] for name in ("slow", "hot", "poor"))
    assert found.best.as_asked
    assert found.slower is slow
    assert slow.passes
    assert not slow.as_asked
    assert slow.factors["quick"] in FACTORS[1:]
    assert not hot.passes
    assert "0.05" not in hot.lacking.split("asks for")[0]
    assert "none of it is enough for" in hot.lacking
    assert "none of it is enough for" in poor.lacking
    assert poor.loads == {}
    names = [family.name for family in found.families]
    assert names.index("mine") < names.index("slow") < min(names.index("hot"), names.index("poor"))


def test_a_servo_heavier_than_its_link_is_refused_and_so_are_servos_that_outweigh_it_together(robot, quick):
    heavy = replace(GOOD, name="heavy", family="heavy", mass=0.16)  # the femur is simulated with 0.15 kg
    many = replace(GOOD, name="many", family="many", mass=0.11)  # seven of them sit on a pelvis of 0.75 kg
    light = replace(heavy, name="light", family="heavy and light", mass=0.05, price=(90.0, 90.0))
    mixed = replace(heavy, name="mixed", family="heavy and light")
    found = by_name(sized(robot, quick, heavy, many, light, mixed))
    assert "heavy of LF_knee weighs 160 g, and LF_femur, on which it sits, 150 g" in found["heavy"].lacking
    assert found["heavy"].loads == {}
    assert "its servos on pelvis weigh 770 g, and pelvis with all that is on it 750 g" in found["many"].lacking
    chosen = found["heavy and light"].chosen
    assert chosen["LF_knee"].name == "light"
    assert chosen["spine_yaw_1"].name == "mixed"  # cheaper, and spine and pelvis bear it


def test_loads_of_links_are_those_of_the_building_sheet(bought):
    budgets = {budget.name: budget for budget in sheet(bought).bodies}
    loads = link_loads(bought, dict.fromkeys(layout(bought).servos, STS))
    assert sum(load.servos for load in loads) == pytest.approx(19 * STS.mass)
    for load in loads:
        assert load.servos == pytest.approx(budgets[load.body].servos)
        assert load.mass == pytest.approx(budgets[load.body].simulated)
    fills = [load.servos / load.mass for load in loads]
    assert fills == sorted(fills, reverse=True)
    assert loads[0].body == "pelvis"


def test_a_family_whose_servos_do_not_bear_one_supply_is_refused(robot, quick):
    odd = replace(GOOD, name="odd", volts=24.0, volts_range=(20.0, 28.0))
    with pytest.raises(InvalidDesign, match=r"family 'mine' has a supply of 24 V, and good bears 6 to 12\.6 V"):
        families_of({"good": GOOD, "odd": odd})
    with pytest.raises(UnknownName, match="family of servos"):
        size(robot, cases(robot, [quick]), family="nobody's")


def test_a_servo_at_its_limit_is_told_the_cheapest_one_that_does_and_a_strong_one_nothing(former, quick):
    weak = with_servos(former, lambda servo: replace(servo, torque=0.25) if servo.torque == 3.0 else servo)
    (case,) = cases(weak, [quick])
    (before,) = loads_of_cases(weak, [case])
    assert any(load.at_limit > 0.02 for load in before.values())
    after = with_better(weak, case, before, {"good": GOOD, "poor": POOR})
    for load in after.values():
        assert load.other == ("good" if load.at_limit > 0.02 else "")
    none = with_better(weak, case, before, {"poor": POOR})
    assert all(load.other == "" for load in none.values())
    assert FULL_WOUND < 1.0
