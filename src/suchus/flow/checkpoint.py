"""Checkpoints: the whole state of a simulation in one file, from which it goes on to the same bytes."""

from dataclasses import fields
from hashlib import sha256
from pathlib import Path
from time import monotonic
from typing import Protocol
from zipfile import BadZipFile

import numpy as np

from suchus.errors import UnreadableFile, Unwritable
from suchus.flow.setup import Setup

VERSION = 4
"""Layout of the file; rises with every change of it."""

State = dict[str, np.ndarray]
"""What a simulation needs to go on, by name."""


class Resumable(Protocol):
    """What can be saved and go on from what was saved."""

    @property
    def setup(self) -> Setup:
        """What is simulated."""

    def state(self) -> State:
        """Return all that changes."""

    def resume(self, state: State) -> None:
        """Set all that changes."""


def fingerprint(setup: Setup) -> str:
    """Return what two simulations must share for one to go on from the other's checkpoint."""
    s = setup
    numbers = (
        s.grid, s.viscosity, s.density, s.follow, s.follow_axes, s.courant, s.step, s.tolerance, s.precision,
        tuple(type(getattr(s.sides, f.name)).__name__ for f in fields(s.sides)), s.sides.endless,
        tuple((type(b).__name__, type(b.shape).__name__, b.name) for b in s.bodies),
        None if callable(s.stream) else s.stream,
    )  # fmt: skip
    return sha256(repr(numbers).encode()).hexdigest()


def save(sim: Resumable, path: Path) -> None:
    """Write the state to a file; a kill in between leaves the old file whole.

    Raises:
        Unwritable: naming the place.
    """
    state = {"version": np.array(VERSION), "setup": np.array(fingerprint(sim.setup)), **sim.state()}
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with part.open("wb") as file:
            np.savez(file, allow_pickle=False, **state)
        part.replace(path)
    except OSError as error:
        raise Unwritable(f"the checkpoint {path} cannot be written: {error.strerror}; choose another place.") from error


def load(sim: Resumable, path: Path) -> None:
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
    if str(state["setup"]) != fingerprint(sim.setup):
        raise UnreadableFile(f"{path} was written by another setup; give that setup, or another file.")
    sim.resume(state)


class Saver:
    """Saves a simulation now and then."""

    def __init__(self, path: Path | None, every: float) -> None:
        self._path, self._every, self._saved = path, every, monotonic()

    def save(self, sim: Resumable, *, now: bool = False) -> None:
        """Save if a path was given and it is time, or ``now``."""
        if self._path is not None and (now or monotonic() - self._saved >= self._every):
            save(sim, self._path)
            self._saved = monotonic()
