"""What each model says of a swimmer: two theories, sections in six degrees of freedom, the slice, the flow in space.

A swim is asked at a frequency, or at the speed that it is to hold; then its frequency is found.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import degrees, hypot, isfinite, pi, radians
from typing import NamedTuple

import numpy as np

from evidence.league.contestant import Found, Numbers, Predictor
from suchus.core import rotation
from suchus.core.errors import InvalidDesign, NotConverged, OutsideLimits
from suchus.core.progress import Progress, portion
from suchus.core.water_table import column
from suchus.flow.setup import MIN_LAYER_CELLS
from suchus.robot.control import Swimming
from suchus.robot.design import WATER_DENSITY, BodyForm, Robot, layout
from suchus.robot.design.form import formed, shed_momenta
from suchus.robot.design.pieces import pieces
from suchus.robot.design.scale import control_period
from suchus.robot.design.water import Water
from suchus.robot.motion import Curve, Gait, cycle_targets, servo_parts
from suchus.sim.land import Lake, Run, simulate
from suchus.swimming.water import Motion, Outline, cruise, cycle, reactive, recoil, resistive, undulation
from suchus.swimming.water.form_drag import resist_form
from suchus.swimming.water.resolved import SwimSetting, resolved_swim
from suchus.swimming.water.slender import Effort, Model
from suchus.swimming.water.undulation import straight_motion

STATIONS = 65
"""Points along the midline in the theories [-]; they change the speed by less than 1 % from 257."""
THEORY_DRAWS, SECTION_DRAWS = 32, 24
"""Choices of the numbers in a theory and in sections [-]."""
_SEARCHES = 6
"""Greatest number of swims in a search for a speed and a swing [-]."""
FASTEST = 20.0
"""Fastest beat that is tried [Hz]."""
LEAST_TICKS = 16
"""Commands a cycle that servos need in sections [-]: fewer are stairs whose steps, not the swim, take the power. The
root mean square between a sine and 16 stairs a cycle is a ninth of its amplitude."""
LAST = 3
"""Cycles at the end of a swim over which speed and power are means [-]."""
SLICE_CELLS, SPACE_CELLS = 80, (56, 72)
"""Cells per body length of the slice, and of the grids in space [-]."""
_COASTS = 4
"""Postures of a cycle in which a body coasts [-]."""
_COASTING = 3.0
"""Distance that a body coasts while its deceleration is read [body length]."""
_DEEP = 3.0
"""Depth of a lake [body length]."""
MAX_SWING_ERROR = 0.2
"""Greatest error of the swing of the tail of a swim that is to be one that was filmed [-]: thrust goes with its square.
Set before any was judged by it."""
_SWING_TOLERANCE, _SPEED_TOLERANCE = 0.03, 0.01
"""Errors of the swing of the tail and of the speed at which a search for them ends [-]."""
MAX_PITCH, MAX_HEEL = radians(20.0), radians(45.0)
"""Greatest mean pitch and heel of a steady swim [rad]: beyond, a level course is no course along the body, and bends
to the side are more up and down than to the side."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelSwimmer:
    """A body, how it moves, and what the water does to it, all numbers chosen."""

    robot: Robot
    """The body."""
    gait: Gait
    """Its swim."""
    water: Water = field(default_factory=Water)
    """The medium, and what sections feel in it."""
    form: BodyForm = field(default_factory=BodyForm)
    """Drag of head, blunt end and folded limbs, and what the tail sheds."""
    added_mass: float = 1.0
    """Added mass over that of ideal water [-]."""
    ramp: float = 0.5
    """Part of the first period in which the motion grows; 0 for measured curves [cycle]."""
    bend: float = 1.0
    """Factor by which the bends of its gait were scaled so that the tail swings as filmed [-]."""


class SwimPrediction(NamedTuple):
    """What a model says of one swim."""

    frequency: float
    """[Hz]."""
    speed: float
    """Along the path, in the last cycles; negative tail first [m/s]."""
    power: float
    """Mean power of the body on the water; in six degrees of freedom that of its joints, which have no friction [W]."""
    periods: tuple[float, ...]
    """Mean speed of each period from rest [m/s]."""
    swing: float
    """Of the tail's tip, from end to end [m]; NaN where it is not read."""
    coast: float
    """k in dU/dt = -k U^2 with the posture held [1/m]; NaN where it is not read."""
    pitch: float = np.nan
    """Mean pitch in the last cycles, nose up positive [rad]; NaN where the model knows none."""
    heel: float = np.nan
    """Mean size of the heel in the last cycles [rad]; NaN where the model knows none."""


Build = Callable[[Numbers, float | None], ModelSwimmer]
"""Makes the swimmer of a choice of the numbers, at a frequency [Hz] or at its own."""
Read = Callable[[Numbers, ModelSwimmer, SwimPrediction], Found]
"""Reads what is predicted from a swim."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SwimTask:
    """What is asked of a swimmer."""

    build: Build
    """Makes it."""
    read_quantities: Read
    """Reads its quantities."""
    cycles: int = 10
    """Cycles of a swim in six degrees of freedom [-]."""
    resolved_cycles: int = 6
    """Cycles of a swim in the flow [-]."""
    target_speed: Callable[[Numbers], float] | None = None
    """Speed that it is to hold, from the numbers [m/s]; None where its frequency is given."""
    start: float = 2.0
    """Frequency from which that of a speed to be held is sought [Hz]."""
    coasts: bool = False
    """Whether it is to coast with its posture held."""
    filmed_swing: Callable[[Numbers], float] | None = None
    """Way of the tail's tip from side to side that was filmed, from the numbers [m]: the bends of the gait are scaled
    until the free body swings its tail so far; None where the joints' angles were measured."""


def rungs(asked: SwimTask, *, space: bool = True, section_draws: int = SECTION_DRAWS) -> dict[str, Predictor]:
    """Return every model that can be asked of a swimmer.

    Args:
        asked: what is asked.
        space: whether the flow in space can be.
        section_draws: choices of the numbers in sections [-].
    """
    found = {
        name: Predictor(words=words, work=partial(_by_theory, model, asked), draws=THEORY_DRAWS)
        for name, words, model in (
            ("resistive", "resistive theory: the drag of each section (Taylor 1952)", resistive),
            ("reactive", "reactive theory: the momentum shed at the tail (Lighthill 1971)", reactive),
        )
    }
    found["sections"] = Predictor(
        words="six degrees of freedom, with drag, added mass and shed momentum of each section",
        work=partial(_by_sections, asked),
        draws=section_draws,
    )
    found["slice"] = Predictor(
        words="the flow around a slice of unlimited depth, in thick water",
        work=partial(_by_slice, asked),
        draws=0,
        interval_source="sections",
    )
    if space:
        found["space"] = Predictor(
            words="the flow around the body in three dimensions, in thick water, brought to real water by theories",
            work=partial(_by_space, asked),
            draws=0,
            interval_source="sections",
        )
    return found


# --- theories -----------------------------------------------------------------------------------------------------


def _by_theory(model: Model, asked: SwimTask, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    found: list[Found] = []
    for i, numbers in enumerate(choices):
        progress("choices of the numbers", i / len(choices))
        try:
            swimmer, swum = held_swim(
                asked, numbers, partial(theory, model, coasts=asked.coasts, starts=asked.target_speed is None)
            )
            found.append(asked.read_quantities(numbers, swimmer, swum))
        except (NotConverged, OutsideLimits, InvalidDesign):  # this choice: no forward speed, or no beat so fast
            found.append({})
    return found


def held_swim(
    asked: SwimTask, numbers: Numbers, swim: Callable[[ModelSwimmer], SwimPrediction]
) -> tuple[ModelSwimmer, SwimPrediction]:
    """Return a swim at its own frequency or at that which holds a speed, with the filmed swing where there is one.

    Speed is nearly in proportion to the frequency and to the swing, and the swing to the bends.

    Args:
        asked: the task.
        numbers: choice of the numbers.
        swim: lets a swimmer swim.

    Raises:
        NotConverged: it does not swim forward where it is to hold a speed, or its tail cannot swing as filmed.
    """
    target = None if asked.target_speed is None else asked.target_speed(numbers)
    frequency, bend = None if target is None else asked.start, 1.0
    for _ in range(_SEARCHES):
        swimmer = _bent(asked.build(numbers, frequency), bend)
        swum = swim(swimmer)
        if target is not None and not swum.speed > 0.0:
            raise NotConverged(f"at {frequency:.3g} Hz it does not swim forward, so that it holds no speed.")
        stretch = swing_ratio(asked, numbers, swum)
        holds = target is None or abs(swum.speed / target - 1.0) < _SPEED_TOLERANCE
        if holds and abs(stretch - 1.0) < _SWING_TOLERANCE:
            break
        bend = _next_bend(bend, stretch)
        if target is not None and frequency is not None:
            frequency *= target / swum.speed / stretch
    reason = _unfilmed(asked, numbers, swum)
    if reason:
        raise NotConverged(reason)
    return swimmer, swum if target is None else _at_speed(swum, target)


def _bent(swimmer: ModelSwimmer, bend: float) -> ModelSwimmer:
    """Return a swimmer whose gait has its lateral bends scaled by a factor."""
    return swimmer if bend == 1.0 else replace(swimmer, gait=swimmer.gait.bent(bend), bend=bend)


def _next_bend(bend: float, stretch: float) -> float:
    """Return the factor on the bends for the next try, no farther than a factor of two from the film's."""
    return float(np.clip(bend * stretch, 0.5, 2.0))


def swing_ratio(asked: SwimTask, numbers: Numbers, swum: SwimPrediction) -> float:
    """Return the filmed swing of the tail over that of a swim [-]; 1 where none was filmed or read."""
    if asked.filmed_swing is None or not swum.swing > 0.0:
        return 1.0
    return asked.filmed_swing(numbers) / swum.swing


def _unfilmed(asked: SwimTask, numbers: Numbers, swum: SwimPrediction) -> str:
    """Return why a swim is not the one that was filmed; empty where it is, or where none was filmed."""
    stretch = swing_ratio(asked, numbers, swum)
    if abs(1.0 / stretch - 1.0) <= MAX_SWING_ERROR or asked.filmed_swing is None:
        return ""
    return (
        f"not a steady swim as filmed: its tail swings {swum.swing:.3g} m from side to side, and "
        f"{asked.filmed_swing(numbers):.3g} m were filmed."
    )


def out_of_trim(swum: SwimPrediction) -> str:
    """Return why a swim keeps no trim; empty where it does, or where the model knows neither pitch nor heel."""
    if abs(swum.pitch) > MAX_PITCH:
        return f"not a steady swim: it pitches by {degrees(swum.pitch):.0f} degrees in the mean."
    if swum.heel > MAX_HEEL:
        return f"not a steady swim: it heels by {degrees(swum.heel):.0f} degrees in the mean."
    return ""


def _at_speed(swum: SwimPrediction, wanted: float) -> SwimPrediction:
    """Return a swim at a speed near its own: frequency in proportion, power with the cube."""
    factor = wanted / swum.speed
    return swum._replace(frequency=factor * swum.frequency, speed=wanted, power=factor**3 * swum.power)


def theory(model: Model, swimmer: ModelSwimmer, *, coasts: bool = False, starts: bool = True) -> SwimPrediction:
    """Return what a slender-body model says of a swim, from rest by its mean thrust at each speed.

    Args:
        model: resistive or reactive.
        swimmer: who swims, how and in which water.
        coasts: whether to read how it coasts.
        starts: whether to read its periods from rest.

    Raises:
        NotConverged: thrust and drag never balance.
    """
    outline, table = Outline(swimmer.robot, STATIONS), formed(pieces(swimmer.robot), swimmer.form)
    shed_section = float(shed_momenta(pieces(swimmer.robot), swimmer.form).sum())
    shed = resist_form(partial(_shed, model, shed_section), float(column(table, "end").sum()))
    bent = undulation(outline, swimmer.gait)
    free = cruise(outline, bent, shed, swimmer.water)
    curve = cycle(outline, bent, free.sway, free.turn)
    return SwimPrediction(
        frequency=bent.frequency,
        speed=free.speed,
        power=free.power,
        periods=_from_rest(outline, bent, shed, swimmer, free.speed) if starts else (),
        swing=float(np.ptp(curve.y[:, -1])),
        coast=_coast(outline, bent, model, swimmer, free.speed) if coasts else np.nan,
    )


def _shed(model: Model, section: float, outline: Outline, curve, speed: float, water: Water) -> Effort:  # type: ignore[no-untyped-def]
    """Return the effort of a model that sheds the momentum of a section; resistive theory sheds none.

    Args:
        model: resistive or reactive; the latter sheds the momentum of the trailing edge.
        section: lateral momentum that is shed, over density, speed and lateral velocity [m2].
        outline: outline of the robot.
        curve: its midline over one cycle.
        speed: forward [m/s].
        water: its water.
    """
    whole = model(outline, curve, speed, water)
    if model is not reactive:
        return whole
    share = section / (pi * float(outline.silhouette.half_height[-1]) ** 2)
    surface = -model(
        outline, cycle(outline, straight_motion(outline)), speed, water
    ).thrust  # of the straight body: friction
    return Effort(share * (whole.thrust + surface) - surface, share * whole.power)


def _from_rest(
    outline: Outline, bent: Motion, model: Model, swimmer: ModelSwimmer, last: float, periods: int = 12, steps: int = 24
) -> tuple[float, ...]:
    """Return the mean speed of each period from rest, by the mean thrust at each speed."""
    speeds = np.linspace(0.0, 1.5, 10) * last
    thrusts = [
        model(
            outline, cycle(outline, bent, *recoil(outline, bent, float(u), swimmer.water)), float(u), swimmer.water
        ).thrust
        for u in speeds
    ]
    order = np.argsort(speeds)
    speed, step, found = 0.0, 1.0 / (steps * swimmer.gait.frequency), []
    for _ in range(periods):
        total = 0.0
        for _ in range(steps):
            push = float(np.interp(speed, speeds[order], np.array(thrusts)[order]))
            faster = speed + step * push / swimmer.robot.mass
            total += 0.5 * (speed + faster)
            speed = faster
        found.append(total / steps)
    return tuple(found)


def _coast(outline: Outline, bent: Motion, model: Model, swimmer: ModelSwimmer, speed: float) -> float:
    """Return k of the bent body at rest in itself, its mean over the postures of a cycle [1/m]."""
    free = cycle(outline, bent, *recoil(outline, bent, speed, swimmer.water))
    zero, high, found = np.zeros_like(free.x[:1]), outline.silhouette.half_height, []
    for i in range(0, len(free.x), len(free.x) // 8):
        posture = free._replace(
            x=free.x[i : i + 1], y=free.y[i : i + 1], heading=free.heading[i : i + 1], x_rate=zero, y_rate=zero,
            heading_rate=zero,
        )  # fmt: skip
        drag = -model(outline, posture, speed, swimmer.water).thrust
        carried = WATER_DENSITY * pi * float(np.trapezoid(high**2 * np.sin(posture.heading[0]) ** 2, outline.s))
        found.append(drag / speed**2 / (swimmer.robot.mass + swimmer.added_mass * carried))
    return float(np.mean(found))


# --- sections -----------------------------------------------------------------------------------------------------


def _by_sections(asked: SwimTask, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return the quantities of each choice, in six degrees of freedom.

    Raises:
        OutsideLimits: servos are commanded too rarely, or the swim with the most likely numbers is not steady.
    """
    swimmers, swums = free_swims(asked, choices, progress)
    if asked.target_speed is None and not _commanded(swimmers[0]):
        raise OutsideLimits(
            f"its servos are commanded every {1e3 * control_period(swimmers[0].robot):g} ms, "
            f"{_ticks(swimmers[0]):.3g} times a cycle at {swimmers[0].gait.frequency:g} Hz; "
            f"{LEAST_TICKS} are needed."
        )
    if reason := out_of_trim(swums[0]) or _unfilmed(asked, choices[0], swums[0]):
        raise OutsideLimits(reason)
    return [_sound(asked, *one) for one in zip(choices, swimmers, swums, strict=True)]


def steady_swims(asked: SwimTask, choices: Sequence[Numbers], progress: Progress) -> list[SwimPrediction | None]:
    """Return the swim of each choice in six degrees of freedom; None where it is not steady, or not as filmed.

    Args:
        asked: the task, at frequencies of its own.
        choices: choices of the numbers.
        progress: told the share that is done.

    Raises:
        OutsideLimits: the swim with the most likely numbers is not steady, or not as filmed.
    """
    _, swums = free_swims(asked, choices, progress)
    reasons = [
        out_of_trim(swum) or _unfilmed(asked, numbers, swum) for numbers, swum in zip(choices, swums, strict=True)
    ]
    if reasons[0]:
        raise OutsideLimits(reasons[0])
    return [None if reason or not isfinite(swum.speed) else swum for reason, swum in zip(reasons, swums, strict=True)]


def free_swims(
    asked: SwimTask, choices: Sequence[Numbers], progress: Progress
) -> tuple[list[ModelSwimmer], list[SwimPrediction]]:
    """Return swimmers and their swims, at the speed to be held and with the filmed swing where there is one.

    Frequency and bends begin at those of resistive theory. Of a swim whose servos are commanded too rarely in
    the first choice none is computed.

    Args:
        asked: the task.
        choices: choices of the numbers.
        progress: told the share that is done.
    """
    frequencies: list[float | None] = [None if asked.target_speed is None else asked.start] * len(choices)
    bends = [1.0] * len(choices)
    searched = asked.target_speed is not None or asked.filmed_swing is not None
    for i, numbers in enumerate(choices if searched else ()):
        try:
            swimmer, swum = held_swim(asked, numbers, partial(theory, resistive, starts=False))
        except (NotConverged, OutsideLimits, InvalidDesign):
            continue
        bends[i] = swimmer.bend
        if asked.target_speed is not None:
            frequencies[i] = swum.frequency
    passes = 3 if asked.target_speed is not None else 2 if searched else 1
    for i in range(passes):
        swimmers = [_bent(asked.build(*pair), bend) for *pair, bend in zip(choices, frequencies, bends, strict=True)]
        if asked.target_speed is None and not _commanded(swimmers[0]):
            return swimmers, [_NO_SWIM] * len(swimmers)
        last = i == passes - 1
        swums = sections(
            swimmers, cycles=asked.cycles, coasts=asked.coasts and last, progress=portion(progress, i, passes)
        )
        if last:
            break
        for k, (numbers, swum) in enumerate(zip(choices, swums, strict=True)):
            stretch = swing_ratio(asked, numbers, swum)
            if not isfinite(stretch * swum.speed):
                continue
            bends[k] = _next_bend(bends[k], stretch)
            if asked.target_speed is not None and swum.speed > 0.0:
                factor = asked.target_speed(numbers) / swum.speed / stretch
                frequencies[k] = min((frequencies[k] or asked.start) * float(np.clip(factor, 0.4, 2.5)), FASTEST)
    return swimmers, swums


_NO_SWIM = SwimPrediction(frequency=np.nan, speed=np.nan, power=np.nan, periods=(), swing=np.nan, coast=np.nan)
"""A swim that was not computed."""


def _ticks(swimmer: ModelSwimmer) -> float:
    """Return how often servos are commanded in a cycle of the swim [-]."""
    return swimmer.gait.period / control_period(swimmer.robot)


def _commanded(swimmer: ModelSwimmer) -> bool:
    return _ticks(swimmer) >= LEAST_TICKS


def _sound(asked: SwimTask, numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the quantities of a swim; none of one that diverged, is not steady, or misses its speed."""
    if not isfinite(swum.speed) or out_of_trim(swum) or _unfilmed(asked, numbers, swum):
        return {}
    if asked.target_speed is None:
        return asked.read_quantities(numbers, swimmer, swum)
    speed = asked.target_speed(numbers)
    near = swum.speed > 0.0 and 0.7 < swum.speed / speed < 1.4 and _commanded(swimmer)
    return asked.read_quantities(numbers, swimmer, _at_speed(swum, speed)) if near else {}


def sections(
    swimmers: Sequence[ModelSwimmer], *, cycles: int, coasts: bool = False, progress: Progress = lambda *_: None
) -> list[SwimPrediction]:
    """Return swims in six degrees of freedom, from rest at the surface or just below, by the forces of sections.

    Args:
        swimmers: bodies, those of one control period in one batch.
        cycles: of each [-].
        coasts: whether to read how they coast, with their postures held.
        progress: told the share that is done.
    """
    shares = (0.0, 0.6, 1.0) if coasts else (0.0, 1.0)
    groups: dict[float, list[int]] = {}
    for i, one in enumerate(swimmers):
        groups.setdefault(control_period(one.robot), []).append(i)
    swums: dict[int, SwimPrediction] = {}
    for number, group in enumerate(groups.values()):
        runs = [
            Run(
                robot=swimmers[i].robot,
                gait=swimmers[i].gait,
                lake=_lake(swimmers[i]),
                control=Swimming(ramp=0.0 if swimmers[i].gait.curves else swimmers[i].ramp * swimmers[i].gait.period),
                label=str(i),
            )
            for i in group
        ]
        longest = max(swimmers[i].gait.period for i in group)
        part = portion(progress, number, len(groups))
        record = simulate(
            runs,
            duration=cycles * longest,
            progress=lambda stage, share, part=part: part(stage, shares[0] + share * (shares[1] - shares[0])),
        )
        swums |= {i: _of_run(record.isel(run=k), swimmers[i], cycles) for k, i in enumerate(group)}
    found = [swums[i] for i in range(len(swimmers))]
    if not coasts:
        return found
    speeds = [abs(swum.speed) if isfinite(swum.speed) else 0.1 for swum in found]
    held = _coasting(swimmers, speeds, lambda stage, share: progress(stage, 0.6 + 0.4 * share))
    return [swum._replace(coast=k) for swum, k in zip(found, held, strict=True)]


def _lake(one: ModelSwimmer, current: tuple[float, float] = (0.0, 0.0)) -> Lake:
    return Lake(
        level=_DEEP * one.robot.length, water=one.water, added_mass=one.added_mass, form=one.form, current=current,
    )  # fmt: skip


def _of_run(run, one: ModelSwimmer, cycles: int) -> SwimPrediction:  # type: ignore[no-untyped-def]
    """Return what one run says; speeds NaN where it diverged."""
    period, time = one.gait.period, run.time.values
    centre = run.centre_of_mass.transpose("time", "xyz").values[:, :2]
    turns = np.arange(cycles + 1) * period
    at = np.stack([np.interp(turns, time, centre[:, i]) for i in range(2)], axis=1)
    steps = np.diff(at, axis=0)
    speeds = np.hypot(*steps.T) / period
    facing = rotation.rotate(run.orientation.transpose("time", "wxyz").values, np.array([1.0, 0.0, 0.0]))
    ahead = np.stack([np.interp(turns, time, facing[:, i]) for i in range(2)], axis=1)
    speeds *= np.sign(np.einsum("ij,ij->i", steps, 0.5 * (ahead[1:] + ahead[:-1])))
    last = (time > turns[-1 - LAST]) & (time <= turns[-1] + 1e-9)
    tip = run.tail_tip.transpose("time", "xyz").values[last, :2]
    way = at[-1] - at[-1 - LAST]
    aside = (tip @ np.array([-way[1], way[0]])) / max(hypot(*way), 1e-12)
    drift = np.polyval(np.polyfit(time[last], aside, 1), time[last])
    attitude = run.orientation.transpose("time", "wxyz").values[last]
    left, up = (rotation.rotate(attitude, np.array(axis)) for axis in ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]))
    return SwimPrediction(
        frequency=1.0 / period,
        speed=float(speeds[-LAST:].mean()),
        power=float(run.servo_power.sum("servo").values[last].mean()),
        periods=tuple(float(value) for value in speeds),
        swing=float(np.ptp(aside - drift)),
        coast=np.nan,
        pitch=float(np.arcsin(np.clip(facing[last, 2], -1.0, 1.0)).mean()),
        heel=float(np.abs(np.arctan2(left[:, 2], up[:, 2])).mean()),
    )


def _coasting(swimmers: Sequence[ModelSwimmer], speeds: Sequence[float], progress: Progress) -> list[float]:
    """Return k of bodies that coast with the postures of a cycle, its mean over the postures [1/m].

    A body at rest in a stream is one that coasts in still water, seen from another frame.
    """
    runs, still_at = [], []
    for one, speed in zip(swimmers, speeds, strict=True):
        place, parts = layout(one.robot), servo_parts(one.robot)
        outline = Outline(one.robot, STATIONS)
        curve = cycle(outline, one.gait)
        root = int(np.argmin(np.abs(outline.s - _root(one.robot))))
        for k in range(_COASTS):
            angles = cycle_targets(one.robot, one.gait, np.array([k / _COASTS]))[0]
            curves = tuple(
                Curve(servo=name, part=parts[name], angles=(float(angle),))
                for name, angle in zip(place.servos, angles, strict=True)
            )
            i = k * len(curve.x) // _COASTS
            # x of a midline runs to the tail and y to the right: the body's course, against the direction of its root
            along = np.arctan2(curve.y[i, -1] - curve.y[i, 0], curve.x[i, -1] - curve.x[i, 0])
            turned = -(along - curve.heading[i, root])
            gait = Gait(name="held", period=10.0, limb_phases=(0.0,) * len(place.limbs), curves=curves)
            current = (-speed * float(np.cos(turned)), -speed * float(np.sin(turned)))
            runs.append(
                Run(robot=one.robot, gait=gait, lake=_lake(one, current), control=Swimming(ramp=0.0), label=f"{k}")
            )
            still_at.append(current)
    longest = _COASTING * swimmers[0].robot.length / min(speeds)
    record = simulate(runs, duration=min(longest, 10.0), progress=progress)
    time, found = record.time.values, []
    for i, (current, speed) in enumerate(zip(still_at, np.repeat(speeds, _COASTS), strict=True)):
        centre = record.centre_of_mass.isel(run=i).transpose("time", "xyz").values[:, :2]
        course = -np.array(current) / speed
        rate = np.gradient(centre @ course, time) + speed  # against the water
        part = time <= _COASTING * swimmers[0].robot.length / speed
        part &= np.minimum.accumulate(rate) > 0.2 * speed
        slope = np.polyfit(time[part], 1.0 / rate[part], 1)[0]
        found.append(float(slope))
    return [float(np.mean(found[_COASTS * i : _COASTS * (i + 1)])) for i in range(len(swimmers))]


def _root(robot: Robot) -> float:
    """Return where the middle of the root's segment is, from the snout [m]."""
    ahead = sum(segment.front + segment.rear for segment in robot.axis[: robot.root_index])
    return ahead + robot.axis[robot.root_index].front


# --- the flow -----------------------------------------------------------------------------------------------------


def _flow_swimmer(asked: SwimTask, numbers: Numbers) -> ModelSwimmer:
    """Return the swimmer of a flow, with the bends with which resistive theory swings the tail as filmed."""
    swimmer = asked.build(numbers, asked.start if asked.target_speed else None)
    if asked.filmed_swing is None:
        return swimmer
    return _bent(swimmer, held_swim(asked, numbers, partial(theory, resistive, starts=False))[0].bend)


def _by_slice(asked: SwimTask, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    numbers = choices[0]
    swimmer = _flow_swimmer(asked, numbers)
    swum = resolved(swimmer, axes=2, cells=SLICE_CELLS, cycles=asked.resolved_cycles, progress=progress)
    high = 2.0 * float(np.mean(Outline(swimmer.robot, STATIONS).silhouette.half_height))
    return [_answer(asked, numbers, swimmer, swum._replace(power=high * swum.power))]


def _by_space(asked: SwimTask, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    numbers = choices[0]
    swimmer = _flow_swimmer(asked, numbers)
    grids = []
    for i, cells in enumerate(SPACE_CELLS):
        grids.append(
            resolved(
                swimmer, axes=3, cells=cells, cycles=asked.resolved_cycles,
                progress=portion(progress, i, len(SPACE_CELLS)),
            )
        )  # fmt: skip
    thick = [replace(swimmer, water=replace(swimmer.water, viscosity=_viscosity(swimmer, n))) for n in SPACE_CELLS]
    answers: list[SwimPrediction] = []
    for model in (resistive, reactive):
        real = theory(model, swimmer, starts=asked.target_speed is None)
        for grid, water in zip(grids, thick, strict=True):
            slow = theory(model, water, starts=False)
            if real.speed > 0.0 and slow.speed > 0.0:  # a tail that ends in a point sheds nothing there
                answers.append(_brought(grid, real, slow))
    if not answers:
        raise NotConverged("no theory swims forward in thick and in real water, to bring the flow there.")
    middle = answers[0]._replace(
        speed=_mean([one.speed for one in answers]),
        power=_mean([one.power for one in answers]),
        periods=tuple(_mean(row) for row in zip(*(one.periods for one in answers), strict=False)),
    )
    return [_answer(asked, numbers, swimmer, one) for one in (middle, *answers)]


def _brought(grid: SwimPrediction, real: SwimPrediction, slow: SwimPrediction) -> SwimPrediction:
    """Return a swim in thick water as it would be in real water, were the flow then as far from the theory as it is.

    It may be nearer: what a theory leaves out, the layers of thick water, is thinner there. The theory's own answer is
    that of another model and is no part of this one's.

    Args:
        grid: the swim in the flow.
        real: that of a theory in real water.
        slow: that of the theory in the thick water.
    """
    factor = real.speed / slow.speed
    return grid._replace(
        speed=factor * grid.speed,
        power=real.power / slow.power * grid.power,
        periods=tuple(factor * speed for speed in grid.periods),
    )


def _mean(numbers: Sequence[float]) -> float:
    """Return the geometric mean of positive numbers, else the arithmetic one."""
    return float(np.exp(np.mean(np.log(numbers)))) if min(numbers) > 0.0 else float(np.mean(numbers))


def _answer(asked: SwimTask, numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    if asked.target_speed is None:
        return asked.read_quantities(numbers, swimmer, swum)
    if not swum.speed > 0.0:
        return {}
    return asked.read_quantities(numbers, swimmer, _at_speed(swum, asked.target_speed(numbers)))


def resolved(swimmer: ModelSwimmer, *, axes: int, cells: int, cycles: int, progress: Progress) -> SwimPrediction:
    """Return a free swim in the flow, in water as thick as the grid needs it to carry the boundary layer.

    Power is per metre of depth in the plane [W/m].

    Args:
        swimmer: who swims and how.
        axes: 2 for a slice, 3 for the body in space.
        cells: per body length [-].
        cycles: from rest [-].
        progress: told the share that is done.
    """
    setting = SwimSetting(axes=axes, cells=cells, viscosity=_viscosity(swimmer, cells), cycles=cycles)
    record = resolved_swim(swimmer.robot, swimmer.gait, setting, progress=progress)
    speeds = record.speed.values
    return SwimPrediction(
        frequency=swimmer.gait.frequency,
        speed=float(speeds[-1]),
        power=float(record.power.values[-1]),
        periods=tuple(float(value) for value in speeds),
        swing=float(2.0 * record.swing.values[-1]) if record.swing.ndim else float(record.swing),
        coast=np.nan,
    )


def _viscosity(swimmer: ModelSwimmer, cells: int) -> float:
    """Return the least viscosity with which a grid carries the boundary layer, and a hundredth more [m2/s]."""
    outline, gait, length = Outline(swimmer.robot, cells + 1), swimmer.gait, swimmer.robot.length
    curve = cycle(outline, gait, *recoil(outline, gait, 0.0, Water()))
    speed = float(np.hypot(curve.x_rate, curve.y_rate).max())
    return 1.01 * speed * (MIN_LAYER_CELLS * length / cells) ** 2 / length


def waters(numbers: Mapping[str, float]) -> Water:
    """Return the water that the numbers ``density``, ``viscosity``, ``cross_drag`` and ``thickening`` say."""
    return Water(
        density=numbers["density"], viscosity=numbers["viscosity"], cross_drag=numbers["cross_drag"],
        thickening=numbers["thickening"],
    )  # fmt: skip
