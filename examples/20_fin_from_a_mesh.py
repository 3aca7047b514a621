"""A fin from an STL file that heaves and yaws in a stream, in space: its thrust, and the pressure over its skin."""

import numpy as np
import trimesh

from suchus import flow
from suchus.visual.figures.flow import skin

ball = trimesh.creation.icosphere(subdivisions=3)  # a fin of yours comes from a CAD program
wide, thick, high = ball.vertices.T
ball.vertices = np.column_stack([0.5 * wide * (1 + 0.25 * high**2), 0.11 * thick * (1 - 0.5 * wide), 0.75 * high])
ball.apply_scale(100.0).export("fin.stl")  # in hundredths of its chord

fin = flow.Body(
    shape=flow.from_mesh("fin.stl", scale=0.01),
    motion=flow.Oscillation(
        frequency=0.7, heave=(0.0, 0.4, 0.0), centre=(0.0, 0.0, 0.0), pitch=np.radians(25), pitch_phase=-np.pi / 2
    ),
    name="fin",
)
grid = flow.Grid.covering((-1.2, 2.8), (-1.3, 1.3), (-1.3, 1.3), cell=1 / 20)
setup = flow.Setup(grid=grid, viscosity=1 / 400, stream=(1.0, 0.0, 0.0), bodies=(fin,), coarse=True)
sim = flow.Simulation(setup)
late = sim.run(2 / 0.7).select_after(1 / 0.7)
skin(sim).savefig("fin.png")
thrust = -late.coefficients(length=1.0, speed=1.0, area=1.5).drag
print(f"thrust coefficient {np.average(thrust, weights=late.step):.2f}, at Reynolds number 400")
