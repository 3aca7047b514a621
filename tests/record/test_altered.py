"""Records that somebody changed with other tools mean what they say, or are refused in a sentence."""

import numpy as np
import pytest

from suchus.core.errors import IncompatibleRecord
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.record import check_land

NAMES = ("position", "orientation", "joint_angle", "snout", "tail_tip", "foot_position")


@pytest.fixture(scope="module")
def record():
    return simulate([Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"])], duration=0.05)


SAME = {
    "single precision": lambda r: r.assign(position=r.position.astype("f4")),
    "one run taken out": lambda r: r.isel(run=0),
    "no units": lambda r: r.assign(position=r.position.drop_attrs()),
    "another description": lambda r: r.assign(position=r.position.assign_attrs(long_name="where it is")),
    "half of the samples": lambda r: r.isel(time=slice(None, None, 2)),
    "no labels of axes": lambda r: r.drop_vars(["xyz", "wxyz"]),
}
OTHER = {
    "centimetres": (lambda r: r.assign(snout=(100 * r.snout).assign_attrs(units="cm")), "snout in 'cm' instead of m"),
    "degrees": (
        lambda r: r.assign(joint_angle=np.degrees(r.joint_angle).assign_attrs(units="deg")),
        "joint_angle in 'deg' instead of rad",
    ),
    "milliseconds": (
        lambda r: r.assign_coords(time=("time", 1e3 * r.time.values, {"units": "ms"})),
        "time in 'ms' instead of s",
    ),
    "exchanged": (
        lambda r: r.rename(snout="tail_tip", tail_tip="snout"),
        "tail_tip under the name of snout; snout under the name of tail_tip",
    ),
    "dimensions": (lambda r: r.transpose("xyz", "run", "time", ...), "holds position, snout, tail_tip, foot_position"),
    "axes": (lambda r: r.isel(xyz=[2, 0, 1]), "holds position, snout, tail_tip, foot_position otherwise"),
    "units that are no text": (
        lambda r: r.assign(snout=r.snout.assign_attrs(units=np.array([1.0, 2.0]))),
        "snout in '\\[1. 2.\\]' instead of m",
    ),
    "times before zero": (lambda r: r.assign_coords(time=r.time - 5.0), "times from -5 to -4.95 s"),
    "times of years": (lambda r: r.assign_coords(time=r.time * 1e12), "the unit or the beginning is another"),
    "times of picoseconds": (lambda r: r.assign_coords(time=r.time * 1e-12), "s apart; at least 1e-07 s"),
    "a long gap": (
        lambda r: r.assign_coords(time=r.time + 100.0 * (r.time > 0.03)),
        "no sample from .* longer than all the rest lasts",
    ),
    "a mass in grams": (lambda r: r.assign(mass=(1e3 * r.mass).assign_attrs(units="g")), "mass in 'g' instead of kg"),
    "no mass": (lambda r: r.assign(mass=0 * r.mass.assign_attrs(r.mass.attrs)), "holds mass 0 kg"),
    "a period before zero": (lambda r: r.assign(period=-r.period), "holds period -"),
    "a duty factor of 3": (lambda r: r.assign(duty_factor=3 + 0 * r.duty_factor), "holds duty_factor 3"),
    "an end before the beginning": (lambda r: r.assign(ended=r.ended - 60.0), "holds ended -"),
    "quaternions": (lambda r: r.isel(wxyz=[1, 2, 3, 0]), "holds orientation otherwise"),
    "backwards": (lambda r: r.isel(time=slice(None, None, -1)), "times that do not rise"),
}


@pytest.mark.parametrize("how", SAME)
def test_what_means_the_same_is_read(record, how):
    check_land(SAME[how](record), NAMES, "it")


@pytest.mark.parametrize("how", OTHER)
def test_what_means_something_else_is_refused(record, how):
    change, said = OTHER[how]
    with pytest.raises(IncompatibleRecord, match=said):
        check_land(change(record), NAMES, "it")
