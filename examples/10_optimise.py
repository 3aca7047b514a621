"""Search for a longer stride.

A small search: two fields of the gait, a few generations; the best is a gait like any other.

Usage: python examples/10_optimise.py
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import suchus
from suchus.experiments.optimise import Aim, Limit, Optimisation, optimise
from suchus.experiments.study import Vary
from suchus.sim.land import Run

search = Optimisation(
    name="stride",
    run=Run(robot=suchus.ROBOTS["caiman"], gait=suchus.GAITS["belly_crawl"]),
    vary=(
        Vary(field="gait.stroke", low=0.0, high=0.5),
        Vary(field="gait.axis_lag", low=-0.2, high=0.2),
    ),
    aims=(Aim(name="displacement"),),
    limits=(Limit(name="clearance", value=0.005),),
    evaluations=12,
    population=6,
    duration=3.0,
    timestep=0.01,
)
with TemporaryDirectory() as folder:
    (found,) = optimise(search, Path(folder))

for field, (start, best) in found.values(0).items():
    print(f"{field}: {start:.3f} to {best:.3f}")
displacements = found.checks.aim_displacement
for condition in displacements.condition.values:
    before, after = (float(displacements.sel(run=run, condition=condition)) for run in ("start", "best"))
    print(f"{condition}: {before:.3f} to {after:.3f} m")
