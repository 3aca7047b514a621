"""The article's robot compiles to the same MJCF, and walks the same bytes, as before there were other bodies."""

import hashlib
import json
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from suchus import machine
from suchus.control import Coordinated
from suchus.gaits import GAITS
from suchus.land import crawl
from suchus.model import build
from suchus.model.export.mjcf import mjcf
from suchus.robots import ROBOTS

BEFORE = json.loads((Path(__file__).parent.parent / "golden" / "caiman_bytes.json").read_text())
"""Hashes made on Linux on x86-64 with MuJoCo 4.0 by the code as it was when it knew one skeleton only. Those of records
are of its bytes with the arithmetic that is named."""


PINS = (Path(__file__).parents[2] / "constraints.txt").read_text().splitlines()
pinned = pytest.mark.skipif(
    not all(f"{name}=={version(name)}" in PINS for name in ("mujoco", "numpy", "scipy")),
    reason="other versions of MuJoCo, NumPy or SciPy round otherwise",
)


def text_hash(*texts: str) -> str:
    return hashlib.sha256("".join(texts).encode()).hexdigest()


def record_hash(record) -> str:
    found = hashlib.sha256()
    for name in sorted(record.data_vars):
        values = record[name].values
        raw = str(values).encode() if values.dtype.kind == "U" else np.ascontiguousarray(values).tobytes()
        found.update(name.encode() + raw)
    for name in sorted(record.coords):
        found.update(name.encode() + str(record[name].values.tolist()).encode())
    found.update(json.dumps(dict(record.attrs), sort_keys=True).encode())
    return found.hexdigest()


@pytest.mark.parametrize("name", ["caiman", "long_tail"])
def test_the_mjcf_is_the_same_text(name):
    spec = build(ROBOTS[name])
    spec.compile()
    assert text_hash(spec.to_xml()) == BEFORE[f"{name}_mjcf"]
    assert text_hash(*mjcf(ROBOTS[name], GAITS["belly_crawl"])) == BEFORE[f"{name}_full"]


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
    record = crawl(ROBOTS[robot], GAITS[gait], duration=duration, control=control)
    assert record_hash(record) == BEFORE[key]
