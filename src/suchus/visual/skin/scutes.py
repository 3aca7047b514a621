"""Scutes: rows of keeled plates on neck and back, two rows of crests on the tail that become one."""

import numpy as np

from suchus.robot.design import Robot
from suchus.visual.skin.body import BodyShape
from suchus.visual.skin.look import Look
from suchus.visual.skin.mesh import Mesh, ring, spike
from suchus.visual.skin.paint import SCUTE


def middle_scutes(robot: Robot, outline: BodyShape) -> list[Mesh]:
    """Return the crests on the midline of the rear part of the tail."""
    fork, spacing = _fork(robot), _spacing(robot)
    found = []
    for x in np.arange(outline.back + 0.35 * spacing, fork, 0.62 * spacing):
        top = float(outline.top(np.array(x)))
        tall = (0.40 + 0.35 * (x - outline.back) / (fork - outline.back)) * robot.tail.radius_root
        found.append(_crest(x, 0.0, 0.96 * top, 0.50 * spacing, 0.10 * spacing, tall))
    return found


def left_scutes(robot: Robot, outline: BodyShape, look: Look) -> list[Mesh]:
    """Return the left rows: crests on the root of the tail, plates on back and neck."""
    fork, spacing = _fork(robot), _spacing(robot)
    nape = robot.spine.length + robot.thorax.shoulder + 0.8 * look.skull * (robot.head.snout - robot.thorax.shoulder)
    found = []
    for x in np.arange(fork, -0.5 * robot.tail.offset, 0.62 * spacing):
        share = (x - fork) / max(-fork, 1e-9)
        tall = (0.75 - 0.45 * share) * robot.tail.radius_root
        found.append(_seated(outline, look, x, 0.16 + 0.10 * share, 0.52 * spacing, 0.13 * spacing, tall))
    for row, (aside, tall) in enumerate(((0.11, 0.20), (0.33, 0.20), (0.56, 0.17))):
        start = -0.3 * robot.tail.offset + 0.31 * spacing * (row % 2)
        stop = nape if row < 2 else robot.spine.length
        for x in np.arange(start, stop, 0.66 * spacing):
            wide = 0.17 * float(outline.width(np.array(x)))
            found.append(
                _seated(outline, look, x, aside, 0.50 * spacing, min(wide, 0.28 * spacing), tall * robot.spine.radius)
            )
    return found


def _fork(robot: Robot) -> float:
    """Return x where the two rows on the tail become one; about half way in the animal [m]."""
    return -robot.tail.offset - 0.5 * (robot.tail.length - robot.tail.offset)


def _spacing(robot: Robot) -> float:
    """Return the length of a scute with its gap [m]: some 45 of them from neck to tip."""
    return (robot.tail.length + robot.spine.length) / 28


def _seated(outline: BodyShape, look: Look, x: float, aside: float, long: float, wide: float, tall: float) -> Mesh:
    """Return a scute on the body's surface at a share of its half width."""
    at = np.array(x)
    w, h, n = float(outline.width(at)), float(outline.top(at)), look.roundness
    z = h * (1 - aside**n) ** (1 / n)
    return _crest(x, aside * w, z - 0.05 * h, long, wide, tall + 0.05 * h, lean=0.35 * aside)


def _crest(x: float, y: float, z: float, long: float, wide: float, tall: float, *, lean: float = 0.0) -> Mesh:
    """Return a keeled plate that rises to the rear."""
    c, s = ring(8)
    base = np.stack([x + long * c, y + wide * s, z - 0.25 * tall * np.abs(s) - 0.05 * tall + 0.0 * c], axis=-1)
    apex = np.array([x - 0.55 * long, y + lean * tall, z + tall])
    return spike(base, apex).painted(np.array([*[SCUTE] * 8, 1.5 * SCUTE, SCUTE]))
