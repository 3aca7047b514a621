"""The straight robot in a stream by CFD: the force and power that tow it."""

from dataclasses import replace

import numpy as np

from suchus import flow
from suchus.design import Robot
from suchus.water.held import BOX
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.tank import DENSITY, Tether
from suchus.water.undulation import STILL


def towed(robot: Robot, speed: float, setting: Tether, *, lengths: float = 4.0) -> float:
    """Return the drag of the straight body in a stream, its mean over the last length of the distance [N/m].

    Args:
        robot: whose body.
        speed: of the stream, which grows over the first half length [m/s].
        setting: grid and water; its cycles do not matter.
        lengths: distance that the stream moves [body length].

    Raises:
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow diverged.
    """
    length = robot.length
    outline = Outline(robot, setting.cells + 1)
    over = 0.5 * length / abs(speed)

    def stream(time: float) -> tuple[float, float]:
        part = min(time / over, 1.0)
        return speed * part * part * (3 - 2 * part), 0.0

    body = flow.Body(shape=replace(immersed(outline, STILL, least=setting.least(length)), deforms=False))
    grid = setting.grid(length, BOX)
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=setting.viscosity, density=DENSITY, bodies=(body,), stream=stream)
    )
    series = sim.run(lengths * length / abs(speed), progress=False).after((lengths - 1.0) * length / abs(speed))
    return float(np.average(series.force()[:, 0], weights=series.step))
