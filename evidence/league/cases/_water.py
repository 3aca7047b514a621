"""What is not known of the water around a swimmer, by one rule for all of them.

The rule, with the reason of each number, stands in docs/water_evidence.md, "The form of a body".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from evidence import store
from evidence.league import Given, Numbers
from suchus.core.water_table import column
from suchus.robot.design import BodyForm, Robot
from suchus.robot.design.pieces import pieces
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait
from suchus.swimming.water import Outline, cycle, recoil
from suchus.swimming.water.form_drag import HEAD_DRAG, LIMB_DRAG, form_drag, friction_ends
from suchus.swimming.water.sections import ASPECTS, KEULEGANS, STOKES, attached_coefficients, coefficients

BLOCK_HEAD = (0.5, 0.3, 0.8)
"""Drag coefficient of a block with rounded edges, over its section, with its range [-]."""
MAX_SWIMMING_FRICTION = 1.9
"""Greatest friction of a swimming fish over that of the same fish held straight [-]."""
MAX_LAMINAR_REYNOLDS = 5e5
"""Reynolds number of the length beyond which ``Water.friction`` is that of a turbulent plate [-]."""
STEADY_DRAG = ((0.0, 1.98), (0.5, 1.6), (1.0, 1.17))
"""Width over height of a section across a steady stream, and its drag coefficient by height [-]."""
_MARGIN = 0.1
"""What is added to each end of the range of drag across [-]."""
_TAIL = 0.8
"""Where the tail begins whose height over width counts [body length]."""
_SHED_KC = (4.0, 0.0)
"""Rows of the table of shedding that count: KC, and 0 for a constant angle [-]."""
DENSITY = 998.0
"""Most likely density of fresh water [kg/m3]."""
_STATIONS = 65
_FORM = 'docs/water_evidence.md, "The form of a body"'


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownSwim:
    """What is known of a swim before it is predicted, for the ranges of its water."""

    robot: Robot
    """Body."""
    gait: Gait
    """Gait, at its frequency."""
    wavelength: float
    """Length of the body wave [body length]."""
    swing: float | None = None
    """Way of the tail from side to side, where it was filmed [body length]; None for that of the free body."""
    viscosity: float = 1e-6
    """Kinematic viscosity [m2/s]."""
    head: tuple[float, float, float] = HEAD_DRAG
    """Drag coefficient of the head with its range [-]."""
    tail_aspect: tuple[float, float] | None = None
    """Least and greatest height over width of the tail where the body's outline does not say it [-]."""

    @property
    def wave_speed(self) -> float:
        """Speed of the body wave [m/s]."""
        return self.gait.frequency * self.wavelength * self.robot.length


class Estimate(NamedTuple):
    """A coefficient with its range."""

    value: float
    """Value [-]."""
    low: float
    """Least [-]."""
    high: float
    """Greatest [-]."""


def fresh(swim: KnownSwim) -> dict[str, Given]:
    """Return the numbers of the water and of its force on sections and on the form of a body."""
    edge, taper = shed_shares(swim, store.load("shedding").values["rows"])
    ratio = turbulence_ratio(swim)
    high = max(MAX_SWIMMING_FRICTION, ratio)
    why_rub = "1.9 times was measured on swimming fish (Anderson, McGillis and Grosenbaugh 2001, J. Exp. Biol. 204, 81)"
    found = {
        "density": Given(value=DENSITY, low=997.0, high=1000.0, unit="kg/m3", source="fresh water at 15 to 25 C"),
        "viscosity": Given(value=1.0e-6, low=0.9e-6, high=1.15e-6, unit="m2/s", source="fresh water at 15 to 25 C"),
        "cross_drag": _given(
            drag_across(swim), "between a steady section of its proportions (Hoerner 1965, chapter 3; Delany and "
            f"Sorensen 1953, NACA TN 3038) and one that oscillates in water at rest (results/sections.json): {_FORM}"
        ),
        "thickening": _given(
            Estimate(sqrt(high), 1.0, high),
            f"1 is a laminar plate; {why_rub}; turbulent over laminar friction at the wave's speed is {ratio:.2g} "
            "(ITTC 1957)",
        ),
        "head": _given(Estimate(*swim.head), "over the greatest section: a streamlined nose 0.05 to 0.2, a block with "
                       "rounded edges 0.3 to 0.8, Hoerner 1965, Fluid-Dynamic Drag, chapter 3"),
        "base": _given(base_drag(swim), "of the blunt end over the section of the last strip, by laminar and turbulent "
                       "friction ahead of it, Hoerner 1965, chapter 3"),
        "edge": _given(edge, f"share of the momentum of the last strip that is shed: results/shedding.json, {_FORM}"),
        "taper": _given(taper, "share of the momentum that is lost where the rear half tapers: results/shedding.json, "
                        f"pointed ends, {_FORM}"),
        "added_mass": Given(
            value=1.0, low=0.7, high=1.3, unit="-",
            source="no measurement of this body; range of the model: sections of finite length and close to the "
            "surface have less added mass than in ideal water, those that oscillate far have more (docs/amphibious.md)",
        ),
    }  # fmt: skip
    if swim.robot.girdles:
        found["limbs"] = _given(Estimate(*LIMB_DRAG), "of a limb folded back along the body, over its section: a rod "
                                "along the stream with a round nose to flat ends, Hoerner 1965, chapter 3")  # fmt: skip
    return found


def form_of(numbers: Numbers) -> BodyForm:
    """Return the form of a body that the numbers of ``fresh`` say."""
    return BodyForm(
        head_drag=numbers["head"], base_drag=numbers["base"], limb_drag=numbers.get("limbs", 0.0),
        edge_shedding=numbers["edge"], taper_shedding=numbers["taper"],
    )  # fmt: skip


def turbulence_ratio(swim: KnownSwim) -> float:
    """Return turbulent over laminar friction of a plate at the speed of the body wave [-].

    Beyond ``MAX_LAMINAR_REYNOLDS`` the friction of ``Water`` is turbulent itself, so that no factor makes up for it.
    """
    speed = min(swim.wave_speed, MAX_LAMINAR_REYNOLDS * swim.viscosity / swim.robot.length)
    ends = friction_ends(speed, swim.robot.length, swim.viscosity)
    return ends.turbulent / ends.laminar


def base_drag(swim: KnownSwim) -> Estimate:
    """Return the drag coefficient of the blunt end, over the section of the last strip."""
    area = form_drag(swim.robot, swim.wave_speed, Water(viscosity=swim.viscosity)).base
    half_width, half_height = _last_strip(swim.robot)
    return Estimate(*(end / (pi * half_width * half_height) for end in area))


def drag_across(swim: KnownSwim) -> Estimate:
    """Return the drag coefficient across: between a section in a steady stream and one that oscillates at rest."""
    outline = Outline(swim.robot, _STATIONS)
    curve = cycle(outline, swim.gait, *recoil(outline, swim.gait, 0.0, Water()))
    amplitude = 0.5 * np.ptp(curve.y, axis=0)
    if swim.swing is not None:
        amplitude = amplitude * 0.5 * swim.swing * swim.robot.length / amplitude[-1]
    half_width, half_height = outline.silhouette
    solid = (half_width > 1e-6 * swim.robot.length) & (half_height > 1e-6 * swim.robot.length)
    width, height, reach = half_width[solid], half_height[solid], amplitude[solid]
    ratios, drags = (list(numbers) for numbers in zip(*STEADY_DRAG, strict=True))
    steady = np.interp(width / height, ratios, drags)
    oscillating = [_oscillating_drag(swim, *section) for section in zip(width, height, reach, strict=True)]
    means = [float(np.average(drag, weights=height * reach**3)) for drag in (steady, oscillating)]
    low, high = (1.0 - _MARGIN) * min(means), (1.0 + _MARGIN) * max(means)
    return Estimate(sqrt(means[0] * means[1]), low, high)


def _oscillating_drag(swim: KnownSwim, half_width: float, half_height: float, amplitude: float) -> float:
    """Return the drag coefficient of a section that oscillates in water at rest, with a layer of its own."""
    aspect = float(np.clip(half_height / half_width, ASPECTS[0], ASPECTS[-1]))
    keulegan = float(np.clip(pi * amplitude / half_height, KEULEGANS[0], KEULEGANS[-1]))
    stokes = max(swim.gait.frequency * (2.0 * half_height) ** 2 / swim.viscosity, STOKES)
    layers = [attached_coefficients(keulegan, number)[0] for number in (STOKES, stokes)]
    return max(coefficients(aspect, keulegan)[0] - layers[0] + layers[1], 0.0)


def shed_shares(swim: KnownSwim, rows: Sequence[Mapping[str, Any]]) -> tuple[Estimate, Estimate]:
    """Return the shares that the last strip sheds of its momentum, and tapering strips of what they lose.

    Args:
        swim: body and gait.
        rows: of the table of shedding, see ``evidence.shedding.table``.
    """
    outline = Outline(swim.robot, _STATIONS)
    half_width, half_height = outline.silhouette
    tail = (outline.s >= _TAIL * swim.robot.length) & (half_width > 1e-6 * swim.robot.length)
    aspect = float(np.mean(half_height[tail] / half_width[tail]))
    aspects = swim.tail_aspect or (aspect, aspect)
    square, taper = (share_of(rows, end, aspects) for end in ("square", "pointed"))
    blunt = min(float(half_height[-1]) / _last_strip(swim.robot)[1], 1.0) ** 2
    edge = (blunt * a + (1.0 - blunt) * b for a, b in zip(square, taper, strict=True))
    return Estimate(*edge), taper


def share_of(rows: Sequence[Mapping[str, Any]], end: str, aspects: tuple[float, float]) -> Estimate:
    """Return the share that an end sheds, over heights over width and the rows that count.

    Beyond the heights over width of the table the nearest stands.

    Args:
        rows: of the table of shedding.
        end: shape of the end, one of ``evidence.shedding.ENDS``.
        aspects: least and greatest height over width [-].
    """
    values: list[float] = []
    lows: list[float] = []
    highs: list[float] = []
    for keulegan in _SHED_KC:
        line = sorted(
            (row for row in rows if row["end"] == end and row["kc"] == keulegan), key=lambda row: row["aspect"]
        )
        nodes = np.log([row["aspect"] for row in line])
        for aspect in aspects:
            for ends, name in ((values, "share"), (lows, "low"), (highs, "high")):
                ends.append(float(np.interp(np.log(aspect), nodes, [row[name] for row in line])))
    return Estimate(float(np.mean(values)), max(min(lows), 0.0), max(highs))


def _last_strip(robot: Robot) -> tuple[float, float]:
    """Return half width and half height of the last strip of the axis [m]."""
    table = pieces(robot)
    row = int(np.flatnonzero(column(table, "shed")[:, 0] > 0.0)[-1])
    half = column(table, "half")[row]
    return float(half[0]), float(half[1])


def _given(estimate: Estimate, source: str) -> Given:
    return Given(value=estimate.value, low=estimate.low, high=estimate.high, unit="-", source=source)
