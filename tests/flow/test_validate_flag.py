"""A flag behind a cylinder moved by the coupling of robots: FSI2 and FSI3 of Turek and Hron as chains of links."""

import json

import numpy as np
import pytest
from flag import CASES, COLUMNS, SHAKES, cycle, run, stem
from validation_rows import OUT, note

from suchus.record import code_digest

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

CELLS = {7: 80, 14: 128, 28: 128}
"""Cells across the channel by links: 128 are 31 across the cylinder and 6 across the beam."""
ASKED = 0.05, 0.02
"""Shares by which 28 links may miss the tip's range and the frequency [-]."""
UNTIL = {"FSI2": 6.4, "FSI3": 3.4}
"""End of a run [s]."""
PERIODS = 7
"""Periods that a series has at least after the springs were let go."""


def series(name, count, cells, ratio=1):
    """Return the columns of a case, from ``out/validation/flag`` if a run of this code has left them there."""
    folder = OUT / "flag" / code_digest("flow", "coupling")[:12]
    path = folder / (stem(name, count, cells, ratio) + ".json")
    if not path.exists():
        run(name, count, cells, folder, UNTIL[name], ratio=ratio)
    kept = json.loads(path.read_text())
    return [np.array(kept[column]) for column in COLUMNS]


@pytest.mark.parametrize("name", ["FSI2", "FSI3"])
@pytest.mark.parametrize("count", [7, 14, 28])
def test_flag_behind_a_cylinder(name, count):
    case = CASES[name]
    time, along, across, drag, lift, left, _ = series(name, count, CELLS[count])
    free = time > SHAKES / case.frequency
    assert np.ptp(time[free]) * case.frequency >= PERIODS
    frequency, (way, back, pull, side) = cycle(time[free], across[free], along[free], drag[free], lift[free])
    before = time[free] < time[-1] - 2 / case.frequency
    _, (earlier, *_) = cycle(time[free][before], across[free][before])
    label = f"flag behind a cylinder, {name}, {count} links"
    shared = (
        f"{CELLS[count]} cells across the channel", "2.5 m x 0.41 m, walls",
        "Turek and Hron 2006, level 4 of their page with the shortest step",
    )  # fmt: skip
    late = time > time[-1] - 3.5 / case.frequency
    off = note(
        label, "tip across, half of its range [mm]", 1e3 * way[1], 1e3 * case.tip_y[1], *shared,
        t=time[late], tip=1e3 * across[late], middle=1e3 * case.tip_y[0], half=1e3 * case.tip_y[1],
    )  # fmt: skip
    missed = note(label, "frequency [Hz]", frequency, case.frequency, *shared)
    note(label, "tip along, middle [mm]", 1e3 * back[0], 1e3 * case.tip_x[0], *shared)
    note(label, "drag, middle [N/m]", pull[0], case.drag[0], *shared)
    note(label, "lift, half of its range [N/m]", side[1], case.lift[1], *shared)
    note(label, "change of the tip's range over the last two periods", way[1] / earlier[1] - 1, "below 0.03", *shared)
    rest = float(np.quantile(left[late], 0.99))
    note(label, "force that 99 of 100 steps leave over, in the periods judged", rest, "below 0.01", *shared)
    assert rest < 0.05
    assert abs(way[1] / earlier[1] - 1) < 0.05
    if count == 28:
        note(label, "frequency, off by", missed, f"at most {ASKED[1]}", *shared)
        note(label, "tip's range, off by", off, f"at most {ASKED[0]}", *shared)
        assert missed <= ASKED[1]


def tip(name, cells, ratio=1):
    """Return half of the range of the tip of 28 links over the last period after the springs were let go [m]."""
    time, _, across, *_ = series(name, 28, cells, ratio)
    free = time > SHAKES / CASES[name].frequency
    return cycle(time[free], across[free])[1][0][1]


@pytest.mark.parametrize(
    "name", ["FSI2", pytest.param("FSI3", marks=pytest.mark.xfail(strict=True, reason="8.4 % low in November 2026"))]
)
def test_the_tip_of_28_links_swings_as_far(name):
    """What is missed is expected to be: a change that keeps it is seen here, as the table's row is."""
    assert tip(name, CELLS[28]) == pytest.approx(CASES[name].tip_y[1], rel=ASKED[0])
