"""Samples of the fields around a swimming body: a window of the plane, and vortices in space."""

from typing import Any

import numpy as np
import xarray as xr

from suchus import flow
from suchus.swimming.water.samples import Samples

MIN_FLUID_FRACTION = 0.99
"""Share of the fluid from which a cell counts as outside the body [-]."""
VORTEX = 0.4
"""Second invariant Q on the surfaces that are drawn around vortices, over the square of the frequency [-]."""
TURNS = 10.0
"""Vorticity that the greatest number of ``spin`` stands for, over the frequency [-]."""
LEVEL = 1000
"""Number that stands for ``VORTEX`` in ``vortices`` [-]; what is below a quarter of it is 0."""

COURSE, TICKS = 33, 40
"""Places along the midline whose way to the side is kept of a whole free swim, and instants in a cycle [-]."""
SPINE = (("x", "m"), ("y", "m"), ("heading", "rad"), ("half_width", "m"))
"""Quantities of a midline that are stored, with units."""


class FieldWindow:
    """A window of the grid, whose fields are sampled at the corners of its cells."""

    def __init__(self, grid: flow.Grid, length: float, rear_end: float, half_width: float) -> None:
        """Open a window from a third of a length ahead of the snout.

        Args:
            grid: the cells.
            length: length of the body [m].
            rear_end: end of the window, from the snout [body length].
            half_width: half of its width [body length].
        """
        x, y = grid.x[:-1] + 0.5 * grid.cell, grid.y[:-1] + 0.5 * grid.cell
        columns = np.flatnonzero((x > -0.35 * length) & (x < rear_end * length))
        rows = np.flatnonzero(np.abs(y) < half_width * length)
        self._window = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        self.x, self.y = x[self._window[1]], y[self._window[0]]

    def fields(self, sim: flow.Simulation) -> dict[str, np.ndarray]:
        """Return vorticity, pressure and velocity in the window, all at the corners of the cells.

        The velocity is that of the water in the world, whatever the grid does.
        """
        u, v = sim.velocity
        return {
            "vorticity": sim.vorticity[self._window].astype(np.float32),
            "pressure": self._at_corners(sim.pressure),
            "u": self._at_corners(u + sim.frame[1, 0]),
            "v": self._at_corners(v + sim.frame[1, 1]),
        }

    def _at_corners(self, values: np.ndarray) -> np.ndarray:
        """Return cell values at the corners of the cells within the window."""
        corners = 0.25 * (values[1:, 1:] + values[1:, :-1] + values[:-1, 1:] + values[:-1, :-1])
        return np.asarray(corners[self._window], np.float32)

    def dataset(self, series: dict[str, np.ndarray], axis: str) -> xr.Dataset:
        """Return sampled fields and midlines along an axis, with units."""
        units = {"vorticity": "1/s", "pressure": "Pa", "u": "m/s", "v": "m/s"}
        data: dict[str, Any] = {
            name: ((axis, "y", "x"), series[name], {"units": unit}) for name, unit in units.items() if name in series
        }
        for name, unit in SPINE:
            data[f"midline_{name}"] = ((axis, "station"), series[f"midline_{name}"], {"units": unit})
        return xr.Dataset(data, coords={"x": ("x", self.x, {"units": "m"}), "y": ("y", self.y, {"units": "m"})})


def midline(sim: flow.Simulation) -> flow.MidlineState:
    """Return the midline of the only body, in the frame of the grid."""
    body, (position, _) = sim.setup.bodies[0], sim.frame
    world_state = body.shape.spine(sim.time).in_world(sim.pose(body.name))  # type: ignore[attr-defined]
    return flow.MidlineState(
        x=world_state.x - position[0],
        y=world_state.y - position[1],
        heading=world_state.heading,
        half_width=world_state.half_width,
        x_rate=world_state.x_rate,
        y_rate=world_state.y_rate,
        heading_rate=world_state.heading_rate,
    )


def sample_course(sim: flow.Simulation, samples: Samples) -> None:
    """Store the lateral position of the midline at ``COURSE`` stations, after a step."""
    spine, (position, _) = midline(sim), sim.frame
    stations = np.linspace(0.0, spine.y.size - 1.0, COURSE)
    lateral = np.interp(stations, np.arange(spine.y.size), spine.y) + position[1]
    samples.add("course", sim.time, across=lateral.astype(np.float32))


def course(sim: flow.Simulation, samples: Samples, period: float, cycles: int) -> xr.Dataset:
    """Return the lateral course of a free body from its start: midline and centre of mass at equal intervals of time.

    Args:
        sim: simulation at its end.
        samples: of the swim, those of ``sample_course`` among them.
        period: period of one cycle [s].
        cycles: number of cycles that were swum [-].
    """
    times, course_samples = period * np.arange(TICKS * cycles + 1) / TICKS, samples.series("course")
    lateral = np.column_stack(
        [np.interp(times, course_samples["time"], column) for column in course_samples["across"].T]
    )
    centre = np.interp(times, sim.record.time, sim.record.column("y"))
    return xr.Dataset(
        {
            "course": (("tick", "place"), lateral, {"units": "m", "long_name": "midline to the right"}),
            "course_centre": ("tick", centre, {"units": "m", "long_name": "centre of mass to the right"}),
        }
    )


def midline_values(spine: flow.MidlineState) -> dict[str, np.ndarray]:
    """Return what is sampled of a midline, by name."""
    return {f"midline_{name}": getattr(spine, name) for name, _ in SPINE}


def wake(sim: flow.Simulation) -> xr.Dataset:
    """Return the midline, the vorticity in the plane of symmetry, and the strongest vortices over and beside it.

    Args:
        sim: simulation of one ``Trunk``, the half above its plane of symmetry.
    """
    grid, spine = sim.setup.grid, midline(sim)
    shape = sim.setup.bodies[0].shape
    assert isinstance(shape, flow.Trunk)
    q = _vortices(sim)
    units = {"units": "1/s2", "long_name": "second invariant of the velocity's gradient, the greatest along the view"}
    data = xr.Dataset(
        {
            "vorticity": (("y", "x"), sim.vorticity_at_centres[2, 0].astype(np.float32), {"units": "1/s"}),
            "vortices_above": (("y", "x"), q.max(axis=0).astype(np.float32), units),
            "vortices_beside": (("z", "x"), q.max(axis=1).astype(np.float32), units),
            "half_height": ("station", shape.half_height, {"units": "m"}),
        },
        coords={axis: (axis, getattr(grid, axis), {"units": "m"}) for axis in "xyz"},
    )
    lines = {f"midline_{name}": ("station", getattr(spine, name), {"units": unit}) for name, unit in SPINE}
    return data.assign(lines)


def _vortices(sim: flow.Simulation) -> np.ndarray:
    """Return the second invariant at the cell centres, 0 inside the body, of a flow with its image below [1/s2]."""
    velocity = np.stack(sim.velocity).astype(float)
    image = velocity[:, :1] * np.array([1.0, 1.0, -1.0])[:, None, None, None]
    q = flow.second_invariant(np.concatenate([image, velocity], axis=1), sim.setup.grid.cell)[1:]
    invariant: np.ndarray = q * (sim.fluid_fraction > MIN_FLUID_FRACTION)
    return invariant


class VortexSampler:
    """Samples the midline and the vortices of a body at equal intervals of its last cycle."""

    def __init__(self, frequency: float, end: float, frames: int) -> None:
        """Begin to wait for the last cycle.

        Args:
            frequency: frequency of the swim [Hz].
            end: end of its last cycle [s].
            frames: frames that are kept, the last at the end; 0 keeps none [-].
        """
        self._frequency, self._end, self._frames = frequency, end, frames

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Store a frame if one is due."""
        remaining_cycles = (self._end - sim.time) * self._frequency
        count = samples.count("frames")
        if count < self._frames and remaining_cycles < 1.0 - (count + 1) / self._frames + 1e-6:
            samples.add("frames", sim.time, **self._frame(sim))

    def _frame(self, sim: flow.Simulation) -> dict[str, np.ndarray]:
        """Return vortices, spin and midline of the present instant, in small integers."""
        f = self._frequency
        q = _vortices(sim) / (VORTEX * f * f)
        is_vortex = q > 0.25
        spin = np.where(is_vortex, sim.vorticity_at_centres[2] / (TURNS * f), 0.0)
        return {
            "vortices": np.where(is_vortex, np.round(LEVEL * np.minimum(q, 32.0)), 0.0).astype(np.int16),
            "spin": np.round(127.0 * np.clip(spin, -1.0, 1.0)).astype(np.int8),
            **midline_values(midline(sim)),
        }

    def record(self, samples: Samples) -> xr.Dataset:
        """Return the frames: ``vortices`` and ``spin`` as integers, and the values of their units."""
        if samples.count("frames") == 0:
            return xr.Dataset()
        frames, f, box = samples.series("frames"), self._frequency, ("frame", "z", "y", "x")
        lines = {
            f"film_{name}": (("frame", "station"), frames[f"midline_{name}"].astype(np.float32), {"units": unit})
            for name, unit in SPINE
        }
        phase = (frames["time"] - self._end) * f + 1.0
        return xr.Dataset(
            {
                "vortices": (box, frames["vortices"], {"units": "1", "long_name": "second invariant in vortex_unit"}),
                "spin": (box, frames["spin"], {"units": "1", "long_name": "vorticity about z in spin_unit"}),
                "vortex_unit": ((), VORTEX * f * f / LEVEL, {"units": "1/s2"}),
                "vortex_level": ((), VORTEX * f * f, {"units": "1/s2"}),
                "spin_unit": ((), TURNS * f / 127.0, {"units": "1/s"}),
                **lines,
            },
            coords={"frame": ("frame", phase, {"units": "1", "long_name": "phase of the last cycle"})},
        )
