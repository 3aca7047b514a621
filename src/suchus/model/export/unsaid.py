"""What a format leaves out, told with the numbers of the robot that is written."""

from collections.abc import Sequence

from suchus.design import Crocodile, cable_joints, fin_joints


def told(texts: Sequence[str], robot: Crocodile, **own: object) -> tuple[str, ...]:
    """Return sentences with the robot's numbers in their braces.

    Args:
        texts: what a format leaves out, and what to do about it.
        robot: the design.
        own: further values, of the format.
    """
    tail, contact = robot.tail, robot.contact
    values = {
        "cables": tail.joints,
        "first": cable_joints(robot)[0],
        "last": cable_joints(robot)[-1],
        "stiffness": tail.joint_stiffness,
        "fins": ", ".join(fin_joints(robot)),
        "lateral": tail.fin_stiffness_lateral,
        "vertical": tail.fin_stiffness_vertical,
        "foot": contact.foot_friction,
        "skin": contact.skin_friction,
    }
    return tuple(text.format(**values, **own) for text in texts)
