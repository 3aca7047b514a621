"""What goes wrong during a batch: faults and pushes when their time comes, and noise."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from suchus.control import Sensed
from suchus.design import layout
from suchus.land.bench import Bench
from suchus.land.faults import Deaf, Fault, Locked
from suchus.land.push import Push
from suchus.land.run import Run


class Troubles:
    """The faults, the pushes and the noise of all runs of a batch."""

    def __init__(self, runs: Sequence[Run], bench: Bench, ticks: int, period: float) -> None:
        self._bench = bench
        self._period = period
        self._pushes = [(sim, push) for sim, run in enumerate(runs) for push in run.pushes]
        self._due: dict[int, list[tuple[int, Fault]]] = {}
        for sim, run in enumerate(runs):
            for fault in run.faults:
                self._due.setdefault(int(np.ceil(fault.at / period - 1e-9)), []).append((sim, fault))
        self._servos = layout(runs[0].robot).servos
        self._held = np.full((len(runs), len(self._servos)), np.nan)
        self._deaf: list[tuple[int, str]] = []
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
            self.begin(sim, fault)

    def begin(self, sim: int, fault: Fault) -> None:
        """Let a fault begin now."""
        if isinstance(fault, Locked):
            servo = self._servos.index(fault.joint)
            now = self._bench.readings[sim, servo]  # the first of them are the servos' angles
            self._held[sim, servo] = now if fault.angle is None else fault.angle
        elif isinstance(fault, Deaf):
            self._deaf.append((sim, fault.sensor))
        else:
            self._bench.break_servo(sim, fault)

    def mend(self, sim: int, joint: str) -> None:
        """Let a servo obey again; only where all runs share a model, as a lone run does."""
        self._held[sim, self._servos.index(joint)] = np.nan
        self._bench.mend_servo(sim, joint)

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
            self._bench.push(sim, body, force)
        self._pushes = [(sim, push) for sim, push in self._pushes if push.at + push.duration > tick * self._period]

    def deafen(self, sensed: Sensed) -> Sensed:
        """Return what is sensed by what still senses."""
        if not self._deaf:
            return sensed
        heard = {name: getattr(sensed, name).copy() for _, name in self._deaf}
        for sim, name in self._deaf:
            heard[name][sim] = (1.0, 0.0, 0.0, 0.0) if name == "orientation" else 0.0
        return replace(sensed, **heard)

    def disturb(self, tick: int, targets: np.ndarray) -> np.ndarray:
        """Return the angles that the servos are told in the end, shape (run, servo) [rad]."""
        if self._noise:
            targets = targets.copy()
            for sim, noise in self._noise.items():
                targets[sim] += noise[tick]
        return np.where(np.isnan(self._held), targets, self._held)
