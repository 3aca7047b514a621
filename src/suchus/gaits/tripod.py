"""A tripod gait of six legs: front and hind leg of one side with the middle one of the other."""

from math import radians

from suchus.motion import AxialWave, FootPath, Pattern

_PATH = FootPath(stroke=0.20, lift=0.18, outward=0.55, ahead=0.0)
gait = Pattern(
    name="tripod",
    period=1.0,
    duty_factor=0.55,
    limb_phases=(0.0, 0.5, 0.5, 0.0, 0.0, 0.5),
    girdles=(_PATH, _PATH, _PATH),
    height=0.55,
    wave=AxialWave(amplitude=((0.0, radians(5)), (1.0, radians(5))), waves=0.0, phase=0.0),
)
