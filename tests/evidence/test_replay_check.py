"""Records replayed in plain MuJoCo, without the loop of suchus, and what the replay finds in false ones."""

from dataclasses import asdict

import pytest

from evidence.replay_check import LIMITS, replay, runs
from suchus import GAITS, ROBOTS
from suchus.core.errors import IncompatibleRecord
from suchus.sim.land import VACUUM, Backlash, Ground, Lake, Limp, Locked, LostFoot, Push, Run, Slow, Weak, simulate
from suchus.sim.persistence import Persistence

CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]


def disagreements(run, record=None):
    """Return what of a run lies outside its limits."""
    record = simulate([run], duration=2.5).isel(run=0) if record is None else record
    values = asdict(replay(record, run.robot, faults=run.faults, pushes=run.pushes))
    return {name: value for name, value in values.items() if abs(value) > LIMITS[name]}


SAMPLE = {
    "crawl": Run(robot=CAIMAN, gait=CRAWL),
    "slope and friction": Run(
        robot=CAIMAN, gait=GAITS["high_walk"], ground=Ground(friction_scale=0.7, uphill=0.05, sideways=-0.03)
    ),
    "noise": Run(robot=CAIMAN, gait=CRAWL, noise=0.02, seed=3),
    "limp": Run(robot=CAIMAN, gait=CRAWL, faults=(Limp("LF_pitch", 1.5),)),
    "locked": Run(robot=CAIMAN, gait=CRAWL, faults=(Locked("LH_yaw", 1.2),)),
    "weak": Run(robot=CAIMAN, gait=CRAWL, faults=(Weak("RH_pitch", 0.2, 1.0),)),
    "push": Run(robot=CAIMAN, gait=CRAWL, pushes=(Push(at=1.2, force=(0.0, 9.0, 0.0)),)),
    "backlash": Run(robot=CAIMAN, gait=CRAWL, faults=(Backlash("LF_yaw", gap=0.1, at=1.2),)),
    "limp, and powered again": Run(
        robot=CAIMAN, gait=GAITS["low_crawl"], faults=(Limp("LF_yaw", 1.5, persistence=Persistence(duration=0.4)),)
    ),
    "spells": Run(
        robot=CAIMAN, gait=CRAWL, faults=(Slow("LF_yaw", 0.5, 1.2, persistence=Persistence(rate=3.0, length=0.2)),)
    ),
    "lost foot": Run(robot=CAIMAN, gait=CRAWL, faults=(LostFoot("LF", 1.2, persistence=Persistence(duration=0.5)),)),
    "six legs": Run(robot=ROBOTS["strider"], gait=GAITS["tripod"]),
    "salamander": Run(robot=ROBOTS["salamander"], gait=GAITS["salamander_walk"]),
}


@pytest.mark.parametrize("name", SAMPLE)
def test_a_record_is_what_plain_mujoco_does(name):
    assert disagreements(SAMPLE[name]) == {}


@pytest.mark.slow("every body in every gait, and with each kind of fault: more than ten seconds")
def test_all_bodies_gaits_and_faults_agree():
    assert {run.label: found for run in runs() if (found := disagreements(run))} == {}


def falsified(**changes):
    """Return the crawl with variables multiplied."""
    record = simulate([SAMPLE["crawl"]], duration=2.5).isel(run=0)
    return record.assign({name: record[name] * factor for name, factor in changes.items()})


@pytest.mark.parametrize(
    ("variable", "error"),
    [
        ("servo_power", "work_error"),
        ("servo_absolute_power", "absolute_work_error"),
        ("servo_mean_square_torque", "square_error"),
        ("servo_torque", "torque_error"),
        ("foot_force", "load_error"),
        ("position", "position_error"),
    ],
)
def test_a_false_record_is_found(variable, error):
    assert error in disagreements(SAMPLE["crawl"], falsified(**{variable: 1.03}))


def test_records_that_cannot_be_replayed_are_refused():
    swim = simulate([Run(robot=ROBOTS["floating_caiman"], gait=CRAWL, lake=Lake(level=0.5))], duration=0.1).isel(run=0)
    with pytest.raises(IncompatibleRecord, match="in water"):
        replay(swim, ROBOTS["floating_caiman"])
    floats = simulate([Run(robot=CAIMAN, gait=CRAWL, afloat=VACUUM)], duration=0.1).isel(run=0)
    with pytest.raises(IncompatibleRecord, match="no ground"):
        replay(floats, CAIMAN)
    thinned = simulate([SAMPLE["crawl"]], duration=1.0, sample_stride=10).isel(run=0)
    with pytest.raises(IncompatibleRecord, match=r"every 0\.1 s from 0 s"):
        replay(thinned, CAIMAN)
