"""Measure what single pages of the documentation state and no experiment does, each source by a function of its own."""

import re
from collections.abc import Callable, Mapping
from math import radians
from typing import Any

import numpy as np

from suchus import swim
from suchus.core.errors import InvalidDesign
from suchus.flow.setup import MIN_LAYER_CELLS
from suchus.robot.control.standing import BALANCE, Standing
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.motion.rising import max_snout_height, stand_up
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate
from suchus.sim.metrics.reach import lead
from suchus.swimming.water import ExactWave, Outline, fit, printed_wave, undulation, with_passive_end
from suchus.swimming.water.resolved import SwimSetting, resolved_swim

ROBOT = ROBOTS["caiman"]
FREQUENCY = 1.0
"""Of the swims [Hz]."""
TOWARDS_TAIL, TOWARDS_HEAD = -1, 1
"""Signs of (20): a wave that runs to the tail, and the wave as printed."""
REAL_WATER = 1e-6
"""Kinematic viscosity of water [m^2/s]."""
PASSIVE_SPEED = 0.2
"""Speed at which the passive end is bent [m/s]."""
LEADS = 0.05, 0.08
"""Distances of the centre of mass behind the feet whose heights are compared [m]."""
STAND_SLOPE = 8.0
"""Slope on which the robot stands, down ahead [degrees]."""
PRINTED_GRIDS = (300.0, 48), (3000.0, 48)
"""Reynolds number f L^2 / nu and cells per body length of swims with the wave as printed."""
PRINTED_CYCLES = 6
"""Cycles of these swims, of which the last is measured [-]."""


def _joints(sign: int) -> Gait:
    """Return the motion of the joints that comes nearest to (20) in reading I."""
    return fit(ROBOT, printed_wave(ROBOT, "I", sign=sign)).gait


def real_water() -> dict[str, float]:
    """Return what the solver asks of a grid for a swim in real water, as its refusal says.

    Returns:
        ``layer`` [m], the thickness of the boundary layer; ``cells`` per body length; ``count``, all cells; ``hours``
        of processor time for six cycles [h]; ``layer_cells``, the cells across the layer.
    """
    try:
        resolved_swim(ROBOT, _joints(TOWARDS_TAIL), SwimSetting(axes=3, cells=96, viscosity=REAL_WATER, cycles=6))
    except InvalidDesign as refusal:
        pattern = r"is ([\d.]+) m thin .* least (\d+) cells .*, (\d+) million cells .* some (\d+) hours"
        match = re.search(pattern, str(refusal))
    assert match
    layer, cells, millions, hours = map(float, match.groups())
    return {"layer": layer, "cells": cells, "count": 1e6 * millions, "hours": hours, "layer_cells": MIN_LAYER_CELLS}


def passive_end() -> dict[str, float]:
    """Return how far the passive end of the tail bends, and by which fraction that changes the speeds.

    Returns:
        ``bend`` [rad], the amplitude of the tip's heading against a straight end; ``resistive`` and ``reactive``, the
        changes of speed [-].
    """
    motion, outline = _joints(TOWARDS_TAIL), Outline(ROBOT)
    bent = with_passive_end(outline, motion, PASSIVE_SPEED)
    tip = bent.stations[1][-1] - undulation(outline, motion).stations[1][-1]
    change = swim(ROBOT, bent).speed / swim(ROBOT, motion).speed - 1.0
    return {"bend": float(abs(tip)), **{str(model): float(change.sel(model=model)) for model in change.model.values}}


def rising() -> dict[str, float]:
    """Return lengths of the rising, and what a lead costs of the greatest height.

    Returns:
        ``feet_past_mass`` and ``mass_behind_cobra`` [m], distances of feet and centre of mass; ``lead_low`` and
        ``lead_high`` [m], the distances of the centre of mass behind the feet whose greatest heights differ by
        ``height_of_lead`` [m].
    """
    _, swung, _, cobra, *_ = stand_up(ROBOT).postures
    heights = max_snout_height(ROBOT, np.array(LEADS))
    return {
        "feet_past_mass": swung.lead,
        "mass_behind_cobra": cobra.lead,
        "lead_low": LEADS[0],
        "lead_high": LEADS[1],
        "height_of_lead": float(heights[0] - heights[1]),
    }


def standing_feedback() -> dict[str, float]:
    """Return where the centre of mass lies while the robot stands on ground that slopes down ahead.

    Returns:
        ``slope`` [rad]; ``behind_off`` and ``behind_on`` [m], the median distance of the centre of mass behind the feet
        without feedback and with it.
    """
    slope, behind = radians(STAND_SLOPE), {}
    for name, balance in (("off", None), ("on", BALANCE)):
        control = Standing(at=1.0, hold=20.0, balance=balance)
        run = Run(robot=ROBOT, gait=GAITS["belly_crawl"], control=control, ground=Ground(uphill=-slope))
        until = control.upright_until(ROBOT)
        record = simulate([run], duration=until, timestep=0.005, sample_stride=5)
        behind[name] = float(lead(record).isel(run=0).sel(time=slice(control.upright_from(ROBOT), until)).median())
    return {"slope": slope, **{f"behind_{name}": distance for name, distance in behind.items()}}


def printed_direction() -> dict[str, Any]:
    """Return the speeds of plane swims by the wave as printed and by the wave that runs to the tail.

    Returns:
        ``cycles``; ``rows``, each with ``reynolds``, ``cells`` and the speeds in the last cycle [m/s]: ``exact`` of the
        curve as printed, ``joints`` of what the joints make of it, ``to_tail`` of the joints with the wave mended.
    """
    exact = ExactWave(name="as printed", wave=printed_wave(ROBOT, "I", frequency=FREQUENCY, sign=TOWARDS_HEAD))
    motions = {"exact": exact, "joints": _joints(TOWARDS_HEAD), "to_tail": _joints(TOWARDS_TAIL)}
    rows = []
    for reynolds, cells in PRINTED_GRIDS:
        viscosity = FREQUENCY * ROBOT.length**2 / reynolds
        setting = SwimSetting(cells=cells, viscosity=viscosity, cycles=PRINTED_CYCLES)
        speeds = {name: float(resolved_swim(ROBOT, motion, setting).speed[-1]) for name, motion in motions.items()}
        rows.append({"reynolds": reynolds, "cells": cells, **speeds})
    return {"cycles": PRINTED_CYCLES, "rows": rows}


SOURCES: Mapping[str, Callable[[], Mapping[str, Any]]] = {
    "real_water": real_water,
    "passive_end": passive_end,
    "rising": rising,
    "standing_feedback": standing_feedback,
    "printed_direction": printed_direction,
}
"""What measures each source."""
