"""From what the robot senses to the commands of its servos, for a whole batch at once."""

from suchus.catalog import Catalog
from suchus.control.amphibious import Amphibious
from suchus.control.attitude import AttitudeRule
from suchus.control.controller import SENSED, Command, Control, Controller, Runs, needs
from suchus.control.coordinated import Coordinated, Kick
from suchus.control.heading import HeadingRule
from suchus.control.holding import DepthHold, HeadingHold
from suchus.control.limbs import LAWS, LimbLaw
from suchus.control.open_loop import OpenLoop
from suchus.control.oscillators import Oscillators
from suchus.control.pattern_generator import Generator, OscillatorStates, PatternGenerator, oscillate
from suchus.control.pattern_load import LoadRule
from suchus.control.sensed import Sensed
from suchus.control.shared import OWNERS, Shared
from suchus.control.spine import SpineRule
from suchus.control.standing import BALANCE, Balance, Standing
from suchus.control.swimming import Swimming
from suchus.control.switching import SwitchRule
from suchus.control.tail import TailRule
from suchus.control.trim import PitchHold
from suchus.control.turning import CURVES, TurningCurve, turn
from suchus.control.walking import Change, Walking

CONTROLLERS: Catalog[type[Control]] = Catalog(
    "controller", "suchus.control", "suchus.control.controller:Control", scattered=True
)
"""The controls by name, ``pattern_generator`` for ``PatternGenerator``: classes of values for ``Run.control``."""

__all__ = [
    "BALANCE",
    "CONTROLLERS",
    "CURVES",
    "LAWS",
    "OWNERS",
    "SENSED",
    "Amphibious",
    "AttitudeRule",
    "Balance",
    "Change",
    "Command",
    "Control",
    "Controller",
    "Coordinated",
    "DepthHold",
    "Generator",
    "HeadingHold",
    "HeadingRule",
    "Kick",
    "LimbLaw",
    "LoadRule",
    "OpenLoop",
    "OscillatorStates",
    "Oscillators",
    "PatternGenerator",
    "PitchHold",
    "Runs",
    "Sensed",
    "Shared",
    "SpineRule",
    "Standing",
    "Swimming",
    "SwitchRule",
    "TailRule",
    "TurningCurve",
    "Walking",
    "needs",
    "oscillate",
    "turn",
]
