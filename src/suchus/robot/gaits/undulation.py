"""Lateral undulation: one wave along the whole axis, from head to tail, growing backward; no limbs."""

from math import radians

from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.motion import Bend, Gait

gait = Gait(
    name="undulation",
    period=1.0,
    duty_factor=0.5,
    axis=(Bend(part="axis", amplitude=(radians(1850 / 11), radians(3650 / 11)), lag=(1 / 11, 10 / 11)),),
)
"""At the places of ten hinges, one wavelength along the body, 15 degrees a hinge at the snout and 35 at the tip.

For water; on even ground it hardly moves, since friction is the same along the body and across."""
made_for = ("swimmer",)
"""Robots of the catalog whose gait it is."""

_REASONS = (
    Reason(r"^axis", 0.5, 1.5, "an eel-like wave: one wavelength on the body, growing toward the tail"),
    Reason(r"^period$", 0.5, 2.0, "about the frequency at which its servos reach these angles"),
    Reason(r"^(duty_factor)", 0.8, 1.3, "it has no limbs: unused"),
)
chosen = assumptions_of(gait, _REASONS)
"""Every number with its plausible range and the reason."""
