"""The two girdles and the head."""

from dataclasses import dataclass

from suchus.design.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class Pelvis:
    """The hind girdle, frame 0 of the spine; it holds battery and electronics."""

    mass: float
    """[kg]."""
    length: float
    """Length along the body [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""

    def __post_init__(self) -> None:
        with Checks("pelvis", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            for field in ("length", "width", "height"):
                check.number(field, 1e-5, 10.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Thorax:
    """The front girdle, rigid with the last frame of the spine."""

    mass: float
    """[kg]."""
    shoulder: float
    """Distance from the last spine joint forward to the front girdle's axis [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""

    @property
    def half(self) -> tuple[float, float, float]:
        """Half axes of its ellipsoid: length, width, height [m]; it reaches a little beyond joint and shoulders."""
        return max(self.shoulder, 0.02) + 0.012, self.width / 2, self.height / 2

    def __post_init__(self) -> None:
        with Checks("thorax", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            check.number("shoulder", 0.0, 10.0, "m")
            for field in ("width", "height"):
                check.number(field, 1e-5, 10.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """The head, rigid with the thorax."""

    mass: float
    """[kg]."""
    snout: float
    """Distance from the last spine joint forward to the tip of the snout [m]."""
    width: float
    """Width at the jaw joint [m]."""
    height: float
    """Height at the jaw joint [m]."""

    def __post_init__(self) -> None:
        with Checks("head", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            check.number("snout", 1e-4, 20.0, "m")
            for field in ("width", "height"):
                check.number(field, 1e-5, 10.0, "m")
