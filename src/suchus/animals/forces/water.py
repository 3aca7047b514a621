"""Force and power of the water on a body that swims as it was filmed: by sections, in a slice, in space.

On every rung the same happens: the joints follow the first harmonics of the film, nothing else holds the body, which is
as heavy as the water that it displaces, in the plane, deep below the surface, its limbs left out. Speed, sway and
turning are what the water makes of it, so that the speed can be held against the film's.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Complex, Float

from suchus import flow
from suchus.animals.capture import UnusableTracks, Walk
from suchus.animals.capture.strides import PHASES
from suchus.animals.forces.body import (
    RUNGS,
    Quantities,
    Rung,
    Unknown,
    choices,
    errors,
    even,
    middle,
    put,
    sized,
    unsure,
    widened,
)
from suchus.core.errors import UnknownName
from suchus.core.progress import Progress, portion, silent
from suchus.flow.immerse import THINNEST
from suchus.flow.setup import LAYER_CELLS
from suchus.robot.design import Robot, check_needs, layout
from suchus.robot.design.physics import WATER_DENSITY
from suchus.robot.design.pieces import volumes
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait, swimming_gait
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.motion.swim import lateral_servos
from suchus.sim.land.lake import Lake
from suchus.sim.land.prescribed import free_sections
from suchus.sim.metrics import SIMILARITY, swim_numbers
from suchus.swimming.water import Outline, cycle, displaced, recoil, undulation
from suchus.swimming.water.setting import SwimSetting
from suchus.swimming.water.swim_setup import ResolvedSwim

THICK = "sections, thick water"
"""Name of the sections in water as thick as that of the flows, beside which these stand."""
CELLS = {"slice": 80, "space": 64}
"""Cells per body length of the flows [-], more where a body is so thin that these do not show it."""
CYCLES, FLOW_CYCLES = 8, 5
"""Cycles from rest by sections, and in a flow; the last one is looked at [-]."""
_KINDS = (("thrust", "N", "force of the water, forward"), ("aside", "N", "force of the water, to the right"),
          ("power", "W", "power of the body on the water"))  # fmt: skip
_LEAST_BEND = 0.5  # share of the midline over which bends must be seen


class _Swum(NamedTuple):
    """One swim: its last cycle."""

    force: Float[np.ndarray, "kind phase"]  # thrust, aside [N], power [W]
    speed: float  # [m/s]


def swum_forces(
    walk: Walk,
    robot: Robot,
    *,
    rungs: Sequence[Rung] = RUNGS,
    unknown: Unknown | None = None,
    length: float | None = None,
    cells: Mapping[str, int] | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Return force and power of the water on an animal that swims as it was filmed, with intervals, rung by rung.

    Intervals are those of the sections, over choices of each bend within its interval and of what the film does not
    show from its range. A flow, which is computed once, gets the same in proportion to the size of its forces.

    Args:
        walk: what was measured of the swim: bends along the midline.
        robot: whose body it is, with an axis that bends.
        rungs: which models of the water are asked.
        unknown: the ranges of what the film does not show; with a mass the body gets the volume of so much water.
        length: the animal's, where the film does not show it [m].
        cells: per body length of the flows, by rung; ``CELLS`` if None [-].
        progress: told the share that is done.

    Returns:
        Over ``rung`` and ``phase``, the phase of the walk's own tables: ``thrust`` forward, ``aside`` to the right [N],
        ``power`` of the body on the water [W], each with ``_low`` and ``_high``; over ``rung`` ``speed`` [m/s] and what
        stands out; over ``quantity`` what is alike on all rungs.

    Raises:
        UnsuitedRobot: the robot's axis does not bend.
        UnknownName: a rung that there is not.
        UnusableTracks: too few cycles or bends were seen, or the size is unknown.
        InvalidDesign: the body is too thin for the grid of a flow.
        Diverged: a flow diverged.
    """
    check_needs(robot, ("axis",), "forces of a filmed swim")
    for rung in rungs:
        if rung not in RUNGS:
            raise UnknownName("rung of the water", rung, RUNGS)
    unsure(walk)
    unknown = unknown or Unknown()
    _check_bends(walk)
    body = sized(robot, _long(walk, length) / robot.length)
    body = body if unknown.mass is None else widened(body, middle(unknown.mass) / WATER_DENSITY)
    seen = _Bends(walk, body)
    names = (*seen.unsure, "cross_drag", "thickening", "added_mass", "shedding", "viscosity")
    likely = dict.fromkeys(names, 0.5)
    all_shares = [likely, *choices(names, unknown.draws)]
    gaits = [seen.gait(shares) for shares in all_shares]
    solved = [rung for rung in rungs if rung != "sections"]
    finer = {rung: _cells(body, rung) for rung in solved} | dict(cells or {})
    thick = {rung: _viscosity(body, gaits[0], finer[rung]) for rung in solved}
    work = 1 + len(solved) * 4
    found: dict[str, list[_Swum]] = {"sections": []}
    for i, (gait, shares) in enumerate(zip(gaits, all_shares, strict=True)):
        portion(progress, 0, work)("sections", i / len(gaits))
        found["sections"].append(_by_sections(body, gait, _lake(body, unknown, shares)))
    if solved:
        water = Water(viscosity=max(thick.values()), cross_drag=middle(unknown.cross_drag), thickening=1.0)
        lake = replace(_lake(body, unknown, likely), water=water)
        found[THICK] = [_by_sections(body, gaits[0], lake)]
    for number, rung in enumerate(solved):
        part = portion(progress, 1 + 4 * number, work)
        found[rung] = [_by_flow(body, gaits[0], rung, finer[rung], max(thick.values()), part)]
    order = [name for name in ("sections", THICK, "slice", "space") if name in found]
    if "sections" not in rungs:
        order.remove("sections")
    data = _told(walk, body, gaits[0], {name: _spread(found[name], found["sections"]) for name in order})
    data.attrs["gait_frequency"] = gaits[0].frequency
    notes = [*seen.notes, *_left_open(body, max(thick.values(), default=0.0), unknown)]
    return data.assign_attrs(
        title=f"forces of the water on the animal of {walk.source}", medium="water", body=robot.name,
        notes="\n".join(notes),
    )  # fmt: skip


def swim_gait(walk: Walk, robot: Robot) -> Gait:
    """Return the swim of a robot whose joints follow the first harmonics of a film, limbs folded back.

    Args:
        walk: what was measured.
        robot: who is to swim so.

    Raises:
        UnusableTracks: too few bends were seen.
    """
    seen = _Bends(walk, robot)
    return seen.gait(dict.fromkeys(seen.unsure, 0.5))


def _long(walk: Walk, length: float | None) -> float:
    """Return how long the animal is [m]."""
    if length is not None:
        if not 0.0 < length < np.inf:
            raise UnusableTracks(f"the animal is {length:g} m long; a length above 0 is needed.")
        return length
    long = _midline(walk)
    if long is None:
        raise UnusableTracks(
            f"{walk.source} is in pixels, which do not show how long the animal is: give its whole length, as in "
            "--length 0.4."
        )
    return long


def _midline(walk: Walk) -> float | None:
    """Return the length of the midline from its first keypoint to its last [m]; None where its unit is unknown."""
    if "curvature" not in walk.phases or walk.phases.curvature.attrs["units"] != "1/m":
        return None
    places = np.concatenate([[0.0], walk.phases.place.values, [1.0]])
    return float(np.nanmedian(2.0 * _arms(walk) / (places[2:] - places[:-2])))


def _arms(walk: Walk) -> Float[np.ndarray, " place"]:
    """Return half of the length of the two segments beside each keypoint, by which curvature becomes a bend."""
    curvature, bend = walk.phases.curvature.values, walk.phases.bend.values
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.nanmedian(np.where(np.abs(curvature) > 0.0, bend / curvature, np.nan), axis=1))


def _check_bends(walk: Walk) -> None:
    """Refuse a film that does not show how a body bends."""
    if "bend" not in walk.phases or walk.phases.bend.attrs["long_name"].endswith("down positive"):
        raise UnusableTracks(
            f"{walk.source} does not show how the body bends to the sides: at least three keypoints of the midline, "
            "filmed from above, are needed."
        )
    front, rear = float(walk.phases.place[0]), float(walk.phases.place[-1])
    if rear - front < _LEAST_BEND:
        raise UnusableTracks(
            f"{walk.source} shows bends from {front:.2f} to {rear:.2f} of the midline; at least half of it is needed: "
            "track more keypoints from snout to tail tip."
        )


class _Bends:
    """The bends of a midline as those of a body's joints."""

    def __init__(self, walk: Walk, body: Robot) -> None:
        _check_bends(walk)
        phases, self._body, self._period = walk.phases, body, walk.numbers["period"]
        turn = np.exp(-2j * np.pi * phases.phase.values)
        bend = np.nan_to_num(phases.bend.values)
        self._first: Complex[np.ndarray, " place"] = -2.0 * (bend * turn).mean(axis=1)  # left positive
        wide = np.nan_to_num(phases.curvature_high.values - phases.curvature_low.values) / 2
        self._error = np.sqrt(np.mean(wide**2, axis=1)) * np.nan_to_num(_arms(walk))
        self._places, self._names = phases.place.values, [str(name) for name in phases.keypoint.values]
        self.unsure = ("period", *(f"{part} {name}" for name in self._names for part in ("cosine", "sine")))
        left = bend + (self._first[:, None] * np.conj(turn)).real
        over = float(np.sqrt((left - left.mean(axis=1, keepdims=True)).var() / max(bend.var(), 1e-300)))
        self.notes = (f"overtones, {100 * over:.0f} % of the bends, and bends to one side on average are left out",)

    def gait(self, shares: Mapping[str, float]) -> Gait:
        """Return the swim at shares of the distributions of period and bends."""
        period = self._period.value + self._period.error * errors(shares["period"])
        off = np.array([
            errors(shares[f"cosine {name}"]) - 1j * errors(shares[f"sine {name}"]) for name in self._names
        ])  # fmt: skip
        first = self._first + self._error * off
        hinges, servos = yaw_hinges(self._body), layout(self._body).servos
        each = _shared(first, self._places, hinges.places)
        lateral = lateral_servos(self._body)
        whole = [sum(each[k] for k in range(len(each)) if servos[hinges.servos[k]] == name) for name in lateral]
        return swimming_gait(
            self._body,
            name="filmed",
            frequency=1.0 / period,
            amplitude=[min(abs(one), 3.1415) for one in whole],
            lag=[-float(np.angle(one)) / (2 * np.pi) for one in whole],
        )


def _shared(
    first: Complex[np.ndarray, " place"], places: Float[np.ndarray, " place"], hinges: Sequence[float]
) -> list[complex]:
    """Return the bend of each hinge: that of the midline halfway to its neighbours.

    Between keypoints a midline is evenly curved: each keypoint's bend is that of the halves of the segments beside it.

    Args:
        first: harmonics of the bends at keypoints [rad].
        places: of the keypoints along the midline, 0 to 1 [-].
        hinges: places of the hinges along the body, 0 to 1 [-].
    """
    ends = np.concatenate([[0.0], places, [1.0]])
    middles = (ends[1:] + ends[:-1]) / 2
    turned = np.concatenate([[0.0], np.cumsum(first)])
    at = np.asarray(hinges)
    edges = np.concatenate([[0.0], (at[1:] + at[:-1]) / 2, [1.0]])
    direction = np.interp(edges, middles, turned.real) + 1j * np.interp(edges, middles, turned.imag)
    return [complex(one) for one in np.diff(direction)]


def _lake(body: Robot, unknown: Unknown, shares: Mapping[str, float]) -> Lake:
    chosen = {name: even(getattr(unknown, name), shares[name])
              for name in ("cross_drag", "thickening", "added_mass", "shedding", "viscosity")}  # fmt: skip
    water = Water(
        viscosity=chosen["viscosity"], cross_drag=chosen["cross_drag"], thickening=chosen["thickening"]
    )  # fmt: skip
    return Lake(
        level=2 * body.length, water=water, added_mass=chosen["added_mass"], shedding=chosen["shedding"]
    )  # fmt: skip


def _by_sections(body: Robot, gait: Gait, lake: Lake) -> _Swum:
    swum = free_sections(body, gait, lake, CYCLES)
    rows = [_even(swum.phase.values, swum[f"last_{name}"].values) for name, _, _ in _KINDS]
    return _Swum(np.array(rows), float(swum.speed[-1]))


def _even(phase: np.ndarray, values: np.ndarray) -> np.ndarray:
    return np.interp(np.arange(PHASES) / PHASES, phase, values, period=1.0)


def _viscosity(body: Robot, gait: Gait, cells: int) -> float:
    """Return the least viscosity with which a grid carries the boundary layer, and a hundredth more [m2/s]."""
    outline = Outline(body, cells + 1)
    motion = undulation(outline, gait)
    curve = cycle(outline, motion, *recoil(outline, motion, 0.0, Water()))
    speed = float(np.hypot(curve.x_rate, curve.y_rate).max())
    return 1.01 * speed * (LAYER_CELLS * body.length / cells) ** 2 / body.length


def _cells(body: Robot, rung: str) -> int:
    """Return the cells per body length of a flow: as many as show the body, in a slice as it is thickened."""
    wide, _ = Outline(body, 65).silhouette
    needed = 1.02 * THINNEST * body.length / (2.0 * float(np.max(wide)))
    return CELLS[rung] if rung == "slice" else max(CELLS[rung], int(np.ceil(needed)))


def _by_flow(body: Robot, gait: Gait, rung: str, cells: int, viscosity: float, progress: Progress) -> _Swum:
    """Return a swim in a flow; that of a slice as deep as it displaces what the body does."""
    outline = Outline(body, cells + 1)
    blunt = 1.75 if rung == "slice" else 0.0
    setting = SwimSetting(
        axes=2 if rung == "slice" else 3, cells=cells, viscosity=viscosity, cycles=FLOW_CYCLES, blunt=blunt
    )
    swim = ResolvedSwim(robot=body, motion=undulation(outline, gait), setting=setting)
    swim.check()
    sim = flow.Simulation(swim.setup)
    quarters = 4 * FLOW_CYCLES
    for i in range(quarters):
        sim.run((i + 1) * swim.end / quarters, progress=False)
        progress(rung, (i + 1) / quarters)
    series = sim.record.after(swim.end - 1.05 * swim.period)
    when = (series.time - 0.5 * series.step - swim.end + swim.period) / swim.period
    wide, _ = outline.silhouette
    deep = displaced(outline, 1.0) / float(np.trapezoid(2 * wide, outline.s)) if rung == "slice" else 1.0
    force = series.force()
    columns = (-force[:, 0], force[:, 1], series.column("power"))
    clock = (np.arange(PHASES) + 0.5) / PHASES
    rows = [deep * _even(clock, np.interp(clock, when, values)) for values in columns]
    last = series.time > swim.end - swim.period
    speed = -float(np.average(series.column("velocity_x")[last], weights=series.step[last]))
    return _Swum(np.array(rows), speed)


def _spread(mine: Sequence[_Swum], sections: Sequence[_Swum]) -> list[_Swum]:
    """Return answers that span the interval of a rung: its own, or the sections' in proportion to its size."""
    if len(mine) > 1:
        return list(mine)
    (one,) = mine
    size = np.abs(sections[0].force).max(axis=1, keepdims=True)
    scale = np.abs(one.force).max(axis=1, keepdims=True) / np.maximum(size, 1e-300)
    first = sections[0]
    pace = one.speed / first.speed if first.speed else 1.0
    return [
        _Swum(one.force + scale * (other.force - first.force), one.speed + pace * (other.speed - first.speed))
        for other in sections
    ]


def _told(walk: Walk, body: Robot, gait: Gait, found: Mapping[str, Sequence[_Swum]]) -> xr.Dataset:
    """Return forces and quantities of all rungs as one dataset."""
    data = xr.Dataset(
        coords={"phase": ("phase", np.arange(PHASES) / PHASES, {"units": "1"}), "rung": ("rung", list(found))}
    )
    forces = np.array([[one.force for one in row] for row in found.values()])  # rung answer kind phase
    speeds = np.array([[one.speed for one in row] for row in found.values()])
    for i, (name, unit, meaning) in enumerate(_KINDS):
        put(data, name, ("rung", "phase"), np.swapaxes(forces[:, :, i], 0, 1), (unit, meaning))
    put(data, "speed", ("rung",), speeds.T, ("m/s", "speed of the body that swims as was filmed"))
    put(data, "mean_power", ("rung",), forces[:, :, 2].mean(axis=-1).T, ("W", "mean power of the body on the water"))
    for name, i in (("peak_thrust", 0), ("peak_aside", 1)):
        put(
            data, name, ("rung",), np.abs(forces[:, :, i]).max(axis=-1).T, ("N", f"greatest {name[5:]}, to either side")
        )
    table = Quantities()
    displaces = WATER_DENSITY * sum(volumes(body).values())
    table.add("length", [body.length], "m", "of the body")
    table.add("displaced", [displaces], "kg", "water that the body displaces, and so its mass where it hovers")
    film = walk.numbers.get("speed")
    if film is not None and film.unit == "m/s":
        seen = [film.value + off for off in (0.0, -film.error, film.error)]
        table.add("speed_filmed", seen, "m/s", "of the trunk on the film")
        for rung, row in zip(found, speeds, strict=True):
            table.add(f"speed_to_filmed_{rung.replace(', ', '_').replace(' ', '_')}", list(row / film.value), "-",
                      f"speed over that filmed, {rung}")  # fmt: skip
    return data.merge(_numbers(body, gait, speeds[0], table).dataset())


def _numbers(body: Robot, gait: Gait, speeds: np.ndarray, table: Quantities) -> Quantities:
    """Add the numbers by which swims of other sizes are compared, in real water by the first rung."""
    outline, water = Outline(body, 65), Water()
    motion = undulation(outline, gait)
    swing = float(np.ptp(cycle(outline, motion, *recoil(outline, motion, 0.0, water)).y[:, -1]))
    each = [
        swim_numbers(
            speed=float(speed), length=body.length, frequency=gait.frequency, swing=swing, viscosity=water.viscosity
        )
        for speed in speeds
    ]
    for name, what in SIMILARITY.items():
        answers = list(dict.fromkeys(getattr(one, name) for one in each))
        table.add(name, answers, "-", f"{what}, in fresh water by the first model")
    return table


def _left_open(body: Robot, thick: float, unknown: Unknown) -> list[str]:
    """Say what cannot be known from the film, and what was taken instead."""
    notes = [
        f"sections, fins and limbs are not on the film: the body is that of {body.name}, its limbs left out",
        "the body swims deep below the surface, in a plane; near the surface waves take power, which is not in it",
    ]
    if unknown.mass is None:
        notes.append("the volume is the named body's at this length; with --mass it is that of so much water")
    if thick:
        notes.append(
            f"the flows are of water with {thick / Water().viscosity:.3g} times the viscosity, the least that their "
            f"grids carry; the sections stand beside them in the same water ({THICK})"
        )
        notes.append("a flow is computed once: its intervals are the sections', in proportion to its forces")
    return notes
