"""The conditions of the crawl that are compared: each differs from another one in one thing."""

from dataclasses import replace

from suchus.gaits.limbs_tail_lifted import LIFTED
from suchus.motion import Gait

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
