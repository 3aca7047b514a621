"""What the controllers of limbs, spine and tail exchange: five quantities, each with one owner."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

from suchus.core.errors import OutsideLimits

OWNERS: Mapping[str, str] = MappingProxyType(
    {
        "limb_phase": "limbs",
        "trunk_bend": "spine",
        "trunk_direction": "spine",
        "tail_bend": "tail",
        "tail_direction": "tail",
    }
)
"""Which controller writes which shared variable; every controller reads all of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Shared:
    """The shared variables of a batch, as the article lists them; nothing else passes between the controllers.

    A direction says in which direction something is bending: it is the bend to be reached a quarter of a cycle from
    now, so that its sign is the side and bend and direction together are the whole wave.

    Paper: section III.D.
    """

    limb_phase: Float[np.ndarray, "run limb"]
    """Phase of each limb, not wrapped [cycle]; owner: limbs."""
    trunk_bend: Float[np.ndarray, " run"]
    """Lateral bend of the trunk, left positive [rad]; owner: spine."""
    trunk_direction: Float[np.ndarray, " run"]
    """Bend of the trunk a quarter of a cycle from now [rad]; owner: spine."""
    tail_bend: Float[np.ndarray, " run"]
    """Lateral bend of the tail, tip to the right positive [rad]; owner: tail."""
    tail_direction: Float[np.ndarray, " run"]
    """Bend of the tail a quarter of a cycle from now [rad]; owner: tail."""

    def updated_by(self, owner: str, **values: np.ndarray) -> "Shared":
        """Return the shared variables with new values of one owner; the new arrays are read-only.

        Args:
            owner: the controller that writes.
            **values: new values of its variables, by name.

        Raises:
            OutsideLimits: a variable that belongs to another controller.
        """
        for name, value in values.items():
            if OWNERS.get(name) != owner:
                raise OutsideLimits(
                    f"{owner!r} wrote the shared variable {name!r}, which belongs to {OWNERS.get(name, 'nobody')!r}; "
                    f"it may write {', '.join(v for v, o in OWNERS.items() if o == owner) or 'none'}."
                )
            value.flags.writeable = False
        return Shared(
            limb_phase=values.get("limb_phase", self.limb_phase),
            trunk_bend=values.get("trunk_bend", self.trunk_bend),
            trunk_direction=values.get("trunk_direction", self.trunk_direction),
            tail_bend=values.get("tail_bend", self.tail_bend),
            tail_direction=values.get("tail_direction", self.tail_direction),
        )


def initial_shared(runs: int, limbs: int) -> Shared:
    """Return the shared variables of a batch before the first control period: zeros.

    Args:
        runs: number of runs.
        limbs: number of limbs of each robot.
    """
    zeros = np.zeros(runs)
    return Shared(
        limb_phase=np.zeros((runs, limbs)),
        trunk_bend=zeros,
        trunk_direction=zeros,
        tail_bend=zeros,
        tail_direction=zeros,
    )
