"""The passive end of the tail, which the water bends against its springs."""

from dataclasses import replace

import numpy as np

from suchus.robot.design import Spring
from suchus.robot.design.water import Water
from suchus.swimming.water.outline import Outline, cumulative_positions
from suchus.swimming.water.slender import recoil
from suchus.swimming.water.undulation import Motion, Undulation, undulation

_ROUNDS = 12
"""Rounds in which drag, recoil and bends are brought to agree; the last changes the bends by less than 1e-4 [-]."""


def with_passive_end(outline: Outline, motion: Motion, speed: float, water: Water | None = None) -> Undulation:
    """Return a motion whose passive end yields to the water, for a free body.

    The spring and the damper of each passive joint balance three moments: Lighthill's reaction of the water beyond the
    joint, the drag across the body, and the inertia of the end, which has the mass of its water. The drag is linearised
    with equal work for a sine. The model has a first harmonic, small bends, a round body and no wake.

    Args:
        outline: outline of the robot.
        motion: motion of the joints that are driven.
        speed: forward [m/s].
        water: fresh water if None.
    """
    medium, driven_motion = water or Water(), undulation(outline, motion)
    middle = 0.5 * (outline.s[1:] + outline.s[:-1])
    middles, stations = outline.passive_at(middle), outline.passive_at(outline.s)
    step = outline.s[1] - outline.s[0]
    shapes = np.stack([cumulative_positions(np.zeros(()), step * column) for column in middles.T])
    bends = np.zeros(len(shapes), complex)
    for _ in range(_ROUNDS):
        limber = _with_bend(driven_motion, middles @ bends, stations @ bends)
        sway, turn = recoil(outline, limber, speed, medium)
        slope = limber.stations[1] + turn
        y = cumulative_positions(limber.sway[1] + sway, step * (limber.middles[1] + turn))
        load = _Load(outline, driven_motion.frequency, speed, medium, y, slope)
        response = np.array([load.moments(shape, column) for shape, column in zip(shapes, stations.T, strict=True)]).T
        load_moments = load.moments(y - shapes.T @ bends, slope - stations @ bends)
        bends = np.linalg.solve(np.diag(_springs(outline, driven_motion.frequency)) - response, load_moments)
    return _with_bend(driven_motion, middles @ bends, stations @ bends)


def _with_bend(base_motion: Undulation, middles: np.ndarray, stations: np.ndarray) -> Undulation:
    """Return a motion with a first harmonic added to its headings."""
    more_middles, more_stations = np.zeros_like(base_motion.middles), np.zeros_like(base_motion.stations)
    more_middles[1], more_stations[1] = middles, stations
    return replace(
        base_motion, middles=base_motion.middles + more_middles, stations=base_motion.stations + more_stations
    )


def _springs(outline: Outline, frequency: float) -> np.ndarray:
    """Return the complex stiffness of each passive joint at a frequency, by spring and damper [N m/rad]."""
    drives = {hinge.name: hinge.drive for hinge in outline.robot.axis_hinges}
    springs = [drives[outline.joints[i]] for i in outline.passive]
    return np.array([s.stiffness + 2j * np.pi * frequency * s.damping for s in springs if isinstance(s, Spring)])


class _Load:
    """Load of the water on a section in a lateral motion, linear in that motion."""

    def __init__(
        self, outline: Outline, frequency: float, speed: float, water: Water, y: np.ndarray, slope: np.ndarray
    ) -> None:
        """Compute added mass, mass and linearised drag of the stations in a lateral motion.

        Args:
            outline: outline of the robot.
            frequency: frequency of the motion [Hz].
            speed: forward [m/s].
            water: density and drag coefficient.
            y: first harmonic of the lateral displacement [m].
            slope: first harmonic of the heading [rad].
        """
        self._s, self._speed, self._rate = outline.s, speed, 2j * np.pi * frequency
        half_width, half_height = outline.silhouette
        self._added_mass = water.density * np.pi * half_height**2
        self._mass = water.density * np.pi * half_width * half_height
        lateral_speed = np.abs(self._rate * y + speed * slope)
        self._drag = water.density * water.cross_drag * half_height * 8.0 / (3.0 * np.pi) * lateral_speed
        self._joints = outline.joint_positions[list(outline.passive)]

    def moments(self, y: np.ndarray, slope: np.ndarray) -> np.ndarray:
        """Return the moments about the passive joints of the water's load beyond them in a lateral motion [N m]."""
        lateral_velocity = self._rate * y + self._speed * slope
        momentum = self._added_mass * lateral_velocity
        force = -(self._rate * momentum + self._speed * np.gradient(momentum, self._s))
        force = force - self._drag * lateral_velocity - self._rate**2 * self._mass * y
        arms = np.maximum(self._s - self._joints[:, None], 0.0)
        return np.asarray(np.trapezoid(force * arms, self._s, axis=-1))
