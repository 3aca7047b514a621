"""Forces on single feet of a filmed walk: the animal's body repeats the walk in simulations.

The film gives stance, swing and bends. Weight, ground and stiffness of the joints determine how the feet share the
load. So the body is simulated, and the forces are taken from its feet.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.animals.capture import AngleCycle, UnusableTracks, Walk, to_curves, to_gait
from suchus.animals.capture.retarget import ROBOT_NEEDS, Duty, mean_of
from suchus.animals.capture.strides import PHASES
from suchus.animals.forces.body import (
    Quantities,
    Unknown,
    add_with_interval,
    choices,
    errors,
    interpolate_bounds,
    middle,
    names_with_interval,
    resize_body,
    sample_walk,
)
from suchus.article.paper.walking_salamanders import ANIMAL
from suchus.core.errors import OutsideLimits
from suchus.core.progress import Progress, silent
from suchus.robot.design import GRAVITY, LEGS, Girdle, Robot, Servo, check_needs, hips_ahead, layout
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import rescale
from suchus.robot.design.servos import with_full_torque, with_servos
from suchus.robot.gaits import default_gait
from suchus.robot.motion import START, Curve, Gait, suits
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import mean_cycle, require_complete
from suchus.sim.metrics.foot_forces import PARTS, FootStep, Window, displacement_per_cycle, stance_forces, step, weight

SETTLE, CYCLES = 1, 3
"""Cycles that are walked before anything is measured, and that are [-]."""
LOADED = 0.15
"""Vertical force from which a foot counts as standing [body weight], as in ``suchus run salamander``."""
_DIRECTIONS = {"vertical": "up", "sideways": "toward the midline of the course", "foreaft": "forward along the course"}
_MIN_SUCCESS_FRACTION = 0.8  # least fraction of choices that can be walked
_HOLD_TIME = 0.05  # [cycle]; duration of a force that is no strike
_STRONGER = 4.0  # factor on torque and speed of a robot's servos: the film shows that the animal is strong enough
_LIMB_FACTORS = tuple(1.0 + 0.1 * step for step in range(16))  # factors on the length of limbs that are tried
_REACH_TOLERANCE = 0.005  # [trunk]; greatest error of a foot path
_HALVES = (1.0, 0.5, 0.25, 0.0)  # fractions of a change that are tried, the greatest first


class _Try(NamedTuple):
    """One choice of all that is not known."""

    gait: Gait
    friction: float  # [-]
    mass: float  # [kg]
    phase_lag: float  # of the gait's clock behind that of the tables [cycle]


class _GroundResponse(NamedTuple):
    """What the ground did in one choice; forces in body weights."""

    feet: Float[np.ndarray, "leg part phase"]
    belly: Float[np.ndarray, " phase"]
    tail: Float[np.ndarray, " phase"]
    steps: tuple[FootStep, ...]
    speed: float  # [m/s]
    joint_error: float  # [rad]


def walked_forces(
    walk: Walk,
    robot: Robot,
    base: Gait | None = None,
    *,
    unknown: Unknown | None = None,
    duty: Duty = "retraction",
    trunk: float | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Return the forces of the ground on an animal that walks as it was filmed, with intervals.

    The body is a robot's in the animal's size, from hip to shoulder; its gait is read from the walk. Each choice draws
    every measured number from its interval, the duty factor from between the share in which feet go back and that in
    which they rest, and what the film does not show from its range.

    Args:
        walk: the measured walk, with all keypoints.
        robot: robot whose body it is, four limbs with feet that can be put on a path.
        base: gait from which what was not measured is taken; the robot's own if None.
        unknown: the ranges of what the film does not show.
        duty: which share of the cycle is the duty factor of the most likely choice.
        trunk: the animal's length from hip to shoulder, where the film does not show it [m].
        progress: told the share that is done.

    Returns:
        Over ``leg`` and ``phase``, the phase of the walk's own tables: ``vertical``, ``sideways`` toward the midline of
        the course and ``foreaft`` along it [N], the same as ``vertical_bw`` ... [body weight],
        ``belly_bw`` and ``tail_bw`` [body weight], each with ``_low`` and ``_high``; over ``quantity`` what stands out,
        beside published numbers.

    Raises:
        UnsuitedRobot: the robot lacks four limbs with foot paths.
        UnusableTracks: keypoints are lacking, too few cycles were seen, the size is unknown, the animal climbs, or
            hardly any choice can be walked.
        OutsideLimits: the body cannot follow.
    """
    check_needs(robot, ROBOT_NEEDS, "forces of a filmed walk")
    if walk.slope:
        raise UnusableTracks(
            f"in {walk.source} the animal climbs on a surface at {np.degrees(walk.slope):.0f} degrees against level; "
            "forces are computed on level ground only, where the weight acts across it: leave --forces out."
        )
    names, unknown = names_with_interval(walk), unknown or Unknown()
    trunk_length = trunk if trunk is not None else _trunk(walk)
    body = resize_body(robot, trunk_length / hips_ahead(robot, 0))
    base_gait = base or default_gait(robot)
    body, notes = _fit_body(resize_body(body, 1.0, middle(unknown.masses(body))), walk, base_gait, trunk_length)
    rest_fraction = 0.0 if duty == "retraction" else 1.0
    likely = dict.fromkeys((*names, "friction", "mass", "lift", "height"), 0.5) | {"rests": rest_fraction}
    trials: list[_Try] = []
    for i, shares in enumerate([likely, *choices(list(likely), unknown.draws)]):
        progress("reading gaits", 0.1 * i / (unknown.draws + 1))
        try:
            trials.append(_try(walk, body, base_gait, unknown, shares, trunk_length))
        except OutsideLimits:
            if i == 0:
                raise
    if len(trials) < _MIN_SUCCESS_FRACTION * (unknown.draws + 1):
        raise UnusableTracks(
            f"only {len(trials)} of {unknown.draws + 1} choices of what {walk.source} leaves open can be walked by the "
            f"body of {robot.name}: film more cycles, or name another body with --robot."
        )
    responses = _simulate_trials(body, trials, lambda stage, share: progress(stage, 0.1 + 0.9 * share))
    film = walk.numbers.get("speed")
    scale = 1.0 if film is None or film.unit == "m/s" else trunk_length / walk.value("trunk_length")
    film_speeds = (
        () if film is None else tuple(scale * (film.value + deviation) for deviation in (0.0, -film.error, film.error))
    )
    data = _forces_dataset(body, [trial.mass for trial in trials], responses, film_speeds)
    return data.assign_attrs(
        title=f"forces of the ground on the animal of {walk.source}", medium="land", body=robot.name,
        notes="\n".join([*notes, *_left_open(walk, unknown)]),
    )  # fmt: skip


def _trunk(walk: Walk) -> float:
    """Return the length of the animal's trunk from hip to shoulder [m]."""
    trunk_length = walk.numbers.get("trunk_length")
    if trunk_length is None or trunk_length.unit != "m":
        raise UnusableTracks(
            f"{walk.source} is in pixels, which do not show how long the animal is, and forces grow with the cube of "
            "it: give its length from hip to shoulder, as in --trunk 0.12."
        )
    return trunk_length.value


def _fit_body(body: Robot, walk: Walk, base: Gait, trunk: float) -> tuple[Robot, list[str]]:
    """Return the body with limbs long enough and joints strong enough for the filmed walk, and notes.

    A robot's limbs and servos are made for its own task; the animal's do what the film shows.
    """
    strong_body = with_servos(body, _stronger)
    for limb_factor in _LIMB_FACTORS:
        candidate = (
            strong_body
            if limb_factor == 1.0
            else replace(
                strong_body, girdles=tuple(_lengthen_limb(girdle, limb_factor) for girdle in strong_body.girdles)
            )
        )
        captured = to_gait(walk, candidate, base, name="filmed", girdles="apart", time="own", trunk=trunk)
        if _reaches(candidate, walk, captured.gait, trunk):
            limb_notes = (
                []
                if limb_factor == 1.0
                else [f"limbs are {limb_factor:.2g} times as long as {body.name}'s, so that feet reach"]
            )
            return candidate, limb_notes
    return strong_body, [note for note in captured.notes if note not in walk.notes]


def _stronger(servo: Servo) -> Servo:
    return replace(with_full_torque(servo), torque=_STRONGER * servo.torque, speed=_STRONGER * servo.speed)


def _lengthen_limb(girdle: Girdle, factor: float) -> Girdle:
    return replace(girdle, limb=rescale(girdle.limb, length_factor=factor, mass_factor=1.0))


def _reaches(body: Robot, walk: Walk, gait: Gait, trunk: float) -> bool:
    """Return whether the feet follow the measured paths."""
    for girdle, limb, legs in zip(body.girdles, gait.limbs, (LEGS[:2], LEGS[2:]), strict=True):
        film_ratios = {"stroke": mean_of(walk, "stroke", legs), "outward": mean_of(walk, "outward", legs)}
        target_lengths = {
            "stroke": trunk * film_ratios["stroke"],
            "outward": trunk * film_ratios["outward"] - girdle.aside,
        }
        gait_lengths = {name: getattr(limb, name) * girdle.limb.reach for name in target_lengths}
        if any(abs(gait_lengths[name] - target_lengths[name]) > _REACH_TOLERANCE * trunk for name in target_lengths):
            return False
    return True


def _try(walk: Walk, body: Robot, base: Gait, unknown: Unknown, shares: Mapping[str, float], trunk: float) -> _Try:
    """Return the choice at shares of the distributions of all that is not known."""
    sample = sample_walk(walk, shares)
    numbers = dict(sample.numbers)
    for leg in (str(leg) for leg in walk.cycle.leg.values):
        retraction, duty = numbers[f"retraction_{leg}"], numbers[f"duty_{leg}"].value
        numbers[f"retraction_{leg}"] = retraction._replace(
            value=interpolate_bounds((retraction.value, duty), shares["rests"])
        )
    sample = replace(sample, numbers=numbers)
    gait = to_gait(sample, body, base, name="filmed", girdles="apart", time="own", trunk=trunk).gait
    if not walk.has_heights:
        gait = _scale_parameter(body, gait, "lift", interpolate_bounds(unknown.lift, shares["lift"]))
    gait = _scale_parameter(body, gait, "height", interpolate_bounds(unknown.height, shares["height"]))
    phase_lag = (gait.duty_factor - mean_of(walk, "duty")) / 2  # both have LF's mid-stance in common
    mass = interpolate_bounds(unknown.masses(body), shares["mass"])
    return _Try(gait, interpolate_bounds(unknown.friction, shares["friction"]), mass, phase_lag)


def _scale_parameter(body: Robot, gait: Gait, name: str, factor: float) -> Gait:
    """Return a gait with one number scaled, as far as the limbs can follow."""
    original = gait.number(name)
    for fraction in _HALVES if original else ():
        candidate = gait.with_numbers(**{name: original * (1.0 + fraction * (factor - 1.0))})
        if suits(body, candidate):
            return candidate
    return gait


def played_forces(
    cycle: AngleCycle,
    robot: Robot,
    *,
    period: float,
    unknown: Unknown | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Return the forces of a walk whose joint angles are given by a table, on the body of a robot.

    The table gives neither size nor time: the body has the robot's size. Each joint is uncertain by the residual of its
    harmonics.

    Args:
        cycle: the table.
        robot: robot of the joints.
        period: period of the cycle [s].
        unknown: the ranges of what the table does not show.
        progress: told the share that is done.

    Raises:
        UnsuitedRobot: the robot has no two pairs of limbs.
        UnknownName: a column belongs to no servo of the robot.
        OutsideLimits: the body cannot follow.
    """
    check_needs(robot, ("four_limbs",), "forces of a filmed walk")
    unknown = unknown or Unknown()
    gait = to_curves(cycle, robot, name="filmed", period=period)
    body = resize_body(robot, 1.0, middle(unknown.masses(robot)))
    waves = [f"{component} {curve.servo}" for curve in gait.curves for component in ("cosine", "sine")]
    likely = dict.fromkeys((*waves, "friction", "mass"), 0.5)
    residuals = {curve.servo: float(size) for curve, size in zip(gait.curves, cycle.residual, strict=True)}
    trials = []
    for shares in [likely, *choices(list(likely), unknown.draws)]:
        curves = tuple(_waved(curve, residuals[curve.servo], shares) for curve in gait.curves)
        mass = interpolate_bounds(unknown.masses(robot), shares["mass"])
        trials.append(
            _Try(replace(gait, curves=curves), interpolate_bounds(unknown.friction, shares["friction"]), mass, 0.0)
        )
    responses = _simulate_trials(body, trials, progress)
    notes = [
        f"the table shows no size: the body is {robot.name}'s, {body.length:.3g} m long",
        *_ALWAYS,
        f"friction is somewhere from {unknown.friction[0]:g} to {unknown.friction[1]:g}",
    ]
    data = _forces_dataset(body, [trial.mass for trial in trials], responses, ())
    return data.assign_attrs(
        title=f"forces of the ground on the animal of {cycle.source}", medium="land", body=robot.name,
        notes="\n".join(notes),
    )  # fmt: skip


def _waved(curve: Curve, size: float, shares: Mapping[str, float]) -> Curve:
    """Return a curve with an added first harmonic as large as the residual of the table's harmonics [rad]."""
    turn = 2 * np.pi * np.arange(len(curve.angles)) / len(curve.angles)
    parts = [2.0 * size * errors(shares[f"{component} {curve.servo}"]) for component in ("cosine", "sine")]
    correction = parts[0] * np.cos(turn) + parts[1] * np.sin(turn)
    return replace(curve, angles=tuple(float(angle) for angle in curve.angles + correction))


def _simulate_trials(body: Robot, trials: Sequence[_Try], progress: Progress) -> list[_GroundResponse]:
    """Simulate the walk of every choice, and return the response of the ground."""
    foot_friction = body.contact.foot_friction
    runs = [
        Run(robot=body, gait=trial.gait, ground=Ground(friction_scale=trial.friction / foot_friction))
        for trial in trials
    ]
    longest_period = max(trial.gait.period for trial in trials)
    record = require_complete(
        simulate(runs, duration=START + (SETTLE + CYCLES) * longest_period + 0.1 * longest_period, progress=progress)
    )
    return [_ground_response(record.isel(run=i), trial) for i, trial in enumerate(trials)]


def _ground_response(record: xr.Dataset, trial: _Try) -> _GroundResponse:
    """Return contact forces over the phase of the walk's tables, steps, speed and joint error of a choice."""
    period = trial.gait.period
    window = Window(START + SETTLE * period, period, CYCLES)
    force = stance_forces(record, window)
    clock = np.arange(PHASES) / PHASES - trial.phase_lag

    def resample(values: np.ndarray) -> np.ndarray:
        grid = np.arange(values.shape[-1]) / values.shape[-1]
        rows = values.reshape(-1, values.shape[-1])
        return np.array([np.interp(clock, grid, row, period=1.0) for row in rows]).reshape(*values.shape[:-1], PHASES)

    carried_load = {
        "belly": mean_cycle(record.belly_force.sel(xyz="z").sum("segment"), *window),
        "tail": mean_cycle(record.tail_force.sel(xyz="z"), *window),
    }
    servos = [str(name) for name in record.servo.values if name in record.joint.values]
    joint_errors = record.joint_angle.sel(joint=servos).values - record.servo_target.sel(servo=servos).values
    is_in_window = record.time.values > window.start
    return _GroundResponse(
        feet=resample(force.transpose("leg", "part", "phase").values),
        belly=resample(carried_load["belly"].values / weight(record)),
        tail=resample(carried_load["tail"].values / weight(record)),
        steps=tuple(step(force.sel(leg=leg), LOADED) for leg in force.leg.values),
        speed=float(np.hypot(*displacement_per_cycle(record, window))) / period,
        joint_error=float(np.sqrt(np.mean(joint_errors[is_in_window] ** 2))),
    )


def _forces_dataset(
    body: Robot, masses: Sequence[float], responses: Sequence[_GroundResponse], film: tuple[float, ...]
) -> xr.Dataset:
    """Return forces and quantities of all choices as one dataset."""
    place = layout(body)
    legs = [limb.name for limb in place.limbs]
    data = xr.Dataset(
        coords={"phase": ("phase", np.arange(PHASES) / PHASES, {"units": "1"}), "leg": ("leg", legs)},
    )
    feet = np.array([response.feet for response in responses])
    newtons = GRAVITY * np.array(masses)[:, None, None]
    for i, direction in enumerate(PARTS):
        meaning = f"force of the ground on the foot, {_DIRECTIONS[direction]}"
        add_with_interval(data, direction, ("leg", "phase"), newtons * feet[:, :, i], ("N", meaning))
        add_with_interval(data, f"{direction}_bw", ("leg", "phase"), feet[:, :, i], ("body weight", meaning))
    for name in ("belly", "tail"):
        loads = np.array([getattr(response, name) for response in responses])
        add_with_interval(
            data, f"{name}_bw", ("phase",), loads, ("body weight", f"force of the ground on the {name}, up")
        )
    table = Quantities()
    table.add("mass", masses, "kg", "of the animal")
    table.add("length", [body.length], "m", "of the whole body")
    if film:
        table.add("speed_filmed", film, "m/s", "of the trunk on the film")
        table.add(
            "speed_to_filmed",
            [response.speed / film[0] for response in responses],
            "-",
            "speed of the body over that filmed",
        )
    table.add("speed", [response.speed for response in responses], "m/s", "of the body that walks as was filmed")
    table.add(
        "angle_missed",
        [response.joint_error for response in responses],
        "rad",
        "root mean square by which joints miss the film's",
    )
    _peaks(table, body, responses)
    for j, leg in enumerate(legs):
        mean = feet[:, j, PARTS.index("vertical")].mean(axis=-1)
        table.add(f"carried_{leg}", list(mean), "body weight", f"mean vertical force on {leg} over the cycle")
    for name in ("belly", "tail"):
        table.add(f"carried_{name}", [float(getattr(response, name).mean()) for response in responses], "body weight",
                  f"mean vertical force on the {name} over the cycle")  # fmt: skip
    return data.merge(table.dataset())


def _peaks(table: Quantities, body: Robot, responses: Sequence[_GroundResponse]) -> None:
    """Add the peak forces on fore and hind feet, means of left and right, and those of salamanders."""
    limbs = layout(body).limbs
    for pair, number in (("fore", 0), ("hind", limbs[-1].number)):
        limb_indices = [i for i, limb in enumerate(limbs) if limb.number == number]
        steps = [[response.steps[i] for i in limb_indices] for response in responses]
        rows: dict[str, tuple[list[float], str, str]] = {
            "net": (
                [_mean(step.net for step in limb_steps) for limb_steps in steps],
                "body weight",
                "greatest net force",
            ),
            "time": (
                [_mean(step.time for step in limb_steps) for limb_steps in steps],
                "stance",
                "when, as a share of stance, net",
            ),
        }
        quantity_names = {"vertical": "peak", "sideways": "sideways", "foreaft": "foreaft"}
        for direction in PARTS:
            values = [_mean(step.parts[direction] for step in limb_steps) for limb_steps in steps]
            rows[quantity_names[direction]] = values, "body weight", f"force at that instant, {_DIRECTIONS[direction]},"
        for name, (values, unit, meaning) in rows.items():
            animal = ANIMAL[f"foot_force_{name}_{pair}"]
            table.add(f"foot_force_{name}_{pair}", values, unit, f"{meaning} of a {pair} foot",
                      (animal.value, animal.spread, animal.source))  # fmt: skip
        held_forces = [[_sustained_force(response.feet[i]) for i in limb_indices] for response in responses]
        net = ANIMAL[f"foot_force_net_{pair}"]
        table.add(f"foot_force_held_{pair}", [_mean(net_forces) for net_forces in held_forces], "body weight",
                  f"greatest net force on a {pair} foot that lasts {_HOLD_TIME:g} cycles, longer than a strike",
                  (net.value, net.spread, net.source))  # fmt: skip
        loaded = [response.feet[limb_indices, PARTS.index("vertical")] > LOADED for response in responses]
        standing = [float(np.mean(is_loaded)) for is_loaded in loaded]
        table.add(f"stance_share_{pair}", standing, "cycle", f"in which a {pair} foot carries {LOADED:g} body weights")


def _sustained_force(foot: Float[np.ndarray, "part phase"]) -> float:
    """Return the greatest net force on a foot that lasts for ``_HOLD_TIME`` of the cycle [body weight]."""
    net = np.linalg.norm(foot, axis=0)
    return float(np.min([np.roll(net, -i) for i in range(round(_HOLD_TIME * len(net)))], axis=0).max())


def _mean(values: Any) -> float:
    return float(np.mean(list(values)))


_ALWAYS = (
    "how feet that stand share the weight follows from the stiffness of the body's joints, not of the animal's muscles",
    "how the mass is spread along the body is that of the named body",
)


def _left_open(walk: Walk, unknown: Unknown) -> list[str]:
    """Return sentences on what the film does not show, and the assumptions about it."""
    notes = list(_ALWAYS)
    notes.append(f"friction is somewhere from {unknown.friction[0]:g} to {unknown.friction[1]:g}")
    if unknown.mass is None:
        notes.append("mass: 0.7 to 1.4 times the named body's at this length; forces in body weights do not need it")
    if not walk.has_heights:
        (min_lift, max_lift), (min_height, max_height) = unknown.lift, unknown.height
        notes.append(
            f"heights were not seen: feet are lifted {min_lift:g} to {max_lift:g} times as high, and hips are "
            f"{min_height:g} to {max_height:g} times as high, as in the gait that lends them"
        )
    return notes
