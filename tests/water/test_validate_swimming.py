"""The swim on three grids: `make validate`. Its table stands in docs/water_evidence.md.

Asked are speeds within 2 %, a swim that is steady to 1 % and a force noise below 1 %: what is missed is expected to be,
and the numbers are those that the page states.
"""

import os
from itertools import pairwise

import numpy as np
import pytest

from pages.stated import keep, kept
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import SwimMeasures, fit, printed_wave
from suchus.swimming.water.resolved import TETHERED, SwimSetting, resolved_swim

pytestmark = pytest.mark.validate

CELLS = (96, 128, 192)
REYNOLDS = 7000.0
CYCLES = 8


@pytest.fixture(scope="module")
def grids():
    robot = ROBOTS["caiman"]
    fitted, viscosity = fit(robot, printed_wave(robot)), robot.length**2 / REYNOLDS
    rows = {}
    for cells in CELLS:
        setting = SwimSetting(cells=cells, viscosity=viscosity, cycles=3, free=TETHERED)
        held = resolved_swim(robot, fitted.gait, setting, turn=fitted.head)
        free = resolved_swim(robot, fitted.gait, SwimSetting(cells=cells, viscosity=viscosity, cycles=CYCLES))
        swum = SwimMeasures.from_record(free, 1.0)
        rows[cells] = {
            "speed": swum.speed,
            "gain": swum.gain,
            "power": float(free.power[-1]),
            "strouhal": swum.strouhal,
            "thrust": float(held.cycle_thrust[1:].mean()),
            "held": float(held.cycle_power[1:].mean()),
            "noise": float(held.noise),
            "thin": float(held["thin"]),
        }
        print(cells, " | ".join(f"{name} {value:.3g}" for name, value in rows[cells].items()), flush=True)
    return rows


def test_the_page_states_what_the_grids_give(grids):
    """Renew with SUCHUS_GOLDEN=write and ``python tools/pages/stated.py``."""
    every = {f"{name}_{cells}": value for cells, row in grids.items() for name, value in row.items()}
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        keep("swim_grids", every)
    assert every == pytest.approx(kept("swim_grids"), rel=0.02, abs=0.001)


def _changes(rows, name):
    return [abs(rows[fine][name] / rows[coarse][name] - 1) for coarse, fine in pairwise(CELLS)]


def test_the_speed_grows_with_the_grid_by_little(grids):
    cell = np.array([1 / n for n in CELLS])
    speed = np.array([grids[n]["speed"] for n in CELLS])
    assert np.all(np.diff(speed) > 0)
    for order in (1, 2):
        end = speed[1:] + np.diff(speed) / ((cell[:-1] / cell[1:]) ** order - 1)
        print(f"speed on an endlessly fine grid if the error has order {order}, from each pair: {end.round(3)}")


@pytest.mark.xfail(strict=True, reason="9 % from 128 to 192 cells in November 2026")
def test_the_speed_is_known_to_two_percent(grids):
    assert _changes(grids, "speed")[1] < 0.02


@pytest.mark.xfail(strict=True, reason="4 to 6 % in the eighth cycle in November 2026")
def test_the_swim_is_steady_in_its_last_cycle(grids):
    assert all(abs(row["gain"]) < 0.01 for row in grids.values())


def test_the_power_and_the_thrust_settle(grids):
    assert _changes(grids, "power")[1] < 0.08  # after the fact
    assert _changes(grids, "thrust")[1] < 0.1  # after the fact; the wake differs as much from cycle to cycle


def test_less_of_the_body_is_thin_on_a_finer_grid(grids):
    assert np.all(np.diff([grids[cells]["thin"] for cells in CELLS]) < 0)
    assert grids[CELLS[-1]]["thin"] < 0.01


def test_forces_are_smoother_on_a_finer_grid(grids):
    noise = [grids[cells]["noise"] for cells in CELLS]
    assert np.all(np.diff(noise) < 0)


@pytest.mark.xfail(strict=True, reason="2.6 to 4.4 % in November 2026: the tail tapers to nothing")
def test_the_noise_of_the_force_is_below_a_hundredth(grids):
    assert max(grids[cells]["noise"] for cells in CELLS) < 0.01
