"""What the experiment ``swim_3d`` keeps of its swims, and every number that it reads from them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

import numpy as np
import xarray as xr

from suchus.design import GRAVITY, Robot
from suchus.design.water import Water
from suchus.experiment import Measure
from suchus.experiments._taken import TAKEN, TakenMidline

WHOLE = "trunk and tail"
"""The motion that the others are compared with."""
LIMBS = "limbs folded"
"""The same with the limbs in the water."""


class Swim3dParameters(Protocol):
    """What the experiment is asked: its fields that lay out the record."""

    @property
    def cells(self) -> tuple[int, ...]:
        """Cells per body length of the grids [-]."""

    @property
    def compared_cells(self) -> int:
        """Cells per body length where motions and tails are compared [-]."""

    @property
    def compared_cycles(self) -> int:
        """Cycles of these [-]."""

    @property
    def tail_heights(self) -> tuple[float, ...]:
        """Heights of the raised tails [m]."""

    @property
    def reynolds(self) -> float:
        """Frequency times length squared over viscosity [-]."""


def record(swims: Mapping[str, xr.Dataset], beside: xr.Dataset, asked: Swim3dParameters) -> xr.Dataset:
    """Return the record of the experiment from the swims by name, and what slice and models say."""
    grids = [swims[f"{cells} cells"] for cells in asked.cells]
    whole = swims.get("compared", swims.get(f"{asked.compared_cells} cells"))
    assert whole is not None
    names = [name for name in ("trunk only", "tail only", "as printed", LIMBS, *TAKEN) if name in swims]
    tails = {f"tail {high:g} m": high for high in asked.tail_heights}
    compared = {WHOLE: whole, **{name: swims[name] for name in (*names, *tails)}}
    finest = grids[-1].drop_vars(("speed", "thrust", "power", "steps", "million_cells", "thin", "cycle"))
    n, held = asked.compared_cycles, swims["held"]
    speeds, powers = ([one[name].values[:n] for one in compared.values()] for name in ("speed", "power"))
    data = xr.Dataset(
        {
            **{name: (("grid", "cycle"), [one[name].values for one in grids], grids[0][name].attrs)
               for name in ("speed", "thrust", "power")},
            **{name: ("grid", [float(one[name]) for one in grids], grids[0][name].attrs)
               for name in ("steps", "million_cells", "thin")},
            "compared_speed": (("compared", "compared_cycle"), speeds, {"units": "m/s"}),
            "compared_power": (("compared", "compared_cycle"), powers, {"units": "W"}),
            "tail_height": ("compared", [tails.get(name, 0.0) for name in compared], {"units": "m"}),
            "weight_compared": ("compared", [float(one.weight) for one in compared.values()], {"units": "N"}),
            "held_thrust": ((), float(held.thrust[-1]), {"units": "N"}),
            "held_power": ((), float(held.power[-1]), {"units": "W"}),
            "compared_cells": ((), float(asked.compared_cells), {"units": "1"}),
            "reynolds": ((), asked.reynolds, {"units": "1"}),
        },
        coords={"cells": ("grid", list(asked.cells)), "compared": list(compared),
                "cycle": grids[0].cycle.values, "compared_cycle": np.arange(1, n + 1)},
    )  # fmt: skip
    return data.merge(finest).merge(beside)


def with_midlines(beside: xr.Dataset, bent: Sequence[TakenMidline]) -> xr.Dataset:
    """Return what stands beside the swims, with how far the midlines that the joints took are off, if there are any."""
    if not bent:
        return beside
    away = ("taken_arm", [one.away for one in bent], {"units": "1", "long_name": "rms angle off, over that commanded"})
    return beside.assign(taken_away=away).assign_coords(taken_arm=[one.name for one in bent])


def measures(record: xr.Dataset, robot: Robot, frequency: float) -> Mapping[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened.
        robot: who swam.
        frequency: of the wave [Hz].
    """
    return {
        **dict(_body(record, robot, frequency)),
        **dict(_grids(record)),
        **dict(_beside(record)),
        **dict(_compared(record)),
        **dict(_loads(record)),
    }


def _body(record: xr.Dataset, robot: Robot, frequency: float) -> Iterator[tuple[str, Measure]]:
    speeds, power = record.speed.values[-1], float(record.power[-1, -1])
    speed, weight = float(speeds[-1]), float(record.weight)
    yield "reynolds", Measure(float(record.reynolds), "-")
    real = frequency * robot.length**2 / Water().viscosity
    yield "reynolds_real_water", Measure(real, "-")
    yield "reynolds_of_speed", Measure(float(record.reynolds) * abs(speed) / (frequency * robot.length), "-")
    yield "cells_per_length", Measure(float(record.cells[-1]), "-")
    yield "cycles", Measure(float(record.sizes["cycle"]), "-")
    yield "mass", Measure(weight / GRAVITY, "kg")
    yield "speed", Measure(speed, "m/s")
    yield "speed_lengths", Measure(speed / robot.length, "1/s")
    yield "speed_gain", Measure(_gain(speeds), "-")
    yield "power", Measure(power, "W")
    yield "cost_of_transport", Measure(power / (weight * abs(speed)), "-")
    yield "strouhal", Measure(frequency * float(record["swing"]) / abs(speed), "-")
    yield "slip", Measure(speed / float(record.wave_speed), "-")
    yield "head_yaw", Measure(float(record.head_yaw), "rad")
    yield "thrust_held", Measure(float(record.held_thrust), "N")
    yield "power_held", Measure(float(record.held_power), "W")


def _grids(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    for i, cells in enumerate(record.cells.values):
        yield f"speed_{cells}_cells", Measure(float(record.speed[i, -1]), "m/s")
        yield f"power_{cells}_cells", Measure(float(record.power[i, -1]), "W")
        yield f"thin_share_{cells}_cells", Measure(float(record["thin"][i]), "-")
    if record.sizes["grid"] > 1:
        last, power = record.speed.values[-2:, -1], record.power.values[-2:, -1]
        yield "speed_over_grids", Measure(float(last[1] / last[0] - 1.0), "-")
        yield "power_over_grids", Measure(float(power[1] / power[0] - 1.0), "-")


def _beside(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    plane, speed = float(record.slice_speed[-1]), float(record.speed[-1, -1])
    yield "speed_slice", Measure(plane, "m/s")
    yield "slice_over_body", Measure(plane / speed, "-")
    for model in record.model.values:
        one = record.sel(model=model)
        yield f"speed_{model}", Measure(float(one.model_speed), "m/s")
        yield f"power_{model}", Measure(float(one.model_power), "W")
        yield f"thrust_held_{model}", Measure(float(one.model_thrust), "N")
        yield f"speed_{model}_real_water", Measure(float(one.real_model_speed), "m/s")


def _compared(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    for name in record.compared.values:
        one, key = record.sel(compared=name), _key(str(name))
        speed, power = one.compared_speed.values, float(one.compared_power[-1])
        yield f"speed_{key}", Measure(float(speed[-1]), "m/s")
        yield f"speed_gain_{key}", Measure(_gain(speed), "-")
        yield f"power_{key}", Measure(power, "W")
        yield f"cost_of_transport_{key}", Measure(power / (float(one.weight_compared) * abs(float(speed[-1]))), "-")
    for name in record.taken_arm.values if "taken_away" in record else ():
        yield f"misfit_{_key(str(name))}", Measure(float(record.taken_away.sel(taken_arm=name)), "-")


def _gain(speeds: np.ndarray) -> float:
    """Return by how much the last cycle is faster than the one before; NaN where that stood still [-]."""
    return float(speeds[-1] / speeds[-2] - 1.0) if speeds[-2] != 0.0 else float("nan")


def _key(name: str) -> str:
    return name.replace(" m", "").replace(" ", "_").replace(".", "_")


def _loads(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    for servo in record.servo.values:
        one = record.sel(servo=servo)
        yield f"servo_load_peak_{servo}", Measure(float(abs(one.servo_torque).max() / one.servo_limit), "-")
