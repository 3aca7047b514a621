"""Periodic forces of a tethered swimmer, and the same swimmer towed through still water: two frames, one flow."""

import numpy as np

from suchus import flow

cells, speed = 64, 0.4
waves = flow.eel(1.0, stations=2 * cells + 1)
swimmer = flow.Midline(spine=lambda time: waves.spine(time).thickened(1.75 / cells))
grid = flow.Grid.covering((-0.6, 1.8), (-0.6, 0.6), cell=1 / cells)


def forces(stream, motion, follow):
    """Return the mean force along x and the rms force across in each of two periods, after one to start."""
    body = flow.Body(shape=swimmer, motion=motion)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=5e-4, stream=stream, bodies=(body,), follow=follow))
    record = sim.run(3.0)
    rows = []
    for first in (1.0, 2.0):
        k = (record.time > first) & (record.time <= first + 1)
        fx, fy = record.force()[k].T
        rows.append((np.average(fx, weights=record.step[k]), np.sqrt(np.average(fy**2, weights=record.step[k]))))
    return np.array(rows)


held = forces((speed, 0.0), flow.Pose(), None)
towed = forces((0.0, 0.0), flow.Glide(start=(0.0, 0.0), velocity=(-speed, 0.0)), "body")
for name, rows in (("tethered in a stream", held), ("towed through still water", towed)):
    (x, aside), (later_x, later) = rows
    print(f"{name}: second period {x:+.4f} along x, {aside:.4f} rms across; third {later_x:+.4f}, {later:.4f}")
