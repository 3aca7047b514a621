"""Where the air of a hull must be for a robot that hovers under water to be level."""

import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.water_table import column
from suchus.robot.design import WATER_DENSITY, Chamber, Robot, layout
from suchus.robot.design.pieces import pieces, volumes
from suchus.robot.kinematics.tree import centre_of_mass, frames


def level_chambers(
    robot: Robot, angles: Float[np.ndarray, " joint"], *, front: str, rear: str
) -> tuple[Chamber, Chamber]:
    """Return two chambers with which a robot at neutral buoyancy has no trim moment in a level posture.

    Let V be the volume of the robot and x_B the centre of that volume, both with all air, x_G the centre of mass, and s
    = V - m / rho the air that it lets out to hover. The displaced water then has the moment V x_B - s x_A about the
    root, with x_A the centre of the released air. For zero trim moment it must equal (V - s) x_G, so that x_A = x_G + V
    (x_B - x_G) / s. The lever rule gives the fractions of two chambers whose common centre is x_A.

    Args:
        robot: a design with air in its hull.
        angles: angles of every hinge, in the order of ``joint_names(robot)`` [rad].
        front: body of the axis ahead of the root that has the front chamber.
        rear: body of the axis, the root or one behind it, that has the rear chamber.

    Raises:
        InvalidDesign: the robot cannot hover by letting air out, or no two shares make it level.
        UnknownName: there is no such body.
    """
    place, table = layout(robot), pieces(robot)
    names, volume = [body.name for body in place.bodies], column(table, "volume")[:, 0]
    for body in (front, rear):
        if body not in names:
            raise UnknownName("body", body, names)
    ids, body_frames = table[:, 0].astype(int), frames(robot, angles)
    x = body_frames.positions[ids, 0] + np.einsum("nj,nj->n", body_frames.turns[ids, 0], column(table, "at"))
    front_center, rear_center = (np.average(x, weights=volume * (ids == names.index(body))) for body in (front, rear))
    mass, buoyancy = centre_of_mass(robot, angles)[0], np.average(x, weights=volume)
    target_center = mass + volume.sum() * (buoyancy - mass) / spare_volume(robot)
    if not rear_center < target_center < front_center:
        raise InvalidDesign(
            f"the air that robot {robot.name!r} lets out to hover must have its centre {target_center:.3f} m ahead of "
            f"the root for it to be level; {front} is at {front_center:.3f} m and {rear} at {rear_center:.3f} m: "
            "choose chambers before and behind that point."
        )
    fraction = float((target_center - rear_center) / (front_center - rear_center))
    return Chamber(body=front, share=fraction), Chamber(body=rear, share=1.0 - fraction)


def spare_volume(robot: Robot) -> float:
    """Return how much air a robot under fresh water lets out to hover, neither sinking nor rising [m3].

    Raises:
        InvalidDesign: its hull has no air, or not enough of it.
    """
    hull = robot.hull
    air = 0.0 if hull is None else hull.air
    spare_air = sum(volumes(robot).values()) - robot.mass / WATER_DENSITY
    if not 0.0 < spare_air <= air:
        raise InvalidDesign(
            f"robot {robot.name!r} would have to let out {1e3 * spare_air:.3g} l of air to hover, and has "
            f"{1e3 * air:.3g} l: give it a design.Hull with as much air, and foam enough to float with it."
        )
    return spare_air
