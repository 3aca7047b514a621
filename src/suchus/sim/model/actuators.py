"""A servo as an actuator of MuJoCo: its loop, and what its motor makes of speed, supply and heat."""

from typing import Any

import mujoco
import numpy as np

from suchus.robot.design import Layout, Robot, Servo, Winding, layout
from suchus.robot.design.body import servos_of
from suchus.robot.design.motor import COPPER, ROOM_TEMPERATURE

SUPPLY = 7
"""Column of ``actuator_gainprm`` in which MuJoCo's dcmotor keeps the greatest voltage of its drive [V]."""
_SLEW_PID, _SLEW_MOTOR = 1, 7
_POSITION_INPUT = 1  # the servo takes an angle; the other inputs of MuJoCo's actuators stay unused


def add_servo(spec: Any, number: int, name: str, servo: Servo, robot_layout: Layout) -> None:
    """Add a servo to a ``mujoco.MjSpec``: MuJoCo's pid, or its dcmotor for a servo with a winding.

    Args:
        spec: the model.
        number: number of the servo in the layout.
        name: name of the servo, and of its joint or cable.
        servo: its design.
        robot_layout: the layout.
    """
    actuator = spec.add_actuator(name=name, group=number)
    if servo.winding is None:
        actuator.set_to_pid(
            kp=servo.kp,
            kv=servo.kd,
            ki=servo.ki if servo.ki > 0 else -1,
            imax=servo.integral_limit / servo.ki if servo.ki > 0 else -1,
            slewmax=servo.speed,
            ctrlspec=_POSITION_INPUT,
        )
    else:
        _wind(actuator, servo, servo.winding)
    if number in robot_layout.cables:
        actuator.trntype = mujoco.mjtTrn.mjTRN_TENDON
        actuator.target = name
        actuator.gear[0] = (
            1.0 / robot_layout.cable(number).pulley
        )  # cable length to angle of the pulley, and its torque to tension
    else:
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        actuator.target = name
    actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
    actuator.forcerange = [-servo.torque, servo.torque]


def _wind(actuator: Any, servo: Servo, winding: Winding) -> None:
    """Make an actuator the motor of a servo, which turns its own gear at the servo's speed without load.

    MuJoCo's motor turns all of its current's power into torque times speed or heat of the winding, and so takes less
    current than one with a real gear. That its heat is right all the same, its thermal resistance is that of the servo
    times the power at standstill over MuJoCo's.
    """
    heat, thermal = winding.heat, [0.0] * 6
    if heat is not None:
        heat_ratio = winding.volts * winding.stall_current / (servo.torque * servo.ideal_speed)
        thermal = [
            heat.resistance * heat_ratio,
            heat.capacity / heat_ratio,
            0.0,
            COPPER,
            ROOM_TEMPERATURE,
            heat.ambient,
        ]
    integral = servo.integral_limit / servo.ki if servo.ki > 0 else 0.0
    actuator.set_to_dcmotor(
        motorconst=[0.0, 0.0],
        resistance=0.0,
        nominal=[winding.volts, servo.torque, servo.ideal_speed],
        controller=[servo.kp, servo.ki, servo.kd, servo.speed, integral, winding.volts],
        thermal=thermal,
        ctrlspec=_POSITION_INPUT,
    )


def slew_column(model: Any, servo: str) -> int:
    """Return the column of ``actuator_dynprm`` in which MuJoCo keeps the slew limit of a servo."""
    is_motor = int(model.actuator(servo).dyntype[0]) == int(mujoco.mjtDyn.mjDYN_DCMOTOR)
    return _SLEW_MOTOR if is_motor else _SLEW_PID


def activations(model: Any, servos: np.ndarray) -> np.ndarray:
    """Return the servos' inner states at rest: slew-limited target first, then the integral, then warming [K]."""
    act = np.zeros(model.na)
    act[model.actuator_actadr] = servos
    return act


def warms(servo: Servo) -> bool:
    """Return whether a servo warms up."""
    return servo.winding is not None and servo.winding.heat is not None


def warming(model: Any, robot: Robot) -> np.ndarray:
    """Return where the servos keep by how much they are warmer than the air, in ``act``; -1 for one that does not."""
    temperature_columns = model.actuator_actadr + model.actuator_actnum - 1
    return np.where([warms(servo) for servo in _servos(robot)], temperature_columns, -1)


def supplies(robot: Robot) -> np.ndarray:
    """Return the supply of each servo; NaN for one without a winding [V]."""
    return np.array([np.nan if servo.winding is None else servo.winding.volts for servo in _servos(robot)])


def ambient(robot: Robot) -> np.ndarray:
    """Return the temperature of the air around each servo; NaN for one that does not warm up [degC]."""
    heats = [servo.winding.heat if servo.winding else None for servo in _servos(robot)]
    return np.array([np.nan if heat is None else heat.ambient for heat in heats])


def _servos(robot: Robot) -> list[Servo]:
    """Return the servos in the order of the layout, which is that of the model's actuators."""
    servos = servos_of(robot)
    return [servos[name] for name in layout(robot).servos]
