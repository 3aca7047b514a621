"""A robot for other tools: MJCF and URDF."""

from suchus.model.export.folder import MARK, Format, export
from suchus.model.export.mjcf import home, mjcf
from suchus.model.export.urdf import ball, unsaid, urdf

__all__ = ["MARK", "Format", "ball", "export", "home", "mjcf", "unsaid", "urdf"]
