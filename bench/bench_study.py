"""A hundred runs of 10 s through a study, and the memory of ten thousand short ones.

Usage: python bench/bench_study.py [--memory]
"""

import resource
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from suchus import threads
from suchus.gaits import GAITS
from suchus.land import Run
from suchus.robots import ROBOTS
from suchus.study import Study, Vary, conduct

MEASURES = ("displacement", "slip", "cost_of_transport", "height_std", "peak_torque")


def study(samples: int, duration: float, timestep: float) -> Study:
    return Study(
        name="bench",
        run=Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"]),
        vary=(
            Vary(field="gait.stroke", low=0.01, high=0.05),
            Vary(field="robot.contact.foot_friction", low=0.5, high=1.0),
        ),
        measure=MEASURES,
        design="sobol",
        samples=samples,
        duration=duration,
        timestep=timestep,
    )


def run(samples: int, duration: float, timestep: float) -> None:
    wall, cpu = time.perf_counter(), time.process_time()
    with TemporaryDirectory() as folder:
        results = conduct(study(samples, duration, timestep), Path(folder) / "s")
    failed = int((results.error != "").sum())
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(
        f"{samples} runs of {duration:g} s at {1000 * timestep:g} ms, {len(MEASURES)} measures, {failed} failed: "
        f"{wall:.1f} s, {cpu:.1f} s of processor time, peak memory {peak:.2f} GB"
    )


def main() -> None:
    print(f"{threads.count()} threads; every run has a robot of its own; 32 runs a batch, stored as they come")
    run(100, 10.0, 0.005)
    if "--memory" in sys.argv:
        run(10_000, 1.1, 0.01)


if __name__ == "__main__":
    main()
