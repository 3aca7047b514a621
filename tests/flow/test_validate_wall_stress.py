"""The trial of a layer by its law, as far as a validation runs it again; `make validate`.

What the page on limits says of it is of runs that ``wall_stress.py`` kept, those in space of minutes to half an hour.
"""

import os

import pytest
from validation_rows import OUT
from wall_stress import gathered, judged, left_in, run

from pages.stated import keep, kept


def test_what_is_kept_says_what_its_runs_say():
    """With SUCHUS_GOLDEN=write it first keeps the runs in ``out/validation/wall_stress``."""
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        keep("wall_stress", gathered(left_in(OUT / "wall_stress")))
    found = kept("wall_stress")
    said = judged(found["runs"])
    assert said["word"] == found["word"]
    for key in ("word", "off", "law", "plain"):
        assert [row[key] for row in said["rows"]] == [row[key] for row in found["rows"]]


@pytest.mark.validate
@pytest.mark.parametrize("law", ["law", "plain"])
def test_a_new_run_has_the_drag_that_is_kept(law, tmp_path):
    """Over 25 diameters of a wake that beats unevenly."""
    before = kept("wall_stress")["runs"][f"towed_10000_16_{law}_plane"]
    found = run("towed", 1e4, 16, law, "plane", tmp_path, before["time"], before["since"])
    assert found["drag"] == pytest.approx(before["drag"], rel=0.05)
