"""Replies that come too late on a real wire: taken for what they are, and never for the answer to something else."""

from time import sleep

import pytest

from suchus.hardware.bus import Bus, Packet
from suchus.hardware.protocols import PROTOCOLS

FRAMING = PROTOCOLS["dynamixel"]
SERVOS, ADDRESS, LENGTH = (1, 2, 3), 126, 4
WAIT = 0.01


class Scripted:
    """A port that hands over, after each request, what the script says, one portion a reading."""

    name = "scripted"

    def __init__(self, *portions):
        self.portions, self.ready = list(portions), []

    def send(self, data, timeout):
        self.ready += self.portions.pop(0)

    def receive(self, timeout):
        if self.ready:
            return self.ready.pop(0)
        sleep(timeout)
        return b""


def says(servo, value, length=LENGTH):
    return FRAMING.reply(Packet(servo, 0, value.to_bytes(length, "little")))


def asked(bus):
    bus.begin(SERVOS, ADDRESS, LENGTH)
    found = bus.end(SERVOS, LENGTH)
    return {servo: int.from_bytes(packet.data, "little") for servo, packet in found.items()}


def test_a_late_reply_stands_for_one_that_is_missing_and_is_said_to_be_late():
    port = Scripted([says(1, 10)], [says(1, 11), says(2, 21)])
    bus = Bus(port, FRAMING, wait=WAIT)
    assert asked(bus) == {1: 10}
    port.ready.append(says(2, 20) + says(3, 30))  # too late for the question before
    assert asked(bus) == {1: 11, 2: 21, 3: 30}
    assert bus.late == {3}
    assert bus.counts.missing == 3
    assert bus.counts.stale == 0


def test_a_new_reply_is_preferred_and_who_is_behind_does_not_stay_behind():
    port = Scripted([], [says(1, 11), says(2, 21), says(3, 31)])
    bus = Bus(port, FRAMING, wait=WAIT)
    assert asked(bus) == {}
    port.ready.append(says(1, 10) + says(2, 20) + says(3, 30))
    assert asked(bus) == {1: 11, 2: 21, 3: 31}
    assert bus.late == frozenset()


def test_a_late_reply_that_comes_while_somebody_else_is_asked_is_not_lost():
    port = Scripted([says(1, 10)], [says(2, 20), says(200, 5)], [says(1, 11)])
    bus = Bus(port, FRAMING, wait=WAIT)
    assert asked(bus) == {1: 10}
    bus.begin((200,), 128, LENGTH)
    assert set(bus.end((200,), LENGTH)) == {200}
    assert asked(bus) == {1: 11, 2: 20}
    assert bus.late == {2}


@pytest.mark.parametrize("other", [says(2, 20, 2), says(9, 20)])
def test_a_reply_of_another_length_or_of_one_that_was_not_asked_is_stale(other):
    port = Scripted([], [says(1, 11)])
    bus = Bus(port, FRAMING, wait=WAIT)
    assert asked(bus) == {}
    port.ready.append(other)
    assert asked(bus) == {1: 11}
    assert bus.counts.stale == 1
