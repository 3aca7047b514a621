"""Swims by the numbers of a crocodile's lateral servos: three yaw joints from the pelvis forward, the tail's cable."""

from suchus.robot.motion import LIMBS_BACK, LIMBS_UP, Gait, swimming_gait
from suchus.robot.robots import ROBOTS


def crocodile_swim(  # as many as the article's numbers
    *,
    frequency: float = 1.0,
    yaw: tuple[float, float, float] = (0.36, 0.13, 0.11),
    yaw_lag: tuple[float, float, float] = (0.08, -0.11, -0.29),
    tail: float = 0.75,
    tail_lag: float = -0.11,
    limbs: tuple[float, float] = LIMBS_BACK,
) -> Gait:
    """Return a swim whose trunk bends left, and whose tail bends right, where its angles are positive [rad]."""
    left = tail_lag + 0.5 if tail_lag <= 0.0 else tail_lag - 0.5
    return swimming_gait(
        ROBOTS["caiman"],
        name="wave",
        frequency=frequency,
        amplitude=(*yaw, tail),
        lag=(*yaw_lag, left),
        limbs=limbs,
    )


__all__ = ["LIMBS_UP", "crocodile_swim"]
