"""Fast physics, for training: how far it may be from full physics, as `simulate` says."""

import pytest

from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement

WALKS = [("caiman", "low_crawl"), ("caiman", "semi_erect"), ("strider", "tripod")]


def walked(robot, gait, step, *, fast):
    """Return the forward displacement of two cycles [m]."""
    run = Run(robot=ROBOTS[robot], gait=GAITS[gait])
    duration = START + 2 * GAITS[gait].period
    record = simulate([run], duration=duration, timestep=step, effort=False, fast=fast, sample_stride=5)
    return float(displacement(record).sel(xyz="x").values[0])


@pytest.mark.filterwarnings("ignore::suchus.core.errors.Doubtful")
@pytest.mark.parametrize(("robot", "gait"), WALKS)
def test_fast_physics_gets_nearly_as_far(robot, gait):
    """The errors that the documentation of ``simulate`` states."""
    coarse, longest = coarse_step(ROBOTS[robot]), control_period(ROBOTS[robot])
    full = walked(robot, gait, coarse / 2, fast=False)
    assert walked(robot, gait, coarse, fast=True) == pytest.approx(full, rel=0.05)
    quick = walked(robot, gait, longest, fast=True)
    assert quick == pytest.approx(full, rel=0.08)
    assert quick != walked(robot, gait, longest, fast=False)
