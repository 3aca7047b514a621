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
    """Time constant of the correction of penetration, MuJoCo's ``solref[0]`` [s]."""
    torsion: float = 0.005
    """Torsional friction over the sliding one [m]; 5 thousandths of a body length."""
    rolling: float = 0.0001
    """Rolling friction over the sliding one [m]; a ten-thousandth of a body length."""
    depth: float = 0.001
    """Penetration over which the contact stiffens, MuJoCo's ``solimp[2]`` [m]; a thousandth of a body length."""

    def __post_init__(self) -> None:
        with Checks("contact", self) as check:
            check.number("foot_friction", 0.01, 3.0, "")
            check.number("skin_friction", 0.01, 3.0, "")
            check.number("time_constant", 1e-4, 1.0, "s")
            for field in ("torsion", "rolling", "depth"):
                check.number(field, 0.0, 1.0, "m")
