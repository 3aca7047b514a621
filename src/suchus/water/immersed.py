"""The robot as a body of the flow solver: a slice through it, as deep as the flow is."""

import numpy as np

from suchus import flow
from suchus.motion import Swim, bends
from suchus.water.outline import Base, Outline


def immersed(
    outline: Outline, motion: Swim, *, sway: complex = 0j, turn: complex = 0j, grow: float = 0.0
) -> flow.Midline:
    """Return the robot as a bending body of ``suchus.flow``, head at the origin, tail towards +x, y to its right.

    Seen from above that frame is turned by half a turn, not mirrored: counter-clockwise stays counter-clockwise.

    Args:
        outline: of the robot; stations about one cell apart serve well.
        motion: how it swims.
        sway: harmonic of the snout's way to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
        grow: time over which the motion grows from nothing [s].
    """
    rate = 2j * np.pi * motion.frequency
    half_width = outline.silhouette.half_width

    def spine(time: float) -> flow.Spine:
        share, share_rate = _grown(time, grow)
        now = bends(motion, np.asarray(time))
        at, to = sway * np.exp(rate * time), turn * np.exp(rate * time)
        values = (
            0.0,
            share * at.real,
            share * to.real,
            0.0,
            (share * rate * at + share_rate * at).real,
            (share * rate * to + share_rate * to).real,
        )
        base = Base._make(np.asarray(value) for value in values)
        scaled = type(now)(
            share * now.yaw,
            share * now.tail,
            share * now.yaw_rate + share_rate * now.yaw,
            share * now.tail_rate + share_rate * now.tail,
        )
        curve = outline.curve(scaled, base)
        return flow.Spine(**curve._asdict(), half_width=half_width)

    return flow.Midline(spine=spine)


def _grown(time: float, over: float) -> tuple[float, float]:
    """Return the share of a motion that has grown, smooth at both ends, and its rate."""
    if over <= 0.0 or time >= over:
        return 1.0, 0.0
    part = time / over
    return part**3 * (10 - 15 * part + 6 * part**2), 30 * part**2 * (1 - part) ** 2 / over
