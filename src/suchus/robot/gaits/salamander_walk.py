"""A walk of the salamander: diagonal limbs, the trunk in a standing wave against the tail."""

from math import radians

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Bend, FootPath, Gait

_TAIL = (6.0, 8.829694323144105, 11.633187772925764, 12.93, 14.0)  # [degree]; of its joints, toward the tip
_PATH = FootPath(stroke=0.30, lift=0.20, outward=0.60, ahead=0.0)
gait = Gait(
    name="salamander_walk",
    period=1.0,
    duty_factor=0.55,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    limbs=(_PATH, _PATH),
    height=0.45,
    axis=(
        Bend(part="trunk", amplitude=(radians(36),)),
        Bend(part="tail", amplitude=tuple(5 * radians(angle) for angle in _TAIL), lag=(0.5,)),
    ),
)
"""Diagonal limbs and a standing wave, as the animal walks."""
made_for = ("salamander",)
"""Robots of the catalog whose gait it is."""
trunk_steering = {"salamander": 0.21, "caiman": -0.55}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_REASONS = (
    Reason(
        r"^axis",
        0.5,
        1.5,
        "as a walking salamander: a standing wave with its nodes at the girdles, 15 to 20 degrees a joint in the trunk",
    ),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^limbs|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = assumptions_of(gait, _REASONS)
"""Every number with its plausible range and the reason."""
