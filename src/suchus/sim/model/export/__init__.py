"""A robot for other tools: MJCF, URDF and USD."""

from suchus.sim.model.export.folder import MARK, Format, export
from suchus.sim.model.export.mjcf import home, mjcf
from suchus.sim.model.export.urdf import ball, unsaid, urdf
from suchus.sim.model.export.usd import NoUsd, unsaid_in_usd, usd

__all__ = ["MARK", "Format", "NoUsd", "ball", "export", "home", "mjcf", "unsaid", "unsaid_in_usd", "urdf", "usd"]
