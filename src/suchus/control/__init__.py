"""From what the robot senses to what its servos are told, for a whole batch at once."""

from suchus.control.controller import Command, Control, Controller
from suchus.control.open_loop import OpenLoop
from suchus.control.sensed import Sensed

__all__ = ["Command", "Control", "Controller", "OpenLoop", "Sensed"]
