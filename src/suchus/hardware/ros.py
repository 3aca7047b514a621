"""A robot for ROS 2: its URDF with a ``ros2_control`` block, and its controllers."""

from collections.abc import Sequence
from xml.etree import ElementTree

from suchus.core.errors import UnsuitedRobot
from suchus.robot.design import Robot, layout
from suchus.sim.model.export.urdf import urdf

PLUGIN = "dynamixel_hardware_interface/DynamixelHardware"
"""The plugin that ROBOTIS writes for its servos; for others its name is to be replaced."""
RATE = 100
"""Rate of the controllers [Hz]."""
_STATES = ("Present Position", "Present Velocity", "Present Current", "Hardware Error Status")
NOTE = (
    "A cable is a joint of its own here, that of its pulley ({cables}), on a link without mass: a driver has one "
    "joint for each servo. Mimic joints do not do: the plugin counts every joint in the ros2_control block against its "
    "number of joints, mimics too, and hinges that follow a pulley by springs keep no fixed ratio under load. The "
    "hinges that the cable bends ({hinges}) are in the URDF and not in the block; publish their states from that of "
    "the pulley, each the pulley's bend over their number, as suchus export-commands writes them."
)


def unfit_reason(robot: Robot) -> str:
    """Return a sentence why a robot cannot be described for ROS 2; empty if it can."""
    linear_cables = [cable.name for cable in robot.cables if cable.linear is not None]
    if not linear_cables:
        return ""
    return (
        f"Robot {robot.name!r} moves {', '.join(linear_cables)} by a linear actuator, which has no place among the "
        "servos of "
        f"{PLUGIN}: take the plain URDF (suchus export), or let a servo pull the cords by a pulley (tail.drive = "
        "'cable')."
    )


def ros_urdf(robot: Robot, *, numbers: Sequence[int] = (), baud: int = 1_000_000, port: str = "/dev/ttyUSB0") -> str:
    """Return a robot as URDF with a joint for each cable's pulley, and a ``ros2_control`` block for its servos.

    Args:
        robot: the design.
        numbers: ids of the servos on their bus, in the order of the layout; 1 and so on if empty.
        baud: baud rate of the bus [1/s].
        port: port of the bus.

    Raises:
        UnsuitedRobot: a linear actuator moves a cable.
    """
    if reason := unfit_reason(robot):
        raise UnsuitedRobot(reason)
    place = layout(robot)
    root = ElementTree.fromstring(urdf(robot))
    for i in place.cables:
        cable = place.cable(i)
        seat = next(body for body in place.bodies if any(name == cable.hinges[0] for _, name, _ in body.hinges))
        parent = place.bodies[seat.parent].name if seat.parent >= 0 else place.robot.root
        ElementTree.SubElement(root, "link", name=f"{cable.name}_pulley")
        joint = ElementTree.SubElement(root, "joint", name=cable.name, type="revolute")
        ElementTree.SubElement(joint, "parent", link=parent)
        ElementTree.SubElement(joint, "child", link=f"{cable.name}_pulley")
        ElementTree.SubElement(joint, "origin", xyz="0 0 0", rpy="0 0 0")
        ElementTree.SubElement(joint, "axis", xyz="0 0 1")
        reach = cable.bend_limit * cable.cord_spacing / 2 / cable.pulley
        limits = {"lower": -reach, "upper": reach, "effort": cable.turning.torque, "velocity": cable.turning.speed}
        ElementTree.SubElement(joint, "limit", {key: repr(float(value)) for key, value in limits.items()})
    root.append(_control(robot, numbers or range(1, len(place.servos) + 1), baud, port))
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _control(robot: Robot, numbers: Sequence[int], baud: int, port: str) -> ElementTree.Element:
    """Return the ``ros2_control`` block of a robot's servos.

    Args:
        robot: the design.
        numbers: ids of the servos on their bus, in the order of the layout.
        baud: bit rate of the bus [1/s].
        port: device name of the bus.
    """
    names = layout(robot).servos
    count = len(names)
    block = ElementTree.Element("ros2_control", name=f"{robot.name}_servos", type="system")
    hardware = ElementTree.SubElement(block, "hardware")
    ElementTree.SubElement(hardware, "plugin").text = PLUGIN
    unit = " ".join("1" if i == j else "0" for i in range(count) for j in range(count))
    for name, value in (
        ("port_name", port),
        ("baud_rate", str(baud)),
        ("number_of_joints", str(count)),
        ("number_of_transmissions", str(count)),
        ("transmission_to_joint_matrix", unit),
        ("joint_to_transmission_matrix", unit),
        ("dynamixel_model_folder", "/param/dxl_model"),
        ("disable_torque_at_init", "true"),
        ("error_timeout_ms", "500"),
    ):
        ElementTree.SubElement(hardware, "param", name=name).text = value
    for i, name in enumerate(names):
        joint = ElementTree.SubElement(block, "joint", name=name)
        command = ElementTree.SubElement(joint, "command_interface", name="position")
        limits = _range(robot, i)
        if limits is not None:
            for word, limit in zip(("min", "max"), limits, strict=True):
                ElementTree.SubElement(command, "param", name=word).text = repr(float(limit))
        for state in ("position", "velocity", "effort"):
            ElementTree.SubElement(joint, "state_interface", name=state)
    for number in numbers:
        gpio = ElementTree.SubElement(block, "gpio", name=f"dxl{number}")
        ElementTree.SubElement(gpio, "param", name="type").text = "dxl"
        ElementTree.SubElement(gpio, "param", name="ID").text = str(number)
        ElementTree.SubElement(gpio, "command_interface", name="Goal Position")
        for word in _STATES:
            ElementTree.SubElement(gpio, "state_interface", name=word)
    return block


def _range(robot: Robot, servo: int) -> tuple[float, float] | None:
    """Return the limits of a servo's angle; None for a crank [rad]."""
    place = layout(robot)
    if servo in place.cables:
        cable = place.cable(servo)
        reach = cable.bend_limit * cable.cord_spacing / 2 / cable.pulley
        return -reach, reach
    name = place.servos[servo]
    return next(h.range for body in place.bodies for h, full, _ in body.hinges if full == name)


def controllers(robot: Robot) -> str:
    """Return the YAML of the controller manager: states of all joints, and trajectories for all servos."""
    names = "".join(f"      - {name}\n" for name in layout(robot).servos)
    return (
        "controller_manager:\n"
        "  ros__parameters:\n"
        f"    update_rate: {RATE}\n"
        "    joint_state_broadcaster:\n"
        "      type: joint_state_broadcaster/JointStateBroadcaster\n"
        "    joint_trajectory_controller:\n"
        "      type: joint_trajectory_controller/JointTrajectoryController\n"
        "joint_trajectory_controller:\n"
        "  ros__parameters:\n"
        f"    joints:\n{names}"
        "    command_interfaces:\n"
        "      - position\n"
        "    state_interfaces:\n"
        "      - position\n"
        "      - velocity\n"
    )


def note(robot: Robot) -> str:
    """Return why the URDF has a joint for each cable; empty for a robot without one."""
    cables = layout(robot).robot.cables
    if not cables:
        return ""
    hinges = ", ".join(hinge for cable in cables for hinge in cable.hinges)
    return NOTE.format(cables=", ".join(cable.name for cable in cables), hinges=hinges)
