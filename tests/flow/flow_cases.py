"""Flows that small tests and the validation share: each answers with numbers, at a resolution of the caller's."""

from dataclasses import replace

import numpy as np
from scipy.special import kv

from suchus import flow
from suchus.flow import signals
from suchus.flow.compiled import PAD


def taylor_green(n, *, viscosity=0.02, until=0.5, precision="double"):
    """RMS error of the decaying vortices in the unit square [m/s]."""
    grid = flow.Grid(cells=(n, n), cell=1 / n)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid,
            viscosity=viscosity,
            sides=flow.Sides.periodic(),
            precision=precision,
            tolerance=1e-8 if precision == "double" else 1e-6,
            courant=0.5,
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


def middle(record):
    """Times that the forces of a record belong to: they are means over the steps [s]."""
    return record.time - record.step / 2


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
    record = sim.run(float(periods), progress=False).select_after(periods - 1.0)
    got = flow.morison(middle(record), record.force()[:, 0], frequency=1.0, speed=speed, diameter=1.0, density=1.0)
    return got, sim


def turning(cells, *, viscosity=0.05, swing=0.2, periods=1.0, width=3.0):
    """A cylinder that turns to and fro in still water, against the exact solution far from other walls.

    Returns:
        rms error of the torque over its amplitude, in the last half period; rms error of the velocity over the
        wall's speed, within 0.25 diameters of the wall and outside the kernel, at the end.

    Source: the diffusion equation for a swirl, v = Re[V K1(k r) / K1(k a) exp(i w t)], k^2 = i w / viscosity.
    """
    grid = flow.Grid.covering((-width / 2, width / 2), (-width / 2, width / 2), cell=1 / cells)
    shape, motion = flow.Cylinder(diameter=1.0), flow.Oscillation(frequency=1.0, pitch=swing, pitch_phase=-np.pi / 2)
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=viscosity, density=1.0, bodies=(flow.Body(shape=shape, motion=motion),))
    )
    a, rate, speed = 0.5, 2 * np.pi, np.pi * swing
    k = np.sqrt(1j * rate / viscosity)
    n = sim.water.u.shape[0]
    faces, mids = grid.faces(0, n, 0), grid.centres(0, n, 0)

    def swirl(x, y, along, time):
        r = np.maximum(np.hypot(x, y), a)
        return speed * (kv(1, k * r) / kv(1, k * a) * np.exp(1j * (rate * time - np.pi / 2))).real * along / r

    def exact(time):
        x, y = np.meshgrid(faces, mids)
        u = swirl(x, y, -y, time)
        return u, -u.T

    sim.water.u[:], sim.water.v[:] = exact(0.0)
    late = sim.run(periods, progress=False).select_after(periods / 2)
    slope = -k * kv(0, k * a) / kv(1, k * a) - 2 / a  # of v at the wall, less v / a, over v
    scale = 2 * np.pi * a**2 * viscosity * speed * slope
    wanted = (scale * np.exp(1j * (rate * middle(late) - np.pi / 2))).real
    torque = np.sqrt(np.mean((late.column("torque") - wanted) ** 2)) / np.abs(scale)
    squares = []
    for got, right, x, y in zip((sim.water.u, sim.water.v), exact(periods), (faces, mids), (mids, faces), strict=True):
        r = np.hypot(x[None, :], y[:, None])
        near = (r > a + 1.5 / cells) & (r < a + 0.25)
        squares.append(((got - right) / speed)[near] ** 2)
    return float(torque), float(np.sqrt(np.mean(np.concatenate(squares))))


def straight_foil(cells, reynolds, until):
    """Drag coefficient of a NACA 0012 held straight along the stream, chord and speed 1, mean of the last second."""
    spine = flow.foil(1.0, thickness=0.12, stations=2 * cells + 1).spine(0.0).thickened(1.75 / cells)
    grid = flow.Grid.covering((-0.75, 2.25), (-0.75, 0.75), cell=1 / cells)
    body = flow.Body(shape=flow.Midline(spine=lambda time: spine))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / reynolds, density=1.0, stream=(1.0, 0.0), bodies=(body,)))
    late = sim.run(until, progress=False).select_after(until - 1.0)
    return 2 * signals.mean(late.time, late.force()[:, 0])


def wavy_foil(cells, speed, cycles):
    """Held NACA 0012 in a stream of 1 with a wave that runs to the tail at ``speed``; forces as coefficients.

    Envelope 0.02 - 0.0825 x + 0.1625 x^2 and one wave a chord; Reynolds number 5000.
    """
    base = flow.foil(1.0, thickness=0.12, stations=2 * cells + 1).spine(0.0)
    x, k = base.x, 2 * np.pi
    amplitude, slope = 0.02 - 0.0825 * x + 0.1625 * x**2, -0.0825 + 0.325 * x

    def spine(time):
        sin, cos = np.sin(k * (x - speed * time)), np.cos(k * (x - speed * time))
        tangent = slope * sin + amplitude * k * cos
        rate = speed * k * (-slope * cos + amplitude * k * sin)
        return replace(
            base, y=amplitude * sin, y_rate=-speed * k * amplitude * cos, heading=np.arctan(tangent),
            heading_rate=rate / (1 + tangent**2),
        )  # fmt: skip

    def blunt(time):
        return spine(time).thickened(1.75 / cells)

    grid = flow.Grid.covering((-0.75, 2.25), (-0.75, 0.75), cell=1 / cells)
    body = flow.Body(shape=flow.Midline(spine=blunt))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 5000, density=1.0, stream=(1.0, 0.0), bodies=(body,)))
    period = 1 / speed
    record = sim.run(cycles * period, progress=False).select_after((cycles - 1) * period)
    return 2 * signals.mean(record.time, record.force()[:, 0]), 2 * signals.mean(record.time, record.column("power"))


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


def swimming_eel(cells, cycles, *, size=(2.5, 1.0), viscosity=1.4e-4, tolerance=1e-5):
    """The free eel of the IBAMR example, length and period 1; mean speed of each cycle."""
    w, hgt = size
    grid = flow.Grid.covering((-w / 4, 3 * w / 4), (-hgt / 2, hgt / 2), cell=1 / cells)
    body = flow.FreeBody(shape=flow.eel(1.0, stations=2 * cells + 1), start=(0.0, 0.0), name="eel")
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=viscosity, density=1.0, bodies=(body,), follow="eel", tolerance=tolerance)
    )
    record = sim.run(float(cycles), progress=False)
    turn = np.ceil(record.time).astype(int)
    return record, [
        -np.average(record.column("velocity_x")[turn == k], weights=record.step[turn == k])
        for k in range(1, cycles + 1)
    ]


def still_setup(**changes):
    settings = {
        "grid": flow.Grid(cells=(64, 64), cell=1 / 16, origin=(-2.0, -2.0)),
        "viscosity": 0.01,
        "density": 1.0,
        "bodies": (flow.Body(shape=flow.Cylinder(diameter=1.0)),),
    }
    return flow.Setup(**{**settings, **changes})


def eel_setup(**changes):
    shape = flow.eel(1.0, stations=97)
    settings = {
        "grid": flow.Grid.covering((-1.2, 2.0), (-0.8, 0.8), cell=1 / 48),
        "viscosity": 1e-3,
        "density": 1.0,
        "bodies": (flow.FreeBody(shape=shape, name="eel"),),
        "follow": "eel",
    }
    return flow.Setup(**{**settings, **changes})


def heaving_plate(cells, thick, *, angle=0.3, amplitude=0.1):
    """A plate of length 1 that moves to and fro across itself in still water, one period at Reynolds number 400 pi.

    Returns:
        added mass over that of a plate without thickness in potential flow, work done [J/m].
    """
    across, rate = np.array([-np.sin(angle), np.cos(angle)]), 2 * np.pi

    def motion(time):
        place, speed = -amplitude * np.cos(rate * time), amplitude * rate * np.sin(rate * time)
        return flow.Pose(position=tuple(place * across), angle=angle, velocity=tuple(speed * across))

    grid = flow.Grid.covering((-0.8, 0.8), (-0.8, 0.8), cell=1 / cells)
    body = flow.Body(shape=flow.Plate(length=1.0, thick=thick), motion=motion)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 2000, density=1.0, bodies=(body,), coarse=True))
    record = sim.run(1.0, progress=False).select_after(0.05)
    phase = rate * middle(record)
    pushed = np.pi / 4 * amplitude * rate**2 * np.cos(phase)
    dragged = 0.5 * (amplitude * rate) ** 2 * np.sin(phase) * np.abs(np.sin(phase))
    weight = np.sqrt(record.step)
    terms = -np.stack([pushed, dragged], axis=1) * weight[:, None]
    fitted = np.linalg.lstsq(terms, (record.force() @ across) * weight, rcond=None)[0]
    return float(fitted[0]), float(record.column("power") @ record.step)


def in_patch(setup, whole, x, y, *, until, ratio=4, z=None):
    """Records of one flow on fine cells everywhere and on a patch of them in cells ``ratio`` times as wide.

    ``whole`` is the grid of the wide cells; of ``setup`` the grid is not looked at.
    """
    fine = flow.Grid(cells=tuple(ratio * n for n in whole.cells), cell=whole.cell / ratio, origin=whole.origin)
    patch = whole.patch(x, y, z, ratio=ratio)
    grids = {"grid": fine}, {"grid": patch, "coarse_grid": whole}
    sims = [flow.Simulation(replace(setup, **those)) for those in grids]
    return [sim.run(until, progress=False) for sim in sims]


def off_potential_flow(sim, cells=(1.0, 4.0), front=False):
    """Rms difference of the velocity from ideal water around the cylinder of diameter 1, over the stream.

    That is a stream of speed 1 along x; what is compared lies so many cells off the cylinder, all around it or ahead of
    its middle.
    """
    grid, off = sim.setup.grid, []
    (x0, y0), radius, (near, far) = sim.pose("body").position, 0.5, cells
    for c, component in enumerate(sim.water.velocity):
        x = (grid.faces if c == 0 else grid.centres)(0, component.shape[1], 0) - x0
        y = (grid.faces if c == 1 else grid.centres)(0, component.shape[0], 1) - y0
        x, y = np.meshgrid(x, y)
        r = np.maximum(np.hypot(x, y), 0.1)
        exact = 1 - 0.25 * (x**2 - y**2) / r**4 if c == 0 else -0.5 * x * y / r**4
        counts = (r > radius + near * grid.cell) & (r < radius + far * grid.cell) & ~(front & (x >= 0))
        off.append((component - exact)[counts])
    return float(np.sqrt(np.mean(np.concatenate(off) ** 2)))
