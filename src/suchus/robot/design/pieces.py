"""A robot in pieces for the water: strips of its axis, sections of its limbs and balls for feet, in a table.

The table's columns are those of ``hydro.table``; bodies are numbered as in ``design.layout``.
"""

from functools import lru_cache
from math import ceil, hypot, pi, sqrt

import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign
from suchus.robot.design.body import Robot
from suchus.robot.design.hull import Hull
from suchus.robot.design.layout import Layout, LimbPlace, layout
from suchus.robot.design.profile import profile, stations
from suchus.robot.design.water_table import BALL, COLUMNS, DISC, WIDTH, column

FINENESS = 20
"""Strips of an axis at least [-]; see docs/amphibious.md for what finer ones change."""
_WITHIN = 24
"""Stations within a strip over which its section is averaged [-]."""
_BONES = 2
"""Sections of each link of a limb [-]."""
_NOSE = 0.1
"""Drag coefficient of the front, over the greatest section [-]; streamlined noses have 0.05 to 0.2."""
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
    found = {segment.name: sum(shape.mass for shape in segment.shapes) for segment in place.robot.axis}
    for limb in place.limbs:
        design = limb.girdle.limb
        for link in design.links:
            found[f"{limb.name}_{link.name}"] = link.mass
        found[f"{limb.name}_{design.links[-1].name}"] += design.foot.mass
    return found


def _row(**parts: float | tuple[float, ...] | np.ndarray) -> np.ndarray:
    row = np.zeros(WIDTH)
    for name, values in parts.items():
        row[slice(*COLUMNS[name])] = values
    return row


def _strips(place: Layout) -> list[np.ndarray]:
    """Return strips of the axis, from head to tail."""
    robot, found = place.robot, []
    number = {body.name: i for i, body in enumerate(place.bodies)}
    for segment, (start, end) in zip(robot.axis, stations(robot), strict=True):
        count = max(1, ceil((end - start) / robot.length * FINENESS - 1e-9))
        long = (end - start) / count
        s = start + long * (np.arange(count * _WITHIN) + 0.5) / _WITHIN
        part = [values.reshape(count, _WITHIN) for values in profile(robot, s)]
        shift = place.bodies[number[segment.name]].shift
        for i, (wide, high, area, middle) in enumerate(zip(*part, strict=True)):
            x = shift + segment.front - (i + 0.5) * long
            found.append(_strip(number[segment.name], x, long, (wide, high, area, middle)))
    last = found[-1]
    a, b, c = last[slice(*COLUMNS["half"])]
    last[slice(*COLUMNS["shed"])], last[COLUMNS["shed_at"][0]] = (pi * b**2, pi * a**2), -c
    found[0][COLUMNS["end"][0]] = _NOSE * max(row[COLUMNS["volume"][0]] / (2 * row[16]) for row in found)
    return found


def _strip(body: int, x: float, long: float, part: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return an elliptic section with the mean area, and the proportions of the mean width and height."""
    wide, high, area, middle = part
    volume = float(area.mean()) * long
    scale = sqrt(float(area.mean()) / (pi * float(wide.mean()) * float(high.mean())))
    half = scale * float(wide.mean()), scale * float(high.mean()), long / 2
    at = x, 0.0, float(np.average(middle, weights=area))
    return _disc(body, at, ((0, 1, 0), (0, 0, 1), (1, 0, 0)), half, volume)


def _disc(
    body: int,
    at: tuple[float, float, float] | np.ndarray,
    axes: tuple[tuple[float, ...] | np.ndarray, ...],
    half: tuple[float, float, float],
    volume: float,
) -> np.ndarray:
    """Return an elliptic section: added mass of potential flow, girth of an ellipse after Ramanujan."""
    a, b, c = half
    girth = pi * (3 * (a + b) - sqrt((3 * a + b) * (a + 3 * b)))
    return _row(
        body=body,
        kind=DISC,
        at=at,
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


def ball(body: int, at: tuple[float, float, float] | np.ndarray, radius: float) -> np.ndarray:
    """Return a sphere as a piece: half its volume of added mass, drag of a sphere."""
    volume = 4 / 3 * pi * radius**3
    area = _BALL_DRAG * pi * radius**2
    return _row(
        body=body, kind=BALL, at=at, across=(0, 1, 0), upward=(0, 0, 1), forward=(1, 0, 0), half=3 * (radius,),
        volume=volume, added=3 * (volume / 2,), area=(area, area), end=0.47 * pi * radius**2,
    )  # fmt: skip


def _limb(limb: LimbPlace) -> list[np.ndarray]:
    """Return the sections of a limb's links, and its foot."""
    design, found = limb.girdle.limb, []
    first = limb.tip - len(design.links) + 1
    for i, link in enumerate(design.links):
        end = np.array([link.end[0], limb.side * link.end[1], link.end[2]])
        forward = end / link.length
        across = np.cross(forward, (0, 0, 1) if abs(forward[2]) < 0.9 else (1, 0, 0))
        across /= hypot(*across)
        axes = across, np.cross(forward, across), forward
        last = i == len(design.links) - 1
        inside = sqrt(max(design.foot.radius**2 - link.radius**2, 0.0)) if last else 0.0
        long = max(link.length - inside, 1e-6) / _BONES
        for k in range(_BONES):
            half = link.radius, link.radius, long / 2
            found.append(_disc(first + i, (k + 0.5) * long * forward, axes, half, pi * link.radius**2 * long))
        if last:
            found.append(ball(first + i, end, design.foot.radius))
    return found


def _dress(place: Layout, table: np.ndarray, hull: Hull) -> None:
    """Let every body swell to the volume that it has with its foam, and lift it as far as the foam's centre says."""
    number = {body.name: i for i, body in enumerate(place.bodies)}
    for foam in hull.foam:
        if foam.body not in number:
            raise InvalidDesign(
                f"hull.foam is on {foam.body!r}, and robot {place.robot.name!r} has no such body; it has "
                f"{', '.join(number)}."
            )
        mine = table[:, 0] == number[foam.body]
        part = table[mine]
        own = part[:, COLUMNS["volume"][0]].sum()
        factor = 1.0 + foam.volume / own
        table[mine] = swollen(part, factor)
        column(table, "at")[mine, 2] += foam.raised * foam.volume / (own + foam.volume)
    if hull.air == 0.0:
        return
    for body, volume in (_given if hull.chambers else _in_foam)(place, hull).items():
        mine = table[:, 0] == number[body]
        here = table[mine, COLUMNS["volume"][0]]
        if hull.chambers:
            _check_hollow(place, body, volume, here.sum())
        kind = FRONT if body in place.trunk[1:] else REAR
        table[mine, COLUMNS["air"][0] + kind] = volume * here / here.sum()


def _in_foam(place: Layout, hull: Hull) -> dict[str, float]:
    """Return the air in each body of the axis, in proportion to its foam [m3]."""
    axis = {segment.name for segment in place.robot.axis}
    on_axis = {foam.body: foam.volume for foam in hull.foam if foam.body in axis}
    total = sum(on_axis.values())
    if hull.air > total + 1e-12:
        raise InvalidDesign(
            f"hull.air is {1e3 * hull.air:g} l and the foam on the axis is {1e3 * total:.3g} l; at "
            "most all of it can be a bladder: add foam or take less air."
        )
    return {body: hull.air * volume / total for body, volume in on_axis.items()}


def _given(place: Layout, hull: Hull) -> dict[str, float]:
    """Return the air in each chamber [m3]."""
    axis = [segment.name for segment in place.robot.axis]
    for chamber in hull.chambers:
        if chamber.body not in axis:
            raise InvalidDesign(
                f"hull.chambers has one in {str(chamber.body)[:40]!r}, and the axis of robot {place.robot.name!r} has "
                f"no such body; it has {', '.join(axis)}."
            )
    return {chamber.body: hull.air * chamber.share for chamber in hull.chambers}


def _check_hollow(place: Layout, body: str, air: float, volume: float) -> None:
    """Refuse a chamber larger than what a body displaces, foam included, beside what is solid in it."""
    most = max(volume - masses(place.robot)[body] / SOLID, 0.0)
    if air > most + 1e-12:
        raise InvalidDesign(
            f"the chamber in {body} of robot {place.robot.name!r} has {1e3 * air:.3g} l; it displaces "
            f"{1e3 * volume:.3g} l with its foam, of which at most {1e3 * most:.3g} l can be air: make the chamber "
            "smaller, or give the body more foam."
        )


def foam_centres(robot: Robot) -> dict[str, tuple[float, float, float]]:
    """Return where the centre of the foam of each body is that has some, in the frame of that body [m]."""
    place, table = layout(robot), pieces(robot)
    number = {body.name: i for i, body in enumerate(place.bodies)}
    found = {}
    for foam in () if place.robot.hull is None else place.robot.hull.foam:
        mine = table[table[:, 0] == number[foam.body]]
        x, y, z = np.average(column(mine, "at"), axis=0, weights=column(mine, "volume")[:, 0])
        found[foam.body] = (float(x), float(y), float(z))
    return found


def chambers(robot: Robot) -> tuple[float, float]:
    """Return the air in the front and in the rear chambers of a robot's hull [m3]; both 0 without."""
    front, rear = column(pieces(robot), "air").sum(axis=0)
    return float(front), float(rear)


def swollen(part: Float[np.ndarray, "piece column"], factor: float) -> Float[np.ndarray, "piece column"]:
    """Return pieces of so many times their volume: sections thicker, balls larger.

    Args:
        part: some pieces.
        factor: on volume [-].
    """
    out = np.array(part)
    round_ = part[:, 1] == BALL
    across = np.where(round_, factor ** (1 / 3), factor**0.5)[:, None]
    along = np.where(round_, factor ** (1 / 3), 1.0)[:, None]
    column(out, "volume")[:] *= factor
    column(out, "half")[:] *= np.hstack([across, across, along])
    column(out, "added")[:] *= across**2 * along
    column(out, "area")[:] *= across * np.where(round_[:, None], across, 1.0)
    column(out, "skin")[:] *= across * np.where(round_[:, None], across, 1.0)
    column(out, "end")[:] *= across**2
    column(out, "roll")[:] *= across**4
    column(out, "shed")[:] *= across**2
    return out
