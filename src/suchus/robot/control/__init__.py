"""From what the robot senses to the commands of its servos, for a whole batch at once."""

from suchus.core.catalog import Catalog
from suchus.robot.control.amphibious import Amphibious
from suchus.robot.control.attitude import AttitudeRule
from suchus.robot.control.controller import SENSED, Command, Control, Controller, Runs, needs
from suchus.robot.control.coordinated import Coordinated, Kick
from suchus.robot.control.heading import HeadingRule
from suchus.robot.control.holding import DepthHold, HeadingHold
from suchus.robot.control.learned import Learned
from suchus.robot.control.limbs import LAWS, LimbLaw
from suchus.robot.control.open_loop import OpenLoop
from suchus.robot.control.oscillators import Oscillators
from suchus.robot.control.pattern_generator import Generator, OscillatorStates, PatternGenerator, oscillate
from suchus.robot.control.pattern_load import LoadRule
from suchus.robot.control.policy import ACTIONS, Policy, load_policy, save_policy
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.shared import OWNERS, Shared
from suchus.robot.control.spine import SpineRule
from suchus.robot.control.standing import BALANCE, Balance, Standing
from suchus.robot.control.swimming import Swimming
from suchus.robot.control.switching import SwitchRule
from suchus.robot.control.tail import TailRule
from suchus.robot.control.trim import PitchHold
from suchus.robot.control.turning import CURVES, TurningCurve, turn
from suchus.robot.control.walking import Change, Walking

CONTROLLERS: Catalog[type[Control]] = Catalog(
    "controller", "suchus.robot.control", "suchus.robot.control.controller:Control", scattered=True
)
"""The controls by name, ``pattern_generator`` for ``PatternGenerator``: classes of values for ``Run.control``."""

__all__ = [
    "ACTIONS",
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
    "Learned",
    "LimbLaw",
    "LoadRule",
    "OpenLoop",
    "OscillatorStates",
    "Oscillators",
    "PatternGenerator",
    "PitchHold",
    "Policy",
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
    "load_policy",
    "needs",
    "oscillate",
    "save_policy",
    "turn",
]
