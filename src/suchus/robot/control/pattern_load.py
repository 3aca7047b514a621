"""Feedback of the ground load to the drive of a pattern generator, so that one drive serves water and land."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.design import GRAVITY, Robot


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadRule:
    """Oscillators get more drive the smaller the sensed ground load is.

    Above the limbs' highest drive the limbs fall silent and the axis swims. So one descending drive walks on land and
    swims in water. The sensed load is the low-pass-filtered contact force of feet, belly and tail, as a fraction of
    body weight.
    """

    afloat: float = 2.0
    """Drive beside the descending one where nothing is felt, 0 to 10 [-]; the published drives walk at 2 and swim at
    4."""
    touch: float = 0.02
    """Share of the weight on the ground from which there is none of it, above 0 to 1; linear between [-]. A snout on
    the sand carries 0.035 to 0.05."""
    memory: float = 0.4
    """Time constant of the low pass, 0 to 60 [s]."""

    def __post_init__(self) -> None:
        with Checks("load_rule", self) as check:
            check.number("afloat", 0.0, 10.0, "")
            check.number("touch", 1e-4, 1.0, "")
            check.number("memory", 0.0, 60.0, "s")


class LoadDrive:
    """The filtered ground load of each run of a batch, and the drive that it adds."""

    def __init__(self, rules: Sequence[LoadRule | None], robots: Sequence[Robot], period: float) -> None:
        """Gather the rules of the batch; a run without one gets no drive from its load.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            period: control period [s].
        """
        self.has_feedback = any(rule is not None for rule in rules)
        """Whether any run has such a rule."""
        active_rules = [rule or LoadRule(afloat=0.0) for rule in rules]
        self._afloat_drive, self._touch = (
            np.array([getattr(rule, name) for rule in active_rules]) for name in ("afloat", "touch")
        )
        self._decay = np.array([decay_factor(rule.memory, period) for rule in active_rules])
        self._weight = np.array([robot.mass * GRAVITY for robot in robots])
        self.load: Float[np.ndarray, " run"] = np.ones(len(active_rules))
        """Share of the weight that the ground carries, through the low pass; as on land before anything is felt [-]."""

    def feel(self, sensed: Sensed) -> None:
        """Update the filtered ground load."""
        ground = finite(sensed.foot_pressure).sum(axis=1) + finite(sensed.belly_pressure).sum(axis=1)
        load = (ground + finite(sensed.tail_pressure)) / self._weight
        self.load = load + self._decay * (self.load - load)

    @property
    def drive(self) -> Float[np.ndarray, " run"]:
        """Drive that the load rule adds to the descending drive [-]."""
        return np.asarray(self._afloat_drive * np.clip(1.0 - self.load / self._touch, 0.0, 1.0))
