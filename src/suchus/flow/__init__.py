"""Incompressible flow around bodies that move and bend, in the plane and in space.

A ``Setup`` names grid, sides, fluid and bodies; a ``Simulation`` advances it and keeps a ``Record``. Nothing here
knows a robot or draws a picture.

Start reading with ``flow.setup``, then ``flow.simulation``.
"""

from suchus.core.isosurface import IsoSurface, isosurface
from suchus.flow.added import added_mass
from suchus.flow.batch import batch
from suchus.flow.bent import Bent, bend_shape
from suchus.flow.body import Body
from suchus.flow.contact import BodyContact
from suchus.flow.eel import eel, eel_in_space
from suchus.flow.force import Load, Surface
from suchus.flow.free import FreeBody
from suchus.flow.grid import Grid
from suchus.flow.integrator import EULER, HEUN, SHU_OSHER, Integrator, Stage
from suchus.flow.limbed import Capsule, Limbed
from suchus.flow.linked import Linked, LinkPiece, LinkStates, Spherocylinder
from suchus.flow.log import FlowLoads
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass
from suchus.flow.mesh import TriangleMesh, from_mesh
from suchus.flow.midline import Midline, MidlineState, foil
from suchus.flow.outline import Implicit, Polygon, difference, from_outline, from_sdf, scaled, union
from suchus.flow.output import FieldSeries, save_vti, snapshot
from suchus.flow.pose import Glide, Motion, Oscillation, Pose
from suchus.flow.rake import Rake, Sample, line
from suchus.flow.record import Coefficients, Record
from suchus.flow.resolution import ALONG_THE_SKIN
from suchus.flow.scheme import CENTRAL, QUICK, UPWIND, Scheme
from suchus.flow.setup import Setup
from suchus.flow.shape import Field, Shape
from suchus.flow.sides import Inflow, Mirror, Outflow, Periodic, Side, Sides, Slip, Stream, Wall
from suchus.flow.signals import frequency, morison, noise, strouhal
from suchus.flow.simulation import Simulation
from suchus.flow.solid import Cylinder, Ellipse, Ellipsoid, PlaneSolid, Plate, Solid, Sphere, SurfacePoints
from suchus.flow.trunk import Trunk
from suchus.flow.twist import Twists
from suchus.flow.vortices import lambda2, second_invariant, velocity_gradient

__all__ = [
    "ALONG_THE_SKIN",
    "CENTRAL",
    "EULER",
    "HEUN",
    "QUICK",
    "SHU_OSHER",
    "UPWIND",
    "Bent",
    "Body",
    "BodyContact",
    "Capsule",
    "Coefficients",
    "Cylinder",
    "Ellipse",
    "Ellipsoid",
    "Field",
    "FieldSeries",
    "FlowLoads",
    "FreeBody",
    "Glide",
    "Grid",
    "Implicit",
    "Inflow",
    "Integrator",
    "IsoSurface",
    "Limbed",
    "LinkPiece",
    "LinkStates",
    "Linked",
    "Load",
    "Markers",
    "Mass",
    "Midline",
    "MidlineState",
    "Mirror",
    "Motion",
    "Oscillation",
    "Outflow",
    "Periodic",
    "PlaneSolid",
    "Plate",
    "Polygon",
    "Pose",
    "Rake",
    "Record",
    "Sample",
    "Scheme",
    "Setup",
    "Shape",
    "Side",
    "Sides",
    "Simulation",
    "Slip",
    "Solid",
    "Sphere",
    "Spherocylinder",
    "Stage",
    "Stream",
    "Surface",
    "SurfacePoints",
    "TriangleMesh",
    "Trunk",
    "Twists",
    "Wall",
    "added_mass",
    "batch",
    "bend_shape",
    "difference",
    "eel",
    "eel_in_space",
    "foil",
    "frequency",
    "from_mesh",
    "from_outline",
    "from_sdf",
    "isosurface",
    "lambda2",
    "line",
    "morison",
    "noise",
    "save_vti",
    "scaled",
    "second_invariant",
    "snapshot",
    "strouhal",
    "union",
    "velocity_gradient",
]
