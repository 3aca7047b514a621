"""A walk of Salamandra robotica: cranks that stand slowly and return fast, the trunk in a standing wave."""

from math import radians

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
