"""Between water and land: what is felt, when it changes, and how the postures go into each other."""

from dataclasses import replace

import numpy as np
import pytest
from tests.felt import felt as feels
from tests.start_batch import start_batch
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign
from suchus.robot.control import Amphibious, HeadingHold, HeadingRule, Sensed, Swimming
from suchus.robot.control.holding import DepthHold
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS
from suchus.robot.motion import LIMBS_UP, START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate

ROBOT, PERIOD = ROBOTS["floating_caiman"], 0.01
WAVE = crocodile_swim(limbs=LIMBS_UP)
WAY = Amphibious(swim=WAVE, memory=0.1, change=0.5, patience=0.2)
GAIT = GAITS["low_crawl"]
BEGIN = round(START / PERIOD)


def twice(felt):
    """The same felt by two robots."""
    both = {name: np.repeat(getattr(felt, name), 2, axis=0) for name in Sensed.__dataclass_fields__ if name != "time"}
    return Sensed(time=felt.time, **both)


def sensed(load, robot=ROBOT, yaw=0.0, feet=1 / 3):
    """What a robot feels whose feet, belly and tail carry a share of its weight, belly and tail alike."""
    weight = load * robot.mass * 9.81
    part = weight * (1 - feet) / 2
    return feels(
        robot,
        foot_pressure=weight * feet / 4,
        belly_pressure=part / len(layout(robot).trunk),
        tail_pressure=part,
        orientation=[np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)],
    )


def begun(way=WAY, load=0.0, gait=GAIT):
    machine = start_batch(way, [ROBOT], [gait], [0], 3000, PERIOD)
    machine.rest()
    for tick in range(BEGIN):
        machine.command(tick, sensed(load))
    return machine


def feel(machine, loads, tick=BEGIN, feet=1 / 3):
    """Return whether it walks, for each of the loads, and the last command."""
    found = []
    for i, load in enumerate(loads):
        command = machine.command(tick + i, sensed(load, feet=feet))
        found.append(bool(machine.walking[0]))
    return found, command


@pytest.mark.parametrize(("load", "walks"), [(0.0195, False), (0.0205, True)])
def test_it_walks_from_the_load_of_touching_on(load, walks):
    assert feel(begun(), [load] * 100)[0][-1] is walks


@pytest.mark.parametrize(("share", "walks"), [(0.0205, True), (0.0195, False)])
def test_it_walks_until_its_feet_carry_almost_nothing(share, walks):
    machine = begun(replace(WAY, begins="walking"), load=1.0)
    assert feel(machine, [1.0] * 5)[0][-1]
    assert feel(machine, [share] * 300, feet=1.0)[0][-1] is walks


def test_a_tail_and_a_belly_that_drag_on_the_bottom_do_not_walk():
    machine = begun(replace(WAY, begins="walking"), load=1.0)
    walks = feel(machine, [0.3] * 240, feet=0.0)[0]
    assert walks[0]
    assert not walks[-1]


@pytest.mark.parametrize(("empty", "walks"), [(180, True), (220, False)])
def test_its_feet_must_be_empty_for_a_whole_cycle(empty, walks):
    machine = begun(replace(WAY, begins="walking", memory=0.0), load=1.0)
    assert feel(machine, [1.0] * 5 + [0.0] * empty + [1.0] * 10)[0][-11] is walks
    assert GAIT.period == 2.0


def test_in_between_it_goes_on_as_before():
    swims, walks = begun(), begun(replace(WAY, begins="walking"), load=1.0)
    assert not feel(swims, [0.019] * 200)[0][-1]
    assert feel(walks, [0.025] * 400, feet=0.9)[0][-1]


def test_a_load_that_flickers_changes_it_no_more_often_than_its_patience():
    loads = np.tile(np.repeat([0.5, 0.0], 30), 12)  # 0.3 s each
    quick = replace(GAIT, period=0.2)  # so that its feet are empty for a whole cycle
    machine = begun(replace(WAY, memory=0.0, change=0.5, patience=1.0), gait=quick)
    walks, _ = feel(machine, loads)
    changes = np.flatnonzero(np.diff(np.array(walks, dtype=int)))
    assert len(changes) > 3
    assert np.diff(changes).min() * PERIOD >= 1.5 - 1e-9


def test_a_touch_shorter_than_the_memory_is_not_felt():
    assert not any(feel(begun(replace(WAY, memory=0.4)), [0.0] * 100 + [0.1] * 5 + [0.0] * 100)[0])
    assert any(feel(begun(replace(WAY, memory=0.0)), [0.0] * 100 + [0.1] * 5 + [0.0] * 100)[0])


def test_limbs_step_only_while_it_walks_and_postures_go_over_without_a_jump():
    machine = begun()
    swims = start_batch(Swimming(), [ROBOT], [WAVE], [0], 3000, PERIOD)
    before, last, phases = [], None, []
    for tick in range(BEGIN, BEGIN + 300):
        command = machine.command(tick, sensed(0.0 if tick < BEGIN + 100 else 0.5))
        phases.append(command.phase[0, 0])
        if tick < BEGIN + 100:
            assert np.array_equal(command.targets, swims.command(tick, None).targets)
        if last is not None:
            before.append(np.abs(command.targets - last).max())
        last = command.targets.copy()
    moves = np.diff(phases) > 0
    first = int(np.argmax(moves))
    assert not moves[:first].any()
    assert moves[first:].all()
    assert first * PERIOD == pytest.approx(1.0 + 0.5, abs=0.06)
    assert max(before) < 0.1


def test_when_it_walks_it_walks_the_gait():
    machine = begun(replace(WAY, begins="walking"), load=1.0)
    _, command = feel(machine, [1.0] * 250)
    walked = GAITS["low_crawl"]
    expected = simulate([Run(robot=ROBOT, gait=walked)], duration=0.02).servo_target  # its posture at rest
    assert machine._phase[0] == pytest.approx(np.array(walked.limb_phases) + 2.5 / walked.period, abs=0.01)
    other = start_batch(WAY, [ROBOT], [walked], [0], 10, PERIOD).rest()
    rest = start_batch(replace(WAY, begins="walking"), [ROBOT], [walked], [0], 10, PERIOD).rest()
    limbs = slice(0, 12)
    assert rest[0, limbs] == pytest.approx(expected[0, 0].values[limbs], abs=0.7)
    assert np.abs(other[0, limbs] - expected[0, 0].values[limbs]).max() > 0.9
    assert np.isfinite(command.targets).all()


def test_it_lets_air_out_while_it_lands_as_fast_as_the_pump_goes():
    machine = begun(replace(WAY, air_released=0.5, pump=0.5))
    _, swam = feel(machine, [0.0] * 100)
    _, soon = feel(machine, [0.7] * 60, BEGIN + 100)
    _, lands = feel(machine, [0.7] * 100, BEGIN + 160)
    assert machine.landing[0]
    _, landed = feel(machine, [0.9] * 200, BEGIN + 260)
    assert not machine.landing[0]
    assert swam.air_fraction[0].tolist() == [1.0, 1.0]
    assert 0.5 < soon.air_fraction[0, 0] < 1.0
    assert soon.air_fraction[0, 1] == soon.air_fraction[0, 0]
    assert lands.air_fraction[0] == pytest.approx(0.5)
    assert landed.air_fraction[0] == pytest.approx(1.0)


def test_it_takes_its_air_in_when_it_is_carried_off():
    machine = begun(replace(WAY, air_released=0.5, pump=0.5))
    _, lands = feel(machine, [0.5] * 300)
    walks, swims = feel(machine, [0.0] * 500, BEGIN + 300)
    assert lands.air_fraction[0] == pytest.approx(0.5)
    assert not walks[-1]
    assert swims.air_fraction[0] == pytest.approx(1.0)


def test_it_wades_until_it_has_landed_and_then_walks_its_gait():
    wade = GAITS["semi_erect"]
    plain, wading = begun(), begun(replace(WAY, wade=wade))
    other = begun(gait=wade)
    loads = [0.5] * 200
    _, same = feel(other, loads)
    _, wades = feel(wading, loads)
    assert wades.targets == pytest.approx(same.targets)
    assert wades.phase == pytest.approx(same.phase)
    feel(plain, loads)
    _, walks = feel(plain, [1.0] * 1200, BEGIN + 200)
    _, late = feel(wading, [1.0] * 1200, BEGIN + 200)
    place = (wading._phase - plain._phase)[0, 0]
    assert wading._phase[0] - place == pytest.approx(plain._phase[0])
    again = feel(wading, [1.0] * round((1.0 - place % 1.0) * GAIT.period / PERIOD), BEGIN + 1400)[1]
    assert again.targets == pytest.approx(walks.targets, abs=0.02)
    assert np.abs(late.targets - walks.targets).max() > 0.05 or place % 1.0 < 0.02


def test_a_robot_that_begins_on_land_walks_its_gait_and_keeps_its_air():
    way = replace(WAY, begins="walking", wade=GAITS["semi_erect"], air_released=1.0)
    plain, wading = (begun(one, load=1.0) for one in (replace(WAY, begins="walking"), way))
    _, one = feel(plain, [1.0] * 100)
    _, two = feel(wading, [1.0] * 100)
    assert np.array_equal(one.targets, two.targets)
    assert two.air_fraction[0].tolist() == [1.0, 1.0]


def test_an_air_fraction_that_is_commanded_reaches_the_water():
    way = replace(WAY, touch=0.0, memory=0.0, change=0.05, patience=0.0, air_released=1.0, pump=100.0)
    runs = [Run(robot=ROBOT, gait=GAIT, lake=Lake(level=0.06), control=one) for one in (WAY, way)]
    record = simulate(runs, duration=START + 0.8)
    assert record.air_fraction.min("time").values == pytest.approx([1.0, 0.0])


def test_what_others_of_its_batch_do_changes_nothing():
    """The direction is felt from the beginning on, and what stays of its error adds up only while it walks."""
    way = replace(WAY, heading=HeadingRule())
    alone = start_batch(way, [ROBOT], [GAIT], [0], 3000, PERIOD)
    both = start_batch([way, replace(way, begins="walking")], [ROBOT] * 2, [GAIT] * 2, [0, 0], 3000, PERIOD)
    rng = np.random.default_rng(0)
    for tick in range(0, 260):
        felt = sensed(0.0 if tick < 150 else 0.5, yaw=0.3 + 0.1 * rng.random())
        one = alone.command(tick, felt)
        two = both.command(tick, twice(felt))
        assert two.targets[0] == pytest.approx(one.targets[0], abs=1e-9), tick
    swam = start_batch(way, [ROBOT], [GAIT], [0], 3000, PERIOD)
    for tick in range(400):
        swam.command(tick, sensed(0.0, yaw=0.3 * (tick > 0)))
    assert np.abs(swam._heading._steering).max() == 0.0
    assert np.abs(swam._stroke - 1.0).max() == 0.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: replace(WAY, aground=0.02), "aground must be the greatest"),
        (lambda: replace(WAY, afloat=0.9), "aground must be the greatest"),
        (lambda: replace(WAY, air_released=2.0), "air_released is 2"),
        (lambda: replace(WAY, change=0.0), "change is 0 s"),
        (lambda: replace(WAY, swimming=Swimming(depth=DepthHold(depth=1.0))), "leave out swimming.depth"),
        (
            lambda: start_batch(replace(WAY, air_released=0.5), [ROBOTS["caiman"]], [GAIT], [0], 10, PERIOD),
            "no air that it could let out",
        ),
        (lambda: HeadingHold(gain=-1.0), "heading_hold.gain is -1"),
    ],
)
def test_bad_settings_are_refused_in_a_sentence(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make()
