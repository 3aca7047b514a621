"""The article's robot with foam around every body that is too heavy for its water: it floats and rights itself."""

from dataclasses import replace

from suchus.robot.design import crocodile
from suchus.robot.design.flotation import float_hull
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.kinematics.trim import level_chambers
from suchus.robot.motion import limbs_back
from suchus.robot.robots import caiman

_FREEBOARD, _FOAM_OFFSET, _AIR = 0.05, 0.016, 0.0004

_hull = float_hull(caiman.robot, freeboard_fraction=_FREEBOARD, foam_offset=_FOAM_OFFSET, air=_AIR)
_buoyant_robot = crocodile(replace(caiman.tables, name="floating_caiman", hull=_hull))
_chambers = level_chambers(_buoyant_robot, limbs_back(_buoyant_robot), front="thorax", rear="pelvis")
tables = replace(caiman.tables, name="floating_caiman", hull=replace(_hull, chambers=_chambers))
"""Its measures."""
robot = crocodile(tables)
"""A robot that swims at the surface with 5 % of its volume above it, its limbs held out, and level where it hovers."""

_REASONS = (
    Reason(r"^hull\.foam\[\d+\]\.volume$", 0.8, 1.2, "every body floats by itself, so that a bent robot floats level"),
    Reason(r"^hull\.foam\[\d+\]\.raised$", 0.5, 1.5, "more on the back than below: it rights itself from 150 degrees"),
    Reason(r"^hull\.density$", 0.6, 1.5, "extruded polystyrene and closed-cell polyethylene have 25 to 60 kg/m3"),
    Reason(r"^hull\.chambers\[\d+\]\.share$", 0.9, 1.1, "level at neutral buoyancy, its limbs back"),
    Reason(r"^hull\.air$", 0.5, 1.2, "a tenth of the volume let out brings the feet down on a steep shore"),
)
chosen = (*caiman.chosen, *assumptions_of(robot, _REASONS, (r"^(?!hull\.)",)))
"""Every number of the robot that the article does not give, with its plausible range and the reason."""
