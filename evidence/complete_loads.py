"""The recorded load of many robots against their weight: all designs of the study of claims, and foreign bodies.

``python -m evidence.complete_loads`` walks each and prints those whose recorded contact forces miss the weight by more
than ``LOAD_TOLERANCE`` over the last cycle; ``--designs N`` takes the first N designs only.
"""

import argparse
import sys
import warnings
from collections.abc import Iterator, Sequence

import numpy as np

import suchus
from suchus.core.errors import SuchusError
from suchus.experiments.study.claims import Claims
from suchus.experiments.study.plan import Plan
from suchus.robot.design import Robot, layout, with_values
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate
from suchus.sim.land.load_check import LOAD_TOLERANCE, missing_load

FOREIGN = 60
"""Number of foreign bodies [-]."""
_CYCLES = 2


def sampled_designs(count: int) -> Iterator[Run]:
    """Yield the whole robot's runs of the first designs of the study of claims, those that can be built and walk."""
    plan = Plan(Claims().study(max(count, 2), 0.005))
    for sample in range(count):
        try:
            run = plan.run(sample * len(plan.study.arms))
            simulate([run], duration=0.02, timestep=0.01)
        except SuchusError:
            continue
        yield run


def foreign_bodies(count: int, seed: int = 0) -> Iterator[Run]:
    """Yield walks of the robots of the catalog that are not the article's, with other feet and shanks.

    Args:
        count: number of walks [-].
        seed: of the random radii.
    """
    random = np.random.default_rng(seed)
    pairs = [
        (robot, gait)
        for robot in suchus.ROBOTS.values()
        if robot.tables is None and layout(robot).limbs
        for gait in suchus.GAITS.values()
        if _can_walk(robot, gait)
    ]
    for number in range(count):
        robot, gait = pairs[number % len(pairs)]
        changes = {}
        for index, girdle in enumerate(robot.girdles):
            limb, radius = girdle.limb, girdle.limb.foot.radius * random.uniform(0.6, 1.6)
            changes[f"girdles[{index}].limb.foot.radius"] = radius
            changes[f"girdles[{index}].limb.links[{len(limb.links) - 1}].radius"] = radius * random.uniform(0.3, 1.0)
        yield Run(robot=with_values(robot, changes), gait=gait, label=f"{robot.name} {gait.name} {number}")


def _can_walk(robot: Robot, gait: object) -> bool:
    """Return whether a robot can walk in a gait."""
    try:
        simulate([Run(robot=robot, gait=gait)], duration=0.1)  # type: ignore[arg-type]
    except SuchusError:
        return False
    return True


def lacking_loads(runs: Sequence[Run]) -> list[float]:
    """Return the share of the weight that the record of each run lacks [-]; NaN where it ended early."""
    shares: list[float] = []
    for run in runs:
        try:
            record = simulate([run], duration=_duration(run), effort=False)
            shares.append(float(missing_load(record, [run])[0]))
        except SuchusError:
            shares.append(float("nan"))
    return shares


def _duration(run: Run) -> float:
    """Return the duration of a run in whole hundredths of a second [s]."""
    return round(100 * (START + _CYCLES * run.gait.period)) / 100


def main() -> int:
    """Walk all, print the summary; return 1 where a record lacks a load."""
    parser = argparse.ArgumentParser(description="recorded loads against weights")
    parser.add_argument("--designs", type=int, default=2048)
    count, bad = parser.parse_args().designs, 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name, runs in (
            ("designs", list(sampled_designs(count))),
            ("foreign bodies", list(foreign_bodies(FOREIGN))),
        ):
            shares = np.array(lacking_loads(runs))
            outside = np.abs(shares) > LOAD_TOLERANCE
            bad += int(outside.sum())
            print(
                f"{name}: {len(runs)} walk, {np.isfinite(shares).sum()} judged, {outside.sum()} miss the weight by "
                f"more than {LOAD_TOLERANCE:.0%}, greatest {np.nanmax(np.abs(shares)):.3%}"
            )
            for run, share in zip(runs, shares, strict=True):
                if abs(share) > LOAD_TOLERANCE:
                    print(f"  {run.label or run.gait.name}: {share:+.2%}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
