"""What the water does to each part of a body that is divided along its midline, and to its joints."""

from collections.abc import Sequence

import numpy as np

from suchus.flow.body import AnyBody
from suchus.flow.momentum import Reaction
from suchus.flow.pose import Pose, cross
from suchus.flow.trunk import Trunk


def columns_of(
    body: AnyBody, acts: Sequence[Reaction], about: tuple[float, ...], pose: Pose, time: float, frame: np.ndarray
) -> list[float]:
    """Return ``record.PART_COLUMNS`` of a body's parts one after the other; nothing of a body of one part.

    Args:
        body: which.
        acts: what the water did to each part, its torque about one point.
        about: that point, in the frame of the grid [m].
        pose: of the body, in the frame of the grid.
        time: end of the step [s].
        frame: mean velocity of the grid [m/s].
    """
    if len(acts) < 2 or not isinstance(body.shape, Trunk):
        return []
    force, torque = (np.array([getattr(act, what) for act in acts]) for what in ("force", "moment"))
    power = np.array([act.power for act in acts]) - force[:, :2] @ frame[:2] - force[:, 2] * frame[2]
    behind, moment = (part[::-1].cumsum(axis=0)[::-1] for part in (force, torque))
    ends = body.shape.at(time, pose, np.array([0.0, *body.shape.cuts])) - np.array(about)
    axis = pose.matrix[:, 2]  # the midline bends about the body's z
    joint = (moment - np.stack(cross(ends.T, behind.T), axis=1)) @ axis
    found: list[float] = np.column_stack([force[:, :2], torque[:, 2], power, joint]).ravel().tolist()
    return found
