"""The shelf of arenas: grounds by name."""

from collections.abc import Mapping
from math import radians
from types import MappingProxyType

from suchus.design.ground import Bumps, Ground, Step, Stone

BEFORE = 0.42
"""Where bumps begin, ahead of the hips at the start [m]: just ahead of the front feet."""
STONE = Stone(at=0.75, aside=0.0, height=0.05, length=0.06, width=0.05)
"""A stone that fits between the feet."""

ARENAS: Mapping[str, Ground] = MappingProxyType(
    {
        "flat": Ground(),
        "uphill": Ground(uphill=radians(10)),
        "downhill": Ground(uphill=radians(-10)),
        "sideways": Ground(sideways=radians(10)),
        "step": Ground(relief=Step(at=0.66, height=0.02)),
        "stone": Ground(relief=STONE),
        "bumps": Ground(relief=Bumps(height=0.03, correlation=0.06, start=BEFORE, seed=0)),
    }
)
"""Grounds by name; vary one with ``dataclasses.replace``."""
