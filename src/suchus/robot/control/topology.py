"""Which sensors and shared variables each controller reads and writes, observed while the code runs."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from suchus.robot.control.coordinated import Coordinated
from suchus.robot.control.heading import Heading, HeadingRule
from suchus.robot.control.limbs import Limbs
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.shared import OWNERS, Shared, initial_shared
from suchus.robot.control.spine import SpineController
from suchus.robot.control.tail import TailController
from suchus.robot.design import Layout, Robot, layout
from suchus.robot.design.scale import control_period
from suchus.robot.motion import Batch, Gait


class ControlPart(NamedTuple):
    """One controller of the topology."""

    name: str
    """``limbs``, ``spine``, ``tail`` or ``heading``."""
    feels: frozenset[str]
    """Sensors that it read: fields of ``Sensed``, the time aside."""
    hears: frozenset[str]
    """Shared variables that it read, its own ones included."""
    writes: frozenset[str]
    """Shared variables that it wrote."""


def topology(robot: Robot, gait: Gait, control: Coordinated | None = None) -> tuple[ControlPart, ...]:
    """Return the sensors and shared variables that each controller reads and writes, in the order of action.

    Args:
        robot: the design.
        gait: which it walks.
        control: the rules; by default those of ``Coordinated`` that the robot's parts make possible, and the heading
            loop.

    Raises:
        OutsideLimits: the gait has measured curves.
    """
    gait.needs_steering("the closed loop")
    if control is None:
        control = Coordinated(heading=HeadingRule()).suited(robot, gait)
    place, period = layout(robot), control_period(robot)
    robots, gaits, batch, walk_clock = [robot], [gait], Batch([robot], [gait]), np.zeros(1)
    limbs = Limbs([control.limbs], robots, gaits, np.zeros((1, len(place.limbs))), period)
    spine = SpineController([control.spine], robots, period)
    tail = TailController([control.tail], robots, gaits, period)
    clock, targets = np.array([gait.limb_phases]), np.zeros((1, len(place.servos)))

    def heading(_: Any, sensed: Any) -> None:
        if control.heading is not None:
            Heading([control.heading], robots, gaits, period).step(sensed, walking=True)

    def of_spine(shared: Any, sensed: Any) -> Shared:
        spine.correct(targets.copy(), np.zeros(1), sensed)
        return spine.step(shared, batch, walk_clock)

    def of_tail(shared: Any, sensed: Any) -> Shared:
        tail.correct(targets.copy(), sensed)
        return tail.step(shared, batch, walk_clock)

    steps: dict[str, Callable[[Any, Any], Shared | None]] = {
        "limbs": lambda shared, sensed: limbs.step(shared, sensed, clock, walking=True),
        "spine": of_spine,
        "tail": of_tail,
        "heading": heading,
    }
    return tuple(_observe_step(name, step, place) for name, step in steps.items())


def _observe_step(name: str, run_step: Callable[[Any, Any], Shared | None], robot_layout: Layout) -> ControlPart:
    """Return the sensors and shared variables that one step of a controller reads and replaces.

    The step runs once, for a robot at rest: branches that are not taken then, and arrays that are changed in place, are
    not seen.

    Args:
        name: name of the controller.
        run_step: one step of the controller, a function of the shared variables and the readings.
        robot_layout: layout of the robot.
    """
    shared, read_names, sensed_names = initial_shared(1, len(robot_layout.limbs)), set[str](), set[str]()
    new_shared = run_step(_watching(shared, read_names), _watching(_readings_at_rest(robot_layout), sensed_names))
    replaced_names = (
        []
        if new_shared is None
        else [variable for variable in OWNERS if getattr(new_shared, variable) is not getattr(shared, variable)]
    )
    return ControlPart(
        name, frozenset(sensed_names) - {"time"}, frozenset(read_names) & frozenset(OWNERS), frozenset(replaced_names)
    )


def _watching(value: object, read_names: set[str]) -> Any:
    """Return a proxy of a value, of the same type, that records which attributes are read.

    Args:
        value: the value.
        read_names: set to which the names are added.
    """

    def noted(_: object, name: str) -> Any:
        read_names.add(name)
        return getattr(value, name)

    return object.__new__(type("Watched", (type(value),), {"__getattribute__": noted}))


def _readings_at_rest(robot_layout: Layout) -> Sensed:
    """Return the readings of one robot at rest."""
    servo_zeros, zeros = np.zeros((1, len(robot_layout.servos))), np.zeros(1)
    return Sensed(
        time=1.0,
        servo_position=servo_zeros,
        servo_velocity=servo_zeros,
        servo_torque=servo_zeros,
        foot_pressure=np.ones((1, len(robot_layout.limbs))),
        belly_pressure=np.zeros((1, len(robot_layout.trunk))),
        tail_pressure=zeros,
        orientation=np.array([[1.0, 0.0, 0.0, 0.0]]),
        angular_velocity=np.zeros((1, 3)),
        acceleration=np.zeros((1, 3)),
    )
