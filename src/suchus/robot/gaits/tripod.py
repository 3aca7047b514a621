"""A tripod gait of six legs: front and hind leg of one side with the middle one of the other."""

from math import radians

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Bend, FootPath, Gait

_PATH = FootPath(stroke=0.20, lift=0.18, outward=0.55, ahead=0.0)
gait = Gait(
    name="tripod",
    period=1.0,
    duty_factor=0.55,
    limb_phases=(0.0, 0.5, 0.5, 0.0, 0.0, 0.5),
    limbs=(_PATH, _PATH, _PATH),
    height=0.55,
    axis=(Bend(part="trunk", amplitude=(radians(10),)),),
)
"""The insects' gait."""
made_for = ("strider",)
"""Robots of the catalog whose gait it is."""
trunk_steering = {"strider": 0.02}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_REASONS = (
    Reason(r"^axis", 0.5, 1.5, "a little bend with the legs, to show that the axis takes part"),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^limbs|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = assumptions_of(gait, _REASONS)
"""Every number with its plausible range and the reason."""
