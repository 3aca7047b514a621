"""The recorded load of many robots against their weight: all designs of the study of claims, and foreign bodies.

``python -m evidence.complete_loads`` walks each and prints those whose recorded contact forces miss the weight by more
than ``LOAD_TOLERANCE`` over the last cycle. ``--designs N`` takes the first N designs only. The outcome is the result
``complete_loads`` of the store.
"""

import argparse
import sys
import time
import warnings
from collections.abc import Iterator, Sequence

import numpy as np

import suchus
from suchus.core.errors import SuchusError
from suchus.experiments.study.claims import Claims
from suchus.experiments.study.plan import Plan
from suchus.robot.design import Robot, layout, with_values
from suchus.robot.design.scale import coarse_step
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate
from suchus.sim.land.load_check import LOAD_TOLERANCE, missing_load

NAME = "complete_loads"
DESIGNS = 2048
"""Number of sampled designs, of which some cannot follow their gait [-]."""
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
            record = simulate([run], duration=_duration(run), timestep=coarse_step(run.robot), effort=False)
            shares.append(float(missing_load(record, [run])[0]))
        except SuchusError:
            shares.append(float("nan"))
    return shares


def _duration(run: Run) -> float:
    """Return the duration of a run in whole hundredths of a second [s]."""
    return round(100 * (START + _CYCLES * run.gait.period)) / 100


def measured(designs: int = DESIGNS, foreign: int = FOREIGN) -> dict[str, dict[str, float]]:
    """Return of the sampled designs and of the foreign bodies how well their records hold their weights.

    Args:
        designs: number of sampled designs [-].
        foreign: number of walks of foreign bodies [-].

    Returns:
        For ``designs`` and ``foreign``: ``walk``, the number that walk; ``judged``, that whose walk is steady enough to
        be judged; ``outside``, that whose record misses the weight by more than ``LOAD_TOLERANCE``; ``greatest``, the
        greatest share of the weight that a record misses [-].
    """
    found: dict[str, dict[str, float]] = {}
    for name, runs in (("designs", sampled_designs(designs)), ("foreign", foreign_bodies(foreign))):
        walks = list(runs)
        shares = np.abs(lacking_loads(walks))
        found[name] = {
            "walk": len(walks), "judged": int(np.isfinite(shares).sum()),
            "outside": int((shares > LOAD_TOLERANCE).sum()), "greatest": float(np.nanmax(shares)),
        }  # fmt: skip
        for run, share in zip(walks, shares, strict=True):
            if share > LOAD_TOLERANCE:
                print(f"{name}: {run.label or run.gait.name} misses {share:.2%} of the weight", flush=True)
    return found


def main() -> int:
    """Walk all, print and store the summary; return 1 where a record lacks a load."""
    from evidence import renew  # noqa: PLC0415  the registry that it reads names this module

    parser = argparse.ArgumentParser(description="recorded loads against weights")
    parser.add_argument("--designs", type=int, default=DESIGNS)
    count = parser.parse_args().designs
    if count < 2:
        print(f"--designs is {count}; give at least 2, best a power of two.", file=sys.stderr)
        return 2
    began = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = measured(count)
        print(renew.store(NAME, found | {"sampled": count}, time.process_time() - began))
    for name, one in found.items():
        print(
            f"{name}: {one['walk']} walk, {one['judged']} judged, {one['outside']} miss the weight by more than "
            f"{LOAD_TOLERANCE:.0%}, greatest {one['greatest']:.3%}"
        )
    return int(any(one["outside"] for one in found.values()))


if __name__ == "__main__":
    sys.exit(main())
