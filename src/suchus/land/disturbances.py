"""What goes wrong during a batch: faults and pushes when their time comes, and noise."""

from collections.abc import Sequence

import numpy as np

from suchus.design import layout
from suchus.fault import Fault
from suchus.land.batch import SimulationBatch
from suchus.land.injector import Injector
from suchus.land.push import Push
from suchus.land.run import Run


class Disturbances:
    """The faults, the pushes and the noise of all runs of a batch."""

    def __init__(self, runs: Sequence[Run], batch: SimulationBatch, ticks: int, period: float) -> None:
        self._batch = batch
        self._period = period
        self._pushes = [(sim, push) for sim, run in enumerate(runs) for push in run.pushes]
        self._due: dict[int, list[tuple[int, Fault]]] = {}
        for sim, run in enumerate(runs):
            for fault in run.faults:
                self._due.setdefault(int(np.ceil(fault.at / period - 1e-9)), []).append((sim, fault))
        self._servos = layout(runs[0].robot).servos
        self.injector = Injector(batch, period, runs[0].robot)
        self._noise = {
            sim: run.noise * np.random.default_rng(run.seed).standard_normal((ticks, len(self._servos)))
            for sim, run in enumerate(runs)
            if run.noise > 0
        }

    def happen(self, tick: int) -> None:
        """Let the faults of this control period begin, and push."""
        if self._pushes:
            self._push(tick)
        for sim, fault in self._due.get(tick, ()):
            self.injector.begin(sim, fault)

    def push(self, sim: int, push: Push) -> None:
        """Add a push."""
        self._pushes.append((sim, push))

    def _push(self, tick: int) -> None:
        forces: dict[tuple[int, str], np.ndarray] = {}
        for sim, push in self._pushes:
            share = push.share(tick * self._period, (tick + 1) * self._period)
            key = sim, push.body
            forces[key] = forces.get(key, np.zeros(3)) + share * np.array(push.force)
        for (sim, body), force in forces.items():
            self._batch.push(sim, body, force)
        self._pushes = [(sim, push) for sim, push in self._pushes if push.at + push.duration > tick * self._period]

    def disturb(self, tick: int, targets: np.ndarray) -> np.ndarray:
        """Return the angles that the servos are commanded in the end, a new array of shape (run, servo) [rad]."""
        if self._noise:
            targets = targets.copy()
            for sim, noise in self._noise.items():
                targets[sim] += noise[tick]
        return self.injector.command(tick, targets)
