"""Settings of a swim in the flow solver: in the plane or in space, tethered or free, resolution and duration."""

from dataclasses import dataclass, replace

import numpy as np

from suchus import flow
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.flow.immerse import MIN_THICKNESS
from suchus.robot.design import WATER_DENSITY, Robot

DENSITY = WATER_DENSITY
"""Density of the water [kg/m3]."""
GROWS = 0.5
"""Part of the first cycle in which the motion grows from nothing [cycle]."""
FREE, ON_THE_SPOT, TETHERED = (True, True, True), (False, True, True), (False, False, False)
"""A body that nothing holds; one that is kept from moving on; one whose motion is given."""
TETHERED_BOX, FREE_BOX = (2.75, 1.5), (3.5, 2.0)
"""Length and width of the box of a slice, where a setting gives none [body length]."""
MARGIN_AHEAD, MARGIN_BEHIND, MARGIN_BESIDE, MARGIN_ABOVE = 0.15, 0.35, 0.2, 0.15
"""In space: water ahead of the snout, behind the tail, beside the widest swing and above the back [body length]."""
MAX_CELLS = {2: 4096, 3: 1024}
"""Most cells per body length, by the number of axes [-]."""
_TOLERANCES = {2: 1e-5, 3: 1e-4}
_MIN_LENGTH, _MIN_WIDTH = 1.75, 1.0
"""Least length and width of a slice's box that leaves some water on every side of a swimming body [body length]."""
_MARGIN = 8.0
"""Cells between the body's widest reach and the sides that the solver needs, its half-width included [-]."""
_DRIFT_MARGIN = 0.05
"""Swing to a side that the box leaves to a body that draws to the side and turns, beside its own [body length]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SwimSetting:
    """How a swim is resolved: grid, water, time, and what moves the body.

    In the plane it is a slice through the body, as deep as the water is, and forces are per metre of depth. In space it
    is the body itself: the half above its plane of symmetry is computed, and beyond the plane lies its image.
    """

    axes: int = 2
    """Axes of the grid, 2 or 3 [-]."""
    cells: int
    """Cells per body length [-]."""
    viscosity: float
    """Kinematic viscosity of the water [m2/s]."""
    cycles: int
    """Number of cycles that are simulated; the last is measured [-]."""
    free: tuple[bool, bool, bool] = FREE
    """Whether the water moves the body along its course, to the side, and in yaw; what is not free keeps its place. All
    False is a tethered body, whose head may be given a motion."""
    frames: int = 0
    """Instants of the last cycle at which the fields of a free body are kept, for films [-]."""
    box: tuple[float, float] | None = None
    """In the plane: length and width of the box [body length]; None gives a tethered body 2.75 by 1.5, a free one
    3.5 by 2."""
    blunt: float = 0.0
    """In the plane: least half-width; where the body is thinner it is thickened, its ends made round [cell]. With 1.75
    cells the force has the least noise; with 0 the body stays as it is. Of the caiman held at its snout, at 80 cells a
    length, the noise along the body falls from 7.3 to 1.3 %, and the mean thrust by half; with 160 cells it is 2.7 %
    without, with 240 cells 1.6 %."""
    beside: float = MARGIN_BESIDE
    """In space: water beside the widest swing, to each side [body length]."""
    behind: float = MARGIN_BEHIND
    """In space: water behind the tail [body length]."""
    tail_height: float = 0.0
    """In space: height of the last third of the body, as a fin as thick as the tail is; 0 leaves it as it is [m]."""
    limbs: bool = False
    """In space: whether the limbs are in the water, folded straight back along the body."""
    tolerance: float | None = None
    """Mean divergence left over, in fastest speed per cell; None is 1e-5 in the plane and 1e-4 in space [-]."""

    def __post_init__(self) -> None:
        """Refuse settings out of range, and settings of a slice for a body in space and vice versa."""
        with Checks("setting", self) as check:
            check.that(self.axes in MAX_CELLS, f"setting.axes is {self.axes!r}; 2 is a slice and 3 the body in space")
            check.whole("cells", 32, MAX_CELLS.get(self.axes, MAX_CELLS[3]))
            check.whole("cycles", 1, 1000)
            check.whole("frames", 0, 1000)
            check.number("viscosity", 1e-7, 10.0, "m2/s")
            check.number("blunt", 0.0, 5.0, "cells")
            check.number("beside", 0.0, 3.0, "body lengths")
            check.number("behind", 0.2, 5.0, "body lengths")
            check.number("tail_height", 0.0, 1.0, "m")
            if self.tolerance is not None:
                check.number("tolerance", 5e-7, 1e-2, "")
            foreign_fields = ("box", "blunt") if self.axes == 3 else ("beside", "behind", "tail_height", "limbs")
            changed_fields = [name for name in foreign_fields if getattr(self, name) != _default(name)]
            kind = "a slice" if self.in_space else "a body in space"
            check.that(
                not changed_fields,
                f"setting.{', '.join(changed_fields)} is for {kind}, and setting.axes is {self.axes}: leave it out",
            )
        for value, min_value, dimension in zip(
            self.box or (), (_MIN_LENGTH, _MIN_WIDTH), ("long", "wide"), strict=False
        ):
            if not (np.isfinite(value) and value >= min_value):
                raise InvalidDesign(
                    f"setting.box is {value} body lengths {dimension}; the body itself is 1 long and swings to both "
                    f"sides: give at least {min_value}."
                )

    @property
    def tethered(self) -> bool:
        """Whether the whole motion of the body is prescribed."""
        return not any(self.free)

    @property
    def in_space(self) -> bool:
        """Whether the body itself is resolved, and not a slice of it."""
        return self.axes == 3

    def min_half_width(self, length: float) -> float:
        """Return the half-width below which a body of a length [m] is thickened [m]."""
        return self.blunt * length / self.cells

    def largest_divergence(self) -> float:
        """Return ``tolerance``, or its default if it is None [-]."""
        return _TOLERANCES[self.axes] if self.tolerance is None else self.tolerance

    def grid(self, length: float, swing: float = 0.0, height: float = 0.0) -> flow.Grid:
        """Return the cells around a body whose snout is near the origin, most of the water behind it.

        Args:
            length: length of the body [m].
            swing: greatest displacement to a side, which widens the box in space [m].
            height: greatest half-height of the body, over which the water in space stands [m].
        """
        if self.in_space:
            return self._grid_in_space(length, swing, height)
        box_length, box_width = self.box or (TETHERED_BOX if self.tethered else FREE_BOX)
        front_length = (box_length - 0.5) / 3.0
        return flow.Grid.covering(
            (-front_length * length, (box_length - front_length) * length),
            (-0.5 * box_width * length, 0.5 * box_width * length),
            cell=length / self.cells,
        )

    def grid_around(self, length: float, reach: float) -> flow.Grid:
        """Return the cells around a body in space that moves in all directions.

        Args:
            length: length of the body [m].
            reach: greatest distance of the body from its axis, to any side [m].
        """
        half_width = reach + (_DRIFT_MARGIN + self.beside) * length
        return flow.Grid.covering(
            (-MARGIN_AHEAD * length, (1.0 + self.behind) * length),
            (-half_width, half_width),
            (-half_width, half_width),
            cell=length / self.cells,
        )

    def _grid_in_space(self, length: float, swing: float, height: float) -> flow.Grid:
        """Return the cells around the upper half of a body."""
        lateral_reach, top = swing / length + _DRIFT_MARGIN, height / length + MARGIN_ABOVE
        grid = flow.Grid.covering(
            (-MARGIN_AHEAD * length, (1.0 + self.behind) * length),
            (-(lateral_reach + self.beside) * length, (lateral_reach + self.beside) * length),
            (0.0, top * length),
            cell=length / self.cells,
        )
        return replace(grid, origin=(*grid.origin[:2], 0.0))  # what it grew above and below lies above

    def grid_above_floor(self, length: float, swing: float, height: float, floor: float) -> flow.Grid:
        """Return the cells around a whole body in space that swims in its plane above a floor.

        Args:
            length: length of the body [m].
            swing: greatest displacement to a side [m].
            height: greatest half-height of the body [m].
            floor: depth of the floor below the middle of the body [m].
        """
        cell, lateral_reach = length / self.cells, swing / length + _DRIFT_MARGIN + self.beside
        return flow.Grid.covering(
            (-MARGIN_AHEAD * length, (1.0 + self.behind) * length),
            (-lateral_reach * length, lateral_reach * length),
            (-floor, height + MARGIN_ABOVE * length),
            cell=cell,
            sides=flow.Sides(low=flow.Wall()),
        )

    def check_thickness(self, robot: Robot, shape: flow.Shape) -> None:
        """Refuse cells in space so coarse that a robot is nowhere thick enough for them.

        Raises:
            InvalidDesign: with the cells that would do.
        """
        max_thickness, cell = float(shape.thickness(0.0)[1].max()), robot.length / self.cells
        if self.in_space and max_thickness < MIN_THICKNESS * cell:
            min_cells = int(np.ceil(MIN_THICKNESS * robot.length / max_thickness))
            raise InvalidDesign(
                f"robot {robot.name!r} is {max_thickness:.3g} m thick at most, and with {self.cells} cells a length "
                "a cell is "
                f"{cell:.3g} m: a flow in space needs {MIN_THICKNESS:.2f} cells across. Take at least {min_cells} "
                f"cells, "
                "or a slice."
            )

    def check_margin(self) -> None:
        """Refuse a box in space so narrow that the body would leave it.

        Raises:
            InvalidDesign: with what is left beside the body, and what would do.
        """
        min_margin = _MARGIN / self.cells
        if self.in_space and self.beside + _DRIFT_MARGIN < min_margin:
            raise InvalidDesign(
                f"the box leaves {self.beside:.3g} body lengths of water beside the widest swing, and the body would "
                f"leave it: give at least {min_margin - _DRIFT_MARGIN:.2g}, better {MARGIN_BESIDE}."
            )


def _default(name: str) -> object:
    return SwimSetting.__dataclass_fields__[name].default
