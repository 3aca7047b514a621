"""One control period of a batch after the other: trouble happens, the controller decides, the physics goes on."""

from collections.abc import Sequence

import numpy as np

from suchus.control import Command, Controller, Runs
from suchus.design.checks import require
from suchus.design.scale import control_period
from suchus.errors import InvalidDesign
from suchus.land.batch import SimulationBatch
from suchus.land.deduplication import Deduplication
from suchus.land.disturbances import Disturbances
from suchus.land.readings import Readings
from suchus.land.run import Run

CONTROL_PERIOD = 0.01
"""Of the article's robot [s]: 100 Hz, what a bus of hobby servos sustains; ``design.scale`` has those of others."""


def physics_steps(timestep: float, period: float = CONTROL_PERIOD) -> int:
    """Return the number of physics steps in a control period.

    Args:
        timestep: of the physics [s].
        period: of control [s].

    Raises:
        InvalidDesign: the time step does not divide the control period.
    """
    require("simulate", "timestep", timestep, 1e-6, period, "s")
    steps = round(period / timestep)
    if abs(steps * timestep - period) > 1e-9:
        raise InvalidDesign(f"simulate.timestep is {timestep} s; it must divide the control period of {period} s.")
    return steps


def start(runs: Sequence[Run], ticks: int, period: float = CONTROL_PERIOD) -> Controller:
    """Start the controller of a group of runs that share one.

    Args:
        runs: with equal controls, or with controls that can be joined.
        ticks: number of control periods to come.
        period: of control [s].
    """
    control = runs[0].control
    group = Runs(
        controls=tuple(run.control for run in runs),
        robots=tuple(run.robot for run in runs),
        gaits=tuple(run.gait for run in runs),
        seeds=tuple(run.seed for run in runs),
        ticks=ticks,
    )
    return control.start(group, period)


class Loop:
    """Robots on their grounds, their controller, their faults and pushes, for a group of runs that share a controller.

    Args:
        runs: of the group.
        ticks: number of control periods to come.
        steps: physics steps in each.
        timestep: of the physics [s].
        samples: that can be stored.
    """

    def __init__(self, runs: Sequence[Run], ticks: int, steps: int, timestep: float, *, samples: int) -> None:
        self._steps = steps
        self._breath: np.ndarray | None = None
        self._period = period = control_period(runs[0].robot)
        self.batch = SimulationBatch(runs, timestep)
        self.feels = any(run.control.feels for run in runs)
        self.controller = start(runs, ticks, period)
        first = self.controller.rest()
        self.batch.place(runs, first)
        self._deduplication = Deduplication(runs, first, period)
        self.disturbances = Disturbances(runs, self.batch, ticks, period)
        self.readings = Readings(self.batch, runs, samples)

    def decide(self, tick: int, beat: int | None = None) -> Command:
        """Let happen what is due and return what the controller commands; ``disturb`` returns the result.

        Args:
            tick: number of the control period.
            beat: the one that the controller takes it for; the same if None.
        """
        self.disturbances.happen(tick)
        injector = self.disturbances.injector
        sensed = injector.sense(self.readings.sensed(tick * self._period)) if self.feels else None
        command = self.controller.command(tick if beat is None else beat, sensed)
        self._breath = command.breath
        return command

    def disturb(self, tick: int, command: Command) -> Command:
        """Return what the servos are commanded in the end, with noise and faults."""
        return command._replace(targets=self.disturbances.disturb(tick, command.targets))

    def advance(self, tick: int, targets: np.ndarray) -> None:
        """Let one control period pass in which the servos are commanded these angles, shape (run, servo) [rad]."""
        self._deduplication.part(tick, targets if self._breath is None else np.column_stack([targets, self._breath]))
        self.batch.waters.flood(tick * self._period, self._breath)
        self.batch.advance(targets, self._steps, tick * self._period, self._deduplication)
