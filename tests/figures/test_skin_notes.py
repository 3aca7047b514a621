"""What is known of the error of pressure and friction along the skin stands beside each plot of them."""

import numpy as np
import xarray as xr

from suchus import flow
from suchus.experiments.catalog.swimming.figure import draw_forces, draw_sides
from suchus.visual.figures import caption
from suchus.visual.figures.flow import skin


def swum():
    """The least that the two figures of a held swimmer draw."""
    phase, tail = np.linspace(0, 1, 9), np.linspace(0, 1, 5)
    servos, instants = [f"servo {k}" for k in range(4)], [0.25, 0.5, 0.75, 1.0]
    wave = ("held_phase", np.sin(2 * np.pi * phase))
    return xr.Dataset(
        {
            "held_place": wave, "held_bend": wave, "held_thrust": wave,
            "held_sides": (("held_instant", "held_side", "held_tail"), np.zeros((4, 2, 5))),
            "held_servo_torque": (("held_phase", "held_servo"), np.ones((9, 4))),
            "servo_limit": ("held_servo", np.ones(4)), "held_cycle_thrust": ("held_cycle", np.ones(2)),
            "printed_thrust": ("printed_phase", np.zeros(9)), "printed_cycle_thrust": ("printed_cycle", np.ones(2)),
        },
        coords={
            "held_phase": phase, "printed_phase": phase, "held_instant": instants, "held_side": ["right", "left"],
            "held_tail": tail, "held_servo": servos,
        },
    )  # fmt: skip


def test_the_figures_of_a_held_swimmer_say_it():
    for draw in (draw_sides, draw_forces):
        assert flow.ALONG_THE_SKIN[1:] in caption(draw(swum()))


def test_the_picture_of_the_skin_says_it():
    grid = flow.Grid.covering((-1.0, 1.0), (-1.0, 1.0), cell=1 / 16)
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), name="round")
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.05, stream=(1.0, 0.0), bodies=(body,)))
    sim.advance()
    for name in (None, "round"):
        assert " ".join(skin(sim, name).get_supxlabel().split()) == flow.ALONG_THE_SKIN


def test_over_a_skin_in_space_each_picture_has_the_points_that_face_who_looks():
    grid = flow.Grid.covering(*[(-1.0, 1.0)] * 3, cell=1 / 12)
    body = flow.Body(shape=flow.Sphere(diameter=1.0))
    setup = flow.Setup(grid=grid, viscosity=0.05, stream=(1.0, 0.0, 0.0), bodies=(body,), coarse=True)
    sim = flow.Simulation(setup)
    sim.advance()
    figure, read = skin(sim), sim.surface()
    assert " ".join(figure.get_supxlabel().split()) == flow.ALONG_THE_SKIN
    side, top = (figure.axes[i].collections[0] for i in (0, 1))
    for drawn, facing in ((side, read.markers.normals[1] < 0), (top, read.markers.normals[2] > 0)):
        assert len(drawn.get_offsets()) == facing.sum()
        assert sorted(drawn.get_array()) == sorted(read.pressure[facing])
