"""Any movement as a table of servo angles: what every hinge does over one cycle, up and down as well as sideways."""

import numpy as np

from suchus.design import AnyRobot, layout
from suchus.motion.angle_table import MOST_ANGLES, AngleTable, Curve
from suchus.motion.any_body import AnyGait, intended
from suchus.motion.timing import START


def as_table(robot: AnyRobot, gait: AnyGait, samples: int = 64) -> AngleTable:
    """Return the servo angles of a movement over one cycle as a table, to be changed by hand or in a file.

    Between the samples a table is smooth where a gait may have a corner, at lift-off and touch-down of a foot; with
    64 samples the crawl's angles differ by less than 0.002 rad.

    Args:
        robot: the design.
        gait: the movement, which the robot can follow.
        samples: of one cycle [-].

    Raises:
        OutsideLimits: the robot cannot follow it.
    """
    clock = np.arange(min(samples, MOST_ANGLES)) / min(samples, MOST_ANGLES)
    angles = intended(robot, gait, START + clock * gait.period).targets
    named = zip(layout(robot).servos, angles.T, strict=True)
    moved = {name: curve[:1] if np.ptp(curve) < 1e-9 else curve for name, curve in named}
    return AngleTable(
        name=f"{gait.name}_table",
        period=gait.period,
        duty_factor=gait.duty_factor,
        limb_phases=gait.limb_phases,
        curves=tuple(
            Curve(servo=name, angles=tuple(float(round(one, 6)) for one in curve))
            for name, curve in moved.items()
            if np.any(np.abs(curve) > 1e-12)
        ),
    )
