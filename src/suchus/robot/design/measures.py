"""The measures of a chain that closed forms are for, read from any robot that has it.

A leg of yaw, pitch and knee; a spine whose hinges turn by yaw and pitch in turn; a tail of plates with a flexible end.
A robot that has no such chain has no such measures: what needs them asks for them by ``design.NEEDS``.
"""

from functools import lru_cache
from math import fsum, inf, isnan, nan, pi, tan
from typing import TYPE_CHECKING, NamedTuple

from suchus.robot.design.hinge import Cable, Hinge, Servo, Spring
from suchus.robot.design.limb import Girdle
from suchus.robot.design.segment import Rod, Segment, Shell

if TYPE_CHECKING:
    from suchus.robot.design.body import Robot

Range = tuple[float, float]
_ENDLESS: Range = (-inf, inf)
_LENGTH_TOLERANCE = 1e-12  # of a length; what is equal but for rounding


class LegMeasures(NamedTuple):
    """A limb of yaw and pitch at the hip and a knee, its links straight out."""

    hip_offset: float
    """Distance from the midline to the hip's yaw axis, the article's a0 [m]."""
    femur: float
    """Length from hip to knee, the article's a2 [m]."""
    tibia: float
    """Length from knee to the foot's centre, the article's a3 [m]."""
    foot_radius: float
    """Radius of the spherical foot [m]."""
    above: float
    """Distance from the axis of the body up to the hip [m]."""
    radius: float
    """Radius of the femur [m]."""
    mass: float
    """Mass of one leg [kg]."""
    yaw_range: Range
    """Limits of the yaw joint, forward positive [rad]."""
    pitch_range: Range
    """Limits of the pitch joint, foot down positive [rad]."""
    knee_range: Range
    """Limits of the knee, shank down positive [rad]."""
    servo: Servo
    """The servo at the yaw joint."""

    @property
    def reach(self) -> Range:
        """Nearest and farthest distance of the foot from the hip [m]."""
        return abs(self.femur - self.tibia), self.femur + self.tibia


class SpineMeasures(NamedTuple):
    """Hinges in a row between hind and front girdle, the first and every second a yaw, the others pitches."""

    base: float
    """Distance from the root's origin forward to the first joint, the article's a0 [m]."""
    link: float
    """Length from each joint to the next, the article's a1 to a4 [m]; 0 for a single joint."""
    joints: int
    """Number of joints [-]."""
    radius: float
    """Greatest radius of the links between the joints [m]; 0 for a single joint."""
    link_masses: tuple[float, ...]
    """Mass of each link between the joints, from the root forward [kg]."""
    yaw_range: Range
    """Limits of the first yaw joint [rad]."""
    pitch_range: Range
    """Limits of the first pitch joint [rad]."""
    yaw_servo: Servo
    """The servo of the first yaw joint."""
    pitch_servo: Servo
    """The servo of the first pitch joint; of the yaw joint where there is none."""

    @property
    def length(self) -> float:
        """Length from the root's origin to the last joint when straight [m]."""
        return self.base + (self.joints - 1) * self.link

    @property
    def names(self) -> tuple[str, ...]:
        """Names that its joints have in a robot of the article's tables, from the root forward."""
        return tuple(f"spine_{'pitch' if i % 2 else 'yaw'}_{i // 2 + 1}" for i in range(self.joints))


class TailMeasures(NamedTuple):
    """A tail that pitches at its root, bends sideways in equal joints and ends in equal passive segments."""

    offset: float
    """Distance from the root's origin back to the pitch joint [m]."""
    root: float
    """Distance from the pitch joint to half a joint's distance before the first driven one [m]."""
    joints: int
    """Number of driven yaw joints, the article's N [-]."""
    driven: tuple[str, ...]
    """Names of those joints, from the root."""
    passive: tuple[str, ...]
    """Names of the passive joints, from the root, yaw before pitch in each."""
    lengths: tuple[float, ...]
    """Length of each segment, from the root: plates between their joints, then the passive end [m]."""
    radii: tuple[float, ...]
    """Radius of each segment [m]."""
    masses: tuple[float, ...]
    """Mass of each segment [kg]."""
    pitch: float
    """Distance from each driven joint to the next, the article's H + h [m]."""
    gap: float
    """Gap between plates, the article's h [m]; NaN without a cable."""
    cord_spacing: float
    """Distance between the two cords, the article's d [m]; NaN without a cable."""
    pulley: float
    """Radius of the servo's pulley, the article's r [m]; NaN without a cable."""
    bend_limit: float
    """Greatest lateral bend of the driven joints together to either side [rad]."""
    joint_stiffness: float
    """Lateral spring at each joint under the cable [N m/rad]; NaN without a cable."""
    joint_damping: float
    """Lateral damper at each joint under the cable [N m s/rad]; NaN without a cable."""
    fin_segments: int
    """Number of segments of the passive end [-]."""
    fin_length: float
    """Length of the passive end [m]."""
    fin_stiffness_lateral: float
    """Lateral spring at the first passive joint [N m/rad]."""
    fin_stiffness_vertical: float
    """Vertical spring at the first passive joint [N m/rad]."""
    fin_damping: float
    """Damper at the first passive joint [N m s/rad]."""
    radius_root: float
    """Radius at the root, where its taper is carried on to [m]."""
    radius_tip: float
    """Radius at the tip, where its taper is carried on to [m]."""
    mass: float
    """Mass of the whole tail [kg]."""
    pitch_range: Range
    """Limits of the pitch joint, down positive [rad]."""
    pitch_servo: Servo
    """The servo of the pitch joint."""
    cable_servo: Servo
    """The servo that turns the pulley, or the first driven joint."""

    @property
    def cabled(self) -> bool:
        """Whether a cable bends the driven joints, and not a servo in each."""
        return not isnan(self.gap)

    @property
    def plate(self) -> float:
        """Thickness of a plate, the article's H [m]."""
        return _tidy(self.pitch - self.gap)

    @property
    def length(self) -> float:
        """Length from the root's origin to the tip when straight [m]."""
        return self.offset + self.root + self.joints * self.pitch + self.fin_length


class PelvisMeasures(NamedTuple):
    """The shell of the hind girdle."""

    mass: float
    """[kg]."""
    length: float
    """Length along the body [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""


class ThoraxMeasures(NamedTuple):
    """The shell of the front girdle."""

    mass: float
    """[kg]."""
    shoulder: float
    """Distance from the last joint of the trunk forward to the front girdle's axis [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""


class HeadMeasures(NamedTuple):
    """The shell of the head, in the foremost segment."""

    mass: float
    """[kg]."""
    snout: float
    """Distance from the joint behind the foremost segment forward to the tip of the snout [m]."""
    width: float
    """[m]."""
    height: float
    """[m]."""


def pelvis_of(robot: "Robot") -> PelvisMeasures | None:
    """Return the measures of the root's shell called ``pelvis``, None without one."""
    shell = shell_of(robot, "pelvis")
    return None if shell is None else PelvisMeasures(shell.mass, *(2 * half for half in shell.half))


def thorax_of(robot: "Robot") -> ThoraxMeasures | None:
    """Return the measures of the shell called ``thorax``, None without one."""
    shell = shell_of(robot, "thorax")
    if shell is None or not robot.girdles:
        return None
    front = next(segment for segment in robot.axis if segment.name == robot.girdles[0].segment)
    return ThoraxMeasures(shell.mass, front.rear + robot.girdles[0].at, 2 * shell.half[1], 2 * shell.half[2])


def head_of(robot: "Robot") -> HeadMeasures | None:
    """Return the measures of the shell called ``head``, None without one."""
    shell, front = shell_of(robot, "head"), robot.axis[0]
    if shell is None or shell not in front.shapes:
        return None
    return HeadMeasures(shell.mass, front.front + front.rear, 2 * shell.half[1], 2 * shell.half[2])


def leg_of(girdle: Girdle) -> LegMeasures | None:
    """Return the measures of a girdle's left limb, None where it is no leg of yaw, pitch and knee."""
    links = girdle.limb.links
    turns = [[hinge.turn for hinge in link.hinges] for link in links]
    straight = all(link.end[0] == link.end[2] == 0.0 and link.end[1] > 0.0 for link in links)
    if not straight or turns != [["yaw", "pitch"], ["pitch"]]:
        return None
    yaw, pitch, knee = girdle.limb.hinges
    if yaw.servo is None:
        return None
    return LegMeasures(
        hip_offset=girdle.aside,
        femur=links[0].length,
        tibia=links[1].length,
        foot_radius=girdle.limb.foot.radius,
        above=girdle.above,
        radius=links[0].radius,
        mass=girdle.limb.mass,
        yaw_range=yaw.range or _ENDLESS,
        pitch_range=pitch.range or _ENDLESS,
        knee_range=knee.range or _ENDLESS,
        servo=yaw.servo,
    )


@lru_cache(maxsize=256)
def spine_of(robot: "Robot") -> SpineMeasures | None:
    """Return the measures of the spine from the root to the front girdle's segment, None of another chain."""
    if not robot.girdles:
        return None
    front = [segment.name for segment in robot.axis].index(robot.girdles[0].segment)
    segments = robot.axis[front : robot.root_index][::-1]
    hinges = [segment.hinges[0] for segment in segments if len(segment.hinges) == 1]
    servos = [hinge.servo for hinge in hinges]
    turns = [hinge.turn for hinge in hinges]
    lengths = [segment.front + segment.rear for segment in segments[:-1]]
    fits = (
        len(hinges) == len(segments) > 0
        and turns == ["pitch" if i % 2 else "yaw" for i in range(len(segments))]
        and all(abs(length - lengths[0]) <= _LENGTH_TOLERANCE * lengths[0] for length in lengths)
        and segments[-1].rear == 0.0
    )
    if not fits or servos[0] is None or None in servos:
        return None
    rods = [shape.radius for segment in segments[:-1] for shape in segment.shapes if isinstance(shape, Rod)]
    pitched = hinges[1] if len(hinges) > 1 else hinges[0]
    return SpineMeasures(
        base=robot.axis[robot.root_index].front,
        link=lengths[0] if lengths else 0.0,
        joints=len(hinges),
        radius=max(rods, default=0.0),
        link_masses=tuple(fsum(shape.mass for shape in segment.shapes) for segment in segments[:-1]),
        yaw_range=hinges[0].range or _ENDLESS,
        pitch_range=pitched.range or _ENDLESS,
        yaw_servo=servos[0],
        pitch_servo=pitched.servo or servos[0],
    )


@lru_cache(maxsize=256)
def tail_of(robot: "Robot") -> TailMeasures | None:
    """Return the measures of the tail behind the root, None of another chain."""
    root, segments = robot.axis[robot.root_index], robot.axis[robot.root_index + 1 :]
    if len(root.hinges) != 1 or len(segments) < 2 or root.hinges[0].turn != "pitch" or root.hinges[0].servo is None:
        return None
    driven_hinges = [s.hinges[0] for s in segments[:-1] if [h.turn for h in s.hinges] == ["yaw"]]
    passive = [s.hinges for s in segments[:-1] if [h.turn for h in s.hinges] == ["yaw", "pitch"]]
    count = len(driven_hinges)
    rods = [s.shapes[0] for s in segments if len(s.shapes) == 1 and isinstance(s.shapes[0], Rod)]
    if count == 0 or not passive or count + len(passive) + 1 != len(segments) or len(rods) != len(segments):
        return None
    names = tuple(hinge.name for hinge in driven_hinges)
    cable = next((cable for cable in robot.cables if cable.hinges == names), None)
    servo = cable.turning if cable is not None else driven_hinges[0].servo
    springs = [hinge.drive for pair in passive for hinge in pair]
    in_order = [[h.turn for h in s.hinges] for s in segments[:-1]] == count * [["yaw"]] + len(passive) * [
        ["yaw", "pitch"]
    ]
    if servo is None or not in_order or not all(isinstance(spring, Spring) for spring in springs):
        return None
    return _plates(segments, root, driven_hinges, cable, servo, rods)


def _plates(
    segments: tuple[Segment, ...],
    root: Segment,
    driven_hinges: list[Hinge],
    cable: Cable | None,
    servo: Servo,
    rods: list[Rod],
) -> TailMeasures | None:
    """Return the measures of a tail whose hinges fit; None where its segments are not equal.

    Args:
        segments: behind the root.
        root: segment whose hinge pitches the tail.
        driven_hinges: yaw hinges under the cable or with servos.
        cable: over these hinges; None if each has a servo.
        servo: servo that drives them.
        rods: shape of each segment.
    """
    count, lengths = len(driven_hinges), [segment.front + segment.rear for segment in segments]
    # the last driven joint is followed by half a joint's distance, then the passive end begins
    pitch = lengths[1] if count > 1 else _tidy(2 * lengths[count])
    ends = lengths[count + 1 :]
    expected_lengths = [*(count - 1) * [pitch], pitch / 2, *len(ends) * [ends[0]]]
    if any(abs(a - b) > _LENGTH_TOLERANCE * b for a, b in zip(lengths[1:], expected_lengths, strict=True)):
        return None
    lateral_spring, vertical_spring = (hinge.drive for hinge in segments[count].hinges)
    assert isinstance(lateral_spring, Spring)
    assert isinstance(vertical_spring, Spring)
    centers = [fsum(lengths[:i]) + length / 2 for i, length in enumerate(lengths)]
    taper = (rods[-1].radius - rods[0].radius) / (centers[-1] - centers[0])
    first_drive = driven_hinges[0].drive
    limit = fsum(abs((hinge.range or _ENDLESS)[1]) for hinge in driven_hinges) if cable is None else cable.bend_limit
    pitching = root.hinges[0]
    assert pitching.servo is not None
    return TailMeasures(
        offset=root.rear,
        root=_tidy(lengths[0] - pitch / 2),
        joints=count,
        driven=tuple(hinge.name for hinge in driven_hinges),
        passive=tuple(hinge.name for segment in segments[count:] for hinge in segment.hinges),
        lengths=tuple(lengths),
        radii=tuple(rod.radius for rod in rods),
        masses=tuple(rod.mass for rod in rods),
        pitch=pitch,
        gap=nan if cable is None else closing_gap(cable),
        cord_spacing=nan if cable is None else cable.cord_spacing,
        pulley=nan if cable is None else cable.pulley,
        bend_limit=limit,
        joint_stiffness=first_drive.stiffness if isinstance(first_drive, Spring) else nan,
        joint_damping=first_drive.damping if isinstance(first_drive, Spring) else nan,
        fin_segments=len(ends),
        fin_length=_tidy(fsum(ends)),
        fin_stiffness_lateral=lateral_spring.stiffness,
        fin_stiffness_vertical=vertical_spring.stiffness,
        fin_damping=lateral_spring.damping,
        radius_root=_tidy(rods[0].radius - taper * centers[0]),
        radius_tip=_tidy(rods[-1].radius + taper * (fsum(lengths) - centers[-1])),
        mass=_tidy(fsum(rod.mass for rod in rods)),
        pitch_range=pitching.range or _ENDLESS,
        pitch_servo=pitching.servo,
        cable_servo=servo,
    )


def closing_gap(cable: Cable) -> float:
    """Return the gap between the plates that a cable bends [m]; if it names none, that which closes at its limit."""
    return cable.gap or cable.cord_spacing * tan(min(cable.bend_limit / (2 * cable.joints), pi / 2 - 1e-3))


def shell_of(robot: "Robot", name: str) -> Shell | None:
    """Return the shell of the axis that carries a name, as ``head``; None where there is none."""
    shapes = (shape for segment in robot.axis for shape in segment.shapes)
    return next((shape for shape in shapes if shape.name == name and isinstance(shape, Shell)), None)


def _tidy(value: float) -> float:
    """Return a number rounded to 14 digits, which removes rounding errors of decimal fractions."""
    return float(f"{value:.14g}")
