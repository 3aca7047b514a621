"""A robot from a file of another tool, URDF or MJCF: a draft that a person confirms."""

from suchus.model.importing.draft import Draft
from suchus.model.importing.draft_hinges import Match
from suchus.model.importing.options import Words
from suchus.model.importing.read import import_robot

__all__ = ["Draft", "Match", "Words", "import_robot"]
