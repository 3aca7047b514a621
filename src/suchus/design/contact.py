"""How the body meets the ground."""

from dataclasses import dataclass

from suchus.design.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Coulomb friction and softness of the robot's surfaces; the ground adds nothing of its own."""

    foot_friction: float
    """Friction coefficient of the feet [-]."""
    skin_friction: float
    """Friction coefficient of belly, head and tail [-]."""
    time_constant: float
    """How fast penetration is corrected, MuJoCo's ``solref[0]`` [s]."""

    def __post_init__(self) -> None:
        with Checks("contact", self) as check:
            check.number("foot_friction", 0.01, 3.0, "")
            check.number("skin_friction", 0.01, 3.0, "")
            check.number("time_constant", 0.004, 0.2, "s")
