"""Body plans that robots of the catalog share: axes of hinges in a row, and their limbs."""

from collections.abc import Sequence

from suchus.robot.design import Foot, Girdle, Hinge, Limb, Link, Rod, Segment, Servo, Spring
from suchus.robot.design.hinge import Turn
from suchus.robot.design.reasons import Reason

BY_SIZE = (
    Reason(
        r"\.(drive|servo)\.",
        0.5,
        2.0,
        "from mass and length by the rules of design.scale: the article's servo in this size; half and twice do too",
    ),
    Reason(
        r"^contact\.(time_constant|torsion|rolling|depth)$",
        0.5,
        2.0,
        "from the length by the rules of design.scale: the article's rubber sole in this size",
    ),
    Reason(r"^contact\.", 0.6, 1.4, "a rubber foot and a smooth skin on a floor"),
    Reason(r"\.range\[", 0.7, 1.5, "clear of every angle that the gait asks for"),
)
"""Reasons for what follows from a body's size, and for ranges."""

Joint = tuple[str, Turn, Servo | Spring, float]
"""Name, turn, drive and range to either side [rad] of a hinge of the axis."""


def hinge(name: str, turn: Turn, drive: Servo | Spring, limit: float) -> Hinge:
    """Return a hinge with equal ranges to either side [rad]."""
    return Hinge(name=name, turn=turn, drive=drive, range=(-limit, limit))


def row(
    names: Sequence[str],
    lengths: Sequence[float],
    radii: Sequence[float],
    masses: Sequence[float],
    joints: Sequence[Sequence[Joint]],
) -> tuple[Segment, ...]:
    """Return an axis of rods from the snout to the tip of the tail; each segment's origin is its front end.

    Args:
        names: names of the segments.
        lengths: lengths of the segments [m].
        radii: radii of their rods [m].
        masses: masses of the segments [kg].
        joints: behind every segment but the last, those of each joint in order.
    """
    segments = []
    for i, (name, length, radius, mass) in enumerate(zip(names, lengths, radii, masses, strict=True)):
        # the rods' round ends reach into the joints; the first and the last one stay inside the body's length
        start = -radius if i == 0 else 0.0
        end = -length + (radius if i == len(names) - 1 else 0.0)
        rod = Rod(name=name, start=(start, 0.0, 0.0), end=(end, 0.0, 0.0), radius=radius, mass=mass)
        hinges = tuple(hinge(*joint) for joint in joints[i]) if i < len(joints) else ()
        segments.append(Segment(name=name, front=0.0, rear=length, shapes=(rod,), hinges=hinges))
    return tuple(segments)


def limb(
    upper_length: float,
    lower_length: float,
    *,
    radius: float,
    masses: tuple[float, float, float],
    foot: float,
    servo: Servo,
    roll: bool,
    limit: float,
) -> Limb:
    """Return a limb of yaw, pitch, perhaps roll, and an elbow.

    Args:
        upper_length: length of the upper limb [m].
        lower_length: length of the lower limb to the foot's centre [m].
        radius: radius of the upper limb [m].
        masses: masses of upper limb, lower limb and foot [kg].
        foot: radius of the foot [m].
        servo: servo at every hinge.
        roll: whether the upper limb turns about itself.
        limit: limit of every hinge to either side [rad]; pitch and elbow bend further down.
    """
    hip = [hinge("yaw", "yaw", servo, limit), hinge("pitch", "pitch", servo, limit)]
    if roll:
        hip.append(hinge("roll", "roll", servo, limit))
    bend = Hinge(name="elbow", turn="pitch", drive=servo, range=(-0.2, 2.6))
    return Limb(
        links=(
            Link(name="upper", hinges=tuple(hip), end=(0.0, upper_length, 0.0), radius=radius, mass=masses[0]),
            Link(name="lower", hinges=(bend,), end=(0.0, lower_length, 0.0), radius=0.8 * radius, mass=masses[1]),
        ),
        foot=Foot(radius=foot, mass=masses[2]),
    )


def girdle(name: str, segment: str, position: float, lateral_offset: float, height: float, limb: Limb) -> Girdle:
    """Return a girdle; see ``suchus.robot.design.Girdle``."""
    return Girdle(name=name, segment=segment, at=position, aside=lateral_offset, above=height, limb=limb)
