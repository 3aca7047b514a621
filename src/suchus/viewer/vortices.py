"""What a record of a swim in three dimensions shows over its last cycle: the body and the surfaces around its vortices.

It knows nothing of browsers.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr

from suchus.figures import vortices
from suchus.record import load
from suchus.skin.mesh import Mesh
from suchus.viewer.swim import PlottedCurve

LARGEST = 60_000
"""Points of the upper half of the surfaces from which they are taken of blocks of cells [-]."""
_COARSEST = 4
_LEAST, _MOST = 0.3, 4.0
"""Least and greatest second invariant that can be chosen, over the record's own; fields are kept from a quarter on."""


@dataclass(frozen=True, eq=False)
class VortexFilm:
    """The last cycle of a swim in three dimensions, frame by frame.

    Args:
        record: of the experiment ``swim_3d``, or of ``water.resolved`` in space with frames; see ``figures.vortices``.
        whose: how a sentence about it begins.

    Raises:
        IncompatibleRecord: it is none of these.
    """

    record: xr.Dataset
    whose: str = "the record"

    def __post_init__(self) -> None:
        vortices.check_filmed(self.record, self.whose)

    @property
    def phase(self) -> np.ndarray:
        """Phase of each frame in the cycle, (frame,) [-]."""
        return np.asarray(self.record.frame.values, dtype=float)

    @property
    def level(self) -> float:
        """Second invariant Q on the surfaces of the experiment's own pictures [1/s2]."""
        return float(self.record.vortex_level)

    @property
    def levels(self) -> tuple[float, float]:
        """Least and greatest Q whose surface can be shown [1/s2]."""
        return _LEAST * self.level, _MOST * self.level

    def within(self, level: float) -> float:
        """Return the nearest Q whose surface can be shown [1/s2]; the record's own for what is no number."""
        low, high = self.levels
        return min(max(level, low), high) if np.isfinite(level) else self.level

    @cached_property
    def limit(self) -> float:
        """Vorticity about the vertical at which the colours end [1/s]."""
        return vortices.colour_limit(self.record)

    def body(self, frame: int) -> Mesh:
        """Return the body."""
        return vortices.body(self.record, frame)

    def blocks(self, level: float) -> int:
        """Return the cells along each side of the blocks of which surfaces are taken, so that they are small [-]."""
        last = self.record.sizes["frame"] - 1
        for coarse in range(1, _COARSEST):
            surface, _ = vortices.surface(self.record, last, coarse=coarse, level=level)
            if len(surface.points) <= LARGEST:
                return coarse
        return _COARSEST

    def surfaces(self, frame: int, level: float, *, blocks: int = 1, lower: bool = False) -> Mesh:
        """Return the surfaces around the vortices, coloured by the vorticity about the vertical.

        Args:
            frame: which.
            level: second invariant on them [1/s2].
            blocks: see the method of that name [-].
            lower: whether the half above the plane of symmetry, which hides the body, is left out.
        """
        return vortices.around(self.record, frame, coarse=blocks, level=level, lower=lower)

    def camera(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return where the camera is at first and where it looks, as in the experiment's pictures [m]."""
        taken = vortices.camera(self.record)
        place = np.array(taken.target) + 1.1 * taken.width * taken.axes[2]
        return (float(place[0]), float(place[1]), float(place[2])), taken.target

    def about(self) -> str:
        """Return in words on which grid and in what water it swims, as far as the record says."""
        said = []
        if "cells" in self.record.coords and self.record.cells.ndim == 1:
            said.append(f"{int(self.record.cells[-1])} cells a length")
        if "reynolds" in self.record:
            said.append(f"f L² / ν = {float(self.record.reynolds):.0f}")
        return ", ".join(said)

    def curves(self) -> tuple[PlottedCurve, ...]:
        """Return the courses that were measured beside it, which a record of a single swim lacks."""
        return tuple(_curves(self.record))


def _curves(record: xr.Dataset) -> Iterator[PlottedCurve]:
    for name, unit in (("speed", "m/s"), ("power", "W")):
        if name in record and record[name].dims == ("grid", "cycle") and "cells" in record.coords:
            grids = {f"{int(n)} cells a length": record[name].values[i] for i, n in enumerate(record.cells.values)}
            yield PlottedCurve(f"{name} [{unit}] of each cycle", record.cycle.values, dict(list(grids.items())[-3:]))
    if "servo_torque" in record and set(record.servo_torque.dims) == {"moment", "servo"}:
        share = (record.servo_torque / record.servo_limit).transpose("servo", "moment")
        lines = {str(name): share.values[i] for i, name in enumerate(record.servo.values)}
        yield PlottedCurve("torque of the water over the servo's limit [-]", record.moment.values, lines)


def vortex_film(path: Path) -> VortexFilm | None:
    """Return the last cycle of a swim in three dimensions; None if the record knows nothing of vortices in space.

    Args:
        path: of the file.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: the record holds vortices, and lacks or garbles what belongs to them.
    """
    record = load(path)
    return VortexFilm(record, str(path)) if "vortices" in record else None
