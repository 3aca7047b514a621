"""Some control periods in one go are as many control periods one after the other, to the last bit."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="not installed: pip install 'suchus[gym]'")

from suchus.apps.envs import TASKS, Breaks, CrocodileVectorEnv, Pushes
from suchus.robot.design import layout
from suchus.robot.robots import ROBOTS

CASES = {
    "crawl": TASKS["Crawl"],
    "fast": replace(TASKS["Velocity"], fast=True, timestep=0.01),
    "built": TASKS["Velocity"].for_robot(ROBOTS["strider"]),
    "fault": replace(TASKS["Fault"], breaks=Breaks(earliest=0.2, latest=0.3)),
    "pushed": replace(TASKS["Stand"], pushes=Pushes(earliest=0.2, latest=0.3)),
    "swim": TASKS["Swim"],
}


def played(task, *, apart, actions=12, robots=3):
    """Return observations, works and fused calls of some actions."""
    env, calls = CrocodileVectorEnv(robots, task, max_episode_steps=9), []
    together = env.pack.loop.advance_many

    def noted(periods):
        powers = None if apart else together(periods)
        calls.append(powers is not None)
        return powers

    env.pack.loop.advance_many = noted
    rows = [env.reset(seed=4)[0]]
    random = np.random.default_rng(0)
    works = []
    for _ in range(actions):
        seen, *_, infos = env.step(random.uniform(-0.6, 0.6, (robots, len(layout(task.robot).servos))))
        rows.append(seen)
        works.append(infos.get("work", np.zeros(robots)))
    batch = env.pack.loop.batch
    return np.array(rows).tobytes(), np.array(works).tobytes(), batch.readings.tobytes(), batch.qpos.tobytes(), calls


@pytest.mark.parametrize("name", CASES)
def test_periods_together_are_periods_apart(name):
    together, apart = (played(CASES[name], apart=apart) for apart in (False, True))
    assert together[:-1] == apart[:-1]
    assert any(together[-1]) == (name != "swim")
    if name in {"fault", "pushed"}:
        assert not all(together[-1])


def test_a_robot_that_diverges_ends_in_its_period():
    task = TASKS["Crawl"]
    for apart in (False, True):
        env = CrocodileVectorEnv(2, task)
        env.reset(seed=0)
        if apart:
            env.pack.loop.advance_many = lambda periods: None
        env.pack.loop.batch.qvel[0, 6] = 1e5
        _, _, terminated, _, infos = env.step(np.zeros((2, 19)))
        assert terminated.tolist() == [True, False]
        assert "diverged" in infos["cause"][0]
