"""The robot as a body of the flow solver: a slice through it, or the body itself."""

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
    outline: Outline,
    motion: Motion,
    *,
    sway: complex = 0j,
    turn: complex = 0j,
    grow: float = 0.0,
    min_half_width: float = 0.0,
) -> flow.Midline:
    """Return the robot as a bending body of ``suchus.flow``, head at the origin, tail towards +x, y to its right.

    The midline bends as it is commanded, and the six cable joints bend equally. The real cable fixes only their sum,
    and the moments of the water differ between the joints; this is neglected. The compliance of the passive end is
    neglected as well, see ``sprung``.

    Seen from above the frame is turned by half a turn, not mirrored: counter-clockwise stays counter-clockwise.

    Args:
        outline: outline of the robot; stations about one cell apart serve well.
        motion: how it swims.
        sway: harmonic of the snout's displacement to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
        grow: time over which the motion grows from nothing [s].
        min_half_width: half-width below which the body is thickened, its ends made round [m].
    """
    body_motion = undulation(outline, motion).with_head_motion(sway, turn)
    half_width = outline.silhouette.half_width

    @lru_cache(maxsize=2)  # the flow asks up to ten times for the same two instants of a step
    def spine(time: float) -> flow.MidlineState:
        curve = body_motion.curve(np.asarray(time), *_growth(time, grow))
        state = flow.MidlineState(**curve._asdict(), half_width=half_width)
        return state.thickened(min_half_width) if min_half_width > 0.0 else state

    return flow.Midline(spine=spine)


def _growth(time: float, duration: float) -> tuple[float, float]:
    """Return the fraction of a motion that has grown, smooth at both ends, and its rate [1/s]."""
    if duration <= 0.0 or time >= duration:
        return 1.0, 0.0
    fraction = time / duration
    return fraction**3 * (10 - 15 * fraction + 6 * fraction**2), 30 * fraction**2 * (1 - fraction) ** 2 / duration


def half_heights(outline: Outline, tail_height: float = 0.0) -> np.ndarray:
    """Return half of the body's height at the stations, without limbs, with a raised tail if requested [m].

    Args:
        outline: outline of the robot.
        tail_height: height that the last third is raised to, where it is not as high [m].
    """
    share = outline.s / outline.robot.length
    rise = np.clip((share - FIN_STARTS) / FIN_RISES, 0.0, 1.0)
    fall = np.clip((1.0 - share) / FIN_RISES, 0.0, 1.0)
    fin = 0.5 * tail_height * np.sqrt(rise * (2.0 - rise) * fall * (2.0 - fall))
    return np.maximum(outline.silhouette.half_height, fin)


def folded_limbs(robot: Robot) -> tuple[flow.Capsule, ...]:
    """Return the limbs of a robot, stretched and turned straight back from the hips, in the plane of the body.

    Each link is a capsule and each foot a ball. They are fixed to the body at the hip.
    """
    place, capsules = layout(robot), []
    names = [segment.name for segment in place.robot.axis]
    for limb in place.limbs:
        girdle = limb.girdle
        hip_position = stations(place.robot)[names.index(girdle.segment)][0]
        hip_position += place.robot.axis[names.index(girdle.segment)].front - girdle.at
        lateral_offset, rear_offset = -limb.side * girdle.aside, 0.0  # the body's y points to the robot's right
        for link in girdle.limb.links:
            ends = (rear_offset, lateral_offset), (rear_offset + link.length, lateral_offset)
            capsules.append(flow.Capsule(arc_position=hip_position, start=ends[0], end=ends[1], radius=link.radius))
            rear_offset += link.length
        capsules.append(
            flow.Capsule(
                arc_position=hip_position,
                start=(rear_offset, lateral_offset),
                end=(rear_offset, lateral_offset),
                radius=girdle.limb.foot.radius,
            )
        )
    return tuple(capsules)


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
        outline: outline of the robot; stations about one cell apart serve well.
        motion: how it swims.
        grow: time over which the motion grows from nothing [s].
        tail_height: see ``half_heights`` [m].
        limbs: whether it has its limbs, see ``folded_limbs``; without them otherwise.
        sway: harmonic of the snout's displacement to the right [m]; zero for a free body, which finds it by itself.
        turn: harmonic of the head's direction [rad].
    """
    spine = immersed(outline, motion, sway=sway, turn=turn, grow=grow).spine
    cuts, half_height = tuple(sorted(outline.joint_positions.tolist())), half_heights(outline, tail_height)
    if limbs:
        return flow.Limbed(spine=spine, half_height=half_height, cuts=cuts, limbs=folded_limbs(outline.robot))
    return flow.Trunk(spine=spine, half_height=half_height, cuts=cuts)
