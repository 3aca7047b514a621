"""Train a crawl from nothing with stable-baselines3, and see whether it beats standing still.

The robots of ``CrocodileVectorEnv`` are one batch of physics; ``Herd`` shows them to stable-baselines3, which has a
vector interface of its own. PPO knows nothing of gaits: its actions are 19 servo angles, twenty times a second.

Usage: pip install stable-baselines3; python examples/12_train.py [STEPS]
"""

import sys
from dataclasses import replace
from typing import Any

import numpy as np

import suchus.apps.envs as envs

STEPS = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
ROBOTS, SEED = 32, 0

try:
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.vec_env import VecEnv, VecMonitor
except ImportError:
    print("this example needs stable-baselines3; install it with: pip install stable-baselines3")
    sys.exit(0)


class Herd(VecEnv):
    """A ``CrocodileVectorEnv`` for stable-baselines3: infos as a list, the last observation kept at a reset."""

    def __init__(self, task: envs.Task, robots: int, steps: int) -> None:
        self.env = envs.CrocodileVectorEnv(robots, task, max_episode_steps=steps, autoreset_mode="SameStep")
        super().__init__(robots, self.env.single_observation_space, self.env.single_action_space)

    def reset(self) -> np.ndarray:
        return self.env.reset(seed=SEED)[0]

    def step_async(self, actions: np.ndarray) -> None:
        self._actions = actions

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        seen, rewards, terminated, truncated, said = self.env.step(self._actions)
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for i in np.flatnonzero(terminated | truncated):
            late = bool(truncated[i] and not terminated[i])
            infos[i] = {"terminal_observation": said["final_obs"][i], "TimeLimit.truncated": late}
        return seen, rewards, terminated | truncated, infos

    def close(self) -> None:
        self.env.close()

    def get_attr(self, attr_name: str, *_: Any, **__: Any) -> list[Any]:
        return [getattr(self.env, attr_name, None)] * self.num_envs

    def set_attr(self, *_: Any, **__: Any) -> None:
        raise NotImplementedError

    def env_method(self, *_: Any, **__: Any) -> list[Any]:
        raise NotImplementedError

    def env_is_wrapped(self, *_: Any, **__: Any) -> list[bool]:
        return [False] * self.num_envs


class Curve(BaseCallback):
    """Prints the mean return of the last hundred episodes now and then."""

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        last = [episode["r"] for episode in self.model.ep_info_buffer or ()]
        if last and (self.num_timesteps // 2048) % 10 == 0:
            print(f"{self.num_timesteps:8d} steps  mean return {np.mean(last):+6.2f}", flush=True)


def main() -> None:
    task = envs.TASKS["Crawl"]
    torch.set_num_threads(1)
    learner = PPO(
        "MlpPolicy",
        VecMonitor(Herd(task, ROBOTS, envs.MAX_STEPS)),
        n_steps=64,
        batch_size=512,
        n_epochs=5,
        learning_rate=1e-3,
        gamma=0.97,
        use_sde=True,  # noise that is smooth in time and rhythmic, since the clock is among what it depends on
        sde_sample_freq=16,
        policy_kwargs={"log_std_init": -3.5, "net_arch": [64, 64]},
        seed=SEED,
        device="cpu",
    )
    learner.learn(STEPS, callback=Curve())

    def learned(seen: np.ndarray) -> np.ndarray:
        return learner.predict(seen, deterministic=True)[0]

    centre = tuple(envs.CrocodileVectorEnv(1, task).pack.centre)
    name = f"learned in {STEPS} steps"
    shown = {
        "standing still": (task, envs.HoldStill(task)),
        "anything": (task, envs.RandomActions(task, np.random.default_rng(SEED))),
        "the built-in gait": (task, envs.GaitFollower(task=task, centre=centre, gait=task.gait)),
        name: (task, learned),
        f"{name}, physics of 2 ms": (replace(task, timestep=0.002), learned),
        f"{name}, full torque at any speed": (replace(task, speed_lines=False), learned),
    }
    for name, (where, policy) in shown.items():
        played = envs.play(where, policy, episodes=16, seed=1000)
        fell = int((played.durations < envs.MAX_STEPS * task.decision - 1e-6).sum())
        print(
            f"{name:44s} return {played.returns.mean():+7.2f} +- {played.returns.std():5.2f}, "
            f"forward {played.forward.mean():+6.2f} m in up to 10 s, {fell} of 16 fell"
        )


if __name__ == "__main__":
    main()
