"""Tasks with commands: what is observed and rewarded, delay and noise, and faults that the robot is told of."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="not installed: pip install 'suchus[gym]'")

import gymnasium

from suchus.apps.envs import (
    TASKS,
    Breaks,
    CommandRanges,
    CrocodileVectorEnv,
    GaitFollower,
    mirror_actions,
    mirror_observations,
    play,
    reading_columns,
)
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.control.observation import FAILURE_READINGS, observation_layout
from suchus.robot.control.policy import mirror_shift
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Limp, Persistence, Tolerances
from suchus.sim.land.lake import gravity
from suchus.sim.model import compile_model

VELOCITY = TASKS["Velocity"]
AS_DESIGNED = {"tolerances": None, "slope": 0.0}
STRIDER = replace(VELOCITY.for_robot(ROBOTS["strider"]), **AS_DESIGNED)


def follower(task, env):
    return GaitFollower(task=task, centre=tuple(env.pack.centre), gait=task.gait)


def test_spells_of_an_intermittent_fault_differ_between_episodes_and_repeat_with_the_seed():
    flickers = Limp("LF_yaw", persistence=Persistence(rate=1.0, length=0.2, seed=3))
    stays = Limp("LF_yaw", persistence=Persistence(duration=1.0, seed=3))
    breaks, robot = Breaks(faults=(flickers,)), ROBOTS["caiman"]
    random = np.random.default_rng(0)
    drawn = [breaks.draw(random, robot).persistence for _ in range(5)]
    assert len({persistence.seed for persistence in drawn}) == 5
    assert {replace(persistence, seed=3) for persistence in drawn} == {flickers.persistence}
    again = np.random.default_rng(0)
    assert [breaks.draw(again, robot).persistence for _ in range(5)] == drawn
    assert Breaks(faults=(stays,)).draw(random, robot) == stays


def test_velocity_is_known_to_gymnasium_and_shows_what_a_robot_measures():
    env = gymnasium.make("suchus/Velocity-v0", robot="strider")
    seen, _ = env.reset(seed=3)
    assert env.observation_space.contains(seen)
    names = [sense.name for sense in observation_layout(ROBOTS["strider"], STRIDER.observed)]
    assert {"command", "heading_error", "tracking_error", "servo_position", "angular_velocity"} <= set(names)
    assert not {"ahead", "foot_pressure", "belly_pressure", "failure"} & set(names)
    seen, reward, *_, info = env.step(env.action_space.sample())
    assert reward < 0.0
    assert info["speed_error"] >= 0.0


def test_commands_are_drawn_anew_and_seen_in_parts_of_the_greatest():
    task = replace(STRIDER, noise=0.0, commands=CommandRanges(forward=(0.1, 0.4), turn=(-0.5, 0.5), interval=0.2))
    env = CrocodileVectorEnv(2, task)
    seen, _ = env.reset(seed=5)
    commands = []
    for _ in range(9):
        shown = reading_columns(seen, "command", task.robot, task.observed)
        assert shown * (0.4, 0.5) == pytest.approx(env.pack.command, abs=1e-6)
        commands.append(env.pack.command[0].tolist())
        seen, *_ = env.step(np.zeros(env.action_space.shape))
    assert commands[0] == commands[3]
    assert commands[3] != commands[4]
    assert all(0.1 <= speed <= 0.4 and abs(turn) <= 0.5 for speed, turn in commands)


def test_who_walks_as_commanded_is_paid_more_than_who_stands():
    task = replace(STRIDER, noise=0.0, delay=0.0, commands=CommandRanges(forward=(0.19, 0.2), turn=(-0.01, 0.01)))
    env = CrocodileVectorEnv(2, task)
    walked = play(task, follower(task, env), episodes=2, steps=100)
    stood = play(task, lambda seen: np.zeros((len(seen), len(layout(task.robot).servos))), episodes=2, steps=100)
    assert walked.returns.mean() > stood.returns.mean() + 2.0
    assert stood.returns.mean() == pytest.approx(task.rewards.speed_error * 0.195 * 5.0, rel=0.15)


def test_a_delay_is_the_same_motion_later():
    task = replace(STRIDER, noise=0.0, delay=0.0, jitter=0.0)
    late = replace(task, delay=0.02)
    actions = np.random.default_rng(0).uniform(-0.3, 0.3, (6, 1, len(layout(task.robot).servos)))
    targets = {}
    for chosen in (task, late):
        env, rows = CrocodileVectorEnv(1, chosen), []
        env.reset(seed=1)
        advance = env.pack.loop.advance

        def noted(env=env, rows=rows, advance=advance, **settings):
            rows.append(env.pack.loop.command.targets[0].copy())
            advance(**settings)

        env.pack.loop.advance, env.pack.loop.advance_many = noted, lambda _: None
        for action in actions:
            env.step(action)
        targets[chosen.delay] = np.array(rows)
    assert np.array_equal(targets[0.02][2:], targets[0.0][:-2])
    assert not np.array_equal(targets[0.02], targets[0.0])


def test_noise_depends_on_the_seed_alone():
    task = replace(STRIDER, noise=0.05)
    three, one = CrocodileVectorEnv(3, task), CrocodileVectorEnv(1, task)
    seen, _ = three.reset(seed=7)
    alone, _ = one.reset(seed=8)
    assert seen[1].tobytes() == alone[0].tobytes()
    silent, _ = CrocodileVectorEnv(1, replace(task, noise=0.0)).reset(seed=8)
    assert 0.02 < np.std(alone - silent) < 0.08


def test_the_heading_error_grows_where_a_turn_is_commanded_and_not_made():
    task = replace(STRIDER, noise=0.0, commands=CommandRanges(forward=(0.1, 0.2), turn=(0.29, 0.3)))
    env = CrocodileVectorEnv(1, task)
    env.reset(seed=0)
    for _ in range(20):
        seen, *_ = env.step(np.zeros(env.action_space.shape))
    error = reading_columns(seen, "heading_error", task.robot, task.observed)[0, 0]
    assert error == pytest.approx(0.295 * 20 * task.decision, abs=0.05)


def test_a_robot_is_told_of_its_fault_from_its_time_on():
    breaks = Breaks(joints=("LF_yaw",), earliest=0.2, latest=0.2)
    task = replace(TASKS["Fault"], breaks=breaks, shows_failures=True)
    env = CrocodileVectorEnv(1, task)
    seen, _ = env.reset(seed=0)
    shown = []
    for _ in range(6):
        shown.append(reading_columns(seen, "failure", task.robot, task.observed)[0])
        seen, *_ = env.step(np.zeros(env.action_space.shape))
    servo = layout(task.robot).servos.index("LF_yaw")
    assert [row[servo] for row in shown] == [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    assert sum(row.sum() for row in shown) == 2.0


def test_the_tasks_in_water_take_commands_too():
    env = gymnasium.make("suchus/Swim-v0", commands=CommandRanges(forward=(0.05, 0.1)))
    seen, _ = env.reset(seed=0)
    assert seen.shape == (108,)
    env.step(env.action_space.sample())


def test_what_cannot_be_is_refused():
    with pytest.raises(InvalidDesign, match="readings has command, heading_error, which need"):
        replace(TASKS["Crawl"], readings=("clock", "command", "heading_error"))
    with pytest.raises(UnknownName, match="colour"):
        replace(TASKS["Crawl"], readings=("clock", "colour"))
    with pytest.raises(InvalidDesign, match=r"delay is 0\.013 s; whole control periods"):
        replace(TASKS["Crawl"], delay=0.013)
    with pytest.raises(InvalidDesign, match=r"commands\.forward"):
        CommandRanges(forward=(0.2, 0.1))
    assert "failure" in FAILURE_READINGS
    assert GAITS["low_crawl"] == VELOCITY.gait
    with pytest.raises(InvalidDesign, match=r"task\.slope is 1 rad"):
        replace(VELOCITY, slope=1.0)
    with pytest.raises(InvalidDesign, match="a goal lies on the ground as it is"):
        replace(TASKS["Swim"], slope=0.1)
    with pytest.raises(InvalidDesign, match="in which every robot is as designed"):
        replace(TASKS["Swim"], lake=None, goal=None, water="slice", tolerances=Tolerances())
    with pytest.raises(InvalidDesign, match=r"task\.tolerances is 'loose'; a Tolerances or None is needed"):
        gymnasium.make("suchus/Velocity-v0", tolerances="loose")


def test_velocity_has_built_robots_slopes_delay_and_noise_by_default():
    assert VELOCITY.tolerances == Tolerances()
    assert min(VELOCITY.slope, VELOCITY.delay, VELOCITY.noise) > 0.0
    assert VELOCITY.tolerances.backlash > 0.0


@pytest.mark.parametrize(
    ("task", "robot"), [("Velocity", "caiman"), ("Velocity", "strider"), ("Swim", "floating_caiman")]
)
def test_each_episode_has_the_robot_of_its_seed(task, robot):
    chosen = replace(TASKS[task].for_robot(ROBOTS[robot]), tolerances=Tolerances(), slope=0.0)
    env = CrocodileVectorEnv(2, chosen)
    env.reset(seed=[3, 4])
    env.reset(seed=[5, None], options={"reset_mask": np.array([True, False])})
    pack = env.pack
    run = pack.loop.runs[0]
    for i, chance in enumerate(pack.chances):
        built = Tolerances().draw_run(run, chance.body_seed)
        model = compile_model(built.robot, chosen.timestep)
        body_mass = pack.loop.batch.field("body_mass", i)
        assert body_mass[: model.nbody] == pytest.approx(model.body_mass, rel=1e-12)
        assert not np.allclose(body_mass[: model.nbody], compile_model(chosen.robot, chosen.timestep).body_mass)
        friction = pack.loop.batch.field("geom_friction", i)[1:, 0]
        assert friction == pytest.approx(built.ground.friction_scale * pack.loop.batch.model.geom_friction[1:, 0])
        errors = pack.loop.disturbances
        assert errors._zero_error[errors._inexact_sims.index(i)].tolist() == list(built.zero_error)
        assert (2 * errors._half_play[errors._inexact_sims.index(i)]).tolist() == pytest.approx(list(built.play))
    assert pack.chances[0].body_seed != pack.chances[1].body_seed


def test_an_episode_depends_on_its_seed_and_not_on_the_robots_beside_it_or_before_it():
    def final(env, seeds, row):
        env.reset(seed=seeds)
        for action in actions:
            seen, *_ = env.step(np.tile(action, (env.num_envs, 1)))
        return seen[row].tobytes()

    task = VELOCITY.for_robot(ROBOTS["strider"])
    actions = np.random.default_rng(0).uniform(-0.3, 0.3, (8, len(layout(task.robot).servos)))
    three, one = CrocodileVectorEnv(3, task), CrocodileVectorEnv(1, task)
    alone = final(one, 8, 0)
    assert final(three, 7, 1) == alone
    assert final(one, 9, 0) != alone
    assert final(one, 8, 0) == alone


def test_fast_physics_has_the_longest_step_unless_another_is_named():
    assert gymnasium.make("suchus/Velocity-v0", fast=True).unwrapped.task.timestep == 0.01
    assert gymnasium.make("suchus/Velocity-v0", fast=True, timestep=0.005).unwrapped.task.timestep == 0.005
    assert gymnasium.make("suchus/Velocity-v0").unwrapped.task.timestep == 0.005


def test_the_slope_of_an_episode_is_drawn():
    env = CrocodileVectorEnv(3, replace(VELOCITY, tolerances=None, ground=Ground(uphill=0.1)))
    env.reset(seed=1)
    slopes = []
    for i, chance in enumerate(env.pack.chances):
        expected = gravity(Ground(uphill=0.1 + chance.uphill, sideways=chance.sideways))
        assert env.pack.loop.batch.field("opt.gravity", i) == pytest.approx(expected)
        slopes += [chance.uphill, chance.sideways]
    assert len(set(slopes)) == 6
    assert np.abs(slopes).max() <= VELOCITY.slope


@pytest.mark.parametrize("robot", ["caiman", "strider", "pleurobot"])
def test_a_mirrored_robot_observes_the_mirror_image_to_the_last_digits(robot):
    """Two robots of which one does the mirror image of the other: the property that mirrored experience rests on."""
    commands = CommandRanges(forward=(0.09, 0.1), turn=(-0.0001, 0.0001))
    plain = {**AS_DESIGNED, "noise": 0.0, "delay": 0.0, "jitter": 0.0}
    task = replace(VELOCITY.for_robot(ROBOTS[robot]), **plain, commands=commands)
    env = CrocodileVectorEnv(2, task)
    env.reset(seed=1)
    env.pack._phases[1] = env.pack._phases[0] + mirror_shift(task.gait)
    random = np.random.default_rng(0)
    for _ in range(20):
        action = random.uniform(-0.4, 0.4, env.action_space.shape[1])
        seen, *_ = env.step(np.stack([action, mirror_actions(action, task)]))
    mirrored = mirror_observations(seen[0], task)
    column = {sense.name: sense.columns for sense in observation_layout(task.robot, task.observed)}
    compared = np.ones(len(mirrored), dtype=bool)
    compared[column["command"]] = False
    assert seen[1][compared] == pytest.approx(mirrored[compared], abs=1e-3)
    assert np.abs(seen[1] - seen[0])[column["servo_position"]].max() > 0.05


def test_a_gait_without_a_mirror_image_has_no_mirrored_observations():
    lopsided = replace(GAITS["belly_crawl"], limb_phases=(0.0, 0.3, 0.5, 0.9))
    task = replace(TASKS["Crawl"], gait=lopsided)
    with pytest.raises(InvalidDesign, match="is not symmetric"):
        mirror_observations(np.zeros(101, dtype=np.float32), task)
