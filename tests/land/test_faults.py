from dataclasses import dataclass, replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.control import Command, OpenLoop
from suchus.robot.design import crocodile, servo_names
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import SENSORS
from suchus.sim.land import Deaf, Limp, Locked, Run, Weak, simulate
from suchus.sim.metrics import displacement

CAIMAN = ROBOTS["caiman"]
CRAWL = GAITS["belly_crawl"]
OTHER = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.25)))


def walk(*faults, robot=CAIMAN, gait=CRAWL, duration=3.0, beside=()):
    """Return the record of one run; ``beside`` puts runs of other robots into the same batch."""
    runs = [Run(robot=robot, gait=gait, faults=faults), *beside]
    return simulate(runs, duration=duration, timestep=0.005).isel(run=0)


def same(one, other):
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.data_vars)


# In a batch of one robot faults are per-run values of one model; in a batch of several each run has its own model.
BATCHES = pytest.mark.parametrize("beside", [(), (Run(robot=OTHER, gait=CRAWL),)], ids=["one robot", "several robots"])


@BATCHES
@pytest.mark.parametrize("joint", ["LF_yaw", "RH_knee", "spine_pitch_1", "tail_pitch", "tail_cable"])
def test_a_limp_servo_gives_no_torque_and_the_others_do(joint, beside):
    record = walk(Limp(joint), beside=beside)
    assert np.all(record.servo_torque.sel(servo=joint).isel(time=slice(1, None)) == 0.0)
    others = [name for name in servo_names() if name != joint]
    assert float(abs(record.servo_torque.sel(servo=others)).max("time").min()) > 1e-3


@BATCHES
def test_the_gear_friction_of_a_limp_servo_stays(beside):
    rough = crocodile(
        replace(
            CAIMAN.tables, spine=replace(CAIMAN.tables.spine, yaw_servo=replace(CAIMAN.spine.yaw_servo, friction=4.0))
        )
    )
    speed = {}
    for robot in (CAIMAN, rough):
        record = walk(Limp("spine_yaw_1"), robot=robot, beside=beside)
        assert np.all(record.servo_torque.sel(servo="spine_yaw_1").isel(time=slice(1, None)) == 0.0)
        speed[robot] = float(abs(record.servo_velocity.sel(servo="spine_yaw_1")).max())
    assert speed[rough] < 0.5 * speed[CAIMAN]


@BATCHES
@pytest.mark.parametrize("joint", ["LF_yaw", "RH_pitch", "spine_yaw_2"])
@pytest.mark.parametrize("angle", [None, 0.1])
def test_a_locked_servo_does_not_move_beyond_its_compliance(joint, angle, beside):
    at = 1.5
    record = walk(Locked(joint, at=at, angle=angle), beside=beside)
    moved = record.servo_angle.sel(servo=joint)
    held = float(moved.sel(time=at)) if angle is None else angle
    settled = slice(at + 0.3, None)
    off = abs(moved.sel(time=settled) - held)
    servo = CAIMAN.spine.yaw_servo if joint.startswith("spine") else CAIMAN.hind_leg.servo
    torque = abs(record.servo_torque.sel(servo=joint, time=settled))
    # a proportional servo gives way by its torque over kp; the derivative adds what is still moving
    assert float(off.max()) <= float(torque.max()) / servo.kp + 0.01
    assert np.allclose(record.servo_target.sel(servo=joint, time=slice(at, None)), held, atol=1e-12)
    free = walk().servo_angle.sel(servo=joint, time=settled)
    assert float(free.max() - free.min()) > 2 * float(moved.sel(time=settled).max() - moved.sel(time=settled).min())


@BATCHES
def test_a_weak_servo_stays_within_what_is_left_of_its_torque(beside):
    limit = CAIMAN.spine.yaw_servo.torque
    intact = abs(walk().servo_torque.sel(servo="spine_yaw_1")).max()
    weak = abs(walk(Weak("spine_yaw_1", fraction=0.2), beside=beside).servo_torque.sel(servo="spine_yaw_1")).max()
    assert float(intact) > 0.2 * limit
    assert float(weak) == pytest.approx(0.2 * limit, rel=1e-9)


@BATCHES
def test_a_servo_weakened_to_nothing_gives_no_torque(beside):
    record = walk(Weak("LF_pitch", fraction=0.0), beside=beside, duration=1.5)
    assert np.all(record.servo_torque.sel(servo="LF_pitch").isel(time=slice(1, None)) == 0.0)


@BATCHES
@pytest.mark.parametrize("fault", [Limp, Locked, Weak], ids=lambda fault: fault.__name__)
def test_until_a_fault_nothing_differs_and_from_then_on_it_does(fault, beside):
    intact, broken = walk(duration=4.5), walk(fault("LF_yaw", at=4.0), duration=4.5, beside=beside)
    if fault is Weak:
        broken = walk(Weak("spine_yaw_1", fraction=0.1, at=4.0), duration=4.5, beside=beside)
    assert same(intact.sel(time=slice(None, 3.999)), broken.sel(time=slice(None, 3.999)))
    assert not np.array_equal(intact.joint_angle.sel(time=4.5), broken.joint_angle.sel(time=4.5))


@BATCHES
def test_a_fault_between_two_control_periods_begins_with_the_next(beside):
    record = walk(Limp("LF_pitch", at=1.004), duration=1.2, beside=beside)
    torque = record.servo_torque.sel(servo="LF_pitch")
    assert np.all(torque.sel(time=slice(0.5, 1.0101)) != 0.0)
    assert np.all(torque.sel(time=slice(1.0199, None)) == 0.0)


@BATCHES
def test_a_fault_of_no_severity_does_not_differ_from_intact(beside):
    assert same(walk(), walk(Weak("LF_yaw", fraction=1.0), Weak("spine_yaw_1", fraction=1.0), beside=beside))


def test_a_fault_of_one_run_leaves_its_neighbours_alone():
    runs = [Run(robot=CAIMAN, gait=CRAWL, faults=f) for f in ((), (Limp("LF_yaw"),), (), (Weak("LH_yaw", 0.1),))]
    record = simulate(runs, duration=2.0, timestep=0.005)
    alone = walk(duration=2.0)
    assert same(record.isel(run=0), alone)
    assert same(record.isel(run=2), alone)


def test_several_faults_at_once_add_up():
    record = walk(
        Limp("LF_yaw"), Locked("tail_pitch", angle=0.3), Weak("LH_knee", fraction=0.0), Limp("RH_yaw", at=1.5)
    )
    torque = record.servo_torque
    assert np.all(torque.sel(servo=["LF_yaw", "LH_knee"]).isel(time=slice(1, None)) == 0.0)
    assert np.all(record.servo_target.sel(servo="tail_pitch") == 0.3)
    assert float(abs(torque.sel(servo="RH_yaw", time=slice(0, 1.499))).max()) > 0
    assert np.all(torque.sel(servo="RH_yaw", time=slice(1.52, None)) == 0.0)


@pytest.mark.parametrize("fault", [Limp, lambda joint: Locked(joint, angle=0.2)], ids=["limp", "locked"])
@pytest.mark.parametrize(("left", "right"), [("LF_yaw", "RF_yaw"), ("LH_pitch", "RH_pitch")])
def test_mirrored_faults_mirror_the_track(fault, left, right):
    one = walk(fault(left), duration=4.0)
    other = walk(fault(right), gait=CRAWL.mirrored(), duration=4.0)
    mirror = np.array([1.0, -1.0, 1.0])
    # rounding grows at every contact, so the two agree to micrometres and not to the byte
    assert np.allclose(one.centre_of_mass, other.centre_of_mass * mirror, atol=1e-5)
    assert float(abs(displacement(one).sel(xyz="y"))) > 1e-3


@dataclass(frozen=True)
class Listening:
    """Open loop, but it listens and keeps what it heard."""

    heard: tuple[list, ...] = ([],)

    feels = True

    @staticmethod
    def start(runs, period):
        table, heard = (
            OpenLoop.start(runs._replace(controls=(OpenLoop(),) * len(runs.robots)), period),
            runs.controls[0].heard[0],
        )

        class Machine:
            def rest(self):
                return table.rest()

            def command(self, tick, sensed):
                heard.append({name: getattr(sensed, name).copy() for name in SENSORS})
                return Command(*table.command(tick, sensed))

        return Machine()

    def __hash__(self):
        return 0


def test_deaf_sensors_read_zero_from_then_on_and_the_others_are_heard():
    control = Listening(([],))
    faults = (Deaf("foot_pressure", at=0.5), Deaf("orientation", at=0.8))
    runs = [Run(robot=CAIMAN, gait=CRAWL, control=control, faults=f) for f in (faults, ())]
    record = simulate(runs, duration=1.2, timestep=0.005)
    (heard,) = control.heard
    feet = np.array([each["foot_pressure"] for each in heard])  # (tick, run, leg)
    facing = np.array([each["orientation"] for each in heard])
    assert np.all(feet[50:, 0] == 0.0)
    assert np.all(feet[20:50, 0].sum(axis=-1) > 1.0)
    assert np.all(feet[20:, 1].sum(axis=-1) > 1.0)
    assert np.all(facing[80:, 0] == (1.0, 0.0, 0.0, 0.0))
    assert np.allclose(np.linalg.norm(facing, axis=-1), 1.0)
    for name in set(SENSORS) - {"foot_pressure", "orientation"}:
        assert np.array_equal(*(np.array([each[name][run] for each in heard]) for run in (0, 1)))
    # the record tells what happened, not what was heard
    assert same(record.isel(run=0), record.isel(run=1).assign_coords(run=0))


def test_a_robot_that_does_not_listen_does_not_mind_deafness():
    assert same(walk(duration=1.5), walk(Deaf("orientation"), duration=1.5))


@pytest.mark.parametrize(
    ("faults", "error", "words"),
    [
        ((Limp("LF_elbow"),), UnknownName, ["LF_elbow", *servo_names()]),
        ((Locked("LF"),), UnknownName, servo_names()),
        ((Deaf("nose"),), UnknownName, ["sensor", *SENSORS]),
        ((Limp("LF_yaw", at=3.0),), InvalidDesign, ["LF_yaw", "3.0 s", "lasts"]),
        ((Limp("LF_yaw", at=-0.1),), InvalidDesign, ["-0.1 s"]),
        ((Limp("LF_yaw", at=float("nan")),), InvalidDesign, ["nan"]),
        ((Weak("LF_yaw", fraction=1.2),), InvalidDesign, ["1.2", "0 to 1"]),
        ((Locked("LF_pitch", angle=3.0),), OutsideLimits, ["LF_pitch", "-1.309", "2.618"]),
        ((Locked("tail_cable", angle=float("nan")),), OutsideLimits, ["nan"]),
        ((Limp("LF_yaw"), Locked("LF_yaw")), InvalidDesign, ["contradict", "Limp", "Locked"]),
        ((Limp("LF_yaw"), Limp("LF_yaw", at=1.0)), InvalidDesign, ["contradict"]),
        ((Deaf("foot_pressure"), Deaf("foot_pressure")), InvalidDesign, ["contradict"]),
    ],
)
def test_faults_that_cannot_happen_are_refused_in_one_sentence(faults, error, words):
    with pytest.raises(error) as caught:
        walk(*faults)
    text = str(caught.value)
    assert all(word in text for word in words)
    assert "\n" not in text


def test_robots_with_and_without_integral_action_do_not_share_a_batch():
    yaw = replace(CAIMAN.spine.yaw_servo, ki=5.0)
    integrating = crocodile(replace(CAIMAN.tables, spine=replace(CAIMAN.tables.spine, yaw_servo=yaw)))
    with pytest.raises(InvalidDesign, match="integral action"):
        simulate([Run(robot=CAIMAN, gait=CRAWL), Run(robot=integrating, gait=CRAWL)], duration=0.1)
