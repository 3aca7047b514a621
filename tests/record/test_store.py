import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import IncompatibleRecord, UnreadableFile, Unwritable
from suchus.core.files import check_writable, digest, load, new_folder, plain, provenance, remove_leftovers, save
from suchus.core.writing import MANIFEST


@pytest.fixture
def record():
    time = np.arange(300) * 0.01
    return xr.Dataset(
        {
            "height": (("run", "time"), np.vstack([np.sin(time), np.cos(time)]), {"units": "m"}),
            "fell": ("run", np.array([True, False])),
            "count": ((), 3),
            "cause": ("run", np.array(["", "tipped over"])),
        },
        coords={"run": ["left", "right"], "time": ("time", time, {"units": "s"})},
        attrs={"nested": {"list": [1, 2.5], "none": None}, "schema": "test 1"},
    )


def test_a_record_comes_back_equal(record, tmp_path):
    again = load(save(record, tmp_path / "deep" / "r.nc"))
    xr.testing.assert_identical(again, record)
    assert {name: v.dtype.kind for name, v in again.variables.items()} == {
        name: v.dtype.kind for name, v in record.variables.items()
    }


def test_a_path_may_be_a_text(record, tmp_path):
    file = save(record, str(tmp_path / "r.nc"))
    xr.testing.assert_identical(load(str(file)), record)
    with pytest.raises(UnreadableFile, match="there is no file"):
        load(str(tmp_path / "none.nc"))


def test_saving_leaves_the_record_alone(record, tmp_path):
    before = record.copy(deep=True)
    save(record, tmp_path / "r.nc")
    xr.testing.assert_identical(record, before)


def test_equal_records_give_equal_bytes(record, tmp_path):
    first = save(record, tmp_path / "a.nc").read_bytes()
    assert save(record.copy(deep=True), tmp_path / "b.nc").read_bytes() == first


def test_a_file_is_what_xarray_itself_writes_and_a_seal(record, tmp_path):
    written = save(record.drop_attrs(), tmp_path / "a.nc").read_bytes()
    marked = record.drop_attrs().assign_attrs(suchus_record=1, suchus_attributes="{}")
    packed = {"zlib": True, "complevel": 4, "shuffle": True}
    numbers = [name for name, v in marked.variables.items() if v.dtype.kind in "biuf" and v.size > 1]
    assert written.startswith(bytes(marked.to_netcdf(engine="h5netcdf", encoding=dict.fromkeys(numbers, packed))))


def test_records_are_compressed(tmp_path):
    zeros = xr.Dataset({"x": ("time", np.zeros(100_000))})
    assert save(zeros, tmp_path / "r.nc").stat().st_size < zeros.nbytes / 20


def test_what_is_no_record_of_ours_is_refused(record, tmp_path):
    (tmp_path / "text.nc").write_text("no NetCDF")
    record.drop_attrs().to_netcdf(tmp_path / "foreign.nc", engine="h5netcdf")
    for name, said in (("text.nc", "not a NetCDF file"), ("foreign.nc", "not written by suchus")):
        with pytest.raises(IncompatibleRecord, match=said):
            load(tmp_path / name)
    with pytest.raises(UnreadableFile, match="there is no file"):
        load(tmp_path / "missing.nc")


def test_a_record_of_a_later_version_is_refused(record, tmp_path, monkeypatch):
    monkeypatch.setattr("suchus.core.files.store._VERSION", 2)
    save(record, tmp_path / "r.nc")
    monkeypatch.setattr("suchus.core.files.store._VERSION", 1)
    with pytest.raises(IncompatibleRecord, match="update suchus"):
        load(tmp_path / "r.nc")


def test_a_failed_save_leaves_the_old_file(record, tmp_path, monkeypatch):
    old = save(record, tmp_path / "r.nc").read_bytes()

    def fails(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", fails)
    with pytest.raises(Unwritable, match="no space left"):
        save(record, tmp_path / "r.nc")
    assert [f.name for f in tmp_path.iterdir()] == ["r.nc"]
    assert (tmp_path / "r.nc").read_bytes() == old


def test_a_folder_appears_complete_or_not_at_all(tmp_path):
    place = tmp_path / "result"

    def stopped():
        with new_folder(place) as draft:
            (draft / "m").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert list(tmp_path.iterdir()) == []
    for content in ("one", "two"):
        with new_folder(place) as draft:
            (draft / "m").write_text(content)
            (draft / content).touch()
    assert {f.name for f in place.iterdir()} == {"m", "two", MANIFEST}
    assert list(tmp_path.iterdir()) == [place]


def test_a_folder_that_is_not_ours_is_never_replaced(tmp_path):
    (tmp_path / "result").mkdir()
    (tmp_path / "result" / "thesis.tex").touch()

    def replace():
        with new_folder(tmp_path / "result"):
            pass

    with pytest.raises(Unwritable, match="nothing says that suchus wrote it"):
        replace()
    assert (tmp_path / "result" / "thesis.tex").exists()


def test_a_new_folder_can_be_read_by_those_who_may_read_its_parent(tmp_path):
    with new_folder(tmp_path / "result"):
        pass
    mask = os.umask(0)
    os.umask(mask)
    assert (tmp_path / "result").stat().st_mode & 0o777 == 0o777 & ~mask


def test_checking_a_place_leaves_nothing_behind(tmp_path):
    check_writable(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(Unwritable, match="cannot be written"):
        check_writable(Path("/dev/null/a"))


@dataclass(frozen=True)
class _Part:
    length: float
    tags: tuple[str, ...] = ()


def test_equal_settings_have_equal_digests_in_any_order_and_type():
    first = {"part": _Part(0.5, ("a",)), "seed": 3}
    second = {"seed": np.int64(3), "part": {"tags": ["a"], "length": np.float64(0.5)}}
    assert digest(first) == digest(second)
    assert digest(first) != digest({**first, "seed": 4})
    assert digest(first) != digest({**first, "part": _Part(0.5000001, ("a",))})


def test_plain_values_are_json():
    assert plain({"a": (1, np.arange(2)), "b": float("nan"), "c": Path("x/y"), "d": {2, 1}}) == {
        "a": [1, [0, 1]],
        "b": "nan",
        "c": "x/y",
        "d": [1, 2],
    }
    with pytest.raises(TypeError, match="object"):
        plain(object())


def test_provenance_differs_in_seconds_only():
    first, second = (provenance({"seed": 1, "x": 2.0}, seconds=s) for s in (1.0, 2.0))
    assert first.pop("seconds") != second.pop("seconds")
    assert first == second


def test_what_a_process_that_died_has_left_is_swept_and_the_older_result_comes_back(tmp_path):
    place, shelter = tmp_path / "result", tmp_path / ".result-abc"
    (shelter / "new").mkdir(parents=True)
    (tmp_path / ".results-abc").mkdir()
    (shelter / "old").mkdir()
    (shelter / "old/m").write_text("an older one")
    remove_leftovers(place)  # it died between the two renames
    assert (place / "m").read_text() == "an older one"
    (shelter / "old").mkdir(parents=True)
    remove_leftovers(place)
    assert (place / "m").read_text() == "an older one"
    assert sorted(path.name for path in tmp_path.iterdir()) == [".results-abc", "result"]
