"""Swimming to a goal and ashore as tasks: what is seen, rewarded, ended and refused."""

from dataclasses import fields, replace
from math import radians, sin

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed: pip install suchus[gym]")

from suchus.apps import envs  # noqa: E402
from suchus.apps.envs.pack import Pack  # noqa: E402
from suchus.apps.envs.senses import decode_observations  # noqa: E402
from suchus.core.errors import InvalidDesign, OutsideLimits, SuchusError, UnknownName  # noqa: E402
from suchus.robot.control import Amphibious, HeadingHold, HeadingRule, Swimming  # noqa: E402
from suchus.robot.motion import cycle_targets  # noqa: E402
from suchus.robot.robots import ROBOTS  # noqa: E402
from suchus.sim.land import Ground, Lake, Wave  # noqa: E402
from suchus.sim.land.lake import up_direction  # noqa: E402

SWIM, SHORE = envs.TASKS["Swim"], envs.TASKS["Shore"]
NEAR = envs.Goal(distance=0.4, within=0.1, bearing=0.3)
MOVING = Lake(level=0.5, wave=Wave(height=0.02, length=0.8), current=(0.05, -0.02))


def begun(task, count=1, seed=0):
    """Return a pack whose episodes have begun, by seeds that follow each other."""
    pack = Pack(task, count)
    pack.restart(range(count), [np.random.default_rng(seed + i) for i in range(count)])
    return pack


def shifted(pack, by):
    """Put every robot of a pack elsewhere, by a vector [m], and bring the readings up to date."""
    pack.loop.batch.qpos[:, :3] += by
    pack.loop.batch.physics.forward()
    pack.loop.batch.read_sensors(slice(None))


@pytest.mark.parametrize("name", ["Swim", "Shore"])
def test_many_swimmers_in_one_batch_are_as_many_single_environments_to_the_byte(name):
    count, short = 2, 5
    one = gymnasium.make_vec(
        f"suchus/{name}-v0", num_envs=count, vectorization_mode="vector_entry_point", max_episode_steps=short
    )
    many = [gymnasium.make(f"suchus/{name}-v0", max_episode_steps=short) for _ in range(count)]
    seen, _ = one.reset(seed=5)
    for i, env in enumerate(many):
        np.testing.assert_array_equal(seen[i], env.reset(seed=5 + i)[0])
    random = np.random.default_rng(1)
    for _ in range(short):
        actions = random.uniform(-1, 1, one.action_space.shape).astype(np.float32)
        seen, rewards, over, late, infos = one.step(actions)
        for i, env in enumerate(many):
            theirs = env.step(actions[i])
            np.testing.assert_array_equal(seen[i], theirs[0])
            assert (rewards[i], over[i], late[i]) == theirs[1:4]
            assert infos["approach"][i] == theirs[4]["approach"] != 0.0
    assert late.all()


@pytest.mark.parametrize("task", [replace(SWIM, lake=MOVING), SHORE], ids=["Swim", "Shore"])
def test_an_episode_after_others_is_the_first_of_a_fresh_batch_to_the_byte(task):
    used, fresh = begun(task, 2), Pack(task, 2)
    for _ in range(3):
        used.act(np.ones((2, 19)), np.ones(2, dtype=bool))
    floated = used.loop.batch.qpos[0, :3].copy()
    for pack in (used, fresh):
        pack.restart([1], [np.random.default_rng(7)])
        first = pack.record(1)
        assert float(first.water_force.sel(xyz="z")[0]) == pytest.approx(9.81 * task.robot.mass, rel=0.05)
        for _ in range(4):
            pack.act(np.full((2, 19), 0.2), np.array([False, True]))
    np.testing.assert_array_equal(used.feel()[1], fresh.feel()[1])
    np.testing.assert_array_equal(used.loop.batch.qpos[1], fresh.loop.batch.qpos[1])
    np.testing.assert_array_equal(used.loop.batch.waters.rows[1], fresh.loop.batch.waters.rows[1])
    np.testing.assert_array_equal(used.loop.batch.qpos[0, :3], floated)  # the other one waits meanwhile


def test_equal_seeds_give_equal_goals_and_others_do_not():
    goals = [begun(SWIM, seed=seed)._goals[0] for seed in (3, 3, 4)]
    np.testing.assert_array_equal(goals[0], goals[1])
    assert not np.array_equal(goals[0], goals[2])
    bearings = [begun(SWIM, 40).chances[i].bearing for i in range(0, 40, 8)]
    assert max(np.abs(bearings)) <= SWIM.goal.bearing
    assert min(bearings) < 0 < max(bearings)


def test_the_goal_is_seen_in_the_frame_of_the_root():
    pack = begun(replace(SWIM, jitter=0.0))
    turn = Rotation.from_euler("zyx", [0.7, -0.2, 0.1])
    pack.loop.batch.qpos[0, 3:7] = turn.as_quat(scalar_first=True)
    shifted(pack, np.zeros(3))
    centre = pack.loop.sensors["centre_of_mass"][0, :2]
    pack._goals[0] = centre + 0.9 * np.array([0.6, 0.8])
    seen = pack.feel()
    np.testing.assert_allclose(
        envs.reading_columns(seen, "goal_direction", SWIM.robot)[0], turn.inv().apply([0.6, 0.8, 0.0]), atol=1e-6
    )
    scale = 4 * SWIM.robot.length
    assert envs.reading_columns(seen, "goal_distance", SWIM.robot)[0, 0] == pytest.approx(0.8 / scale, rel=1e-6)
    pack._goals[0] = centre
    assert not envs.reading_columns(pack.feel(), "goal_direction", SWIM.robot).any()
    dry = envs.CrocodileVectorEnv(1, "Crawl")
    with pytest.raises(UnknownName, match="no reading named 'goal_direction'"):
        envs.reading_columns(dry.reset(seed=0)[0], "goal_direction")


def test_who_swims_to_the_goal_gets_more_than_who_rests_and_who_drifts_away_less():
    near = replace(SWIM, goal=NEAR)
    centre = tuple(Pack(near, 1).centre)
    away = replace(near, lake=Lake(level=0.5, current=(-0.2, 0.0)))
    swims, rests, drifts = (
        envs.play(task, policy, episodes=3, steps=70)
        for task, policy in (
            (near, envs.SwimToGoal(task=near, centre=centre)),
            (near, envs.HoldStill(near)),
            (away, envs.HoldStill(away)),
        )
    )
    assert swims.goal.all()
    assert not rests.goal.any()
    np.testing.assert_allclose(swims.approach, NEAR.distance - NEAR.within, atol=1e-9)
    assert swims.returns.min() > 0.8 * (10 * swims.approach[0] + 5)
    assert abs(rests.returns).max() < 0.5
    assert drifts.returns.max() < rests.returns.min() - 0.5
    assert swims.durations.max() < rests.durations.min() == pytest.approx(3.5)


def test_the_shelf_s_swim_fits_into_the_actions_and_the_steering_turns_both_ways():
    centre = tuple(Pack(SWIM, 1).centre)
    swim = envs.SwimToGoal(task=SWIM, centre=centre)
    clock = np.linspace(0.0, 1.0, 20, endpoint=False)
    seen = np.zeros((20, envs.CrocodileEnv("Swim").observation_space.shape[0]))
    envs.reading_columns(seen, "clock", SWIM.robot)[:] = np.column_stack(
        [np.sin(2 * np.pi * clock), np.cos(2 * np.pi * clock)]
    )
    envs.reading_columns(seen, "goal_direction", SWIM.robot)[:] = [1.0, 0.0, 0.0]
    straight = swim(seen)
    assert np.abs(straight).max() < 1.0
    expected = cycle_targets(SWIM.robot, SWIM.swimming_gait, clock + SWIM.decision)
    np.testing.assert_allclose(np.array(centre) + SWIM.span * straight, expected, atol=1e-12)
    envs.reading_columns(seen, "goal_direction", SWIM.robot)[:] = [0.0, 1.0, 0.0]
    left = swim(seen)
    envs.reading_columns(seen, "goal_direction", SWIM.robot)[:] = [0.0, -1.0, 0.0]
    cable = -1
    assert np.ptp(np.sign((left - swim(seen))[:, cable])) == 0
    assert np.abs(left).max() < 1.0


@pytest.mark.parametrize("name", ["Swim", "Crawl"])
def test_a_controller_feels_through_the_observation_what_the_robot_feels(name):
    task = envs.TASKS[name]
    pack = begun(task, 2)
    pack.act(0.1 * np.ones((2, 19)), np.ones(2, dtype=bool))
    ours, theirs = decode_observations(pack.feel(), task.robot, 0.05), pack.loop.sensed()
    for field in fields(ours):
        if field.name not in ("time", "depth", "orientation"):
            np.testing.assert_allclose(getattr(ours, field.name), getattr(theirs, field.name), atol=1e-5, rtol=1e-5)
    same = np.abs(np.einsum("ij,ij->i", ours.orientation, theirs.orientation))
    np.testing.assert_allclose(same, 1.0, atol=1e-9)


def test_a_controller_of_the_shelf_swims_through_the_actions_with_its_heading_held():
    near = replace(SWIM, goal=replace(NEAR, bearing=0.0), jitter=0.0)
    centre = tuple(Pack(near, 1).centre)
    control, gait = Swimming(heading=HeadingHold()), SWIM.swimming_gait
    policy = envs.ControllerPolicy(near, centre, control, steps=100, gait=gait)
    played = envs.play(near, policy, episodes=1, steps=100)
    assert played.goal.all()
    away = replace(control, heading=HeadingHold(direction=1.5))
    policy = envs.ControllerPolicy(near, centre, away, steps=100, gait=gait)
    played = envs.play(near, policy, episodes=1, steps=100)
    assert not played.goal.any()


def test_the_clock_goes_with_the_swimming_motion():
    slow = replace(SWIM.swimming_gait, period=2.0)
    assert (SWIM.period, replace(SWIM, swim=slow).period) == (pytest.approx(1.0), pytest.approx(2.0))
    assert envs.TASKS["Crawl"].period == envs.TASKS["Crawl"].gait.period


def test_a_controller_of_the_shelf_comes_ashore_through_the_actions_and_gets_more_than_who_rests():
    steep = radians(12)  # a shorter way, and less to compute, than that of the task
    near = replace(SHORE, ground=Ground(uphill=steep), lake=Lake(level=1.1 * sin(steep)), goal=envs.Landing(beyond=0.1))
    centre = tuple(Pack(near, 1).centre)
    holds = Swimming(heading=HeadingHold())
    control, steps = Amphibious(swim=near.swimming_gait, swimming=holds, heading=HeadingRule()), 400
    comes = envs.play(near, envs.ControllerPolicy(near, centre, control, steps=steps), episodes=1, steps=steps)
    rests = envs.play(near, envs.HoldStill(near), episodes=1, steps=40)
    assert comes.goal.all()
    assert comes.approach[0] == pytest.approx(comes.forward[0], abs=0.02)  # it overshoots the line a little
    assert comes.returns[0] > 10 * comes.approach[0] > 10 > 1 > abs(rests.returns[0])


@pytest.mark.parametrize(("short_of", "reached"), [(0.04, False), (-0.04, True)])
def test_an_episode_ends_ashore_beyond_the_line_and_not_before(short_of, reached):
    env = envs.CrocodileEnv("Shore")
    env.reset(seed=0)
    pack, line = env.pack, SHORE.lake.level / np.sin(SHORE.ground.uphill)
    assert (up_direction(SHORE.ground) @ [line, 0.0, 0.0]) == pytest.approx(SHORE.lake.level)
    assert env.step(np.zeros(19))[2] is False
    ahead = line + 1.0 - short_of - pack.loop.sensors["centre_of_mass"][0, 0]
    shifted(pack, [ahead, 0.3, 0.3])
    before = pack.remaining[0]
    _, reward, over, _, info = env.step(np.zeros(19))
    assert (over, info["goal"]) == (reached, reached)
    assert info["approach"] == pytest.approx(before - pack.remaining[0], abs=1e-12)
    assert info["cause"] == ("it reached the goal at 0.10 s" if reached else "")
    assert (reward > 4.0) == reached


def test_a_robot_that_rolls_over_at_the_goal_has_not_reached_it():
    pack = begun(replace(SWIM, goal=envs.Goal(distance=0.2, within=0.19)))
    pack._goals[0] = pack.loop.sensors["centre_of_mass"][0, :2]
    pack.loop.batch.qpos[0, 3:7] = [0, 1, 0, 0]
    terms = pack.act(np.zeros((1, 19)), np.ones(1, dtype=bool))
    assert (terms.fall[0], terms.goal[0], terms.is_over[0]) == (True, False, True)
    assert "it rolled over" in pack.causes[0]


def test_servos_lose_torque_with_speed_in_water_too():
    assert SWIM.speed_lines
    assert SHORE.speed_lines
    assert SWIM.body == SWIM.robot
    assert SWIM.robot.servo("LF_yaw").winding is not None


def rigid():
    """Return a robot whose axis does not bend."""
    robot = ROBOTS["strider"]
    return replace(robot, name="rigid", axis=tuple(replace(segment, hinges=()) for segment in robot.axis))


@pytest.mark.parametrize("name", ["swimmer", "pleurobot"])
def test_any_body_that_floats_and_bends_swims_to_the_goal(name):
    near = replace(SWIM.for_robot(ROBOTS[name]), goal=replace(NEAR, bearing=0.0), jitter=0.0)
    policy = envs.SwimToGoal(task=near, centre=tuple(Pack(near, 1).centre))
    swum = envs.play(near, policy, episodes=1, steps=100)
    rests = envs.play(near, envs.HoldStill(near), episodes=1, steps=100)
    assert swum.forward[0] > 0.1 > 10 * abs(rests.forward[0])


@pytest.mark.parametrize(
    ("task", "changes", "error", "text"),
    [
        ("Swim", {"robot": "caiman"}, InvalidDesign, r"robot 'caiman' sinks: it is 999 g heavier"),
        (
            "Swim",
            {"robot": rigid()},
            SuchusError,
            "a task that begins swimming needs an axis that bends sideways",
        ),
        ("Swim", {"robot": "strider"}, InvalidDesign, r"robot 'strider' sinks"),
        (
            "Shore",
            {"robot": "swimmer"},
            SuchusError,
            "a task that ends on land needs limbs to walk on; robot",
        ),
        ("Swim", {"lake": None}, InvalidDesign, r"needs water: give it a land\.Lake"),
        ("Swim", {"lake": 1.0}, InvalidDesign, "a Lake or None is needed"),
        ("Swim", {"lake": Lake(level=((0.0, 0.4), (5.0, 0.5)))}, InvalidDesign, "give each as one number"),
        ("Swim", {"lake": Lake(level=0.04)}, InvalidDesign, "'floating_caiman' touches the ground"),
        ("Swim", {"goal": 3}, InvalidDesign, "a Goal or Landing or None is needed"),
        ("Shore", {"ground": Ground()}, InvalidDesign, "it needs a lake and ground that rises ahead"),
        ("Crawl", {"goal": envs.Landing()}, InvalidDesign, r"task\.lake is None and"),
        ("Crawl", {"lake": Lake(level=0.1, air_fraction=0.5)}, InvalidDesign, "has no air that it could let out"),
    ],
)
def test_what_cannot_swim_is_refused_in_a_sentence(task, changes, error, text):
    with pytest.raises(error, match=text) as said:
        envs.CrocodileEnv(task, **changes)
    assert str(said.value).count(". ") <= 1


def test_a_goal_and_a_swim_that_cannot_be_are_refused():
    with pytest.raises(InvalidDesign, match="within must be less"):
        envs.Goal(distance=0.1, within=0.1)
    with pytest.raises(InvalidDesign, match="0 to 1000 m is allowed"):
        envs.Landing(beyond=-1.0)
    wide = SWIM.swimming_gait.with_numbers(tail_bend=3.0)
    with pytest.raises(OutsideLimits, match="tail"):
        envs.CrocodileEnv("Swim", swim=wide)
