"""What holds for every policy in the catalog: its file, its robot, and that it walks as commanded."""

import numpy as np
import pytest

from suchus.core import sources
from suchus.core.errors import UnknownName, UnsuitedRobot
from suchus.core.sources import kind_of, shelf_of
from suchus.experiments.study.page import _control
from suchus.experiments.train import motion
from suchus.robot.control import Learned
from suchus.robot.control.policy import MAX_FILE_SIZE, policy_bytes, robot_digest
from suchus.robot.policies import POLICIES, load_policy, policy_of, save_policy
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate


@pytest.fixture(params=list(POLICIES))
def policy(request):
    return POLICIES[request.param]


def test_its_file_is_small_and_its_robot_is_the_one_that_it_was_trained_for(policy):
    source = POLICIES.sources()[policy.name]
    assert source.file is not None
    assert source.file.stat().st_size <= MAX_FILE_SIZE
    assert source.file.read_bytes() == policy_bytes(policy)
    assert policy.robot_digest == robot_digest(ROBOTS[policy.robot])
    policy.check_robot(ROBOTS[policy.robot])
    record = dict(policy.training)
    assert record["command"].startswith(f"suchus train {policy.task}")
    assert 0.0 < float(record["error"]) < 0.2


def test_it_moves_as_commanded(policy):
    robot = ROBOTS[policy.robot]
    lake = Lake(level=robot.length) if policy.task == "swim" else None
    turns = (0.0, policy.max_turn, -policy.max_turn)
    runs = [
        Run(
            robot=robot, gait=policy.gait, lake=lake,
            control=Learned(policy=policy, forward=policy.max_speed / 2, turn=turn),
        )
        for turn in turns
    ]  # fmt: skip
    end = 1.0 + round(4.0 * policy.gait.period, 1)
    moved = motion(simulate(runs, duration=end, timestep=0.005, sample_stride=5), 1.0 + policy.gait.period, end)
    assert not moved.has_fallen.any()
    assert np.abs(moved.speed / policy.max_speed - 0.5).max() < 0.25
    assert np.abs(moved.turn - turns).max() < 0.35 * policy.max_turn


def test_a_name_stands_for_the_policy_of_the_robot():
    assert policy_of(ROBOTS["caiman"], "velocity").robot == "caiman"
    assert policy_of(ROBOTS["strider"], "velocity").robot == "strider"
    with pytest.raises(UnsuitedRobot, match="was trained for robot 'caiman'"):
        policy_of(ROBOTS["pleurobot"], "velocity")
    with pytest.raises(UnknownName, match="velocity"):
        policy_of(ROBOTS["caiman"], "velocty")


def test_a_project_has_policies_of_its_own(tmp_path, monkeypatch):
    (tmp_path / "suchus.toml").write_text("")
    (tmp_path / "policies").mkdir()
    save_policy(POLICIES["velocity"], tmp_path / "policies" / "mine.npz")
    monkeypatch.setenv(sources.VARIABLE, str(tmp_path))
    assert POLICIES["mine"] == POLICIES["velocity"] == load_policy(tmp_path / "policies" / "mine.npz")
    assert Learned(policy="mine").policy == POLICIES["velocity"]
    control = _control({"kind": "learned", "policy": "mine", "forward": 0.1})
    assert control == Learned(policy=POLICIES["velocity"], forward=0.1)


def test_the_plural_of_a_kind():
    assert [shelf_of(kind) for kind in ("robot", "policy")] == ["robots", "policies"]
    assert [kind_of(shelf) for shelf in sources.SHELVES] == [
        "robot", "gait", "fault", "experiment", "controller", "measure", "command", "protocol", "policy",
    ]  # fmt: skip
