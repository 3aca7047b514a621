"""How finely, how long and in how large a box a swim is resolved."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from suchus import flow
from suchus.design import WATER_DENSITY
from suchus.design.checks import Checks
from suchus.errors import InvalidDesign
from suchus.flow.setup import LAYER_CELLS
from suchus.motion import Swim, check_swim
from suchus.water.outline import Outline
from suchus.water.slender import cycle
from suchus.water.undulation import Motion

DENSITY = WATER_DENSITY
"""Of the water [kg/m3]."""
GROWS = 0.5
"""Part of the first cycle in which the motion grows from nothing [cycle]."""
_SHORTEST, _NARROWEST = 1.75, 1.0
"""Least length and width of a box that leaves some water on every side of a swimming body [body length]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tether:
    """How finely, how long and in how large a box a swim is resolved."""

    cells: int
    """Cells per body length [-]."""
    viscosity: float
    """Kinematic viscosity of the water [m2/s]."""
    cycles: int
    """Number of cycles that are simulated; the last is measured [-]."""
    blunt: float = 0.0
    """Least half-width: where the body is thinner it is thickened, its ends made round [cell]. With 1.75 cells the
    force has the least noise; with 0 the body stays as it is."""
    frames: int = 24
    """Instants of a free body's last cycle at which the fields are kept, for films [-]."""
    box: tuple[float, float] | None = None
    """Length and width of the box [body length]; None gives a tethered body 2.75 by 1.5 and a free one 3.5 by 2."""

    def __post_init__(self) -> None:
        with Checks("tether", self) as check:
            check.whole("cells", 32, 4096)
            check.whole("cycles", 1, 1000)
            check.whole("frames", 1, 1000)
            check.number("blunt", 0.0, 5.0, "cells")
            check.number("viscosity", 1e-7, 10.0, "m2/s")
        if self.box is None:
            return
        for value, least, what in zip(self.box, (_SHORTEST, _NARROWEST), ("long", "wide"), strict=True):
            if not (np.isfinite(value) and value >= least):
                raise InvalidDesign(
                    f"tether.box is {value} body lengths {what}; the body itself is 1 long and swings to both sides: "
                    f"give at least {least}."
                )

    def least(self, length: float) -> float:
        """Return the half-width below which a body of a length [m] is thickened [m]."""
        return self.blunt * length / self.cells

    def grid(self, length: float, box: tuple[float, float]) -> flow.Grid:
        """Return the cells around a body whose snout is near the origin, most of the water behind it.

        Args:
            length: of the body [m].
            box: length and width where ``self.box`` is None [body length].
        """
        long, wide = self.box or box
        ahead = (long - 0.5) / 3.0
        return flow.Grid.covering(
            (-ahead * length, (long - ahead) * length),
            (-0.5 * wide * length, 0.5 * wide * length),
            cell=length / self.cells,
        )


def check_motion(
    outline: Outline,
    motion: Motion,
    setting: Tether,
    sway: complex,
    turn: complex,
    cost: Callable[[int], str] = lambda _: "",
) -> None:
    """Refuse what joints, servos or grid cannot follow.

    Args:
        outline: of the robot.
        motion: how it swims.
        setting: grid and water.
        sway: harmonic of the snout's displacement to the right [m].
        turn: harmonic of the head's direction [rad].
        cost: says what a swim with so many cells per body length takes, for the message.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid.
    """
    if isinstance(motion, Swim):
        check_swim(outline.robot, motion)
    length, moving = outline.robot.length, cycle(outline, motion, sway, turn)
    speed = float(np.hypot(moving.x_rate, moving.y_rate).max())
    layer, cell = (length * setting.viscosity / max(speed, 1e-12)) ** 0.5, length / setting.cells
    if layer < LAYER_CELLS * cell:
        cells = int(np.ceil(LAYER_CELLS * length / layer))
        raise InvalidDesign(
            f"the boundary layer of {motion.name!r} is {layer:.2g} m thin and a cell {cell:.2g} m; take at least "
            f"{cells} cells per body length{cost(cells)}, or a viscosity of at least "
            f"{setting.viscosity * (LAYER_CELLS * cell / layer) ** 2:.2g} m2/s."
        )
