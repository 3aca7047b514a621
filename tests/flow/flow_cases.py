"""Flows that small tests and the validation share: each answers with numbers, at a resolution of the caller's."""

from dataclasses import replace

import numpy as np

from suchus import flow
from suchus.flow.compiled import PAD


def taylor_green(n, *, viscosity=0.02, until=0.5):
    """RMS error of the decaying vortices in the unit square [m/s]."""
    grid = flow.Grid(cells=(n, n), cell=1 / n)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=viscosity, sides=flow.Sides.periodic(), precision="double", tolerance=1e-8, courant=0.5
        )
    )
    k = 2 * np.pi
    faces, mids = grid.faces(0, n + 2 * PAD, 0), grid.centres(0, n + 2 * PAD, 0)
    sim.water.u[:] = np.sin(k * faces)[None, :] * np.cos(k * mids)[:, None]
    sim.water.v[:] = -np.cos(k * mids)[None, :] * np.sin(k * faces)[:, None]
    sim.run(until, progress=False)
    exact = np.exp(-2 * viscosity * k**2 * until) * np.sin(k * faces)[None, :] * np.cos(k * mids)[:, None]
    inner = np.s_[PAD:-PAD, PAD:-PAD]
    return float(np.sqrt(np.mean((sim.water.u - exact)[inner] ** 2)))


def cylinder(
    cells, reynolds, *, x, y, until, kick=0.0, control=None, courant=0.8, double=False, progress=False, threads=None
):
    """A cylinder of diameter 1 in a stream of speed 1, started at once; forces come as coefficients."""
    grid = flow.Grid.covering(x, y, cell=1 / cells)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0))
    sim = flow.Simulation(
        flow.Setup(
            grid=grid,
            viscosity=1 / reynolds,
            density=1.0,
            stream=(1.0, 0.0),
            bodies=(body,),
            courant=courant,
            precision="double" if double else "single",
        ),
        thread_count=threads,
    )
    if kick:
        yy, xx = np.meshgrid(grid.y, grid.x, indexing="ij")
        sim.water.v[PAD:-PAD, PAD:-PAD] += kick * np.exp(-((xx - 1.5) ** 2 + yy**2))
    if control is not None:
        sim.control(control)
    record = sim.run(until, progress=progress)
    return sim, record, 2 * record.force()


def wake_length(sim):
    """Length of the recirculation behind a cylinder of diameter 1 at the origin, from its rear [m]."""
    u = sim.water.u[PAD:-PAD, PAD:-PAD]
    x, y = sim.setup.grid.faces(PAD, PAD + u.shape[1], 0), sim.setup.grid.y
    k = np.searchsorted(y, 0.0)
    f = -y[k - 1] / (y[k] - y[k - 1])
    line = (1 - f) * u[k - 1] + f * u[k]
    k = np.flatnonzero((x > 0.6) & (line > 0))[0]
    return float(x[k] - line[k] * (x[k] - x[k - 1]) / (line[k] - line[k - 1]) - 0.5)


def added(shape, cells, *, half=8.0):
    """Added mass of a shape in water of density 1, in a box of ``2 half`` [kg/m, kg, kg m]."""
    grid = flow.Grid.covering((-half, half), (-half, half), cell=1 / cells)
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=1e-9, density=1.0, bodies=(flow.Body(shape=shape),), coarse=True)
    )
    sim.water.place(list(sim.setup.bodies), [flow.Pose()], 0.0)
    return flow.added_mass(sim.water, shape.markers(0.0, flow.Pose(), 1 / cells), (0.0, 0.0), 1.0)


def oscillating(cells, *, keulegan, stokes, periods, width, height, courant=0.8):
    """A cylinder that moves with ``-sin`` in still water; drag and inertia coefficients over the last period."""
    amplitude = keulegan / (2 * np.pi)
    speed = 2 * np.pi * amplitude
    grid = flow.Grid.covering((-width / 2, width / 2), (-height / 2, height / 2), cell=1 / cells)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Oscillation(frequency=1.0, heave=(-amplitude, 0.0)))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / stokes, density=1.0, bodies=(body,), courant=courant))
    record = sim.run(float(periods), progress=False).after(periods - 1.0)
    middle = record.time - record.step / 2
    return flow.morison(middle, record.force()[:, 0], frequency=1.0, speed=speed, diameter=1.0, density=1.0), sim


def cavity(n, reynolds, until):
    """Velocity along the centre lines of the lid-driven cavity: y, u(y), x, v(x)."""
    grid = flow.Grid(cells=(n, n), cell=1 / n)
    sides = flow.Sides(left=flow.Wall(), right=flow.Wall(), bottom=flow.Wall(), top=flow.Wall(speed=1.0))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / reynolds, sides=sides, tolerance=1e-5))
    sim.run(until, progress=False)
    u = sim.water.u[PAD:-PAD, PAD + n // 2]
    v = sim.water.v[PAD + n // 2, PAD:-PAD]
    return grid.y, u, grid.x, v


def channel(rows, mean_speed, until, *, kick=0.0):
    """The DFG channel 2.2 m long: a cylinder of 0.1 m at (0.2, 0.2) m between walls 0.41 m apart."""
    h = 0.41 / rows
    grid = flow.Grid.covering((0.0, 2.2), (0.0, 0.41), cell=h)
    grid = flow.Grid(cells=(grid.cells[0], rows), cell=h)
    sides = flow.Sides(
        left=flow.Inflow(profile=lambda y: 6 * mean_speed * y * (0.41 - y) / 0.41**2),
        right=flow.Outflow(),
        bottom=flow.Wall(),
        top=flow.Wall(),
    )
    body = flow.Body(shape=flow.Cylinder(diameter=0.1), motion=flow.Pose(position=(0.2, 0.2)))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-3, density=1.0, sides=sides, bodies=(body,)))
    profile = sides.left.profile(grid.centres(0, rows + 2 * PAD, 1))
    sim.water.u[:] = profile[:, None] * (1 + kick * np.sin(10 * np.arange(sim.water.u.shape[1]) * h)[None, :])
    record = sim.run(until, progress=False)
    return sim, record, record.force() * 2 / (mean_speed**2 * 0.1)


def pressure_drop(sim):
    """Pressure between the front and the rear of the cylinder in the DFG channel [Pa]."""
    surface = sim.surface()
    angle = np.arctan2(surface.markers.y - 0.2, surface.markers.x - 0.2)
    order = np.argsort(angle)
    turn = np.concatenate([angle[order] - 2 * np.pi, angle[order], angle[order] + 2 * np.pi])
    p = np.tile(surface.pressure[order], 3)
    return float(np.interp(np.pi, turn, p) - np.interp(0.0, turn, p))


def swimming_eel(cells, cycles, *, size=(4.0, 2.0), tolerance=1e-5, angle=0.0, frames=None):
    """The free eel of the IBAMR example, length and period 1; the grid follows it."""
    w, hgt = size
    grid = flow.Grid.covering((-0.3 * w, 0.7 * w), (-hgt / 2, hgt / 2), cell=1 / cells)
    body = flow.FreeBody(shape=flow.eel(1.0, stations=2 * cells + 1), start=(0.0, 0.0), angle=angle, name="eel")
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=1.4e-4, density=1.0, bodies=(body,), follow="eel", tolerance=tolerance)
    )
    return sim, sim.run(float(cycles), progress=False, watch=frames, every=None if frames is None else 0.05)


def blunted(spine, least):
    """The same midline, behind its head nowhere thinner than ``2 least`` [m]."""
    behind = spine.arc > 0.04 * spine.arc[-1]
    return replace(spine, half_width=np.where(behind, np.maximum(spine.half_width, least), spine.half_width))
