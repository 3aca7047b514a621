"""Steps per second of batches and of environments beside MuJoCo's own rollout: same model, states, commands, threads.

And those of one run under feedback beside one in open loop.

Every run has a noise of its own on its servos: equal runs would be simulated once (``land.loop.Deduplication``).
Environments take actions that were kept before, so that no policy is in their time; observations and rewards are.
The time is that of the processors, all threads together, so that other work on the machine counts little.
"""

import os
import time
from itertools import product

import gymnasium
import mujoco
import numpy as np
from mujoco import rollout

from form import in_form
from suchus.apps.envs import GaitFollower
from suchus.core import threads
from suchus.robot.control import Coordinated
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.model import activations, compile_model

TIMESTEP, DURATION, RUNS, REPEATS = 0.002, in_form(4.0, 0.2), in_form(32, 2), in_form(5, 1)
NOISE = 0.01  # rad on every commanded angle
ALIKE = 0.001  # m between the ends of a walk with and without suchus, whose servos' integrals start otherwise
ACTIONS = {1: in_form(160, 2), RUNS: in_form(20, 2)}  # of each environment, by their number


def timed(task) -> float:
    """Return the processor time of a task [s]."""
    start = time.process_time()
    task()
    return time.process_time() - start


def rolled(model, states: np.ndarray, commands: np.ndarray, warmstart=None) -> np.ndarray:
    """Return the states over time that MuJoCo's own rollout gives.

    Args:
        model: the ``mujoco.MjModel`` of all runs.
        states: first ones, shape (run, state).
        commands: shape (run, step, servo) [rad].
        warmstart: accelerations from which the first constraints are solved, shape (run, dof); zeros if None.
    """
    nthread = min(threads.count(), len(states))
    data = [mujoco.MjData(model) for _ in range(nthread)]
    with rollout.Rollout(nthread=nthread) as roll:
        return roll.rollout([model] * len(states), data, states, commands, initial_warmstart=warmstart)[0]


def report(what: str, steps: int, raw, ours, begin=lambda: None, actions: int = 0) -> None:
    """Print the steps per second of two tasks, timed in turns: what else the machine does then weighs on both.

    Args:
        what: what is timed, in words.
        steps: physics steps of each task.
        raw: MuJoCo's own rollout.
        ours: the same by suchus.
        begin: called before each pair.
        actions: actions of environments in the second task, whose rate is printed too; 0 for none.
    """
    pairs = []
    for _ in range(REPEATS):
        begin()
        pairs.append((timed(raw), timed(ours)))
    raw_time, our_time = np.median(pairs, axis=0)
    ratio = np.median([bare / full for bare, full in pairs])
    rate = f", {actions / our_time:6.0f} actions/s" if actions else ""
    rates = f"rollout {steps / raw_time:8.0f} steps/s, suchus {steps / our_time:8.0f} steps/s, ratio {ratio:.2f}"
    print(f"{what}: {rates}{rate}")


def batches() -> None:
    """Time batches of runs, control and record at 100 Hz."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    model = compile_model(robot, TIMESTEP)
    runs = [Run(robot=robot, gait=gait, noise=NOISE, seed=i) for i in range(RUNS)]
    record = simulate(runs, duration=DURATION, timestep=TIMESTEP)
    assert len({values.tobytes() for values in record.position.values}) == RUNS
    targets = np.repeat(record.servo_target.values[:, :-1], round(0.01 / TIMESTEP), axis=1)
    states = np.array([_first_state(model, record, run) for run in range(RUNS)])
    ends = rolled(model, states, targets)[:, -1, 1:4]  # after the time; the same walks, or their ratio says nothing
    np.testing.assert_allclose(ends, record.position.values[:, -1], rtol=0.0, atol=ALIKE)
    for count in (1, RUNS):
        report(
            f"{count:3d} runs of {DURATION} s at {TIMESTEP} s",
            count * round(DURATION / TIMESTEP),
            lambda n=count: rolled(model, states[:n], targets[:n]),
            lambda n=count: simulate(runs[:n], duration=DURATION, timestep=TIMESTEP),
        )


def feedback() -> None:
    """Time one run under feedback and one in open loop, with the coarse time step and ten samples a second."""
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    timestep, duration = coarse_step(robot), in_form(20.0, 2.0)
    runs = {"open loop": Run(robot=robot, gait=gait), "feedback": Run(robot=robot, gait=gait, control=Coordinated())}
    pairs = np.array(
        [
            [
                timed(lambda run=run: simulate([run], duration=duration, timestep=timestep, sample_stride=10))
                for run in runs.values()
            ]
            for _ in range(1 + REPEATS)
        ]
    )[1:]  # the first compiles the models
    rates = duration / timestep / np.median(pairs, axis=0)
    texts = [f"{name} {rate:8.0f} steps/s" for name, rate in zip(runs, rates, strict=True)]
    ratio = np.median(pairs[:, 0] / pairs[:, 1])
    print(f"one run of {duration} s at {timestep} s: {', '.join(texts)}, ratio {ratio:.2f}")


def environments(count: int, actions: int, *, fast: bool) -> None:
    """Time so many environments over so many actions.

    Args:
        count: number of environments.
        actions: number of actions of each.
        fast: whether contacts are solved in less time and with less accuracy.
    """
    env = gymnasium.make_vec("suchus/Crawl-v0", num_envs=count, fast=fast).unwrapped
    policy = GaitFollower(task=env.task, centre=tuple(env.pack.centre), gait=env.task.gait)
    loop, steps = env.pack.loop, env.pack.loop.steps
    batch, advance, commands, played = loop.batch, loop.advance, [], []

    def kept(**how) -> None:
        commands.extend([loop.command.targets.copy()] * steps)
        advance(**how)

    seen = env.reset(seed=0)[0]
    every = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states, warmstart = np.empty((count, mujoco.mj_stateSize(batch.model, every))), np.empty((count, batch.model.nv))
    for run in range(count):
        data = batch.physics.get_data(run)
        mujoco.mj_getState(batch.model, data, states[run], every)
        warmstart[run] = data.qacc_warmstart
    many = loop.advance_many
    loop.advance, loop.advance_many = kept, lambda _: None  # one control period after the other, to the same bits
    for _ in range(actions):
        played.append(policy(seen))
        seen = env.step(played[-1])[0]
    loop.advance, loop.advance_many = advance, many
    controls = np.ascontiguousarray(np.swapaxes(commands, 0, 1))
    places = slice(1, 1 + batch.model.nq)  # in a state, after the time
    np.testing.assert_array_equal(rolled(batch.model, states, controls, warmstart)[:, -1, places], batch.qpos)

    def ours() -> None:
        for action in played:
            env.step(action)

    timestep = loop.period / steps
    report(
        f"{count:3d} environments over {actions} actions at {timestep:g} s{', fast' if fast else ''}",
        controls.shape[0] * controls.shape[1],
        lambda: rolled(batch.model, states, controls, warmstart),
        ours,
        lambda: env.reset(seed=0),
        count * actions,
    )


def main() -> None:
    """Print it all."""
    print(
        f"cores {os.cpu_count()}, threads {threads.count()}, MuJoCo {mujoco.__version__}, load {os.getloadavg()[0]:.1f}"
    )
    print(f"processor time, median of {REPEATS} pairs")
    batches()
    feedback()
    for fast, (count, actions) in product((False, True), ACTIONS.items()):
        environments(count, actions, fast=fast)


def _first_state(model: mujoco.MjModel, record, run: int) -> np.ndarray:
    data = mujoco.MjData(model)
    now = record.isel(run=run, time=0)
    data.qpos[:3], data.qpos[3:7] = now.position.values, now.orientation.values
    for name in record.joint.values:
        data.joint(str(name)).qpos = float(now.joint_angle.sel(joint=name))
    data.act[:] = activations(model, now.servo_target.values)
    state = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return state


if __name__ == "__main__":
    main()
