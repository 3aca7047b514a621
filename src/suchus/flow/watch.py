"""Warnings of a simulation, once each: thin layers, overlapping bodies, vortices at fixed sides, and near wakes."""

from dataclasses import dataclass, field
from warnings import warn

import numpy as np

from suchus.core.errors import Doubtful
from suchus.flow.body import AnyBody
from suchus.flow.compiled import PAD
from suchus.flow.contact import WallPlane
from suchus.flow.immerse import MEAN_WINDOW_MARGIN
from suchus.flow.plausibility import heading_text, implausible_inputs
from suchus.flow.pose import length
from suchus.flow.setup import Setup
from suchus.flow.sides import Stream
from suchus.flow.water import Fluid

SIDE_CHECK_INTERVAL = 256
"""Steps between two checks of the sides; they are also checked at the end of a run [-]."""

MAX_SIDE_VORTICITY = 0.05
"""Vorticity at a fixed side, over the largest in the domain, above which a warning is issued [-]."""

MAX_OVERLAP = 0.5
"""Depth above which two bodies overlap [cells]; the grid hardly distinguishes less from contact."""

MIN_INDUCED_SPEED = 0.02
"""Speed that the vortex induces in a cell at the side, over the fastest water, below which no warning is issued [-]."""

MIN_WAKE_DISTANCE = 3.0
"""Distance behind the bodies, over their width, from which on a side that carries the wake out changes the drag by less
than 2 % [-]. On a sphere at Re 100 it is 10 % at 1.2 diameters and 4 % at 2."""

MIN_STREET_DISTANCE = 11.0
"""The same for the lift of a vortex street in the plane: 9 % off at 8 diameters, 4 % at 10, 1 % at 12 [-]."""

MIN_STREET_RE = 47.0
"""Reynolds number from which on a blunt body in the plane sheds vortices [-]."""

MIN_STREET_TRAVEL = 20.0
"""Way of the stream, over the width of the bodies, after which a wake should not be symmetric any more [-]."""

MAX_SYMMETRIC_DIFFERENCE = 0.2
"""Difference of a wake from its mirror image, over the stream's speed, up to which it counts as symmetric [-]; that of
a street is one or so."""

MAX_BLUNT_LENGTH = 2.0
"""Length along the stream, over the width across it, up to which a body is blunt [-]."""

MIN_WAKE_VORTICITY = 0.01
"""Vorticity at a side, over the largest in the domain, from which on the wake has come there [-]."""


def vorticity_size(velocity: np.ndarray) -> np.ndarray:
    """Return the sum of the absolute vorticity components at the low corners of the cells [m/s per cell].

    The shape is one less than the cells along each axis of the grid, the last axis first.

    Args:
        velocity: padded velocity, shape (axis, ...) [m/s].
    """
    ndim, interior = len(velocity), slice(PAD + 1, -PAD)

    def shifted(component: np.ndarray, axis: int) -> np.ndarray:
        """Return the values one cell lower along an axis."""
        return component[tuple(slice(PAD, -PAD - 1) if ndim - 1 - n == axis else interior for n in range(ndim))]

    inner = (interior,) * ndim
    total: np.ndarray = np.zeros(velocity[0][inner].shape, velocity.dtype)
    for d in range(ndim):
        for e in range(d):
            u, v = velocity[e], velocity[d]
            total += np.abs((v[inner] - shifted(v, e)) - (u[inner] - shifted(u, d)))
    return total


@dataclass(slots=True)
class Watch:
    """Issues each warning once."""

    setup: Setup
    """Set-up of the simulation."""
    errors: list[float] = field(default_factory=list)
    """Present estimated error of each body's force [-]."""
    _issued_keys: set[str] = field(default_factory=set)
    _carried: np.ndarray = field(default_factory=lambda: np.zeros(1))
    """How far the far water has moved past the domain [m]."""
    _carried_time: float = 0.0
    """Time until which that counts [s]."""

    def layers(self, errors: list[float]) -> None:
        """Store the estimated errors of all bodies' forces and warn of those that are large.

        Args:
            errors: relative error for each body; see ``Setup.layer_error`` [-].
        """
        self.errors = errors
        for body, error in zip(self.setup.bodies, errors, strict=True):
            warning = self.setup.layer_warning(body, error)
            if warning is not None:
                self._say(f"layer {body.name}", warning)

    def overlap_message(self, water: Fluid, time: float) -> str | None:
        """Return a message about two bodies that overlap, or None.

        Args:
            water: the water with the placed bodies.
            time: time, for the message [s].
        """
        depth, pair = water.overlap
        if depth <= MAX_OVERLAP * water.grid.cell:
            return None
        first_name, second_name = (self.setup.bodies[k].name for k in pair)
        return (
            f"at t = {time:.4g} s {first_name} and {second_name} lie {depth:.3g} m deep in each other, "
            f"{depth / water.grid.cell:.2g} cells: the water meets the nearer surface alone, so that neither's force "
            f"is its own. Move them apart, keep free bodies apart by a BodyContact, or make one shape of them (union, "
            f"difference)."
        )

    def overlap(self, water: Fluid, time: float) -> None:
        """Warn of bodies that have run into each other."""
        text = self.overlap_message(water, time)
        if text is not None:
            self._say(f"overlap {water.overlap.bodies}", text)

    def clearance(self, body: AnyBody, wall: WallPlane, clearance: float, time: float) -> None:
        """Warn of a body so near to a wall that the grid does not resolve the water between them.

        Args:
            body: the body.
            wall: the wall.
            clearance: distance between them [m].
            time: time, for the message [s].
        """
        cell = self.setup.grid.cell
        remedy = (
            f"Give contact=BodyContact(gap={2.5 * cell:.3g}, pressure=...)"
            if self.setup.contact is None
            else "Raise the pressure of the contact"
        )
        self._say(
            f"clearance {body.name} {wall.name}",
            f"at t = {time:.4g} s {body.name} is {clearance:.3g} m or {clearance / cell:.2g} cells from the "
            f"{wall.name} side: nearer than one cell the grid does not resolve the water between them, and forces are "
            f"too small. {remedy}, or take finer cells.",
        )

    def sides(self, water: Fluid, time: float) -> None:
        """Warn of vortices at a side that is fixed to the far stream although the vortices should move it.

        Args:
            water: the water after a step.
            time: time, for the message [s].
        """
        water = water.layers[-1]
        fixed_edges = [
            edge for edge in water.border.edges
            if isinstance(edge.side, Stream) and not edge.unbounded and edge.convective_weight < 0.5
        ]  # fmt: skip
        if not fixed_edges:
            return
        inner = (slice(PAD + 1, -PAD),) * water.ndim
        spin = vorticity_size(water.velocity)
        max_vorticity = float(spin.max())
        fastest = max(float(np.abs(component[inner]).max()) for component in water.velocity)
        for edge in fixed_edges:
            lines = edge.with_normal_first(spin)
            outer_lines = lines[:2] if edge.is_lower_side else lines[-2:]
            side_vorticity = float(outer_lines.max())
            if side_vorticity > MAX_SIDE_VORTICITY * max_vorticity and side_vorticity > MIN_INDUCED_SPEED * fastest:
                percent = 100 * side_vorticity / max_vorticity
                self._say(
                    f"side {edge.name}",
                    f"at t = {time:.4g} s there is a vortex at the {edge.name} side of the domain "
                    f"({percent:.0f} % of the largest vorticity), which is held to the far stream and turns it back. "
                    f"Enlarge the domain there, or leave all four sides Stream(), which then move as in an unbounded "
                    f"domain.",
                )

    def wakes(self, water: Fluid, time: float) -> None:
        """Warn of a wake that leaves through a side so near behind a body that the forces depend on the side.

        The far water must have carried the wake there since the start: a domain that follows a body sways with it, and
        a vortex that comes to a side beside it is no wake that leaves.

        Args:
            water: the water after a step, with the bodies.
            time: time, for the message [s].
        """
        window, ndim = water.window, water.ndim
        if len(water.layers) > 1 or window[1] <= window[0]:
            return
        margin, spin = MEAN_WINDOW_MARGIN, None
        stream = np.array(water.border.stream)
        self._carried = self._carried + stream * (time - self._carried_time)
        self._carried_time = time
        far = float(np.linalg.norm(self._carried))
        spans = [  # beside a wall the window ends there
            (start - PAD + margin if start >= PAD else 0, stop - PAD - margin if stop <= n + PAD else n)
            for start, stop, n in zip(window[-2::-2], window[::-2], water.grid.cells, strict=True)
        ]
        for edge in water.border.edges:
            if edge.convective_weight < 0.5:
                continue
            start, stop = spans[edge.axis]
            width = max(b - a for d, (a, b) in enumerate(spans) if d != edge.axis)
            distance = start if edge.is_lower_side else edge.cells - stop
            carried = (-1.0 if edge.is_lower_side else 1.0) * self._carried[edge.axis]
            if carried < max(0.5 * far, distance * water.grid.cell):
                continue
            sheds = (
                ndim == 2 and stop - start <= width * MAX_BLUNT_LENGTH and self._reynolds(water, width) > MIN_STREET_RE
            )
            needed = MIN_STREET_DISTANCE if sheds else MIN_WAKE_DISTANCE
            if distance >= needed * width:
                continue
            spin = vorticity_size(water.velocity) if spin is None else spin
            lines = edge.with_normal_first(spin)
            outer = lines[0] if edge.is_lower_side else lines[-1]
            if float(outer.max()) > MIN_WAKE_VORTICITY * float(spin.max()):
                h = water.grid.cell
                effect = "the lift and the frequency of a vortex street depend" if sheds else "the drag depends"
                self._say(
                    f"wake {edge.name}",
                    f"at t = {time:.4g} s the wake leaves through the {edge.name} side of the domain, "
                    f"{distance * h:.3g} m behind the bodies or {distance / width:.2g} times their width: {effect} on "
                    f"that side. Put it at least {needed * width * h:.3g} m behind them.",
                )

    def symmetry(self, water: Fluid, time: float) -> None:
        """Warn of a wake in the plane that is still its mirror image, although it should shed vortices.

        Args:
            water: the water after a step, with the bodies.
            time: time, for the message [s].
        """
        stream, window = water.border.stream, water.window
        if water.ndim == 3 or len(water.layers) > 1 or window[1] <= window[0] or np.count_nonzero(stream) != 1:
            return
        axis, speed = int(np.abs(stream).argmax()), length(stream)
        margin = 2 * MEAN_WINDOW_MARGIN
        lengths = [window[2 * d + 1] - window[2 * d] - margin for d in (1, 0)]
        width = lengths[1 - axis]
        reynolds, travel = self._reynolds(water, width), speed * time / (width * water.grid.cell)
        if lengths[axis] > MAX_BLUNT_LENGTH * width or reynolds <= MIN_STREET_RE or travel < MIN_STREET_TRAVEL:
            return
        inner = slice(PAD + 1, -PAD)
        along = water.velocity[axis].T if axis == 1 else water.velocity[axis]
        across = water.velocity[1 - axis].T if axis == 1 else water.velocity[1 - axis]
        along, across = along[PAD:-PAD, inner], across[inner, inner]  # rows across the stream
        asymmetry = max(float(np.abs(along - along[::-1]).max()), float(np.abs(across + across[::-1]).max())) / speed
        if asymmetry < MAX_SYMMETRIC_DIFFERENCE:
            self._say(
                "symmetry",
                f"at t = {time:.4g} s the wake at Reynolds number {reynolds:.3g} is still its mirror image, to "
                f"{asymmetry:.2g} of the stream's speed, after {travel:.3g} widths of travel. It would shed vortices, "
                f"and forces are those before it does. Give Setup(perturb=0.2), or run much longer.",
            )

    def inputs(self) -> None:
        """Warn of inputs that are possible and probably not meant."""
        for text in implausible_inputs(self.setup):
            self._say(text, text)
        self.headings(0.0)

    def headings(self, time: float) -> None:
        """Warn of midlines whose headings are not their directions, at a time [s]."""
        for body in self.setup.bodies:
            text = heading_text(body, time)
            if text is not None:
                self._say(f"heading {body.name}", text)

    def _reynolds(self, water: Fluid, width: float) -> float:
        """Return the Reynolds number of the far stream past bodies of a width in cells [-]."""
        return length(water.border.stream) * width * water.grid.cell / self.setup.viscosity

    def _say(self, key: str, message: str | Doubtful) -> None:
        """Issue a warning once for each key."""
        if key not in self._issued_keys:
            self._issued_keys.add(key)
            warn(message if isinstance(message, Doubtful) else Doubtful(message), stacklevel=5)
