"""What the article's robot and its former self, with weaker servos, do in the gaits that were made for it."""

from dataclasses import replace
from math import isfinite
from typing import Any

from evidence.store import ROOT
from suchus.hardware.loads import LoadCase, cold, measure_loads, records_of_each
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import displacement

FILE = ROOT / "examples" / "former_caiman.toml"
ITS_OWN = ("belly_crawl", "low_crawl", "limbs_only", "spine_only", "tail_still", "semi_erect", "high_walk")
"""Gaits that were made for it; each at its period."""
HASTY = (("semi_erect", 0.8), ("high_walk", 0.8))
"""Gaits at the period that they had with the former servos [s]."""
WALKS = (*((name, GAITS[name].period) for name in ITS_OWN), *HASTY)
"""Gaits and their periods [s]."""


def former() -> Robot:
    """Return the robot as it was."""
    return blueprint.read_design(FILE, Robot, ROBOTS)


def measured() -> dict[str, Any]:
    """Return what the robot and its former self do."""
    cases = []
    for name, period in WALKS:
        gait = GAITS[name]
        cases.append(LoadCase(name=name, gait=replace(gait, period=period)))
    rows = []
    for robot in (former(), ROBOTS["caiman"]):
        records = records_of_each([(cold(robot), case) for case in cases])
        for case, record in zip(cases, records, strict=True):
            loads = measure_loads(robot, record)
            most = max(loads, key=lambda name: loads[name].at_limit)
            steady = [load.steady for load in loads.values()]
            rows.append(
                {
                    "gait": case.name,
                    "period": case.gait.period,
                    "robot": robot.name,
                    "distance": float(displacement(record).sel(xyz="x")),
                    "servo": most,
                    "at_limit": loads[most].at_limit,
                    "lag": max(load.off for load in loads.values()),
                    "warmest": max(steady) if all(map(isfinite, steady)) else None,
                }
            )
    order = [name for name, _ in WALKS]
    return {"rows": sorted(rows, key=lambda row: (order.index(row["gait"]), row["period"], row["robot"]))}
