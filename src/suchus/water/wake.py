"""The wake of a body in three dimensions: what is kept of it at the end, and of its vortices over the last cycle."""

import numpy as np
import xarray as xr

from suchus import flow
from suchus.water.diary import Diary
from suchus.water.view import SPINE, kept, midline

OUTSIDE = 0.99
"""Share of the fluid from which a cell counts as outside the body [-]."""
VORTEX = 0.4
"""Second invariant Q on the surfaces that are drawn around vortices, over the square of the frequency [-]."""
TURNS = 10.0
"""Vorticity that the greatest number of ``spin`` stands for, over the frequency [-]."""
LEVEL = 1000
"""Number that stands for ``VORTEX`` in ``vortices`` [-]; what is below a quarter of it is 0."""


def wake(sim: flow.Simulation) -> xr.Dataset:
    """Return the midline, the vorticity in the plane of symmetry, and the strongest vortices over and beside it.

    Args:
        sim: of one ``Trunk``, the half above its plane of symmetry.
    """
    grid, spine = sim.setup.grid, midline(sim)
    shape = sim.setup.bodies[0].shape
    assert isinstance(shape, flow.Trunk)
    q = _vortices(sim)
    units = {"units": "1/s2", "long_name": "second invariant of the velocity's gradient, the greatest along the view"}
    found = xr.Dataset(
        {
            "vorticity": (("y", "x"), sim.vorticity_at_centres[2, 0].astype(np.float32), {"units": "1/s"}),
            "vortices_above": (("y", "x"), q.max(axis=0).astype(np.float32), units),
            "vortices_beside": (("z", "x"), q.max(axis=1).astype(np.float32), units),
            "half_height": ("station", shape.half_height, {"units": "m"}),
        },
        coords={axis: (axis, getattr(grid, axis), {"units": "m"}) for axis in "xyz"},
    )
    lines = {f"midline_{name}": ("station", getattr(spine, name), {"units": unit}) for name, unit in SPINE}
    return found.assign(lines)


def _vortices(sim: flow.Simulation) -> np.ndarray:
    """Return the second invariant at the cell centres, 0 inside the body, of a flow with its image below [1/s2]."""
    velocity = np.stack(sim.velocity).astype(float)
    image = velocity[:, :1] * np.array([1.0, 1.0, -1.0])[:, None, None, None]
    q = flow.second_invariant(np.concatenate([image, velocity], axis=1), sim.setup.grid.cell)[1:]
    found: np.ndarray = q * (sim.fluid_share > OUTSIDE)
    return found


class Filmed:
    """Looks at a body at equal intervals of its last cycle and notes its midline and the vortices around it."""

    def __init__(self, frequency: float, end: float, frames: int) -> None:
        """Begin to wait for the last cycle.

        Args:
            frequency: of the swim [Hz].
            end: of its last cycle [s].
            frames: that are kept, the last at the end; 0 keeps none [-].
        """
        self._frequency, self._end, self._frames = frequency, end, frames

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        """Note a frame if one is due."""
        left = (self._end - sim.time) * self._frequency
        count = diary.count("frames")
        if count < self._frames and left < 1.0 - (count + 1) / self._frames + 1e-6:
            diary.note("frames", sim.time, **self._frame(sim))

    def _frame(self, sim: flow.Simulation) -> dict[str, np.ndarray]:
        f = self._frequency
        q = _vortices(sim) / (VORTEX * f * f)
        shown = q > 0.25
        spin = np.where(shown, sim.vorticity_at_centres[2] / (TURNS * f), 0.0)
        return {
            "vortices": np.where(shown, np.round(LEVEL * np.minimum(q, 32.0)), 0.0).astype(np.int16),
            "spin": np.round(127.0 * np.clip(spin, -1.0, 1.0)).astype(np.int8),
            **kept(midline(sim)),
        }

    def record(self, diary: Diary) -> xr.Dataset:
        """Return the frames: ``vortices`` and ``spin`` in whole numbers, and what 1 of them stands for."""
        if diary.count("frames") == 0:
            return xr.Dataset()
        page, f, box = diary.page("frames"), self._frequency, ("frame", "z", "y", "x")
        lines = {
            f"film_{name}": (("frame", "station"), page[f"midline_{name}"].astype(np.float32), {"units": unit})
            for name, unit in SPINE
        }
        phase = (page["time"] - self._end) * f + 1.0
        return xr.Dataset(
            {
                "vortices": (box, page["vortices"], {"units": "1", "long_name": "second invariant in vortex_unit"}),
                "spin": (box, page["spin"], {"units": "1", "long_name": "vorticity about z in spin_unit"}),
                "vortex_unit": ((), VORTEX * f * f / LEVEL, {"units": "1/s2"}),
                "vortex_level": ((), VORTEX * f * f, {"units": "1/s2"}),
                "spin_unit": ((), TURNS * f / 127.0, {"units": "1/s"}),
                **lines,
            },
            coords={"frame": ("frame", phase, {"units": "1", "long_name": "phase of the last cycle"})},
        )
