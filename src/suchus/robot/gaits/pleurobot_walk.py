"""A walk of Pleurobot: diagonal limbs whose elbows point up and back, the trunk in a standing wave."""

from math import radians

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Bend, FootPath, Gait

_TAIL = (3.2307692307692186, 6.395604395604396, 6.879120879120879, 7.362637362637363, 7.846153846153846)
"""Amplitudes of the tail's joints, toward the tip [degree]."""
gait = Gait(
    name="pleurobot_walk",
    period=2.0,
    duty_factor=0.6,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    limbs=(
        FootPath(stroke=0.22, lift=0.15, outward=0.60, ahead=0.0, swivel=radians(-20)),
        FootPath(stroke=0.25, lift=0.17, outward=0.60, ahead=0.0, swivel=radians(20)),
    ),
    height=0.45,
    axis=(
        Bend(part="neck", amplitude=(0.0, 2 * radians(2.769230769230765))),
        Bend(part="trunk", amplitude=(radians(48),)),
        Bend(part="tail", amplitude=tuple(5 * radians(angle) for angle in _TAIL), lag=(0.5,)),
    ),
)
"""The walk of the robot with four joints a limb."""
made_for = ("pleurobot",)
"""Robots of the catalog whose gait it is."""
trunk_steering = {"pleurobot": -0.36, "caiman": -0.77}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_REASONS = (
    Reason(r"^axis", 0.5, 1.5, "the standing wave of the walking animal, a dozen degrees a joint"),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^limbs|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = assumptions_of(gait, _REASONS)
"""Every number with its plausible range and the reason."""
