"""The state of a simulation kept in memory, from which the same step can be taken again to the same bytes."""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from suchus.flow.consistency import Consistency
from suchus.flow.markers import Markers

if TYPE_CHECKING:
    from suchus.flow.simulation import Simulation

_SCALARS = ("time", "_last_step", "_speed", "_reference", "_fastest", "_is_placed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Snapshot:
    """Copies of all of a simulation that changes; ``Simulation.restore`` can go back to it any number of times.

    Shape and motion of a ``Body`` are not part of it: they must be the same as at that time.
    """

    scalars: Mapping[str, float]
    """Time, last step, speeds."""
    arrays: Mapping[str, np.ndarray]
    """Velocity, pressure, sides, frame, the bodies' velocity in the window, and what their regions hold."""
    swimmers: Mapping[str, Mapping[str, np.ndarray]]
    """States of free bodies."""
    rows: tuple[int, int, np.ndarray | None]
    """Rows of the record and of its control volume, and the last row."""
    consistency_checks: tuple[Consistency, ...]
    """State of the checks of the declared rates."""
    outlines: tuple[Markers, ...]
    """Skins of the bodies."""


def take_snapshot(sim: "Simulation") -> Snapshot:
    """Return a snapshot of a simulation."""
    log, state = sim._log, sim.water.state()
    extra_arrays = {"frame": sim.frame, "held": log.region_contents, "b": sim.water.b}
    return Snapshot(
        scalars={name: getattr(sim, name) for name in _SCALARS},
        arrays={name: np.array(value) for name, value in {**state, **extra_arrays}.items()},
        swimmers={name: swimmer.state() for name, swimmer in sim.swimmers.items()},
        rows=(len(log.rows), len(log.control_rows), log.rows[-1] if log.rows else None),
        consistency_checks=tuple(copy(check) for check in sim._consistency_checks), outlines=tuple(sim._outlines),
    )  # fmt: skip


def restore_snapshot(sim: "Simulation", snapshot: Snapshot) -> None:
    """Restore a simulation from a snapshot; the bodies are placed anew in the next step."""
    for name, value in snapshot.scalars.items():
        setattr(sim, name, value)
    arrays = {name: value.copy() for name, value in snapshot.arrays.items()}
    log, (count, controls, last_row) = sim._log, snapshot.rows
    del log.rows[count:], log.control_rows[controls:]
    if last_row is not None:
        log.rows[-1] = last_row
    log.region_contents, sim.frame = arrays["held"], arrays["frame"]
    sim.water.resume(arrays)
    for name, state in snapshot.swimmers.items():
        sim.swimmers[name].resume({key: value.copy() for key, value in state.items()})
    sim._consistency_checks = [copy(check) for check in snapshot.consistency_checks]
    sim._outlines = list(snapshot.outlines)
