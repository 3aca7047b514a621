"""Large batches are stepped in portions that stay in the processor's cache: the bytes are those of one portion."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.robot.control import Coordinated
from suchus.robot.design import crocodile
from suchus.robot.design.ground import Grains
from suchus.sim.land import Ground, Lake, Limp, Run, simulate
from suchus.sim.land import batch as batches

WORLDS = {
    "dry": {},
    "water": {"lake": Lake(level=0.06)},
    "grains": {"ground": Ground(grains=Grains(strength=2e6))},
}


def walks(robot, gait, world):
    """Return walks of which one breaks down, one has a limp servo, and two are equal for a while."""
    wild = replace(robot.hind_leg.servo, kp=9000.0, kd=0.0, armature=1e-4, damping=0.0, torque=900.0)
    broken = crocodile(replace(robot.tables, name="wild", hind_leg=replace(robot.tables.hind_leg, servo=wild)))
    run = Run(robot=robot, gait=gait, control=Coordinated(), **world)
    return [
        replace(run, seed=1, noise=0.01),
        run,
        replace(run, robot=broken),
        replace(run, faults=(Limp("LF_yaw", at=0.25),)),
        replace(run, control=Coordinated(random_start=True), seed=4),
    ]


@pytest.mark.parametrize("effort", [True, False])
@pytest.mark.parametrize("world", WORLDS)
def test_a_batch_in_portions_has_the_bytes_of_one_in_one_portion(robot, crawl_gait, world, effort, monkeypatch):
    def walked(size):
        monkeypatch.setattr(batches, "_RUNS_IN_CACHE", size)
        return simulate(
            walks(robot, crawl_gait, WORLDS[world]),
            duration=0.6,
            timestep=0.005,
            sample_stride=5,
            effort=effort,
            ends=lambda runs, time, phase: (runs == 1) & (time > 0.45),
        )

    monkeypatch.setenv("SUCHUS_THREADS", "1")
    apart, together = walked(2), walked(100)
    for name in together.variables:
        first, second = np.asarray(apart[name].values), np.asarray(together[name].values)
        assert first.tobytes() == second.tobytes() if first.dtype.kind == "f" else (first == second).all()
    assert together.cause.values.astype(bool).tolist() == [False, False, True, False, False]
    assert float(together.ended[1]) < 0.6


def test_the_rows_of_all_portions_are_those_of_all_runs(robot, crawl_gait, monkeypatch):
    monkeypatch.setenv("SUCHUS_THREADS", "1")
    monkeypatch.setattr(batches, "_RUNS_IN_CACHE", 2)
    batch = batches.SimulationBatch([Run(robot=robot, gait=crawl_gait, seed=seed) for seed in range(7)], 0.005)
    portions = batch._portions(np.array([1, 3, 4, 6]), calls=2)
    assert [sims.tolist() for sims, _ in portions] == [[1, 3], [4, 6]]
    assert [np.arange(7)[rows].tolist() for _, rows in portions] == [[0, 1, 2, 3], [4, 5, 6]]
    assert [rows for _, rows in batch._portions(None, calls=2)] == [slice(0, 2), slice(2, 4), slice(4, 6), slice(6, 7)]
    assert batch._portions(None, calls=1) == [(None, slice(None))]
