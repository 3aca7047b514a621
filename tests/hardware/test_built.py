"""The article's robot, whose servos are sold, beside the one that it was when its servos were numbers."""

import os
import sys
from dataclasses import replace
from pathlib import Path

from evidence.built import HASTY, ITS_OWN, former
from suchus.hardware.loads import AT_LIMIT
from suchus.robot.design import Servo, with_servos
from suchus.robot.design.body import servos_of
from suchus.robot.gaits import GAITS
from suchus.robot.motors import motor
from suchus.robot.robots import ROBOTS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from pages.passages import put  # noqa: E402
from pages.stated import kept as stated_numbers  # noqa: E402
from pages.stated import text_of  # noqa: E402

PAGE = ROOT / "docs" / "servos_evidence.md"


def test_its_servos_are_those_that_are_sold_and_nothing_else_became_another():
    own, was = servos_of(ROBOTS["caiman"]), servos_of(former())
    bought = Servo.from_motor(motor("STS3250"))
    for name, servo in own.items():
        assert replace(servo, kp=bought.kp, kd=bought.kd, integral_limit=bought.integral_limit) == bought, name
        assert (servo.kp, servo.kd) == (was[name].kp, 2.5 * was[name].kd), name
        assert was[name].winding is None
    tables = with_servos(former(), lambda _: own["LF_yaw"]).tables
    assert replace(tables, name="caiman") == ROBOTS["caiman"].tables


def page(found):
    return put(PAGE.read_text(encoding="utf-8"), {"built": text_of("built", {"built": found})})


def test_the_page_states_what_was_measured_and_no_servo_is_at_its_limit():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    found = stated_numbers("built")
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(page(found), encoding="utf-8")
    assert page(found) == PAGE.read_text(encoding="utf-8")
    rows = {(row["gait"], row["period"], row["robot"]): row for row in found["rows"]}
    assert all(rows[name, GAITS[name].period, "caiman"]["at_limit"] < AT_LIMIT for name in ITS_OWN)
    assert all(rows[name, period, "caiman"]["at_limit"] > AT_LIMIT for name, period in HASTY)
    # a crawl that never ends is just what they bear: 70.2 degrees, since friction is that of identified servos
    assert rows["belly_crawl", 4.0, "caiman"]["warmest"] < motor("STS3250").temperature_limit + 1.0
    assert rows["belly_crawl", 4.0, "former_caiman"]["at_limit"] > 0.1
