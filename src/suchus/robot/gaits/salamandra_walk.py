"""A walk of Salamandra robotica: cranks that stand slowly and return fast, the trunk in a standing wave."""

from math import radians

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Bend, Gait, Sweep

_TRUNK = (12.0, 12.0, 12.0, 1.2018779342722972)  # [degree]; of its joints, from the head
_TAIL = (8.436619718309858, 9.179968701095461, 9.923317683881061)  # [degree]; toward the tip
_TURN = Sweep(stance=radians(80), down=0.0)
gait = Gait(
    name="salamandra_walk",
    period=1.5,
    duty_factor=0.55,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    limbs=(_TURN, _TURN),
    height=0.75,
    axis=(
        Bend(part="neck", amplitude=(radians(1.0140845070422577),)),
        Bend(part="trunk", amplitude=tuple(4 * radians(angle) for angle in _TRUNK)),
        Bend(part="tail", amplitude=tuple(3 * radians(angle) for angle in _TAIL), lag=(0.5,)),
    ),
)
"""The walk of the crank-legged robot."""
made_for = ("salamandra",)
"""Robots of the catalog whose gait it is."""
trunk_steering = {"salamandra": 0.37}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_REASONS = (
    Reason(
        r"^axis", 0.5, 1.5, "the standing wave of the walking animal, a dozen degrees a joint within the range of 65"
    ),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^limbs|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = assumptions_of(gait, _REASONS)
"""Every number with its plausible range and the reason."""
