"""Slender-body models of swimming: resistive after Taylor, reactive after Lighthill, on the robot's own midline.

Both take every section of the body for itself. The resistive model drags it by its own velocity; the reactive one
gives it the momentum of the water beside it, which leaves at the tail. Neither knows the wake nor the flow around the
head. The body swims towards -x, at the speed U against the water.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from suchus.core.errors import NotConverged
from suchus.robot.design.water import Water
from suchus.swimming.water.outline import MidlineCurve, Outline, summed
from suchus.swimming.water.undulation import Motion, undulation

_TIMES = 96
"""Instants of a cycle [-]."""
_NOTHING = 1e-5
"""Thrust over that which the power would give at three wave speeds, below which it is rounding [-]."""


class Effort(NamedTuple):
    """Means over a cycle."""

    thrust: float
    """Force forward [N]."""
    power: float
    """Power of the joints on the water [W]."""


Model = Callable[[Outline, MidlineCurve, float, Water], Effort]
"""From the midline's motion over a cycle, and the speed forward [m/s], to the effort."""


def resistive(outline: Outline, curve: MidlineCurve, speed: float, water: Water) -> Effort:
    """Return thrust and power after Taylor: drag square to the body, friction along it.

    Args:
        outline: of the robot.
        curve: its midline over one cycle, shape (time, station).
        speed: forward [m/s].
        water: the coefficients.

    Source: Taylor 1952, Proc. R. Soc. A 214, 158.
    """
    tangent_x, tangent_y, across, along = _velocities(curve, speed)
    perimeter = _perimeter(outline)
    fastest = float(np.sqrt(np.mean(along**2)))
    normal = -water.density * water.cross_drag * outline.silhouette.half_height * np.abs(across) * across
    rub = -0.5 * water.density * water.friction(fastest, outline.robot.length) * perimeter * np.abs(along) * along
    force_x = -normal * tangent_y + rub * tangent_x
    thrust = -_over_body(outline, force_x)
    power = -_over_body(outline, normal * across + rub * along) + thrust * speed
    return Effort(thrust, power)


def reactive(outline: Outline, curve: MidlineCurve, speed: float, water: Water) -> Effort:
    """Return thrust and power after Lighthill: the momentum that sheds at the tail, less the body's friction.

    The mean force is that of the water that passes the plane through the tail's tip, square to the body, with the
    pressure on that plane. The water must leave there: the model knows nothing of a body that swims tail first, and
    its thrust at rest is the same for a wave and its reverse.

    Args:
        outline: of the robot.
        curve: its midline over one cycle, shape (time, station).
        speed: forward [m/s].
        water: density and friction.

    Source: Lighthill 1971, Proc. R. Soc. B 179, 125.
    """
    tangent_x, tangent_y, across, along = _velocities(curve, speed)
    added = water.density * np.pi * outline.silhouette.half_height[-1] ** 2
    w, u, tx, ty = across[:, -1], along[:, -1], tangent_x[:, -1], tangent_y[:, -1]
    shed = u * added * w * -ty - 0.5 * added * w**2 * tx
    thrust = -float(np.mean(shed))
    wake = float(np.mean(-u * 0.5 * added * w**2))  # energy that the shed water carries away
    surface = float(np.trapezoid(_perimeter(outline), outline.s))
    drag = 0.5 * water.density * water.friction(abs(speed), outline.robot.length) * surface * abs(speed) * speed
    return Effort(thrust - drag, wake + thrust * speed)


def recoil(outline: Outline, motion: Motion, speed: float, water: Water) -> tuple[complex, complex]:
    """Return how the snout sways and the head turns when nothing holds the body.

    Small lateral motions: body and the water beside it exchange no net lateral momentum and no moment about the
    snout over time, by Lighthill's reactive force. The body is as heavy as the water it displaces.

    Args:
        outline: of the robot.
        motion: its motion.
        speed: forward [m/s].
        water: density.

    Returns:
        Harmonics of the snout's displacement to the right [m] and of the head's direction [rad]: ``Re(h exp(2 pi i f
        t))``.
    """
    bent = undulation(outline, motion)
    omega = 2 * np.pi * bent.frequency
    s, (wide, high) = outline.s, outline.silhouette
    slope, shape = bent.stations[1], summed(bent.sway[1], (s[1] - s[0]) * bent.middles[1])
    mass, added = water.density * np.pi * wide * high, water.density * np.pi * high**2

    def balance(y: np.ndarray, dy: np.ndarray) -> np.ndarray:
        """Return net lateral force and moment of a lateral motion, body and water."""
        momentum = added * (1j * omega * y + speed * dy)
        rate = -(omega**2) * mass * y + 1j * omega * momentum + speed * np.gradient(momentum, s)
        return np.array([np.trapezoid(rate, s), np.trapezoid(rate * s, s)])

    columns = [balance(np.ones_like(s) + 0j, np.zeros_like(s)), balance(s + 0j, np.ones_like(s))]
    sway, turn = np.linalg.solve(np.column_stack(columns), -balance(shape, slope))
    return complex(sway), complex(turn)


def cycle(outline: Outline, motion: Motion, sway: complex = 0j, turn: complex = 0j) -> MidlineCurve:
    """Return the midline over one cycle, shape (time, station), its snout swaying and its head turning as given."""
    bent = undulation(outline, motion)
    return bent.held(sway, turn).curve(np.arange(_TIMES) / _TIMES / bent.frequency)


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
    bent = undulation(outline, motion)
    most = 3.0 * bent.frequency * outline.robot.length

    def effort(speed: float) -> Effort:
        return model(outline, cycle(outline, bent, *recoil(outline, bent, speed, water)), speed, water)

    held = effort(0.0)
    if abs(held.thrust) <= _NOTHING * held.power / most:
        return Cruise(0.0, held.power, *recoil(outline, bent, 0.0, water))
    start = 0.0
    for share in np.geomspace(0.01, 1.0, 9):
        end = float(np.copysign(share * most, held.thrust))
        if effort(end).thrust * held.thrust <= 0:
            speed = float(brentq(lambda speed: effort(speed).thrust, start, end, xtol=1e-6))
            return Cruise(speed, effort(speed).power, *recoil(outline, bent, speed, water))
        start = end
    raise NotConverged(
        f"no speed up to {most:.3g} m/s balances thrust and drag of {bent.name!r}; raise cross_drag or thickening."
    )


def _velocities(curve: MidlineCurve, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return tangent and the velocity against the water across and along it."""
    tangent_x, tangent_y = np.cos(curve.heading), np.sin(curve.heading)
    x_rate = curve.x_rate - speed
    across = -tangent_y * x_rate + tangent_x * curve.y_rate
    along = tangent_x * x_rate + tangent_y * curve.y_rate
    return tangent_x, tangent_y, across, along


def _perimeter(outline: Outline) -> np.ndarray:
    """Return the girth of the body at the stations, as of ellipses, by Ramanujan's formula [m]."""
    wide, high = outline.silhouette
    return np.asarray(np.pi * (3 * (wide + high) - np.sqrt((3 * wide + high) * (wide + 3 * high))))


def _over_body(outline: Outline, density: Float[np.ndarray, "time station"]) -> float:
    return float(np.mean(np.trapezoid(density, outline.s, axis=-1)))
