"""Lateral undulation: one wave along the whole axis, from head to tail, growing backward; no limbs."""

from math import radians

from suchus.motion import AxialWave, Pattern

gait = Pattern(
    name="undulation",
    period=1.0,
    duty_factor=0.5,
    limb_phases=(),
    girdles=(),
    height=0.0,
    wave=AxialWave(amplitude=((0.0, radians(15)), (1.0, radians(35))), waves=1.0, phase=0.0),
)
