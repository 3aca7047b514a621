"""A flat ellipsoid that flutters down in six degrees of freedom; the grid travels with it."""

import numpy as np
from matplotlib.image import imsave

from suchus import flow
from suchus.core import rotation
from suchus.visual.figures.vortices import Viewpoint, picture
from suchus.visual.skin.mesh import Mesh, ellipsoid, join_meshes

shape = flow.Ellipsoid(length=1.0, width=1.0, height=0.28)
seed = flow.FreeBody(shape=shape, density=2.5, gravity=(0.0, 0.0, -1.0), pitch=0.6, spin_x=0.5, name="seed")
grid = flow.Grid.covering((-1.3, 1.3), (-1.3, 1.3), (-1.2, 2.0), cell=1 / 14)
sim = flow.Simulation(
    flow.Setup(grid=grid, viscosity=0.0035, bodies=(seed,), follow="seed", follow_axes=(True, True, True), coarse=True)
)
record = sim.run(11.0)

# The seed every 0.7 s, and the surface around the vortices behind it at the end
places = np.stack([record.column(name) for name in "xyz"], axis=1)
turns = rotation.matrix(record.attitude())
shown = np.searchsorted(record.time, np.arange(record.time[-1], 0.0, -0.7))
disc = ellipsoid((0.0, 0.0, 0.0), shape.half_extents, point_count=96, rings=64)
colour = np.where(disc.vertices[:, 2:] > 0, (0.85, 0.62, 0.30), (0.36, 0.42, 0.50))  # its two faces
solid = join_meshes([Mesh(disc.vertices @ turns[k].T + places[k], disc.faces, colour) for k in shown])
q = flow.second_invariant(np.stack(sim.velocity), grid.cell)
corner = np.array([grid.x[0], grid.y[0], grid.z[0]]) + sim.frame[0]
found = flow.isosurface(q, 0.3, corner, grid.cell)
vortices = Mesh(found.points, found.faces, np.full(found.points.shape, (0.45, 0.66, 0.86)))
middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
tall = float(np.ptp(places[:, 2])) + 1.7
camera = Viewpoint(azimuth=-1.2, elevation=0.12, distance=4 * tall, target=tuple(middle), width=0.44 * tall)
imsave("flutter.png", picture(solid, vortices, camera, (440, 1000)))
tilt = np.degrees(np.arccos(turns[:, 2, 2]))
print(
    f"after 11 s it is {-places[-1, 2]:.2f} m lower; its axis has been up to {tilt[record.time > 4].max():.0f} degrees"
)
print(f"off the vertical since 4 s, and it has moved up to {np.hypot(*places[:, :2].T).max():.2f} m aside")
