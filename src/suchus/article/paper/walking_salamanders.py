"""Published numbers of walking salamanders, with which those of a run are compared."""

from collections.abc import Mapping
from math import nan
from typing import NamedTuple


class AnimalValue(NamedTuple):
    """A number of the animal."""

    value: float
    """In ``unit``."""
    spread: float
    """Standard deviation over trials, in ``unit``; NaN where none is published."""
    unit: str
    """``-`` for none."""
    source: str
    """Publication, or the simulation, that it is from."""


_KINEMATICS = "Pleurodeles waltl; Karakasiliotis et al. 2013, Biol. Cybern. 107, 529"
_FORCES = "Ambystoma tigrinum; computed from the public data of Kawano and Blob (FinsAndLimbs/mudskipperKinematics)"


def _force(value: float, spread: float = nan) -> AnimalValue:
    return AnimalValue(value, spread, "body weight", _FORCES)


ANIMAL: Mapping[str, AnimalValue] = {
    "standing_index_walk": AnimalValue(0.91, nan, "-", _KINEMATICS),
    "foot_force_peak_fore": _force(0.447),
    "foot_force_peak_hind": _force(0.439),
    "foot_force_net_fore": _force(0.457, 0.063),
    "foot_force_net_hind": _force(0.479, 0.070),
    "foot_force_sideways_fore": _force(0.068),
    "foot_force_sideways_hind": _force(0.071),
    "foot_force_foreaft_fore": _force(-0.028),
    "foot_force_foreaft_hind": _force(0.151),
    "foot_force_time_fore": AnimalValue(0.61, nan, "stance", _FORCES),
    "foot_force_time_hind": AnimalValue(0.33, nan, "stance", _FORCES),
}
"""Numbers of the animals by the names of the measures beside which they stand.

Forces are those at the instant of the greatest net force on one foot, means over 50 (fore) and 48 (hind) trials.
"""
