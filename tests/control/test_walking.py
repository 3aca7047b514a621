from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from tests.felt import felt as feels

from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.control import AttitudeRule, Change, Control, OpenLoop, Runs, SwitchRule, Walking
from suchus.robot.control.switching import Switcher
from suchus.robot.design.ground import Bumps, Stone
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate
from suchus.sim.metrics import displacement, heading_change, tilt, time_window


def started(control, robot, gait):
    return control.start(Runs.identical(control, robot, gait, ticks=10), 0.01)


POSTURES = ("belly_crawl", "low_crawl", "semi_erect", "high_walk")
SEEDS = ((2, 0.06), (3, 0.1))
LADDER = tuple(GAITS[name] for name in POSTURES[1:])


def sensed(*, roll=0.0, pitch=0.0, roll_rate=0.0, pitch_rate=0.0, feet=(20.0,) * 4, belly=0.0, runs=1):
    """What robots feel that roll and pitch about their own axes."""
    quaternion = (
        [np.cos(roll / 2), np.sin(roll / 2), 0.0, 0.0] if roll else [np.cos(pitch / 2), 0, np.sin(pitch / 2), 0]
    )
    return feels(
        ROBOTS["caiman"],
        runs,
        time=2.0,
        foot_pressure=feet,
        belly_pressure=[belly, 0, 0, 0, 0, 0],
        orientation=quaternion,
        angular_velocity=[roll_rate, pitch_rate, 0.0],
    )


@pytest.mark.parametrize("name", POSTURES)
def test_with_nothing_asked_it_is_the_open_loop(robot, name):
    gait = GAITS[name]
    table = OpenLoop.start(Runs.identical(OpenLoop(), robot, gait, ticks=400), 0.01)
    walker = Walking.start(Runs.identical(Walking(), robot, gait, ticks=400), 0.01)
    assert walker.rest() == pytest.approx(table.rest(), abs=1e-9)
    for tick in range(0, 400, 7):
        ours, theirs = walker.command(tick, None), table.command(tick, None)
        assert ours.targets == pytest.approx(theirs.targets, abs=1e-9)
        assert ours.phase == pytest.approx(theirs.phase, abs=1e-9)
    assert not Walking().feels
    assert isinstance(Walking(), Control)


def test_feet_on_the_side_that_sinks_go_lower_and_the_front_ones_when_the_nose_sinks(robot):
    def lowered(**felt):
        walker = started(Walking(attitude=AttitudeRule()), robot, GAITS["high_walk"])
        walker.command(150, sensed())
        for tick in range(151, 171):  # for five time constants of the filter
            walker.command(tick, sensed(**felt))
        return walker._foot_lowering[0]

    assert (lowered(roll=0.05) * [1, -1, 1, -1] < -0.002).all()  # left side up: left feet give way
    assert (lowered(pitch=0.05) * [1, 1, -1, -1] > 0.002).all()  # nose down: front feet push
    assert (lowered(roll_rate=0.5) * [1, -1, 1, -1] < -0.002).all()
    assert (lowered(pitch_rate=0.5) * [1, 1, -1, -1] > 0.002).all()
    assert np.abs(lowered(roll=1.0)).max() == AttitudeRule().most
    assert lowered() == pytest.approx(np.zeros(4))


def test_a_constant_slope_is_no_stumble(robot):
    walker = started(Walking(attitude=AttitudeRule(washout=0.5)), robot, GAITS["high_walk"])
    walker.command(150, sensed())
    for tick in range(151, 600):
        walker.command(tick, sensed(pitch=0.2))
    assert walker._foot_lowering[0] == pytest.approx(np.zeros(4), abs=1e-4)


def test_attitude_feedback_keeps_the_high_walk_on_its_feet_on_bumps(robot):
    grounds = [Ground(relief=Bumps(height=0.04, correlation=length, start=0.42, seed=s)) for s, length in SEEDS]
    runs = [
        Run(robot=robot, gait=GAITS["high_walk"], control=Walking(attitude=rule), ground=ground)
        for rule in (None, AttitudeRule())
        for ground in grounds
    ]
    record = simulate(runs, duration=14.0, timestep=0.005, sample_stride=5)
    way = displacement(record).sel(xyz="x").values.reshape(2, -1)
    assert way[1].min() > 1.0 > way[0].min()
    roll = np.abs(tilt(time_window(record))["roll"]).max("time").values.reshape(2, -1)
    assert np.degrees(roll[1]).max() < 20 < np.degrees(roll[0]).max()


BUMPS = Ground(relief=Bumps(height=0.03, correlation=0.1, start=0.42, seed=1))
ON_BUMPS = [("low_crawl", "high_walk", BUMPS), ("high_walk", "low_crawl", BUMPS), ("semi_erect", "high_walk", BUMPS)]
EVEN = [(a, b, Ground()) for a, b in permutations(POSTURES, 2)]


@pytest.mark.parametrize("cases", [ON_BUMPS, EVEN], ids=["bumps", "even"])
def test_every_posture_turns_into_every_other(robot, cases):
    runs = [
        Run(
            robot=robot,
            gait=GAITS[a],
            control=Walking(attitude=AttitudeRule(), changes=(Change(at=1.5, gait=GAITS[b]),)),
            ground=ground,
        )
        for a, b, ground in cases
    ]
    record = simulate(runs, duration=7.0, timestep=0.005, sample_stride=5)
    off = tilt(time_window(record, 1.0))
    assert np.degrees(np.maximum(abs(off["roll"]), abs(off["pitch"])).max()) < 30
    forward = displacement(record, 5.1).sel(xyz="x").values
    assert forward.min() > 0.05
    last = record.servo_target.isel(time=-1).sel(servo="LF_yaw").values
    for (_, there, _), yaw in zip(cases, last, strict=True):
        assert (yaw == pytest.approx(-np.pi / 2)) == (there == "high_walk")


def test_runs_with_different_wishes_share_a_batch_and_equal_themselves_alone(robot):
    controls = [Walking(), Walking(bend=0.4), Walking(changes=(Change(at=1.5, gait=LADDER[2]),))]
    runs = [Run(robot=robot, gait=LADDER[1], control=control) for control in controls]
    together = simulate(runs, duration=3.0, timestep=0.005, sample_stride=10)
    for i, run in enumerate(runs):
        alone = simulate([run], duration=3.0, timestep=0.005, sample_stride=10)
        way = alone.centre_of_mass.isel(run=0).values
        assert way == pytest.approx(together.centre_of_mass.isel(run=i).values, abs=1e-6)


def test_bend_and_asymmetry_steer_to_the_left(robot):
    controls = [Walking(), Walking(bend=0.3), Walking(bend=-0.3), Walking(asymmetry=0.5)]
    runs = [Run(robot=robot, gait=GAITS["semi_erect"], control=control) for control in controls]
    turned = heading_change(simulate(runs, duration=5.0, timestep=0.005, sample_stride=10)).values
    assert turned[1] > 0.5
    assert turned[2] < -0.5
    assert turned[3] > 0.3
    assert abs(turned[0]) < 0.15


def feel(rule, gait, many, *, ticks):
    """Let one run feel the same for some ticks; return the rung of each answer."""
    switcher, phase, answers = Switcher([rule], [ROBOTS["caiman"]], [gait], 0.01), np.full((1, 4), 0.9), []
    for _ in range(ticks):
        for _, asked in switcher.decide(many, phase, [gait], set()):
            answers.append(rule.ladder.index(asked))
    return answers


def test_the_ladder_goes_up_when_the_belly_touches_and_down_when_feet_stumble_or_all_is_calm():
    rule = SwitchRule(ladder=LADDER, home=1)
    assert feel(rule, LADDER[0], sensed(belly=20.0), ticks=150)[:1] == [1]
    assert feel(rule, LADDER[1], sensed(belly=20.0), ticks=150)[:1] == [2]
    assert feel(rule, LADDER[2], sensed(belly=20.0), ticks=150) == []  # there is nothing higher
    assert feel(rule, LADDER[1], sensed(), ticks=800) == []  # calm at home
    assert feel(rule, LADDER[2], sensed(), ticks=800)[:1] == [1]
    assert feel(rule, LADDER[2], sensed(feet=(0.0,) * 4, belly=0.0), ticks=400)[:1] == [1]
    assert feel(replace(rule, home=0), LADDER[1], sensed(), ticks=800)[:1] == [0]


def test_a_crawl_that_is_stuck_on_a_stone_rises_by_what_it_feels(robot):
    stone = Ground(relief=Stone(at=0.75, aside=0.0, height=0.04, length=0.06, width=0.05))
    rule = SwitchRule(ladder=LADDER, home=0)
    runs = [
        Run(robot=robot, gait=LADDER[0], control=control, ground=stone)
        for control in (Walking(), Walking(attitude=AttitudeRule(), switching=rule))
    ]
    record = simulate(runs, duration=12.0, timestep=0.005, sample_stride=10)
    way = displacement(record).sel(xyz="x").values
    assert way[1] > 1.05 * way[0]
    knee = record.servo_target.sel(servo="LF_yaw")
    assert float(knee.isel(run=1).min()) < float(knee.isel(run=0).min()) - 0.1  # it took another posture


def test_impossible_wishes_are_refused(robot):
    with pytest.raises(InvalidDesign, match="must increase"):
        Walking(changes=(Change(at=3.0, gait=LADDER[0]), Change(at=2.0, gait=LADDER[1])))
    with pytest.raises(InvalidDesign, match="give one of them"):
        Walking(changes=(Change(at=3.0, gait=LADDER[0]),), switching=SwitchRule(ladder=LADDER, home=0))
    with pytest.raises(InvalidDesign, match="home"):
        SwitchRule(ladder=LADDER, home=3)
    with pytest.raises(InvalidDesign, match="repeats"):
        SwitchRule(ladder=(LADDER[0], LADDER[0]), home=0)
    with pytest.raises(OutsideLimits, match=r"lower walking\.bend"):
        started(Walking(bend=2.0), robot, LADDER[1])
    with pytest.raises(UnknownName, match="belly_crawl"):
        started(Walking(switching=SwitchRule(ladder=LADDER, home=0)), robot, GAITS["belly_crawl"])
