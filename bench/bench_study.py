"""A hundred runs of 10 s through a study beside the bare physics, in one process; environments: ``bench_land``.

Usage: python bench/bench_study.py [--memory]   (with it only the memory of ten thousand short runs)
"""

import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import mujoco
import numpy as np
from mujoco import rollout

from form import in_form
from suchus.core import threads
from suchus.experiments.study import Study, Vary, conduct, run_chunk
from suchus.robot.gaits import GAITS
from suchus.robot.motion import hip_height
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.model import activations, compile_model, standing

MEASURES = ("displacement", "slip", "cost_of_transport", "height_std", "peak_torque")
RUNS, DURATION, HALVED = in_form(100, 2), in_form(10.0, 1.1), in_form(8, 1)
STEPS = in_form((0.01, 0.005, 0.0025), (0.01,))
ALIKE = 0.01  # of the way, in the median of the runs that are run with half the step as well
ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]


class Spent(NamedTuple):
    """What something took [s]."""

    wall: float
    cpu: float

    def beside(self, steps: float, bare: "Spent", bare_steps: float) -> str:
        """Tell a rate of physics steps, and its share of the bare one."""
        wall, cpu = steps / self.wall, steps / self.cpu
        share = (wall / (bare_steps / bare.wall), cpu / (bare_steps / bare.cpu))
        return (
            f"{self.wall:6.1f} s, {self.cpu:6.1f} s of processor time, {wall:7.0f} physics steps/s "
            f"({cpu:.0f} for each second of a processor); beside the bare physics {share[0]:.2f} ({share[1]:.2f})"
        )


def spent(task: Callable[[], object]) -> Spent:
    wall, cpu = time.perf_counter(), time.process_time()
    task()
    return Spent(time.perf_counter() - wall, time.process_time() - cpu)


def study(samples: int, duration: float, timestep: float) -> Study:
    return Study(
        name="bench",
        run=Run(robot=ROBOT, gait=GAIT),
        vary=(
            Vary(field="gait.stroke", low=0.06, high=0.32),
            Vary(field="robot.contact.foot_friction", low=0.5, high=1.0),
        ),
        measure=MEASURES,
        design="sobol",
        samples=samples,
        duration=duration,
        timestep=timestep,
    )


def largest_step() -> float:
    """Return the largest time step whose halving leaves the way as it is, in the median of some of the runs."""
    ways: dict[float, np.ndarray] = {}

    def way(timestep: float) -> np.ndarray:
        if timestep not in ways:
            ways[timestep] = run_chunk(study(HALVED, DURATION, timestep), 0).displacement_x.values
        return ways[timestep]

    for timestep in STEPS:
        off = abs(way(timestep) / way(timestep / 2) - 1.0)
        print(
            f"half of {1000 * timestep:g} ms changes the way of {HALVED} of the runs by {100 * np.median(off):.2f} % "
            f"in the median and {100 * off.max():.1f} % at most; {100 * ALIKE:g} % in the median is allowed"
        )
        if np.median(off) <= ALIKE:
            return timestep
    return STEPS[-1]


def bare(timestep: float, runs: int = in_form(10, 2), duration: float = DURATION) -> tuple[Spent, float]:
    """Let MuJoCo's own rollout do the same crawl with as many threads; return what it took, and the steps.

    It is as long as the runs of the study: a robot stands for the first second, in which a step costs less.
    """
    model = compile_model(ROBOT, timestep)
    record = simulate([Run(robot=ROBOT, gait=GAIT)], duration=duration, timestep=timestep)
    targets = np.repeat(record.servo_target.values[0, :-1], round(0.01 / timestep), axis=0)
    data = [mujoco.MjData(model) for _ in range(min(threads.count(), runs))]
    data[0].qpos[:] = standing(model, ROBOT, hip_height(ROBOT, GAIT), targets[0])
    data[0].act[:] = activations(model, targets[0])
    begin = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data[0], begin, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    controls = np.broadcast_to(targets, (runs, *targets.shape))
    with rollout.Rollout(nthread=len(data)) as roll:
        took = spent(lambda: roll.rollout([model] * runs, data, np.tile(begin, (runs, 1)), controls))
    return took, float(runs * len(targets))


def run(samples: int, duration: float, timestep: float) -> tuple[Spent, int]:
    with TemporaryDirectory() as folder:
        results = []
        took = spent(lambda: results.append(conduct(study(samples, duration, timestep), Path(folder) / "s")))
    return took, int((results[0].error != "").sum())


def batches(timestep: float) -> None:
    took, failed = run(RUNS, DURATION, timestep)
    what = f"{RUNS} runs of {DURATION:g} s at {1000 * timestep:g} ms, {len(MEASURES)} measures, {failed} failed: "
    print(what + took.beside(RUNS * DURATION / timestep, *bare(timestep)))


def memory() -> None:
    took, failed = run(10_000, 1.1, 0.01)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(
        f"10 000 runs of 1.1 s at 10 ms, {failed} failed: {took.wall:.0f} s, {took.cpu:.0f} s of processor time, "
        f"peak memory {peak:.2f} GB"
    )


def main() -> None:
    print(f"{threads.count()} threads; every run has a robot of its own; 32 runs a batch, stored as they come")
    if "--memory" in sys.argv:
        memory()
        return
    run_chunk(study(1, 1.1, 0.01), 0)  # what is compiled once is none of it
    batches(largest_step())


if __name__ == "__main__":
    main()
