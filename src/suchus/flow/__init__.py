"""Two-dimensional incompressible flow around bodies that move and bend."""

from suchus.flow.added import added_mass
from suchus.flow.body import Body
from suchus.flow.eel import eel
from suchus.flow.force import Load, Surface
from suchus.flow.free import FreeBody
from suchus.flow.grid import Grid
from suchus.flow.mass import Mass
from suchus.flow.midline import Midline, Spine, foil
from suchus.flow.pose import Glide, Motion, Oscillation, Pose
from suchus.flow.record import Record
from suchus.flow.setup import Setup
from suchus.flow.shape import Cylinder, Ellipse, Field, Markers, Plate, Shape
from suchus.flow.sides import Inflow, Outflow, Periodic, Side, Sides, Slip, Stream, Wall
from suchus.flow.signals import frequency, morison, noise, strouhal
from suchus.flow.simulation import Simulation

__all__ = [
    "Body",
    "Cylinder",
    "Ellipse",
    "Field",
    "FreeBody",
    "Glide",
    "Grid",
    "Inflow",
    "Load",
    "Markers",
    "Mass",
    "Midline",
    "Motion",
    "Oscillation",
    "Outflow",
    "Periodic",
    "Plate",
    "Pose",
    "Record",
    "Setup",
    "Shape",
    "Side",
    "Sides",
    "Simulation",
    "Slip",
    "Spine",
    "Stream",
    "Surface",
    "Wall",
    "added_mass",
    "eel",
    "foil",
    "frequency",
    "morison",
    "noise",
    "strouhal",
]
