"""A flag behind a cylinder moved by the coupling of robots: FSI2 and FSI3 of Turek and Hron as chains of links."""

import json

import numpy as np
import pytest
from flag import CASES, COLUMNS, SHAKES, cycle, run
from validation_rows import OUT, note

from suchus.record import code_digest

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

CELLS = {7: 72, 14: 128, 28: 128}
"""Cells across the channel by links: 128 are 31 across the cylinder and 6 across the beam."""
UNTIL = {"FSI2": 6.4, "FSI3": 3.4}
"""End of a run [s]."""
PERIODS = 7
"""Periods that a series has at least after the springs were let go."""


def series(name, count):
    """Return the columns of a case, from ``out/validation/flag`` if a run of this code has left them there."""
    folder = OUT / "flag" / code_digest("flow", "coupling")[:12]
    path = folder / f"{name}_{count}_{CELLS[count]}.json"
    if not path.exists():
        run(name, count, CELLS[count], folder, UNTIL[name])
    kept = json.loads(path.read_text())
    return [np.array(kept[column]) for column in COLUMNS]


@pytest.mark.parametrize("name", ["FSI2", "FSI3"])
@pytest.mark.parametrize("count", [7, 14, 28])
def test_flag_behind_a_cylinder(name, count):
    case = CASES[name]
    time, along, across, drag, lift, left, _ = series(name, count)
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
        note(label, "tip's range, off by", off, "at most 0.05", *shared)
        note(label, "frequency, off by", missed, "at most 0.02", *shared)
        assert off < 0.1
        assert missed < 0.02
