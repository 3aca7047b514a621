"""A robot from a file of another tool, URDF or MJCF: a draft that a person confirms."""

from suchus.sim.model.importing.draft import Draft
from suchus.sim.model.importing.making import Match
from suchus.sim.model.importing.plan import Words
from suchus.sim.model.importing.read import import_robot

__all__ = ["Draft", "Match", "Words", "import_robot"]
