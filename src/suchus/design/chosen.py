"""A number that the article does not give, with the reason for ours."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """Why a field holds what it holds, and how far it could plausibly be off."""

    field: str
    """Dotted path of the field from the robot or gait, as ``spine.pitch_servo.torque``."""
    low: float
    """Least plausible value, in the field's unit."""
    high: float
    """Greatest plausible value, in the field's unit."""
    why: str
    """Not in the paper; chosen because of this."""
