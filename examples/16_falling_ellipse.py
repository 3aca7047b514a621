"""A heavy ellipse that is let go in still water; the grid travels with it."""

import numpy as np

from suchus import flow
from suchus.visual.figures.flow import vorticity

gravity, density = 2.0, 2.0
ellipse = flow.FreeBody(
    shape=flow.Ellipse(length=1.0, width=0.4), angle=0.3, density=density, gravity=(0.0, -gravity), name="ellipse"
)
grid = flow.Grid.covering((-1.6, 1.6), (-1.2, 2.0), cell=1 / 32)
sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 200, bodies=(ellipse,), follow="ellipse"))
record = sim.run(5.0)
vorticity(sim, limit=10.0).savefig("falling_ellipse.png")
x, y, angle = (record.column(name)[-1] for name in ("x", "y", "angle"))
print(f"after 5 s it is {-y:.2f} m lower and {abs(x):.2f} m aside, turned by {np.degrees(angle - 0.3):.0f} degrees")
