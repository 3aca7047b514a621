"""Swims by slender-body models, which take no time: one motion in full, or many with a few numbers each."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from suchus.core.errors import OutsideLimits
from suchus.robot.design import GRAVITY, WATER_DENSITY, Robot
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait, check_limits, check_speeds
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import SIMILARITY, swim_numbers
from suchus.swimming.water.measures import efficiency
from suchus.swimming.water.outline import MidlineCurve, Outline
from suchus.swimming.water.slender import Model, cruise, cycle, reactive, recoil, resistive
from suchus.swimming.water.undulation import Motion, straight_motion, undulation

MODELS: dict[str, Model] = {"resistive": resistive, "reactive": reactive}
"""The models by name."""
VALUES = {"speed": "m/s", "efficiency": "1", "water_cost_of_transport": "1", "strouhal": "1", "slip": "1"}
"""Quantities that are computed for each motion, with units."""


def swim(robot: Robot | str, motion: Motion, *, water: Water | None = None, stations: int = 257) -> xr.Dataset:
    """Return the swim of a robot by the resistive and by the reactive model.

    ``thrust_held`` is the mean force on a body that cannot move forward but can sway and turn. All other quantities are
    those of free swimming, at the speed with no mean force. The passive end of the tail is straight. The body has the
    mass of the water that it displaces. Limbs have no effect.

    Args:
        robot: robot that swims, or its name in the catalog.
        motion: a gait; or a wave that the midline follows exactly, joints or not.
        water: density, viscosity and coefficients; fresh water if None.
        stations: points along the midline.

    Returns:
        A record with the dimensions ``model``, ``time`` (one cycle) and ``station``; x runs from the snout to the tail,
        y to the right, in a frame that travels with the body.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        NotConverged: thrust and drag never balance.
    """
    swimmer, medium = ROBOTS.resolve(robot), water or Water()
    if isinstance(motion, Gait):
        check_limits(swimmer, motion)
        check_speeds(swimmer, motion)
    outline = Outline(swimmer, stations)
    body_motion = undulation(outline, motion)
    fixed_curve = cycle(outline, body_motion, *recoil(outline, body_motion, 0.0, medium))
    per_model: dict[str, list[float]] = {name: [] for name in _PER_MODEL}
    curves = []
    for model in MODELS.values():
        free = cruise(outline, body_motion, model, medium)
        curve = cycle(outline, body_motion, free.sway, free.turn)
        curves.append(curve)
        values = _numbers(swimmer, motion, outline, curve, free.speed, free.power, medium)
        for name, value in {"thrust_held": model(outline, fixed_curve, 0.0, medium).thrust, **values}.items():
            per_model[name].append(value)
    return _record(outline, motion, medium, curves, per_model)


_PER_MODEL = {
    "thrust_held": ("N", "mean force forward, kept from moving on"),
    "speed": ("m/s", "free swimming, forward"),
    "speed_lengths": ("1/s", "free swimming, in body lengths"),
    "power": ("W", "of the joints on the water"),
    "slip": ("1", "speed over that of the body wave"),
    "strouhal": ("1", SIMILARITY["strouhal"]),
    "water_cost_of_transport": ("1", "power over displaced weight and speed"),
    "head_yaw": ("rad", "amplitude of the head's direction"),
    **{name: ("1", SIMILARITY[name]) for name in ("reynolds", "froude", "swimming_number")},
}


def _numbers(
    robot: Robot, motion: Motion, outline: Outline, curve: MidlineCurve, speed: float, power: float, water: Water
) -> dict[str, float]:
    """Return speed, power, slip, cost of transport and the similarity numbers of a free swim.

    Args:
        robot: the design.
        motion: motion of the midline.
        outline: outline of the robot.
        curve: midline over one cycle.
        speed: forward [m/s].
        power: power of the body on the water [W].
        water: density and viscosity.
    """
    swing = float(np.ptp(curve.y[:, -1]))
    weight = GRAVITY * displaced_mass(outline)
    moving = speed != 0.0
    return {
        "speed": speed,
        "speed_lengths": speed / robot.length,
        "power": power,
        "slip": speed / wave_speed(outline, motion, curve),
        **swim_numbers(
            speed=speed, length=robot.length, frequency=motion.frequency, swing=swing, viscosity=water.viscosity
        )._asdict(),
        "water_cost_of_transport": power / (weight * abs(speed)) if moving else float("nan"),
        "head_yaw": float(np.ptp(curve.heading[:, 0])) / 2,
    }


def displaced_mass(outline: Outline, density: float = WATER_DENSITY) -> float:
    """Return the mass of the water that the body displaces; sections are ellipses [kg]."""
    half_width, half_height = outline.silhouette
    return float(density * np.pi * np.trapezoid(half_width * half_height, outline.s))


def wave_speed(outline: Outline, motion: Motion, curve: MidlineCurve) -> float:
    """Return the speed of the body wave towards the tail, negative if it runs to the head [m/s].

    A line is fitted to the phase of the lateral motion along the body, weighted with the squared amplitude.
    """
    count = len(curve.y)
    turning = np.exp(-2j * np.pi * np.arange(count) / count)
    harmonic = (turning[:, None] * curve.y).sum(axis=0)  # a product of matrices has other digits on more threads
    weight = np.abs(harmonic) ** 2
    if weight.sum() == 0.0:
        return float("inf")
    lag = -np.unwrap(np.angle(harmonic))
    s = outline.s - np.average(outline.s, weights=weight)
    k = float(np.sum(weight * s * lag) / np.sum(weight * s**2))
    return 2 * np.pi * motion.frequency / k if k else float("inf")


def _record(
    outline: Outline, motion: Motion, water: Water, curves: list[MidlineCurve], per_model: dict[str, list[float]]
) -> xr.Dataset:
    """Return the record of a swim by all models."""
    count = len(curves[0].x)
    data = xr.Dataset(
        coords={
            "model": list(MODELS),
            "time": ("time", np.arange(count) / count / motion.frequency, {"units": "s"}),
            "station": ("station", outline.s, {"units": "m", "long_name": "along the midline from the snout"}),
        }
    )
    for name, (unit, meaning) in _PER_MODEL.items():
        data[name] = ("model", per_model[name], {"units": unit, "long_name": meaning})
    for field, unit in (("x", "m"), ("y", "m"), ("heading", "rad"), ("x_rate", "m/s"), ("y_rate", "m/s")):
        values = np.stack([getattr(curve, field) for curve in curves])
        data[field] = (("model", "time", "station"), values, {"units": unit})
    for name, values in outline.silhouette._asdict().items():
        data[name] = ("station", values, {"units": "m"})
    data["displaced_mass"] = ((), displaced_mass(outline, water.density), {"units": "kg"})
    data.attrs.update(schema="suchus swim record 1", robot=outline.robot.name, motion=motion.name)
    return data


def survey(robot: Robot, motions: Sequence[Gait], *, water: Water | None = None, stations: int = 65) -> xr.Dataset:
    """Return the results of both slender-body models for motions, and whether the robot can follow them.

    Args:
        robot: robot that swims.
        motions: how.
        water: fresh water if None.
        stations: points along the midline; 65 change the speed by less than 1 % from 257.

    Returns:
        ``VALUES`` along ``model`` and ``motion``, and ``possible`` along ``motion``: joints and servos can follow it.
    """
    outline, medium = Outline(robot, stations), water or Water()
    values = np.array(
        [[_evaluate_motion(outline, motion, model, medium) for motion in motions] for model in MODELS.values()]
    )
    data = {name: (("model", "motion"), values[:, :, i], {"units": VALUES[name]}) for i, name in enumerate(VALUES)}
    possible = [_is_feasible(robot, motion) for motion in motions]
    return xr.Dataset({**data, "possible": ("motion", possible, {"units": "1"})}, coords={"model": list(MODELS)})


def max_amplitude_factor(robot: Robot, motion: Gait, *, max_factor: float = 4.0) -> float:
    """Return the greatest factor on all angles at which joints and servos can follow a motion, to 1e-4 [-].

    Args:
        robot: robot that swims.
        motion: how.
        max_factor: factor that is not gone beyond [-].
    """
    lower_bound, upper_bound = 0.0, max_factor
    if _is_feasible(robot, motion.bent(upper_bound)):
        return upper_bound
    while upper_bound - lower_bound > 1e-4:
        middle = 0.5 * (lower_bound + upper_bound)
        if _is_feasible(robot, motion.bent(middle)):
            lower_bound = middle
        else:
            upper_bound = middle
    return lower_bound


def _evaluate_motion(outline: Outline, motion: Gait, model: Model, water: Water) -> tuple[float, ...]:
    """Return ``VALUES`` of one motion by one model."""
    free = cruise(outline, motion, model, water)
    if free.speed == 0.0:
        return 0.0, 0.0, float("nan"), float("nan"), 0.0
    curve = cycle(outline, motion, free.sway, free.turn)
    straight = straight_motion(outline, motion.frequency)
    drag = -model(outline, cycle(outline, straight), free.speed, water).thrust * float(np.sign(free.speed))
    swing = float(np.ptp(curve.y[:, -1]))
    return (
        free.speed,
        efficiency(drag, free.speed, free.power),
        free.power / (GRAVITY * displaced_mass(outline, water.density) * abs(free.speed)),
        motion.frequency * swing / abs(free.speed),
        free.speed / wave_speed(outline, motion, curve),
    )


def _is_feasible(robot: Robot, motion: Gait) -> bool:
    """Return whether joints and servos can follow a motion."""
    try:
        check_limits(robot, motion)
        check_speeds(robot, motion)
    except OutsideLimits:
        return False
    return True
