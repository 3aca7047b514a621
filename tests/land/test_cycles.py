"""A crawl of so many cycles, and the speed that gaits of other cycle times are compared by."""

from dataclasses import replace

import pytest

import suchus
from suchus.core.errors import InvalidDesign
from suchus.robot.motion import START
from suchus.sim.metrics import displacement, speed

GAIT = suchus.GAITS["belly_crawl"]
FAST = replace(GAIT, period=GAIT.period / 2)


def walk(gait, **options):
    return suchus.crawl("caiman", gait, timestep=0.005, **options)


def test_cycles_end_where_the_gait_has_gone_through_them():
    record = walk(FAST, cycles=1.5)
    assert float(record.time[-1]) == pytest.approx(START + 1.5 * FAST.period)
    assert record.position.equals(walk(FAST, duration=START + 1.5 * FAST.period).position)


def test_speed_is_displacement_over_the_time_after_settling():
    record = walk(FAST, cycles=0.5)
    far = float(displacement(record).sel(xyz="x"))
    assert float(speed(record)) == pytest.approx(far / (0.5 * FAST.period))
    part = float(speed(record, START, START + 0.25 * FAST.period))
    far = float(displacement(record, START, START + 0.25 * FAST.period).sel(xyz="x"))
    assert part == pytest.approx(far / (0.25 * FAST.period))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"duration": 3.0, "cycles": 2}, "duration = 3.0 s and cycles = 2; give one of the two"),
        ({"cycles": 0}, "cycles"),
        ({"cycles": float("nan")}, "cycles"),
        ({"cycles": "two"}, "cycles"),
    ],
)
def test_what_makes_no_sense_is_refused_in_a_sentence(options, said):
    with pytest.raises(InvalidDesign, match=said):
        walk(GAIT, **options)
