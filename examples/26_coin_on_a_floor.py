"""A coin that is let go at an angle sways down through water and comes to rest on the floor of a tank."""

import numpy as np
from matplotlib.patches import Polygon

from suchus import flow
from suchus.visual.figures.flow import vorticity

coin = flow.FreeBody(
    shape=flow.Ellipse(length=1.0, width=0.25),
    start=(0.0, 2.8),
    angle=0.6,
    density=2.0,
    gravity=(0.0, -1.0),
    name="coin",
)
sides = flow.Sides(bottom=flow.Wall())  # the floor; the other sides are open
grid = flow.Grid.covering((-3.0, 3.0), (0.0, 3.6), cell=1 / 16, sides=sides)
contact = flow.BodyContact(gap=2.5 * grid.cell, pressure=10.0)  # bears the coin nearer than the grid resolves
setup = flow.Setup(grid=grid, viscosity=1 / 150, bodies=(coin,), sides=sides, contact=contact)
sim, outlines = flow.Simulation(setup), []
record = sim.run(16.0, watch=lambda sim: outlines.append(sim.surface().markers.points), watch_interval=1.0)

figure = vorticity(sim, limit=2.0)
for points in outlines:  # the coin at every second
    figure.axes[0].add_patch(Polygon(points.T, fill=False, edgecolor="0.35", linewidth=0.7))
figure.savefig("coin.png")
x, y, angle, speed = (record.column(name) for name in ("x", "y", "angle", "velocity_y"))
landed = record.time[np.flatnonzero(y > 0.3)[-1]]
print(f"it falls with up to {-speed.min():.2f} m/s and has come down after {landed:.1f} s, at x = {x[-1]:.2f} m")
print(f"at the end its middle is {y[-1]:.3f} m above the floor, turned by {np.degrees(angle[-1]):.0f} degrees")
