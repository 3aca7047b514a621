"""The conditions of the crawl that are compared: each differs from another one in one thing."""

from dataclasses import replace

from suchus.design import AnyRobot, layout
from suchus.gaits.limbs_tail_lifted import LIFTED
from suchus.motion import AnyGait, Gait, straightened

CONDITIONS = ("coordinated", "limbs_only", "limbs_tail_lifted", "tail_still", "spine_only", "tail_drag")
"""With spine and tail; with limbs only, the tail lying still; with limbs only, the tail in the air; with the trunk and
a tail dragged still; with the trunk and the tail in the air; with a straight trunk and a tail that swings."""


def conditions(gait: Gait, control: Gait) -> dict[str, Gait]:
    """Return the gait of each of ``CONDITIONS``, in their order.

    Args:
        gait: with spine and tail.
        control: with limbs only.
    """
    return {
        "coordinated": gait,
        "limbs_only": control,
        "limbs_tail_lifted": replace(control, name="limbs_tail_lifted", tail_pitch=LIFTED),
        "tail_still": replace(gait, name="tail_still", tail_bend=0.0),
        "spine_only": replace(gait, name="spine_only", tail_bend=0.0, tail_pitch=LIFTED),
        "tail_drag": replace(gait, name="tail_drag", trunk_bend=0.0),
    }


def conditions_of(robot: AnyRobot, gait: AnyGait, control: AnyGait) -> dict[str, AnyGait]:
    """Return the gaits of those of ``CONDITIONS`` that a robot's parts make possible, in their order.

    Without a servo that pitches the tail nothing lifts it; without one that bends the tail, or the trunk, that part
    has no swing to be taken away.

    Args:
        robot: the design.
        gait: with all of the axis.
        control: with limbs only.
    """
    place = layout(robot)
    if isinstance(gait, Gait) and isinstance(control, Gait) and place.tail_pitch:
        return dict(conditions(gait, control))
    behind = {*place.tail_yaw, *place.tail_pitch, *place.cables}
    ahead = set(place.axial_yaw) - behind
    found = {"coordinated": gait}
    if behind or ahead:
        found["limbs_only"] = control
    if behind and ahead:
        found["tail_still"] = straightened(robot, gait, trunk=False, name="tail_still")
        found["tail_drag"] = straightened(robot, gait, tail=False, name="tail_drag")
    return found
