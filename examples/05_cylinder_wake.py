"""A cylinder in a stream at Reynolds number 150: its wake as a picture, and its Strouhal number."""

from suchus import flow
from suchus.visual.figures.flow import vorticity

grid = flow.Grid.covering((-4.0, 12.0), (-4.0, 4.0), cell=1 / 16)
cylinder = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(position=(0.0, 0.1)))
wake = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 150, stream=(1.0, 0.0), bodies=(cylinder,)))
late = wake.run(80.0).select_after(55.0)
vorticity(wake, limit=3.0).savefig("cylinder_wake.png")
print("Strouhal number", round(flow.strouhal(late.time, late.force()[:, 1], length=1.0, speed=1.0), 3))
