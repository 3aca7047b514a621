"""Where no adapter or no wiring is there, the sentence says that, and what to do."""

import pytest

from suchus.apps.cli import main
from suchus.core.errors import BusFailure, UnreadableFile
from suchus.hardware import read_wiring
from suchus.hardware.bus import open_port
from suchus.hardware.bus import ports as bus_ports
from suchus.robot.robots import ROBOTS


def test_a_missing_wiring_names_what_writes_one(tmp_path, monkeypatch, capsys):
    with pytest.raises(UnreadableFile, match="suchus calibrate wiring --robot strider writes one"):
        read_wiring(tmp_path / "none.toml", ROBOTS["strider"])
    monkeypatch.chdir(tmp_path)
    assert main(["drive", "--port", "/dev/ttyUSB97"]) == 2
    assert "there is no file hardware.toml, which says where each servo hangs" in capsys.readouterr().err


def test_a_missing_adapter_is_said_with_the_remedy(monkeypatch):
    class NoPorts:
        def __init__(self, folder):
            self.folder = folder

        def glob(self, _):
            return []

    real = bus_ports.Path
    monkeypatch.setattr(bus_ports, "Path", lambda path: NoPorts(path) if str(path).startswith("/dev/serial") or
                        str(path) == "/dev" else real(path))  # fmt: skip
    with pytest.raises(BusFailure, match=r"no adapter is plugged in, .* plug it in, or start suchus emulate"):
        open_port("/dev/ttyUSB97", 1_000_000)
