"""The article's robot, whose servos are sold, beside the one that it was when its servos were numbers."""

import json
import os
import sys
from dataclasses import replace
from math import isfinite
from pathlib import Path

import pytest

from suchus import blueprint
from suchus.design import Robot, Servo, with_servos
from suchus.design.body import servos_of
from suchus.gaits import GAITS
from suchus.hardware.loads import AT_LIMIT, LoadCase, borne, cold, records_of_each
from suchus.metrics import displacement
from suchus.motors import motor
from suchus.robots import ROBOTS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from pages.passages import put  # noqa: E402
from pages.stated import text_of  # noqa: E402

FILE = ROOT / "examples" / "former_caiman.toml"
STATED = ROOT / "tests" / "docs" / "stated" / "built.json"
PAGE = ROOT / "docs" / "build_one.md"
ITS_OWN = ("belly_crawl", "low_crawl", "limbs_only", "spine_only", "tail_still", "semi_erect", "high_walk")
"""Gaits that were made for it; each at its period."""
HASTY = (("semi_erect", 0.8), ("high_walk", 0.8))
"""Gaits at the period that they had with the former servos [s]."""
WALKS = (*((name, GAITS[name].period) for name in ITS_OWN), *HASTY)
"""Gaits and their periods [s]."""


def former():
    return blueprint.read(FILE, Robot, ROBOTS)


def test_its_servos_are_those_that_are_sold_and_nothing_else_became_another():
    own, was = servos_of(ROBOTS["caiman"]), servos_of(former())
    for name, servo in own.items():
        assert servo == Servo.of(motor("STS3250"), like=was[name]), name
        assert was[name].winding is None
    tables = with_servos(former(), lambda servo: Servo.of(motor("STS3250"), like=servo)).tables
    assert replace(tables, name="caiman") == ROBOTS["caiman"].tables


def measured():
    """Return what the robot and its former self do."""
    cases = []
    for name, period in WALKS:
        gait = GAITS[name]
        cases.append(LoadCase(name=name, gait=replace(gait, period=period)))
    rows = []
    for robot in (former(), ROBOTS["caiman"]):
        records = records_of_each([(cold(robot), case) for case in cases])
        for case, record in zip(cases, records, strict=True):
            loads = borne(robot, record)
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


def page(found):
    return put(PAGE.read_text(encoding="utf-8"), {"built": text_of("built", {"built": found})})


def test_the_page_states_what_was_measured_and_no_servo_is_at_its_limit():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    found = json.loads(STATED.read_text(encoding="utf-8"))
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(page(found), encoding="utf-8")
    assert page(found) == PAGE.read_text(encoding="utf-8")
    rows = {(row["gait"], row["period"], row["robot"]): row for row in found["rows"]}
    assert all(rows[name, GAITS[name].period, "caiman"]["at_limit"] < AT_LIMIT for name in ITS_OWN)
    assert all(rows[name, period, "caiman"]["at_limit"] > AT_LIMIT for name, period in HASTY)
    assert rows["belly_crawl", 4.0, "caiman"]["warmest"] < motor("STS3250").temperature_limit
    assert rows["belly_crawl", 4.0, "former_caiman"]["at_limit"] > 0.1


@pytest.mark.validate
def test_the_two_robots_do_what_is_kept():
    """Renew with SUCHUS_GOLDEN=write."""
    found = measured()
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        STATED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    kept = json.loads(STATED.read_text(encoding="utf-8"))
    for row, one in zip(found["rows"], kept["rows"], strict=True):
        assert (row["gait"], row["robot"]) == (one["gait"], one["robot"])
        assert row["distance"] == pytest.approx(one["distance"], rel=0.02, abs=2e-3)
        assert row["at_limit"] == pytest.approx(one["at_limit"], abs=0.02)
