"""One control period of a batch after the other: trouble happens, the controller decides, the physics goes on."""

from collections.abc import Sequence

import numpy as np

from suchus.control import Command, Controller, Joinable
from suchus.design.checks import require
from suchus.errors import InvalidDesign
from suchus.land.alike import Alike
from suchus.land.bench import Bench
from suchus.land.readings import Readings
from suchus.land.run import Run
from suchus.land.troubles import Troubles

CONTROL_PERIOD = 0.01  # [s]; 100 Hz, what a bus of hobby servos sustains


def physics_steps(timestep: float) -> int:
    """Return the number of physics steps in a control period.

    Raises:
        InvalidDesign: the time step does not divide the control period.
    """
    require("simulate", "timestep", timestep, 1e-5, CONTROL_PERIOD, "s")
    steps = round(CONTROL_PERIOD / timestep)
    if abs(steps * timestep - CONTROL_PERIOD) > 1e-9:
        raise InvalidDesign(
            f"simulate.timestep is {timestep} s; it must divide the control period of {CONTROL_PERIOD} s."
        )
    return steps


def start(runs: Sequence[Run], ticks: int) -> Controller:
    """Start the controller of a group of runs that share one.

    Args:
        runs: with equal controls, or with controls that can be joined.
        ticks: number of control periods to come.
    """
    robots, gaits, seeds = [run.robot for run in runs], [run.gait for run in runs], [run.seed for run in runs]
    control = runs[0].control
    if isinstance(control, Joinable):
        return control.start_together([run.control for run in runs], robots, gaits, seeds, ticks, CONTROL_PERIOD)
    return control.start(robots, gaits, seeds, ticks, CONTROL_PERIOD)


class Loop:
    """Robots on their grounds, what steers them and what troubles them, for a group of runs that share a controller.

    Args:
        runs: of the group.
        ticks: number of control periods to come.
        steps: physics steps in each.
        timestep: of the physics [s].
        samples: that can be stored.
    """

    def __init__(self, runs: Sequence[Run], ticks: int, steps: int, timestep: float, *, samples: int) -> None:
        self._steps = steps
        self.bench = Bench(runs, timestep)
        self.feels = any(run.control.feels for run in runs)
        self.controller = start(runs, ticks)
        first = self.controller.rest()
        self.bench.place(runs, first)
        self._alike = Alike(runs, first, CONTROL_PERIOD)
        self.troubles = Troubles(runs, self.bench, ticks, CONTROL_PERIOD)
        self.readings = Readings(self.bench, runs, samples)

    def decide(self, tick: int, beat: int | None = None) -> Command:
        """Let happen what is due and return what the controller commands; ``disturb`` says what comes of it.

        Args:
            tick: number of the control period.
            beat: the one that the controller takes it for; the same if None.
        """
        self.troubles.happen(tick)
        injector = self.troubles.injector
        sensed = injector.sense(self.readings.sensed(tick * CONTROL_PERIOD)) if self.feels else None
        return self.controller.command(tick if beat is None else beat, sensed)

    def disturb(self, tick: int, command: Command) -> Command:
        """Return what the servos are commanded in the end, with noise and faults."""
        return Command(self.troubles.disturb(tick, command.targets), command.phase)

    def advance(self, tick: int, targets: np.ndarray) -> None:
        """Let one control period pass in which the servos are told these angles, shape (run, 19) [rad]."""
        self._alike.part(tick, targets)
        self.bench.advance(targets, self._steps, tick * CONTROL_PERIOD, self._alike)
