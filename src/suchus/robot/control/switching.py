"""Choice of the walking posture from sensor readings, without a map."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.core.errors import UnknownName
from suchus.robot.control.sensed import Sensed
from suchus.robot.design import GRAVITY, Robot
from suchus.robot.motion import Gait

_WASHOUT = 3.0  # [s]; time constant of the mean tilt
_FOOT_LOADED = (
    0.02895931795  # [body weight], 1 N of the article's robot; load from which a foot counts as on the ground
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchRule:
    """A ladder of postures: up when the belly touches, down when the feet stumble or the ground is calm.

    Three quantities are sensed, each averaged over the last ``memory`` seconds: the fraction of the weight that the
    belly carries; the fraction of feet that contradict the gait, loaded in swing or free in stance; and the tilt of the
    body against its own mean. A loaded belly leads to the next higher posture. On a posture above ``home``, too many
    contradictions of the feet or a calm body lead to the next lower one.
    """

    ladder: tuple[Gait, ...]
    """Gaits from the lowest posture to the highest; the run's gait must be among them."""
    home: int
    """Rung to which it returns on calm ground, counted from 0 [-]."""
    belly: float = 0.03
    """Share of the weight on the belly that asks for the next rung [-]; a free belly carries nothing."""
    stumbling: float = 0.30
    """Contradiction of the feet that asks for the rung below [-]; 0.03 to 0.18 on even ground, 0.35 before a wall."""
    calm: float = 0.016
    """Mean tilt below which the ground counts as calm [rad]; 0.012 on even ground, 0.018 on bumps of 20 mm."""
    memory: float = 0.8
    """Time over which is averaged [s]; about a cycle."""
    patience: float = 3.0
    """Least time in a posture before it goes down again, and of calm before it goes home [s]."""

    def __post_init__(self) -> None:
        with Checks("switch_rule", self) as checks:
            checks.that(len(self.ladder) >= 2, "switch_rule.ladder needs two gaits or more")
            checks.whole("home", 0, max(len(self.ladder) - 1, 0))
            for field in ("belly", "stumbling", "calm"):
                checks.number(field, 0.0, 10.0, "")
            checks.number("memory", 0.01, 60.0, "s")
            checks.number("patience", 0.0, 600.0, "s")
            checks.that(len(set(self.ladder)) == len(self.ladder), "switch_rule.ladder repeats a gait")


class Switcher:
    """The filtered ground readings of a batch, and the changes of posture that follow from them."""

    def __init__(
        self,
        rules: Sequence[SwitchRule | None],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        period: float,
    ) -> None:
        """Check the ladders and start with nothing felt.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            gaits: gaits in which the runs begin.
            period: control period [s].

        Raises:
            UnknownName: a run's gait is not on its ladder.
        """
        self._rules, self._period = list(rules), period
        self._weight = np.array([robot.mass * GRAVITY for robot in robots])
        for rule, gait in zip(rules, gaits, strict=True):
            if rule is not None and gait not in rule.ladder:
                raise UnknownName("gait on the ladder", gait.name, [g.name for g in rule.ladder])
        self._keep = np.exp(-period / np.array([1.0 if rule is None else rule.memory for rule in rules]))
        n = len(rules)
        self._belly, self._stumbling, self._tilt = np.zeros(n), np.zeros(n), np.zeros(n)
        self._mean: np.ndarray | None = None
        self._since = np.zeros(n)  # time in this posture [s]
        self._calm = np.zeros(n)  # uninterrupted time of calm [s]

    def decide(
        self, sensed: Sensed, phase: Float[np.ndarray, "run limb"], gaits: Sequence[Gait], busy: set[int]
    ) -> list[tuple[int, Gait]]:
        """Update the filtered readings and return the runs that begin another gait now, with that gait.

        Args:
            sensed: readings.
            phase: phase of the limbs [cycle].
            gaits: present gait of each run.
            busy: runs that are changing their gait; their readings do not count.
        """
        if all(rule is None for rule in self._rules):
            return []
        free = np.array([run not in busy for run in range(len(self._rules))])
        self._feel(sensed, phase, gaits, free)
        requests = []
        for run, rule in enumerate(self._rules):
            if rule is not None and free[run]:
                rung = rule.ladder.index(gaits[run])
                step = self._step(run, rule, rung)
                if step:
                    requests.append((run, rule.ladder[rung + step]))
                    self._since[run] = self._calm[run] = 0.0
                    self._belly[run] = self._stumbling[run] = self._tilt[run] = 0.0
        return requests

    def _step(self, run: int, rule: SwitchRule, rung: int) -> int:
        """Return by how many rungs of its ladder a run changes its posture: -1, 0 or 1.

        Args:
            run: index of the run.
            rule: its rule.
            rung: present index on the ladder.
        """
        if self._since[run] < rule.memory:
            return 0
        if self._belly[run] > rule.belly and rung + 1 < len(rule.ladder):
            return 1
        self._calm[run] = self._calm[run] + self._period if self._tilt[run] < rule.calm else 0.0
        if rung > rule.home and self._since[run] >= rule.patience:
            return -int(self._stumbling[run] > rule.stumbling or self._calm[run] >= rule.patience)
        return 0

    def _feel(self, sensed: Sensed, phase: np.ndarray, gaits: Sequence[Gait], free: np.ndarray) -> None:
        """Update the filtered belly load, foot contradiction and tilt of those runs that are free.

        Args:
            sensed: sensor readings of the robots.
            phase: phase of the limbs, shape (run, limb) [cycle].
            gaits: present gait of each run.
            free: which runs are not changing their gait.
        """
        feet, belly = np.nan_to_num(sensed.foot_pressure), np.nan_to_num(sensed.belly_pressure).sum(axis=1)
        total = feet.sum(axis=1) + belly + np.nan_to_num(sensed.tail_pressure)
        duty = np.array([[gait.duty_factor] for gait in gaits])
        contradicts = (feet > _FOOT_LOADED * self._weight[:, None]) != (np.mod(phase, 1.0) >= 1.0 - duty)
        tilt = np.nan_to_num(np.stack([rotation.roll(sensed.orientation), rotation.pitch(sensed.orientation)]))
        self._mean = tilt if self._mean is None else self._mean + self._period / _WASHOUT * (tilt - self._mean)
        deviation = np.hypot(*(tilt - self._mean))
        for mean, reading in (
            (self._belly, belly / np.maximum(total, _FOOT_LOADED * self._weight)),
            (self._stumbling, contradicts.mean(axis=1)),
            (self._tilt, deviation),
        ):
            mean[free] = (reading + self._keep * (mean - reading))[free]
        self._since[free] += self._period
