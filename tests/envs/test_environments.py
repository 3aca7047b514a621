"""The environments keep gymnasium's contract, and their numbers do not depend on who else is in the batch."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed: pip install suchus[gym]")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

from suchus.apps import envs  # noqa: E402
from suchus.apps.envs.pack import Pack, draw  # noqa: E402
from suchus.apps.envs.task import Terms  # noqa: E402
from suchus.core import rotation  # noqa: E402
from suchus.core.errors import InvalidDesign, OutsideLimits, SuchusError, UnknownName  # noqa: E402
from suchus.robot.design import LINE, layout, leg_joints, servo_names, with_values  # noqa: E402
from suchus.robot.design.scale import rescale  # noqa: E402
from suchus.robot.gaits import GAITS, default_gait  # noqa: E402
from suchus.robot.motion import intended  # noqa: E402
from suchus.robot.motion.rising import stretched_length  # noqa: E402
from suchus.robot.robots import ROBOTS  # noqa: E402
from suchus.sim.faults import Locked, Weak  # noqa: E402

CRAWL, STAND, FAULT = (envs.TASKS[name] for name in ("Crawl", "Stand", "Fault"))
DOCS = Path(__file__).parents[2] / "docs" / "environments.md"


def acting(env, steps, seed=0):
    """Step an environment with random actions and yield what it answers."""
    random = np.random.default_rng(seed)
    for _ in range(steps):
        yield env.step(random.uniform(-1, 1, env.action_space.shape).astype(np.float32))


@pytest.mark.parametrize("name", envs.IDS)
def test_an_environment_passes_gymnasium_s_own_check_without_a_warning(name):
    check_env(gymnasium.make(name).unwrapped, skip_render_check=False)  # pytest turns warnings into errors
    task = name.removeprefix("suchus/").removesuffix("-v0")
    assert gymnasium.spec(name).max_episode_steps == envs.MAX_STEPS_BY_TASK.get(task, envs.MAX_STEPS)


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_many_robots_in_one_batch_are_as_many_single_environments_to_the_byte(mode):
    count, short = 3, 12
    breaks = replace(FAULT.breaks, latest=0.4)
    one = gymnasium.make_vec(
        "suchus/Fault-v0",
        num_envs=count,
        vectorization_mode="vector_entry_point",
        autoreset_mode=mode,
        max_episode_steps=short,
        breaks=breaks,
    )
    many = gymnasium.vector.SyncVectorEnv(
        [lambda: gymnasium.make("suchus/Fault-v0", max_episode_steps=short, breaks=breaks)] * count,
        autoreset_mode=mode,
    )
    assert one.observation_space == many.observation_space
    assert one.action_space == many.action_space
    (a, said), (b, told) = one.reset(seed=5), many.reset(seed=5)
    np.testing.assert_array_equal(a, b)
    same(said, told)
    ended = 0
    for ours, theirs in zip(acting(one, 2 * short + 3), acting(many, 2 * short + 3), strict=True):
        for a, b in zip(ours[:4], theirs[:4], strict=True):
            np.testing.assert_array_equal(a, b)
            assert a.dtype == b.dtype
        same(ours[4], theirs[4])
        ended += (ours[2] | ours[3]).sum()
    assert ended >= 2 * count


def same(ours, theirs):
    assert set(ours) == set(theirs)
    for key, value in ours.items():
        if isinstance(value, dict):
            same(value, theirs[key])
        elif key == "final_obs":
            for a, b in zip(value, theirs[key], strict=True):
                np.testing.assert_array_equal(a, b)
        else:
            np.testing.assert_array_equal(value, theirs[key], err_msg=key)


def test_equal_seeds_give_equal_episodes_and_others_do_not():
    env = gymnasium.make("suchus/Stand-v0").unwrapped
    runs = []
    for seed in (3, 3, 4):
        first = env.reset(seed=seed)[0]
        runs.append(np.array([first, *(step[0] for step in acting(env, 5))]))
    np.testing.assert_array_equal(runs[0], runs[1])
    assert not np.array_equal(runs[0], runs[2])


@pytest.mark.parametrize("kind", ["limp", "locked"])
def test_a_robot_that_broke_begins_anew_as_if_nothing_had_happened(kind):
    breaks = envs.Breaks(joints=("LF_pitch",), kinds=(kind,), latest=0.0)
    used, fresh = (Pack(replace(FAULT, breaks=breaks), 2) for _ in range(2))
    used.restart([0, 1], [np.random.default_rng(1), np.random.default_rng(2)])
    used.act(np.ones((2, 19)), np.ones(2, dtype=bool))
    limp = used.loop.batch.physics.expanded("opt.disableactuator")
    locked = used.loop.disturbances.injector.broken(1)
    assert (limp != 0).all() if kind == "limp" else locked == (Locked("LF_pitch", at=0.0),)
    for pack in (used, fresh):
        pack.restart([1], [np.random.default_rng(7)])
        pack.loop.disturbances.schedule(1, [], [])
        for _ in range(4):
            pack.act(np.full((2, 19), 0.3), np.array([False, True]))
    np.testing.assert_array_equal(used.feel()[1], fresh.feel()[1])
    np.testing.assert_array_equal(used.loop.batch.qpos[1], fresh.loop.batch.qpos[1])


def test_the_shelf_s_gait_fits_into_the_actions_and_comes_out_of_them():
    env = envs.CrocodileVectorEnv(1, CRAWL)
    gait = CRAWL.gait
    follow = envs.GaitFollower(task=CRAWL, centre=tuple(env.pack.centre), gait=gait)
    clock = np.linspace(0.0, 1.0, 50, endpoint=False)
    seen = np.zeros((50, env.single_observation_space.shape[0]))
    envs.reading_columns(seen, "clock")[:] = np.column_stack([np.sin(2 * np.pi * clock), np.cos(2 * np.pi * clock)])
    actions = follow(seen)
    assert np.abs(actions).max() < 1.0
    ahead = 1.0 + gait.period * clock + CRAWL.decision
    expected = intended(CRAWL.robot, gait, ahead).targets
    np.testing.assert_allclose(env.pack.centre + CRAWL.span * actions, expected, atol=1e-12)


def test_an_action_is_the_last_commanded_angle():
    env = envs.CrocodileVectorEnv(1, replace(CRAWL, jitter=0.0))
    env.reset(seed=0)
    action = np.linspace(-0.5, 0.5, 19)[None]
    for _ in range(12):
        seen, *_ = env.step(action)
    np.testing.assert_allclose(envs.reading_columns(seen, "last_action"), action, atol=1e-6)
    low, high = env.pack._lower_limits, env.pack._upper_limits
    angles = np.pi * envs.reading_columns(seen, "servo_position")[0]
    commanded = np.clip(env.pack.centre + CRAWL.span * action[0], low, high)
    arms = np.array(["yaw" in name for name in servo_names()])  # these carry no weight
    np.testing.assert_allclose(angles[arms], commanded[arms], atol=0.03)


def test_what_presses_on_the_ground_is_the_weight():
    env = envs.CrocodileVectorEnv(1, CRAWL)
    env.reset(seed=0)
    pressed = []
    for _ in range(40):
        seen, *_ = env.step(np.zeros((1, 19)))
        pressed.append(
            sum(envs.reading_columns(seen, f"{where}_pressure").sum() for where in ("foot", "belly", "tail"))
        )
    assert np.mean(pressed[10:]) == pytest.approx(1.0, abs=0.01)
    np.testing.assert_allclose(envs.reading_columns(seen, "upward")[0], [0, 0, 1], atol=0.1)
    np.testing.assert_allclose(envs.reading_columns(seen, "acceleration")[0], np.array([0, 0, 0.25]), atol=0.03)


def test_the_world_s_axes_are_felt_as_the_pelvis_turns():
    turns = Rotation.random(20, random_state=3)
    upward, ahead = (turn(turns.as_quat(scalar_first=True)) for turn in (rotation.upward, rotation.world_x))
    np.testing.assert_allclose(upward, turns.inv().apply([0, 0, 1]), atol=1e-12)
    np.testing.assert_allclose(ahead, turns.inv().apply([1, 0, 0]), atol=1e-12)


def test_readings_off_their_scale_are_cut_and_lost_ones_are_zero():
    env = envs.CrocodileVectorEnv(2, CRAWL)
    env.reset(seed=0)
    env.pack.loop.batch.readings[0, :19] = np.nan
    env.pack.loop.batch.readings[1, :19] = -7.0
    seen = env.pack.feel()
    np.testing.assert_array_equal(envs.reading_columns(seen, "servo_position"), np.repeat([[0.0], [-1.0]], 19, axis=1))


def test_the_reward_is_the_weighted_sum_of_what_happened():
    terms = Terms(
        forward=np.array([0.5]),
        lateral_drift=np.array([0.25]),
        upright=np.array([0.05]),
        work=np.array([2.0]),
        action_rate=np.array([4.0]),
        approach=np.array([0.125]),
        goal=np.array([True]),
        fall=np.array([True]),
        speed_error=np.array([0.5]),
        turn_error=np.array([0.25]),
    )
    weights = envs.Rewards(
        speed_error=-4.0,
        turn_error=-8.0,
        forward=1.0,
        lateral_drift=2.0,
        upright=20.0,
        work=-0.5,
        action_rate=-1.0,
        fall=-8.0,
        approach=8.0,
        goal=16.0,
    )
    assert terms.reward(weights).tolist() == [0.5 + 0.5 + 1.0 - 1.0 - 4.0 - 8.0 + 1.0 + 16.0 - 2.0 - 2.0]


def test_the_terms_add_up_over_an_episode():
    env = gymnasium.make("suchus/Crawl-v0").unwrapped
    env.reset(seed=2)
    begin = env.pack.record(0).centre_of_mass.values
    forward = lateral_drift = total = weighted = 0.0
    for _, reward, fell, _, info in acting(env, 4):
        assert not fell
        forward, lateral_drift, total = forward + info["forward"], lateral_drift + info["lateral_drift"], total + reward
        weighted += sum(
            getattr(CRAWL.rewards, name) * info[name] for name in ("forward", "lateral_drift", "work", "action_rate")
        )
    end = env.pack.record(0).centre_of_mass.values
    assert forward == pytest.approx(end[0, 0] - begin[0, 0], abs=1e-12)
    assert lateral_drift == pytest.approx(abs(end[0, 1]) - abs(begin[0, 1]), abs=1e-12)
    assert total == pytest.approx(weighted, abs=1e-12)


@pytest.mark.parametrize("kind", ["limp", "locked"])
def test_the_joint_that_was_drawn_breaks_when_it_was_drawn(kind):
    breaks = envs.Breaks(joints=("RH_yaw",), kinds=(kind,), earliest=0.3, latest=0.3)
    env = gymnasium.make("suchus/Fault-v0", breaks=breaks).unwrapped
    assert env.reset(seed=0)[1]["fault"] == f"RH_yaw {kind} from 0.30 s"
    yaw = servo_names().index("RH_yaw")
    wave = [np.eye(19)[yaw] * np.sin(0.9 * i) for i in range(14)]
    seen = np.array([env.step(action)[0] for action in wave])
    torque, angle = (
        envs.reading_columns(seen, "servo_torque")[:, yaw],
        np.pi * envs.reading_columns(seen, "servo_position")[:, yaw],
    )
    assert np.abs(torque[:6]).min() > 0
    if kind == "limp":
        assert (torque[6:] == 0).all()
    else:
        np.testing.assert_allclose(angle[9:], angle[5], atol=0.06)
    assert np.ptp(angle[:6]) > 0.3


def test_faults_are_drawn_from_all_that_are_named():
    random = np.random.default_rng(0)
    drawn = [draw(FAULT, random) for _ in range(300)]
    assert {chance.broken.part for chance in drawn} == set(leg_joints())
    assert {chance.broken.kind() for chance in drawn} == {"limp", "locked"}
    assert max(chance.broken.at for chance in drawn) <= 4.0


def test_a_standing_robot_stays_up_unless_it_is_pushed_too_hard():
    pushed = envs.Pushes(most=40.0, earliest=0.2, latest=0.2)
    calm = envs.play(replace(STAND, pushes=None), envs.HoldStill(STAND), episodes=1, steps=60)
    assert calm.durations.tolist() == pytest.approx([3.0])
    assert calm.returns[0] > 2.5
    env = gymnasium.make("suchus/Stand-v0", pushes=pushed).unwrapped
    env.reset(seed=1)
    for _ in range(60):
        _, reward, fell, _, info = env.step(np.zeros(19))
        if fell:
            break
    assert fell
    assert reward < -4
    assert "the snout is at" in info["cause"]
    assert info["cause"].endswith("m, below 0.45 m")


def test_a_robot_that_comes_apart_ends_its_episode_with_a_sentence_and_the_others_go_on(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its log
    env, alone = (envs.CrocodileVectorEnv(n, CRAWL) for n in (2, 1))
    env.reset(seed=[8, 9])
    alone.reset(seed=[9])
    env.pack.loop.batch.qvel[0, 7] = 1e9
    zero = np.zeros((2, 19))
    seen, rewards, fell, _, infos = env.step(zero)
    theirs, *_ = alone.step(zero[:1])
    assert fell.tolist() == [True, False]
    assert "the simulation diverged at 0.05 s" in infos["cause"][0]
    assert infos["cause"][1] == ""
    assert np.isfinite(seen).all()
    assert rewards[0] == pytest.approx(CRAWL.rewards.fall)
    np.testing.assert_array_equal(seen[1], theirs[0])
    seen, *_ = env.step(zero)
    assert np.isfinite(seen).all()
    assert env.pack.time.tolist() == [0.0, 0.1]


def test_servos_lose_torque_with_speed_unless_it_is_switched_off(former):
    sold = ROBOTS["caiman"].servo("LF_yaw").winding
    of_former = replace(CRAWL, robot=former)
    for asked, lines, winding in (
        (CRAWL, True, sold),
        (CRAWL, False, None),
        (of_former, True, LINE),
        (of_former, False, None),
    ):
        task = replace(asked, speed_lines=lines)
        assert task.body.servo("LF_yaw").winding == winding
        assert task.body.servo("tail_cable").winding == winding
        kind = int(Pack(task, 1).loop.batch.model.actuator("LF_yaw").dyntype[0])
        assert (kind == int(mujoco.mjtDyn.mjDYN_DCMOTOR)) == lines
    assert CRAWL.speed_lines
    with pytest.raises(InvalidDesign, match=r"task\.speed_lines is 1; true or false"):
        replace(CRAWL, speed_lines=1)


@pytest.mark.parametrize(("least", "falls"), [(0.0, False), (0.2, True)])
def test_a_snout_in_the_ground_is_a_fall_only_where_a_height_is_asked_for(least, falls):
    env = envs.CrocodileVectorEnv(1, replace(CRAWL, jitter=0.0, least_height=least))
    env.reset(seed=0)
    fell = [env.step(np.linspace(-0.5, 0.5, 19)[None])[2][0] for _ in range(3)]
    assert any(fell) == falls


def test_a_robot_of_another_size_stands_when_its_episode_begins_and_one_too_weak_is_refused():
    small = rescale(ROBOTS["caiman"], length_factor=0.3, mass_factor=0.027)
    pack = Pack(envs.TASKS["Stand"].for_robot(small), 1)
    pack.restart([0], [np.random.default_rng(0)])
    assert pack.loop.sensors["snout_position"][0, 2] > 0.8 * stretched_length(small)
    weak = with_values(ROBOTS["caiman"], {"spine.pitch_servo.torque": 0.5})
    with pytest.raises(InvalidDesign, match=r"robot 'caiman' falls over as it stands up: its snout is 0\.\d+ m high"):
        Pack(envs.TASKS["Stand"].for_robot(weak), 1)


def test_a_robot_on_its_back_has_fallen():
    env = gymnasium.make("suchus/Crawl-v0").unwrapped
    env.reset(seed=0)
    env.pack.loop.batch.qpos[0, 2] += 0.1
    env.pack.loop.batch.qpos[0, 3:7] = [0, 1, 0, 0]
    _, _, fell, _, info = env.step(np.zeros(19))
    assert fell
    assert "it rolled over" in info["cause"]


def test_the_gait_beats_standing_still_and_standing_still_beats_anything():
    centre = tuple(Pack(CRAWL, 1).centre)
    follow = envs.GaitFollower(task=CRAWL, centre=centre, gait=CRAWL.gait)
    returns = [
        envs.play(CRAWL, policy, episodes=4, steps=90).returns.mean()
        for policy in (follow, envs.HoldStill(CRAWL), envs.RandomActions(CRAWL, np.random.default_rng(0)))
    ]
    assert returns[0] > 2 > returns[1] > -0.5 > returns[2]


def test_a_picture_shows_the_robot():
    env = gymnasium.make("suchus/Crawl-v0", render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    assert picture.shape == (480, 640, 3)
    assert (picture < 200).mean() > 0.02
    assert gymnasium.make("suchus/Crawl-v0").unwrapped.render() is None


def test_some_robots_begin_anew_by_a_mask_and_none_by_itself_when_that_is_disabled():
    env = envs.CrocodileVectorEnv(2, CRAWL, max_episode_steps=1, autoreset_mode="Disabled")
    env.reset(seed=0)
    env.step(np.zeros((2, 19)))
    with pytest.raises(gymnasium.error.ResetNeeded, match=r"robots \[0, 1\]"):
        env.step(np.zeros((2, 19)))
    _, infos = env.reset(options={"reset_mask": np.array([True, False])})
    assert infos["_time"].tolist() == [True, False]
    with pytest.raises(gymnasium.error.ResetNeeded, match=r"robots \[1\]"):
        env.step(np.zeros((2, 19)))


def test_tasks_are_varied_by_naming_their_fields():
    env = gymnasium.make("suchus/Crawl-v0", robot="long_tail", gait="low_crawl", span=0.5).unwrapped
    assert (env.task.robot.name, env.task.gait, env.task.span) == ("long_tail", GAITS["low_crawl"], 0.5)


@pytest.mark.parametrize(
    ("changes", "error", "text"),
    [
        ({"spam": 1}, UnknownName, "Did you mean 'span'?"),
        ({"task": "Crwl"}, UnknownName, "Did you mean 'Crawl'?"),
        ({"robot": "caimen"}, UnknownName, "Did you mean 'caiman'?"),
        ({"gait": 3}, InvalidDesign, "task.gait is '3'; a Gait is needed"),
        ({"breaks": "limp"}, InvalidDesign, "a Breaks or None is needed"),
        ({"span": -1.0}, InvalidDesign, "0.01 to 3.2 rad is allowed"),
        ({"decision": 0.025}, InvalidDesign, "must fit the control period of 0.01 s"),
        ({"timestep": 0.003}, InvalidDesign, "must fit the control period of 0.01 s"),
        ({"start": "flying"}, InvalidDesign, "lying or upright or swimming is allowed"),
        ({"render_mode": "human"}, UnknownName, "there is rgb_array"),
        ({"pushes": envs.Pushes(body="nose")}, UnknownName, "there is no body named 'nose'"),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(changes, error, text):
    with pytest.raises(error) as told:
        envs.CrocodileEnv(**changes)
    assert text in str(told.value)


def test_bad_breaks_and_shoves_are_refused():
    with pytest.raises(UnknownName, match="Did you mean 'LF_yaw'"):
        envs.CrocodileEnv("Fault", breaks=envs.Breaks(joints=("LF_yav",)))
    with pytest.raises(UnknownName, match="Did you mean 'weak'"):
        envs.Breaks(kinds=("wek",))
    with pytest.raises(UnknownName, match="there is no fault of a servo named 'deaf'"):
        envs.Breaks(kinds=("deaf",))
    with pytest.raises(InvalidDesign, match="kinds is empty"):
        envs.Breaks(kinds=())
    with pytest.raises(InvalidDesign, match="0 to 1 is allowed"):
        envs.CrocodileEnv(breaks=envs.Breaks(faults=(Weak("LF_yaw", 1.5),)))
    with pytest.raises(InvalidDesign, match="must not decrease"):
        envs.Breaks(earliest=5.0, latest=1.0)
    with pytest.raises(InvalidDesign, match="must not decrease"):
        envs.Pushes(earliest=5.0, latest=1.0)


def test_bad_actions_seeds_and_sizes_are_refused():
    env = envs.CrocodileVectorEnv(2, CRAWL)
    env.reset(seed=0)
    with pytest.raises(OutsideLimits, match=r"\(2, 19\) is needed"):
        env.step(np.zeros((2, 18)))
    with pytest.raises(OutsideLimits, match="not a finite number"):
        env.step(np.full((2, 19), np.nan))
    with pytest.raises(InvalidDesign, match="3 seeds for 2 robots"):
        env.reset(seed=[1, 2, 3])
    with pytest.raises(InvalidDesign, match="2 booleans are needed"):
        env.reset(options={"reset_mask": np.array([True])})
    with pytest.raises(InvalidDesign, match="num_envs is 0"):
        envs.CrocodileVectorEnv(0)
    with pytest.raises(InvalidDesign, match="'NextStep', 'SameStep', 'Disabled'"):
        envs.CrocodileVectorEnv(1, autoreset_mode="later")


def test_without_gymnasium_the_sentence_says_what_to_install():
    code = "import sys; sys.modules['gymnasium'] = None; import suchus.apps.envs"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode
    assert done.stderr.strip().splitlines()[-1].endswith("install it with: pip install 'suchus[gym]'.")


def test_the_page_lists_every_sense_as_it_is():
    page = DOCS.read_text()
    for sense in envs.SENSES:
        columns = f"{sense.columns.start} to {sense.columns.stop - 1}"
        row = f"| `{sense.name}` | {columns} | {sense.scale} | {sense.description} |"
        assert row in page


@pytest.mark.parametrize("name", list(ROBOTS))
def test_every_robot_of_the_shelf_acts_in_spaces_of_its_own(name):
    robot, place = ROBOTS[name], layout(ROBOTS[name])
    env = gymnasium.make("suchus/Fault-v0", robot=name).unwrapped
    assert env.action_space.shape == (len(place.servos),)
    assert env.observation_space.shape == (4 * len(place.servos) + len(place.limbs) + len(place.trunk) + 15,)
    assert gymnasium.make("suchus/Fault-v0", robot=robot).unwrapped.task == env.task
    many = envs.CrocodileVectorEnv(2, "Fault", robot=name)
    seen, said = many.reset(seed=[3, 4])
    alone, info = env.reset(seed=4)
    limbs = [servo for limb in place.limbs for servo in place.servos[limb.servos]]
    assert info["fault"].split()[0] in (limbs or place.servos)
    np.testing.assert_array_equal(seen[1], alone)
    for ours, theirs in zip(acting(many, 3), acting(many, 3), strict=True):
        assert ours[0].shape == theirs[0].shape == (2, *env.observation_space.shape)
    assert env.observation_space.contains(env.step(env.action_space.sample())[0])
    assert said["fault"][1] == info["fault"]


@pytest.mark.parametrize(("name", "lengths"), [("salamander", 0.25), ("strider", 0.5), ("salamandra", 0.4)])
def test_the_open_loop_gait_of_another_body_walks_through_the_environment(name, lengths):
    env = envs.CrocodileVectorEnv(2, "Crawl", robot=name)
    task = env.task
    assert task.gait == default_gait(task.robot)
    follow = envs.GaitFollower(task=task, centre=tuple(env.pack.centre), gait=task.gait)
    cycles = 60 * task.decision / task.gait.period
    assert cycles > 1.4
    played = envs.play(task, follow, episodes=2, steps=60)
    assert played.forward.min() > lengths * task.robot.length
    assert played.returns.min() > 1.0
    held = envs.play(task, envs.HoldStill(task), episodes=1, steps=10)
    assert abs(held.forward[0]) < 0.02 * task.robot.length


def test_a_crank_turns_by_its_action_and_its_angle_is_given_within_a_turn():
    env = envs.CrocodileVectorEnv(1, "Crawl", robot="salamandra", jitter=0.0)
    env.reset(seed=0)
    cranks = [place.servos.start for place in layout(env.task.robot).limbs]
    speed = env.task.robot.servo("LF_crank").speed
    action = np.zeros((1, env.single_action_space.shape[0]))
    action[0, cranks[0]], action[0, cranks[1]] = 0.9, 3.0
    before = env.pack._commanded.copy()
    seen = [env.step(action)[0][0] for _ in range(30)]
    turned = (env.pack._commanded - before)[0]
    assert turned[cranks[:2]] == pytest.approx([0.9 * speed * 1.5, speed * 1.5])
    assert turned[cranks[0]] > 2 * np.pi
    assert envs.reading_columns(np.array(seen), "last_action", "salamandra")[-1, cranks].tolist() == pytest.approx(
        [0.9, 1.0, 0.0, 0.0]
    )
    angles = np.pi * envs.reading_columns(np.array(seen), "servo_position", "salamandra")[:, cranks[0]].astype(float)
    assert np.abs(angles).max() <= np.pi
    assert np.ptp(angles) > 5.0
    assert np.unwrap(angles)[-1] - angles[0] == pytest.approx(0.9 * speed * 1.5, abs=1.0)


def test_a_task_follows_the_size_of_the_robot():
    task = CRAWL.for_robot(ROBOTS["salamander"])
    longer = ROBOTS["salamander"].length / ROBOTS["caiman"].length
    heavier = ROBOTS["salamander"].mass / ROBOTS["caiman"].mass
    assert (task.decision, task.timestep) == (0.025, 0.0025)
    assert task.rewards.forward == pytest.approx(CRAWL.rewards.forward / longer)
    assert task.rewards.work == pytest.approx(CRAWL.rewards.work / (heavier * longer))
    assert task.rewards.action_rate == CRAWL.rewards.action_rate
    pushed = replace(CRAWL, pushes=envs.Pushes()).for_robot(ROBOTS["strider"])
    assert pushed.pushes.most == pytest.approx(15.0 * 3.0 / ROBOTS["caiman"].mass)
    assert (pushed.pushes.pushed_body(pushed.robot), envs.Pushes().pushed_body(CRAWL.robot)) == ("front", "thorax")
    assert CRAWL.for_robot(ROBOTS["long_tail"]) == replace(CRAWL, robot=ROBOTS["long_tail"])
    rates = {sense.name: sense.scale for sense in envs.senses(ROBOTS["salamander"])}
    assert rates["servo_velocity"] == f"{10 / np.sqrt(longer):.3g} rad/s"


def test_the_senses_of_the_article_s_robot_are_its_readings_over_fixed_scales():
    env = envs.CrocodileVectorEnv(1, CRAWL)
    env.reset(seed=1)
    *_, (seen, *_) = acting(env, 3)
    felt = env.pack.loop.sensed()
    np.testing.assert_array_equal(
        envs.reading_columns(seen, "servo_velocity"), np.clip(felt.servo_velocity / 10, -1, 1, dtype="f4")
    )
    np.testing.assert_array_equal(
        envs.reading_columns(seen, "angular_velocity"), (felt.angular_velocity / 10).astype("f4")
    )
    assert envs.senses(ROBOTS["caiman"]) == envs.SENSES
    assert env.single_observation_space.shape == (101,)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"task": "Stand", "robot": "strider"}, "a task that begins upright needs a trunk that bends up and down"),
        ({"robot": "strider", "gait": "belly_crawl"}, "choose a gait made for it"),
        ({"robot": "strider", "breaks": envs.Breaks(joints=("tail_cable",))}, "no servo named 'tail_cable'"),
        ({"robot": "strider", "timestep": 0.02}, "task.timestep is 0.02"),
    ],
)
def test_what_another_body_cannot_do_is_refused_in_a_sentence(changes, text):
    with pytest.raises(SuchusError, match=text) as told:
        envs.CrocodileEnv(**changes)
    assert str(told.value).count(". ") <= 1
