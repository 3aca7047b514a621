"""What a format leaves out, described with the numbers of the robot that is written."""

from collections.abc import Sequence

from suchus.design import Robot, Spring, layout

_CABLES, _SPRINGS = "The cable.", "Springs"
_BESIDE = "{name} {stiffness:g} N m/rad"


def filled(texts: Sequence[str], robot: Robot, **own: object) -> tuple[str, ...]:
    """Return sentences with the robot's numbers in their braces; those about cables or springs only if it has some.

    Args:
        texts: what a format leaves out, and what to do about it.
        robot: the design.
        own: further values, of the format.
    """
    place, contact = layout(robot), robot.contact
    cables = place.robot.cables
    springs = [
        _BESIDE.format(name=name, stiffness=hinge.drive.stiffness)
        for body in place.bodies
        for hinge, name, _ in body.hinges
        if isinstance(hinge.drive, Spring)
    ]
    values = {
        "cables": cables[0].joints if cables else 0,
        "first": cables[0].hinges[0] if cables else "",
        "last": cables[0].hinges[-1] if cables else "",
        "springs": ", ".join(springs),
        "foot": contact.foot_friction,
        "skin": contact.skin_friction,
        "root": place.robot.root,
    }
    kept = [
        text
        for text in texts
        if (cables or not text.startswith(_CABLES)) and (springs or not text.startswith(_SPRINGS))
    ]
    return tuple(text.format(**values, **own) for text in kept)
