from dataclasses import replace
from math import asin, exp, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.felt import felt
from tests.start_batch import start_batch

from suchus.animals.capture.angles import standing_index
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, UnsuitedRobot
from suchus.robot.control import LAWS, Control, OpenLoop, Oscillators, PatternGenerator, SpineRule, TailRule
from suchus.robot.control import oscillate as turned
from suchus.robot.control.oscillators import LimbCoupling, Rhythm, couple, cut_couplings, steps_needed
from suchus.robot.control.pattern_generator import STEERING_BEND
from suchus.robot.control.pattern_posture import axis_segments
from suchus.robot.design import layout, servo_ranges
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, middle_stance
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement

WALKERS = {
    "caiman": "belly_crawl",
    "salamander": "salamander_walk",
    "salamandra": "salamandra_walk",
    "pleurobot": "pleurobot_walk",
    "strider": "tripod",
    "swimmer": "undulation",
}
NUMBERS = Oscillators()
SALAMANDER, WALK = ROBOTS["salamander"], GAITS["salamander_walk"]
N = 8  # segments of its axis


def started(control, name, runs=1, seeds=None):
    robot, gait = ROBOTS[name], GAITS[WALKERS[name]]
    seeds = list(range(runs)) if seeds is None else seeds
    return start_batch(control, [robot] * runs, [gait] * runs, seeds, 0, control_period(robot))


def followed(generator, name, cycles):
    """Return the targets over so many periods of the gait, from the beginning of the walk."""
    period = control_period(ROBOTS[name])
    first, ticks = round(START / period), round(cycles * GAITS[WALKERS[name]].period / period)
    return np.array([generator.command(first + k, None).targets for k in range(ticks + 1)])


def wrapped(cycles):
    return np.mod(np.asarray(cycles) + 0.5, 1.0) - 0.5


def rhythm(couplings, phase, amplitude, period=0.005, numbers=NUMBERS):
    phases = np.array([phase], dtype=float)
    return Rhythm([couplings], [numbers], np.ones(1), phases, np.full_like(phases, amplitude), period)


# --- exact ---


@pytest.mark.parametrize("first", [0.1, 1.0, 3.0, 6.0])
def test_two_oscillators_lock_at_the_prescribed_bias(first):
    pair = couple(NUMBERS, [LimbCoupling(-1, 0.0)], [], [], 0.0)
    both = rhythm(pair, [0.0, first], 0.3)
    for _ in range(2000):
        both.advance(np.full((1, 2), 0.7), np.full((1, 2), 0.3))
    assert wrapped((both.phase[0, 1] - both.phase[0, 0]) / (2 * pi) - 0.5) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("faster", [-0.6, 0.2, 0.9])
def test_two_oscillators_of_different_frequency_lock_apart_by_the_closed_form(faster):
    # d' = 2 pi df - 2 r w sin(d) for the distance d from the bias
    pair = couple(NUMBERS, [LimbCoupling(-1, 0.0)], [], [], 0.0)
    both = rhythm(pair, [0.0, 2.5], 0.3)
    for _ in range(3000):
        both.advance(np.array([[0.7, 0.7 + faster]]), np.full((1, 2), 0.3))
    apart = both.phase[0, 1] - both.phase[0, 0] - pi
    expected = asin(2 * pi * faster / (2 * 0.3 * NUMBERS.sides_weight))
    assert 2 * pi * wrapped(apart / (2 * pi)) == pytest.approx(expected, abs=1e-9)


def test_an_amplitude_rises_critically_damped_and_heun_is_of_second_order():
    pair = couple(NUMBERS, [LimbCoupling(-1, 0.0)], [], [], 0.0)
    errors = []
    for period in (0.005, 0.0025):
        one = rhythm(pair, [0.0, pi], 0.0, period=period)
        for _ in range(round(0.15 / period)):
            one.advance(np.zeros((1, 2)), np.full((1, 2), 0.4))
        errors.append(one.amplitude[0, 0] - 0.4 * (1 - 2.5 * exp(-1.5)))  # a t / 2 = 1.5
    assert abs(errors[0]) < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


def test_frequencies_and_amplitudes_follow_the_drive_and_end_with_it():
    drives = np.array([0.99, 1.0, 2.0, 3.0, 3.01, 5.0, 5.01])
    axis, limbs = NUMBERS.axis(drives), NUMBERS.limbs(drives)
    assert axis[0] == pytest.approx([0.0, 0.5, 0.7, 0.9, 0.902, 1.3, 0.0])
    assert axis[1] == pytest.approx([0.0, 0.261, 0.326, 0.391, 0.39165, 0.521, 0.0])
    assert limbs[0] == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.0, 0.0, 0.0])
    assert limbs[1] == pytest.approx([0.0, 0.262, 0.393, 0.524, 0.0, 0.0, 0.0])


def test_the_step_shrinks_with_the_fastest_rate():
    parts = [LimbCoupling(0, 0.0)] * N
    usual = couple(NUMBERS, parts, ("LF", "RF"), (0.0, 0.5), 0.1)
    stiff = couple(NUMBERS, parts * 2, ("LF", "RF"), (0.0, 0.5), 0.1)
    assert steps_needed(usual, NUMBERS, 1.0, 0.005) == 1
    assert steps_needed(usual, NUMBERS, 4.0, 0.005) == 4
    assert steps_needed(stiff, NUMBERS, 1.0, 0.005) == 4  # weights grow with the square of the number of segments
    quick = replace(NUMBERS, rate=320.0)
    assert steps_needed(usual, quick, 1.0, 0.005) == 10


# --- published and prototype numbers: Ijspeert et al. 2007; shared/design/bodies.md ---


def test_walking_is_a_standing_wave_of_the_limbs_frequency_with_its_node_between_the_girdles():
    done = turned([PatternGenerator(drive=2.0, pace=1.0)], SALAMANDER, WALK, duration=6.0, sample_interval=10)
    phase, rate = done.phase[0], (done.phase[0, -1] - done.phase[0, -20]) / (done.time[-1] - done.time[-20])
    assert rate == pytest.approx(np.full(2 * N + 4, 0.4), abs=1e-6)
    lags = wrapped(-np.diff(phase[-1, :N]))
    assert lags[2] == pytest.approx(0.37, abs=0.01)  # the border between the girdles' parts
    assert np.delete(lags, 2).max() < 0.07
    assert np.delete(lags, 2).min() > 0.0
    assert standing_index(np.ones(N), 2 * pi * phase[-1, :N]) == pytest.approx(0.91, abs=0.01)
    assert wrapped(phase[-1, 2 * N :] - phase[-1, 2 * N]) == pytest.approx([0.0, -0.5, -0.5, 0.0], abs=1e-9) or (
        np.abs(wrapped(phase[-1, 2 * N :] - phase[-1, 2 * N])) == pytest.approx([0.0, 0.5, 0.5, 0.0], abs=1e-9)
    )


def test_swimming_is_a_travelling_wave_of_the_axis_own_frequency():
    controls = [PatternGenerator(drive=drive, pace=1.0) for drive in (3.01, 4.0)]
    done = turned(controls, SALAMANDER, WALK, duration=2.0, sample_interval=10)
    rate = (done.phase[:, -1] - done.phase[:, -20]) / (done.time[-1] - done.time[-20])
    assert rate[:, :N] == pytest.approx(np.repeat([[0.902], [1.1]], N, axis=1), abs=1e-6)
    assert rate[:, 2 * N :] == pytest.approx(np.zeros((2, 4)), abs=1e-12)
    assert wrapped(-np.diff(done.phase[:, -1, :N])) == pytest.approx(np.full((2, N - 1), 0.125), abs=1e-6)
    assert done.amplitude[:, -1, 2 * N :].max() == 0.0
    assert np.abs(wrapped(done.phase[:, -1, N : 2 * N] - done.phase[:, -1, :N])) == pytest.approx(np.full((2, N), 0.5))


@pytest.mark.parametrize(("name", "limbs"), [("salamander", (0, 1, 1, 0)), ("strider", (0, 1, 1, 0, 0, 1))])
def test_random_starts_lock_to_diagonal_limbs_or_the_tripod(name, limbs):
    controls = [PatternGenerator(initial="random", pace=1.0)] * 16
    robot, gait = ROBOTS[name], GAITS[WALKERS[name]]
    done = turned(controls, robot, gait, duration=3.0, seeds=range(16), sample_interval=100)
    first = 2 * done.wave.shape[2]
    apart = wrapped(done.phase[:, -1, first:] - done.phase[:, -1, first : first + 1] - np.array(limbs) / 2)
    assert np.abs(apart).max() < 0.1 / (2 * pi)
    before = wrapped(done.phase[:, 0, first:] - done.phase[:, 0, first : first + 1] - np.array(limbs) / 2)
    assert (np.abs(before).max(axis=1) > 0.1).all()  # none began there


# --- the body ---


@pytest.mark.parametrize("name", ["caiman", "salamander", "salamandra", "strider"])
def test_at_the_middle_drive_limbs_do_what_the_gait_does_and_the_axis_bends_as_far(name):
    robot, gait = ROBOTS[name], GAITS[WALKERS[name]]
    period, generator = control_period(robot), started(PatternGenerator(), name)
    ticks = round((START + 2.5 * gait.period) / period)
    table = start_batch(OpenLoop(), [robot], [gait], [0], ticks + 1, period)
    limbs = [i for one in layout(robot).limbs for i in range(one.servos.start, one.servos.stop)]
    found, meant = [generator.rest()], [table.rest()]
    for tick in range(round(START / period), ticks):
        ours, theirs = generator.command(tick, None), table.command(tick, None)
        assert ours.phase == pytest.approx(theirs.phase, abs=1e-9)
        found.append(ours.targets)
        meant.append(theirs.targets)
    ours, theirs = np.array(found)[:, 0], np.array(meant)[:, 0]
    assert ours[:, limbs] == pytest.approx(theirs[:, limbs], abs=1e-9)
    axis = [i for i in range(ours.shape[1]) if i not in limbs]
    late = slice(len(ours) - round(gait.period / period), None)
    assert np.ptp(ours[late][:, axis], axis=0) == pytest.approx(
        np.ptp(theirs[late][:, axis], axis=0), rel=0.02, abs=1e-9
    )
    # the foremost joint that bends; it leads the limbs by a fortieth of a cycle
    first = next(one.servo for one in axis_segments(robot, gait) if one.amplitude > 0.0)
    assert np.corrcoef(ours[late, first], theirs[late, first])[0, 1] > 0.9


@pytest.mark.parametrize("name", list(WALKERS))
@given(
    drive=st.floats(0.0, 10.0), asymmetry=st.floats(-4.0, 4.0), steering=st.floats(-1.0, 1.0), seed=st.integers(0, 9)
)
@settings(max_examples=5, deadline=None)
def test_on_any_body_commands_are_finite_and_within_the_axis_ranges(name, drive, asymmetry, steering, seed):
    bend = None if name != "strider" else STEERING_BEND  # a bend hardly turns it, so that it must be given
    control = PatternGenerator(
        drive=drive, asymmetry=asymmetry, steering=steering, steering_gain=bend, initial="random"
    )
    targets = followed(started(control, name, seeds=[seed]), name, 0.05)
    assert np.isfinite(targets).all()
    low, high = servo_ranges(ROBOTS[name]).T
    axis = [one.servo for one in axis_segments(ROBOTS[name], GAITS[WALKERS[name]])]
    assert (targets[..., axis] >= low[axis]).all()
    assert (targets[..., axis] <= high[axis]).all()


@pytest.mark.parametrize("name", ["swimmer", "caiman"])
def test_bends_beyond_the_servos_end_at_their_ranges(name):
    far = PatternGenerator(gradient=((0.0, 10.0), (1.0, 10.0)))
    targets = followed(started(far, name), name, 0.5)[:, 0]
    low, high = servo_ranges(ROBOTS[name]).T
    for servo in {one.servo for one in axis_segments(ROBOTS[name], GAITS[WALKERS[name]])}:
        reached = targets[:, servo].min() == low[servo], targets[:, servo].max() == high[servo]
        assert any(reached)
        assert low[servo] <= targets[:, servo].min()
        assert targets[:, servo].max() <= high[servo]


def test_silent_limbs_fold_or_stand_and_cranks_stop():
    up = ((START, 3.0), (START + 0.01, 4.0))
    yaw = layout(SALAMANDER).servos.index("LF_yaw")
    folded = followed(started(PatternGenerator(drive=up), "salamander"), "salamander", 2.0)[-1, 0]
    standing = followed(started(PatternGenerator(drive=up, silent="standing"), "salamander"), "salamander", 2.0)[-1, 0]
    limbs = slice(0, layout(SALAMANDER).limbs[-1].servos.stop)
    assert folded[yaw] == pytest.approx(np.radians(-85), abs=1e-6)
    assert standing[limbs] == pytest.approx(middle_stance(SALAMANDER, WALK)[limbs], abs=1e-6)
    cranks = followed(started(PatternGenerator(drive=up), "salamandra"), "salamandra", 2.0)[:, 0, :4]
    assert cranks[-1] == pytest.approx(cranks[-100], abs=1e-9)
    assert np.abs(cranks[-1] - cranks[0]).max() > 1e-4


def test_a_weaker_drive_on_the_right_bends_to_the_left_and_steering_bends_the_trunk_alone():
    controls = [PatternGenerator(), PatternGenerator(asymmetry=-1.0), PatternGenerator(steering=1.0)]
    done = turned(controls, SALAMANDER, WALK, duration=3.0)
    more = done.amplitude[:, -1, :N] - done.amplitude[:, -1, N : 2 * N]
    assert more[1] == pytest.approx(np.full(N, 0.065), abs=1e-9)  # the slope of the amplitude over the drive
    assert (done.wave[1, -200:].mean(axis=0) > 0.05).all()
    assert done.wave[2].tobytes() == done.wave[0].tobytes()  # the oscillators know nothing of steering
    assert more[0] == pytest.approx(np.zeros(N), abs=1e-12)
    plain, left = (
        followed(started(PatternGenerator(steering=s), "salamander"), "salamander", 0.1)[-1, 0] for s in (0.0, 1.0)
    )
    place = layout(SALAMANDER)
    bent = (left - plain)[list(place.axial_yaw)] * place.axial_left
    assert bent == pytest.approx([STEERING_BEND] * 3 + [0.0] * 5, abs=1e-9)


def test_the_gradient_and_the_lag_are_what_is_asked():
    control = PatternGenerator(drive=4.0, lag=0.05, gradient=((0.2, 0.0), (0.8, 2.0)), pace=1.0)
    done = turned([control], SALAMANDER, WALK, duration=1.0, sample_interval=10)
    assert wrapped(-np.diff(done.phase[0, -1, :N])) == pytest.approx(np.full(N - 1, 0.05), abs=1e-6)
    full = turned(
        [replace(control, gradient=((0.0, 1.0), (1.0, 1.0)))], SALAMANDER, WALK, duration=1.0, sample_interval=10
    )
    places = [one.axial_position for one in axis_segments(SALAMANDER, WALK)]
    assert done.wave == pytest.approx(full.wave * np.interp(places, [0.2, 0.8], [0.0, 2.0]))


def test_lesions_cut_what_they_name():
    whole = couple(
        NUMBERS,
        [LimbCoupling(0, 0.0)] * 4 + [LimbCoupling(1, 0.0)] * 4,
        ("LF", "RF", "LH", "RH"),
        WALK.limb_phases,
        0.1,
    )
    halves = cut_couplings(whole, (("axis_4", "axis_5"),))
    lost = np.flatnonzero(halves.weight != whole.weight)
    pairs = {(whole.names[whole.receiver[i]], whole.names[whole.sender[i]]) for i in lost}
    assert pairs == {
        (f"axis_{a}_{side}", f"axis_{b}_{side}") for a, b in ((4, 5), (5, 4)) for side in ("left", "right")
    }
    free = turned(
        [PatternGenerator(lesions=(("limbs", "axis"),), pace=1.0)], SALAMANDER, WALK, duration=1.0, sample_interval=10
    )
    rate = (free.phase[0, -1] - free.phase[0, -10]) / (free.time[-1] - free.time[-10])
    assert rate[2 * N :] == pytest.approx(np.full(4, 0.4), abs=1e-9)
    assert rate[:N].min() > 0.5  # the axis goes its own way
    with pytest.raises(UnknownName, match="axis_9"):
        cut_couplings(whole, (("axis_9", "LF"),))
    with pytest.raises(OutsideLimits, match="no coupling joins 'axis_1' and 'axis_3'"):
        cut_couplings(whole, (("axis_1", "axis_3"),))
    with pytest.raises(OutsideLimits, match="no coupling joins 'axis_1_left' and 'LH'"):
        cut_couplings(whole, (("axis_1_left", "LH"),))  # hind limbs drive the tail


def test_the_drive_may_change_over_time():
    table = ((START, 1.0), (START + 2.0, 3.0))
    done = turned([PatternGenerator(drive=table, pace=1.0)], SALAMANDER, WALK, duration=4.0)
    rate = np.gradient(done.phase[0, :, 2 * N], done.time)
    at = np.interp(done.time - START, [0.0, 2.0], [0.2, 0.6])
    assert rate[5:-5] == pytest.approx(at[5:-5], abs=0.003)


# --- batches ---


def test_a_batch_turns_as_each_run_does_alone_to_the_byte_in_any_order():
    controls = [
        PatternGenerator(),
        PatternGenerator(drive=4.0, initial="random"),
        PatternGenerator(drive=((1.0, 1.0), (1.5, 5.0)), pace=7.0, lag=0.02),
        PatternGenerator(lesions=(("axis", "limbs"),), asymmetry=1.0, silent="standing", initial="random"),
        PatternGenerator(oscillators=Oscillators(rate=100.0), limbs=LAWS["own_load"]),
    ]
    robot, period = SALAMANDER, control_period(SALAMANDER)
    first = round(START / period)

    def told(some, seeds):
        runs = len(some)
        generator = start_batch(some, [robot] * runs, [WALK] * runs, seeds, 0, period)
        rows = [generator.command(first + k, None) for k in range(60)]
        return np.array([row.targets for row in rows]), np.array([row.phase for row in rows])

    together, phases = told(controls, range(5))
    order = [3, 1, 4, 0, 2]
    mixed, _ = told([controls[i] for i in order], order)
    for i, control in enumerate(controls):
        alone, phase = told([control], [i])
        assert together[:, i].tobytes() == alone[:, 0].tobytes()
        assert phases[:, i].tobytes() == phase[:, 0].tobytes()
        assert mixed[:, order.index(i)].tobytes() == alone[:, 0].tobytes()


def test_it_walks_on_land_the_same_alone_and_beside_others():
    runs = [Run(robot=SALAMANDER, gait=WALK, control=PatternGenerator(drive=drive)) for drive in (3.0, 2.0)]
    both = simulate(runs, duration=2.0, sample_stride=10)
    alone = simulate(runs[1:], duration=2.0, sample_stride=10)
    assert both.position.isel(run=1).values.tobytes() == alone.position.isel(run=0).values.tobytes()
    stride = displacement(both).sel(xyz="x").values / SALAMANDER.length / [1.5, 1.0]
    assert (stride > 0.1).all()
    assert isinstance(PatternGenerator(), Control)
    assert isinstance(PatternGenerator(), Control)


# --- feedback ---


def test_a_limb_that_still_carries_waits_and_one_that_carries_early_hurries():
    control = PatternGenerator(limbs=LAWS["own_load"], lesions=(("limbs", "limbs"),))
    period, ahead = control_period(SALAMANDER), []
    weight = np.array([[SALAMANDER.mass * 9.81, 0.0, 0.0, 0.0]])
    for phase in (0.6, 0.95):  # early and late in a stance that lasts from 0.45 to 1
        limbs = [phase - (0.25 - WALK.duty_factor / 2)] * 4
        generator = started(replace(control, initial=(*([0.0] * 2 * N), *limbs)), "salamander")
        for k in range(10):
            phases = generator.command(
                round(START / period) + k, felt(SALAMANDER, time=2.0, foot_pressure=weight)
            ).phase[0]
        ahead.append(phases[0] - phases[1])
        assert phases[1:] == pytest.approx(np.full(3, phases[1]))
    assert ahead[0] > 1e-3
    assert ahead[1] < -1e-3


def test_spine_and_tail_rules_act_on_it(robot, crawl_gait):
    tick, period = 150, 0.01
    torque = np.zeros((1, 19))
    place = layout(robot)
    torque[0, place.tail_pitch[0]] = 1.0
    readings = felt(robot, time=2.0, servo_torque=torque)
    plain, ruled = (
        start_batch(control, [robot], [crawl_gait], [0], 0, period).command(tick, readings).targets[0]
        for control in (PatternGenerator(), PatternGenerator(spine=SpineRule(), tail=TailRule()))
    )
    yaws = list(place.trunk_yaw)
    lacking = plain[yaws].sum()
    assert abs(lacking) > 0.1
    heard = SpineRule().share * (1.0 - exp(-period / SpineRule().delay)) * lacking
    assert (ruled - plain)[yaws] == pytest.approx(np.full(3, heard))
    assert (ruled - plain)[place.tail_pitch[0]] == pytest.approx(-TailRule().rate * period)


# --- refusals ---


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"drive": 11.0}, "drive is 11"),
        (
            {"drive": ((1.0, 2.0), (1.0, 3.0))},
            "pairs of a time and such a number are allowed, the times rising from 0 on",
        ),
        ({"drive": ((-1.0, 2.0), (1.0, 3.0))}, "the times rising from 0 on"),
        ({"gradient": ((0.5, 1.0), (0.2, 1.0))}, "the places rising"),
        ({"drive": ()}, "drive is"),
        ({"drive": float("nan")}, "drive is nan"),
        ({"steering": 1.1}, "steering is 1.1; -1 to 1 is allowed"),
        ({"asymmetry": ((0.0, 9.0),)}, "asymmetry is"),
        ({"gradient": ((0.0, -1.0),)}, "gradient is"),
        ({"lag": 0.6}, "lag is 0.6 cycle"),
        ({"initial": "wild"}, "initial is 'wild'; gait, random or a phase"),
        ({"silent": "gone"}, "folded or standing"),
        ({"pace": 0.0}, "pace is 0"),
    ],
)
def test_impossible_settings_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        PatternGenerator(**fields)


def test_tables_begin_at_once_or_later_and_may_hold_one_pair():
    PatternGenerator(drive=((0.0, 2.0), (0.5, 3.0)), steering=((3.0, 1.0),), gradient=((0.0, 10.0), (1.0, 0.0)))


def test_what_does_not_fit_the_robot_is_refused():
    with pytest.raises(InvalidDesign, match="initial has 3 phases; robot 'salamander' has 20 oscillators"):
        started(PatternGenerator(initial=(0.0, 0.5, 0.0)), "salamander")
    with pytest.raises(UnsuitedRobot, match="rule tail to tail needs"):
        started(PatternGenerator(tail=TailRule()), "salamander")
    with pytest.raises(InvalidDesign, match="do not turn at drive 2"):
        started(PatternGenerator(oscillators=Oscillators(limb_frequency=(0.0, 0.0))), "salamander")
    with pytest.raises(InvalidDesign, match="rate is 0"):
        Oscillators(rate=0.0)
