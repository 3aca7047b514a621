"""A robot in pieces for the water: strips of its axis, sections of its limbs and balls for feet, in a table.

The table's columns are those of ``hydro.table``; bodies are numbered as in ``design.layout``.
"""

from functools import lru_cache
from math import ceil, hypot, pi, sqrt

import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign
from suchus.core.water_table import BALL, COLUMNS, DISC, WIDTH, column
from suchus.robot.design.body import Robot
from suchus.robot.design.form import NOSE_DRAG
from suchus.robot.design.hull import Hull
from suchus.robot.design.layout import Layout, LimbPlace, layout
from suchus.robot.design.profile import profile, stations

FINENESS = 20
"""Strips of an axis at least [-]; see docs/amphibious.md for what finer ones change."""
_SAMPLES_PER_STRIP = 24
"""Stations within a strip over which its section is averaged [-]."""
_BONES = 2
"""Sections of each link of a limb [-]."""
FRONT, REAR = 0, 1
"""Kinds of chambers in the order of the table's columns."""
SOLID = 2000.0
"""Density of what is solid in a robot, batteries and servos above all [kg/m3]; packed cells and geared servos of metal
have 1700 to 2500, frames of plastic 1200."""
_BALL_DRAG = 0.47 / 1.1
"""Drag coefficient of a ball over that of a round section across [-]."""


@lru_cache(maxsize=64)
def pieces(robot: Robot) -> Float[np.ndarray, "piece column"]:
    """Return the pieces of a robot, with its foam if it has any; read-only.

    Raises:
        InvalidDesign: a hull with foam or air on a body that does not exist, or with more air than there is room for.
    """
    place = layout(robot)
    rows = [*_strips(place), *(row for limb in place.limbs for row in _limb(limb))]
    table = np.stack(rows)
    if place.robot.hull is not None:
        _dress(place, table, place.robot.hull)
    table.flags.writeable = False
    return table


def volumes(robot: Robot) -> dict[str, float]:
    """Return the volume of each body with its foam [m3]."""
    table, place = pieces(robot), layout(robot)
    sums = np.bincount(table[:, 0].astype(int), table[:, COLUMNS["volume"][0]], len(place.bodies))
    return {body.name: float(volume) for body, volume in zip(place.bodies, sums, strict=True)}


def masses(robot: Robot) -> dict[str, float]:
    """Return the mass of each body, without foam [kg]."""
    place = layout(robot)
    body_masses = {segment.name: sum(shape.mass for shape in segment.shapes) for segment in place.robot.axis}
    for limb in place.limbs:
        design = limb.girdle.limb
        for link in design.links:
            body_masses[f"{limb.name}_{link.name}"] = link.mass
        body_masses[f"{limb.name}_{design.links[-1].name}"] += design.foot.mass
    return body_masses


def _row(**parts: float | tuple[float, ...] | np.ndarray) -> np.ndarray:
    row = np.zeros(WIDTH)
    for name, values in parts.items():
        row[slice(*COLUMNS[name])] = values
    return row


def _strips(place: Layout) -> list[np.ndarray]:
    """Return strips of the axis, from head to tail."""
    robot, strips = place.robot, []
    number = {body.name: i for i, body in enumerate(place.bodies)}
    for segment, (start, end) in zip(robot.axis, stations(robot), strict=True):
        count = max(1, ceil((end - start) / robot.length * FINENESS - 1e-9))
        length = (end - start) / count
        s = start + length * (np.arange(count * _SAMPLES_PER_STRIP) + 0.5) / _SAMPLES_PER_STRIP
        sections = [values.reshape(count, _SAMPLES_PER_STRIP) for values in profile(robot, s)]
        shift = place.bodies[number[segment.name]].shift
        for i, (half_width, half_height, area, center) in enumerate(zip(*sections, strict=True)):
            x = shift + segment.front - (i + 0.5) * length
            strips.append(_strip(number[segment.name], x, length, (half_width, half_height, area, center)))
    tail_strip = strips[-1]
    a, b, c = tail_strip[slice(*COLUMNS["half"])]
    tail_strip[slice(*COLUMNS["shed"])], tail_strip[COLUMNS["shed_at"][0]] = (pi * b**2, pi * a**2), -c
    strips[0][COLUMNS["end"][0]] = NOSE_DRAG * max(row[COLUMNS["volume"][0]] / (2 * row[16]) for row in strips)
    return strips


def _strip(body: int, x: float, length: float, section: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return one strip of the axis as an elliptic section of the mean area and the mean proportions.

    Args:
        body: index of the body that carries it.
        x: of its centre in the frame of the body, forward [m].
        length: along the axis [m].
        section: half widths, half heights, areas and centre heights at its stations [m], [m2].
    """
    half_width, half_height, area, middle = section
    volume = float(area.mean()) * length
    scale = sqrt(float(area.mean()) / (pi * float(half_width.mean()) * float(half_height.mean())))
    half = scale * float(half_width.mean()), scale * float(half_height.mean()), length / 2
    center = x, 0.0, float(np.average(middle, weights=area))
    return _disc(body, center, ((0, 1, 0), (0, 0, 1), (1, 0, 0)), half, volume)


def _disc(
    body: int,
    center: tuple[float, float, float] | np.ndarray,
    axes: tuple[tuple[float, ...] | np.ndarray, ...],
    half: tuple[float, float, float],
    volume: float,
) -> np.ndarray:
    """Return an elliptic section with the added mass of potential flow and the girth of an ellipse (Ramanujan).

    Args:
        body: index of the body that carries it.
        center: center in the frame of the body [m].
        axes: unit vectors across, upward and forward.
        half: half axes along them [m].
        volume: [m3].
    """
    a, b, c = half
    girth = pi * (3 * (a + b) - sqrt((3 * a + b) * (a + 3 * b)))
    return _row(
        body=body,
        kind=DISC,
        at=center,
        across=axes[0],
        upward=axes[1],
        forward=axes[2],
        half=half,
        volume=volume,
        added=(pi * b**2 * 2 * c, pi * a**2 * 2 * c, 0.0),
        area=(4 * b * c, 4 * a * c),
        skin=girth * 2 * c,
        roll=0.25 * abs(a**4 - b**4) * 2 * c,
    )


def ball(body: int, center: tuple[float, float, float] | np.ndarray, radius: float) -> np.ndarray:
    """Return a sphere as a piece: added mass of half its volume, drag of a sphere.

    Args:
        body: index of the body that carries it.
        center: center in the frame of the body [m].
        radius: [m].
    """
    volume = 4 / 3 * pi * radius**3
    area = _BALL_DRAG * pi * radius**2
    return _row(
        body=body, kind=BALL, at=center, across=(0, 1, 0), upward=(0, 0, 1), forward=(1, 0, 0), half=3 * (radius,),
        volume=volume, added=3 * (volume / 2,), area=(area, area), end=0.47 * pi * radius**2,
    )  # fmt: skip


def _limb(limb: LimbPlace) -> list[np.ndarray]:
    """Return the sections of a limb's links, and its foot."""
    design, rows = limb.girdle.limb, []
    first_body = limb.tip - len(design.links) + 1
    for i, link in enumerate(design.links):
        end = np.array([link.end[0], limb.side * link.end[1], link.end[2]])
        forward = end / link.length
        lateral_axis = np.cross(forward, (0, 0, 1) if abs(forward[2]) < 0.9 else (1, 0, 0))
        lateral_axis /= hypot(*lateral_axis)
        axes = lateral_axis, np.cross(forward, lateral_axis), forward
        is_last_link = i == len(design.links) - 1
        overlap = sqrt(max(design.foot.radius**2 - link.radius**2, 0.0)) if is_last_link else 0.0
        length = max(link.length - overlap, 1e-6) / _BONES
        for k in range(_BONES):
            half = link.radius, link.radius, length / 2
            rows.append(_disc(first_body + i, (k + 0.5) * length * forward, axes, half, pi * link.radius**2 * length))
        if is_last_link:
            rows.append(ball(first_body + i, end, design.foot.radius))
    return rows


def _dress(place: Layout, table: np.ndarray, hull: Hull) -> None:
    """Add foam and air to the pieces: bodies grow to their volume with foam, shifted by its offset.

    Args:
        place: layout of the robot.
        table: table of the pieces, changed in place.
        hull: hull of the robot.
    """
    number = {body.name: i for i, body in enumerate(place.bodies)}
    for foam in hull.foam:
        if foam.body not in number:
            raise InvalidDesign(
                f"hull.foam is on {foam.body!r}, and robot {place.robot.name!r} has no such body; it has "
                f"{', '.join(number)}."
            )
        is_in_body = table[:, 0] == number[foam.body]
        body_pieces = table[is_in_body]
        own_volume = body_pieces[:, COLUMNS["volume"][0]].sum()
        factor = 1.0 + foam.volume / own_volume
        table[is_in_body] = swell(body_pieces, factor)
        column(table, "at")[is_in_body, 2] += foam.raised * foam.volume / (own_volume + foam.volume)
    if hull.air == 0.0:
        return
    for body, volume in (_air_in_chambers if hull.chambers else _air_in_foam)(place, hull).items():
        is_in_body = table[:, 0] == number[body]
        piece_volumes = table[is_in_body, COLUMNS["volume"][0]]
        if hull.chambers:
            _check_hollow(place, body, volume, piece_volumes.sum())
        kind = FRONT if body in place.trunk[1:] else REAR
        table[is_in_body, COLUMNS["air"][0] + kind] = volume * piece_volumes / piece_volumes.sum()


def _air_in_foam(robot_layout: Layout, hull: Hull) -> dict[str, float]:
    """Return the volume of air in each segment of the axis, in proportion to its foam [m3].

    A bladder of air takes the place of foam; a hull has at most one foam for each body.

    Args:
        robot_layout: layout of the robot.
        hull: hull of the robot.

    Raises:
        InvalidDesign: there is more air than foam on the axis.
    """
    segment_names = {segment.name for segment in robot_layout.robot.axis}
    foam_volumes = {foam.body: foam.volume for foam in hull.foam if foam.body in segment_names}
    total_foam = sum(foam_volumes.values())
    if hull.air > total_foam + 1e-12:
        raise InvalidDesign(
            f"hull.air is {1e3 * hull.air:g} l and the foam on the axis is {1e3 * total_foam:.3g} l; at "
            "most all of it can be a bladder: add foam or take less air."
        )
    return {body: hull.air * volume / total_foam for body, volume in foam_volumes.items()}


def _air_in_chambers(robot_layout: Layout, hull: Hull) -> dict[str, float]:
    """Return the volume of air in the body of each chamber [m3]."""
    segment_names = [segment.name for segment in robot_layout.robot.axis]
    for chamber in hull.chambers:
        if chamber.body not in segment_names:
            raise InvalidDesign(
                f"hull.chambers has one in {str(chamber.body)[:40]!r}, and the axis of robot "
                f"{robot_layout.robot.name!r} has no such body; it has {', '.join(segment_names)}."
            )
    return {chamber.body: hull.air * chamber.share for chamber in hull.chambers}


def _check_hollow(place: Layout, body: str, air: float, volume: float) -> None:
    """Refuse a chamber that is larger than the volume of its body, foam included, minus its solid parts.

    Args:
        place: layout of the robot.
        body: body that holds the chamber.
        air: volume of air in the chamber [m3].
        volume: volume of the body with its foam [m3].
    """
    max_air = max(volume - masses(place.robot)[body] / SOLID, 0.0)
    if air > max_air + 1e-12:
        raise InvalidDesign(
            f"the chamber in {body} of robot {place.robot.name!r} has {1e3 * air:.3g} l; it displaces "
            f"{1e3 * volume:.3g} l with its foam, of which at most {1e3 * max_air:.3g} l can be air: make the chamber "
            "smaller, or give the body more foam."
        )


def foam_centres(robot: Robot) -> dict[str, tuple[float, float, float]]:
    """Return the centre of the foam of each body that has some, in the frame of the body [m]."""
    place, table = layout(robot), pieces(robot)
    number = {body.name: i for i, body in enumerate(place.bodies)}
    centers = {}
    for foam in () if place.robot.hull is None else place.robot.hull.foam:
        body_pieces = table[table[:, 0] == number[foam.body]]
        x, y, z = np.average(column(body_pieces, "at"), axis=0, weights=column(body_pieces, "volume")[:, 0])
        centers[foam.body] = (float(x), float(y), float(z))
    return centers


def chambers(robot: Robot) -> tuple[float, float]:
    """Return the air in the front and in the rear chambers of a robot's hull [m3]; both 0 without."""
    front, rear = column(pieces(robot), "air").sum(axis=0)
    return float(front), float(rear)


def swell(body_pieces: Float[np.ndarray, "piece column"], factor: float) -> Float[np.ndarray, "piece column"]:
    """Return pieces of so many times their volume: sections thicker, balls larger.

    Args:
        body_pieces: some pieces.
        factor: on volume [-].
    """
    swollen_pieces = np.array(body_pieces)
    round_ = body_pieces[:, 1] == BALL
    lateral_scale = np.where(round_, factor ** (1 / 3), factor**0.5)[:, None]
    axial_scale = np.where(round_, factor ** (1 / 3), 1.0)[:, None]
    column(swollen_pieces, "volume")[:] *= factor
    column(swollen_pieces, "half")[:] *= np.hstack([lateral_scale, lateral_scale, axial_scale])
    column(swollen_pieces, "added")[:] *= lateral_scale**2 * axial_scale
    column(swollen_pieces, "area")[:] *= lateral_scale * np.where(round_[:, None], lateral_scale, 1.0)
    column(swollen_pieces, "skin")[:] *= lateral_scale * np.where(round_[:, None], lateral_scale, 1.0)
    column(swollen_pieces, "end")[:] *= lateral_scale**2
    column(swollen_pieces, "roll")[:] *= lateral_scale**4
    column(swollen_pieces, "shed")[:] *= lateral_scale**2
    return swollen_pieces
