"""Checkpoints: the whole state of a simulation in one file, from which it goes on to the same bytes."""

from dataclasses import fields
from hashlib import sha256
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from suchus.errors import UnreadableFile, Unwritable

if TYPE_CHECKING:
    from suchus.flow.simulation import Simulation

VERSION = 1
"""Layout of the file; rises with every change of it."""

_SWIMMER = ("place", "rate", "push", "load", "steady", "added")


def fingerprint(sim: "Simulation") -> str:
    """Return what two simulations must share for one to go on from the other's checkpoint."""
    s = sim.setup
    numbers = (
        s.grid, s.viscosity, s.density, s.follow, s.follow_axes, s.courant, s.step, s.tolerance, s.precision,
        tuple(type(getattr(s.sides, f.name)).__name__ for f in fields(s.sides)),
        tuple((type(b).__name__, type(b.shape).__name__, b.name) for b in s.bodies),
        None if callable(s.stream) else s.stream,
    )  # fmt: skip
    return sha256(repr(numbers).encode()).hexdigest()


def save(sim: "Simulation", path: Path) -> None:
    """Write the state to a file; a kill in between leaves the old file whole.

    Raises:
        Unwritable: naming the place.
    """
    water = sim.water
    state = {
        "version": np.array(VERSION), "setup": np.array(fingerprint(sim)), "time": np.array(sim.time),
        "last": np.array(sim._last), "speed": np.array(sim._speed), "peak": np.array(sim._peak),
        "offset": np.array(water.offset), "reference": np.array(sim._reference), "frame": sim.frame,
        "u": water.u, "v": water.v, "p": water.p, "stream": np.array(water.border.stream),
        "rows": np.array(sim._rows).reshape(len(sim._rows), -1),
    }  # fmt: skip
    for k, edge in enumerate(water.border.edges):
        state[f"edge{k}"] = edge.prescribed
    for name, swimmer in sim.swimmers.items():
        for key in _SWIMMER:
            state[f"{name}.{key}"] = getattr(swimmer, key)
        state[f"{name}.steps"] = np.array(swimmer.steps)
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with part.open("wb") as file:
            np.savez(file, allow_pickle=False, **state)
        part.replace(path)
    except OSError as error:
        raise Unwritable(f"the checkpoint {path} cannot be written: {error.strerror}; choose another place.") from error


def load(sim: "Simulation", path: Path) -> None:
    """Set the simulation to the state in a file.

    Raises:
        UnreadableFile: not a checkpoint, of another version, or of another setup.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            state = {key: file[key] for key in file.files}
    except (OSError, ValueError, BadZipFile, EOFError) as error:
        raise UnreadableFile(f"{path} is not a checkpoint ({error}); delete it to start anew.") from error
    if "version" not in state or int(state["version"]) != VERSION:
        raise UnreadableFile(f"{path} is not a checkpoint of version {VERSION}; delete it to start anew.")
    if str(state["setup"]) != fingerprint(sim):
        raise UnreadableFile(f"{path} was written by another setup; give that setup, or another file.")
    _restore(sim, state)


def _restore(sim: "Simulation", state: dict[str, np.ndarray]) -> None:
    water = sim.water
    sim.time, sim._last, sim._speed, sim._peak = (float(state[k]) for k in ("time", "last", "speed", "peak"))
    sim._reference = float(state["reference"])
    water.offset = float(state["offset"])
    sim.frame = state["frame"]
    sim._rows = list(state["rows"])
    sim._placed = False
    water.u[:], water.v[:], water.p[:] = state["u"], state["v"], state["p"]
    sim._fastest = water.fastest()
    water.border.stream = (float(state["stream"][0]), float(state["stream"][1]))
    for k, edge in enumerate(water.border.edges):
        edge.prescribed[:] = state[f"edge{k}"]
    for name, swimmer in sim.swimmers.items():
        for key in _SWIMMER:
            setattr(swimmer, key, state[f"{name}.{key}"])
        swimmer.steps = int(state[f"{name}.steps"])


class Saver:
    """Saves a simulation now and then."""

    def __init__(self, path: Path | None, every: float) -> None:
        self._path, self._every, self._saved = path, every, monotonic()

    def save(self, sim: "Simulation", *, now: bool = False) -> None:
        """Save if a path was given and it is time, or ``now``."""
        if self._path is not None and (now or monotonic() - self._saved >= self._every):
            save(sim, self._path)
            self._saved = monotonic()
