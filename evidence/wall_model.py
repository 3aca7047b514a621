"""A study, not a part of the package: walls in one dimension, solved exactly, for the wall of today and for others.

Water moves along a wall, nodes a cell apart lie anywhere to it, and all depends on the distance alone. One stage takes
the slip of the water over the wall from ``u`` to ``(keep + gain) @ u``, with everything in cells, and a ``spread`` of
viscosity times the step over the cell squared. So the place where the water rests is the solution of a linear system,
stability an eigenvalue, and friction on a wall that swings to and fro a short run. A wall is a function of the nodes'
distances and of the spread; ``WALLS`` are those that were compared, and the passage ``walls`` of docs/flow_trials.md
has the results.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from suchus.flow import immerse

INSIDE, OUTSIDE = 8, 60
"""Nodes inside the wall and outside of it [-]."""

NEAR, FAR, DEEP = 1.0, 2.0, 2.0
"""Distances at which ``carried`` reads the water, and depth to which it carries it on [cells]."""


class Stage(NamedTuple):
    """What one stage of a wall does."""

    keep: np.ndarray
    """What becomes of the slip that there was, shape (node, node)."""
    gain: np.ndarray
    """What friction in the water adds, per slip, shape (node, node)."""
    momentum_weights: np.ndarray
    """Weights that make the water's momentum of the slip, shape (node,) [cells]."""
    lag: np.ndarray
    """Share of a change of the wall's speed that the water does not know of yet, shape (node,)."""


def _acting(keep: np.ndarray, spread: float, wet: np.ndarray) -> Stage:
    """Return the stage that lets the water's own step through ``keep``."""
    count = len(keep)
    return Stage(keep, keep @ (spread * diffusion(count)), wet, keep @ np.ones(count))


Wall = Callable[[np.ndarray, float], Stage]
"""A wall: its stage for signed distances of the nodes, shape (node,) [cells], and a spread [-]."""


def nodes(place: float) -> np.ndarray:
    """Return the signed distances of the nodes, the first one outside at ``place`` from 0 to 1 [cells]."""
    return np.arange(-INSIDE, OUTSIDE + 1) + place


def diffusion(count: int) -> np.ndarray:
    """Return the second difference, 0 at both ends, shape (node, node)."""
    out = np.diag(np.ones(count - 1), 1) - 2 * np.eye(count) + np.diag(np.ones(count - 1), -1)
    out[[0, -1]] = 0
    return out


def _moments(distance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return tuple(np.array([part(float(d)) for d in distance]) for part in (immerse.moment0, immerse.moment1))


def _immersion(distance: np.ndarray) -> np.ndarray:
    share, moment = _moments(distance)
    return np.diag(share) + np.diag(moment[:-1] / 2, 1) - np.diag(moment[1:] / 2, -1)


def immersed(distance: np.ndarray, spread: float) -> Stage:
    """Immersion of the whole state, as the solver's, without an offset."""
    return _acting(_immersion(distance), spread, _moments(distance)[0])


def of_today(distance: np.ndarray, spread: float) -> Stage:
    """The solver's wall: immersion of the whole state, set off by ``immerse.wall_offset``."""
    return immersed(distance - immerse.wall_offset(spread), spread)


def of_increments(distance: np.ndarray, spread: float) -> Stage:
    """Immersion of the step's increment alone: what the water has is kept."""
    count, share = distance.size, _moments(distance)[0]
    return Stage(np.eye(count), _immersion(distance) @ (spread * diffusion(count)), share, share)


def cut_cells(distance: np.ndarray, spread: float) -> Stage:
    """Finite volumes cut by the wall; one less than half open is merged with the next."""
    count = distance.size
    share = np.clip(distance + 0.5, 0, 1)
    own = int(np.flatnonzero(share >= 0.5)[0])
    volume = share[own] + share[own - 1]
    middle = volume / 2
    live = np.where(np.arange(count) >= own, 1.0, 0.0)
    gain = diffusion(count)
    up, wall = np.zeros(count), np.zeros(count)  # the fluxes between the first two cells and at the wall
    up[own : own + 2] = np.array([-1, 1]) / (distance[own + 1] - middle)
    wall[own] = 1 / middle
    gain[:own] = 0
    gain[own] = (up - wall) / volume
    gain[own + 1] = np.eye(count)[own + 2] - np.eye(count)[own + 1] - up
    wet = live.copy()
    wet[own] = volume
    return Stage(np.diag(live), spread * gain, wet, live)


def _at(distance: np.ndarray, place: float) -> tuple[np.ndarray, float]:
    """Return what reads the slip at a place linearly between two nodes, and how far that is off for ``d^2``."""
    k = int(np.floor(place - distance[0]))
    share = place - distance[k]
    out = np.zeros(distance.size)
    out[k : k + 2] = 1 - share, share
    return out, share * (1 - share)


def carried(distance: np.ndarray, spread: float, width: float = 1.0) -> Stage:
    """Immersion, then the parabola through the wall and two places off it in the share that is not the water's.

    The parabola takes up that places between nodes are read linearly. A state that is one comes out as it went in.

    Args:
        distance: signed distances of the nodes, shape (node,) [cells].
        spread: viscosity times the step over the cell squared [-].
        width: reach of the kernel to either side of the wall [cells].
    """
    count, (share, _) = distance.size, _moments(distance / width)
    near, bow = _at(distance, NEAR)
    far, bow_far = _at(distance, FAR)
    p, q = NEAR**2 + bow, FAR**2 + bow_far
    slope, bend = (q * near - p * far) / (NEAR * q - FAR * p), (NEAR * far - FAR * near) / (NEAR * q - FAR * p)
    back = np.outer(distance, slope) + np.outer(distance**2, bend)
    back[distance < -DEEP] = 0
    blend = share[:, None] * np.eye(count) + (1 - share)[:, None] * back
    return _acting(blend, spread, share)


def carried_far(distance: np.ndarray, spread: float) -> Stage:
    """Return the wall of ``carried`` with a kernel that is twice as wide."""
    return carried(distance, spread, 2.0)


WALLS: dict[str, Wall] = {
    "immersion without an offset": immersed, "today's: immersion with an offset": of_today,
    "immersion of increments": of_increments, "cut cells, merged": cut_cells, "parabola carried to the wall": carried,
    "parabola carried to the wall, kernel twice as wide": carried_far,
}  # fmt: skip
"""The walls that were compared, by name."""


def rest(wall: Wall, place: float, spread: float) -> float:
    """Return where a steady profile of slope 1 far off rests, in cells outside the wall."""
    distance = nodes(place)
    stage = wall(distance, spread)
    system = np.eye(distance.size) - stage.keep - stage.gain
    system[-1] = 0
    system[-1, -2:] = -1, 1
    right = np.zeros(distance.size)
    right[-1] = 1
    dead = np.abs(system).sum(axis=1) < 1e-12  # what is kept as it is inside rests with the wall
    system[dead, dead] = 1
    profile = np.linalg.solve(system, right)
    return float(distance[-2] - profile[-2])


def growth(wall: Wall, place: float, spread: float) -> float:
    """Return the largest factor by which a step of Heun's method changes anything."""
    stage = wall(nodes(place), spread)
    keep, gain = stage.keep[:-1, :-1], stage.gain[:-1, :-1]
    once = keep + gain
    return float(np.abs(np.linalg.eigvals(0.5 * (once + keep + gain @ once))).max())


def friction(wall: Wall, place: float, spread: float, layer: float, periods: float = 1.5) -> complex:
    """Return the friction on a wall that swings along itself over the exact one, in the last period [-].

    The absolute value is what the amplitude is off by, the angle the phase.

    Args:
        wall: which.
        place: of the nodes, from 0 to 1 [cells].
        spread: of a step [-].
        layer: ``sqrt(2 viscosity / angular frequency)`` [cells].
        periods: how long, from the exact profile on [-].
    """
    distance, rate = nodes(place), 2 / layer**2
    decay, steps = np.sqrt(1j * rate), round(2 * np.pi / rate / spread)
    dt = 2 * np.pi / rate / steps
    keep, gain, wet, lag = wall(distance, dt)
    slip = np.exp(-decay * np.maximum(distance, 0)).real - 1  # of the water over the wall, whose speed is a cosine
    total, exact = 0j, 0j
    for k in range(round(periods * steps)):
        time = (k + 1) * dt
        shift = np.cos(rate * time) - np.cos(rate * (time - dt))  # of the wall's speed
        held = keep @ slip - shift * lag
        once = held + gain @ slip
        new = 0.5 * once + 0.5 * (held + gain @ once)
        push = (wet @ (new - slip) + shift * wet.sum()) / dt
        slip = new
        if k >= (periods - 1) * steps:
            turn = np.exp(-1j * rate * (time - dt / 2))
            total += push * turn
            exact += (decay / turn).real * turn
    return complex(total / exact)


PLACES = (np.arange(20) + 0.5) / 20
"""Places of the nodes over which walls are compared [cells]."""


def compared() -> dict[str, dict[str, float]]:
    """Return what each wall does, over the places of the nodes.

    Returns:
        by name of the wall: ``rest_0_01``, ``rest_0_1``, where a steady profile rests at these spreads [cells];
        ``friction``, that of a layer of two cells over the exact one [-], each with the ends ``_low`` and ``_high``;
        ``error``, the largest of the friction [-]; ``growth``, the largest factor of a step at a spread of 0.2 [-].
    """
    rows = {}
    for name, wall in WALLS.items():
        rubbed = np.array([friction(wall, place, 0.1, 2.0) for place in PLACES[::2]])
        ranges = {f"rest_{spread:g}".replace(".", "_"): [rest(wall, place, spread) for place in PLACES]
                  for spread in (0.01, 0.1)} | {"friction": np.abs(rubbed)}  # fmt: skip
        row = {}
        for quantity, values in ranges.items():
            row |= {quantity: np.mean(values), f"{quantity}_low": np.min(values), f"{quantity}_high": np.max(values)}
        row |= {"error": np.abs(rubbed - 1).max(), "growth": max(growth(wall, place, 0.2) for place in PLACES[::4])}
        rows[name] = {quantity: round(float(value), 6) + 0.0 for quantity, value in row.items()}
    return rows
