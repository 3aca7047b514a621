"""What a simulation warns of, once each: thin layers, bodies in each other, and vortices at a side that cannot move."""

from dataclasses import dataclass, field
from warnings import warn

import numpy as np

from suchus.core.errors import Doubtful
from suchus.flow.compiled import PAD
from suchus.flow.setup import Setup
from suchus.flow.sides import Stream
from suchus.flow.water import Fluid

EVERY = 256
"""Steps after which the sides are looked at, and at a run's end [-]."""

STRONG = 0.05
"""Vorticity at a side, over the largest in the domain, that is too strong for the side to be held [-]."""

SHARED = 0.5
"""Depth from which two bodies lie in each other [cells]: what a grid hardly tells from bodies that touch."""

FELT = 0.02
"""Speed that the vortex gives a cell at the side, over the fastest water, below which nothing is said [-]."""


def vorticity_size(velocity: np.ndarray) -> np.ndarray:
    """Return the summed sizes of the vorticity's components beside the low corners of the cells [m/s per cell].

    The shape is one less than the cells along each axis of the grid, the last axis first.
    """
    axes, here = len(velocity), slice(PAD + 1, -PAD)

    def shifted(part: np.ndarray, axis: int) -> np.ndarray:
        """Return the values one cell lower along an axis."""
        return part[tuple(slice(PAD, -PAD - 1) if axes - 1 - n == axis else here for n in range(axes))]

    inner = (here,) * axes
    total: np.ndarray = np.zeros(velocity[0][inner].shape, velocity.dtype)
    for d in range(axes):
        for e in range(d):
            u, v = velocity[e], velocity[d]
            total += np.abs((v[inner] - shifted(v, e)) - (u[inner] - shifted(u, d)))
    return total


@dataclass(slots=True)
class Watch:
    """Warns once of each thing."""

    setup: Setup
    """Set-up of the simulation."""
    errors: list[float] = field(default_factory=list)
    """Estimated error of each body's force now [-]."""
    _said: set[str] = field(default_factory=set)

    def layers(self, errors: list[float]) -> None:
        """Note the estimated errors of all bodies' forces; warn of a body whose error is large."""
        self.errors = errors
        for body, error in zip(self.setup.bodies, errors, strict=True):
            warning = self.setup.layer_warning(body, error)
            if warning is not None:
                self._say(f"layer {body.name}", warning)

    def shared(self, water: Fluid, time: float) -> str | None:
        """Return what is to be said of two bodies that lie in each other at a time [s], if any do."""
        depth, pair = water.overlap
        if depth <= SHARED * water.grid.cell:
            return None
        one, other = (self.setup.bodies[k].name for k in pair)
        return (
            f"at t = {time:.4g} s {one} and {other} lie {depth:.3g} m deep in each other, "
            f"{depth / water.grid.cell:.2g} cells: the water meets the nearer surface alone, so that neither's force "
            f"is its own. Move them apart, keep free bodies apart by a BodyContact, or make one shape of them (union, "
            f"difference)."
        )

    def overlap(self, water: Fluid, time: float) -> None:
        """Warn of bodies that have run into each other."""
        text = self.shared(water, time)
        if text is not None:
            self._say(f"overlap {water.overlap.bodies}", text)

    def sides(self, water: Fluid, time: float) -> None:
        """Warn of vortices at a side that is held to the far stream, which they should move."""
        water = water.layers[-1]
        held = [
            edge for edge in water.border.edges
            if isinstance(edge.side, Stream) and not edge.unbounded and edge.leaves < 0.5
        ]  # fmt: skip
        if not held:
            return
        inner = (slice(PAD + 1, -PAD),) * water.axes
        spin = vorticity_size(water.velocity)
        largest, fastest = float(spin.max()), max(float(np.abs(part[inner]).max()) for part in water.velocity)
        for edge in held:
            lines = edge.across(spin)
            near = lines[:2] if edge.low else lines[-2:]
            at = float(near.max())
            if at > STRONG * largest and at > FELT * fastest:
                self._say(
                    f"side {edge.name}",
                    f"at t = {time:.4g} s there is a vortex at the {edge.name} side of the domain "
                    f"({100 * at / largest:.0f} % of the largest vorticity), which is held to the far stream and turns "
                    f"it back. Enlarge the domain there, or leave all four sides Stream(), which then move as in an "
                    f"unbounded domain.",
                )

    def _say(self, key: str, what: str | Doubtful) -> None:
        if key not in self._said:
            self._said.add(key)
            warn(what if isinstance(what, Doubtful) else Doubtful(what), stacklevel=5)
