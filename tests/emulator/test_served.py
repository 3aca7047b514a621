"""An emulated bus as other programs see it: a pseudo-terminal, or a socket of this computer."""

import os
import socket
import threading
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import monotonic

import pytest
from tests.hardware.test_drive import GAIT, REST, ROBOT
from tests.wires import Obedient, wiring

from suchus.core.errors import BusFailure, InvalidDesign, Unwritable
from suchus.hardware import BusClock, DriveSettings, Rig, drive
from suchus.hardware.bus import Bus, BusGone, FilePort, open_port
from suchus.hardware.emulator import Emulator, Server, Trouble
from suchus.hardware.protocols import PROTOCOLS

pytest.importorskip("serial", reason="the extra hardware is not installed")
SOON = 60.0
"""How long a busy machine may take for an answer [s]."""


@contextmanager
def served(links=(), *, clocked=True, sockets=False, trouble=None, made=None):
    """Serve a robot whose servos are where they were sent, from a thread."""
    body, done = Obedient(), threading.Event()
    body.angles[:] = body.goals[:] = REST
    server = Server(Emulator(made or wiring(), body, trouble or Trouble(), has_clock=clocked), links, sockets=sockets)
    thread = threading.Thread(target=server.serve, args=(done.is_set,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        done.set()
        thread.join(SOON)
        server.close()


def bus_to(server, baud=1_000_000):
    return Bus(open_port(server.ports[0], baud), PROTOCOLS["dynamixel"], wait=SOON, has_clock=True)


@pytest.mark.parametrize(("protocol", "sockets"), [("dynamixel", False), ("dynamixel", True), ("line", False)])
def test_it_is_driven_through_a_port(protocol, sockets, tmp_path):
    made = wiring(protocol)
    with served([] if sockets else [tmp_path / "bus"], sockets=sockets, made=made) as server:
        made = replace(made, bus=(replace(made.bus[0], port=server.ports[0]),))
        rig = Rig(ROBOT, made, has_clock=True)
        log = drive(rig, GAIT, settings=DriveSettings(duration=0.05, stop="off"), clock=BusClock(rig))
        rig.close()
        assert log.sizes["time"] == 6
        assert log.servo_heard.values.all()
        assert sockets == server.ports[0].startswith("socket://127.0.0.1:")
    assert not (tmp_path / "bus").is_symlink()


def test_servos_hear_nothing_at_another_bit_rate_and_the_one_that_answers_is_named(monkeypatch):
    monkeypatch.setattr("suchus.hardware.rig.PATIENT", 0.05)
    monkeypatch.setattr("suchus.hardware.rig._MAX_ATTEMPTS", 1)
    opened = []

    def opened_at(name, baud):
        opened.append(baud)
        return open_port(name, baud)

    def patient(port, framing):
        """Wait long where an answer comes, and shortly where none can come."""
        return Bus(port, framing, wait=SOON if opened[-1] == 1_000_000 else 0.05)

    with served(clocked=False) as server:
        made = wiring()
        made = replace(made, bus=(replace(made.bus[0], port=server.ports[0], baud=2_000_000),))
        rig = Rig(ROBOT, made, rate=20.0)
        monkeypatch.setattr("suchus.hardware.rig.open_port", opened_at)
        monkeypatch.setattr("suchus.hardware.rig.Bus", patient)
        with pytest.raises(BusFailure, match=r"nobody answers .* at 2000000 baud, but at 1000000 baud number 1 does"):
            rig.check()


def test_a_machine_that_falls_behind_lets_the_robot_wait_and_nobody_else(monkeypatch):
    class Slow(Obedient):
        period = property(lambda self: 1e-9, lambda self, value: None)  # no machine is so fast

    body, heard = Slow(), []
    server = Server(Emulator(wiring(), body))
    monkeypatch.setattr(server, "_listen", lambda wait: heard.append((body.tick, wait)))
    server.serve(lambda: len(heard) >= 50)
    server.close()
    assert [tick for tick, _ in heard] == list(range(1, 51))  # one step between two looks at the bus
    assert {wait for _, wait in heard} == {0.0}


def test_a_second_host_is_told_that_the_port_is_held():
    with served() as server:
        first = open_port(server.ports[0], 1_000_000)
        with pytest.raises(BusFailure, match="held by another process"):
            open_port(server.ports[0], 1_000_000)
        first.close()


def test_a_port_that_is_not_there_or_none_is_said(tmp_path):
    with pytest.raises(BusFailure, match="there is no port"):
        open_port(str(tmp_path / "nothing"), 1_000_000)
    (tmp_path / "file").write_text("")
    with pytest.raises(BusFailure, match="is no serial port but a file"):
        open_port(str(tmp_path / "file"), 1_000_000)
    with pytest.raises(BusFailure, match="nobody listens at"):
        open_port("socket://127.0.0.1:9", 1_000_000)
    for elsewhere in ("socket://192.0.2.1:5000", "socket://127.0.0.1", "socket://127.0.0.1:x"):
        with pytest.raises(InvalidDesign, match="on this computer"):
            open_port(elsewhere, 1_000_000)


def test_a_port_that_one_may_not_open_is_said_with_the_group():
    with served() as server:
        name = server.ports[0]
        if os.geteuid():
            Path(name).chmod(0)
        else:
            Path(name).chmod(0o600)
            os.seteuid(65534)  # nobody
        try:
            with pytest.raises(
                BusFailure, match=r"may not be opened by you: join the group that owns it, often dialout"
            ):
                open_port(name, 1_000_000)
        finally:
            os.seteuid(os.getuid())
    with pytest.raises(BusFailure, match="cannot be opened at 1000000 baud as a serial port"):
        open_port("/dev/null", 1_000_000)


def test_a_bus_whose_other_end_closes_or_reads_no_more_is_told_of_by_the_deadline():
    ours, theirs = socket.socketpair()
    port = FilePort("a bus", ours.fileno(), ours)
    begun = monotonic()
    with pytest.raises(BusGone, match=r"took \d+ of 10000000 bytes and then none for 0.05 s"):
        port.send(bytes(10_000_000), 0.05)
    assert monotonic() - begun < SOON
    theirs.close()
    with pytest.raises(BusGone, match=r"gone|ended"):
        port.receive(SOON)
    port.close()
    port.close()


def test_a_pseudo_terminal_that_is_closed_in_mid_drive_stops_it_with_its_log():
    body = Obedient()
    body.angles[:] = body.goals[:] = REST
    server = Server(Emulator(wiring(), body, has_clock=True))

    def unplug():
        server.serve(lambda: body.time > 0.3)
        server.close()

    thread = threading.Thread(target=unplug, daemon=True)
    thread.start()
    made = wiring()
    rig = Rig(ROBOT, replace(made, bus=(replace(made.bus[0], port=server.ports[0]),)), has_clock=True)
    with pytest.raises(BusFailure, match=r"is gone|has ended.*the robot was stopped") as caught:
        drive(rig, GAIT, settings=DriveSettings(duration=5.0), clock=BusClock(rig))
    assert caught.value.record.sizes["time"] > 10
    thread.join(SOON)
    rig.close()


def test_an_emulator_that_ends_ends_the_bus():
    with served(sockets=True) as server:
        bus = bus_to(server)
        assert bus.ping(3) is not None
    with pytest.raises(BusGone, match=r"gone|ended"):
        bus.port.receive(SOON)
    bus.close()


def test_a_link_of_an_emulator_that_was_killed_is_taken_over_and_a_file_is_not(tmp_path):
    (tmp_path / "bus").symlink_to("/dev/pts/99999")
    with served([tmp_path / "bus"]) as server:
        bus = bus_to(server)
        assert bus.ping(3) is not None
        bus.close()
    (tmp_path / "bus").write_text("mine")
    with pytest.raises(Unwritable, match="cannot be linked"), served([tmp_path / "bus"]):
        pass
    assert (tmp_path / "bus").read_text() == "mine"
    (tmp_path / "mine").symlink_to(tmp_path / "a disk that is not there now")
    with pytest.raises(Unwritable, match="cannot be linked"), served([tmp_path / "mine"]):
        pass
    assert (tmp_path / "mine").is_symlink()
