"""What names nothing, and an output file that cannot be, are refused before a command loads its libraries."""

import subprocess
import sys

import pytest

HEAVY = {
    "numpy", "scipy", "mujoco", "numba", "matplotlib", "xarray", "pandas", "tyro", "suchus.sim.land",
    "suchus.robot.control", "suchus.sim.faults", "suchus.robot.design", "suchus.visual.figures", "suchus.flow",
}  # fmt: skip
LOADED = """
import sys
from suchus.apps.cli import main
code = main(sys.argv[1:])
print(code, *(name for name in sys.modules))
"""
REFUSED = {
    "run displacment": "there is no experiment named 'displacment'; .* Did you mean 'displacement'?",
    "run --quick": "the name of the experiment comes first",
    "run displacement --robot caimann": "there is no robot named 'caimann'",
    "run displacement --gait=belly": "there is no gait named 'belly'",
    "run displacement --out taken/out": "taken/out cannot be written",
    "capture tracks.csv --out gait.txt": "the gait goes into a .toml file; --out is 'gait.txt'",
    "capture tracks.csv --out=taken/gait.toml": "taken cannot be written",
    "capture tracks.csv --out users.toml": "users.toml exists, and nothing says that suchus wrote it",
    "capture track.csv": "there is no file track.csv",
    "capture tracks.csv --robot nobody": "there is no robot named 'nobody'",
    "import robot.urdf": "there is no file robot.urdf",
    "import tracks.csv --out robot.txt": "the robot goes into a .toml file",
    "demo --out page.txt": "the page would be page.txt",
    "compare a b --out page.txt": "the page would be page.txt",
    "replay record.nc": "there is no file record.nc",
    "replay tracks.csv --out page.txt": "the page would be page.txt",
    "page strider --out page.txt": "the page would be page.txt",
    "study clams": "there is no file clams",
    "view caimann": "there is no robot named 'caimann'",
    "size caimann": "there is no robot named 'caimann'",
    "parts caimann": "there is no robot named 'caimann'",
    "emulate caimann": "there is no robot named 'caimann'",
    "export --robot caimann": "there is no robot named 'caimann'",
    "export-commands belly": "there is no gait named 'belly'",
    "drive belly": "there is no gait named 'belly'",
    "calibrate wiring --robot caimann": "there is no robot named 'caimann'",
}


def run_command(words, folder):
    command = [sys.executable, "-c", LOADED, *words.split()]
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)


@pytest.mark.parametrize("words", REFUSED)
def test_nothing_large_is_loaded_to_refuse(words, tmp_path):
    (tmp_path / "taken").touch()
    (tmp_path / "tracks.csv").touch()
    (tmp_path / "users.toml").write_text("a = 1")
    done = run_command(words, tmp_path)
    code, *modules = done.stdout.split()
    assert code == "2"
    start, _, end = REFUSED[words].partition(" .* ")
    assert done.stderr.startswith(f"suchus: {start}")
    assert done.stderr.rstrip().endswith(end)
    assert not HEAVY & {*modules}


def test_what_is_right_goes_on_to_the_command(tmp_path):
    """The test of the test: these libraries are loaded where nothing is wrong."""
    done = run_command("export --robot caiman --format nothing", tmp_path)
    assert {"numpy", "mujoco", "suchus.robot.design"} <= {*done.stdout.split()}
    assert "there is no format named 'nothing'" in done.stderr


def test_a_file_of_the_users_is_no_unknown_name(tmp_path):
    (tmp_path / "own.toml").write_text('base = "caiman"')
    for words in ("export --format nothing --robot own.toml", "export --format nothing --gait own.toml"):
        assert "there is no format" in run_command(words, tmp_path).stderr
