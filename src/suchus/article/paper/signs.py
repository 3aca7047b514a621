"""The article's four bend angles and the sums of joint angles that they stand for: converted here only.

III.D calls the angles of index 1 "pitch" and those of index 2 "yaw", yet says of the first that they go left
and right, of the second that they go to the top and bottom of the body. We name them by what they do. Left
and up are negative, right and down positive. The article states the positive side for the spine's lateral and
the tail's vertical angle only; for the other two we take the opposite of the stated negative side.
"""

from typing import Any, NamedTuple, Protocol, TypeVar, runtime_checkable


@runtime_checkable
class Signed(Protocol):
    """A number, or an array of numbers."""

    def __neg__(self) -> Any:
        """Return it with the other sign."""


Angle = TypeVar("Angle", bound=Signed)


class BendAngles(NamedTuple):
    """The angles of Figs 11 and 12 in the article's signs.

    Paper: Figs 11, 12.
    """

    spine_lateral: Any
    """theta_q1, right positive [rad]."""
    spine_vertical: Any
    """theta_q2, down positive [rad]."""
    tail_lateral: Any
    """theta_w1, right positive [rad]."""
    tail_vertical: Any
    """theta_w2, down positive [rad]."""


class JointSums(NamedTuple):
    """The same bends as sums of joint angles in the signs of ``suchus.robot.design.layout``."""

    spine_yaw: Any
    """Sum of the three yaw joints, front end left positive [rad]."""
    spine_pitch: Any
    """Sum of the two pitch joints, front end down positive [rad]."""
    tail_yaw: Any
    """Sum of the cable joints, tip right positive [rad]."""
    tail_pitch: Any
    """The tail's pitch joint, tip down positive [rad]."""


def spine_lateral(yaw_sum: Angle) -> Angle:
    """Return theta_q1 for a sum of spine yaw angles [rad], or the sum for theta_q1: the map undoes itself."""
    return -yaw_sum


def to_bend_angles(sums: JointSums) -> BendAngles:
    """Return the bend angles in the article's signs [rad] for sums of joint angles [rad]."""
    return BendAngles(
        spine_lateral=spine_lateral(sums.spine_yaw),
        spine_vertical=sums.spine_pitch,
        tail_lateral=sums.tail_yaw,
        tail_vertical=sums.tail_pitch,
    )
