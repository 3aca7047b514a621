"""Water as a value: its density, and what a section of a body feels in it."""

from dataclasses import dataclass

from suchus.core.checks import Checks
from suchus.core.physics import WATER_DENSITY


@dataclass(frozen=True, slots=True, kw_only=True)
class Water:
    """Still water, and what a section of the body feels in it."""

    density: float = WATER_DENSITY
    """[kg/m3]."""
    viscosity: float = 1e-6
    """Kinematic viscosity [m2/s]."""
    cross_drag: float = 1.1
    """Drag coefficient of a section that moves sideways [-]; round cylinders have 1.0 to 1.2 at Re 1e3 to 1e5."""
    thickening: float = 3.0
    """Factor of a swimming body's friction over a flat plate's [-]; bending thins the boundary layer, 2 to 5 are
    reported."""

    def __post_init__(self) -> None:
        with Checks("water", self) as check:
            check.number("density", 1.0, 2e4, "kg/m3")
            check.number("viscosity", 1e-9, 1.0, "m2/s")
            check.number("cross_drag", 0.0, 10.0, "")
            check.number("thickening", 0.0, 100.0, "")

    def friction(self, speed: float, length: float) -> float:
        """Return the coefficient of friction of a laminar or turbulent plate, whichever rubs more, thickened [-].

        Args:
            speed: [m/s].
            length: length of the body [m].

        Source: Blasius 1908; Prandtl's 0.074 Re^(-1/5).
        """
        reynolds = max(speed * length / self.viscosity, 1.0)
        return float(self.thickening * max(1.328 * reynolds**-0.5, 0.074 * reynolds**-0.2 * (reynolds > 5e5)))
