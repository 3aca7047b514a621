"""Experiments in processes of their own: the same files, whoever breaks, dies or is stopped."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.apps.report import PAGE
from suchus.core.stopping import CUT_MESSAGE
from suchus.core.writing import MANIFEST

FAKES = Path(__file__).parent / "fake_shelf"

CRASHING = '''"""Does it crash?"""
import os
from dataclasses import dataclass
import suchus.experiments.catalog.wave as wave

@dataclass(frozen=True, slots=True, kw_only=True)
class Crashing(wave.Wave):
    title = "Does it crash?"

    def run(self, progress=None):
        os._exit(7)

experiment = Crashing()
'''


SLOW = '''"""Is it slow?"""
import os, time
from dataclasses import dataclass, replace
from pathlib import Path
import suchus.experiments.catalog.wave as wave
from suchus.experiments.experiment import Replay

def dawdle():
    Path(os.environ["STARTED"]).write_text(str(os.getpid()))
    time.sleep(3600.0)

@dataclass(frozen=True, slots=True, kw_only=True)
class Slow(wave.Wave):
    title = "Is it slow?"

    def run(self, progress=None):
        return replace(wave.Wave.run(self), replays={"slow.html": Replay(caption="It dawdles.", make=dawdle)})

experiment = Slow()
'''
DRIVER = """
import signal, sys, suchus.experiments.catalog
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the tests' own shell ignores it
suchus.experiments.catalog.__path__ = sys.argv.pop(1).split(":")
from suchus.apps.cli import main
sys.exit(main())
"""


@pytest.fixture
def crashing(broken, tmp_path):
    """A third fake takes its process with it."""
    (tmp_path / "broken_shelf/crashing.py").write_text(CRASHING)


def files(folder: Path) -> dict[str, bytes | dict[str, object]]:
    """What a folder holds; of an outcome, and of its page, all but its command, its threads and its time."""
    found: dict[str, bytes | dict[str, object]] = {
        path.name: path.read_bytes() for path in folder.iterdir() if path.name not in (MANIFEST, PAGE)
    }
    found["outcome.json"] = json.loads(found["outcome.json"])
    del found["outcome.json"]["provenance"]["seconds"], found["outcome.json"]["command"]
    del found["outcome.json"]["provenance"]["machine"]["described"]["threads"]
    return found


@pytest.mark.usefixtures("crashing")
@pytest.mark.slow("a process dies")
def test_who_breaks_or_dies_is_told_and_the_others_are_as_ever(capsys, tmp_path):
    assert main(["reproduce", "--jobs", "2", "--out", str(tmp_path / "out")]) == 1
    out, err = capsys.readouterr()
    assert out == f"{tmp_path / 'out/report.html'}\n"
    assert "broken: failed: RuntimeError: it broke, as it should" in err
    assert "crashing: failed: its process ended with exit code 7" in err
    page = (tmp_path / "out/report.html").read_text()
    assert page.index("it broke, as it should") < page.index("exit code 7")
    assert sorted(path.name for path in (tmp_path / "out").glob("[!.]*")) == ["report.html", "wave"]
    assert main(["run", "wave", "--out", str(tmp_path / "alone")]) == 0
    assert files(tmp_path / "out/wave") == files(tmp_path / "alone/wave")
    outcome = json.loads((tmp_path / "out/wave/outcome.json").read_text())
    assert outcome["provenance"]["machine"]["described"]["threads"] == "1"


PATIENCE = 300.0
"""Time that a process may take to end, however busy the machine is; one that computes on takes an hour [s]."""


@pytest.fixture
def saving(tmp_path):
    """Two experiments in processes, of which one saves for an hour: it alone or its whole group may get a signal."""
    started = tmp_path / "started"
    (tmp_path / "slow.py").write_text(SLOW)
    process = subprocess.Popen(
        [
            sys.executable,
            "-c",
            DRIVER,
            f"{FAKES}:{tmp_path}",
            "reproduce",
            "--jobs",
            "2",
            "--out",
            str(tmp_path / "out"),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "STARTED": str(started)},
        start_new_session=True,
    )
    with process:
        try:
            while not started.exists():
                assert process.poll() is None
                time.sleep(0.05)
            yield process
        finally:  # else it is a warning of a process that nobody waited for, in whatever test comes next
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


@pytest.mark.battery("kills")
@pytest.mark.slow("processes are stopped")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_a_signal_while_one_is_saving_stops_all_and_leaves_nothing_half_written(tmp_path, saving, number, counted):
    out = tmp_path / "out"
    if number == signal.SIGINT:
        os.killpg(saving.pid, number)  # as a terminal does, to all of them
    else:
        os.kill(saving.pid, number)
    told, complaint = saving.communicate(timeout=PATIENCE)
    counted()
    killed = number == signal.SIGKILL
    assert (saving.returncode, told) == (-number if killed else 128 + number, "")
    assert "Traceback" not in complaint
    if not killed:
        assert complaint.splitlines()[-1].startswith("suchus: stopped"), complaint
        cut = complaint.endswith(CUT_MESSAGE)  # a machine that is busy with others
        assert {path.name for path in out.glob("[!.]*" if cut else "*")} <= {"wave"}
    worker, end = int((tmp_path / "started").read_text()), time.monotonic() + PATIENCE
    while is_there(worker):
        assert time.monotonic() < end, "a worker computes on"
        time.sleep(0.05)


def is_there(pid):
    """Return whether a process lives; one that has ended waits for nobody in particular."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
