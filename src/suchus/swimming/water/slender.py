"""Slender-body models of swimming on the robot's midline: resistive after Taylor, reactive after Lighthill.

Both treat every section by itself. The resistive model computes the drag of its velocity. The reactive model computes
the momentum of the water beside it, which is shed at the tail. Neither has a wake or the flow around the head. The body
swims towards -x at the speed U.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from suchus.core.errors import NotConverged
from suchus.robot.design.water import Water
from suchus.swimming.water.outline import MidlineCurve, Outline, cumulative_positions
from suchus.swimming.water.undulation import Motion, undulation

_TIMES = 96
"""Instants of a cycle [-]."""
_THRUST_TOLERANCE = 1e-5
"""Thrust over that which the power would give at three wave speeds, below which it is rounding [-]."""


class Effort(NamedTuple):
    """Mean thrust and power over a cycle."""

    thrust: float
    """Force forward [N]."""
    power: float
    """Power of the joints on the water [W]."""


Model = Callable[[Outline, MidlineCurve, float, Water], Effort]
"""From the midline's motion over a cycle, and the speed forward [m/s], to the effort."""


def resistive(outline: Outline, curve: MidlineCurve, speed: float, water: Water) -> Effort:
    """Return thrust and power after Taylor: drag square to the body, friction along it.

    Args:
        outline: outline of the robot.
        curve: its midline over one cycle, shape (time, station).
        speed: forward [m/s].
        water: the coefficients.

    Source: Taylor 1952, Proc. R. Soc. A 214, 158.
    """
    tangent_x, tangent_y, normal_velocity, tangential_velocity = _velocities(curve, speed)
    perimeter = _perimeter(outline)
    fastest = float(np.sqrt(np.mean(tangential_velocity**2)))
    normal = (
        -water.density * water.cross_drag * outline.silhouette.half_height * np.abs(normal_velocity) * normal_velocity
    )
    rub = (
        -0.5
        * water.density
        * water.friction(fastest, outline.robot.length)
        * perimeter
        * np.abs(tangential_velocity)
        * tangential_velocity
    )
    force_x = -normal * tangent_y + rub * tangent_x
    thrust = -_over_body(outline, force_x)
    power = -_over_body(outline, normal * normal_velocity + rub * tangential_velocity) + thrust * speed
    return Effort(thrust, power)


def reactive(outline: Outline, curve: MidlineCurve, speed: float, water: Water) -> Effort:
    """Return thrust and power after Lighthill: momentum shed at the tail, minus the body's friction.

    The mean force is the momentum flux through the plane normal to the body at the tip of the tail, with the pressure
    on that plane. The water must leave there: the model is not valid for a body that swims tail first. Its thrust at
    rest is the same for a wave and its reverse.

    Args:
        outline: outline of the robot.
        curve: its midline over one cycle, shape (time, station).
        speed: forward [m/s].
        water: density and friction.

    Source: Lighthill 1971, Proc. R. Soc. B 179, 125.
    """
    tangent_x, tangent_y, normal_velocity, tangential_velocity = _velocities(curve, speed)
    added_mass = water.density * np.pi * outline.silhouette.half_height[-1] ** 2
    w, u, tx, ty = normal_velocity[:, -1], tangential_velocity[:, -1], tangent_x[:, -1], tangent_y[:, -1]
    shed_momentum = u * added_mass * w * -ty - 0.5 * added_mass * w**2 * tx
    thrust = -float(np.mean(shed_momentum))
    wake = float(np.mean(-u * 0.5 * added_mass * w**2))  # energy that the shed water carries away
    surface = float(np.trapezoid(_perimeter(outline), outline.s))
    drag = 0.5 * water.density * water.friction(abs(speed), outline.robot.length) * surface * abs(speed) * speed
    return Effort(thrust - drag, wake + thrust * speed)


def recoil(outline: Outline, motion: Motion, speed: float, water: Water) -> tuple[complex, complex]:
    """Return the sway of the snout and the turn of the head of a free body.

    Lateral motions are small. Body and water exchange no net lateral momentum and no net moment about the snout over
    time, by Lighthill's reactive force. The body has the mass of the water that it displaces.

    Args:
        outline: outline of the robot.
        motion: its motion.
        speed: forward [m/s].
        water: density.

    Returns:
        Harmonics of the snout's displacement to the right [m] and of the head's direction [rad]: ``Re(h exp(2 pi i f
        t))``.
    """
    body_motion = undulation(outline, motion)
    omega = 2 * np.pi * body_motion.frequency
    s, (half_width, half_height) = outline.s, outline.silhouette
    slope, shape = (
        body_motion.stations[1],
        cumulative_positions(body_motion.sway[1], (s[1] - s[0]) * body_motion.middles[1]),
    )
    mass, added_mass = water.density * np.pi * half_width * half_height, water.density * np.pi * half_height**2

    def balance(y: np.ndarray, dy: np.ndarray) -> np.ndarray:
        """Return net lateral force and moment of a lateral motion, body and water."""
        momentum = added_mass * (1j * omega * y + speed * dy)
        rate = -(omega**2) * mass * y + 1j * omega * momentum + speed * np.gradient(momentum, s)
        return np.array([np.trapezoid(rate, s), np.trapezoid(rate * s, s)])

    columns = [balance(np.ones_like(s) + 0j, np.zeros_like(s)), balance(s + 0j, np.ones_like(s))]
    sway, turn = np.linalg.solve(np.column_stack(columns), -balance(shape, slope))
    return complex(sway), complex(turn)


def cycle(outline: Outline, motion: Motion, sway: complex = 0j, turn: complex = 0j) -> MidlineCurve:
    """Return the midline over one cycle, shape (time, station), with given sway of the snout and turn of the head."""
    body_motion = undulation(outline, motion)
    return body_motion.with_head_motion(sway, turn).curve(np.arange(_TIMES) / _TIMES / body_motion.frequency)


class Cruise(NamedTuple):
    """Free swimming at a steady mean speed."""

    speed: float
    """Forward; negative if it goes tail first [m/s]."""
    power: float
    """Power of the joints on the water [W]."""
    sway: complex
    """Harmonic of the snout's displacement to the side [m]."""
    turn: complex
    """Harmonic of the head's direction [rad]."""


def cruise(outline: Outline, motion: Motion, model: Model, water: Water) -> Cruise:
    """Return the speed at which a model's thrust vanishes.

    Raises:
        NotConverged: no speed up to three wave speeds balances the forces.
    """
    body_motion = undulation(outline, motion)
    max_speed = 3.0 * body_motion.frequency * outline.robot.length

    def effort(speed: float) -> Effort:
        return model(outline, cycle(outline, body_motion, *recoil(outline, body_motion, speed, water)), speed, water)

    rest_effort = effort(0.0)
    if abs(rest_effort.thrust) <= _THRUST_TOLERANCE * rest_effort.power / max_speed:
        return Cruise(0.0, rest_effort.power, *recoil(outline, body_motion, 0.0, water))
    start = 0.0
    for share in np.geomspace(0.01, 1.0, 9):
        end = float(np.copysign(share * max_speed, rest_effort.thrust))
        if effort(end).thrust * rest_effort.thrust <= 0:
            speed = float(brentq(lambda speed: effort(speed).thrust, start, end, xtol=1e-6))
            return Cruise(speed, effort(speed).power, *recoil(outline, body_motion, speed, water))
        start = end
    raise NotConverged(
        f"no speed up to {max_speed:.3g} m/s balances thrust and drag of {body_motion.name!r}; raise cross_drag or "
        "thickening."
    )


def _velocities(curve: MidlineCurve, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the tangent, and the velocity relative to the water normal to the midline and along it."""
    tangent_x, tangent_y = np.cos(curve.heading), np.sin(curve.heading)
    x_rate = curve.x_rate - speed
    normal_velocity = -tangent_y * x_rate + tangent_x * curve.y_rate
    tangential_velocity = tangent_x * x_rate + tangent_y * curve.y_rate
    return tangent_x, tangent_y, normal_velocity, tangential_velocity


def _perimeter(outline: Outline) -> np.ndarray:
    """Return the perimeter of the body at the stations by Ramanujan's formula for ellipses [m]."""
    half_width, half_height = outline.silhouette
    return np.asarray(
        np.pi
        * (3 * (half_width + half_height) - np.sqrt((3 * half_width + half_height) * (half_width + 3 * half_height)))
    )


def _over_body(outline: Outline, density: Float[np.ndarray, "time station"]) -> float:
    return float(np.mean(np.trapezoid(density, outline.s, axis=-1)))
