"""The shelf of faults: one file, one kind of fault, declared as ``fault``."""

from suchus.faults._table import FAULTS, from_table, numbers
from suchus.faults.backlash import Backlash
from suchus.faults.deaf import Deaf
from suchus.faults.limp import Limp
from suchus.faults.locked import Locked
from suchus.faults.lost_foot import LostFoot
from suchus.faults.offset import Offset
from suchus.faults.slow import Slow
from suchus.faults.weak import Weak

__all__ = [
    "FAULTS",
    "Backlash",
    "Deaf",
    "Limp",
    "Locked",
    "LostFoot",
    "Offset",
    "Slow",
    "Weak",
    "from_table",
    "numbers",
]
