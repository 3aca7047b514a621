"""Dynamixel protocol 1.0 of ROBOTIS's AX and MX series, which is named by motors and spoken by nobody here."""

from suchus.hardware.bus.protocol import ServoProtocol


class Dynamixel1(ServoProtocol):
    """The former protocol of ROBOTIS: its AX servos cannot be read together, as a drive reads them."""

    name = "dynamixel1"
    families = ("Dynamixel AX", "Dynamixel MX")


protocol = Dynamixel1()
