"""Steps per second of the land simulation beside MuJoCo's own rollout: same model, commands, threads, one process.

Every run has a noise of its own on its servos: equal runs would be simulated once (``land.deduplication``).
The time is that of the processors, all threads together, so that other work on the machine counts little.
"""

import os
import time

import mujoco
import numpy as np
from mujoco import rollout

from suchus import threads
from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.model import compile_model
from suchus.robots import ROBOTS

TIMESTEP, DURATION, RUNS, REPEATS = 0.002, 4.0, 32, 5
NOISE = 0.01  # rad on every commanded angle


def timed(task) -> float:
    """Return the processor time of a task [s]."""
    start = time.process_time()
    task()
    return time.process_time() - start


def main() -> None:
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    model = compile_model(robot, TIMESTEP)
    steps = round(DURATION / TIMESTEP)
    runs = [Run(robot=robot, gait=gait, noise=NOISE, seed=i) for i in range(RUNS)]
    record = simulate(runs, duration=DURATION)
    assert len({values.tobytes() for values in record.position.values}) == RUNS
    targets = np.repeat(record.servo_target.values[:, :-1], round(0.01 / TIMESTEP), axis=1)
    states = np.array([_first_state(model, record, run) for run in range(RUNS)])

    def raw(count: int, nthread: int) -> None:
        data = [mujoco.MjData(model) for _ in range(nthread)]
        with rollout.Rollout(nthread=nthread) as roll:
            roll.rollout([model] * count, data, states[:count], targets[:count])

    def ours(count: int) -> None:
        simulate(runs[:count], duration=DURATION)

    nthread = threads.count()
    print(f"model {robot.name}: {model.nv} dof, time step {TIMESTEP} s, {DURATION} s a run, median of {REPEATS} pairs")
    print(f"cores {os.cpu_count()}, threads {nthread}, MuJoCo {mujoco.__version__}, control and record at 100 Hz")
    print(f"load {os.getloadavg()[0]:.1f}; processor time")
    for count in (1, RUNS):
        # in pairs, one after the other: what else the machine does then weighs on both
        pairs = np.array(
            [(timed(lambda n=count: raw(n, min(n, nthread))), timed(lambda n=count: ours(n))) for _ in range(REPEATS)]
        )
        raw_time, our_time = np.median(pairs, axis=0)
        print(
            f"{count:3d} runs: rollout {count * steps / raw_time:8.0f} steps/s, "
            f"suchus {count * steps / our_time:8.0f} steps/s, "
            f"ratio {np.median(pairs[:, 0] / pairs[:, 1]):.2f}, {count * DURATION / our_time:.0f} times real time"
        )


def _first_state(model: mujoco.MjModel, record, run: int) -> np.ndarray:
    data = mujoco.MjData(model)
    now = record.isel(run=run, time=0)
    data.qpos[:3], data.qpos[3:7] = now.position.values, now.orientation.values
    for name in record.joint.values:
        data.joint(str(name)).qpos = float(now.joint_angle.sel(joint=name))
    data.act[:] = now.servo_target.values
    state = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return state


if __name__ == "__main__":
    main()
