"""Where the energy goes that a body gives to the water, term by term of the discrete equations.

One step is ``u2 - u1 = half the sum over its two stages of dt (advection + diffusion - grad p) + given``, where
``given`` is what the immersion adds near the body. Times the mean of u1 and u2 and summed over the faces that is the
change of the kinetic energy, exactly. The rates are computed here anew, with numpy, from copies of the fields; what
of a step they leave unexplained away from the body is a fault of one of the two.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus import flow
from suchus.flow.compiled import PAD
from suchus.flow.water import Fluid


@dataclass
class Budget:
    """Energy over a run, per metre of depth and with density 1 [J/m]."""

    work: float = 0.0
    """Work of the body, from the record."""
    change: float = 0.0
    """Kinetic energy that the water gained, without what fills the body's region."""
    viscous: float = 0.0
    """Taken by diffusion."""
    numerical: float = 0.0
    """Taken by the limiter, and by the time step: the mean of a step's ends is not the velocity of its stages."""
    immersion: float = 0.0
    """Lost where the body moves the water around it: the force times what the water lags behind the body."""
    pressure: float = 0.0
    """Taken by the pressure, which does work only where something is left of the divergence."""
    strange: float = 0.0
    """Work of what is unexplained away from the body."""
    cells: float = 0.0
    """Dissipation as the strain in the cells has it, which sees nothing thinner than a cell."""

    @property
    def missing(self) -> float:
        """Share of the work that none of the terms explains [-]."""
        terms = self.change + self.viscous + self.numerical + self.immersion + self.pressure
        return (self.work - terms) / self.work


@dataclass
class Stage:
    """One stage of a step as the solver left it."""

    out: list[np.ndarray]
    blend: list[np.ndarray]
    pressure: np.ndarray
    dilatation_work: float
    dt: float
    keep: float
    moments: list[np.ndarray]


@dataclass
class Spy:
    """Stands between the water and its own bookkeeping, and keeps copies of each stage."""

    water: Fluid
    stages: list[Stage] = field(default_factory=list)

    def __post_init__(self):
        self.collect, self.water._collect = self.water._collect, self

    def __call__(self, stage, weight):
        w = self.water
        self.collect(stage, weight)
        inside = list(w.mu0 < 1)
        for touched, mu1 in zip(inside, w.mu1, strict=True):
            touched[w.window_slices] |= (mu1 != 0).any(axis=0)
        dilatation_work = float((w.p[w.window_slices].astype(float) * w.widening).sum())
        copies = [list(vector.astype(float)) for vector in (stage.result, stage.blend)]
        self.stages.append(
            Stage(*copies, w.p.astype(float), dilatation_work, float(stage.dt), float(stage.blend_fraction), inside)
        )


def limited(far, near, ahead):
    """Return QUICK's face value kept monotone, from the two points upstream and the one ahead."""
    quick, steep = 0.75 * near + 0.375 * ahead - 0.125 * far, 10 * near - 9 * far
    low, high = np.minimum(steep, ahead), np.maximum(steep, ahead)
    return np.clip(quick, np.minimum(near, np.clip(near, low, high)), np.maximum(near, np.clip(near, low, high)))


def carried(speed, f):
    """Return the advective flux between ``f[k + 1]`` and ``f[k + 2]``, along the first axis."""
    return speed * np.where(speed > 0, limited(f[:-3], f[1:-2], f[2:-1]), limited(f[3:], f[2:-1], f[1:-2]))


def rates(u, v):
    """Return advection and Laplacian of ``u``, whose normal is the second axis; zero in the outer two rows."""
    inner = np.s_[2:-2, 2:-2]
    advection, laplacian = np.zeros_like(u), np.zeros_like(u)
    along = carried(0.5 * (u[:, 1:-2] + u[:, 2:-1]).T, u.T).T[2:-2]
    across = carried(0.5 * (v[2:-1, :-1] + v[2:-1, 1:]), u[:, 1:])[:, 1:-2]
    advection[inner] = along[:, :-1] - along[:, 1:] + across[:-1] - across[1:]
    laplacian[inner] = u[2:-2, 3:-1] + u[2:-2, 1:-3] + u[3:-1, 2:-2] + u[1:-3, 2:-2] - 4 * u[inner]
    return advection, laplacian


def strain(u, v):
    """Return the sum over the cells of the squared rates of strain, as in the dissipation [m^2/s^2]."""
    a, b = PAD, -PAD
    stretch = u[a:b, a + 1 : u.shape[1] + b + 1] - u[a:b, a:b], v[a + 1 : v.shape[0] + b + 1, a:b] - v[a:b, a:b]
    shear = u[a : b + 1, a : b + 1] - u[a - 1 : b, a : b + 1] + v[a : b + 1, a : b + 1] - v[a : b + 1, a - 1 : b]
    return float(2 * (stretch[0] ** 2).sum() + 2 * (stretch[1] ** 2).sum() + (shear**2).sum())


def of_component(budget, k, stages, ends, base, nu, body):
    """Add one component of the velocity in one step to the budget, in m^2/s^2."""
    inner = np.s_[PAD:-PAD, PAD + 1 : -PAD] if k == 0 else np.s_[PAD + 1 : -PAD, PAD:-PAD]
    mean = 0.5 * (ends[0][k] + ends[1][k])
    budget.change += 0.5 * float((ends[1][k][inner] ** 2 - ends[0][k][inner] ** 2).sum())
    for stage, (u, v) in zip(stages, (base, stages[0].out), strict=True):
        advection, laplacian = rates(u, v) if k == 0 else (r.T for r in rates(v.T, u.T))
        rise = np.diff(stage.pressure, axis=1 - k, prepend=0)
        moved = (stage.out[k] - stage.keep * stage.blend[k]) / (1 - stage.keep)
        given = moved - base[k] - stage.dt * (advection + nu * laplacian - rise)
        half = 0.5 * stage.dt
        budget.numerical -= half * float((mean * advection)[inner].sum())
        budget.viscous -= half * nu * float((mean * laplacian)[inner].sum())
        budget.pressure += half * float((mean * rise)[inner].sum())
        near = stage.moments[k][inner]
        budget.immersion += 0.5 * float(((body[k] - mean) * given)[inner][near].sum())
        budget.strange += 0.5 * float((mean * given)[inner][~near].sum())


def of_step(budget, sim, spy, before):
    """Add the step that just ended to the budget, in m^2/s^2 for cells of side 1; return the velocities now."""
    w = sim.water
    now = [w.u.astype(float), w.v.astype(float)]
    j0, j1, i0, i1 = w.window
    body = [np.zeros_like(f) for f in now]
    for full, part in zip(body, w.mean, strict=True):
        full[j0 : j1 + 1, i0 : i1 + 1] = part
    for k in range(2):
        of_component(budget, k, spy.stages, (before, now), before, float(w.nu), body)
    for stage in spy.stages:
        budget.pressure += 0.5 * stage.dt * stage.dilatation_work
    budget.cells += spy.stages[0].dt * float(w.nu) * 0.5 * (strain(*before) + strain(*now))
    spy.stages.clear()
    return now


def spent(setup, until):
    """Return the budget of a run from rest in a domain that nothing enters or leaves."""
    sim, budget = flow.Simulation(setup), Budget()
    spy = Spy(sim.water)
    now, start = [sim.water.u.astype(float), sim.water.v.astype(float)], sim._log.region_contents[:, 3].sum()
    while sim.time < until * (1 - 1e-9):
        sim.advance(min(sim.next_step(), until - sim.time))
        now = of_step(budget, sim, spy, now)
    budget.change -= float(sim._log.region_contents[:, 3].sum() - start)
    for name in ("change", "viscous", "numerical", "immersion", "pressure", "strange", "cells"):
        setattr(budget, name, getattr(budget, name) * setup.grid.cell**2)
    record = sim.record
    budget.work = float((record.column("power") * record.step).sum())
    return budget


def shaken_in_a_box(cells, *, keulegan=1.0, stokes=10.0, half=3.0):
    """A cylinder that starts from rest and oscillates in a closed box."""
    grid = flow.Grid.covering((-half, half), (-half, half), cell=1 / cells)
    motion = flow.Oscillation(frequency=1.0, heave=(keulegan / (2 * np.pi), 0.0), phase=-np.pi / 2)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion)
    return flow.Setup(grid=grid, viscosity=1 / stokes, density=1.0, bodies=(body,), sides=flow.Sides.box())


def bending_in_a_box(cells):
    """An eel that is held and bends in a closed box."""
    grid = flow.Grid.covering((-0.3, 1.3), (-0.4, 0.4), cell=1 / cells)
    body = flow.Body(shape=flow.eel(1.0, stations=2 * cells + 1))
    return flow.Setup(grid=grid, viscosity=1e-3, density=1.0, bodies=(body,), sides=flow.Sides.box())
