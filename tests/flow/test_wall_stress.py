"""The wall whose layer is a law's: where it separates, what it rubs, and its limits of thick layers and of none."""

import numpy as np
import pytest
from flow_cases import off_potential_flow
from wall_stress import LEAST, PUBLISHED, LayeredFluid, cylinder, front, judged, layered, layers

from evidence.friction import along_stations
from suchus import flow

COUNT = 720
ANGLES = 2 * np.pi * np.arange(COUNT) / COUNT
RADIUS = 0.5
AROUND = 2 * np.sin(ANGLES - np.pi)[None]  # ideal water that comes from the left, counter-clockwise
SPACING = 2 * np.pi * RADIUS / COUNT


def test_a_laminar_layer_in_ideal_water_leaves_the_cylinder_where_thwaites_says():
    """At 103.1 degrees from the foremost point (Thwaites 1949), whatever the viscosity."""
    for viscosity in (1e-3, 1e-6):
        _, stress = layers(AROUND, SPACING, viscosity, 0.05)
        assert front(stress, ANGLES) == pytest.approx([103.1, 103.1], abs=1.0)


def test_its_friction_is_that_of_the_law_along_stations():
    share, stress = layers(AROUND, SPACING, 1e-5, 0.05)
    under = slice(COUNT // 2, COUNT // 2 + COUNT // 4)  # a quarter of the way around from the foremost point
    arc = RADIUS * (ANGLES[under] - np.pi)
    band = along_stations(arc, np.ones_like(arc), np.abs(AROUND[0, under]), viscosity=1e-5, density=1.0)
    assert np.trapezoid(stress[0, under], arc) == pytest.approx(band.laminar, rel=0.02)
    assert 0.9 < share[0, under][1:].min() < share.max() < 1


def test_no_wall_slips_under_a_thick_layer_and_every_wall_without_one():
    thick, _ = layers(AROUND, SPACING, 1.0, 0.05)
    none, _ = layers(AROUND, SPACING, 1e-12, 0.05)
    assert not thick.any()
    assert none.max() > 0.9999
    assert not none[0, :60].any()  # in the lee nothing is attached
    assert not layers(np.full((1, COUNT), 0.3), SPACING, 1e-6, 0.05)[0].any()  # nor where the water nowhere divides


def begun(law, reynolds, steps):
    with layered(law):
        sim = cylinder("towed", reynolds, 16, "plane")
        for _ in range(steps):
            sim.advance()
    return sim


def test_a_stream_goes_around_the_front_as_ideal_water_does():
    """Half a diameter after the start at Reynolds number 1e6 the plain wall has a layer a cell thick, this hardly."""
    plain, law = (off_potential_flow(begun(law, 1e6, 24), (1.0, 3.0), front=True) for law in (False, True))
    assert law < 0.5 * plain
    assert law < 0.05


def test_with_a_layer_that_the_cells_carry_it_is_the_plain_solver():
    plain, law = (begun(law, 20.0, 4) for law in (False, True))
    assert isinstance(law.water, LayeredFluid)
    assert not law.water.slip.any()
    assert law.water.velocity.tobytes() == plain.water.velocity.tobytes()
    assert law.record.bodies.tobytes() == plain.record.bodies.tobytes()


def test_a_patch_and_a_slice_in_space_take_the_same_wall():
    for cells, where in ((32, "plane"), (12, "space")):
        with layered(True):
            sim = cylinder("towed", 1e4, cells, where)
            assert sim.setup.coarse_grid is not None
            for _ in range(2):
                sim.advance()
        assert isinstance(sim.water, flow.nest.Nested)
        assert 1.0 < np.abs(sim.water.slip).max() < 2.5
        assert np.abs(sim.water.velocity).max() < 3.0


def outcomes(law=(1.0, 1.02), plain=(1.3, 1.1), **more):
    """Runs in space on two grids, as shares of what is published."""
    found = {}
    for case, published in PUBLISHED.items():
        for word, shares in (("law", law), ("plain", plain)):
            for cells, share in zip((12, 24), shares, strict=True):
                one = {"drag": share * published, "since": 20.0, "time": 20.0 + LEAST} | more
                found[f"{case}_{cells}_{word}_space"] = one
    return found


def test_success_is_what_was_laid_down():
    assert judged(outcomes())["word"] == "kept"
    assert judged(outcomes(law=(1.08, 1.09)))["word"] == "kept"
    assert judged(outcomes(law=(1.1, 1.11)))["word"] == "missed"  # too far off
    assert judged(outcomes(law=(0.8, 1.0)))["word"] == "missed"  # the cells change it more than the plain solver
    assert judged(outcomes(time=30.0))["word"] == "not judged"  # read over too short a time
    assert judged({})["word"] == "not judged"
    one = outcomes()
    del one["towed_100000_24_law_space"]
    assert [row["word"] for row in judged(one)["rows"]][3:] == ["kept", "not judged", "kept"]
    assert judged(one)["word"] == "not judged"
    one["oscillated_10350_24_law_space"]["drag"] = 1.0
    assert judged(one)["word"] == "missed"
    del one["oscillated_10350_12_plain_space"]
    assert judged(one)["word"] == "missed"  # whatever the plain solver gives
