"""The robot with its former servos compiles to the same MJCF and walks the same bytes as when it was the only one."""

import hashlib
import json
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from suchus.core import machine
from suchus.robot import blueprint
from suchus.robot.control import Coordinated
from suchus.robot.design import Robot, crocodile
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl
from suchus.sim.model import build
from suchus.sim.model.export.mjcf import mjcf
from suchus.sim.record import EFFORT

BEFORE = json.loads((Path(__file__).with_name("caiman_bytes.json")).read_text())
"""Hashes made on Linux on x86-64 with MuJoCo 4.0 by the code as it was when it knew one skeleton only, but for the
rotor of the cable, which turns with the cords since. Those of records are of its bytes with the arithmetic that is
named."""

SINCE = {*EFFORT, "foot_roll", "limb_force"}
"""Variables of a record that came later."""


def former(name):
    """Return a robot of the shelf with the servos and the name that it had then."""
    path = Path(__file__).parents[2] / "examples" / "former_caiman.toml"
    was, tables = blueprint.read_design(path, Robot, ROBOTS).tables, ROBOTS[name].tables
    parts = {"hind_leg": ("servo",), "front_leg": ("servo",), "spine": ("yaw_servo", "pitch_servo"),
             "tail": ("pitch_servo", "cable_servo")}  # fmt: skip
    changed = {
        part: replace(getattr(tables, part), **{servo: getattr(getattr(was, part), servo) for servo in servos})
        for part, servos in parts.items()
    }
    return crocodile(replace(tables, **changed))


PINS = (Path(__file__).parents[2] / "constraints.txt").read_text().splitlines()
pinned = pytest.mark.skipif(
    not all(f"{name}=={version(name)}" in PINS for name in ("mujoco", "numpy", "scipy")),
    reason="other versions of MuJoCo, NumPy or SciPy round otherwise",
)


def text_hash(*texts: str) -> str:
    return hashlib.sha256("".join(texts).encode()).hexdigest()


def record_hash(record) -> str:
    """Return the hash of the bytes of all variables that records held then."""
    found = hashlib.sha256()
    for name in sorted(set(record.data_vars) - SINCE):
        values = record[name].values
        raw = str(values).encode() if values.dtype.kind == "U" else np.ascontiguousarray(values).tobytes()
        found.update(name.encode() + raw)
    for name in sorted(record.coords):
        found.update(name.encode() + str(record[name].values.tolist()).encode())
    found.update(json.dumps(dict(record.attrs), sort_keys=True).encode())
    return found.hexdigest()


@pytest.mark.parametrize("name", ["caiman", "long_tail"])
def test_the_mjcf_is_the_same_text(name):
    robot = former(name)
    spec = build(robot)
    spec.compile()
    assert text_hash(spec.to_xml()) == BEFORE[f"{name}_mjcf"]
    assert text_hash(*mjcf(robot, GAITS["belly_crawl"])) == BEFORE[f"{name}_full"]


@pinned
@pytest.mark.skipif(
    machine.arithmetic() != BEFORE["arithmetic"], reason="another machine's arithmetic gives other last bits"
)
@pytest.mark.parametrize(
    ("key", "robot", "gait", "duration", "control"),
    [
        ("crawl", "caiman", "belly_crawl", 2.0, None),
        ("coordinated", "caiman", "belly_crawl", 2.0, Coordinated()),
        ("high_walk", "caiman", "high_walk", 1.6, None),
    ],
)
def test_its_record_has_the_same_bytes(key, robot, gait, duration, control):
    hasty = replace(GAITS[gait], period=min(GAITS[gait].period, 0.8)) if gait == "high_walk" else GAITS[gait]
    record = crawl(former(robot), hasty, duration=duration, control=control)
    assert record_hash(record) == BEFORE[key]
