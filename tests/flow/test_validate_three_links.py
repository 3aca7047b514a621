"""Kanso's three-link swimmer: as viscosity falls, a cycle takes it where it would in potential flow."""

import numpy as np
import pytest
from three_links import LinkedSwimmer, in_potential_flow
from validation_rows import note

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

AMPLITUDE = 0.25
"""Of the joints' angles [rad]: the layers part little from links that swing so far."""
CELLS = {250.0: 64, 1000.0: 96, 4000.0: 128}
"""Cells a length at the Reynolds numbers of the runs [-]: 1.1 to 2.3 across the layer of still water that swings."""


ASKED = 0.4
"""Power of the viscosity with which the difference from potential flow is asked to fall, at least [-]."""


@pytest.fixture(scope="module")
def off():
    """Differences from potential flow, of the first cycle's way and the second's way ahead, shape (number, cycle)."""
    exact = [in_potential_flow(AMPLITUDE, first, points=24) for first in (0, 1)]
    found = []
    for reynolds, cells in CELLS.items():
        swimmer = LinkedSwimmer(AMPLITUDE, reynolds, cells)
        ends = [np.zeros(3), swimmer.run(1.0)[-1, 1:], swimmer.run(2.0)[-1, 1:]]
        case = f"three-link swimmer, f L²/nu {reynolds:.0f}"
        shared = (
            f"{cells} cells/L", "2.2 m x 1.4 m, unbounded",
            "potential flow by panels of sources, 120 and 240 a link",
        )  # fmt: skip
        far = float(np.hypot(*(ends[1] - exact[0])[:2]) / np.hypot(*exact[0][:2]))
        note(case, "first cycle, difference of the way over the way", far, 0.0, *shared)
        note(case, "first cycle, turn [rad]", ends[1][2], float(exact[0][2]), *shared)
        note(case, "second cycle, way ahead [m]", ends[2][0] - ends[1][0], float(exact[1][0]), *shared)
        assert max(swimmer.left[5:]) < 0.01
        found.append([far, 1 - (ends[2][0] - ends[1][0]) / exact[1][0]])
    return np.array(found)


def test_three_links_tend_to_potential_flow(off):
    assert (np.diff(off, axis=0) < 0).all()
    assert off[-1, 0] < 0.08


MISSED = pytest.mark.xfail(strict=True, reason="0.39 in November 2026")


@pytest.mark.parametrize(
    ("cycle", "name"),
    [(0, "first cycle, way"), pytest.param(1, "second cycle, way ahead", marks=MISSED)],
)
def test_three_links_as_viscosity_falls(off, cycle, name):
    """What is missed is expected to be: a change that keeps it is seen here, as the table's row is."""
    order = -np.polyfit(np.log(list(CELLS)), np.log(off[:, cycle]), 1)[0]
    note(
        "three-link swimmer, as viscosity falls", f"{name}: power of the viscosity that the difference has", order,
        f"at least {ASKED}", "64 to 128 cells/L", "2.2 m x 1.4 m, unbounded", "a layer's thickness has a power of 0.5",
    )  # fmt: skip
    assert order >= ASKED
