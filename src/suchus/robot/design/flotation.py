"""How much foam a robot needs to float, body by body, so that it floats level however it bends."""

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.core.physics import WATER_DENSITY
from suchus.robot.design.body import Robot
from suchus.robot.design.hull import Foam, Hull
from suchus.robot.design.pieces import masses, volumes

MAX_VOLUME_RATIO = 9.0
"""Greatest volume of a body with its foam over that without [-]; three times as thick."""


def float_hull(
    robot: Robot, *, freeboard_fraction: float = 0.05, foam_offset: float = 0.0, air: float = 0.0, density: float = 40.0
) -> Hull:
    """Return a hull that lets every body that is too heavy for its water displace its own weight and no more.

    A bent body floats level only if each part floats by itself. Light bodies displace more than their weight; the foam
    of all others is then reduced, so that the whole robot floats with the demanded fraction above the surface.

    Args:
        robot: a robot without a hull.
        freeboard_fraction: share of the volume that stays above the surface [-].
        foam_offset: how far the foam of every body lies above its middle [m].
        air: so much of the foam on the axis is a bladder [m3].
        density: density of the foam [kg/m3].

    Raises:
        InvalidDesign: the share is not 0 to 0.9, the robot has a hull, or a body would swell beyond
            ``MAX_VOLUME_RATIO``.
    """
    require("float_hull", "above", freeboard_fraction, 0.0, 0.9, "")
    require("float_hull", "density", density, 0.0, 0.9 * (1 - freeboard_fraction) * WATER_DENSITY, "kg/m3")
    if robot.hull is not None:
        raise InvalidDesign(f"robot {robot.name!r} has a hull; take it off first, with replace(robot, hull=None).")
    supported_density = (1.0 - freeboard_fraction) * WATER_DENSITY
    body_volumes, body_masses = volumes(robot), masses(robot)
    lacking = {
        name: max(body_masses[name] / supported_density - body_volumes[name], 0.0) / (1 - density / supported_density)
        for name in body_volumes
    }
    foam_volume = (sum(body_masses.values()) / supported_density - sum(body_volumes.values())) / (
        1 - density / supported_density
    )
    if foam_volume < 0:
        raise InvalidDesign(
            f"robot {robot.name!r} displaces {1e3 * sum(body_volumes.values()):.3g} l and floats with more than "
            f"{freeboard_fraction:g} of it "
            "above the surface without any foam: ask for a greater share above."
        )
    fraction = foam_volume / sum(lacking.values()) if foam_volume > 0 else 0.0
    for name, volume in lacking.items():
        if body_volumes[name] + fraction * volume > MAX_VOLUME_RATIO * body_volumes[name]:
            raise InvalidDesign(
                f"{name} of robot {robot.name!r} would need {1e3 * fraction * volume:.3g} l of foam around "
                f"{1e3 * body_volumes[name]:.3g} l, which makes it more than three times as thick: make it "
                "lighter or larger."
            )
    foam = tuple(
        Foam(body=name, volume=fraction * v, raised=foam_offset) for name, v in lacking.items() if fraction * v > 0
    )
    return Hull(foam=foam, density=density, air=air)
