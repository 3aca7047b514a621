"""What each fault does, against answers known exactly: joints of a robot that floats or lies still."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from suchus.robot.control import Command
from suchus.robot.design import GRAVITY, servo_names
from suchus.robot.gaits import GAITS
from suchus.robot.motion import movement
from suchus.robot.robots import ROBOTS
from suchus.sim.land import VACUUM, Backlash, Ground, LostFoot, Offset, Run, Slow, simulate

CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]
LYING = tuple(
    movement(CAIMAN, CRAWL).targets(np.full((1, 4), 0.8), movement(CAIMAN, CRAWL).axis_phase(np.full((1, 4), 0.8)))[0]
)  # all feet on the ground
FEET = ["LF", "RF", "LH", "RH"]


@dataclass(frozen=True)
class Turn:
    """Hold a posture but for one servo, which is commanded other angles."""

    joint: str
    angles: tuple[float, ...]  # off the posture, per control period; the last one stays
    heard: tuple[list, ...] = ([],)
    feels = False

    @staticmethod
    def start(runs, period):
        outer, count = runs.controls[0], len(runs.robots)
        column, rest = servo_names().index(outer.joint), np.tile(LYING, (count, 1))

        class Machine:
            def rest(self):
                return rest

            def command(self, tick, sensed):
                targets = rest.copy()
                targets[:, column] += outer.angles[min(tick, len(outer.angles) - 1)]
                if sensed is not None:
                    outer.heard[0].append(sensed.servo_position.copy())
                return Command(targets, np.zeros((count, 4)))

        return Machine()

    def __hash__(self):
        return hash((self.joint, self.angles))


@dataclass(frozen=True)
class Felt(Turn):
    """The same, listening."""

    feels = True

    __hash__ = Turn.__hash__


def turned(joint, angles, *faults, duration=1.0, afloat=VACUUM, control=Turn):
    run = Run(robot=CAIMAN, gait=CRAWL, control=control(joint, tuple(angles)), faults=faults, afloat=afloat)
    return simulate([run], duration=duration, timestep=0.002).isel(run=0)


def of(record, joint):
    return record.servo_angle.sel(servo=joint).values, record.servo_torque.sel(servo=joint).values


@pytest.mark.parametrize("joint", ["LF_yaw", "RH_knee", "spine_yaw_2", "tail_pitch"])
def test_a_slow_servo_turns_at_its_speed_and_arrives_when_that_says(joint):
    step, speed = 0.3, 0.5
    record = turned(joint, [step], Slow(joint, speed=speed))
    angle, _ = of(record, joint)
    moving = record.servo_velocity.sel(servo=joint, time=slice(0.2, 0.55)).values
    assert moving == pytest.approx(speed, rel=0.02)
    assert abs(angle[-1] - angle[0] - step) < 0.01  # friction over kp
    intact, _ = of(turned(joint, [step]), joint)
    assert abs(intact[20] - intact[0]) > 0.9 * step  # 0.2 s are enough for it
    assert abs(angle[20] - angle[0]) < 0.4 * step


def test_a_slow_joint_is_turned_faster_by_what_is_stronger():
    """The limit is on what the servo aims at: held still, it exerts its torque all the same."""
    _, torque = of(turned("LF_pitch", [0.0], Slow("LF_pitch", speed=0.01), afloat=None, duration=0.3), "LF_pitch")
    _, intact = of(turned("LF_pitch", [0.0], afloat=None, duration=0.3), "LF_pitch")
    assert np.array_equal(torque, intact)


@pytest.mark.parametrize("joint", ["LF_yaw", "tail_cable"])
@pytest.mark.parametrize("angle", [0.1, -0.25])
def test_an_offset_joint_goes_where_a_command_off_by_as_much_sends_it_to_the_byte(joint, angle):
    swing = 0.1 * np.sin(0.2 * np.arange(60))
    broken = turned(joint, swing, Offset(joint, angle, at=0.2), duration=0.6, afloat=None)
    late = np.arange(60) >= 20
    column = servo_names().index(joint)
    # added in the same order, so that it rounds alike
    sent = np.where(late, ((LYING[column] + swing) + angle) - LYING[column], swing)
    asked = turned(joint, sent, duration=0.6, afloat=None)
    np.testing.assert_allclose(broken.servo_target, asked.servo_target, rtol=0, atol=1e-15)
    np.testing.assert_allclose(broken.joint_angle, asked.joint_angle, rtol=0, atol=1e-9)


def test_an_offset_servo_feels_its_own_angle():
    heard: list = []
    control = Felt("LF_yaw", (0.0,), (heard,))
    faults = (Offset("LF_yaw", 0.2, at=0.1),)
    record = simulate(
        [Run(robot=CAIMAN, gait=CRAWL, control=control, faults=faults)], duration=0.4, timestep=0.002
    ).isel(run=0)
    off = np.array(heard)[:, 0] - record.servo_angle.values
    yaw = servo_names().index("LF_yaw")
    assert np.all(off[:10] == 0.0)
    np.testing.assert_allclose(off[10:, yaw], -0.2, atol=1e-15)
    assert np.all(np.delete(off, yaw, axis=1) == 0.0)


def test_a_gear_with_play_does_not_move_within_the_gap_and_has_no_torque_there():
    within = 0.049 * np.sin(0.3 * np.arange(80))
    angle, torque = of(turned("LF_yaw", within, Backlash("LF_yaw", gap=0.1), duration=0.8), "LF_yaw")
    assert np.all(torque[1:] == 0.0)
    assert np.ptp(angle) < 1e-9
    moved, _ = of(turned("LF_yaw", within, duration=0.8), "LF_yaw")
    assert np.ptp(moved) > 0.06


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("gap", [0.05, 0.2])
def test_a_gear_with_play_stops_half_a_gap_short_of_what_is_commanded(gap, way):
    ramp = way * np.minimum(0.001 * np.arange(420), 0.4)  # so slow that friction stops it within a milliradian
    angle, _ = of(turned("RF_yaw", ramp, Backlash("RF_yaw", gap=gap), duration=4.2), "RF_yaw")
    servo = CAIMAN.front_leg.servo
    assert abs(angle[-1] - angle[0] - way * (0.4 - gap / 2)) < servo.friction / servo.kp + 1e-3


@pytest.mark.parametrize("gap", [0.05, 0.2])
def test_a_loaded_gear_with_play_hangs_at_the_end_of_its_gap_with_the_torque_of_a_dead_band(gap):
    lifted, servo = -0.6, CAIMAN.tail.pitch_servo
    faults = Backlash("tail_pitch", gap=gap)
    angle, torque = of(turned("tail_pitch", [lifted], faults, duration=3.0, afloat=None), "tail_pitch")
    off = LYING[servo_names().index("tail_pitch")] + lifted - angle[-1]
    assert abs(torque[-1]) > 0.5  # it carries the tail
    assert abs(off) > gap / 2
    assert torque[-1] == pytest.approx(servo.kp * np.sign(off) * (abs(off) - gap / 2), abs=0.01)


def test_a_lifted_tail_falls_through_the_gap_without_torque():
    record = turned("tail_pitch", [-0.6], Backlash("tail_pitch", gap=0.4, at=1.0), duration=1.05, afloat=None)
    angle, torque = of(record, "tail_pitch")
    assert abs(torque[100]) > 0.5  # until now it was carried
    assert np.all(torque[101:] == 0.0)
    assert 0.01 < angle[-1] - angle[100] < 0.2


def test_a_leg_without_foot_stands_on_its_shank_and_its_sensor_reads_nothing():
    record = turned("LH_yaw", [0.0], LostFoot("LF", at=0.5), duration=2.0, afloat=None)
    force = record.foot_force.sel(xyz="z")
    after = slice(0.511, None)
    assert np.all(force.sel(leg="LF", time=after) == 0.0)
    assert float(force.sel(leg="LF", time=slice(0.4, 0.5)).min()) > 1.0
    assert float(force.sel(leg=["RF", "LH", "RH"], time=2.0).min()) > 0.0
    height = record.foot_position.sel(xyz="z", leg="LF").values
    leg = CAIMAN.front_leg
    assert height[45] == pytest.approx(leg.foot_radius, abs=1e-3)
    assert height[-1] == pytest.approx(0.8 * leg.radius, abs=1e-3)
    felt = force.sum("leg") + record.tail_force.sel(xyz="z") + record.belly_force.sel(xyz="z").sum("segment")
    weight = CAIMAN.mass * GRAVITY
    assert float(felt.sel(time=0.5)) == pytest.approx(weight, rel=0.02)
    assert float(felt.sel(time=2.0)) < 0.99 * weight  # the rest stands on the bare shank, which has no sensor


def test_a_bare_shank_slides_where_a_foot_holds():
    """The friction is that of skin, not that of the sole."""
    slippery = replace(CAIMAN, contact=replace(CAIMAN.contact, foot_friction=1.0, skin_friction=0.01))
    steep, still = Ground(uphill=0.2), Turn("LF_yaw", (0.0,))
    faults = ((), tuple(LostFoot(leg, at=0.5) for leg in FEET))
    runs = [Run(robot=slippery, gait=CRAWL, control=still, ground=steep, faults=each) for each in faults]
    record = simulate(runs, duration=1.5, timestep=0.005)
    slid = (record.centre_of_mass.sel(time=0.5) - record.centre_of_mass.sel(time=1.5)).sel(xyz="x").values
    assert abs(slid[0]) < 0.02
    assert slid[1] > 0.5 * 0.5 * GRAVITY * np.sin(0.2)  # half of what nothing holds would slide in a second
