"""Integrators in time: explicit Runge-Kutta methods, each stage of which is immersed and projected.

Stage ``k`` makes of the velocity ``y_0`` at the step's start and of the last stage's ``y_(k-1)``

    y_k = keep y_(k-1) + (1 - keep) (y_0 + span dt f(y_(k-1)))

with advection and diffusion ``f``; the bodies are where they are at the step's end. An integrator is the ``keep`` and
``span`` of its stages.

Source: Shu and Osher 1988, J. Comput. Phys. 77, 439-471 (methods that keep a bound which Euler's step keeps).
"""

from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.grid import check_kinds

ROUNDING_TOLERANCE = 1e-9
"""Largest error of the sums over stages in the conditions of an order [-]."""


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of an integrator."""

    keep: float
    """Weight of the last stage's velocity, 0 to 1 [-]; 0 in the first stage."""
    span: float
    """Length of the stage from the step's start, in steps [-]."""


@dataclass(frozen=True)
class Integrator:
    """A method of Runge and Kutta.

    Raises:
        InvalidDesign: on creation, for stages that cannot be or do not add up to the step.
    """

    stages: tuple[Stage, ...]
    """Its stages, in their order."""

    def __post_init__(self) -> None:
        """Refuse stages that cannot be or do not add up to the step."""
        check_kinds(self)
        for stage in self.stages:
            check_kinds(stage)
            if not (0 <= stage.keep < 1 and isfinite(stage.span) and stage.span > 0):
                raise InvalidDesign(f"a stage is {stage}; keep is at least 0 and below 1, and span is above 0.")
        if not self.stages or self.stages[0].keep:
            raise InvalidDesign("an integrator has at least one stage, and the first keeps nothing: Stage(0.0, 1.0).")
        if self.order < 1:
            total = float(self.rates[-1].sum())
            raise InvalidDesign(
                f"the stages of the integrator add up to {total:.6g} of a step; they must add up to 1. Heun's method "
                f"is Integrator((Stage(0.0, 1.0), Stage(0.5, 1.0)))."
            )

    @cached_property
    def weights(self) -> np.ndarray:
        """Weight of each stage in the velocity at the step's end, shape (stage,) [-]; the sum is 1."""
        stage_weights = np.zeros(len(self.stages))
        for k, stage in enumerate(self.stages):
            stage_weights *= stage.keep
            stage_weights[k] = 1 - stage.keep
        return stage_weights

    @cached_property
    def rates(self) -> np.ndarray:
        """Butcher's table: coefficient of the rates of each stage in each stage, shape (stage, stage) [steps]."""
        table = np.zeros((len(self.stages),) * 2)
        for k, stage in enumerate(self.stages):
            if k:
                table[k] = stage.keep * table[k - 1]
            table[k, k] = (1 - stage.keep) * stage.span
        return table

    @property
    def order(self) -> int:
        """Order of the method for the water alone, 0 to 3 [-].

        Bodies, which are placed at the step's end for all stages, and the pressure, which the last step left, enter
        with an error of their own.
        """
        b = self.rates[-1]
        stage_table = np.vstack(
            [np.zeros(len(b)), self.rates[:-1]]
        )  # rates are taken at the velocity of the last stage
        c = stage_table.sum(axis=1)
        order_conditions = (
            (1.0, ((b.sum(), 1.0),)),
            (2.0, ((b @ c, 1 / 2),)),
            (3.0, ((b @ c**2, 1 / 3), (b @ stage_table @ c, 1 / 6))),
        )
        order = 0
        for candidate_order, conditions in order_conditions:
            if any(abs(has - needs) > ROUNDING_TOLERANCE for has, needs in conditions):
                break
            order = int(candidate_order)
        return order


EULER = Integrator((Stage(0.0, 1.0),))
"""Euler's method, of first order, for comparison; vortices grow unless the steps are small."""

HEUN = Integrator((Stage(0.0, 1.0), Stage(0.5, 1.0)))
"""Heun's method, of second order."""

SHU_OSHER = Integrator((Stage(0.0, 1.0), Stage(0.25, 1 / 3), Stage(2 / 3, 2.0)))
"""The method of third order of Shu and Osher; it takes one and a half times as long as Heun's."""
