"""Pulses, whose width tells a hobby servo its angle: a board gives them, and speaks a protocol of its own."""

from suchus.hardware.bus.protocol import ServoProtocol


class PulseWidth(ServoProtocol):
    """What hobby servos hear; they answer nothing."""

    name = "pwm"
    families = ("hobby servos",)


protocol = PulseWidth()
