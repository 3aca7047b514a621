"""Inputs that are possible and probably not meant: units, angles, densities, sides and shapes that contradict."""

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from suchus.flow.body import AnyBody, Body
from suchus.flow.compiled import PAD
from suchus.flow.free import FreeBody
from suchus.flow.grid import POSITION_TOLERANCE, Grid
from suchus.flow.midline import MidlineState, Spined
from suchus.flow.pose import Oscillation, angle_text
from suchus.flow.sides import NAMES, Inflow, Outflow, Sides
from suchus.flow.swimmer import to_degrees_of_freedom

if TYPE_CHECKING:
    from suchus.flow.setup import Setup

MAX_DENSITY_RATIO = 100.0
"""Density of a body over the water's, or its inverse, above which one of them is probably in another unit [-]."""

MAX_INFLOW_DIFFERENCE = 0.1
"""Mean inflow minus the stream, over the stream, above which they contradict [-]."""

MIN_CONTACT_CELLS, MAX_CONTACT_CELLS = 1.0, 10.0
"""Reach of a contact outside which it is probably in another unit [cells]."""

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
            yield from _without_effect(body, setup.density, setup.grid.ndim)
    yield from _inflows(setup)
    yield from _contact(setup)
    yield from _positions(setup.coarse_grid or setup.grid, setup.sides)


def _angles(body: AnyBody) -> Iterator[str]:
    """Yield a sentence for each angle at the start of more than a turn."""
    pose = body.pose(0.0) if isinstance(body, Body) else body
    for name in ("angle", "pitch", "roll"):
        text = angle_text(f"the {name} of {body.name} at the start", getattr(pose, name))
        if text is not None:
            yield text
    motion = body.motion if isinstance(body, Body) else None
    if isinstance(motion, Oscillation):
        text = angle_text(f"the amplitude of the pitch of {body.name}", motion.pitch)
        if text is not None:
            yield text
    anchor = body.anchor if isinstance(body, FreeBody) and body.anchor is not None else ()
    for angle in anchor[2:] if len(anchor) == 3 else anchor[3:]:
        text = angle_text(f"an angle of the anchor of {body.name}", angle)
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


def _without_effect(body: FreeBody, water_density: float, ndim: int) -> Iterator[str]:
    """Yield a sentence for a weight, springs or dampers that cannot move a body."""
    if any(body.gravity) and body.density in (None, water_density):
        yield (
            f"gravity of {body.name} is {body.gravity} m/s2, and its density is the water's, so that it has no weight "
            f"in water: gravity does nothing. Give a density in kg/m3, or leave out gravity."
        )
    if ndim == 3 and body.free is not None and len(body.free) == 3 and any(body.gravity[2:]):
        return  # ``_free_body`` says it
    is_free = to_degrees_of_freedom((True,) * 3 * (ndim - 1) if body.free is None else body.free, ndim)
    for name in ("gravity", "springs", "dampers"):
        values = getattr(body, name)
        components = (
            np.pad(np.array(values, float), (0, is_free.size - len(values)))
            if name == "gravity"
            else to_degrees_of_freedom(values, ndim)
        )
        if any(values) and not (np.flatnonzero(components)[:, None] == np.flatnonzero(is_free)).any():
            yield (
                f"{name}={values} of {body.name} acts only along degrees of freedom that free={body.free} locks: it "
                f"does nothing. Free one of them, or leave out {name}."
            )


def _contact(setup: "Setup") -> Iterator[str]:
    """Yield a sentence for a contact whose reach is no few cells, or that moves no body."""
    if setup.contact is None:
        return
    cells = setup.contact.gap / setup.grid.cell
    if not MIN_CONTACT_CELLS <= cells <= MAX_CONTACT_CELLS:
        yield (
            f"the contact's gap is {setup.contact.gap:.4g} m or {cells:.3g} cells. It is a distance in metres; two to "
            f"three cells are right: give {2.5 * setup.grid.cell:.3g} m."
        )
    if not any(isinstance(body, FreeBody) for body in setup.bodies):
        yield "a contact is given and no FreeBody: it moves no body whose motion is given. Leave out contact."


def _inflows(setup: "Setup") -> Iterator[str]:
    """Yield a sentence for each inflow whose mean differs from the far stream."""
    stream, grid = setup.far_velocity(0.0), setup.coarse_grid or setup.grid
    for k, (name, side) in enumerate(zip(NAMES, setup.sides.of_axes(grid.ndim), strict=False)):
        axis, sign = k // 2, 1 if k % 2 == 0 else -1
        inward = sign * stream[axis]
        if isinstance(side, Outflow) and inward > 0:
            yield (
                f"the stream enters with {inward:.4g} m/s through the {name} side, an Outflow, which carries water "
                f"out. Make it a Stream() or an Inflow, or turn the stream round."
            )
        if not isinstance(side, Inflow):
            continue
        places = np.meshgrid(*(grid.centres(PAD, PAD + n, d) for d, n in enumerate(grid.cells) if d != axis))
        mean = float(np.mean(side.inflow_velocity(0.0, *places)))
        if mean < 0:
            yield (
                f"the mean inflow through the {name} side is {mean:.4g} m/s: water leaves there. Positive is into the "
                f"domain, on each side."
            )
        if stream[axis] and abs(mean - inward) > MAX_INFLOW_DIFFERENCE * abs(inward):
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
    if not isinstance(body.shape, Spined):
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
