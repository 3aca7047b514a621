"""Two terminals: emulated servos in one, a drive in the other that is ended in the middle, each way that a user can."""

import os
import pty
import signal
import subprocess
import sys
from time import monotonic, sleep

import pytest
from tests.wires import wiring

from suchus.apps.cli import main
from suchus.core.files import load
from suchus.hardware.bus import Bus, open_port
from suchus.hardware.protocols import PROTOCOLS

pytest.importorskip("serial", reason="the extra hardware is not installed")
PATIENCE = 240.0
"""How long a busy machine may take for a step [s]."""
DYNAMIXEL = wiring().servo[0].table


def wait_for(condition):
    end = monotonic() + PATIENCE
    while not condition():
        assert monotonic() < end, "it never came to that"
        sleep(0.05)


@pytest.mark.slow("an emulator and a drive are processes that are killed or get a signal")
@pytest.mark.parametrize(
    ("how", "code"), [(signal.SIGHUP, 128 + signal.SIGHUP), (signal.SIGTERM, 128 + signal.SIGTERM), ("emulator", 3)]
)
def test_a_terminal_that_closes_a_signal_and_an_emulator_that_ends_leave_a_log_and_a_limp_robot(how, code, tmp_path):
    words = [sys.executable, "-m", "suchus"]
    heard, ours, driver = tmp_path / "heard", None, None
    with heard.open("w") as said:
        emulator = subprocess.Popen(
            [*words, "emulate", "caiman", "--protocol", "dynamixel", "--clock", "bus"], cwd=tmp_path, stdout=said
        )
    try:
        wait_for(lambda: "wired as" in heard.read_text())
        ours, theirs = pty.openpty()
        with (tmp_path / "errors").open("w") as errors:
            driver = subprocess.Popen(
                [*words, "drive", "belly_crawl", "--clock", "bus", "--seconds", "600", "--out", "log"],
                cwd=tmp_path, stdin=theirs, stdout=subprocess.DEVNULL, stderr=errors, start_new_session=True,
            )  # fmt: skip
        os.close(theirs)
        bus = str(tmp_path / "hardware.port")
        wait_for(lambda: _held(bus) or driver.poll() is not None)
        sleep(4.0)
        assert driver.poll() is None, (tmp_path / "errors").read_text()
        if how == "emulator":
            emulator.kill()
        else:
            driver.send_signal(how)
        assert driver.wait(PATIENCE) == code
        assert "Traceback" not in (tmp_path / "errors").read_text()
        log = load(tmp_path / "log" / "record.nc")
        assert log.sizes["time"] > 1
        if how != "emulator":
            end = Bus(open_port(bus, 1_000_000), PROTOCOLS["dynamixel"], wait=PATIENCE / 20)
            assert [end.read(one.id, DYNAMIXEL["torque_enable"]) for one in wiring().servo] == [0] * 19
            end.close()
    finally:
        for process in filter(None, (emulator, driver)):
            process.kill()
            process.wait()
        if ours is not None:
            os.close(ours)


def _held(port):
    """Return whether somebody drives on a port."""
    import fcntl  # noqa: PLC0415  there is none on Windows

    descriptor = os.open(os.path.realpath(port), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    else:
        return False
    finally:
        os.close(descriptor)


@pytest.mark.parametrize("seconds", ["nan", "inf", "-1"])
def test_a_duration_that_cannot_be_is_refused_before_a_port_is_made(seconds, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["emulate", "caiman", "--seconds", seconds]) == 2
    assert "seconds" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
