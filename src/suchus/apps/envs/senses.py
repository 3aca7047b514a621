"""The observations of the environments, which are those of ``suchus.robot.control.observation``."""

from suchus.robot.control.observation import (
    BASIC_READINGS,
    GOAL_READINGS,
    SENSES,
    Observer,
    Sense,
    decode_observations,
    is_crank,
    reading_columns,
    senses,
)

__all__ = [
    "BASIC_READINGS",
    "GOAL_READINGS",
    "SENSES",
    "Observer",
    "Sense",
    "decode_observations",
    "is_crank",
    "reading_columns",
    "senses",
]
