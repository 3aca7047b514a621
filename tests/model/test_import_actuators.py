"""What an MJCF says of its actuators is what the draft has: torque as MuJoCo's ``qfrc_actuator``, and gains."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from hinge_trees import quadruped

from suchus.core.errors import UnreadableFile
from suchus.robot import blueprint
from suchus.robot.design import Robot, Servo, Spring
from suchus.robot.design.scale import servo_for
from suchus.robot.robots import ROBOTS
from suchus.sim.land.tolerances import Tolerances, with_masses
from suchus.sim.model import compile_model
from suchus.sim.model.importing import import_robot

FILES = Path(__file__).parent.parent / "data" / "imports"
RANGE = np.radians(60.0)


def eel(actuator="", joint="", beside="", compiler=""):
    """Return an MJCF of a head and two segments; the actuators are those of its first hinge, the other has a motor."""
    rod = '<geom type="capsule" size="0.02" fromto="0 0 0 -0.1 0 0" density="9000"/>'
    return (
        f'<mujoco><compiler angle="degree" {compiler}/>{beside}<worldbody><body name="head"><freejoint/>{rod}'
        f'<body name="b" pos="-0.1 0 0"><joint name="h1" axis="0 0 1" range="-60 60" {joint}/>{rod}'
        f'<body name="c" pos="-0.1 0 0"><joint name="h2" axis="0 0 1" range="-60 60"/>{rod}'
        f'</body></body></body></worldbody><actuator>{actuator}<motor joint="h2" ctrlrange="-3 3"/></actuator></mujoco>'
    )


def read(text, tmp_path):
    file = tmp_path / "it.xml"
    file.write_text(text)
    return import_robot(file, name="it")


def drive_of(draft, file_hinge):
    name = next(match.hinge for match in draft.matches if match.file_hinge == file_hinge)
    return next(hinge.drive for hinge in draft.robot.axis_hinges if hinge.name == name)


def told(draft):
    return " ".join(draft.remarks)


def test_motors_with_a_gear_give_gear_times_control(tmp_path):
    draft = import_robot(FILES / "eel_motor_gear8.xml", name="eel")
    assert [hinge.drive.torque for hinge in draft.robot.axis_hinges] == [8.0] * 4
    assert [hinge.drive.damping for hinge in draft.robot.axis_hinges] == [0.02] * 4
    text = blueprint.render(draft.robot, notes=draft.notes)
    assert sum(line.startswith("torque = 8.0") and "Of the file." in line for line in text.splitlines()) == 4


ACTUATORS = {
    "motor": ('<motor joint="h1" gear="-8" ctrlrange="-1 1"/>', 8.0),
    "one sided": ('<motor joint="h1" gear="8" ctrlrange="-0.25 1"/>', 8.0),
    "bounded force": ('<motor joint="h1" gear="8" ctrlrange="-9 9" forcerange="-2 2"/>', 16.0),
    "force alone": ('<motor joint="h1" gear="8" forcerange="-2 2"/>', 16.0),
    "general": ('<general joint="h1" gear="3" gainprm="5" ctrlrange="-2 2"/>', 30.0),
    "general servo": (
        '<general joint="h1" gainprm="50" biastype="affine" biasprm="0 -50 -4" ctrlrange="-1 1" '
        'forcerange="-7 7"/>', 7.0
    ),
    "position": ('<position joint="h1" kp="77" ctrlrange="-1 1" forcerange="-6 6"/>', 6.0),
    "position by angle": ('<position joint="h1" kp="0.5" ctrlrange="-1 1"/>', 0.5 * (1.0 + RANGE)),
    "position without ranges": ('<position joint="h1" kp="0.5" gear="2"/>', 0.5 * 2 * 2 * 2 * RANGE),
    "filtered": ('<position joint="h1" kp="90" timeconst="0.05" forcerange="-6 6" ctrlrange="-1 1"/>', 6.0),
    "velocity": ('<velocity joint="h1" kv="2" ctrlrange="-3 3"/>', 6.0),
    "integrator": ('<intvelocity joint="h1" kp="4" actrange="-1 1"/>', 4.0 * (1.0 + RANGE)),
    "two": ('<motor joint="h1" ctrlrange="-1 1"/><motor joint="h1" gear="-2" ctrlrange="-1 1"/>', 3.0),
    "in parent": ('<motor jointinparent="h1" gear="2" ctrlrange="-1 1"/>', 2.0),
}  # fmt: skip


@pytest.mark.parametrize("kind", ACTUATORS)
def test_the_torque_is_what_mujoco_gives_at_the_hinge(kind, tmp_path):
    actuator, torque = ACTUATORS[kind]
    draft = read(eel(actuator), tmp_path)
    assert drive_of(draft, "h1").torque == pytest.approx(torque, rel=1e-12)
    assert drive_of(draft, "h2").torque == 3.0
    assert greatest_effort(eel(actuator)) == pytest.approx(torque, rel=1e-9)


def greatest_effort(text):
    """Return the greatest torque at the first hinge over the corners of angles and controls, at standstill."""
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    data, efforts = mujoco.MjData(model), []
    limits = [
        r if limited else (-RANGE * max(gear[0], 1.0), RANGE * max(gear[0], 1.0)) if is_servo else (-1e6, 1e6)
        for r, limited, gear, is_servo in zip(
            model.actuator_ctrlrange, model.actuator_ctrllimited, model.actuator_gear, model.actuator_biasprm[:, 1] < 0,
            strict=True,
        )
    ]  # fmt: skip
    for angle in (-RANGE, 0.0, RANGE):
        for corner in np.ndindex(*[2] * model.nu):
            mujoco.mj_resetData(model, data)
            data.joint("h1").qpos = angle
            data.ctrl = [pair[k] for pair, k in zip(limits, corner, strict=True)]
            if model.na:
                reach = model.actuator_actrange[0] if model.actuator_actlimited[0] else limits[0]
                data.act = reach[corner[0]]
            mujoco.mj_forward(model, data)
            efforts.append(abs(data.joint("h1").qfrc_actuator[0]))
    return max(efforts)


def test_the_joints_limit_of_force_counts(tmp_path):
    draft = read(eel(ACTUATORS["motor"][0], joint='actuatorfrcrange="-5 5"'), tmp_path)
    assert drive_of(draft, "h1").torque == 5.0


def test_classes_give_actuators_their_values(tmp_path):
    classes = '<default><motor gear="4"/><default class="strong"><motor ctrlrange="-2 2"/></default></default>'
    draft = read(eel('<motor joint="h1" class="strong"/>', beside=classes), tmp_path)
    assert drive_of(draft, "h1").torque == 8.0
    assert drive_of(draft, "h2").torque == 12.0


def test_gains_armature_damping_and_friction_are_those_of_the_file(tmp_path):
    joint = 'armature="0.02" damping="0.5" frictionloss="0.3"'
    draft = read(eel('<position joint="h1" kp="77" kv="1.5" forcerange="-9 9"/>', joint), tmp_path)
    servo = drive_of(draft, "h1")
    assert (servo.kp, servo.kd, servo.armature, servo.damping, servo.friction) == (77.0, 1.5, 0.02, 0.5, 0.3)
    text = blueprint.render(draft.robot, notes=draft.notes)
    for line in ("kp = 77.0", "kd = 1.5", "armature = 0.02", "damping = 0.5", "friction = 0.3", "torque = 9.0"):
        assert any(row.startswith(line) and "Of the file." in row for row in text.splitlines())
    assert sum("as all of this servo that has no note" in row for row in text.splitlines()) == 2
    file = blueprint.write(draft.robot, tmp_path / "it.toml")
    assert blueprint.read_design(file, Robot, ROBOTS) == draft.robot
    model = compile_model(draft.robot)
    hinge = next(match.hinge for match in draft.matches if match.file_hinge == "h1")
    dof = int(model.joint(hinge).dofadr[0])
    assert (model.dof_armature[dof], model.dof_frictionloss[dof]) == (0.02, 0.3)


def test_a_gear_turns_the_gains_of_a_servo_to_the_hinge(tmp_path):
    servo = drive_of(read(eel('<position joint="h1" kp="5" kv="0.5" gear="-3" forcerange="-2 2"/>'), tmp_path), "h1")
    assert (servo.kp, servo.kd, servo.torque) == pytest.approx((45.0, 4.5, 6.0))


def test_a_servo_without_a_gain_of_rate_is_damped_by_its_joint_or_as_before(tmp_path):
    position = '<position joint="h1" kp="77" forcerange="-9 9"/>'
    assert drive_of(read(eel(position, 'damping="0.5"'), tmp_path), "h1").kd == 0.0
    undamped = read(eel(position), tmp_path)
    usual = servo_for(undamped.robot.mass, undamped.robot.length)
    assert drive_of(undamped, "h1").kd == pytest.approx(77.0 * usual.kd / usual.kp, rel=0.2)


def test_a_velocity_servo_says_the_speed(tmp_path):
    servo = drive_of(read(eel('<velocity joint="h1" kv="2" ctrlrange="-3 3"/>'), tmp_path), "h1")
    assert servo.speed == 3.0
    plain = drive_of(read(eel('<motor joint="h1" ctrlrange="-3 3"/>'), tmp_path), "h1")
    assert plain.speed != 3.0


def test_what_the_file_does_not_bound_is_said_and_guessed(tmp_path):
    draft = read(eel('<motor joint="h1" gear="8"/>'), tmp_path)
    assert "bounds neither control nor force of the actuators of h1" in told(draft)
    zero = read(
        eel(
            '<motor joint="h1" gear="8" ctrllimited="true" ctrlrange="0 0"/>'.replace(' ctrlrange="0 0"', "")
            .replace('gear="8"', 'gear="0"')
            .replace('ctrllimited="true"', 'ctrlrange="-1 1"')
        ),
        tmp_path,
    )
    assert "h1 give no torque in the file" in told(zero)
    for one in (draft, zero):
        assert drive_of(one, "h1").torque == pytest.approx(servo_for(one.robot.mass, one.robot.length).torque, rel=0.2)
    assert "bounds neither" not in told(read(eel(ACTUATORS["motor"][0]), tmp_path))


def test_muscles_dampers_and_actuators_of_bodies_are_named(tmp_path):
    draft = read(eel('<muscle joint="h1"/>'), tmp_path)
    assert "Muscles are not taken: the draft has servos of their size at h1." in told(draft)
    assert "bounds neither" not in told(draft)
    assert isinstance(drive_of(draft, "h1"), Servo)
    damped = read(eel('<damper joint="h1" kv="2" ctrlrange="0 1"/>'), tmp_path)
    assert "Dampers brake a joint and drive none; those of h1 were not taken." in told(damped)
    assert isinstance(drive_of(damped, "h1"), Spring)
    with pytest.raises(UnreadableFile, match="names joint 'h9', which is not there"):
        read(eel('<motor joint="h9"/>'), tmp_path)


def test_an_armature_that_is_no_part_of_the_body_is_cut_and_said(tmp_path):
    draft = import_robot(FILES / "fourleg.xml", name="it")
    largest = 0.09 * draft.robot.mass * draft.robot.length**2
    armatures = [hinge.servo.armature for girdle in draft.robot.girdles for hinge in girdle.limb.hinges]
    assert armatures == pytest.approx([largest] * 4, rel=1e-5)
    assert "armature of up to 1 kg m2 is more than 0.09 of the robot's mass" in told(draft)
    assert [hinge.servo.torque for girdle in draft.robot.girdles for hinge in girdle.limb.hinges] == [120.0] * 4
    assert "armature of up to" not in told(read(eel(joint='armature="0.02"'), tmp_path))
    lightest = with_masses(draft.robot, [1.0 - Tolerances().mass] * (len(draft.robot.axis) + len(draft.robot.girdles)))
    assert lightest.mass == pytest.approx(0.95 * draft.robot.mass)  # one that is built lighter is no error


def test_a_passive_hinge_keeps_spring_damper_and_rotor_of_the_file(tmp_path):
    spring = drive_of(read(eel(joint='stiffness="2" damping="0.1" armature="0.003"'), tmp_path), "h1")
    assert spring == Spring(stiffness=2.0, damping=0.1, armature=0.003)
    assert drive_of(read(eel(joint='damping="0.1"'), tmp_path), "h1").damping == 0.1


def test_a_urdf_keeps_its_damping_and_dry_friction(tmp_path):
    text = quadruped().replace('velocity="15"/>', 'velocity="15"/><dynamics damping="0.4" friction="0.2"/>')
    servo = read(text, tmp_path).robot.girdles[0].limb.hinges[0].servo
    assert (servo.damping, servo.friction, servo.torque) == (0.4, 0.2, 30.0)
    plain = read(quadruped(), tmp_path).robot.girdles[0].limb.hinges[0].servo
    assert plain.damping != 0.4
