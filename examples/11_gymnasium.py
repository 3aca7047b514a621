"""The robot as a Gymnasium environment: what a policy sees, does and earns.

An action is one number for each servo, an observation what the robot can feel. ``make_vec`` steps many robots as one
batch of physics. A policy of your own is a function from observations to actions.

Usage: pip install 'suchus[gym]'; python examples/11_gymnasium.py
"""

import sys

import numpy as np

try:
    import gymnasium

    from suchus.apps import envs  # makes the names known
except ImportError as error:
    print(error)
    sys.exit(0)

env = gymnasium.make("suchus/Crawl-v0")
seen, _ = env.reset(seed=0)
for sense in envs.SENSES:
    print(f"{sense.name:18s} {seen[sense.columns].size:3d} numbers, 1 is {sense.scale}")

seen, reward, terminated, truncated, info = env.step(env.action_space.sample())
print(f"one random step: reward {reward:+.3f}, {info['forward'] * 1000:+.1f} mm forward, {info['work']:.2f} J")

robots = gymnasium.make_vec("suchus/Fault-v0", num_envs=4)
robots.reset(seed=0)
print("what will break:", *robots.unwrapped.pack.chances[0].fault.split()[:2], "in the first,", end=" ")
print(*robots.unwrapped.pack.chances[1].fault.split()[:2], "in the second robot")

task = envs.TASKS["Crawl"]
centre = tuple(robots.unwrapped.pack.centre)
policies = {
    "holding still": envs.HoldStill(task),
    "anything": envs.RandomActions(task, np.random.default_rng(0)),
    "the built-in crawl": envs.GaitFollower(task=task, centre=centre, gait=task.gait),
}
for name, policy in policies.items():
    played = envs.play(task, policy, episodes=4, seed=0)
    print(f"{name:18s} return {played.returns.mean():+6.2f}, {played.forward.mean():+.2f} m forward")
