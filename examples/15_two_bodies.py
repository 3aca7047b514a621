"""Two cylinders one behind the other; the rear one hangs on a spring and rings in the wake of the front one."""

import numpy as np

from suchus import flow

front = flow.Body(shape=flow.Cylinder(diameter=1.0), name="front")
rear = flow.FreeBody(
    shape=flow.Cylinder(diameter=1.0),
    start=(2.5, 0.1),
    density=2.0,
    free=(False, True, False),  # locked along x and in turning
    springs=(0.0, 2.5, 0.0),
    dampers=(0.0, 0.1, 0.0),
    name="rear",
)
grid = flow.Grid.covering((-2.0, 7.0), (-2.5, 2.5), cell=1 / 16)
setup = flow.Setup(
    grid=grid,
    viscosity=1 / 100,
    stream=(1.0, 0.0),
    bodies=(front, rear),
    contact=flow.BodyContact(gap=2 / 16, pressure=10.0),  # had they come near each other
)
rake = flow.Rake(points=flow.line((4.0, -2.0), (4.0, 2.0), 21), interval=0.25)
sim = flow.Simulation(setup)
late = sim.run(15.0, watch=rake).select_after(10.0)
swing = np.ptp(late.column("y", "rear")) / 2
behind = rake.velocity[rake.time > 10.0, :, 0].mean(axis=0)
print(f"the rear cylinder swings by {swing:.3f} diameters and stays at x = {late.column('x', 'rear')[-1]}")
print(f"the stream 1.5 diameters behind it, mean over 5 s: {behind.min():.2f} to {behind.max():.2f}")
