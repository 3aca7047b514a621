"""Damaged and foreign files: one sentence, whatever HDF5 and xarray make of them."""

import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import IncompatibleRecord, SuchusError, UnreadableFile, Unwritable, shortened
from suchus.core.files import check_name, check_writable, load, new_folder, read_json, read_toml, save
from suchus.core.reading import MAX_FILE_SIZE


@pytest.fixture
def record():
    return xr.Dataset({"x": ("time", np.linspace(0.0, 1.0, 50)), "name": ("time", ["a"] * 50)}, attrs={"k": [1, 2]})


def test_every_flipped_bit_of_a_record_is_known(record, tmp_path):
    whole = save(record, tmp_path / "r.nc").read_bytes()
    torn = tmp_path / "torn.nc"
    for at in range(0, len(whole) - 80, 97):
        torn.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << at % 8]) + whole[at + 1 :])
        with pytest.raises(IncompatibleRecord, match="is damaged"):
            load(torn)
    for end in (0, 1, 100, len(whole) - 90):
        torn.write_bytes(whole[:end])
        with pytest.raises(IncompatibleRecord, match="can be read"):
            load(torn)
        with pytest.raises(IncompatibleRecord, match="is damaged"):
            load(torn, require_seal=True)


@pytest.mark.parametrize("change", [lambda d: d[:-5], lambda d: d[:-70], lambda d: d + b"x", lambda d: d + d[-80:]])
def test_a_seal_that_is_cut_or_followed_is_none(change, record, tmp_path):
    whole = save(record, tmp_path / "r.nc").read_bytes()
    (tmp_path / "r.nc").write_bytes(change(whole))
    with pytest.raises(IncompatibleRecord, match="is damaged"):
        load(tmp_path / "r.nc")


def test_the_seal_is_no_part_of_the_record_for_others(record, tmp_path):
    path = save(record, tmp_path / "r.nc")
    np.testing.assert_array_equal(xr.load_dataset(path, engine="h5netcdf").x, record.x)
    bare = tmp_path / "bare.nc"
    bare.write_bytes(path.read_bytes()[:-80])
    xr.testing.assert_identical(load(bare).x, load(path).x)  # a file from before there were seals


def test_nothing_is_read_from_other_files(record, tmp_path):
    save(record, tmp_path / "other.nc")
    for kind, link in {
        "external": h5py.ExternalLink(str(tmp_path / "other.nc"), "/x"),
        "soft": h5py.SoftLink("/elsewhere"),
    }.items():
        path = tmp_path / f"{kind}.nc"
        record.assign_attrs(suchus_record=1, suchus_attributes="{}").to_netcdf(path, engine="h5netcdf")
        with h5py.File(path, "a") as file:
            file["y"] = link
        with pytest.raises(IncompatibleRecord, match="refers to other files or places by 'y'"):
            load(path)
    path = tmp_path / "raw.nc"
    with h5py.File(path, "w") as file:
        file.create_dataset("y", (8,), "u1", external=[("/etc/passwd", 0, 8)])
    with pytest.raises(IncompatibleRecord, match="keeps 'y' in other files"):
        load(path)


def test_what_claims_more_than_it_can_hold_is_not_made_room_for(tmp_path):
    path = tmp_path / "bomb.nc"
    with h5py.File(path, "w") as file:
        file.create_dataset("x", (10**12,), "f8", chunks=(10**6,), compression="gzip")
    with pytest.raises(IncompatibleRecord, match="claims to hold 8e"):
        load(path)


@pytest.mark.parametrize("text", ["not JSON", "[1]", "[" * 5000, "1" * 5000])
def test_attributes_that_suchus_did_not_write_are_refused(record, text, tmp_path):
    path = tmp_path / "r.nc"
    record.assign_attrs(k=0, suchus_record=1, suchus_attributes=text).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(IncompatibleRecord, match="attributes that suchus did not write"):
        load(path)
    record.assign_attrs(k=0, suchus_record="x", suchus_attributes="{}").to_netcdf(path, engine="h5netcdf")
    with pytest.raises(IncompatibleRecord, match="version x"):
        load(path)


def test_pipes_devices_folders_and_names_that_are_none_are_no_files(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path, said in (
        (tmp_path / "pipe", "pipe, a socket or a device"),
        ("/dev/zero", "pipe, a socket or a device"),
        (tmp_path, "is a folder"),
        (tmp_path / ("n" * 300), "cannot be read"),
        ("a\0b", "is no name"),
        (tmp_path / "none", "there is no file"),
        (tmp_path / "pipe" / "below", "there is no file"),
    ):
        for reader in (load, read_toml, read_json):
            with pytest.raises(UnreadableFile, match=said):
                reader(type(tmp_path)(path))


@pytest.mark.parametrize("text", ["a = " + "1" * 5000, "a = " + "[" * 3000 + "]" * 3000, "a = 1\na = 2", "\0"])
def test_a_file_that_python_cannot_hold_is_a_sentence(text, tmp_path):
    path = tmp_path / "x.toml"
    path.write_text(text)
    with pytest.raises(UnreadableFile, match=r"x\.toml (holds|is not valid)") as told:
        read_toml(path)
    assert "int" not in str(told.value).split()
    with path.open("wb") as file:
        file.truncate(MAX_FILE_SIZE + 1)
    with pytest.raises(UnreadableFile, match="larger than 64 MiB"):
        read_toml(path)


@pytest.mark.parametrize("name", ["", ".", "..", " ", "a/b", "a\\b", "a\0b", "a\nb", "n" * 201])
def test_names_that_make_no_folder_of_their_own(name):
    with pytest.raises(SuchusError, match="which makes no folder"):
        check_name(name, "study")
    check_name("n" * 200, "study")
    check_name("a study. of mine", "study")


def test_messages_do_not_repeat_pages():
    assert len(str(SuchusError(f"there is no {'x' * 5000}."))) < 400
    assert len(str(SuchusError("a " * 5000))) < 3000
    assert shortened("a sentence of usual length.") == "a sentence of usual length."
    assert shortened("/" + "d" * 250 + "/file") == "/" + "d" * 250 + "/file"


KILLED = """
import os, signal, sys
from pathlib import Path
from suchus.core.files import new_folder
with new_folder(Path(sys.argv[1])) as draft:
    (draft / "m").write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_drafts_of_the_dead_are_swept_and_those_of_the_living_stay(tmp_path):
    place = tmp_path / "result"
    done = subprocess.run([sys.executable, "-c", KILLED, str(place)], check=False)
    assert done.returncode == -signal.SIGKILL
    assert [p.name[:8] for p in tmp_path.iterdir()] == [".result-"]
    with new_folder(place) as first:
        assert len(list(tmp_path.iterdir())) == 1  # the dead one's is gone
        (first / "m").write_text("first")
        with new_folder(place) as second:
            (second / "m").write_text("second")
        assert first.is_dir()
    assert [p.name for p in tmp_path.iterdir()] == ["result"]
    assert (place / "m").read_text() == "first"


def test_many_writers_of_one_place_all_end_well(tmp_path):
    place = tmp_path / "result"

    def write(number):
        try:
            with new_folder(place) as draft:
                (draft / "m").write_text(str(number))
        except Unwritable:
            return False  # another one was faster between looking and moving
        return True

    with ThreadPoolExecutor(8) as pool:
        assert any(pool.map(write, range(40)))
    assert [p.name for p in tmp_path.iterdir()] == ["result"]
    assert (place / "m").read_text().isdecimal()


@pytest.fixture
def nobody():
    """Root becomes nobody for a while, since nothing is forbidden to root."""
    root = os.geteuid() == 0
    if root:
        os.seteuid(65534)
    yield
    if root:
        os.seteuid(0)


def test_a_folder_that_cannot_be_searched_is_a_sentence(tmp_path, request):
    shut = tmp_path / "shut"
    shut.mkdir(mode=0o000)
    request.getfixturevalue("nobody")
    with pytest.raises(Unwritable, match="permission denied"):
        check_writable(shut / "below")
    with pytest.raises(UnreadableFile, match="permission denied"):
        load(shut / "r.nc")
