from dataclasses import FrozenInstanceError, replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.felt import felt as feels
from tests.metres import limb_phase, placed, tail_bend, trunk_bend, with_metres
from tests.start_batch import start_batch

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.control import LAWS, OWNERS, Coordinated, HeadingRule, Kick, LimbLaw, OpenLoop, SpineRule, TailRule
from suchus.robot.control.limbs import GRAVITY, Limbs
from suchus.robot.control.shared import initial_shared
from suchus.robot.control.spine import SpineController
from suchus.robot.control.tail import TailController
from suchus.robot.design import layout
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, Batch, cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

TRUNK_YAW = list(layout(ROBOTS["caiman"]).trunk_yaw)
(PITCH,) = layout(ROBOTS["caiman"]).tail_pitch

PERIOD = 0.01
WALK = round(START / PERIOD)
OFF = Coordinated(limbs=LAWS["off"], spine=None, tail=None)


def sensed(runs, **readings):
    """Return the readings of robots that feel nothing but what is given."""
    return feels(ROBOTS["caiman"], runs, **readings)


def started(control, robot, gait, runs=1, ticks=1000):
    return start_batch(control, [robot] * runs, [gait] * runs, list(range(runs)), ticks, PERIOD)


def turned(angle):
    return np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])


# --- with all rules off ---


def test_with_all_rules_off_the_commands_are_the_open_loop_table_to_the_bit(robot, crawl_gait, limbs_gait):
    gaits = [crawl_gait, with_metres(crawl_gait, duty_factor=0.62, period=1.7, tail_phase=0.3), limbs_gait]
    table = start_batch(OpenLoop(), [robot] * 3, gaits, [0, 1, 2], 1000, PERIOD)
    closed = start_batch(OFF, [robot] * 3, gaits, [0, 1, 2], 1000, PERIOD)
    rng = np.random.default_rng(0)
    assert not OFF.feels
    assert closed.rest().tobytes() == table.rest().tobytes()
    for tick in range(0, 1000, 7):
        felt = sensed(3, foot_pressure=rng.uniform(0, 30, (3, 4)), servo_torque=rng.normal(size=(3, 19)))
        found, expected = closed.command(tick, felt), table.command(tick, None)
        assert found.targets.tobytes() == expected.targets.tobytes()
        assert found.phase.tobytes() == expected.phase.tobytes()


def test_a_run_without_rules_is_the_open_loop_to_the_bit_even_beside_others(robot, crawl_gait):
    runs = [
        Run(robot=robot, gait=crawl_gait, control=c)
        for c in (OFF, Coordinated(heading=HeadingRule()), Coordinated(limbs=LAWS["own_load"], random_start=True))
    ]
    together = simulate(runs, duration=3.0, timestep=0.005)
    alone = simulate([Run(robot=robot, gait=crawl_gait)], duration=3.0, timestep=0.005)
    for name in ("servo_target", "limb_phase", "position", "foot_force"):
        assert together[name].values[0].tobytes() == alone[name].values[0].tobytes(), name


def test_runs_of_different_controls_in_one_batch_walk_as_they_do_alone(robot, crawl_gait):
    controls = [Coordinated(), Coordinated(limbs=LAWS["own_load"], tail=None, load_noise=0.2, random_start=True)]
    runs = [Run(robot=robot, gait=crawl_gait, control=c, seed=3) for c in controls]
    together = simulate(runs, duration=2.5, timestep=0.005).centre_of_mass.values
    for i, run in enumerate(runs):
        alone = simulate([run], duration=2.5, timestep=0.005).centre_of_mass.values[0]
        assert together[i] == pytest.approx(alone, abs=1e-9)


def test_all_rules_off_but_random_phases_is_the_gait_at_those_phases(robot, crawl_gait):
    control = replace(OFF, random_start=True)
    closed = started(control, robot, crawl_gait, runs=2)
    first, later = closed.command(0, None), closed.command(WALK + 130, None)
    assert np.ptp(first.phase, axis=0).min() > 0.0
    assert ((first.phase >= 0.0) & (first.phase < 1.0)).all()
    assert later.phase - first.phase == pytest.approx(1.3 / crawl_gait.period)
    assert later.targets == pytest.approx(placed(robot, crawl_gait, later.phase), abs=1e-12)


# --- the shared variables ---


def test_only_its_owner_writes_a_shared_variable():
    shared = initial_shared(2, 4)
    for name, owner in OWNERS.items():
        value = np.ones((2, 4)) if name == "limb_phase" else np.ones(2)
        for other in {"limbs", "spine", "tail"} - {owner}:
            with pytest.raises(OutsideLimits, match=f"'{other}' wrote the shared variable '{name}', which belongs"):
                shared.updated_by(other, **{name: value})
        written = getattr(shared.updated_by(owner, **{name: value}), name)
        with pytest.raises(ValueError, match="read-only"):
            written[0] = 2.0
    with pytest.raises(FrozenInstanceError):
        shared.trunk_bend = np.ones(2)
    with pytest.raises(OutsideLimits, match="belongs to 'nobody'"):
        shared.updated_by("limbs", mood=np.ones(2))


def test_the_shared_variables_are_those_that_the_article_names():
    assert set(OWNERS) == {"limb_phase", "trunk_bend", "trunk_direction", "tail_bend", "tail_direction"}
    assert set(OWNERS) == set(initial_shared(1, 4).__dataclass_fields__)


phases = st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4)


@given(phases, st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.3, 0.8))
def test_spine_and_tail_follow_the_limbs_by_the_open_loop_law(robot, crawl_gait, phase, late, later, duty):
    gait = with_metres(crawl_gait, spine_phase=late, tail_phase=later, duty_factor=duty)
    gaits, clock = Batch([robot], [gait]), np.zeros(1)
    shared = initial_shared(1, 4).updated_by("limbs", limb_phase=np.array([phase]))
    shared = SpineController.step(shared, gaits, clock)
    shared = TailController.step(shared, gaits, clock)
    for name, law in (("trunk", trunk_bend), ("tail", tail_bend)):
        assert getattr(shared, f"{name}_bend") == pytest.approx(law(gait, np.array([phase])), abs=1e-12)
        assert getattr(shared, f"{name}_direction") == pytest.approx(law(gait, np.array([phase]) + 0.25), abs=1e-12)


@pytest.mark.parametrize("name", ["caiman", "salamander", "strider"])
def test_without_sharing_the_axis_of_any_body_stays_with_the_clock_after_a_kick(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    place, limbs = layout(robot), len(layout(robot).limbs)
    kicked = Coordinated(limbs=LAWS["off"], spine=None, tail=None, kicks=(Kick(START + 0.1, (0.25,) * limbs),))
    period = control_period(robot)
    tick = round((START + 0.3) / period)

    def after(control):
        closed = start_batch(control, [robot], [gait], [0], tick + 2, period)
        for i in range(tick):
            closed.command(i, None)
        return closed.command(tick, None).targets[0]

    table = start_batch(OpenLoop(), [robot], [gait], [0], tick + 2, period).command(tick, None).targets[0]
    sharing, alone = after(kicked), after(replace(kicked, sharing=False))
    axis = list(place.axial_yaw)
    assert alone[axis] == pytest.approx(table[axis], abs=1e-12)
    assert np.abs(sharing[axis] - table[axis]).max() > 0.01
    legs = [i for limb in place.limbs for i in range(limb.servos.start, limb.servos.stop)]
    assert (sharing[legs] == alone[legs]).all()


def test_without_sharing_spine_and_tail_follow_the_clock(robot, crawl_gait):
    closed = started(replace(OFF, random_start=True, sharing=False), robot, crawl_gait)
    command = closed.command(WALK + 70, None)
    by_clock = cycle_targets(robot, crawl_gait, np.array([0.7 / crawl_gait.period]))
    assert command.targets[:, 12:] == pytest.approx(by_clock[:, 12:], abs=1e-12)
    assert np.abs(command.targets[:, :12] - by_clock[:, :12]).max() > 0.01


# --- limb to limb ---


def walked(laws, robot, gait, ahead, load, ticks):
    """Let oscillators turn on synthetic loads, by one law or one for each run; return the phases, (tick, run, 4)."""
    runs = len(ahead)
    laws = [laws] * runs if isinstance(laws, LimbLaw) else laws
    limbs = Limbs(laws, [robot] * runs, [gait] * runs, ahead, PERIOD)
    shared, out = initial_shared(runs, 4), []
    for tick in range(ticks):
        clock = np.tile(limb_phase(gait, np.array(START + tick * PERIOD)), (runs, 1))
        shared = shared.updated_by("limbs", limb_phase=clock + limbs.phase_lead)
        shared = limbs.step(shared, sensed(runs, foot_pressure=load(shared.limb_phase)), clock, walking=True)
        out.append(shared.limb_phase)
    return np.array(out)


def pair_error(phase):
    off = np.stack(
        [phase[..., 0] - phase[..., 3], phase[..., 1] - phase[..., 2], phase[..., 0] - phase[..., 1] + 0.5], axis=-1
    )
    return np.abs((off + 0.5) % 1.0 - 0.5).max(axis=-1)


def test_a_limb_in_the_middle_of_its_stance_keeps_the_clock_whatever_it_carries(robot, crawl_gait):
    for duty in (0.4, 0.5, 0.7):
        gait = replace(crawl_gait, duty_factor=duty)
        middle = 1.0 - duty / 2
        for where, sign in ((middle, 0), (middle + 0.1, -1), (middle - 0.1, 1)):
            ahead = np.full((1, 4), where) - gait.limb_phases
            phase = walked(LimbLaw(own=0.2, delay=0.0), robot, gait, ahead, lambda p: np.full_like(p, 8.0), 1)
            change = phase[0] - where
            assert np.sign(np.where(np.abs(change) < 1e-12, 0.0, change)) == pytest.approx(sign)


def test_the_cross_load_law_is_the_formula(robot, crawl_gait):
    rng = np.random.default_rng(1)
    ahead, load = rng.random((5, 4)), rng.uniform(0, 30, (5, 4))
    law = replace(LAWS["cross_load"], delay=0.0)
    phase = walked(law, robot, crawl_gait, ahead.copy(), lambda p: load, 1)[0]
    before = ahead + crawl_gait.limb_phases
    s = np.array([1, -1, -1, 1])
    n = np.minimum(load / (robot.mass * GRAVITY / 4), 2.5)
    brake = 0.1 * s * (n @ s)[:, None] * np.cos(2 * pi * before - 0.244)
    assert phase == pytest.approx(before - brake * PERIOD / crawl_gait.period, abs=1e-12)


def test_the_wrong_sign_is_the_cross_load_law_reversed(robot, crawl_gait):
    rng = np.random.default_rng(2)
    ahead, load = rng.random((3, 4)), rng.uniform(0, 20, (3, 4))
    moves = [
        walked(LAWS[name], robot, crawl_gait, ahead.copy(), lambda p: load, 1)[0] - ahead - crawl_gait.limb_phases
        for name in ("cross_load", "wrong_sign")
    ]
    assert moves[0] == pytest.approx(-moves[1], abs=1e-12)
    assert np.abs(moves[0]).max() > 1e-5


def test_loads_that_follow_the_phases_pull_the_limbs_into_diagonal_pairs(robot, crawl_gait):
    quarter = robot.mass * GRAVITY / 4
    ahead = np.random.default_rng(3).random((24, 4))

    def load(phase):
        return quarter * (1.0 - np.sin(2 * pi * phase))  # what a leg carries, on average over postures

    laws = [replace(law, shift=0.0, delay=0.0) for law in LAWS.values() for _ in ahead]
    phases = walked(laws, robot, crawl_gait, np.tile(ahead, (len(LAWS), 1)), load, 6000)[-400:]
    errors = dict(zip(LAWS, np.split(pair_error(phases), len(LAWS), axis=1), strict=True))
    assert errors["cross_load"].max() < 0.005
    assert (errors["wrong_sign"].max(axis=0) > 0.2).all()
    # each for itself: on loads that no body passes on, own_load coordinates nothing
    assert (errors["own_load"].max(axis=0) > 0.1).all()
    assert errors["off"][0] == pytest.approx(pair_error(ahead + crawl_gait.limb_phases), abs=1e-9)


def test_phases_stand_still_until_the_walk_begins(robot, crawl_gait):
    closed = started(Coordinated(), robot, crawl_gait)
    felt = sensed(1, foot_pressure=np.array([30.0, 0, 0, 5]), servo_torque=0.5)
    still = [closed.command(tick, felt) for tick in range(WALK)]
    assert all((c.phase == np.array(crawl_gait.limb_phases)).all() for c in still)
    assert all((c.targets == still[0].targets).all() for c in still)
    moved = [closed.command(WALK + tick, felt) for tick in range(30)]
    assert np.abs(moved[-1].phase - limb_phase(crawl_gait, np.array(START + 0.29))).max() > 1e-4


def test_a_kick_is_a_jump_of_one_run_alone(robot, crawl_gait):
    jump = (0.5, 0.0, -0.1, 0.2)
    closed = start_batch(
        [replace(OFF, kicks=(Kick(2.0, jump),)), OFF], [robot] * 2, [crawl_gait] * 2, [0, 0], 400, PERIOD
    )
    before, after = closed.command(199, None).phase, closed.command(200, None).phase
    assert after - before == pytest.approx(np.array([jump, (0, 0, 0, 0)]) + PERIOD / crawl_gait.period, abs=1e-12)


def test_noise_on_the_feet_follows_the_seed(robot, crawl_gait):
    def phase(seed, loud):
        control = Coordinated(spine=None, tail=None, load_noise=loud)
        closed = start_batch(control, [robot], [crawl_gait], [seed], 400, PERIOD)
        felt = sensed(1, foot_pressure=np.array([12.0, 3.0, 6.0, 9.0]))
        return [closed.command(WALK + i, felt).phase for i in range(40)][-1]

    assert (phase(1, 0.3) == phase(1, 0.3)).all()
    assert np.abs(phase(1, 0.3) - phase(2, 0.3)).max() > 1e-7
    assert np.abs(phase(1, 0.3) - phase(1, 0.0)).max() > 1e-7


# --- spine to spine, tail to tail ---


def test_the_joints_share_out_what_is_lacking_of_the_bend(robot, crawl_gait):
    rule = SpineRule(share=0.25, delay=0.1)
    spine = SpineController([rule, None], [robot] * 2, PERIOD)
    targets = np.zeros((2, 19))
    felt = sensed(2, servo_position=np.where(np.isin(np.arange(19), TRUNK_YAW[:2]), 0.1, 0.0))  # 0.2 of 0.6 rad
    for tick in range(200):
        told = spine.correct(targets, np.array([0.6, 0.6]), felt)
        if tick == 0:
            assert told[0, TRUNK_YAW] == pytest.approx(0.25 * 0.4 * (1 - np.exp(-0.1)))
    assert told[0, TRUNK_YAW] == pytest.approx(0.25 * 0.4)
    assert np.delete(told[0], TRUNK_YAW) == pytest.approx(0.0)
    assert (told[1] == 0.0).all()


def test_no_joint_is_told_to_leave_its_range(robot, crawl_gait):
    spine = SpineController([SpineRule(share=2.0, delay=0.0)], [robot], PERIOD)
    told = spine.correct(np.zeros((1, 19)), np.array([3.0]), sensed(1))
    assert told[0, TRUNK_YAW] == pytest.approx(robot.spine.yaw_range[1])


def test_the_tail_gives_way_to_its_torque_within_its_range(robot, crawl_gait):
    limbs_gait = GAITS["limbs_tail_lifted"]
    gaits = [crawl_gait, crawl_gait, crawl_gait, limbs_gait]
    rule = TailRule(rate=0.5)
    tail = TailController([rule, rule, None, rule], [robot] * 4, gaits, PERIOD)
    pitch = np.array([gait.number("tail_pitch") for gait in gaits])
    targets = np.zeros((4, 19))
    targets[:, PITCH] = pitch
    torque = np.zeros((4, 19))
    torque[:, PITCH] = [-0.4, 0.4, -0.4, -0.4]  # negative: the servo holds the tail up
    told = tail.correct(targets, sensed(4, servo_torque=torque))
    assert told[:, PITCH] == pytest.approx(pitch + np.array([0.002, -0.002, 0.0, 0.0]))
    for _ in range(2000):
        told = tail.correct(targets, sensed(4, servo_torque=torque))
    # a lifted tail stays lifted
    assert told[:, PITCH] == pytest.approx(
        [rule.lowest, rule.highest, crawl_gait.number("tail_pitch"), limbs_gait.number("tail_pitch")]
    )


# --- the heading loop ---

STEERED = replace(OFF, heading=HeadingRule())


def test_a_robot_that_is_straight_is_not_steered(robot, crawl_gait):
    closed, table = started(STEERED, robot, crawl_gait), started(OpenLoop(), robot, crawl_gait)
    for tick in range(WALK, WALK + 50):
        found = closed.command(tick, sensed(1, orientation=turned(0.7)))  # the first direction is the asked one
        assert (found.targets == table.command(tick, None).targets).all()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_robot_that_has_turned_strides_longer_on_that_side(robot, crawl_gait, side):
    closed = started(STEERED, robot, crawl_gait)
    closed.command(WALK, sensed(1))
    for tick in range(WALK + 1, WALK + 200):
        found = closed.command(tick, sensed(1, orientation=turned(0.4 * side))).targets
    table = started(OFF, robot, crawl_gait).command(tick, None).targets
    yaws = [0, 3, 6, 9]
    longer = np.abs(found[0, yaws]) > np.abs(table[0, yaws])
    assert longer.tolist() == ([True, False, True, False] if side > 0 else [False, True, False, True])
    bias = found[0, TRUNK_YAW].sum() - table[0, TRUNK_YAW].sum()
    assert np.sign(bias) == -side


def test_the_direction_of_the_body_counts_not_that_of_the_pelvis(robot, crawl_gait):
    closed, table = started(STEERED, robot, crawl_gait), started(OpenLoop(), robot, crawl_gait)
    closed.command(WALK, sensed(1))
    bent = np.where(np.isin(np.arange(19), TRUNK_YAW), 0.2, 0.0)
    for tick in range(WALK + 1, WALK + 50):  # pelvis 0.3 to the right, trunk bent 0.6 to the left
        found = closed.command(tick, sensed(1, orientation=turned(-0.3), servo_position=bent)).targets
        assert found == pytest.approx(table.command(tick, None).targets, abs=1e-9)


def test_a_turn_beyond_half_a_circle_is_not_forgotten(robot, crawl_gait):
    gentle = replace(OFF, heading=HeadingRule(gain=0.1, integral_gain=0.0, trunk=0.1))
    closed = started(gentle, robot, replace(crawl_gait, period=0.2))
    found = [closed.command(WALK + i, sensed(1, orientation=turned(0.05 * i))) for i in range(101)]
    wait = [closed.command(WALK + 101 + i, sensed(1, orientation=turned(5.0))) for i in range(40)]
    del found
    bend = wait[-1].targets[0, TRUNK_YAW].sum() - trunk_bend(replace(crawl_gait, period=0.2), wait[-1].phase)[0]
    assert bend == pytest.approx(-0.1 * 0.1 * 5.0, abs=1e-9)


def test_steering_stops_at_the_reach_of_the_legs(robot, crawl_gait):
    closed = started(replace(OFF, heading=HeadingRule(gain=100.0, most=10.0)), robot, crawl_gait)
    closed.command(WALK, sensed(1))
    for tick in range(WALK + 1, WALK + 400):
        assert np.isfinite(closed.command(tick, sensed(1, orientation=turned(1.0))).targets).all()


# --- what breaks ---


def test_a_robot_that_came_apart_does_not_break_the_others(robot, crawl_gait):
    control = Coordinated(heading=HeadingRule())
    both, alone = started(control, robot, crawl_gait, runs=2), started(control, robot, crawl_gait, runs=1)
    rng = np.random.default_rng(5)
    for tick in range(WALK - 5, WALK + 60):
        fine = {"foot_pressure": rng.uniform(0, 20, (1, 4)), "servo_torque": rng.normal(size=(1, 19))}
        bad = {name: np.concatenate([v, np.full_like(v, np.nan)]) for name, v in fine.items()}
        bad |= {"orientation": np.array([[1.0, 0, 0, 0], [np.nan] * 4])}
        found, expected = both.command(tick, sensed(2, **bad)), alone.command(tick, sensed(1, **fine))
        assert np.isfinite(found.targets).all()
        assert found.targets[0] == pytest.approx(expected.targets[0], abs=1e-12)


def test_a_law_of_pairs_refuses_a_gait_without_them(robot, crawl_gait):
    walk = replace(crawl_gait, name="walk", limb_phases=(0.0, 0.5, 0.75, 0.25), duty_factor=0.7)
    with pytest.raises(OutsideLimits, match=r"gait 'walk' .* use the law 'off' or 'own_load'"):
        started(Coordinated(), robot, walk)
    started(Coordinated(limbs=LAWS["own_load"]), robot, walk)
    started(Coordinated(), robot, crawl_gait.mirrored())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: LimbLaw(own=np.nan), "limb_law.own is nan"),
        (lambda: LimbLaw(delay=-1.0), "limb_law.delay is -1 s; 0 to 10 s is allowed"),
        (lambda: SpineRule(share=5.0), "spine_rule.share is 5; 0 to 2 is allowed"),
        (lambda: TailRule(lowest=-0.5), "highest must be at most lowest"),
        (lambda: HeadingRule(most=-1.0), "heading_rule.most is -1"),
        (lambda: Kick(1.0, (0.1, 0.2, 3.0, 0.0)), r"kick.ahead\[2\] is 3 cycle"),
        (lambda: Kick(-1.0, (0.0, 0.0, 0.0, 0.0)), "kick.at is -1 s"),
        (lambda: Coordinated(load_noise=-0.1), "coordinated.load_noise is -0.1"),
    ],
)
def test_impossible_rules_are_refused(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make()
