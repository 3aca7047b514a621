import numpy as np

from suchus import flow
from suchus.flow import swimmer
from suchus.swimming.water import Outline, fit, printed_wave
from suchus.swimming.water.immersed import immersed
from suchus.swimming.water.resolved import SwimSetting


def _books(robot):
    """Return three accounts of the body's momentum at the steps of a first stroke, each of shape (step, axis) [kg/s].

    What the body has; what the water's forces gave it; and what the water lost, followed through a box around the body.
    """
    cells = 48
    shape = immersed(Outline(robot, cells + 1), fit(robot, printed_wave(robot)).gait, grow=0.5)
    grid = SwimSetting(cells=cells, viscosity=1e-3, cycles=1).grid(robot.length)
    body = flow.FreeBody(shape=shape, start=(0.5 * robot.length, 0.0))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-3, density=1000.0, bodies=(body,), courant=0.3))
    sim.control(0.2 * robot.length)
    record = sim.run(1.0, progress=False)
    step, late = record.step[:, None], record.time > 0.45
    has = 1000.0 * shape.volume(1.0) * np.column_stack([record.column(f"velocity_{axis}") for axis in "xy"])
    given, lost = np.cumsum(record.force() * step, axis=0), np.nancumsum(sim.control_forces * step, axis=0)
    return has[late], given[late], lost[late]


def _apart(one, other):
    """Return the greatest difference along x and y over the greatest momentum."""
    return np.abs(one - other).max(axis=0) / np.abs(other).max()


def test_body_and_water_together_keep_their_momentum(robot):
    has, given, lost = _books(robot)
    forward, aside = _apart(has, given)
    assert forward < 0.04
    assert aside < 0.1  # the body feels the force of the step before, and its sway changes fast
    assert np.all(_apart(given, lost) < 0.09)


def test_the_books_show_what_is_kept_back(robot, monkeypatch):
    """A body that gets nine tenths of the force is found out."""
    whole = swimmer.Swimmer.advance

    def less(self, *how):
        self.load = 0.9 * self.load
        whole(self, *how)

    monkeypatch.setattr(swimmer.Swimmer, "advance", less)
    has, given, _ = _books(robot)
    assert _apart(has, given)[0] > 0.08
