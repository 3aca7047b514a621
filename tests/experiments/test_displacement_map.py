"""The map of displacement counts whole cycles, whatever the period."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design.scale import coarse_step
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement


@pytest.mark.parametrize("period", [1.3, 0.9])
def test_the_map_holds_the_displacement_of_the_whole_run(period):
    """A map whose samples miss the end of the run lost up to 46 % of it."""
    question = EXPERIMENTS["displacement"].quick()
    gait = replace(question.gait, period=period)
    question = replace(question, gait=gait, strokes=(1.0,), bends=(1.0,), pitches=(0.2,), phases=(0.0,), cycles=2)
    duration = START + 2 * period
    mapped = float(question._displacement_map(duration, silent).map_coordinated.item())
    run = Run(robot=question.robot, gait=gait)
    record = simulate([run], duration=duration, timestep=coarse_step(question.robot))
    assert np.isclose(float(record.time[-1]), duration)
    assert mapped == pytest.approx(float(displacement(record).sel(xyz="x").item()), rel=1e-9)
