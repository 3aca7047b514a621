"""Compile the kernels of the flow solver and of water in the physics step once.

``make test`` does so beside mypy; else every test worker compiles them.

``python tools/compile_flow.py single`` or ``double``: the kernels of one precision.
"""

import sys

from suchus import flow
from suchus.land import wetting
from suchus.model.hydrostatics import hydrostatics
from suchus.robots import ROBOTS


def main(precision: str) -> None:
    """Run a few steps of flows that between them use every kernel the tests do."""
    grid = flow.Grid.covering((-1.0, 1.0), (-0.5, 0.5), cell=1 / 48)
    swimmer = flow.FreeBody(shape=flow.eel(1.0), start=(-0.5, 0.0))
    cylinder = flow.Body(shape=flow.Cylinder(diameter=0.25), motion=flow.Oscillation(frequency=1.0, heave=(0.01, 0.0)))
    if precision == "single":
        wetting.install()
        hydrostatics(ROBOTS["caiman"], heels=3)
        setup = flow.Setup(grid=grid, viscosity=0.01, bodies=(swimmer,), follow=swimmer.name, coarse=True)
    else:
        setup = flow.Setup(
            grid=grid, viscosity=0.01, stream=(1.0, 0.0), bodies=(cylinder,), precision="double", coarse=True
        )
    simulation = flow.Simulation(setup)
    simulation.control(4 * grid.cell)
    simulation.run(12 * simulation.next_step(), progress=False)
    simulation.surface()


if __name__ == "__main__":
    main(sys.argv[1])
