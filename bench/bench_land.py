"""Steps per second of the land simulation beside MuJoCo's own rollout, same model, same threads, one process."""

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

TIMESTEP, DURATION, RUNS, REPEATS = 0.002, 4.0, 32, 3


def best(task) -> float:
    """Return the shortest of some timings [s]."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        task()
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    robot, gait = ROBOTS["caiman"], GAITS["belly_crawl"]
    model = compile_model(robot, TIMESTEP)
    steps = round(DURATION / TIMESTEP)
    record = simulate([Run(robot=robot, gait=gait)], duration=DURATION)
    targets = np.repeat(record.servo_target.values[0, :-1], round(0.01 / TIMESTEP), axis=0)
    start = _first_state(model, record)

    def raw(runs: int, nthread: int) -> None:
        data = [mujoco.MjData(model) for _ in range(nthread)]
        with rollout.Rollout(nthread=nthread) as roll:
            controls = np.broadcast_to(targets, (runs, *targets.shape))
            roll.rollout([model] * runs, data, np.tile(start, (runs, 1)), controls)

    def ours(runs: int) -> None:
        simulate([Run(robot=robot, gait=gait, seed=i) for i in range(runs)], duration=DURATION)

    nthread = threads.count()
    print(f"model {robot.name}: {model.nv} dof, time step {TIMESTEP} s, {DURATION} s a run, best of {REPEATS}")
    print(f"cores {os.cpu_count()}, threads {nthread}, MuJoCo {mujoco.__version__}, control and record at 100 Hz")
    for runs in (1, RUNS):
        raw_time, our_time = best(lambda n=runs: raw(n, min(n, nthread))), best(lambda n=runs: ours(n))
        print(
            f"{runs:3d} runs: rollout {runs * steps / raw_time:8.0f} steps/s, "
            f"suchus {runs * steps / our_time:8.0f} steps/s, "
            f"ratio {raw_time / our_time:.2f}, {runs * DURATION / our_time:.0f} times real time"
        )


def _first_state(model: mujoco.MjModel, record) -> np.ndarray:
    data = mujoco.MjData(model)
    now = record.isel(run=0, time=0)
    data.qpos[:3], data.qpos[3:7] = now.position.values, now.orientation.values
    for name in record.joint.values:
        data.joint(str(name)).qpos = float(now.joint_angle.sel(joint=name))
    data.act[:] = now.servo_target.values
    state = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    return state


if __name__ == "__main__":
    main()
