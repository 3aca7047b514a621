"""The robot as a body of the flow solver: a slice through it, as deep as the flow is, or the body itself."""

from functools import lru_cache

import numpy as np

from suchus import flow
from suchus.robot.design import Robot, layout
from suchus.robot.design.profile import stations
from suchus.swimming.water.outline import Outline
from suchus.swimming.water.undulation import Motion, undulation

FIN_STARTS, FIN_RISES = 2 / 3, 0.05
"""Where a raised tail begins, from the snout, and over which length it rises [body length]."""


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
    def spine(time: float) -> flow.MidlineState:
        curve = bent.curve(np.asarray(time), *_grown(time, grow))
        bare = flow.MidlineState(**curve._asdict(), half_width=half_width)
        return bare.thickened(least) if least > 0.0 else bare

    return flow.Midline(spine=spine)


def _grown(time: float, over: float) -> tuple[float, float]:
    """Return the share of a motion that has grown, smooth at both ends, and its rate."""
    if over <= 0.0 or time >= over:
        return 1.0, 0.0
    part = time / over
    return part**3 * (10 - 15 * part + 6 * part**2), 30 * part**2 * (1 - part) ** 2 / over


def half_heights(outline: Outline, tail_height: float = 0.0) -> np.ndarray:
    """Return half of the body's height at the stations, limbs left out, with a raised tail if it is asked for [m].

    Args:
        outline: of the robot.
        tail_height: height that the last third is raised to, where it is not as high [m].
    """
    share = outline.s / outline.robot.length
    rise = np.clip((share - FIN_STARTS) / FIN_RISES, 0.0, 1.0)
    fall = np.clip((1.0 - share) / FIN_RISES, 0.0, 1.0)
    fin = 0.5 * tail_height * np.sqrt(rise * (2.0 - rise) * fall * (2.0 - fall))
    return np.maximum(outline.silhouette.half_height, fin)


def folded(robot: Robot) -> tuple[flow.Capsule, ...]:
    """Return the limbs of a robot, stretched and turned straight back from the hips, which lie in the body's plane.

    Each link is a capsule and each foot a ball, rigid with the body at the hip.
    """
    place, found = layout(robot), []
    names = [segment.name for segment in place.robot.axis]
    for limb in place.limbs:
        girdle = limb.girdle
        at = stations(place.robot)[names.index(girdle.segment)][0]
        at += place.robot.axis[names.index(girdle.segment)].front - girdle.at
        aside, behind = -limb.side * girdle.aside, 0.0  # the body's y points to the robot's right
        for link in girdle.limb.links:
            ends = (behind, aside), (behind + link.length, aside)
            found.append(flow.Capsule(at=at, start=ends[0], end=ends[1], radius=link.radius))
            behind += link.length
        found.append(flow.Capsule(at=at, start=(behind, aside), end=(behind, aside), radius=girdle.limb.foot.radius))
    return tuple(found)


def trunk(
    outline: Outline,
    motion: Motion,
    *,
    grow: float = 0.0,
    tail_height: float = 0.0,
    limbs: bool = False,
    sway: complex = 0j,
    turn: complex = 0j,
) -> flow.Trunk:
    """Return the robot as a bending body in space, its sections ellipses, divided at its joints.

    Args:
        outline: of the robot; stations about one cell apart serve well.
        motion: how it swims.
        grow: time over which the motion grows from nothing [s].
        tail_height: see ``half_heights`` [m].
        limbs: whether it has its limbs, see ``folded``; without them otherwise.
        sway: harmonic of the snout's displacement to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
    """
    spine = immersed(outline, motion, sway=sway, turn=turn, grow=grow).spine
    cuts, high = tuple(sorted(outline.places.tolist())), half_heights(outline, tail_height)
    if limbs:
        return flow.Limbed(spine=spine, half_height=high, cuts=cuts, limbs=folded(outline.robot))
    return flow.Trunk(spine=spine, half_height=high, cuts=cuts)
