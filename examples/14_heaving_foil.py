"""A foil that heaves and pitches in a stream: thrust, power and efficiency of its second period."""

import numpy as np

from suchus import flow
from suchus.visual.figures.flow import vorticity

spine = flow.foil(1.0, thickness=0.12).spine(0.0).thickened(1.75 / 48)  # a round tail that the grid resolves
foil = flow.Body(
    shape=flow.Midline(spine=lambda _: spine, deforms=False),
    motion=flow.Oscillation(frequency=0.6, heave=(0.0, 0.4), pitch=np.radians(20), pitch_phase=-np.pi / 2),
)
grid = flow.Grid.covering((-0.6, 2.6), (-1.1, 1.1), cell=1 / 48)
sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 400, stream=(1.0, 0.0), bodies=(foil,)))
late = sim.run(2 / 0.6).select_after(1 / 0.6)
vorticity(sim, limit=12.0).savefig("heaving_foil.png")
got = late.coefficients(length=1.0, speed=1.0)
thrust, power = (np.average(value, weights=late.step) for value in (-got.drag, got.power))
print(f"thrust coefficient {thrust:.3f}, power coefficient {power:.3f}, efficiency {thrust / power:.2f}")
