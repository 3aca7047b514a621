"""How far the water of the runs is from a flow in three dimensions, and the coefficients that come nearest to it.

What a body feels whose motion is given is linear in three coefficients: the drag coefficient across, the factor on
plate friction along, the factor on added mass. So a flow around the same motion gives them by least squares.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from suchus.core.checks import Schedule
from suchus.robot.design import Robot
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait
from suchus.sim.land.lake import Lake
from suchus.sim.land.prescribed import held_sections

QUANTITIES = ("thrust", "aside", "power")
"""What is compared over a cycle."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WaterCoefficients:
    """What the section model of the runs makes of the water."""

    cross_drag: float = Water().cross_drag
    """Drag coefficient of a section across [-]."""
    thickening: float = Water().thickening
    """Factor on plate friction along [-]."""
    added_mass: float = 1.0
    """Factor on added mass [-]."""

    def lake(self, viscosity: float, level: Schedule = 0.0) -> Lake:
        """Return water of a viscosity [m2/s] with these coefficients, its surface at a level [m]."""
        water = Water(viscosity=viscosity, cross_drag=self.cross_drag, thickening=self.thickening)
        return Lake(level=level, water=water, added_mass=self.added_mass)


NAMES = tuple(field.name for field in fields(WaterCoefficients))
"""Names of the coefficients."""


def responses(
    robot: Robot, gait: Gait, viscosity: float, *, sway: complex = 0j, turn: complex = 0j
) -> Mapping[str, xr.Dataset]:
    """Return what each of ``WaterCoefficients`` does by one unit of it, and what is left without them, as ``rest``.

    Args:
        robot: whose body, limbs left out.
        gait: in which it swims.
        viscosity: of the water [m2/s].
        sway: see ``held_sections`` [m].
        turn: see ``held_sections`` [rad].
    """

    def response(**unit: float) -> xr.Dataset:
        lake = WaterCoefficients(**({"cross_drag": 0.0, "thickening": 0.0, "added_mass": 0.0} | unit)).lake(viscosity)
        return held_sections(robot, gait, lake, sway=sway, turn=turn)

    rest = response()
    return {"rest": rest, **{name: response(**{name: 1.0}) - rest for name in NAMES}}


def composed(parts: Mapping[str, xr.Dataset], coefficients: WaterCoefficients) -> xr.Dataset:
    """Return what a body feels with coefficients, from ``responses``."""
    load = parts["rest"]
    for name in NAMES:
        load = load + getattr(coefficients, name) * parts[name]
    return load


def fitted(flow: xr.Dataset, parts: Mapping[str, xr.Dataset], names: Sequence[str]) -> WaterCoefficients:
    """Return the coefficients with which the model comes nearest to a flow; those that are not named stay.

    Thrust, side force and power count alike, each over its peak in the flow.

    Args:
        flow: ``thrust``, ``aside`` and ``power`` over ``phase``.
        parts: of ``responses`` to the same motion.
        names: of the coefficients that are fitted.
    """
    others = WaterCoefficients(**dict.fromkeys(names, 0.0))
    peaks = {name: float(np.abs(flow[name]).max()) for name in QUANTITIES}

    def row(load: xr.Dataset) -> np.ndarray:
        return np.concatenate([load[name].values / peaks[name] for name in QUANTITIES])

    columns = np.column_stack([row(parts[name]) for name in names])
    values = np.linalg.lstsq(columns, row(flow) - row(composed(parts, others)), rcond=None)[0]
    return WaterCoefficients(**{name: float(value) for name, value in zip(names, values, strict=True)})


def left(flow: xr.Dataset, model: xr.Dataset) -> dict[str, float]:
    """Return the rms of the flow less the model over a cycle, over the peak in the flow, by quantity [-]."""
    return {
        name: float(np.sqrt(np.mean((flow[name].values - model[name].values) ** 2)) / np.abs(flow[name].values).max())
        for name in QUANTITIES
    }
