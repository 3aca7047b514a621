"""Tasks in a flow that is solved together with each robot."""

import gymnasium
import numpy as np
import pytest

import suchus.apps.envs
from suchus.apps.envs import CrocodileEnv, CrocodileVectorEnv, Landing
from suchus.apps.envs.pack import Pack
from suchus.apps.envs.shelf import resolve_task
from suchus.core.errors import Diverged, InvalidDesign, UnknownName
from suchus.robot.design import layout
from suchus.sim.land import Lake
from suchus.sim.land.waters import Slice, Space
from suchus.swimming.coupling import Swim

WATER = Slice(cells=40, reynolds=600.0)
ASKED = {"robot": "swimmer", "water": WATER}


def test_robots_swim_side_by_side_in_flows_of_their_own_as_each_does_alone():
    pair, alone = CrocodileVectorEnv(2, "Swim", **ASKED), gymnasium.make("suchus/Swim-v0", **ASKED)
    pair.reset(seed=[3, 4])
    alone.reset(seed=4)
    actions = np.random.default_rng(0).uniform(-0.4, 0.4, (2, 10))
    felt, rewards, over, _, told = pair.step(actions)
    mine, reward, *_, info = alone.step(actions[1])
    assert np.array_equal(felt[1], mine)
    assert rewards[1] == reward
    assert not np.array_equal(felt[0], felt[1])
    assert np.isfinite(felt).all()
    assert not over.any()
    assert (info["time"], told["time"][0]) == (0.05, 0.05)
    assert info["work"] > 0.0


def test_a_flow_takes_the_place_of_the_lake_and_moves_what_it_sees():
    task = resolve_task("Swim", {"water": "space"})
    assert (task.flow, task.lake) == (Space(), None)
    assert resolve_task("Swim", {"water": "sections"}).lake == Lake(level=0.5)
    moved = Pack(resolve_task("Swim", {"water": WATER}), 1)._tanks.is_lateral_servo
    names = [name for name, does in zip(layout(task.robot).servos, moved, strict=True) if does]
    assert names == ["spine_yaw_1", "spine_yaw_2", "spine_yaw_3", "tail_cable"]


def test_what_ends_a_swim_ends_the_episode_with_its_sentence(monkeypatch):
    env = CrocodileEnv("Swim", **ASKED)
    env.reset(seed=1)
    felt, _, over, _, info = env.step(np.full(10, 0.3))
    assert np.isfinite(felt).all()
    assert not over
    assert (info["time"], info["cause"]) == (0.05, "")
    assert info["work"] > 0.0

    def part(swim, *given, **more):
        raise Diverged("robot and flow do not come to terms", time=0.05)

    monkeypatch.setattr(Swim, "go", part)
    _, _, over, _, info = env.step(np.zeros(10))
    assert over
    assert info["cause"] == "the simulation diverged at 0.10 s: robot and flow do not come to terms"
    assert info["work"] == 0.0


@pytest.mark.parametrize(
    ("task", "changes", "said"),
    [
        ("Swim", {"water": WATER, "lake": Lake(level=1.0)}, "has neither surface nor ground"),
        ("Swim", {"water": WATER, "goal": Landing()}, "has neither surface nor ground"),
        ("Crawl", {"water": WATER}, "must begin swimming"),
        ("Swim", {"water": WATER, "robot": "caiman"}, "robot 'caiman' sinks"),
        ("Swim", {"water": 3}, r"task.water is '3'; a str or Slice or Space is needed"),
    ],
)
def test_tasks_that_a_flow_cannot_hold_are_refused(task, changes, said):
    with pytest.raises(InvalidDesign, match=said):
        resolve_task(task, changes)


def test_a_rung_that_there_is_not_is_refused():
    with pytest.raises(UnknownName, match="sections, slice, space"):
        resolve_task("Swim", {"water": "tank"})
    assert "suchus/Swim-v0" in suchus.apps.envs.IDS
