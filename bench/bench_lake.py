"""Steps per second in water beside dry land: the same batch, one thread and two.

The batches take turns of a fifth of a second of the run, since a machine that others use too changes its speed within
seconds. What is prepared before the first step and gathered after the last one does not count.

Usage: python bench/bench_lake.py [--first]   (with it only how long the first wet step takes in a new process)
"""

import os
import subprocess
import sys
import time

import numpy as np

from form import in_form
from suchus.robot.control import Swimming
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run
from suchus.sim.land.loop import Loop, physics_steps
from suchus.swimming.water import fit, printed_wave

RUNS, TICKS = in_form(8, 2), in_form(20, 2)  # TICKS control periods in a turn
TURNS, WARM = in_form(24, 1), in_form(3, 1)  # the first WARM turns do not count
WAVE = fit(ROBOTS["caiman"], printed_wave(ROBOTS["caiman"], frequency=1.0)).gait
GAIT = GAITS["belly_crawl"]
ARMS = {
    "dry": {"robot": "caiman"},
    "dry, water far below": {"robot": "caiman", "lake": Lake(level=-10.0)},
    "wading, 60 mm": {"robot": "caiman", "lake": Lake(level=0.06)},
    "swimming": {
        "robot": "floating_caiman",
        "lake": Lake(level=2.0),
        "gait": WAVE,
        "control": Swimming(),
    },
}
FIRST = """
import time
from suchus.sim.land import Lake, crawl
crawl("caiman", "belly_crawl", duration=0.01)
start = time.process_time()
crawl("caiman", "belly_crawl", duration=0.01, lake=Lake(level=0.06))
print(time.process_time() - start)
"""


class Arm:
    """A batch that is stepped turn by turn."""

    def __init__(self, arm: dict) -> None:
        runs = [
            Run(**{"gait": GAIT, "seed": i, "noise": 1e-6} | arm) for i in range(RUNS)
        ]  # noise: no two of them go alike
        samples = (WARM + TURNS) * TICKS
        self.steps = physics_steps(0.002)
        self.loop = Loop(runs, 0.002, ticks=samples)
        self.recorder = self.loop.recorder(samples)

    def turn(self, clock) -> float:
        """Return steps per second of a clock over one turn."""
        start = clock()
        for _ in range(TICKS):
            self.loop.decide()
            self.recorder.store(self.loop.tick, self.loop.command.phase, self.loop.command.targets)
            self.loop.advance()
        return RUNS * TICKS * self.steps / (clock() - start)


def first() -> float:
    """Return the processor time of the first wet step of a new process, its kernel compiled before [s]."""
    times = [
        float(subprocess.run([sys.executable, "-c", FIRST], capture_output=True, check=True).stdout)
        for _ in range(in_form(3, 1))
    ]
    return min(times)


def main() -> None:
    print(f"{RUNS} runs, {TURNS} turns of {TICKS} control periods each; cores {os.cpu_count()}")
    print(f"first wet step of a process: {first():.2f} s of processor time")
    if "--first" in sys.argv:
        return
    for threads, clock, unit in (
        ("1", time.process_time, "of processor time"),
        ("2", time.perf_counter, "on the clock"),
    ):
        os.environ["SUCHUS_THREADS"] = threads
        arms = [Arm(arm) for arm in ARMS.values()]
        found = np.array([[arm.turn(clock) for arm in arms] for _ in range(WARM + TURNS)])[WARM:]
        best, shares = found.max(axis=0), np.median(found / found[:, :1], axis=0)
        print(f"{threads} thread{'s' * (threads != '1')}: steps per second {unit}, and the median share of dry")
        for name, steps, share in zip(ARMS, best, shares, strict=True):
            print(f"  {name:22s} {steps:8.0f}  {share:.2f}")


if __name__ == "__main__":
    main()
