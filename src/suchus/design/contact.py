"""How the body meets the ground."""

from dataclasses import dataclass

from suchus.design.checks import require


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
        require("contact", "foot_friction", self.foot_friction, 0.01, 3.0, "")
        require("contact", "skin_friction", self.skin_friction, 0.01, 3.0, "")
        require("contact", "time_constant", self.time_constant, 0.004, 0.2, "s")
