"""Between water and land: what is felt, when it changes, and how the postures go into each other."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.control import Amphibious, HeadingHold, HeadingRule, Joinable, Sensed, Swimming
from suchus.control.holding import DepthHold
from suchus.errors import InvalidDesign
from suchus.gaits import GAITS
from suchus.land import Lake, Run, simulate
from suchus.motion import START, Swim
from suchus.robots import ROBOTS

ROBOT, PERIOD = ROBOTS["floating_caiman"], 0.01
WAVE = Swim(name="wave", frequency=1.0, yaw=(0.36, 0.13, 0.11), yaw_lag=(0.08, -0.11, -0.29), tail=0.75, tail_lag=-0.11)
WAY = Amphibious(swim=Swimming(swim=WAVE), memory=0.1, change=0.5, patience=0.2)
GAIT = GAITS["low_crawl"]
BEGIN = round(START / PERIOD)


def twice(felt):
    """The same felt by two robots."""
    both = {name: np.repeat(getattr(felt, name), 2, axis=0) for name in Sensed.__dataclass_fields__ if name != "time"}
    return Sensed(time=felt.time, **both)


def sensed(load, robot=ROBOT, yaw=0.0):
    """What a robot feels whose feet, belly and tail carry a share of its weight, a third each."""
    part = load * robot.mass * 9.81 / 3
    none = np.zeros((1, 17))
    return Sensed(
        time=0.0,
        servo_position=none,
        servo_velocity=none,
        servo_torque=none,
        foot_pressure=np.full((1, 4), part / 4),
        belly_pressure=np.full((1, 5), part / 5),
        tail_pressure=np.full(1, part),
        orientation=np.array([[np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]]),
        angular_velocity=np.zeros((1, 3)),
        acceleration=np.zeros((1, 3)),
        depth=np.zeros(1),
    )


def begun(way=WAY, load=0.0, gait=GAIT):
    machine = way.start([ROBOT], [gait], [0], 3000, PERIOD)
    machine.rest()
    for tick in range(BEGIN):
        machine.command(tick, sensed(load))
    return machine


def feel(machine, loads, tick=BEGIN):
    """Return whether it walks, for each of the loads, and the last command."""
    found = []
    for i, load in enumerate(loads):
        command = machine.command(tick + i, sensed(load))
        found.append(bool(machine.walking[0]))
    return found, command


@pytest.mark.parametrize(("load", "walks"), [(0.0195, False), (0.0205, True)])
def test_it_walks_from_the_load_of_touching_on(load, walks):
    assert feel(begun(), [load] * 200)[0][-1] is walks


@pytest.mark.parametrize(("load", "walks"), [(0.0041, True), (0.0039, False)])
def test_it_walks_until_the_ground_carries_almost_nothing(load, walks):
    machine = begun(replace(WAY, begins="walking"), load=1.0)
    assert feel(machine, [1.0] * 5)[0][-1]
    assert feel(machine, [load] * 300)[0][-1] is walks


def test_in_between_it_goes_on_as_before():
    swims, walks = begun(), begun(replace(WAY, begins="walking"), load=1.0)
    assert not feel(swims, [0.01] * 200)[0][-1]
    assert feel(walks, [0.01] * 200)[0][-1]


def test_a_load_that_flickers_changes_it_no_more_often_than_its_patience():
    loads = np.tile(np.repeat([0.5, 0.0], 30), 20)  # 0.3 s each
    machine = begun(replace(WAY, memory=0.0, change=0.5, patience=1.0))
    walks, _ = feel(machine, loads)
    changes = np.flatnonzero(np.diff(np.array(walks, dtype=int)))
    assert len(changes) > 3
    assert np.diff(changes).min() * PERIOD >= 1.5 - 1e-9


def test_a_touch_shorter_than_the_memory_is_not_felt():
    assert not any(feel(begun(replace(WAY, memory=0.4)), [0.0] * 100 + [0.1] * 5 + [0.0] * 100)[0])
    assert any(feel(begun(replace(WAY, memory=0.0)), [0.0] * 100 + [0.1] * 5 + [0.0] * 100)[0])


def test_limbs_step_only_while_it_walks_and_postures_go_over_without_a_jump():
    machine = begun()
    swims = Swimming(swim=WAVE).start([ROBOT], [GAIT], [0], 3000, PERIOD)
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
    other = WAY.start([ROBOT], [walked], [0], 10, PERIOD).rest()
    rest = replace(WAY, begins="walking").start([ROBOT], [walked], [0], 10, PERIOD).rest()
    limbs = slice(0, 12)
    assert rest[0, limbs] == pytest.approx(expected[0, 0].values[limbs], abs=0.7)
    assert np.abs(other[0, limbs] - expected[0, 0].values[limbs]).max() > 0.9
    assert np.isfinite(command.targets).all()


def test_it_breathes_out_when_it_walks_and_in_when_it_swims_as_fast_as_the_pump_goes():
    machine = begun(replace(WAY, breathe_out=0.5, pump=0.5))
    _, swam = feel(machine, [0.0] * 100)
    _, soon = feel(machine, [1.0] * 60, BEGIN + 100)
    _, walked = feel(machine, [1.0] * 100, BEGIN + 160)
    _, again = feel(machine, [0.0] * 300, BEGIN + 260)
    assert swam.breath[0] == 1.0
    assert 0.5 < soon.breath[0] < 1.0
    assert walked.breath[0] == pytest.approx(0.5)
    assert again.breath[0] == pytest.approx(1.0)


def test_breath_that_is_commanded_reaches_the_water():
    way = replace(WAY, begins="walking", breathe_out=1.0)
    runs = [Run(robot=ROBOT, gait=GAIT, lake=Lake(level=0.05), control=one) for one in (WAY, way)]
    record = simulate(runs, duration=0.05)
    assert record.breath[:, -1].values == pytest.approx([1.0, 0.0])
    assert isinstance(WAY, Joinable)


def test_what_others_of_its_batch_do_changes_nothing():
    """The direction is felt from the beginning on, and what stays of its error adds up only while it walks."""
    way = replace(WAY, heading=HeadingRule())
    alone = way.start([ROBOT], [GAIT], [0], 3000, PERIOD)
    both = Amphibious.start_together(
        [way, replace(way, begins="walking")], [ROBOT] * 2, [GAIT] * 2, [0, 0], 3000, PERIOD
    )
    rng = np.random.default_rng(0)
    for tick in range(0, 260):
        felt = sensed(0.0 if tick < 150 else 0.5, yaw=0.3 + 0.1 * rng.random())
        one = alone.command(tick, felt)
        two = both.command(tick, twice(felt))
        assert two.targets[0] == pytest.approx(one.targets[0], abs=1e-9), tick
    swam = way.start([ROBOT], [GAIT], [0], 3000, PERIOD)
    for tick in range(400):
        swam.command(tick, sensed(0.0, yaw=0.3 * (tick > 0)))
    assert np.abs(swam._heading._offset).max() == 0.0
    assert np.abs(swam._stroke - 1.0).max() == 0.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: replace(WAY, afloat=0.02), "afloat must be less"),
        (lambda: replace(WAY, breathe_out=2.0), "breathe_out is 2"),
        (lambda: replace(WAY, change=0.0), "change is 0 s"),
        (lambda: replace(WAY, swim=Swimming(swim=WAVE, depth=DepthHold(depth=1.0))), "leave out swim.depth"),
        (
            lambda: replace(WAY, breathe_out=0.5).start([ROBOTS["caiman"]], [GAIT], [0], 10, PERIOD),
            "no air that it could let out",
        ),
        (lambda: HeadingHold(gain=-1.0), "heading_hold.gain is -1"),
    ],
)
def test_bad_settings_are_refused_in_a_sentence(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make()
