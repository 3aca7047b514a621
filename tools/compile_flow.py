"""Compile the kernels of the flow solver and of water in the physics step once.

``make test`` does so beside mypy; else every test worker compiles them.

``python tools/compile_flow.py single``, ``double`` or ``space``: the kernels of one precision in the plane, or those in
space in single precision.
"""

import sys

import numpy as np

from suchus import flow
from suchus.robot.robots import ROBOTS
from suchus.sim.immersion import wetting
from suchus.sim.model.hydrostatics import hydrostatics


def main(which: str) -> None:
    """Run a few steps of flows that between them use every kernel the tests do."""
    if which == "space":
        in_space()
        return
    grid = flow.Grid.covering((-1.0, 1.0), (-0.5, 0.5), cell=1 / 48)
    swimmer = flow.FreeBody(shape=flow.eel(1.0), start=(-0.5, 0.0))
    cylinder = flow.Body(shape=flow.Cylinder(diameter=0.25), motion=flow.Oscillation(frequency=1.0, heave=(0.01, 0.0)))
    if which == "single":
        wetting.install()
        hydrostatics(ROBOTS["caiman"], heel_count=3)
        setup = flow.Setup(grid=grid, viscosity=0.01, bodies=(swimmer,), follow=swimmer.name, coarse=True)
    else:
        setup = flow.Setup(
            grid=grid, viscosity=0.01, stream=(1.0, 0.0), bodies=(cylinder,), precision="double", coarse=True
        )
    simulation = flow.Simulation(setup)
    simulation.control(4 * grid.cell)
    simulation.run(12 * simulation.next_step(), progress=False)
    simulation.surface()


def in_space() -> None:
    """Run a few steps around an ellipsoid and a free trunk."""
    stations = np.linspace(-0.3, 0.3, 13)
    zero, wide = np.zeros(13), np.full(13, 0.15)
    spine = flow.MidlineState(
        x=stations, y=zero, heading=zero, half_width=wide, x_rate=zero, y_rate=zero, heading_rate=zero
    )
    trunk = flow.FreeBody(
        shape=flow.Trunk(spine=lambda _: spine, half_height=1.5 * wide), name="trunk", start=(0.0, 0.35, 0.0)
    )
    ellipsoid = flow.Body(
        shape=flow.Ellipsoid(length=0.6, width=0.4, height=0.4),
        motion=flow.Pose(position=(0.0, -0.35, 0.0)),
        name="ellipsoid",
    )
    grid = flow.Grid.covering((-1.0, 1.0), (-1.0, 1.0), (-1.0, 1.0), cell=1 / 16)
    setup = flow.Setup(grid=grid, viscosity=0.05, stream=(0.5, 0.0), bodies=(ellipsoid, trunk), coarse=True)
    simulation = flow.Simulation(setup)
    for _ in range(3):
        simulation.advance()


if __name__ == "__main__":
    main(sys.argv[1])
