"""Animals at their own length, mass and volume, whose lungs make them lighter than their water or nearly so.

None of them is a robot of the catalog: they are built from a few numbers, each of which has a range of its own.
"""

from dataclasses import replace
from math import pi, sqrt

from suchus.robot.design import Robot, Rod, Segment, Servo
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.pieces import volumes
from suchus.robot.design.scale import rescale, swim_servo_for
from suchus.robot.robots.salamander import robot as _salamander

_CATSHARK_JOINTS = tuple(0.14 + 0.79 * i / 11 for i in range(12))
_EEL_JOINTS = tuple(0.06 + 0.88 * i / 14 for i in range(15))


def pleurodeles(length: float, mass: float, density: float, keel: float, *, beat: float) -> Robot:
    """Return the salamander of the catalog at an animal's length, mass and volume.

    Each part of the axis has the volume of its mass, so that each floats as the whole does; limbs keep their
    proportions. A part of the mass lies low, as that of flesh and bones below the lungs does.

    Args:
        length: length from the snout to the tip of the tail [m].
        mass: [kg].
        density: mass over volume, lungs filled [kg/m3].
        keel: share of the mass of each part of the axis that lies low [-].
        beat: frequency of the swim for which its joints are stiff enough [Hz].
    """
    animal = rescale(_salamander, length_factor=length / _salamander.length, mass_factor=mass / _salamander.mass)
    animal = replace(
        animal, axis=tuple(_with_stiff_hinges(segment, swim_servo_for(mass, length, beat)) for segment in animal.axis)
    )
    factor = 1.0
    for _ in range(12):
        robot = replace(
            animal,
            name="pleurodeles",
            axis=tuple(_floating_segment(segment, density, keel, factor) for segment in animal.axis),
        )
        volume = sum(volumes(robot).values())
        if abs(volume * density / mass - 1.0) < 1e-9:
            break
        factor *= sqrt(mass / density / volume)
    return robot


def _with_stiff_hinges(segment: Segment, servo: Servo) -> Segment:
    """Return a segment behind which a servo that holds the water turns the lateral hinges."""
    hinges = tuple(replace(hinge, drive=servo) if hinge.turn == "yaw" else hinge for hinge in segment.hinges)
    return replace(segment, hinges=hinges)


def _floating_segment(segment: Segment, density: float, keel: float, factor: float) -> Segment:
    """Return a segment with the volume of its mass, of which a part lies low.

    Args:
        segment: segment of one rod.
        density: mass over volume [kg/m3].
        keel: fraction of the mass that lies low [-].
        factor: on the radius [-].
    """
    (rod,) = (shape for shape in segment.shapes if isinstance(shape, Rod))
    length = segment.front + segment.rear
    radius = factor * sqrt(rod.mass / (density * pi * length))
    start, end = min(rod.start[0] + rod.radius, 0.0), -length
    start = -min(radius, 0.4 * length) if rod.start[0] < 0.0 else start
    end += min(radius, 0.4 * length) if rod.end[0] > -length else 0.0
    belly_radius, belly_z = 0.2 * radius, -0.6 * radius
    flesh = replace(rod, start=(start, 0.0, 0.0), end=(end, 0.0, 0.0), radius=radius, mass=(1.0 - keel) * rod.mass)
    belly = Rod(
        name=f"{rod.name}_belly", start=(0.4 * end, 0.0, belly_z), end=(0.6 * end, 0.0, belly_z), radius=belly_radius,
        mass=keel * rod.mass,
    )  # fmt: skip
    return replace(segment, shapes=(flesh, belly))


def catshark(length: float, mass: float, density: float, width_factor: float, tail: float, *, beat: float) -> Robot:
    """Return a small-spotted catshark, its sections ellipses.

    Args:
        length: length from the snout to the tip of the tail [m].
        mass: [kg].
        density: mass over volume [kg/m3].
        width_factor: factor on the drawn width [-].
        tail: factor on the height of the caudal fin [-].
        beat: frequency of the swim for which its joints are stiff enough [Hz].

    Source: proportions of Scyliorhinus canicula, from memory of the drawing in Compagno 1984, FAO Species Catalogue 4.
    """
    places = (0.0, 0.03, 0.10, 0.20, 0.32, 0.45, 0.60, 0.75, 0.85, 0.95, 1.0)
    half_width = (0.012, 0.035, 0.052, 0.055, 0.048, 0.036, 0.024, 0.014, 0.008, 0.006, 0.005)
    half_height = (0.010, 0.022, 0.036, 0.044, 0.042, 0.040, 0.034, 0.026, 0.036, 0.042, 0.036)
    scaled_height = [value * (tail if place > 0.8 else 1.0) for place, value in zip(places, half_height, strict=True)]
    drawing = Drawing(
        name="catshark",
        length=length,
        mass=mass,
        density=density,
        stations=places,
        half_width=tuple(width_factor * value for value in half_width),
        half_height=tuple(scaled_height),
        joints=_CATSHARK_JOINTS,
    )
    return drawing.robot(swim_servo_for(mass, length, beat))


def eel(length: float, mass: float, density: float, *, beat: float) -> Robot:
    """Return an eel, its sections ellipses.

    Args:
        length: length from the snout to the tip of the tail [m].
        mass: [kg].
        density: mass over volume [kg/m3].
        beat: frequency of the swim for which its joints are stiff enough [Hz].

    Source: shape of the anguilliform swimmer of Kern and Koumoutsakos 2006, J. Exp. Biol. 209, 4841: half width 0.04
    body lengths behind a round head, narrowing to 0.01 at 0.95 and from there to an edge, half height that of an
    ellipse of 0.08 about 0.51; at its ends it has 0.001 and 0.006 here, since a section needs some size.
    """
    places = tuple(i / 20 for i in range(21))
    drawing = Drawing(
        name="eel", length=length, mass=mass, density=density, stations=places,
        half_width=tuple(_eel_width(place) for place in places),
        half_height=tuple(max(0.08 * sqrt(max(1.0 - ((place - 0.51) / 0.51) ** 2, 0.0)), 0.006) for place in places),
        joints=_EEL_JOINTS,
    )  # fmt: skip
    return drawing.robot(swim_servo_for(mass, length, beat))


def _eel_width(place: float) -> float:
    """Return the half width of the eel at a place along the body, both [body length]."""
    head, tail, max_width, tail_width = 0.04, 0.95, 0.04, 0.01
    if place < head:
        return max(sqrt(max(2.0 * max_width * place - place**2, 0.0)), 0.006)
    if place < tail:
        return max_width - (max_width - tail_width) * ((place - head) / (tail - head)) ** 2
    return max(tail_width * (1.0 - place) / (1.0 - tail), 0.001)
