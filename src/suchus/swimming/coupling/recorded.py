"""Quantities that are stored in every step of a coupled run, and the record of the run."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields

import numpy as np
import xarray as xr

from suchus.sim.land.run import Run
from suchus.sim.record import COUPLED, WATER
from suchus.swimming.coupling.chain import MidlineChain
from suchus.swimming.coupling.linked import LinkChain

_STATE_KEYS = {"work": "worked"}
"""Names in a checkpoint of the fields of ``Series`` that have another name there."""


@dataclass(slots=True)
class Series:
    """Quantities that are stored in every step."""

    time: list[float] = field(default_factory=list)
    """End of the step [s]."""
    force: list[np.ndarray] = field(default_factory=list)
    """Generalised force of the water on each coordinate of the robot: its place, heading and joints [N, N m]."""
    links: list[np.ndarray] = field(default_factory=list)
    """Force in the world and torque about the vertical through the link's middle, of each, shape (link, 4) [N, N m]."""
    residual: list[tuple[float, float]] = field(default_factory=list)
    """Force left over, before and after the corrections, over the greatest so far [-]."""
    corrections: list[int] = field(default_factory=list)
    """Corrections made [-]."""
    work: list[tuple[float, float, float, float]] = field(default_factory=list)
    """Work of the servos, of springs, dampers and limits, of the water by force and way, and of it by the flow's own
    account [J]."""
    energy: list[float] = field(default_factory=list)
    """Kinetic energy of the robot [J]."""
    radius: list[tuple[float, float]] = field(default_factory=list)
    """Times at which the added mass was computed anew [s], and by how much it then differed: the spectral radius of
    the difference over the whole inertia [-]."""

    def state(self) -> dict[str, np.ndarray]:
        """Return all stored quantities as arrays, by name."""
        names = [series_field.name for series_field in fields(self)]
        return {_STATE_KEYS.get(name, name): np.array(getattr(self, name)) for name in names}

    @classmethod
    def from_state(cls, state: Mapping[str, np.ndarray]) -> "Series":
        """Return the series of a state that ``state`` returned."""
        arrays = ("force", "links")
        field_names = {key: name for name, key in _STATE_KEYS.items()}
        return cls(
            **{
                field_names.get(key, key): list(values) if key in arrays else values.tolist()
                for key, values in state.items()
            }
        )


def coupling_record(
    run: Run, chain: MidlineChain | LinkChain, series: Series, record: xr.Dataset, added_mass: np.ndarray
) -> xr.Dataset:
    """Return the record of a coupled run: the record of the robot, and the forces and errors of the water.

    Args:
        run: of which.
        chain: its midline.
        series: series of every step.
        record: record of the robot alone, of one run.
        added_mass: added mass at the start, in the robot's coordinates.
    """
    values = _sampled(chain, series, record)
    water_variables = {
        name: (("run", *dims), values[name][None], {"units": unit, "long_name": meaning})
        for name, (dims, unit, meaning) in {**WATER, **COUPLED}.items()
    }
    kind = (
        {"solved": type(run.solved_flow).__name__.lower(), **asdict(run.solved_flow)}
        if run.solved_flow is not None
        else {}
    )
    attributes = {"units": "1", "long_name": "the flow as JSON, with its settings"}
    names = list(chain.coordinates)
    inertia = {"units": "kg, kg m, kg m2", "long_name": "added mass at the start, of each coordinate in each"}
    radius = np.array(series.radius).reshape(-1, 2)[:, 1]
    spread = {
        "units": "1",
        "long_name": "by how much the added mass was off when it was computed anew: spectral radius",
    }
    coupled_record = record.assign(
        water_variables
        | {
            "swims_in": ("run", [json.dumps(kind, sort_keys=True)], attributes),
            "added_mass": (("run", "coordinate", "coordinate_too"), added_mass[None], inertia),
            "radius": (("run",), [float(radius.max(initial=0.0))], spread),
        }
    )
    return coupled_record.assign_coords(link=list(chain.names), coordinate=names, coordinate_too=names)


def _sampled(chain: MidlineChain | LinkChain, series: Series, record: xr.Dataset) -> Mapping[str, np.ndarray]:
    """Return the series at the samples of a record; NaN after the end of the run."""
    time = record.time.values.astype(float)
    ends = np.array([0.0, *series.time])
    is_computed = time <= ends[-1] + 1e-9
    steps = np.diff(ends)

    def mean(values: np.ndarray) -> np.ndarray:
        """Return the mean of values over the control period before each sample; the first sample is 0."""
        total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values * _broadcast_steps(steps, values), axis=0)])
        flat = total.reshape(len(total), -1)
        sums = np.column_stack([np.interp(time, ends, column) for column in flat.T])
        rates = np.diff(sums, axis=0) / np.diff(time)[:, None]
        means = np.concatenate([np.zeros_like(rates[:1]), rates]).reshape(len(time), *values.shape[1:])
        means[~is_computed] = np.nan
        return np.asarray(means)

    def latest_value(values: np.ndarray) -> np.ndarray:
        """Return the value of the step that contains each sample."""
        k = np.clip(np.searchsorted(ends, time - 1e-9) - 1, 0, len(values) - 1)
        samples = values[k].astype(float)
        samples[~is_computed] = np.nan
        return np.asarray(samples)

    count = len(series.time)
    if not count:
        sizes = {**record.sizes, "link": len(chain.names), "time": len(time)}
        dims = {name: declaration[0] for name, declaration in {**WATER, **COUPLED}.items()}
        return {name: np.full([sizes[dim] for dim in dimensions], np.nan) for name, dimensions in dims.items()}
    links, force = np.array(series.links), np.array(series.force)
    work, energy = np.array(series.work), np.array(series.energy)
    sums = work.cumsum(axis=0)
    servo_work = np.maximum(np.maximum.accumulate(sums[:, 0]), 1e-300)
    missing = (sums[:, 0] + sums[:, 1] + sums[:, 2] - energy) / servo_work
    power_error = (sums[:, 2] - sums[:, 3]) / np.maximum(np.maximum.accumulate(np.abs(sums[:, 2])), 1e-300)
    hinges = [str(name) for name in record.joint.values]
    moments = np.full((len(time), len(hinges)), np.nan)
    roots = len(chain.coordinates) - len(chain.joints)
    moments[:, [hinges.index(name) for name in chain.joints]] = mean(force[:, roots:])
    flat = np.where(is_computed, 0.0, np.nan)
    pull = mean(links[:, :, :3])
    residual = np.array(series.residual)
    return {
        "link_force": pull,
        "link_torque": mean(links[:, :, 3]),
        "joint_water_torque": moments,
        "coupling_residual": latest_value(residual[:, 1]),
        "coupling_first": latest_value(residual[:, 0]),
        "coupling_iterations": latest_value(np.array(series.corrections)),
        "energy_error": latest_value(missing),
        "power_error": latest_value(power_error),
        "water_level": np.full(len(time), np.nan),
        "air_fraction": np.full(len(time), np.nan),
        "air_fraction_front": np.full(len(time), np.nan),
        "share_under": flat + 1.0,
        "water_force": pull.sum(axis=1),
        "water_power": mean(work[:, 3] / steps),
        "feet_share": flat,
    }


def _broadcast_steps(steps: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the durations of the steps, in a shape that multiplies values of shape (step, ...)."""
    return steps.reshape(-1, *(1,) * (values.ndim - 1))
