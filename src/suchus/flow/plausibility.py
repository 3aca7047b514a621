"""Inputs that are possible and probably not meant: units, angles, densities, sides and shapes that contradict."""

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from suchus.flow.body import AnyBody, Body
from suchus.flow.compiled import PAD
from suchus.flow.free import FreeBody
from suchus.flow.grid import POSITION_TOLERANCE, Grid
from suchus.flow.midline import Midline, MidlineState
from suchus.flow.pose import angle_text
from suchus.flow.sides import NAMES, Inflow, Sides
from suchus.flow.trunk import Trunk

if TYPE_CHECKING:
    from suchus.flow.setup import Setup

MAX_DENSITY_RATIO = 100.0
"""Density of a body over the water's, or its inverse, above which one of them is probably in another unit [-]."""

MAX_INFLOW_DIFFERENCE = 0.1
"""Mean inflow minus the stream, over the stream, above which they contradict [-]."""

MAX_HEADING_ERROR = 0.1
"""Mean angle between the headings of a midline and its direction above which they contradict [rad]."""


def implausible_inputs(setup: "Setup") -> Iterator[str]:
    """Yield a sentence for each input that is possible and probably not meant.

    Args:
        setup: the setup of a simulation.
    """
    for body in setup.bodies:
        yield from _angles(body)
        if isinstance(body, FreeBody):
            yield from _free_body(body, setup.density, setup.grid.ndim)
    yield from _inflows(setup)
    yield from _positions(setup.coarse_grid or setup.grid, setup.sides)


def _angles(body: AnyBody) -> Iterator[str]:
    """Yield a sentence for each angle at the start of more than a turn."""
    pose = body.pose(0.0) if isinstance(body, Body) else body
    for name in ("angle", "pitch", "roll"):
        text = angle_text(f"the {name} of {body.name} at the start", getattr(pose, name))
        if text is not None:
            yield text


def _free_body(body: FreeBody, water_density: float, ndim: int) -> Iterator[str]:
    """Yield a sentence for a density in another unit, and for gravity that does not act."""
    density = body.density
    if density is not None and not 1 / MAX_DENSITY_RATIO <= density / water_density <= MAX_DENSITY_RATIO:
        yield (
            f"{body.name} has a density of {density:.4g} kg/m3 and the water {water_density:.4g} kg/m3. Densities are "
            f"absolute: give {density * water_density:.4g} kg/m3 for a body that is {density:.4g} times as dense as "
            f"this water, or Setup(density=1000) for water in SI units."
        )
    if ndim == 2:
        return
    if len(body.gravity) == 2 and any(body.gravity):
        yield (
            f"gravity of {body.name} is {body.gravity} m/s2, along x and y alone; in space give three numbers, such as "
            f"(0, 0, -9.81)."
        )
    if len(body.gravity) == 3 and body.gravity[2] and body.free is not None and len(body.free) == 3:
        yield (
            f"gravity of {body.name} is {body.gravity} m/s2, and free={body.free} locks its motion along z: of three "
            f"numbers the third is the turn about z. Give six, for x, y, z and the turns about them."
        )


def _inflows(setup: "Setup") -> Iterator[str]:
    """Yield a sentence for each inflow whose mean differs from the far stream."""
    stream, grid = setup.far_velocity(0.0), setup.coarse_grid or setup.grid
    for k, (name, side) in enumerate(zip(NAMES, setup.sides.of_axes(grid.ndim), strict=False)):
        axis, sign = k // 2, 1 if k % 2 == 0 else -1
        if not isinstance(side, Inflow) or not stream[axis]:
            continue
        places = np.meshgrid(*(grid.centres(PAD, PAD + n, d) for d, n in enumerate(grid.cells) if d != axis))
        mean, inward = float(np.mean(side.inflow_velocity(0.0, *places))), sign * stream[axis]
        if abs(mean - inward) > MAX_INFLOW_DIFFERENCE * abs(inward):
            yield (
                f"the mean inflow through the {name} side is {mean:.4g} m/s and the stream has {inward:.4g} m/s there. "
                f"The water begins with the stream and then follows the inflow: make them equal, or leave out stream."
            )


def _positions(grid: Grid, sides: Sides) -> Iterator[str]:
    """Yield a sentence for each side with a fixed position that ``Grid.covering`` has moved."""
    for d, (request, is_fixed) in enumerate(zip(grid.request, sides.is_fixed(grid.ndim), strict=False)):
        ends = grid.origin[d], grid.origin[d] + grid.size[d]
        for place, end, fixed, name in zip(request, ends, is_fixed, NAMES[2 * d : 2 * d + 2], strict=True):
            if fixed and abs(end - place) > POSITION_TOLERANCE * grid.cell:
                yield (
                    f"the {name} side is a {type(getattr(sides, name)).__name__} at {'xyz'[d]} = {end:.6g} m, and "
                    f"{place:.6g} m was asked for: the grid was widened to what multigrid can halve. Give sides= to "
                    f"Grid.covering too."
                )


def heading_text(body: AnyBody, time: float) -> str | None:
    """Return a sentence about a midline whose headings are not its direction, or None.

    Args:
        body: the body.
        time: when [s].
    """
    if not isinstance(body.shape, Midline | Trunk):
        return None
    spine: MidlineState = body.shape.spine(time)
    direction = np.arctan2(np.diff(spine.y), np.diff(spine.x))
    heading = 0.5 * (spine.heading[1:] + spine.heading[:-1])
    deviation = np.abs((direction - heading + pi) % (2 * pi) - pi)
    lengths = np.hypot(np.diff(spine.x), np.diff(spine.y))
    mean = float((deviation * lengths).sum() / max(lengths.sum(), 1e-300))
    if mean <= MAX_HEADING_ERROR:
        return None
    return (
        f"at t = {time:.4g} s the headings of {body.name} differ by {mean:.3g} rad in the mean from the direction of "
        f"its midline: sections would stand oblique to it. Give heading = arctan2(dy/ds, dx/ds), from the first "
        f"station to the last."
    )
