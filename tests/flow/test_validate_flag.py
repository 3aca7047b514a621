"""A flag behind a cylinder moved by the coupling of robots: FSI2 and FSI3 of Turek and Hron as chains of links."""

import json
import os

import numpy as np
import pytest
from flag import CASES, COLUMNS, SHAKES, cycle, run, stem
from validation_rows import OUT, note

from pages.stated import keep, kept
from suchus.core.files import code_digest

pytestmark = [pytest.mark.validate, pytest.mark.usefixtures("validation_table")]

CELLS = {7: 80, 14: 128, 28: 128}
"""Cells across the channel by links: 128 are 31 across the cylinder and 6 across the beam."""
ASKED = 0.05, 0.02
"""Shares by which 28 links may miss the tip's range and the frequency [-]."""
UNTIL = {"FSI2": 6.4, "FSI3": 3.4}
"""End of a run, with a patch of finer cells three quarters of it [s]."""
PERIODS = 7
"""Periods that a series has at least after the springs were let go."""


def series(name, count, cells, ratio=1):
    """Return the columns of a case, from ``out/validation/flag`` if a run of this code has left them there."""
    folder = OUT / "flag" / code_digest("flow", "swimming/coupling")[:12]
    path = folder / (stem(name, count, cells, ratio) + ".json")
    if not path.exists():
        run(name, count, cells, folder, UNTIL[name] * (0.75 if ratio > 1 else 1.0), ratio=ratio)
    kept = json.loads(path.read_text())
    return [np.array(kept[column]) for column in COLUMNS]


@pytest.mark.parametrize("name", ["FSI2", "FSI3"])
@pytest.mark.parametrize("count", [7, 14, 28])
def test_a_flag_in_its_channel(name, count):
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


def swing(name, count, cells, ratio=1):
    """Return half of the range of the tip [m] and of the lift [N/m] over the last period, and the frequency [Hz]."""
    time, _, across, _, lift, *_ = series(name, count, cells, ratio)
    free = time > SHAKES / CASES[name].frequency
    assert np.ptp(time[free]) * CASES[name].frequency >= PERIODS
    frequency, ((_, half), (_, side)) = cycle(time[free], across[free], lift[free])
    return {"half": half, "lift": side, "frequency": frequency}


MISSED = pytest.mark.xfail(strict=True, reason="2.2 and 2.0 % too high in November 2026")


@pytest.mark.parametrize(
    ("name", "what"),
    [("FSI2", "half"), ("FSI3", "half"), *(pytest.param(name, "frequency", marks=MISSED) for name in CASES)],
)
def test_28_links_keep_what_is_asked(name, what):
    """What is missed is expected to be: a change that keeps it is seen here, as the table's row is."""
    found, case = swing(name, 28, CELLS[28])[what], CASES[name]
    published, asked = (case.tip_y[1], ASKED[0]) if what == "half" else (case.frequency, ASKED[1])
    assert abs(found / published - 1) <= asked


FINER = {"80": (80, 1), "128": (128, 1), "256": (256, 4)}
"""Cells across the channel of the runs by which the page on limits says what finer ones do, and how many times as wide
those away from the flag are."""
DOUBTED = 0.2
"""Share by which the lift of a run may be off before its tip proves nothing [-]."""


def by_cells(found):
    """Return what is kept of runs of FSI3: how far off ranges and frequency are, and which of them are in doubt."""
    case = CASES["FSI3"]
    published = {"half": case.tip_y[1], "lift": case.lift[1], "frequency": case.frequency}
    off = {key: {what: one[what] / published[what] - 1 for what in published} for key, one in found.items()}
    return {"off": off, "asked": list(ASKED), "doubted": [key for key in off if abs(off[key]["lift"]) > DOUBTED]}


def test_finer_cells_around_the_flag():
    """With SUCHUS_GOLDEN=write all are run and kept, the finest a quarter of an hour; else the coarsest is."""
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        keep("flag", by_cells({key: swing("FSI3", 28, *grid) for key, grid in FINER.items()}))
    found = by_cells({"80": swing("FSI3", 28, *FINER["80"])})["off"]["80"]
    assert found == pytest.approx(kept("flag")["off"]["80"], abs=0.02)
