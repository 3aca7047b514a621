import numpy as np
import pytest
import xarray as xr

from suchus.errors import Unwritable
from suchus.record import Parts, code_digest

ROOMS = ("design",)


def part(value):
    return xr.Dataset({"x": ("time", np.array([value, np.pi, np.nan])), "word": ("time", np.array(["a", "bcd", ""]))})


def never():
    raise AssertionError("made again")


def test_what_is_there_is_not_made_again_and_is_the_same(tmp_path):
    first = Parts(tmp_path, {"a": 1}, ROOMS).get("one", lambda: part(0.1))
    again = Parts(tmp_path, {"a": 1}, ROOMS).get("one", never)
    assert again.identical(first)
    assert again.x.values.tobytes() == part(0.1).x.values.tobytes()
    assert again.word.values.tolist() == ["a", "bcd", ""]


def test_other_settings_other_parts(tmp_path):
    Parts(tmp_path, {"a": 1}, ROOMS).get("one", lambda: part(1.0))
    other = Parts(tmp_path, {"a": 2}, ROOMS).get("one", lambda: part(2.0))
    assert float(other.x[0]) == 2.0


def test_other_code_other_parts(tmp_path):
    # the rooms stand for the code that makes the parts
    one, other = (Parts(tmp_path, {"a": 1}, rooms) for rooms in (("design",), ("design", "motion")))
    assert one.folder != other.folder
    assert code_digest(("design",)) == code_digest(("design",))
    assert code_digest(("experiments/displacement.py",)) != code_digest(("experiments/sensitivity.py",))


def test_a_part_that_was_interrupted_leaves_nothing(tmp_path):
    parts = Parts(tmp_path, {}, ROOMS)

    def stopped():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        parts.get("one", stopped)
    assert not list(tmp_path.rglob("*.nc"))
    assert float(parts.get("one", lambda: part(3.0)).x[0]) == 3.0


def test_a_damaged_part_is_made_again(tmp_path):
    parts = Parts(tmp_path, {}, ROOMS)
    parts.get("one", lambda: part(1.0))
    (parts.folder / "one.nc").write_bytes(b"not NetCDF")
    assert float(parts.get("one", lambda: part(4.0)).x[0]) == 4.0
    assert float(parts.get("one", never).x[0]) == 4.0


def test_nothing_is_kept_where_nothing_shall_be(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert Parts(None, {}, ROOMS).get("one", lambda: part(5.0)).identical(part(5.0))
    assert not list(tmp_path.iterdir())


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(Unwritable, match="file"):
        Parts(tmp_path / "file", {}, ROOMS).get("one", lambda: part(1.0))
