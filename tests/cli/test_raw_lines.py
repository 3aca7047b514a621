"""Lines of NumPy, pandas, h5py and others do not reach a user: a file that they refuse is one sentence of ours."""

import re
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest

from suchus.animals.capture import ReadingOptions, read_tracks
from suchus.apps.cli import main
from suchus.core.errors import SuchusError, UnreadableFile, plain_warnings
from suchus.core.reading import read_mesh
from suchus.flow import from_outline
from suchus.robot.control.policy import load_policy

RAW = re.compile(
    r"numpy|pandas|h5py|zipfile|pickle|dtype|could not convert|buffer|unpack requires|synchronously|Errno|decode byte"
    r"|BadZip|magic|reshape|index \d+ is out|codec|Traceback|object at 0x|encountered in",
    re.IGNORECASE,
)
"""What messages of libraries hold, and ours do not."""


def sentence(read, *args):
    """Return the one sentence with which a reader refuses a file."""
    with pytest.raises(SuchusError) as caught:
        read(*args)
    text = str(caught.value)
    assert text.endswith(".")
    assert "\n" not in text
    assert not RAW.search(text), text
    return text


BYTES = {
    "empty": b"",
    "noise": bytes(range(256)) * 8,
    "a zip that is cut": b"PK\x03\x04" + b"\0" * 60,
    "HDF5 that is cut": b"\x89HDF\r\n\x1a\n" + b"\0" * 300,
    "text": b"1,2,3\nfour,five\n",
    "UTF-16": "time [s],hip_x [mm]\n0,1\n".encode("utf-16"),
}
READERS = {
    "keypoints.csv": read_tracks,
    "keypoints.trc": read_tracks,
    "keypoints.c3d": read_tracks,
    "policy.npz": load_policy,
    "mesh.stl": read_mesh,
    "mesh.obj": read_mesh,
    "mesh.ply": read_mesh,
    "mesh.glb": read_mesh,
    "outline.txt": from_outline,
}


@pytest.mark.parametrize("content", BYTES)
@pytest.mark.parametrize("name", READERS)
def test_bytes_that_are_no_such_file(name, content, tmp_path):
    if name.endswith("c3d"):
        pytest.importorskip("c3d")
    file = tmp_path / name
    file.write_bytes(BYTES[content])
    assert name in sentence(READERS[name], file)


def test_a_policy_whose_arrays_are_others(tmp_path):
    np.savez(tmp_path / "it.npz", format=np.ones(3))
    sentence(load_policy, tmp_path / "it.npz")


@pytest.mark.parametrize("software", ["DeepLabCut", "SLEAP", "NWB"])
def test_hdf5_of_something_else(software, tmp_path):
    pytest.importorskip("movement.io")
    with h5py.File(tmp_path / "it.h5", "w") as file:
        file["x"] = np.arange(3)
    sentence(read_tracks, tmp_path / "it.h5", ReadingOptions(software=software, rate=50.0))


@pytest.mark.filterwarnings("always")
def test_warnings_of_libraries_are_not_printed(capsys):
    with plain_warnings():
        for kind in (RuntimeWarning, DeprecationWarning, FutureWarning):
            warnings.warn("overflow encountered in multiply", kind, stacklevel=1)
        warnings.warn("it sinks.", stacklevel=1)
    assert capsys.readouterr().err == "suchus: it sinks.\n"


def test_keypoints_far_beyond_any_picture_are_one_sentence_at_the_door(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    lines = (Path(__file__).parent.parent / "data" / "animals" / "needed_points.csv").read_text().splitlines()
    broken = [lines[0], *(",".join(["%.2f" % (0.02 * i), *["1e300"] * lines[0].count(",")]) for i in range(60))]
    Path("it.csv").write_text("\n".join(broken) + "\n")
    assert main(["capture", "it.csv", "--tables", "out"]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert not RAW.search(err)
    assert not Path("out").exists()


def test_the_pattern_finds_what_libraries_say():
    for text in ("could not convert string to float: 'a'", "[Errno 2] No such file", "cannot reshape array of size 3"):
        assert RAW.search(text)
    assert UnreadableFile("it.csv is empty.")
