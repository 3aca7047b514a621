"""The cycle: limb phases, who stands, and how trunk and tail bend with the limbs."""

import numpy as np
from jaxtyping import Bool, Float

from suchus.motion.gait import Gait
from suchus.motion.timing import START

_SIDES = np.array([1.0, -1.0, -1.0, 1.0])  # LF and RH bend the trunk one way, RF and LH the other


def limb_phase(gait: Gait, time: Float[np.ndarray, "*b"]) -> Float[np.ndarray, "*b 4"]:
    """Return the phase of each limb, without wrapping [cycle].

    Before the walk begins the phases stand still.

    Args:
        gait: the gait.
        time: since the beginning of the run [s].
    """
    cycles = np.maximum(time - START, 0.0) / gait.period
    return np.asarray(cycles[..., None] + np.array(gait.limb_phases))


def stance(gait: Gait, phase: Float[np.ndarray, "*b 4"]) -> Bool[np.ndarray, "*b 4"]:
    """Tell which feet are meant to stand."""
    return np.asarray(np.mod(phase, 1.0) >= 1.0 - gait.duty_factor)


def trunk_bend(gait: Gait, phase: Float[np.ndarray, "*b 4"]) -> Float[np.ndarray, "*b"]:
    """Return the lateral bend of the trunk, left positive [rad].

    The four limbs each pull with a quarter of the amplitude. In a diagonal gait this is a standing wave whose
    extreme falls on touch-down: when LF and RH touch down, the trunk is concave on the right, so that both girdles
    carry their new stance foot ahead. In a gait without diagonal pairs the pulls cancel.

    Args:
        gait: the gait.
        phase: of the limbs [cycle].
    """
    return np.asarray(-gait.trunk_bend * _pull(gait, phase, gait.spine_phase))


def tail_bend(gait: Gait, phase: Float[np.ndarray, "*b 4"]) -> Float[np.ndarray, "*b"]:
    """Return the lateral bend of the tail, tip to the right positive [rad]."""
    return np.asarray(-gait.tail_bend * _pull(gait, phase, gait.spine_phase + gait.tail_phase))


def _pull(gait: Gait, phase: Float[np.ndarray, "*b 4"], lag: float) -> Float[np.ndarray, "*b"]:
    before_touch_down = 0.75 - gait.duty_factor / 2  # a quarter cycle before mid-stance
    angle = 2 * np.pi * (phase - before_touch_down - lag)
    return np.asarray(np.cos(angle) @ _SIDES / 4)
