"""The article's robot with servos that are sold, beside the one whose servos are numbers."""

import json
import os
import sys
from dataclasses import replace
from math import isfinite
from pathlib import Path

import pytest

from suchus import blueprint
from suchus.blueprint import motor
from suchus.design import Robot, Servo
from suchus.design.body import servos_of
from suchus.gaits import GAITS
from suchus.hardware.loads import AT_LIMIT, LoadCase, borne, cold, records_of_each
from suchus.metrics import displacement
from suchus.robots import ROBOTS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from pages.passages import put  # noqa: E402
from pages.stated import text_of  # noqa: E402

FILE = ROOT / "examples" / "built_caiman.toml"
STATED = ROOT / "tests" / "docs" / "stated" / "built.json"
PAGE = ROOT / "docs" / "build_one.md"
WALKS = (("belly_crawl", 4.0), ("low_crawl", None), ("semi_erect", None), ("high_walk", 0.8), ("high_walk", 1.6))
"""Gaits and their periods; that of the gait if None [s]."""


def built():
    return blueprint.read(FILE, Robot, ROBOTS)


def test_its_servos_are_those_that_are_sold():
    own, made = servos_of(ROBOTS["caiman"]), servos_of(built())
    for name, servo in made.items():
        assert servo == Servo.of(motor(servo.winding.motor), like=own[name]), name
    assert {servo.winding.motor for servo in made.values()} == {"STS3250", "STS3215-12V"}
    assert made["spine_yaw_1"].winding.motor == made["LH_knee"].winding.motor == "STS3250"


def measured():
    """Return what the robot with numbers and the one with servos that are sold do."""
    cases = []
    for name, period in WALKS:
        gait = GAITS[name]
        cases.append(LoadCase(name=name, gait=replace(gait, period=period or gait.period)))
    rows = []
    for robot in (ROBOTS["caiman"], built()):
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
    return {"rows": sorted(rows, key=lambda row: [name for name, _ in WALKS].index(row["gait"]) + row["period"] / 100)}


def page(found):
    return put(PAGE.read_text(encoding="utf-8"), {"built": text_of("built", {"built": found})})


def test_the_page_states_what_was_measured_and_no_bought_servo_is_at_its_limit():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    found = json.loads(STATED.read_text(encoding="utf-8"))
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(page(found), encoding="utf-8")
    assert page(found) == PAGE.read_text(encoding="utf-8")
    rows = {(row["gait"], row["period"], row["robot"]): row for row in found["rows"]}
    crawl, walk = rows["belly_crawl", 4.0, "built_caiman"], rows["high_walk", 1.6, "built_caiman"]
    assert crawl["at_limit"] == walk["at_limit"] == 0.0
    assert rows["high_walk", 0.8, "built_caiman"]["at_limit"] > AT_LIMIT
    assert crawl["warmest"] < motor("STS3250").temperature_limit
    assert rows["belly_crawl", 4.0, "caiman"]["at_limit"] > 0.1


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
