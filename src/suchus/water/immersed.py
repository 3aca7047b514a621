"""The robot as a body of the flow solver: a slice through it, as deep as the flow is."""

from functools import lru_cache

import numpy as np

from suchus import flow
from suchus.water.outline import Outline
from suchus.water.undulation import Motion, undulation


def immersed(
    outline: Outline, motion: Motion, *, sway: complex = 0j, turn: complex = 0j, grow: float = 0.0, least: float = 0.0
) -> flow.Midline:
    """Return the robot as a bending body of ``suchus.flow``, head at the origin, tail towards +x, y to its right.

    The midline bends as it is commanded, the six cable joints all alike. On the robot one cable holds their sum alone,
    so that the water's moments, which differ from joint to joint, would make their angles differ: that is left out, as
    is what the passive end gives way, see ``sprung``.

    Seen from above that frame is turned by half a turn, not mirrored: counter-clockwise stays counter-clockwise.

    Args:
        outline: of the robot; stations about one cell apart serve well.
        motion: how it swims.
        sway: harmonic of the snout's displacement to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
        grow: time over which the motion grows from nothing [s].
        least: half-width below which the body is thickened, its ends made round [m].
    """
    bent = undulation(outline, motion).held(sway, turn)
    half_width = outline.silhouette.half_width

    @lru_cache(maxsize=2)  # the flow asks up to ten times for the same two instants of a step
    def spine(time: float) -> flow.Spine:
        curve = bent.curve(np.asarray(time), *_grown(time, grow))
        bare = flow.Spine(**curve._asdict(), half_width=half_width)
        return bare.thickened(least) if least > 0.0 else bare

    return flow.Midline(spine=spine)


def _grown(time: float, over: float) -> tuple[float, float]:
    """Return the share of a motion that has grown, smooth at both ends, and its rate."""
    if over <= 0.0 or time >= over:
        return 1.0, 0.0
    part = time / over
    return part**3 * (10 - 15 * part + 6 * part**2), 30 * part**2 * (1 - part) ** 2 / over
