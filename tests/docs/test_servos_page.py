"""The table of walks on identified servos is what the tool makes of them."""

import runpy
from dataclasses import replace
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def tool():
    return runpy.run_path(str(ROOT / "tools" / "identified_servos.py"), run_name="tool")


def test_the_high_walk_of_the_page_is_that_of_today(tool):
    """Renew with ``python tools/identified_servos.py``."""
    page = (ROOT / "docs" / "servos_evidence.md").read_text()
    (task,) = [task for task in tool["TASKS"] if task.name == "high walk"]
    rows = {
        cells[1]: [float(cell) for cell in cells[2:]]
        for line in page.splitlines()
        if (cells := [cell.strip() for cell in line.strip("|").split("|")])[0] == "high walk"
    }
    found = tool["measured"](task)
    assert list(rows) == list(found)
    for label, numbers in found.items():
        assert rows[label] == pytest.approx(list(numbers.values()), rel=0.01), label


def test_the_robots_differ_in_what_the_page_says_alone(tool):
    former, catalog, identified, calm = (robot.servo("LH_pitch") for robot in tool["robots"]().values())
    assert (identified.kp, identified.kd) == (catalog.kp, catalog.kd)
    assert identified.armature == calm.armature == 0.02608
    assert (calm.torque, calm.speed, calm.winding) == (catalog.torque, catalog.speed, catalog.winding)
    assert calm.kd > 1.2 * catalog.kd
    assert replace(former, **{name: getattr(catalog, name) for name in tool["FORMER"]}) == catalog
    assert former.armature < catalog.armature / 2
