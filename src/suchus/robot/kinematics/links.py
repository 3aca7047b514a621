"""The lengths that kinematics needs of a robot, as protocols."""

from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

Numbers: TypeAlias = int | float | np.ndarray
"""One number or an array of them."""


@runtime_checkable
class LegLinks(Protocol):
    """The lengths of a leg; ``suchus.robot.design.Leg`` has them."""

    @property
    def hip_offset(self) -> float:
        """Distance from the midline to the yaw axis, a0 [m]."""

    @property
    def femur(self) -> float:
        """Length from hip to knee, a2 [m]."""

    @property
    def tibia(self) -> float:
        """Length from knee to foot, a3 [m]."""


@runtime_checkable
class SpineLinks(Protocol):
    """The lengths of a spine; ``suchus.robot.design.Spine`` has them."""

    @property
    def base(self) -> float:
        """Length from frame 0 to the first joint, a0 [m]."""

    @property
    def link(self) -> float:
        """Length from each joint to the next, a1 to a4 [m]."""


@runtime_checkable
class Cords(Protocol):
    """The measures of a cable over several joints; ``Tail`` and ``Cable`` of ``robot.design`` have them."""

    @property
    def joints(self) -> int:
        """Number of joints, N [-]."""

    @property
    def cord_spacing(self) -> float:
        """Between the two cords, d [m]."""

    @property
    def pulley(self) -> float:
        """Radius of the servo's pulley, r [m]."""


@runtime_checkable
class TailPlates(Cords, Protocol):
    """The measures of a tail's cable section; ``suchus.robot.design.Tail`` has them."""

    @property
    def plate(self) -> float:
        """Thickness of a plate, H [m]."""

    @property
    def gap(self) -> float:
        """Gap between plates, h [m]."""
