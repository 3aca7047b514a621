"""Comparison with published numbers: a disc that settles onto the floor of a channel. `make validate`."""

import numpy as np
import pytest
from validation_rows import note

from suchus import flow

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

DIAMETER, VISCOSITY, DENSITY, GRAVITY = 0.25, 0.1, 1.25, 981.0
"""Of the disc and its water, in cm, g and s."""

PUBLISHED = 17.27
"""Largest Reynolds number by the disc's density, Glowinski et al. 2001, on cells of 1/192 cm [-]."""


def settled(cells, until=0.95):
    """A disc in a closed channel of 2 x 6 cm, let go at 4 cm; cells a diameter."""
    cell, sides = DIAMETER / cells, flow.Sides.box()
    grid = flow.Grid.covering((0.0, 2.0), (0.0, 6.0), cell=cell, sides=sides)
    disc = flow.FreeBody(
        shape=flow.Cylinder(diameter=DIAMETER), start=(1.0, 4.0), density=DENSITY, gravity=(0.0, -GRAVITY)
    )
    weight = (DENSITY - 1) * GRAVITY * np.pi / 4 * DIAMETER
    contact = flow.BodyContact(gap=2.5 * cell, pressure=20 * weight)
    setup = flow.Setup(grid=grid, viscosity=VISCOSITY, bodies=(disc,), sides=sides, contact=contact)
    return flow.Simulation(setup).run(until, progress=False)


def test_a_disc_settles_in_a_channel_onto_its_floor():
    sizes, numbers = (8,), []
    for cells in sizes:
        record = settled(cells)
        speed, clearance = record.column("velocity_y"), (record.column("y") - DIAMETER / 2) * cells / DIAMETER
        numbers.append(DENSITY * float(np.abs(speed).max()) * DIAMETER / VISCOSITY)
        assert clearance.min() > 0.5
        assert 1.0 < clearance[-1] < 2.5
        assert abs(speed[-1]) < 0.01 * np.abs(speed).max()
    off = note(
        "disc on a floor", "largest Reynolds number of the fall, by the disc's density", numbers[-1], PUBLISHED,
        "8 cells/D", "8 D x 24 D, closed", "Glowinski et al. 2001, from memory", cells=sizes, number=numbers,
    )  # fmt: skip
    assert off < 0.02


PAIR = {"speed": 19.30, "time": 0.165, "upper": 2.489, "lower": 2.853}
"""Two discs one above the other: greatest speed of the upper one before they touch [cm/s], when [s], and how far both
are below the top of the channel after .15 s [cm], Uhlmann 2005, J. Comput. Phys. 209, 448-476, figures 6a and 6b, as
L. Ghigo's sandbox of Basilisk has read them."""


def falling_pair(cells, until=0.2):
    """Two discs in a closed channel of 2 x 6 cm, the upper one let go 1 cm below its top; cells a diameter."""
    cell, sides, density = DIAMETER / cells, flow.Sides.box(), 1.5
    grid = flow.Grid.covering((0.0, 2.0), (0.0, 6.0), cell=cell, sides=sides)
    discs = tuple(
        flow.FreeBody(shape=flow.Cylinder(diameter=DIAMETER), start=start, density=density, gravity=(0.0, -GRAVITY),
                      name=name)
        for name, start in (("upper", (0.999, 5.0)), ("lower", (1.001, 4.5)))
    )  # fmt: skip
    weight = (density - 1) * GRAVITY * np.pi / 4 * DIAMETER
    contact = flow.BodyContact(gap=2.5 * cell, pressure=20 * weight)
    setup = flow.Setup(
        grid=grid, viscosity=0.01, bodies=discs, sides=sides, contact=contact, coarse=True
    )  # fmt: skip
    return flow.Simulation(setup).run(until, progress=False)


def test_two_discs_fall_in_a_channel_until_they_touch():
    sizes, numbers = (12, 16), {name: [] for name in PAIR}
    for cells in sizes:
        record = falling_pair(cells)
        speed = -record.column("velocity_y", "upper")
        numbers["speed"].append(float(speed.max()))
        numbers["time"].append(float(record.time[speed.argmax()]))
        for name in ("upper", "lower"):
            numbers[name].append(6.0 - float(np.interp(0.15, record.time, record.column("y", name))))
    names = {"speed": "greatest speed of the upper disc", "time": "when it has it", "upper": "fall of the upper disc",
             "lower": "fall of the lower disc"}  # fmt: skip
    for name, published in PAIR.items():
        off = note(
            "two discs in a channel", names[name], numbers[name][-1], published, "16 cells/D", "8 D x 24 D, closed",
            "Uhlmann 2005, read from a figure", cells=sizes, number=numbers[name],
        )  # fmt: skip
        assert abs(off) < 0.03, name
