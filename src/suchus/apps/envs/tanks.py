"""Robots of a pack that swim in flows of their own, each solved together with its robot."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from suchus.apps.envs.actor import Actor
from suchus.core.errors import Diverged, InvalidDesign, NotConverged, OutsideLimits
from suchus.core.progress import silent
from suchus.robot.design import layout
from suchus.sim.fault import Fault
from suchus.sim.land import Push, Run
from suchus.sim.land.batch import Beginning, SimulationBatch
from suchus.swimming.water import Outline

if TYPE_CHECKING:
    from suchus.swimming.coupling import Swim

_END_ERRORS = (Diverged, InvalidDesign, NotConverged, OutsideLimits)
"""Errors that end an episode: divergence, a body that leaves its plane or box, or one that moves too fast."""


class Tanks:
    """The flows of a pack.

    Args:
        run: run in a flow, of which each robot has one of its own.
        batch: batch of the pack, in which each robot is shown as its own simulation has it.
        periods: control periods from one action to the next.
        period: control period [s].
    """

    def __init__(self, run: Run, batch: SimulationBatch, periods: int, period: float) -> None:
        self._run, self._batch, self._periods, self._period = run, batch, periods, period
        self._limbs = len(layout(run.robot).limbs)
        self._swims: dict[int, Swim] = {}
        self._actors: dict[int, Actor] = {}
        self._ticks: dict[int, int] = {}
        lateral = {servo.name for servo in Outline(run.robot, 33).servos}
        self.is_lateral_servo: Bool[np.ndarray, " servo"] = np.array(
            [name in lateral for name in layout(run.robot).servos]
        )
        """Whether the flow sees each servo move the body; the others keep still."""

    def restart(self, sim: int, begin: Beginning, faults: Sequence[Fault], pushes: Sequence[Push]) -> None:
        """Put one robot into water at rest.

        Args:
            sim: which.
            begin: the state in which it begins.
            faults: what breaks, each at its time since this beginning.
            pushes: forces from outside, likewise.
        """
        from suchus.swimming.coupling import Swim  # noqa: PLC0415  the solver of the flow is loaded by who swims in one alone

        actor = Actor(begin.commanded[None].copy(), self._periods, self._limbs)
        run = replace(self._run, faults=tuple(faults), pushes=tuple(pushes))
        self._swims[sim] = Swim(run, np.inf, controller=actor, begin=begin)
        self._actors[sim], self._ticks[sim] = actor, 0
        self._swims[sim].stepper.show(self._batch, sim)

    def act(
        self, target: Float[np.ndarray, "run servo"], active_mask: Bool[np.ndarray, " run"]
    ) -> Float[np.ndarray, " run"]:
        """Let robots swim for a step on the way to other servo angles; return the work of their servos [J].

        Args:
            target: commanded at the end of the step [rad].
            active_mask: whether each robot swims; who no longer can is no longer alive in the batch.
        """
        work = np.zeros(len(active_mask))
        for sim in np.flatnonzero(active_mask).tolist():
            swim, last_effort = self._swims[sim], self._swims[sim].effort
            self._actors[sim].aim(target[sim : sim + 1])
            self._ticks[sim] += self._periods
            try:
                swim.go(self._ticks[sim] * self._period, progress=silent)
            except _END_ERRORS as error:
                self._batch.alive[sim], self._batch.end_times[sim], self._batch.cause[sim] = (
                    False,
                    swim.time,
                    str(error),
                )
                continue
            swim.stepper.show(self._batch, sim)
            work[sim] = swim.effort - last_effort
        return work
