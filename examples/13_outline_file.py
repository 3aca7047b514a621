"""A body from a file of its outline, in a stream: its drag, and its fields for ParaView."""

import numpy as np

from suchus import flow

turn = np.linspace(0, 2 * np.pi, 120, endpoint=False)
np.savetxt("outline.csv", 0.5 * np.stack([np.cos(turn), np.sin(turn)], axis=1), delimiter=",")  # or a file of yours

body = flow.Body(shape=flow.from_outline("outline.csv"))
grid = flow.Grid.covering((-2.0, 5.0), (-2.0, 2.0), cell=1 / 16)
sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 40, stream=(1.0, 0.0), bodies=(body,)))
series = flow.FieldSeries("outline.pvd", times=(2.0, 4.0, 6.0))  # open it in ParaView
late = sim.run(6.0, watch=series).select_after(5.0)
drag = late.coefficients(length=1.0, speed=1.0).drag
print(f"drag coefficient at Reynolds number 40, 6 s after the start: {drag.mean():.2f}")
