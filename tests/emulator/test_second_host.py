"""A bus bears one host: a second one is seen and said, and takes nothing from a running drive."""

import socket
import subprocess
import sys

import pytest
from tests.wires import Obedient, wiring

from suchus.core.errors import BusFailure
from suchus.hardware.bus import open_port, port_holders
from suchus.hardware.emulator import Emulator, Server

pytest.importorskip("serial", reason="the extra hardware is not installed")
HOLD = "import os, sys, time; os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY); print('open', flush=True); time.sleep(60)"
"""A program that opens a port as the makers' software does, without asking for it alone."""


@pytest.fixture
def programs():
    running = []

    def start(port):
        program = subprocess.Popen([sys.executable, "-c", HOLD, port], stdout=subprocess.PIPE)
        assert program.stdout.readline() == b"open\n"
        running.append(program)
        return program.pid

    yield start
    for program in running:
        program.kill()
        program.wait()
        program.stdout.close()


def test_two_programs_on_a_pseudo_terminal_are_said_once_with_their_numbers(programs):
    sentences = []
    server = Server(Emulator(wiring(), Obedient(), has_clock=True), say=sentences.append)
    first = programs(server.ports[0])
    server.look_for_hosts()
    assert sentences == []
    second = programs(server.ports[0])
    assert port_holders(server.ports[0]) == sorted([first, second])
    server.look_for_hosts()
    server.look_for_hosts()
    assert len(sentences) == 1
    assert f"processes {min(first, second)} and {max(first, second)}: a bus bears one host" in sentences[0]
    server.close()


def test_a_drive_refuses_a_port_that_another_program_has_open(programs):
    server = Server(Emulator(wiring(), Obedient(), has_clock=True))
    holder = programs(server.ports[0])
    with pytest.raises(BusFailure, match=f"is open in another program too, process {holder}"):
        open_port(server.ports[0], 1_000_000)
    server.close()


def test_a_second_host_on_a_socket_is_refused_and_the_first_goes_on():
    sentences = []
    emulator = Emulator(wiring(), Obedient(), has_clock=True)
    server = Server(emulator, sockets=True, say=sentences.append)
    protocol, address = emulator.lines[0].protocol, ("127.0.0.1", int(server.ports[0].rpartition(":")[2]))

    def answers(host, servo):
        host.sendall(protocol.ping(servo))
        server._listen(1.0)
        return protocol.replies().feed(host.recv(100))[0].id == servo

    with socket.create_connection(address, timeout=60.0) as first:
        server._listen(1.0)
        with socket.create_connection(address, timeout=60.0) as second:
            server._listen(1.0)
            assert second.recv(1) == b""
        assert "a second host" in sentences[0]
        assert answers(first, 3)
    server._listen(1.0)
    with socket.create_connection(address, timeout=60.0) as third:
        server._listen(1.0)
        assert answers(third, 4)
    server.close()
