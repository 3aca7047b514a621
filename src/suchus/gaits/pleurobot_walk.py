"""A walk of Pleurobot: diagonal limbs whose elbows point up and back, the trunk in a standing wave."""

from math import radians

from suchus.design.reasons import Reason, chosen_numbers
from suchus.motion import AxialWave, FootPath, Pattern

gait = Pattern(
    name="pleurobot_walk",
    period=2.0,
    duty_factor=0.6,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    girdles=(
        FootPath(stroke=0.22, lift=0.15, outward=0.60, ahead=0.0, plane=radians(-20)),
        FootPath(stroke=0.25, lift=0.17, outward=0.60, ahead=0.0, plane=radians(20)),
    ),
    height=0.45,
    wave=AxialWave(
        amplitude=((0.15, radians(0)), (0.2, radians(12)), (0.5, radians(12)), (0.6, radians(-6)), (0.95, radians(-8))),
        waves=0.0,
        phase=0.0,
    ),
)
"""The walk of the robot with four joints a limb."""
made_for = ("pleurobot",)
"""Robots of the shelf whose gait it is."""

_REASONS = (
    Reason(r"^wave\.", 0.5, 1.5, "the standing wave of the walking animal, a dozen degrees a joint"),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^girdles|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = chosen_numbers(gait, _REASONS)
"""Every number with its plausible range and the reason."""
