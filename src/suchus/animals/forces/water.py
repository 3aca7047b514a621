"""Force and power of the water on a body that swims as filmed: by the section model, in a slice, in space.

In every model the joints follow the first harmonics of the film. The body is free, as heavy as the water that it
displaces, in a plane deep below the surface, without limbs. Speed, sway and turning are results; the speed can be
compared with the film.
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
    add_with_interval,
    choices,
    errors,
    interpolate_bounds,
    middle,
    names_with_interval,
    resize_body,
    widen_body,
)
from suchus.core.errors import UnknownName
from suchus.core.physics import WATER_DENSITY
from suchus.core.progress import Progress, portion, silent
from suchus.flow.immerse import MIN_THICKNESS
from suchus.flow.setup import MIN_LAYER_CELLS
from suchus.robot.design import Robot, check_needs, layout
from suchus.robot.design.pieces import volumes
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait, swimming_gait
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.motion.swim import lateral_servos
from suchus.sim.land.lake import Lake
from suchus.sim.land.prescribed import free_sections
from suchus.sim.metrics import SIMILARITY, swim_numbers
from suchus.swimming.water import Outline, cycle, displaced_mass, recoil, undulation
from suchus.swimming.water.setting import SwimSetting
from suchus.swimming.water.swim_setup import ResolvedSwim

THICK_WATER = "sections, thick water"
"""Name of the sections in water as thick as that of the flows, beside which these stand."""
CELLS = {"slice": 80, "space": 64}
"""Cells per body length of the flows [-], more where a body is so thin that these do not show it."""
CYCLES, FLOW_CYCLES = 8, 5
"""Cycles from rest by sections, and in a flow; the last one is looked at [-]."""
_KINDS = (("thrust", "N", "force of the water, forward"), ("aside", "N", "force of the water, to the right"),
          ("power", "W", "power of the body on the water"))  # fmt: skip
_LEAST_BEND = 0.5  # share of the midline over which bends must be seen


class _SwimCycle(NamedTuple):
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
        robot: robot whose body it is, with an axis that bends.
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
    names_with_interval(walk)
    unknown = unknown or Unknown()
    _check_bends(walk)
    body = resize_body(robot, _body_length(walk, length) / robot.length)
    body = body if unknown.mass is None else widen_body(body, middle(unknown.mass) / WATER_DENSITY)
    bends = _Bends(walk, body)
    names = (*bends.uncertain_names, "cross_drag", "thickening", "added_mass", "shedding", "viscosity")
    likely = dict.fromkeys(names, 0.5)
    all_shares = [likely, *choices(names, unknown.draws)]
    gaits = [bends.gait(shares) for shares in all_shares]
    flow_rungs = [rung for rung in rungs if rung != "sections"]
    cells_by_rung = {rung: _cells(body, rung) for rung in flow_rungs} | dict(cells or {})
    viscosities = {rung: _viscosity(body, gaits[0], cells_by_rung[rung]) for rung in flow_rungs}
    work = 1 + len(flow_rungs) * 4
    swims: dict[str, list[_SwimCycle]] = {"sections": []}
    for i, (gait, shares) in enumerate(zip(gaits, all_shares, strict=True)):
        portion(progress, 0, work)("sections", i / len(gaits))
        swims["sections"].append(_by_sections(body, gait, _lake(body, unknown, shares)))
    if flow_rungs:
        water = Water(viscosity=max(viscosities.values()), cross_drag=middle(unknown.cross_drag), thickening=1.0)
        lake = replace(_lake(body, unknown, likely), water=water)
        swims[THICK_WATER] = [_by_sections(body, gaits[0], lake)]
    for number, rung in enumerate(flow_rungs):
        rung_progress = portion(progress, 1 + 4 * number, work)
        swims[rung] = [_by_flow(body, gaits[0], rung, cells_by_rung[rung], max(viscosities.values()), rung_progress)]
    order = [name for name in ("sections", THICK_WATER, "slice", "space") if name in swims]
    if "sections" not in rungs:
        order.remove("sections")
    data = _forces_dataset(walk, body, gaits[0], {name: _spread(swims[name], swims["sections"]) for name in order})
    data.attrs["gait_frequency"] = gaits[0].frequency
    notes = [*bends.notes, *_left_open(body, max(viscosities.values(), default=0.0), unknown)]
    return data.assign_attrs(
        title=f"forces of the water on the animal of {walk.source}", medium="water", body=robot.name,
        notes="\n".join(notes),
    )  # fmt: skip


def swim_gait(walk: Walk, robot: Robot) -> Gait:
    """Return the swim of a robot whose joints follow the first harmonics of a film, limbs folded back.

    Args:
        walk: what was measured.
        robot: robot that is to swim so.

    Raises:
        UnusableTracks: too few bends were seen.
    """
    bends = _Bends(walk, robot)
    return bends.gait(dict.fromkeys(bends.uncertain_names, 0.5))


def _body_length(walk: Walk, length: float | None) -> float:
    """Return the length of the animal [m]."""
    if length is not None:
        if not 0.0 < length < np.inf:
            raise UnusableTracks(f"the animal is {length:g} m long; a length above 0 is needed.")
        return length
    midline_length = _midline(walk)
    if midline_length is None:
        raise UnusableTracks(
            f"{walk.source} is in pixels, which do not show how long the animal is: give its whole length, as in "
            "--length 0.4."
        )
    return midline_length


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
        """Take the first harmonic of the bend at every keypoint from the walk, and its standard error."""
        _check_bends(walk)
        phases, self._body, self._period = walk.phases, body, walk.numbers["period"]
        turn = np.exp(-2j * np.pi * phases.phase.values)
        bend = np.nan_to_num(phases.bend.values)
        self._first_harmonic: Complex[np.ndarray, " place"] = -2.0 * (bend * turn).mean(axis=1)  # left positive
        curvature_error = np.nan_to_num(phases.curvature_high.values - phases.curvature_low.values) / 2
        self._error = np.sqrt(np.mean(curvature_error**2, axis=1)) * np.nan_to_num(_arms(walk))
        self._places, self._names = phases.place.values, [str(name) for name in phases.keypoint.values]
        self.uncertain_names = (
            "period",
            *(f"{component} {name}" for name in self._names for component in ("cosine", "sine")),
        )
        residual = bend + (self._first_harmonic[:, None] * np.conj(turn)).real
        overtone_ratio = float(
            np.sqrt((residual - residual.mean(axis=1, keepdims=True)).var() / max(bend.var(), 1e-300))
        )
        self.notes = (
            f"overtones, {100 * overtone_ratio:.0f} % of the bends, and bends to one side on average are left out",
        )

    def gait(self, shares: Mapping[str, float]) -> Gait:
        """Return the swim at shares of the distributions of period and bends."""
        period = self._period.value + self._period.error * errors(shares["period"])
        deviation = np.array([
            errors(shares[f"cosine {name}"]) - 1j * errors(shares[f"sine {name}"]) for name in self._names
        ])  # fmt: skip
        first_harmonic = self._first_harmonic + self._error * deviation
        hinges, servos = yaw_hinges(self._body), layout(self._body).servos
        hinge_harmonics = _hinge_harmonics(first_harmonic, self._places, hinges.axial_positions)
        lateral = lateral_servos(self._body)
        servo_harmonics = [
            sum(hinge_harmonics[k] for k in range(len(hinge_harmonics)) if servos[hinges.servos[k]] == name)
            for name in lateral
        ]
        return swimming_gait(
            self._body,
            name="filmed",
            frequency=1.0 / period,
            amplitude=[min(abs(harmonic), 3.1415) for harmonic in servo_harmonics],
            lag=[-float(np.angle(harmonic)) / (2 * np.pi) for harmonic in servo_harmonics],
        )


def _hinge_harmonics(
    harmonics: Complex[np.ndarray, " place"], places: Float[np.ndarray, " place"], hinges: Sequence[float]
) -> list[complex]:
    """Return the bend of each hinge: that of the midline between the middles to its neighbours.

    The midline has constant curvature between keypoints. The bend of a keypoint is that of the adjacent halves of its
    segments.

    Args:
        harmonics: harmonics of the bends at keypoints [rad].
        places: positions of the keypoints along the midline, 0 to 1 [-].
        hinges: places of the hinges along the body, 0 to 1 [-].
    """
    ends = np.concatenate([[0.0], places, [1.0]])
    middles = (ends[1:] + ends[:-1]) / 2
    cumulative_bend = np.concatenate([[0.0], np.cumsum(harmonics)])
    hinge_positions = np.asarray(hinges)
    edges = np.concatenate([[0.0], (hinge_positions[1:] + hinge_positions[:-1]) / 2, [1.0]])
    direction = np.interp(edges, middles, cumulative_bend.real) + 1j * np.interp(edges, middles, cumulative_bend.imag)
    return [complex(bend) for bend in np.diff(direction)]


def _lake(body: Robot, unknown: Unknown, shares: Mapping[str, float]) -> Lake:
    """Return the lake with the coefficients of the water at fractions of their ranges."""
    coefficients = {name: interpolate_bounds(getattr(unknown, name), shares[name])
              for name in ("cross_drag", "thickening", "added_mass", "shedding", "viscosity")}  # fmt: skip
    water = Water(
        viscosity=coefficients["viscosity"],
        cross_drag=coefficients["cross_drag"], thickening=coefficients["thickening"]
    )  # fmt: skip
    return Lake(
        level=2 * body.length, water=water, added_mass=coefficients["added_mass"], shedding=coefficients["shedding"]
    )  # fmt: skip


def _by_sections(body: Robot, gait: Gait, lake: Lake) -> _SwimCycle:
    swim = free_sections(body, gait, lake, CYCLES)
    rows = [_resample(swim.phase.values, swim[f"last_{name}"].values) for name, _, _ in _KINDS]
    return _SwimCycle(np.array(rows), float(swim.speed[-1]))


def _resample(phase: np.ndarray, values: np.ndarray) -> np.ndarray:
    return np.interp(np.arange(PHASES) / PHASES, phase, values, period=1.0)


def _viscosity(body: Robot, gait: Gait, cells: int) -> float:
    """Return the least viscosity with which a grid carries the boundary layer, and a hundredth more [m2/s]."""
    outline = Outline(body, cells + 1)
    motion = undulation(outline, gait)
    curve = cycle(outline, motion, *recoil(outline, motion, 0.0, Water()))
    speed = float(np.hypot(curve.x_rate, curve.y_rate).max())
    return 1.01 * speed * (MIN_LAYER_CELLS * body.length / cells) ** 2 / body.length


def _cells(body: Robot, rung: str) -> int:
    """Return the cells per body length of a flow, enough to resolve the thickness of the body."""
    half_widths, _ = Outline(body, 65).silhouette
    min_cells = 1.02 * MIN_THICKNESS * body.length / (2.0 * float(np.max(half_widths)))
    return CELLS[rung] if rung == "slice" else max(CELLS[rung], int(np.ceil(min_cells)))


def _by_flow(body: Robot, gait: Gait, rung: str, cells: int, viscosity: float, progress: Progress) -> _SwimCycle:
    """Return a swim in a flow; a slice has the depth at which it displaces as much water as the body."""
    outline = Outline(body, cells + 1)
    bluntness = 1.75 if rung == "slice" else 0.0
    setting = SwimSetting(
        axes=2 if rung == "slice" else 3, cells=cells, viscosity=viscosity, cycles=FLOW_CYCLES, blunt=bluntness
    )
    swim = ResolvedSwim(robot=body, motion=undulation(outline, gait), setting=setting)
    swim.check()
    sim = flow.Simulation(swim.setup)
    quarters = 4 * FLOW_CYCLES
    for i in range(quarters):
        sim.run((i + 1) * swim.end / quarters, progress=False)
        progress(rung, (i + 1) / quarters)
    series = sim.record.select_after(swim.end - 1.05 * swim.period)
    phase = (series.time - 0.5 * series.step - swim.end + swim.period) / swim.period
    half_widths, _ = outline.silhouette
    depth = displaced_mass(outline, 1.0) / float(np.trapezoid(2 * half_widths, outline.s)) if rung == "slice" else 1.0
    force = series.force()
    columns = (-force[:, 0], force[:, 1], series.column("power"))
    clock = (np.arange(PHASES) + 0.5) / PHASES
    rows = [depth * _resample(clock, np.interp(clock, phase, values)) for values in columns]
    is_last_cycle = series.time > swim.end - swim.period
    speed = -float(np.average(series.column("velocity_x")[is_last_cycle], weights=series.step[is_last_cycle]))
    return _SwimCycle(np.array(rows), speed)


def _spread(swims: Sequence[_SwimCycle], sections: Sequence[_SwimCycle]) -> list[_SwimCycle]:
    """Return swims that span the interval of a model of the water.

    A model that was run once gets the relative interval of the section model, scaled by the size of its forces.

    Args:
        swims: swims of the model, one or one for each choice.
        sections: the same choices by the section model.
    """
    if len(swims) > 1:
        return list(swims)
    (swim,) = swims
    size = np.abs(sections[0].force).max(axis=1, keepdims=True)
    scale = np.abs(swim.force).max(axis=1, keepdims=True) / np.maximum(size, 1e-300)
    likely_sections = sections[0]
    pace = swim.speed / likely_sections.speed if likely_sections.speed else 1.0
    return [
        _SwimCycle(
            swim.force + scale * (section_swim.force - likely_sections.force),
            swim.speed + pace * (section_swim.speed - likely_sections.speed),
        )
        for section_swim in sections
    ]


def _forces_dataset(walk: Walk, body: Robot, gait: Gait, swims: Mapping[str, Sequence[_SwimCycle]]) -> xr.Dataset:
    """Return forces and quantities of all rungs as one dataset."""
    data = xr.Dataset(
        coords={"phase": ("phase", np.arange(PHASES) / PHASES, {"units": "1"}), "rung": ("rung", list(swims))}
    )
    forces = np.array([[swim.force for swim in row] for row in swims.values()])  # rung answer kind phase
    speeds = np.array([[swim.speed for swim in row] for row in swims.values()])
    for i, (name, unit, meaning) in enumerate(_KINDS):
        add_with_interval(data, name, ("rung", "phase"), np.swapaxes(forces[:, :, i], 0, 1), (unit, meaning))
    add_with_interval(data, "speed", ("rung",), speeds.T, ("m/s", "speed of the body that swims as was filmed"))
    add_with_interval(
        data, "mean_power", ("rung",), forces[:, :, 2].mean(axis=-1).T, ("W", "mean power of the body on the water")
    )
    for name, i in (("peak_thrust", 0), ("peak_aside", 1)):
        add_with_interval(
            data, name, ("rung",), np.abs(forces[:, :, i]).max(axis=-1).T, ("N", f"greatest {name[5:]}, to either side")
        )
    table = Quantities()
    displaces = WATER_DENSITY * sum(volumes(body).values())
    table.add("length", [body.length], "m", "of the body")
    table.add("displaced", [displaces], "kg", "water that the body displaces, and so its mass where it hovers")
    film = walk.numbers.get("speed")
    if film is not None and film.unit == "m/s":
        film_speeds = [film.value + deviation for deviation in (0.0, -film.error, film.error)]
        table.add("speed_filmed", film_speeds, "m/s", "of the trunk on the film")
        for rung, row in zip(swims, speeds, strict=True):
            table.add(f"speed_to_filmed_{rung.replace(', ', '_').replace(' ', '_')}", list(row / film.value), "-",
                      f"speed over that filmed, {rung}")  # fmt: skip
    return data.merge(_numbers(body, gait, speeds[0], table).dataset())


def _numbers(body: Robot, gait: Gait, speeds: np.ndarray, table: Quantities) -> Quantities:
    """Add the numbers by which swims of other sizes are compared, in real water by the first rung."""
    outline, water = Outline(body, 65), Water()
    motion = undulation(outline, gait)
    swing = float(np.ptp(cycle(outline, motion, *recoil(outline, motion, 0.0, water)).y[:, -1]))
    similarities = [
        swim_numbers(
            speed=float(speed), length=body.length, frequency=gait.frequency, swing=swing, viscosity=water.viscosity
        )
        for speed in speeds
    ]
    for name, meaning in SIMILARITY.items():
        answers = list(dict.fromkeys(getattr(similarity, name) for similarity in similarities))
        table.add(name, answers, "-", f"{meaning}, in fresh water by the first model")
    return table


def _left_open(body: Robot, viscosity: float, unknown: Unknown) -> list[str]:
    """Return sentences on what the film does not show, and the assumptions about it."""
    notes = [
        f"sections, fins and limbs are not on the film: the body is that of {body.name}, its limbs left out",
        "the body swims deep below the surface, in a plane; near the surface waves take power, which is not in it",
    ]
    if unknown.mass is None:
        notes.append("the volume is the named body's at this length; with --mass it is that of so much water")
    if viscosity:
        notes.append(
            f"the flows are of water with {viscosity / Water().viscosity:.3g} times the viscosity, the least that "
            f"their grids carry; the sections stand beside them in the same water ({THICK_WATER})"
        )
        notes.append("a flow is computed once: its intervals are the sections', in proportion to its forces")
    return notes
