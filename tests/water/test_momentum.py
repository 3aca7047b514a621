import numpy as np

from suchus import flow
from suchus.water import Outline, Tether, fit, immersed, printed_wave


def test_body_and_water_together_keep_their_momentum(robot):
    """The water's momentum, followed through a box, is what the forces took from the body."""
    outline, viscosity = Outline(robot, 49), 1e-3
    shape = immersed(outline, fit(robot, printed_wave(robot)).swim, grow=0.5)
    grid = Tether(cells=48, viscosity=viscosity, cycles=1).grid(robot.length, (3.5, 2.0))
    body = flow.FreeBody(shape=shape, start=(0.5 * robot.length, 0.0))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=viscosity, density=1000.0, bodies=(body,)))
    sim.control(0.2 * robot.length)
    record = sim.run(1.0, progress=False)
    step = record.step[:, None]
    taken, scale = np.nansum(sim.control_forces * step, axis=0), np.abs(record.force() * step).sum(axis=0)
    gained = 1000.0 * shape.mass(1.0).area * np.array([record.column(f"velocity_{a}")[-1] for a in "xy"])
    np.testing.assert_allclose((record.force() * step).sum(axis=0), taken, atol=0.02 * scale.max())
    # the body feels the force of the last step, so that its momentum comes a little later
    np.testing.assert_allclose(gained, taken, atol=0.05 * scale.max())
