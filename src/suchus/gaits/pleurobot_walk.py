"""A walk of Pleurobot: diagonal limbs whose elbows point up and back, the trunk in a standing wave."""

from math import radians

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
