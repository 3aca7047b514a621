"""What is to be simulated: grid, water, sides and bodies, checked before anything runs."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite, sqrt
from typing import Literal

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.body import Body, thin_share, window_of
from suchus.flow.free import FreeBody, Swimmer
from suchus.flow.grid import Grid, check_kinds
from suchus.flow.shape import Markers
from suchus.flow.sides import Sides

LAYER_CELLS = 0.7
"""Fewest cells across a boundary layer of thickness L / sqrt(Re) [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """A flow to be simulated.

    Raises:
        InvalidDesign: on creation, for values that cannot be or that the grid cannot carry.
    """

    grid: Grid
    """The cells."""
    viscosity: float
    """Kinematic viscosity of the water [m^2/s]."""
    density: float = 1000.0
    """Density of the water [kg/m^3]."""
    stream: tuple[float, float] | Callable[[float], tuple[float, float]] = (0.0, 0.0)
    """Velocity of the far water, fixed or for every time [m/s]."""
    sides: Sides = field(default_factory=Sides)
    """What happens on the sides of the domain."""
    bodies: tuple[Body | FreeBody, ...] = ()
    """The bodies in the water."""
    follow: str | None = None
    """Name of the body whose centre the grid travels with; None keeps the grid where it is."""
    follow_axes: tuple[bool, bool] = (True, True)
    """Whether the grid travels along x and along y."""
    courant: float = 0.8
    """Share of a cell that the water may cross in one step [-]."""
    step: float | None = None
    """Fixed time step, or None to choose it from ``courant`` [s]."""
    tolerance: float = 1e-5
    """Mean divergence left over, in fastest speed per cell; the largest may be ten times that [-]."""
    precision: Literal["single", "double"] = "single"
    """Precision of the fields; sums are always double."""
    coarse: bool = False
    """Whether a Reynolds number that the grid cannot carry is let through."""

    def __post_init__(self) -> None:
        check_kinds(self)
        for name in ("viscosity", "density", "tolerance"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InvalidDesign(f"{name} is {value}; a positive number is needed.")
        if not 0 < self.courant <= 1:
            raise InvalidDesign(f"courant is {self.courant}; above 1 the time stepping explodes. Give 0 to 1, say 0.8.")
        if not callable(self.stream) and not all(isfinite(part) for part in self.stream):
            raise InvalidDesign(f"stream is {self.stream} m/s; two finite numbers are needed.")
        if self.step is not None and not (isfinite(self.step) and self.step > 0):
            raise InvalidDesign(f"step is {self.step} s; a time step is positive. Give None to let the solver choose.")
        if self.precision not in ("single", "double"):
            raise InvalidDesign(f"precision is {self.precision!r}; there is 'single' and 'double'.")
        if self.precision == "single" and self.tolerance < 5e-7:
            raise InvalidDesign(
                f"tolerance {self.tolerance} is below what single precision resolves (5e-7); take precision='double'."
            )
        names = [b.name for b in self.bodies]
        if len(set(names)) != len(names):
            raise InvalidDesign(f"bodies are named {names}; give each its own name.")
        if self.follow is not None and self.follow not in names:
            raise InvalidDesign(f"the grid is to follow {self.follow!r}, and the bodies are named {names}.")

    @property
    def dtype(self) -> type:
        """Type of the fields."""
        return np.float32 if self.precision == "single" else np.float64

    def far(self, time: float) -> tuple[float, float]:
        """Return the velocity of the far water at a time [m/s]."""
        return self.stream(time) if callable(self.stream) else self.stream

    def check(self) -> dict[str, float]:
        """Return, per body, the share of its length that is too thin for the grid.

        Raises:
            InvalidDesign: a body outside the domain, too thin everywhere, or a Reynolds number that the grid
                cannot carry.
        """
        thin = {}
        for body in self.bodies:
            pose = body.pose(0.0) if isinstance(body, Body) else Swimmer.of(body).pose(body.shape.mass(0.0))
            window_of(body, pose, self.grid, 0.0)
            thin[body.name] = thin_share(body, self.grid, 0.0)
            self.check_layer(body, body.shape.markers(0.0, pose, self.grid.cell), self.far(0.0), 0.0)
        return thin

    def check_layer(
        self, body: Body | FreeBody, markers: Markers, stream: tuple[float, float], time: float, *, slack: float = 1.0
    ) -> None:
        """Refuse a body so fast that the grid does not carry its boundary layer.

        Args:
            body: the body.
            markers: its outline at that time.
            stream: velocity of the far water, in the frame of the markers [m/s].
            time: when [s].
            slack: factor on the speed that is let through [-].

        Raises:
            InvalidDesign: naming the cell that would carry it.
        """
        length = max(float(np.ptp(markers.x)), float(np.ptp(markers.y)))
        speed = float(np.hypot(markers.velocity_x - stream[0], markers.velocity_y - stream[1]).max())
        reynolds = speed * length / self.viscosity
        if self.coarse or reynolds < 1 or length / sqrt(reynolds / slack) >= LAYER_CELLS * self.grid.cell:
            return
        layer = length / sqrt(reynolds)
        raise InvalidDesign(
            f"at t = {time:.4g} s and Reynolds number {reynolds:.4g} the boundary layer of {body.name} is {layer:.3g} "
            f"m thin, and a cell is {self.grid.cell:.3g} m; take cells of at most {layer / LAYER_CELLS:.3g} m, a lower "
            f"Reynolds number, or coarse=True to go on anyway."
        )
