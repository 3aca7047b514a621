"""Scutes: rows of keeled plates on neck and back, two rows of crests on the tail that become one."""

import numpy as np

from suchus.robot.design import Robot
from suchus.visual.skin.body import BodyShape
from suchus.visual.skin.look import Proportions
from suchus.visual.skin.mesh import Mesh, ring, spike
from suchus.visual.skin.paint import SCUTE


def middle_scutes(robot: Robot, outline: BodyShape) -> list[Mesh]:
    """Return the crests on the midline of the rear part of the tail."""
    fork, spacing = _fork(robot), _spacing(robot)
    scutes = []
    for x in np.arange(outline.back + 0.35 * spacing, fork, 0.62 * spacing):
        top = float(outline.top(np.array(x)))
        height = (0.40 + 0.35 * (x - outline.back) / (fork - outline.back)) * robot.tail.radius_root
        scutes.append(_crest(x, 0.0, 0.96 * top, 0.50 * spacing, 0.10 * spacing, height))
    return scutes


def left_scutes(robot: Robot, outline: BodyShape, proportions: Proportions) -> list[Mesh]:
    """Return the left rows: crests on the root of the tail, plates on back and neck."""
    fork, spacing = _fork(robot), _spacing(robot)
    nape = (
        robot.spine.length
        + robot.thorax.shoulder
        + 0.8 * proportions.skull * (robot.head.snout - robot.thorax.shoulder)
    )
    scutes = []
    for x in np.arange(fork, -0.5 * robot.tail.offset, 0.62 * spacing):
        fraction = (x - fork) / max(-fork, 1e-9)
        height = (0.75 - 0.45 * fraction) * robot.tail.radius_root
        scutes.append(_seated(outline, proportions, x, 0.16 + 0.10 * fraction, 0.52 * spacing, 0.13 * spacing, height))
    for row, (lateral_fraction, height) in enumerate(((0.11, 0.20), (0.33, 0.20), (0.56, 0.17))):
        start = -0.3 * robot.tail.offset + 0.31 * spacing * (row % 2)
        stop = nape if row < 2 else robot.spine.length
        for x in np.arange(start, stop, 0.66 * spacing):
            half_width = 0.17 * float(outline.width(np.array(x)))
            scutes.append(
                _seated(
                    outline,
                    proportions,
                    x,
                    lateral_fraction,
                    0.50 * spacing,
                    min(half_width, 0.28 * spacing),
                    height * robot.spine.radius,
                )
            )
    return scutes


def _fork(robot: Robot) -> float:
    """Return x where the two rows on the tail become one; about half way in the animal [m]."""
    return -robot.tail.offset - 0.5 * (robot.tail.length - robot.tail.offset)


def _spacing(robot: Robot) -> float:
    """Return the length of a scute with its gap [m]: some 45 of them from neck to tip."""
    return (robot.tail.length + robot.spine.length) / 28


def _seated(
    outline: BodyShape,
    proportions: Proportions,
    x: float,
    lateral_fraction: float,
    half_length: float,
    half_width: float,
    height: float,
) -> Mesh:
    """Return a scute that sits on the body's surface.

    Args:
        outline: outline of the body.
        proportions: proportions of the animal; the exponent of the body's section is used.
        x: place along the body [m].
        lateral_fraction: distance from the midline over the body's half width [-].
        half_length: half length of the scute [m].
        half_width: half width of the scute [m].
        height: height of its keel above the surface [m].
    """
    position = np.array(x)
    w, h, n = float(outline.width(position)), float(outline.top(position)), proportions.roundness
    z = h * (1 - lateral_fraction**n) ** (1 / n)
    return _crest(
        x, lateral_fraction * w, z - 0.05 * h, half_length, half_width, height + 0.05 * h, lean=0.35 * lateral_fraction
    )


def _crest(
    x: float, y: float, z: float, half_length: float, half_width: float, height: float, *, lean: float = 0.0
) -> Mesh:
    """Return a keeled plate that rises to the rear.

    Args:
        x: middle of the plate, forward [m].
        y: middle of the plate, to the left [m].
        z: height of its base [m].
        half_length: half length of the base [m].
        half_width: half width of the base [m].
        height: height of the keel above the base [m].
        lean: lateral offset of the keel's top over its height [-].
    """
    c, s = ring(8)
    base = np.stack(
        [x + half_length * c, y + half_width * s, z - 0.25 * height * np.abs(s) - 0.05 * height + 0.0 * c], axis=-1
    )
    apex = np.array([x - 0.55 * half_length, y + lean * height, z + height])
    return spike(base, apex).painted(np.array([*[SCUTE] * 8, 1.5 * SCUTE, SCUTE]))
