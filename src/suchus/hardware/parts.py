"""The parts of a robot and their masses, frames, cables, plates, wiring and foam, as numbers for a sheet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import nan, pi

import numpy as np

from suchus.core.checks import require
from suchus.core.physics import WATER_DENSITY
from suchus.robot.design import Cable, Motor, Robot, Rod, Servo, layout
from suchus.robot.design.body import servos_of
from suchus.robot.design.measures import leg_of, spine_of, tail_of
from suchus.robot.design.pieces import foam_centres, volumes
from suchus.robot.kinematics.tail import bend_limit, cable_changes, servo_angle
from suchus.robot.kinematics.tree import body_masses, centre_of_mass, frames
from suchus.robot.motors import motors as shipped

PLASTIC = 1240.0
"""Density of printed plastic (PLA) [kg/m3]."""
WALL = 0.0012
"""Thickness of a printed wall: three lines of a nozzle of 0.4 mm [m]."""
SPARE = 1.25
"""Length of a wire over the straight way between two servos [-]; chosen so that a joint can turn."""
_STEPS = 9  # bends in the table of a cable


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyPart:
    """A part of a body: a rod, a shell, a foot, foam, or a servo that sits on it."""

    body: str
    """The body that it belongs to."""
    name: str
    """Its own name."""
    kind: str
    """``rod``, ``shell``, ``foot``, ``foam`` or ``servo``."""
    size: tuple[float, float, float]
    """Length, width and height [m]."""
    mass: float
    """Mass in the simulation [kg]; of a servo, that of the one that is bought; NaN where that is not known."""
    centre: tuple[float, float, float]
    """Centre of mass in the frame of its body [m]."""
    description: str = ""
    """What it is, in words."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MassBudget:
    """Mass of a moving body in the simulation, of its servos and of its printed walls."""

    name: str
    """Name of the body."""
    simulated: float
    """Mass in the simulation, foam included [kg]."""
    servos: float
    """Mass of the servos that sit on it [kg]; NaN where they are not known."""
    printed: float
    """Mass of a printed wall around its shapes [kg]."""

    @property
    def rest(self) -> float:
        """Remaining mass for battery, electronics, screws and brackets [kg]; below zero the body is too heavy."""
        return self.simulated - self.servos - self.printed


@dataclass(frozen=True, slots=True, kw_only=True)
class HingePlace:
    """Position of a hinge with all joints at zero: forward, left and up from the root's origin."""

    name: str
    """Name of the hinge."""
    body: str
    """The body that it turns."""
    parent: str
    """The body on which it sits."""
    at: tuple[float, float, float]
    """Its place [m]."""
    axis: tuple[float, float, float]
    """Direction of its axis [-]."""
    range: tuple[float, float] | None
    """Its limits [rad]; None for a crank."""
    driven_by: str
    """The servo that turns it, ``spring`` for a passive one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DHRow:
    """One row of a table of Denavit and Hartenberg, as the article's Tables I and II print them (Figs 6 and 8)."""

    chain: str
    """``hind leg``, ``front leg`` or ``spine``."""
    number: int
    """Number of the joint, from 1 [-]."""
    a: float
    """a_(n-1), along x of the frame before [m]."""
    alpha: float
    """alpha_(n-1), about x of the frame before [rad]."""
    d: float
    """d_n, along z [m]."""
    turned_by: str
    """What turns it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TailPlate:
    """One plate of a tail that cords pull, with its holes."""

    name: str
    """Name of the hinge in front of it."""
    radius: float
    """Radius of the plate [m]."""
    thickness: float
    """H of the article [m]."""
    holes: tuple[tuple[float, float], ...]
    """Middles of the two holes for the cords, sideways and up from the plate's middle [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cord:
    """Lengths of the two cords of a cable, and their changes with the bend of the tail."""

    name: str
    """Name of the cable."""
    section: float
    """Length of a cord from the first plate to the last with the tail straight [m]."""
    travel: float
    """Length by which a cord is drawn in at the greatest bend [m]."""
    table: tuple[tuple[float, float, float, float], ...]
    """Bend [rad], angle of the pulley [rad] or place of the linear actuator [m], change of the cord on the side of the
    bend and of the other one [m]."""
    linear: bool = False
    """Whether a linear actuator moves it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoWire:
    """One servo on its bus, after the one before it."""

    servo: str
    """Name of the servo."""
    number: int
    """Number (id) on the bus [-]."""
    bus: str
    """Name of the bus: the family of the servo."""
    after: str
    """The servo before it in the chain, or ``controller``."""
    length: float
    """Length of the wire from there [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Buoyancy:
    """Volumes that carry a robot in water."""

    mass: float
    """Mass of the robot [kg]."""
    bare: float
    """Volume of its bodies without foam [m3]."""
    foam: tuple[tuple[str, float, float], ...]
    """Body, volume of its foam [m3], and by how much it is raised [m]."""
    air: float
    """Air that can be let out [m3]."""
    chambers: tuple[tuple[str, float], ...]
    """Body and share of the air [-]."""

    @property
    def lacking(self) -> float:
        """Volume that it lacks to float [m3]; below zero it floats with so much above the surface."""
        return self.mass / WATER_DENSITY - self.bare - sum(volume for _, volume, _ in self.foam)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """All that a robot is built of."""

    robot: Robot
    """The robot."""
    bought: Mapping[str, Motor]
    """The servos that are bought, by place; empty for those of which only numbers are known."""
    parts: tuple[BodyPart, ...]
    """Its parts, body by body."""
    bodies: tuple[MassBudget, ...]
    """Its bodies."""
    centre: tuple[float, float, float]
    """Centre of mass in the simulation, all joints at zero, from the root's origin [m]."""
    built: tuple[float, float, float]
    """The same with servos where they sit and printed walls, without what is left for battery and electronics [m]."""
    joints: tuple[HingePlace, ...]
    """Its hinges."""
    links: tuple[DHRow, ...]
    """Tables of Denavit and Hartenberg of the chains that have one."""
    plates: tuple[TailPlate, ...]
    """Plates of its tail."""
    cords: tuple[Cord, ...]
    """Cords of its cables."""
    wires: tuple[ServoWire, ...]
    """Its buses."""
    floating: Buoyancy
    """What keeps it up."""


def sheet(
    robot: Robot,
    *,
    motors: Mapping[str, Motor] | None = None,
    wall: float = WALL,
    density: float = PLASTIC,
) -> Sheet:
    """Return what a robot is built of.

    Args:
        robot: robot whose servos' windings name the servos that are bought.
        motors: the servos that are sold; those that suchus knows if None.
        wall: thickness of printed walls [m].
        density: density of what is printed [kg/m3].
    """
    require("parts", "wall", wall, 1e-5, 0.1, "m")
    require("parts", "density", density, 1.0, 2e4, "kg/m3")
    sold = shipped() if motors is None else motors
    linear_cables = {cable.name for cable in robot.cables if cable.linear is not None}
    motor_by_servo = {
        name: sold[servo.winding.motor]
        for name, servo in servos_of(robot).items()
        if name not in linear_cables and servo.winding is not None and servo.winding.motor in sold
    }
    seats = servo_seats(robot)
    parts = (*_shapes(robot), *_foam(robot), *_servos(robot, motor_by_servo, seats))
    bodies = _bodies(robot, motor_by_servo, seats, parts, wall * density)
    zero_angles = np.zeros(len(layout(robot).hinges))
    return Sheet(
        robot=robot,
        bought=motor_by_servo,
        parts=parts,
        bodies=bodies,
        centre=_rounded_point(centre_of_mass(robot, zero_angles)),
        built=_built_centre(robot, parts, wall * density),
        joints=_joints(robot),
        links=_links(robot),
        plates=_plates(robot),
        cords=tuple(_cord(robot, cable) for cable in robot.cables),
        wires=_wires(robot, motor_by_servo, seats),
        floating=_floating(robot),
    )


def area(kind: str, size: Sequence[float]) -> float:
    """Return the surface of a part [m2]: of a rod with round ends, a ball, or an ellipsoid (Thomsen, within 1.1 %).

    Args:
        kind: ``rod``, ``foot`` or ``shell``.
        size: length, width and height, ends included [m].
    """
    length, width, height = size
    if kind == "rod":
        return pi * width * length  # a cylinder and two half balls
    a, b, c = ((side / 2) ** 1.6075 for side in (length, width, height))
    return float(4 * pi * ((a * b + a * c + b * c) / 3) ** (1 / 1.6075))


def _rounded_point(values: np.ndarray | Sequence[float]) -> tuple[float, float, float]:
    """Return the coordinates x, y and z as rounded numbers, without a negative zero [m]."""
    x, y, z = (round(float(value), 12) + 0.0 for value in values)
    return x, y, z


def _shapes(robot: Robot) -> list[BodyPart]:
    """Return the rods, shells and feet of a robot's bodies."""
    place = layout(robot)
    segments = {segment.name: segment for segment in place.robot.axis}
    shape_parts = []
    for body in place.bodies:
        for shape in segments[body.name].shapes if body.name in segments else ():
            centre = _rounded_point((shape.centre[0] + body.shift, *shape.centre[1:]))
            if isinstance(shape, Rod):
                length = float(np.linalg.norm(np.subtract(shape.end, shape.start)))
                size = (length + 2 * shape.radius, 2 * shape.radius, 2 * shape.radius)
                description = f"rod of {1000 * length:.1f} mm between the middles of its round ends"
                shape_parts.append(BodyPart(body=body.name, name=shape.name, kind="rod", size=size, mass=shape.mass,
                                  centre=centre, description=description))  # fmt: skip
            else:
                a, b, c = shape.half
                shape_parts.append(BodyPart(body=body.name, name=shape.name, kind="shell", size=(2 * a, 2 * b, 2 * c),
                                  mass=shape.mass, centre=centre, description="shell, an ellipsoid"))  # fmt: skip
    for limb in place.limbs:
        links = limb.girdle.limb.links
        for i, link in enumerate(links):
            carrier = place.bodies[limb.tip - len(links) + 1 + i].name
            end = (link.end[0], limb.side * link.end[1], link.end[2])
            size = (link.length + 2 * link.radius, 2 * link.radius, 2 * link.radius)
            description = (
                f"rod of {1000 * link.length:.1f} mm from joint to {'foot' if i == len(links) - 1 else 'joint'}"
            )
            shape_parts.append(BodyPart(body=carrier, name=f"{limb.name}_{link.name}", kind="rod", size=size,
                              mass=link.mass,
                              centre=_rounded_point(np.array(end) / 2), description=description))  # fmt: skip
            if i == len(links) - 1:
                foot = limb.girdle.limb.foot
                ball = 2 * foot.radius
                shape_parts.append(BodyPart(body=carrier, name=f"{limb.name}_foot", kind="foot",
                              size=(ball, ball, ball),
                                  mass=foot.mass, centre=_rounded_point(end), description="rubber ball"))  # fmt: skip
    return shape_parts


def _foam(robot: Robot) -> list[BodyPart]:
    """Return one part for each block of foam of the hull: a cube of its volume, in the frame of its body."""
    hull = robot.hull
    if hull is None:
        return []
    centres = foam_centres(robot)
    foam_parts = []
    for foam_block in (foam for foam in hull.foam if foam.volume > 0.0):
        side = foam_block.volume ** (1 / 3)
        description = f"{1e6 * foam_block.volume:.0f} cm³ around the body, raised by {1000 * foam_block.raised:.0f} mm"
        foam_parts.append(BodyPart(body=foam_block.body, name=f"{foam_block.body}_foam", kind="foam",
                          size=(side, side, side),
                          mass=hull.density * foam_block.volume,
                          centre=_rounded_point(centres[foam_block.body]), description=description))  # fmt: skip
    return foam_parts


def servo_seats(robot: Robot) -> dict[str, tuple[str, tuple[float, float, float]]]:
    """Return the body on which each servo sits and its position: the body before its hinge, from the root."""
    place = layout(robot)
    seats = {}
    for body in place.bodies:
        parent = place.bodies[body.parent] if body.parent >= 0 else body
        for _, name, _ in body.hinges:
            seats[name] = (parent.name, _rounded_point(body.offset))
    for cable in place.robot.cables:
        seats[cable.name] = seats[cable.hinges[0]]
        root = next((b for b in place.bodies if b.name == seats[cable.name][0] and b.parent >= 0), None)
        if root is not None:  # the pulley sits ahead of the section that it bends
            seats[cable.name] = (place.bodies[root.parent].name, _rounded_point(root.offset))
    return {name: seats[name] for name in place.servos}


def _servos(
    robot: Robot, motor_by_servo: Mapping[str, Motor], seats: Mapping[str, tuple[str, tuple[float, float, float]]]
) -> list[BodyPart]:
    """Return the servos as parts, with size and mass where a servo that is sold is known."""
    servo_parts = []
    linear_drives = {cable.name: cable.linear for cable in robot.cables if cable.linear is not None}
    for name, servo in ((name, robot.servo(name)) for name in layout(robot).servos):
        body, position = seats[name]
        motor = motor_by_servo.get(name)
        description = f"servo of {servo.torque:g} N m and {servo.speed:g} rad/s"
        if name in linear_drives:
            actuator = linear_drives[name]
            description = (
                f"linear actuator of {actuator.force:g} N, {1000 * actuator.speed:g} mm/s and "
                f"{2000 * actuator.travel:.1f} mm stroke"
            )
        servo_parts.append(
            BodyPart(
                body=body,
                name=name,
                kind="servo",
                size=(nan, nan, nan) if motor is None else motor.size,
                mass=nan if motor is None else motor.mass,
                centre=position,
                description=description if motor is None else motor.name,
            )
        )
    return servo_parts


def _bodies(
    robot: Robot,
    motor_by_servo: Mapping[str, Motor],
    seats: Mapping[str, tuple[str, tuple[float, float, float]]],
    parts: Sequence[BodyPart],
    skin: float,
) -> tuple[MassBudget, ...]:
    """Return the mass budget of each body: as simulated, of its servos, and of printed walls and foam.

    Args:
        robot: the design.
        motor_by_servo: servos that are sold, by name.
        seats: body and position of each servo.
        parts: parts of all bodies.
        skin: mass of a printed wall per area [kg/m2].
    """
    masses, _ = body_masses(robot)
    budgets = []
    for body, mass in zip(layout(robot).bodies, masses, strict=True):
        body_parts = [body_part for body_part in parts if body_part.body == body.name]
        sitting = [
            motor_by_servo[name].mass if name in motor_by_servo else nan
            for name, (seat, _) in seats.items()
            if seat == body.name
        ]
        printed_mass = sum(
            skin * area(body_part.kind, body_part.size)
            for body_part in body_parts
            if body_part.kind in ("rod", "shell", "foot")
        )
        foam = sum(body_part.mass for body_part in body_parts if body_part.kind == "foam")
        budgets.append(
            MassBudget(name=body.name, simulated=float(mass), servos=float(sum(sitting)), printed=printed_mass + foam)
        )
    return tuple(budgets)


def _built_centre(robot: Robot, parts: Sequence[BodyPart], skin: float) -> tuple[float, float, float]:
    """Return the centre of mass of servos, walls and foam, all joints at zero [m]; NaN if servos are unknown."""
    place = layout(robot)
    origins = frames(robot, np.zeros(len(place.hinges))).positions
    origin_by_body = {body.name: origins[i] for i, body in enumerate(place.bodies)}
    weights, points = [], []
    for body_part in parts:
        weights.append(
            skin * area(body_part.kind, body_part.size)
            if body_part.kind in ("rod", "shell", "foot")
            else body_part.mass
        )
        points.append(origin_by_body[body_part.body] + np.array(body_part.centre))
    total = float(np.sum(weights))
    return _rounded_point(np.array(weights) @ np.array(points) / total)


def _joints(robot: Robot) -> tuple[HingePlace, ...]:
    """Return position, axis, range and actuator of each hinge, all joints at zero."""
    place = layout(robot)
    origins = frames(robot, np.zeros(len(place.hinges))).positions
    cable_by_hinge = {hinge: cable.name for cable in place.robot.cables for hinge in cable.hinges}
    hinges = []
    for i, body in enumerate(place.bodies):
        parent = place.bodies[body.parent].name if body.parent >= 0 else ""
        for hinge, name, axis in body.hinges:
            drive = name if isinstance(hinge.servo, Servo) else cable_by_hinge.get(name, "spring")
            hinges.append(HingePlace(name=name, body=body.name, parent=parent, at=_rounded_point(origins[i]),
                               axis=_rounded_point(axis), range=hinge.range, driven_by=drive))  # fmt: skip
    return tuple(hinges)


def _links(robot: Robot) -> tuple[DHRow, ...]:
    """Return the Denavit-Hartenberg tables of the chains that have the article's geometry.

    Paper: Tables I and II, Figs 6 and 8.
    """
    rows = []
    chains = (("front leg", 0), ("hind leg", -1)) if len(robot.girdles) > 1 else (("hind leg", -1),)
    for chain, girdle in chains if robot.girdles else ():
        leg = leg_of(robot.girdles[girdle])
        if leg is not None:
            lengths = (leg.hip_offset, 0.0, leg.femur, leg.tibia)
            names = ("yaw", "pitch", "knee", "foot")
            for i, (a, alpha) in enumerate(zip(lengths, (0.0, pi / 2, 0.0, 0.0), strict=True)):
                rows.append(DHRow(chain=chain, number=i + 1, a=a, alpha=alpha, d=0.0, turned_by=names[i]))
    spine = spine_of(robot) if robot.girdles else None
    if spine is not None:
        for i, name in enumerate(spine.names):
            alpha = 0.0 if i == 0 else (-pi / 2 if i % 2 else pi / 2)
            a = spine.base if i == 0 else spine.link
            rows.append(DHRow(chain="spine", number=i + 1, a=a, alpha=alpha, d=0.0, turned_by=name))
    return tuple(rows)


def _plates(robot: Robot) -> tuple[TailPlate, ...]:
    """Return the plates of a tail that cords bend; none for other tails."""
    tail = tail_of(robot)
    if tail is None or not tail.cabled:
        return ()
    half = tail.cord_spacing / 2
    holes = ((-half, 0.0), (half, 0.0))
    return tuple(
        TailPlate(name=name, radius=max(radius, 1.2 * half), thickness=tail.plate, holes=holes)
        for name, radius in zip(tail.driven, tail.radii, strict=False)
    )


def _cord(robot: Robot, cable: Cable) -> Cord:
    """Return the table of a cord pair: bend of the section, actuator travel, and the length changes of both cords."""
    tail, linear = tail_of(robot), cable.linear is not None
    output_factor = cable.pulley if linear else 1.0
    if tail is None or not tail.cabled or cable.hinges != tail.driven:
        half = cable.cord_spacing / 2
        straight_bends = np.linspace(0.0, cable.bend_limit, _STEPS).tolist()
        straight = tuple((b, output_factor * b * half / cable.pulley, 0.0 - b * half, b * half) for b in straight_bends)
        return Cord(name=cable.name, section=nan, travel=cable.bend_limit * half, table=straight, linear=linear)
    max_bend = min(cable.bend_limit, bend_limit(tail))
    bends = np.linspace(0.0, max_bend, _STEPS)
    inner_change, outer_change = (change + 0.0 for change in cable_changes(tail, bends))  # no -0
    turns = output_factor * servo_angle(tail, bends)
    table = tuple(zip(bends.tolist(), turns.tolist(), inner_change.tolist(), outer_change.tolist(), strict=True))
    return Cord(
        name=cable.name, section=tail.joints * tail.pitch, travel=float(-inner_change[-1]), table=table, linear=linear
    )


def _wires(
    robot: Robot, motor_by_servo: Mapping[str, Motor], seats: Mapping[str, tuple[str, tuple[float, float, float]]]
) -> tuple[ServoWire, ...]:
    """Return the chain of each bus from the root outward: each servo hangs on the nearest one that is wired already."""
    place = layout(robot)
    origins = frames(robot, np.zeros(len(place.hinges))).positions
    origin_by_body = {body.name: origins[i] for i, body in enumerate(place.bodies)}
    seat_positions = {name: origin_by_body[body] + np.array(point) for name, (body, point) in seats.items()}
    wires: list[ServoWire] = []
    for bus in dict.fromkeys(
        motor_by_servo[name].family if name in motor_by_servo else "servos" for name in place.servos
    ):
        members = [n for n in place.servos if (motor_by_servo[n].family if n in motor_by_servo else "servos") == bus]
        wired: dict[str, np.ndarray] = {"controller": np.zeros(3)}
        while members:
            name, predecessor = min(
                ((name, wired_name) for name in members for wired_name in wired),
                key=lambda pair: float(np.linalg.norm(seat_positions[pair[0]] - wired[pair[1]])),
            )
            straight = float(np.linalg.norm(seat_positions[name] - wired[predecessor]))
            number = place.servos.index(name) + 1
            wires.append(
                ServoWire(servo=name, number=number, bus=bus, after=predecessor, length=max(SPARE * straight, 0.05))
            )
            wired[name] = seat_positions[name]
            members.remove(name)
    return tuple(wires)


def _floating(robot: Robot) -> Buoyancy:
    """Return the volumes that carry a robot: its bodies, foam and air chambers."""
    hull = robot.hull
    total_volume = sum(volumes(robot).values())
    foam = (
        ()
        if hull is None
        else tuple((foam_block.body, foam_block.volume, foam_block.raised) for foam_block in hull.foam)
    )
    chambers = () if hull is None else tuple((chamber.body, chamber.share) for chamber in hull.chambers)
    bare_volume = total_volume - sum(volume for _, volume, _ in foam)
    return Buoyancy(
        mass=robot.mass, bare=bare_volume, foam=foam, air=0.0 if hull is None else hull.air, chambers=chambers
    )
