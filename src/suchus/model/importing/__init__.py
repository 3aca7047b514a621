"""A robot from a file of another tool, URDF or MJCF: a draft that a person confirms."""

from suchus.model.importing.draft import Draft
from suchus.model.importing.making import Match
from suchus.model.importing.plan import Words
from suchus.model.importing.read import import_robot

__all__ = ["Draft", "Match", "Words", "import_robot"]
