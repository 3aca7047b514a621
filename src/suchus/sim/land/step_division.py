"""Time steps of the physics, divided for a while: does a result depend on the step that it was computed with?

Within ``divide_steps(2)`` every simulation of this process takes physics steps of half the size, whoever starts it and
whatever step it was given. The control period, the commands and the samples of a record stay as they are.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign

MAX_DIVISOR = 1000
"""Greatest divisor of a time step [-]."""


@dataclass(slots=True)
class StepDivision:
    """How time steps are divided, and how many simulations were."""

    divisor: int
    """Whole number by which each time step is divided [-]."""
    simulations: int = 0
    """Number of simulations whose step was divided, tests on a stand and in a tank among them [-]."""


_active: list[StepDivision] = []


@contextmanager
def divide_steps(divisor: int) -> Iterator[StepDivision]:
    """Divide the physics step of every simulation that begins within, in all threads of this process.

    It applies to ``simulate`` and ``crawl``, live runs, emulated robots, joints on a stand and floating bodies. A flow
    that is solved together with the robot has steps of its own, and stays as it is. So do environments, and processes
    that are started within. Contexts within each other multiply.

    Args:
        divisor: whole number, 1 to ``MAX_DIVISOR`` [-].

    Yields:
        The division, which counts the simulations.

    Raises:
        InvalidDesign: the divisor is no whole number, or out of its range.
    """
    require("divide_steps", "divisor", divisor, 1, MAX_DIVISOR, "")
    if divisor != int(divisor):
        raise InvalidDesign(
            f"divide_steps.divisor is {divisor}; it must be a whole number, so that steps divide the control period."
        )
    division = StepDivision(int(divisor))
    _active.append(division)
    try:
        yield division
    finally:
        _active[:] = [other for other in _active if other is not division]


def divided_step(timestep: float) -> float:
    """Return the time step that a simulation takes for the one that it was given, and count the simulation.

    Args:
        timestep: time step of the physics, as given [s].
    """
    divisor = 1
    for division in _active:
        divisor *= division.divisor
        division.simulations += 1
    return timestep / divisor
