"""The schema of a record: the variables of a run, their dimensions and units."""

from suchus.sim.record.schema import (
    BUS_VARIABLES,
    COUPLED,
    EFFORT,
    ELECTRICAL,
    HEAT,
    PER_RUN,
    VARIABLES,
    WATER,
    check_land,
    dataset,
    ground_of,
    ground_text,
)

__all__ = [
    "BUS_VARIABLES",
    "COUPLED",
    "EFFORT",
    "ELECTRICAL",
    "HEAT",
    "PER_RUN",
    "VARIABLES",
    "WATER",
    "check_land",
    "dataset",
    "ground_of",
    "ground_text",
]
