"""What a file says of the drive of a hinge."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """What moves a hinge, as far as the file says."""

    torque: float | None
    """Greatest torque [N m]; None if not said."""
    speed: float | None
    """Greatest speed [rad/s]; None if not said."""
    passive: bool
    """Whether nothing drives it."""
