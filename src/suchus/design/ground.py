"""Ground: how it tilts, what stands up from it, how much friction it has."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.design.checks import Checks
from suchus.design.relief import Relief
from suchus.rotation import about, multiply


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """Ground: even or with relief, possibly tilted."""

    friction_scale: float = 1.0
    """Factor on the friction coefficients of all the robot's surfaces [-], 0.01 to 10."""
    uphill: float = 0.0
    """Slope along the walk, up positive [rad], -1 to 1."""
    sideways: float = 0.0
    """Slope across the walk, left side up positive [rad], -1 to 1."""
    relief: Relief | None = None
    """Step, stone or bumps on it; None where it is even."""

    def __post_init__(self) -> None:
        with Checks("ground", self) as check:
            check.number("friction_scale", 0.01, 10.0, "")
            check.number("uphill", -1.0, 1.0, "rad")
            check.number("sideways", -1.0, 1.0, "rad")

    def looks_like(self, other: "Ground") -> bool:
        """Return whether another ground has the same slopes and relief, whatever its friction."""
        return (self.uphill, self.sideways, self.relief) == (other.uphill, other.sideways, other.relief)


def slope(uphill: float, sideways: float) -> Float[np.ndarray, "4"]:
    """Return the orientation wxyz in which a ground with these slopes is seen, gravity pointing down.

    Args:
        uphill: along the walk, up positive [rad].
        sideways: left side up positive [rad].
    """
    up, aside = about(np.array([0.0, 1.0, 0.0]), -uphill), about(np.array([1.0, 0.0, 0.0]), sideways)
    return multiply(up, aside)
