"""A search small enough for a test."""

import pytest

from suchus.experiments.optimise import Aim, Limit, Optimisation
from suchus.experiments.study import Vary
from suchus.sim.land import Run

for library in ("cma", "comocma", "moarchiving"):
    pytest.importorskip(library, reason="not installed: pip install 'suchus[optimise]'")


@pytest.fixture
def small(robot, crawl_gait):
    return Optimisation(
        name="small",
        run=Run(robot=robot, gait=crawl_gait),
        vary=(Vary(field="gait.stroke", low=0.0, high=0.75), Vary(field="gait.trunk_bend", low=0.0, high=2.3)),
        aims=(Aim(name="displacement"),),
        limits=(Limit(name="clearance", value=0.005),),
        evaluations=12,
        population=4,
        duration=1.3,
        timestep=0.01,
    )
