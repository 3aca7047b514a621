"""An aerofoil in a stream at Reynolds number 1000, with fine cells around it and coarse ones in its wake."""

from math import radians

from suchus import flow
from suchus.visual.figures.flow import vorticity

whole = flow.Grid.covering((-1.7, 4.0), (-1.4, 1.4), cell=1 / 24)
fine = whole.patch((-0.4, 1.6), (-0.5, 0.4), ratio=4)
aerofoil = flow.Body(shape=flow.foil(1.0, thickness=0.12), motion=flow.Pose(angle=radians(-10)))
stream = flow.Simulation(
    flow.Setup(grid=fine, coarse_grid=whole, viscosity=1 / 1000, stream=(1.0, 0.0), bodies=(aerofoil,))
)
late = stream.run(6.0).select_after(4.0).coefficients(length=1.0, speed=1.0)
vorticity(stream, limit=12.0).savefig("patch_of_fine_cells.png")
print(f"drag {late.drag.mean():.3f}, lift {late.lift.mean():.3f}")
