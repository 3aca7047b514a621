"""The chain that stands for Turek and Hron's beam: under its weight, its first mode, and a case stopped on its way."""

import json

import numpy as np
import pytest
from flag import BEAM, CASES, CHANNEL, COLUMNS, POISSON, THICKNESS, Beam, channel, cycle, grids, run

from suchus.core.errors import InvalidDesign


@pytest.mark.parametrize(
    ("modulus", "along", "across"), [(1.4e6, -7.188e-3, -66.10e-3), (5.6e6, -0.4690e-3, -16.974e-3)]
)
def test_a_chain_hangs_as_the_published_beam_does(modulus, along, across):
    """CSM1 and CSM2 of Turek and Hron, 2 m/s2 across: their beam shears and stretches, ours does not."""
    chain, angles = Beam(1000.0, modulus, 28, gravity=-2.0), np.zeros(28)
    for _ in range(40):
        angles = 0.3 * angles - 0.7 * chain.at(angles, 0 * angles)[1] / chain.stiffness
    x, y = chain.tip(angles)
    assert y == pytest.approx(across, rel=0.01)
    assert x == pytest.approx(along, rel=0.015)


@pytest.mark.parametrize(("count", "off"), [(7, 5e-3), (14, 2e-3), (28, 1e-3)])
def test_the_first_mode_of_a_chain_is_that_of_a_clamped_beam(count, off):
    case = CASES["FSI3"]
    chain = Beam(case.density, case.modulus, count)
    mass, _ = chain.at(np.zeros(count), np.zeros(count))
    first = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, chain.stiffness * np.eye(count))).real.min())
    bending = case.modulus * THICKNESS**3 / (12 * (1 - POISSON**2))
    exact = (1.87510407 / BEAM) ** 2 * np.sqrt(bending / (case.density * THICKNESS))  # Rao 2011, section 8.5
    assert first == pytest.approx(exact, rel=off)


@pytest.mark.parametrize(("cells", "ratio"), [(32, 1), (80, 1), (128, 1), (256, 4)])
def test_the_channel_is_as_wide_as_it_is_published(cells, ratio):
    made = grids(CHANNEL[1] / cells, ratio, channel(lambda y: y))
    whole = made.get("coarse_grid", made["grid"])
    assert whole.origin == pytest.approx((0.0, 0.0))
    assert whole.size[1] == pytest.approx(CHANNEL[1])
    assert whole.size[0] >= CHANNEL[0] - 1e-9
    assert made["grid"].cell == pytest.approx(CHANNEL[1] / cells)
    with pytest.raises(InvalidDesign, match="both sides are held"):
        grids(CHANNEL[1] / 72, 1, channel(lambda y: y))


def test_a_period_is_measured_from_the_last_waves():
    time = np.linspace(0.0, 3.0, 3001)
    grown = np.minimum(time, 1.5) / 1.5
    across, along = 2.0 + 0.3 * grown * np.sin(10 * time), -1.0 + 0.1 * np.cos(20 * time)
    frequency, (way, other) = cycle(time, across, along)
    assert frequency == pytest.approx(10 / (2 * np.pi), rel=1e-4)
    assert way == pytest.approx((2.0, 0.3), rel=1e-3)
    assert other == pytest.approx((-1.0, 0.1), rel=1e-3)
    assert np.isnan(cycle(time[:300], across[:300])[0])  # not one whole period


@pytest.mark.slow("a second run: a flow that was stopped goes on")
def test_a_case_that_is_stopped_goes_on_to_the_same_numbers(tmp_path):
    whole = run("FSI3", 7, 32, tmp_path / "whole", 0.1)
    run("FSI3", 7, 32, tmp_path / "parts", 0.05)
    parts = run("FSI3", 7, 32, tmp_path / "parts", 0.1)
    shared = whole[:, 0] < 0.045  # the step that comes to the end of the first part is shorter
    assert (parts[: shared.sum()] == whole[shared]).all()
    again = run("FSI3", 7, 32, tmp_path / "again", 0.05)
    assert (parts[: len(again)] == again).all()
    assert np.interp(0.1, whole[:, 0], whole[:, 2]) == pytest.approx(parts[-1, 2], rel=1e-2)
    kept = json.loads((tmp_path / "parts" / "FSI3_7_32.json").read_text())
    assert tuple(kept) == COLUMNS
    assert kept["tip_y"] == pytest.approx(parts[:, 2], rel=1e-4)
