"""The conditions of the crawl that are compared: each differs from another one in one thing."""

from suchus.design import Robot, layout
from suchus.gaits.limbs_tail_lifted import LIFTED
from suchus.motion import Gait, divided

CONDITIONS = ("coordinated", "limbs_only", "limbs_tail_lifted", "tail_still", "spine_only", "tail_drag")
"""With spine and tail; with limbs only, the tail lying still; with limbs only, the tail in the air; with the trunk and
a tail dragged still; with the trunk and the tail in the air; with a straight trunk and a tail that swings."""


def conditions_of(robot: Robot, gait: Gait, control: Gait) -> dict[str, Gait]:
    """Return the gaits of those of ``CONDITIONS`` that a robot's parts make possible, in their order.

    Without a servo that pitches the tail nothing lifts it; without one that bends the tail, or the trunk, that part
    has no swing to be taken away.

    Args:
        robot: the design.
        gait: with all of the axis.
        control: with limbs only.
    """
    place, gait = layout(robot), divided(robot, gait)
    behind = {*place.tail_yaw, *place.tail_pitch, *place.cables}
    ahead = set(place.axial_yaw) - behind
    lifts = place.tail_pitch and gait.has("steering")
    found = {"coordinated": gait}
    if behind or ahead:
        found["limbs_only"] = control
        if lifts:
            found["limbs_tail_lifted"] = control.lifted(LIFTED, name="limbs_tail_lifted")
    if behind and ahead:
        still = gait.without("tail", name="tail_still")
        found["tail_still"] = still
        if lifts:
            found["spine_only"] = still.lifted(LIFTED, name="spine_only")
        found["tail_drag"] = gait.straightened("neck", "trunk", name="tail_drag")
    return found
