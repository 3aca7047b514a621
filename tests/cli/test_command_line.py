import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import suchus.experiments.catalog
from suchus.apps.cli import main
from suchus.apps.cli.entry import COMMANDS
from suchus.core.files import load
from suchus.core.writing import MANIFEST
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

pytestmark = pytest.mark.usefixtures("fakes")
FAKES = Path(__file__).parent / "fake_shelf"
DRIVER = f"""
import signal, sys, suchus.experiments.catalog
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the tests' own shell ignores it
suchus.experiments.catalog.__path__ = [{str(FAKES)!r}]
from suchus.apps.cli import main
sys.exit(main())
"""


def one_sentence(capsys):
    """Whatever was printed is one line on standard error that reads as a sentence."""
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("suchus: ")
    assert err.count("\n") == 1
    assert err.endswith((".\n", "?\n"))
    assert "Traceback" not in err
    return err


BAD = {
    "--version x": "leave out 'x'",
    "walk": "there is demo, reproduce, run",
    "run": "wave",
    "run --quick": "comes first",
    "run wav": "Did you mean 'wave'?",
    "run wave --robot kaiman": "caiman",
    "run wave --gait trot": "belly_crawl",
    "run wave --robot missing.toml": "there is no file missing.toml",
    "run wave --amplitude high": "'high'",
    "run wave --amplitude": "missing value",
    "run wave --amplitude -1": "more than 0 m is allowed",
    "run wave --amplitude nan": "more than 0 m is allowed",
    "run wave --amplitde 1": "Did you mean '--amplitude'?",
    "run wave stray": "one word too many",
    "run wave --out /dev/null/here": "cannot be written",
    "reproduce --out /dev/null/here": "cannot be written",
    "reproduce --slow": "there is --out, --quick, --all, --jobs",
    "reproduce --jobs 0": "at least 1",
    "list everything": "takes no 'everything'",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_input_is_one_sentence_and_exit_code_2(words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(words.split()) == 2
    assert BAD[words] in one_sentence(capsys)
    assert list(tmp_path.iterdir()) == []


def test_every_mistake_in_a_robot_file_is_in_the_sentence(capsys, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('base = "caiman"\n[hind_leg]\nfemur = -1\n[tail]\nlenght = 2\n[head]\nmass = "heavy"\n')
    assert main(["run", "wave", "--robot", str(file), "--out", str(tmp_path / "out")]) == 2
    sentence = one_sentence(capsys)
    for said in ("hind_leg.femur is -1 m; 0.0001 to 10 m", "tail.lenght is not known", "head.mass is 'heavy'"):
        assert said in sentence
    assert not (tmp_path / "out").exists()


def test_a_foreign_folder_is_never_replaced(capsys, tmp_path):
    (tmp_path / "wave").mkdir()
    (tmp_path / "wave" / "thesis.tex").write_text("years of work")
    assert main(["run", "wave", "--out", str(tmp_path)]) == 2
    assert "nothing says that suchus wrote it" in one_sentence(capsys)
    assert (tmp_path / "wave" / "thesis.tex").read_text() == "years of work"


def test_a_run_writes_what_the_contract_promises(tmp_path):
    assert main(["run", "wave", "--amplitude", "0.5", "--out", str(tmp_path)]) == 0
    folder = tmp_path / "wave"
    pictures = {"wave.svg", "wave.png", "wave.data.csv"}
    files = {"index.html", "outcome.json", "record.nc", "samples.txt", MANIFEST, *pictures}
    assert {f.name for f in folder.iterdir()} == files
    told = json.loads((folder / "outcome.json").read_text())
    assert told["experiment"] == "wave"
    assert told["measures"] == {"height": {"value": 0.5, "unit": "m"}, "nothing": {"value": None, "unit": "-"}}
    first, second = told["verdicts"]
    assert (first["claim"], first["printed"], first["measured"]) == ("displacement_coordinated", 0.73, 0.5)
    assert (first["verdict"], first["unit"]) == ("same sense", "m")
    assert (second["printed"], second["measured"], second["verdict"]) == (None, None, "not testable")
    assert re.fullmatch("[0-9a-f]{64}", told["provenance"]["config_hash"])
    assert told["provenance"]["seed"] == 7
    assert {"suchus", "python", "mujoco", "numpy"} <= told["provenance"]["versions"].keys()
    assert told["provenance"]["seconds"] >= 0
    assert load(folder / "record.nc").attrs == {"n": {"a": 1}}


def test_equal_runs_give_equal_files(tmp_path):
    for out in ("a", "b"):
        assert main(["run", "wave", "--quick", "--out", str(tmp_path / out)]) == 0
    for name in ("record.nc", "wave.svg", "wave.png", "samples.txt"):
        assert (tmp_path / "a/wave" / name).read_bytes() == (tmp_path / "b/wave" / name).read_bytes()
    first, second = (json.loads((tmp_path / out / "wave/outcome.json").read_text()) for out in "ab")
    for told, out in ((first, "a"), (second, "b")):
        told["provenance"].pop("seconds")
        told["command"] = told["command"].replace(str(tmp_path / out), "")
    assert first == second


def test_quick_is_a_start_that_fields_override(tmp_path):
    for words, samples in ((["--quick"], 20), (["--quick", "--samples", "30"], 30), ([], 200)):
        assert main(["run", "wave", *words, "--out", str(tmp_path)]) == 0
        assert load(tmp_path / "wave" / "record.nc").sizes["time"] == samples


def test_a_robot_and_a_gait_come_from_files(tmp_path):
    robot = blueprint.write(ROBOTS["caiman"], tmp_path / "r.toml")
    robot.write_text(robot.read_text().replace('name = "caiman"', 'name = "mine"'))
    gait = tmp_path / "slow.toml"
    gait.write_text('base = "limbs_only"\nperiod = 8.0\n')
    assert main(["run", "wave", "--robot", str(robot), "--gait", str(gait), "--out", str(tmp_path)]) == 0
    settings = json.loads((tmp_path / "wave/outcome.json").read_text())["settings"]
    assert settings["robot"]["name"] == "mine"
    assert (settings["gait"]["name"], settings["gait"]["period"]) == ("slow", 8.0)
    assert [limb["stroke"] for limb in settings["gait"]["limbs"]] == [limb.stroke for limb in GAITS["limbs_only"].limbs]
    assert isinstance(GAITS["limbs_only"], Gait)


def test_help_of_an_experiment_tells_its_fields(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["run", "wave", "--help"])
    assert stop.value.code == 0
    out, err = capsys.readouterr()
    assert err == ""
    for said in ("How high is a wave?", "--amplitude", "Height of the wave [m].", "--robot", "--quick", "--out"):
        assert said in out


def test_help_names_every_command(capsys):
    assert main(["--help"]) == 0
    out = capsys.readouterr().out
    assert all(f"  {command.name} " in out and command.summary in out for command in COMMANDS)


def test_list_tells_every_shelf(capsys):
    assert main(["list"]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in (*ROBOTS, *GAITS, "experiments", "How high is a wave?"))


def test_reproduce_ends_with_the_path_of_the_page(capsys, tmp_path):
    assert main(["reproduce", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "report.html")
    assert "How high is a wave?" in (tmp_path / "report.html").read_text()


@pytest.mark.usefixtures("broken")
def test_reproduce_leaves_out_what_does_not_reproduce_the_article(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(type(suchus.experiments.catalog.EXPERIMENTS["broken"]), "reproduces", False)
    assert main(["reproduce", "--out", str(tmp_path)]) == 0
    page = (tmp_path / "report.html").read_text()
    assert page.count("broken") == 1
    assert "Not run, since they judge no claim of the article:\nbroken. " in page
    err = capsys.readouterr().err
    assert err.count("wave:") == 1
    assert "not run, since they judge no claim of the article: broken; suchus reproduce --all does" in err
    assert main(["reproduce", "--all", "--out", str(tmp_path)]) == 1
    assert "it broke, as it should" in (tmp_path / "report.html").read_text()
    assert "Not run" not in (tmp_path / "report.html").read_text()


@pytest.mark.usefixtures("broken")
def test_an_experiment_that_breaks_does_not_stop_the_others(capsys, tmp_path):
    assert main(["reproduce", "--out", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert out.splitlines()[-1] == str(tmp_path / "report.html")
    assert "broken: failed: RuntimeError: it broke, as it should" in err
    page = (tmp_path / "report.html").read_text()
    assert "it broke, as it should" in page
    assert "How high is a wave?" in page
    assert not (tmp_path / "broken").exists()


@pytest.mark.slow("a process is stopped")
def test_ctrl_c_stops_with_130_and_leaves_nothing_half_written(tmp_path):
    out, started = tmp_path / "out", tmp_path / "started"
    assert main(["run", "wave", "--quick", "--out", str(out)]) == 0
    before = (out / "wave/outcome.json").read_bytes()
    process = subprocess.Popen(
        [sys.executable, "-c", DRIVER, "run", "wave", "--pause", "60", "--out", str(out)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "WAVE_STARTED": str(started)},
    )
    while not started.exists():
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    told, complaint = process.communicate(timeout=300)
    assert process.returncode == 130
    assert told == ""
    assert complaint.startswith("suchus: stopped")
    assert complaint.count("\n") == 1
    assert [f.name for f in out.iterdir()] == ["wave"]
    assert (out / "wave/outcome.json").read_bytes() == before


def test_ctrl_c_while_saving_keeps_the_earlier_result(tmp_path, monkeypatch, capsys):
    assert main(["run", "wave", "--quick", "--out", str(tmp_path)]) == 0
    before = (tmp_path / "wave/outcome.json").read_bytes()

    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("suchus.core.files.save", stopped)
    assert main(["run", "wave", "--out", str(tmp_path)]) == 130
    assert "stopped" in capsys.readouterr().err
    assert [f.name for f in tmp_path.iterdir()] == ["wave"]
    assert (tmp_path / "wave/outcome.json").read_bytes() == before


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        ("import suchus", {"numpy", "mujoco", "matplotlib", "xarray", "numba", "scipy", "tyro", "pydantic"}),
        ("from suchus.apps.cli import main; main(['--help'])", {"numpy", "mujoco", "matplotlib", "xarray", "tyro"}),
        ("from suchus.apps.cli import main; main(['list'])", {"numpy", "mujoco", "matplotlib", "xarray", "scipy"}),
        ("import suchus.sim.metrics", {"scipy.stats", "matplotlib", "mujoco"}),
    ],
)
def test_light_commands_load_nothing_heavy(code, unwanted):
    told = subprocess.run(
        [sys.executable, "-c", f"{code}; import sys; print('LOADED', *sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()[-1]
    assert told.startswith("LOADED")
    assert not unwanted & set(told.split())
