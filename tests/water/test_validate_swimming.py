"""The swim on three grids: `make validate`. Prints the table that stands in docs/water.md.

Bounds are those that hold, so that nothing can get worse unseen.
"""

from itertools import pairwise

import numpy as np
import pytest

from suchus.robots import ROBOTS
from suchus.water import Swum, Tether, fit, free_swim, printed_wave, tether

pytestmark = pytest.mark.validate

CELLS = (56, 80, 112)
REYNOLDS = 7000.0


@pytest.fixture(scope="module")
def grids():
    robot = ROBOTS["caiman"]
    fitted, viscosity = fit(robot, printed_wave(robot)), robot.length**2 / REYNOLDS
    rows = {}
    for cells in CELLS:
        free = free_swim(robot, fitted.swim, Tether(cells=cells, viscosity=viscosity, cycles=6, frames=1))
        held = tether(robot, fitted.swim, Tether(cells=cells, viscosity=viscosity, cycles=2), turn=fitted.head)
        swum = Swum.of(free, 1.0)
        rows[cells] = {
            "speed": swum.speed,
            "power": float(free.power[-1]),
            "strouhal": swum.strouhal,
            "thrust": float(held.thrust.mean()),
            "power held": float(held.power.mean()),
            "noise": float(held.noise),
            "thin": float(held["thin"]),
        }
        print(cells, " | ".join(f"{name} {value:.3g}" for name, value in rows[cells].items()), flush=True)
    return rows


def _changes(rows, name):
    return [abs(rows[fine][name] / rows[coarse][name] - 1) for coarse, fine in pairwise(CELLS)]


def test_the_speed_settles(grids):
    first, second = _changes(grids, "speed")
    assert second < first
    assert second < 0.25  # 0.18: not settled, see docs/water.md


def test_the_power_settles(grids):
    assert _changes(grids, "power")[1] < 0.1


def test_less_of_the_body_is_thin_on_a_finer_grid(grids):
    assert np.all(np.diff([grids[cells]["thin"] for cells in CELLS]) < 0)


def test_forces_are_smooth(grids):
    assert all(row["noise"] < 0.1 for row in grids.values())
