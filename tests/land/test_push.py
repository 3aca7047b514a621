from dataclasses import replace

import numpy as np
import pytest

import suchus
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.sim.land import CONTROL_PERIOD, Ground, Push, Run, simulate


@pytest.fixture(scope="module")
def icy(request):
    """The caiman at rest on ground with almost no friction: whatever moves it sideways came from the push."""
    robot = suchus.ROBOTS["caiman"]
    contact = replace(robot.contact, foot_friction=0.01, skin_friction=0.01)
    return replace(robot, contact=contact)


def momentum(record, robot):
    """Return the momentum of the whole robot between samples, (time - 1, 3) [N s]."""
    return robot.mass * np.diff(record.centre_of_mass.values, axis=0) / CONTROL_PERIOD


def pushed(robot, pushes, duration=0.9, **options):
    gait = suchus.GAITS["limbs_only"]
    run = Run(robot=robot, gait=gait, ground=Ground(friction_scale=0.01), pushes=tuple(pushes), **options)
    return simulate([run], duration=duration).isel(run=0)


@pytest.mark.parametrize(
    ("at", "duration"), [(0.4, 0.2), (0.403, 0.2), (0.4, 0.0042)], ids=["whole periods", "off the clock", "a knock"]
)
def test_momentum_gained_is_force_times_duration(icy, at, duration):
    force = np.array([2.0, 3.0, 0.0]) * (0.1 / duration)
    record = pushed(icy, [Push(force=tuple(force), at=at, duration=duration, body="pelvis")])
    still = pushed(icy, [])
    gained = momentum(record, icy) - momentum(still, icy)
    after = int(np.ceil((at + duration) / CONTROL_PERIOD)) + 1
    # friction is at most 0.0001 m g
    assert gained[after, :2] == pytest.approx(force[:2] * duration, rel=0.02)
    assert np.abs(gained[: int(at / CONTROL_PERIOD) - 1]).max() == 0.0


def test_a_push_leaves_what_came_before_it_identical_to_the_byte(icy):
    record = pushed(icy, [Push(force=(0, 5, 0), at=0.5)])
    still = pushed(icy, [])
    first = record.time < 0.5 + 1e-9
    assert (
        record.isel(time=first).centre_of_mass.values.tobytes()
        == still.isel(time=first).centre_of_mass.values.tobytes()
    )
    assert np.abs(record.centre_of_mass - still.centre_of_mass).max() > 1e-3


def test_pushes_that_overlap_add_up_and_opposite_ones_cancel(icy):
    one = pushed(icy, [Push(force=(0, 4, 0), at=0.4)])
    halves = pushed(icy, [Push(force=(0, 2, 0), at=0.4), Push(force=(0, 2, 0), at=0.4)])
    none = pushed(icy, [Push(force=(0, 4, 0), at=0.4), Push(force=(0, -4, 0), at=0.4)])
    assert np.array_equal(one.centre_of_mass, halves.centre_of_mass)
    assert np.array_equal(none.centre_of_mass, pushed(icy, []).centre_of_mass)


def test_each_run_of_a_batch_gets_its_own_push(icy):
    gait = suchus.GAITS["limbs_only"]
    pushes = [(), (Push(force=(0, 3, 0), at=0.3),), (Push(force=(0, -3, 0), at=0.3),)]
    runs = [Run(robot=icy, gait=gait, ground=Ground(friction_scale=0.01), pushes=p) for p in pushes]
    y = simulate(runs, duration=0.8).centre_of_mass.sel(xyz="y").isel(time=-1).values
    assert abs(y[0]) < 1e-3
    assert y[1] > 0.02
    assert y[2] < -0.02


def test_crawl_takes_pushes():
    robot, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
    hit = suchus.crawl(robot, gait, duration=0.5, pushes=[suchus.Push(force=(0, 30, 0), at=0.1)])
    assert float(hit.centre_of_mass.sel(xyz="y").max()) > 0.005


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"force": (1.0, 2.0)}, "push.force has 2 numbers; x, y, z need one each"),
        ({"force": (np.nan, 0.0, 0.0)}, "push.force"),
        ({"at": -1.0}, "push.at is -1 s; 0 to 86400 s is allowed"),
        ({"duration": 0.0}, "push.duration is 0 s"),
    ],
)
def test_an_impossible_push_is_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        Push(**({"force": (1.0, 0.0, 0.0), "at": 0.1} | fields))


def test_a_push_on_no_body_or_after_the_end_is_refused(icy):
    with pytest.raises(UnknownName, match=r"no body named 'torso'; there is pelvis.*"):
        pushed(icy, [Push(force=(1, 0, 0), at=0.1, body="torso")])
    with pytest.raises(InvalidDesign, match=r"from 0.8 to 1 s does not fit into a run of 0.9 s"):
        pushed(icy, [Push(force=(1, 0, 0), at=0.8)])
