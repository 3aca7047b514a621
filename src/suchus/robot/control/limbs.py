"""Limb to limb: one phase oscillator per limb, whose rate depends on the loads of the feet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.control.shared import Shared
from suchus.robot.design import GRAVITY, Layout, Robot, layout
from suchus.robot.motion import Gait
from suchus.robot.motion.limbs import in_steps

_DIAGONAL = 0.02  # [cycle]; greatest deviation from diagonal pairs in a gait for laws that make such pairs


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbLaw:
    """How the phase of a limb answers to loads and to the trunk's torque.

    With theta the limb's phase as an angle whose middle of stance is at 270 degrees, n the load of a foot over its
    quarter of the weight, s = 1 for LF and RH and -1 for RF and LH, and u the sum of the trunk's yaw torques over
    its limit:

        d(theta)/dt = 2 pi/T [1 - cos(theta - shift) (own n + diagonal n_d + contralateral n_c + ipsilateral n_i)
                                - trunk s u cos(theta)]

    A foot that still carries load late in its stance waits; one that is loaded early hurries to mid-stance.
    """

    own: float = 0.0
    """Weight of the foot's own load [-]."""
    diagonal: float = 0.0
    """Weight of the load of the foot diagonally opposite [-]."""
    contralateral: float = 0.0
    """Weight of the load of the other foot of the same girdle [-]."""
    ipsilateral: float = 0.0
    """Weight of the load of the other foot of the same side [-]."""
    trunk: float = 0.0
    """Weight of the trunk's yaw torque [-]."""
    shift: float = 0.0
    """Phase shift of the answer to loads [rad]; at the phase where the load peaks the mean clock is not slowed."""
    delay: float = 0.04
    """Time constant of the low-pass filter on loads and torque [s]; as slow as a rubber foot is anyway."""
    clip: float = 2.5
    """Most that a load counts, in quarters of the weight [-]; two feet carry everything in the crawl, impacts more."""

    def __post_init__(self) -> None:
        with Checks("limb_law", self) as checks:
            for name in ("own", "diagonal", "contralateral", "ipsilateral", "trunk"):
                checks.number(name, -10.0, 10.0, "")
            checks.number("shift", -pi, pi, "rad")
            checks.number("delay", 0.0, 10.0, "s")
            checks.number("clip", 0.1, 100.0, "")

    @property
    def feels(self) -> bool:
        """Whether any sensor counts."""
        return any((self.own, self.diagonal, self.contralateral, self.ipsilateral, self.trunk))

    @property
    def needs(self) -> tuple[str, ...]:
        """Loads under the feet and torques of the trunk."""
        return ("foot_pressure", "servo_torque") if self.feels else ()

    @property
    def pairs(self) -> bool:
        """Whether it makes diagonal pairs, whatever the gait."""
        return any((self.diagonal, self.contralateral, self.ipsilateral, self.trunk))


_CROSS = LimbLaw(own=0.1, diagonal=0.1, contralateral=-0.1, ipsilateral=-0.1, shift=0.244)
LAWS: Mapping[str, LimbLaw] = MappingProxyType(
    {
        "off": LimbLaw(),
        "own_load": LimbLaw(own=0.2, shift=0.244),
        "cross_load": _CROSS,
        "body_limb": LimbLaw(trunk=0.3),
        "wrong_sign": replace(_CROSS, own=-0.1, diagonal=-0.1, contralateral=0.1, ipsilateral=0.1),
    }
)
"""The laws by name.

``off``: the clock alone. ``own_load``: each limb feels its own foot and receives nothing else (Owaki and Ishiguro
2017); coordination is then mechanical. ``cross_load``: the loads of the two diagonal pairs against each other.
``body_limb``: the limbs feel the trunk's torque, in the spirit of Suzuki et al. 2021 (our own form: theirs is for
another body). ``wrong_sign``: the cross-load law reversed, which must fail.
"""


class Loads:
    """The filtered loads of feet and trunk of a batch, and their effect on the limbs' clocks.

    Args:
        laws: law of each run.
        robots: robot of each run.
        gaits: gait of each run.
        period: control period [s].
    """

    def __init__(self, laws: Sequence[LimbLaw], robots: Sequence[Robot], gaits: Sequence[Gait], period: float) -> None:
        place = layout(robots[0])
        self.has_feedback = any(law.feels for law in laws)
        self._weights = np.array([_weights(law, place) for law in laws])
        self._trunk, self._shift, self._clip = (
            np.array([getattr(law, name) for law in laws])[:, None] for name in ("trunk", "shift", "clip")
        )
        self._keep = np.array([decay_factor(law.delay, period) for law in laws])[:, None]
        self._mid_stance_phase = np.array([gait.duty_factor / 2 - 0.25 for gait in gaits])[:, None]
        self._weight_per_limb = np.array([robot.mass * GRAVITY / max(len(place.limbs), 1) for robot in robots])[:, None]
        self._torque = np.array([_trunk_torque(robot) for robot in robots])[:, None]
        self._sides = np.array([limb.side * (-1.0) ** limb.number for limb in place.limbs])
        self._yaw = in_steps(place.trunk_yaw)
        self._has_trunk = bool(self._trunk.any())
        self._load: np.ndarray | None = None
        self._twist: np.ndarray | None = None

    def take_over(self, predecessor: "Loads") -> None:
        """Go on with the filtered loads of the same runs."""
        self._load, self._twist = predecessor._load, predecessor._twist

    def feel(self, sensed: Sensed) -> None:
        """Update the low-pass-filtered foot loads and trunk torque."""
        load = np.minimum(finite(sensed.foot_pressure) / self._weight_per_limb, self._clip)
        twist = finite(sensed.servo_torque[:, self._yaw]).sum(axis=1, keepdims=True) / self._torque
        self._load = load if self._load is None else load + self._keep * (self._load - load)
        self._twist = twist if self._twist is None else twist + self._keep * (self._twist - twist)

    def brake(self, phase: Float[np.ndarray, "run limb"]) -> Float[np.ndarray, "run limb"]:
        """Return the fraction by which each limb's clock is slowed [-]; 0 before the first reading.

        Args:
            phase: phase of the limbs [cycle].
        """
        if self._load is None or self._twist is None:
            return np.zeros_like(phase)
        angle = 2 * pi * (phase + self._mid_stance_phase)
        load_feedback = (self._weights * self._load[:, None, :]).sum(axis=-1)
        brake = np.cos(angle - self._shift) * load_feedback
        if self._has_trunk:
            brake = brake + self._trunk * np.cos(angle) * self._sides * self._twist
        return np.asarray(brake)


class Limbs:
    """The oscillators of a batch; their state is each limb's phase lead over the gait's clock."""

    def __init__(
        self,
        laws: Sequence[LimbLaw],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        phase_lead: Float[np.ndarray, "run limb"],
        period: float,
    ) -> None:
        """Start the oscillators at a phase lead over the clock of the gait.

        Args:
            laws: law of each run.
            robots: robot of each run.
            gaits: gait of each run.
            phase_lead: phase lead of each limb over the clock [cycle].
            period: control period [s].

        Raises:
            OutsideLimits: a law makes diagonal pairs, and the gait has others.
        """
        for law, gait in set(zip(laws, gaits, strict=True)):
            if law.pairs:
                _refuse_others(gait, layout(robots[0]))
        self.phase_lead = phase_lead
        self._loads = Loads(laws, robots, gaits, period)
        self._cycles_per_tick = period / np.array([gait.period for gait in gaits])[:, None]

    def step(
        self, shared: Shared, sensed: Sensed | None, clock: Float[np.ndarray, "run limb"], *, walking: bool
    ) -> Shared:
        """Advance the oscillators by one control period.

        Args:
            shared: what the others say.
            sensed: sensor readings of the robots.
            clock: phase of each limb by the gait's clock [cycle].
            walking: whether the walk has begun; before, the phases stand still.
        """
        if self._loads.has_feedback and sensed is not None:
            self._loads.feel(sensed)
            if walking:
                self.phase_lead = self.phase_lead - self._cycles_per_tick * self._loads.brake(shared.limb_phase)
        return shared.updated_by("limbs", limb_phase=clock + self.phase_lead)

    def take_over(self, predecessor: "Limbs") -> None:
        """Continue from the oscillators of the same runs; limbs without feedback return to the clock."""
        if self._loads.has_feedback:
            self.phase_lead = predecessor.phase_lead
            self._loads.take_over(predecessor._loads)

    def kick(self, run: int, phase_lead: Float[np.ndarray, " limb"]) -> None:
        """Add a phase lead to the limbs of one run [cycle]."""
        self.phase_lead = self.phase_lead.copy()
        self.phase_lead[run] += phase_lead


def _trunk_torque(robot: Robot) -> float:
    """Return the sum of the torque limits of the trunk's yaw servos; 1 for a robot without any [N m]."""
    place = layout(robot)
    return sum(place.robot.servo(place.servos[i]).torque for i in place.trunk_yaw) or 1.0


def in_pairs(place: Layout, gait: Gait) -> bool:
    """Return whether diagonal limbs of a gait step together and those of a girdle take turns."""
    return _off_pairs(place, gait) <= _DIAGONAL


def _off_pairs(place: Layout, gait: Gait) -> float:
    phases = gait.limb_phases
    pairs = [(i, j, 0.0) for i, limb in enumerate(place.limbs) for j in limb.diagonal]
    pairs += [(i, limb.contralateral, 0.5) for i, limb in enumerate(place.limbs)]
    return max(abs((phases[i] - phases[j] + phase_offset + 0.5) % 1.0 - 0.5) for i, j, phase_offset in pairs)


def _refuse_others(gait: Gait, place: Layout) -> None:
    """Refuse a gait whose limb phases are too far from diagonal pairs for a law that makes such pairs."""
    deviation = _off_pairs(place, gait)
    if deviation > _DIAGONAL:
        raise OutsideLimits(
            f"gait {gait.name!r} has limb phases {gait.limb_phases}, {deviation:.2f} cycle away from diagonal pairs; "
            "this limb law would turn it into a trot: use the law 'off' or 'own_load'."
        )


def _weights(law: LimbLaw, place: Layout) -> list[list[float]]:
    """Return the weight of each foot's load (column) for each limb (row); two neighbours count half each [-]."""
    weights = np.zeros((len(place.limbs), len(place.limbs)))
    for i, limb in enumerate(place.limbs):
        weights[i, i] = law.own
        weights[i, limb.contralateral] = law.contralateral
        for neighbours, weight in ((limb.ipsilateral, law.ipsilateral), (limb.diagonal, law.diagonal)):
            for neighbour in neighbours:
                weights[i, neighbour] = weight / len(neighbours)
    rows: list[list[float]] = weights.tolist()
    return rows
