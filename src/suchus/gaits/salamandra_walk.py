"""A walk of Salamandra robotica: cranks that stand slowly and return fast, the trunk in a standing wave."""

from math import radians

from suchus.design.reasons import Reason, chosen_numbers
from suchus.motion import AxialWave, Pattern, Sweep

_TURN = Sweep(stance=radians(80), down=0.0)
gait = Pattern(
    name="salamandra_walk",
    period=1.5,
    duty_factor=0.55,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    girdles=(_TURN, _TURN),
    height=0.75,
    wave=AxialWave(
        amplitude=((0.12, radians(0)), (0.2, radians(12)), (0.5, radians(12)), (0.6, radians(-8)), (0.9, radians(-10))),
        waves=0.0,
        phase=0.0,
    ),
)
"""The walk of the crank-legged robot."""
made_for = ("salamandra",)
"""Robots of the shelf whose gait it is."""

_REASONS = (
    Reason(
        r"^wave\.", 0.5, 1.5, "the standing wave of the walking animal, a dozen degrees a joint within the range of 65"
    ),
    Reason(r"^period$", 0.5, 2.0, "a slow walk, at which every posture is nearly static"),
    Reason(r"^(duty_factor|limb_phases)", 0.8, 1.3, "opposite limbs in turn, a little more stance than swing"),
    Reason(r"^girdles|^height$", 0.7, 1.4, "within what the limbs reach, the belly clear of the ground"),
)
chosen = chosen_numbers(gait, _REASONS)
"""Every number with its plausible range and the reason."""
