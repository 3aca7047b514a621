"""Every gait of the shelf on the default robot: servos below their limits for 98 % of the walk, or it is said."""

import os
import re
import sys
from pathlib import Path

import pytest

from evidence.servo_loads import measured
from suchus.hardware.loads import AT_LIMIT
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS, suits
from suchus.robot.robots import ROBOTS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from pages.passages import put  # noqa: E402
from pages.stated import kept as stated_numbers  # noqa: E402
from pages.stated import text_of  # noqa: E402

PAGE = ROOT / "docs" / "servos_evidence.md"
OWN = ("belly_crawl", "low_crawl", "limbs_only", "limbs_tail_lifted", "spine_only", "tail_drag", "tail_still",
       "semi_erect", "high_walk")  # fmt: skip
"""Gaits that were made for the robot."""
SAID = re.compile(
    r"(\w+) is at its torque limit of [\d.]+ N m for \d+ % of the walk, first at [\d.]+ s, and up to [\d.]+ degrees "
    r"from its commanded angle; (\S+ \([\d.]+ N m\)|none of the servos that suchus knows) would do\."
)


def agrees(found):
    """Refuse a gait with a servo at its limit of which nothing is said, or for which too weak a servo is named."""
    for gait, told in found.items():
        assert [SAID.fullmatch(one)[1] for one in told["said"]] == list(told["servos"]), gait
        assert (told["most"] > AT_LIMIT) == bool(told["servos"]), gait
        for name, one in told["servos"].items():
            assert (one["then"] <= AT_LIMIT) == (one["would_do"] != "none"), (gait, name)


def test_every_gait_of_the_shelf_is_below_the_limits_or_it_is_said_which_servo_would_do():
    """One cycle; the table of the page has two. With steps of 5 ms knees reach their limit in the high walk."""
    robot = ROBOTS["caiman"]
    found = measured(robot, cycles=1, timestep=0.002)
    assert list(found) == [name for name in GAITS if suits(robot, GAITS[name])]
    assert set(OWN) <= {gait for gait, told in found.items() if not told["servos"]}
    agrees(found)


def test_of_weaker_servos_it_is_said_which_would_do():
    former = blueprint.read_design(ROOT / "examples" / "former_caiman.toml", Robot, ROBOTS)
    found = measured(former, cycles=1, timestep=0.005, names=("belly_crawl", "spine_only", "limbs_only"))
    assert {gait for gait, told in found.items() if "spine_yaw_1" in told["servos"]} == {"belly_crawl", "spine_only"}
    agrees(found)


def page(found):
    return put(PAGE.read_text(encoding="utf-8"), {"servo_loads": text_of("servo_loads", {"servo_loads": found})})


def test_the_page_states_what_the_servos_bear():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    found = stated_numbers("servo_loads")
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(page(found), encoding="utf-8")
    assert page(found) == PAGE.read_text(encoding="utf-8")
    agrees(found)
    assert all(found[gait]["most"] < AT_LIMIT for gait in OWN)
    weak = {"at_limit": 0.22, "off": 0.2, "would_do": "XM540-W270 (10.6 N m)", "then": 0.03}
    found["spine_only"] = {
        "exported": True, "most": 0.22, "servos": {"spine_yaw_1": weak},
        "said": ["spine_yaw_1 is at its torque limit of 2.5 N m for 22 % of the walk, first at 0.30 s, and up to 14.2 "
                 "degrees from its commanded angle; XM540-W270 (10.6 N m) would do."],
    }  # fmt: skip
    assert "| `spine_only` | `spine_yaw_1` | 22 % |" in page(found)
    with pytest.raises(AssertionError, match="spine_only"):  # too weak a servo is named
        agrees(found)
    weak["then"] = 0.01
    agrees(found)
