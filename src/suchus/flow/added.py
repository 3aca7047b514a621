"""Added mass of a body, from the pressure equation that the solver itself uses."""

from collections.abc import Sequence
from math import prod

import numpy as np

from suchus.flow.pose import TURNS
from suchus.flow.shape import Markers
from suchus.flow.solid import SkinMarkers
from suchus.flow.water import Fluid

_LIMIT = 1e-5
"""Divergence left over, relative to the accelerations [-]."""


def added_mass(
    water: Fluid, markers: Markers | SkinMarkers, about: tuple[float, ...], density: float, body: int = 0,
    wanted: Sequence[bool] | np.ndarray | None = None,
) -> np.ndarray:  # fmt: skip
    """Return the added mass for accelerations along each axis and about a point, in the plane of shape (3, 3).

    In space it is of shape (6, 6): along x, y and z, then about x, y and z. The bodies must have been placed; ``body``
    counts them. The force of mode k is ``-Ma[:, k]`` per unit acceleration; other bodies stay still. It is what
    ``momentum`` would find: the momentum that the immersion gives to the water. Units: kg/m in the plane and kg in
    space for the translations, times m between them and the turnings, times m^2 for the turnings. Where the sides move
    as in open water it is that of open water. What lies beyond mirrors is counted. Motions through a mirror that cuts
    the body, which are not symmetric, have NaN, and so have those that are not ``wanted``.

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    h, axes, cut = water.grid.cell, water.axes, water.cut[body]
    here, kept = water.here, symmetric(cut)
    if wanted is not None:  # in open water the body's whole momentum counts, that along other axes too
        unbounded = water.border.water is not None and axes == 3
        asked = [bool(one) or (unbounded and k < axes) for k, one in enumerate(wanted)]
        kept = [keep and one for keep, one in zip(kept, asked, strict=True)]
    modes = [mode for mode, keep in zip(_modes(water, about), kept, strict=True) if keep]
    rows = water.rows[body]
    own = [(owner >= rows.start) & (owner < rows.stop) for owner in water.owners]
    shares = [(1 - m[here].astype(np.float64)) * mine for m, mine in zip(water.passage, own, strict=True)]
    for share in shares:
        _leave_images(share, cut)
    rises, shores, inward = [], [], []
    for mode in modes:
        scale = max(float(np.abs(part).max()) for part in mode)
        given = np.stack([share * part for share, part in zip(shares, mode, strict=True)]) / scale
        potential = water.potential(given, _LIMIT)
        shores.append([scale * line.astype(np.float64) for line in water.along_sides(potential)])
        near = potential[tuple(slice(s.start - 1, s.stop) for s in here)].astype(np.float64)
        rises.append([scale * _rise(near, axes - 1 - c) for c in range(axes)])
        inward.append([scale * side for side in water.answer(given)])
    held, own_mass = (
        prod([h] * axes) * np.array([[_work(mode, shares, parts) for parts in what] for mode in modes])
        for what in (rises, modes)
    )
    both = np.ix_(kept, kept)
    whole = np.full((len(kept), len(kept)), np.nan)
    rim = _rim(water, markers, about, cut)[both]
    whole[both] = 2 ** sum(cut) * density * (_in_open_water(held, own_mass, shores, inward, prod([h] * axes)) + rim)
    return whole


def symmetric(cut: tuple[bool, ...]) -> list[bool]:
    """Return which modes are symmetric about the mirrors that cut a body; see ``body.cuts``."""
    across = [low or high for low, high in zip(cut[::2], cut[1::2], strict=True)]
    return [*(not off for off in across), *(not (across[a] or across[b]) for a, b in TURNS[len(across)])]


def _modes(water: Fluid, about: tuple[float, ...]) -> list[list[np.ndarray]]:
    """Return the velocity of each mode on the faces of the window, mode by mode and component by component."""
    axes, here = water.axes, water.here
    shape = tuple(s.stop - s.start for s in here)
    off = [
        np.expand_dims(water.grid.centres(s.start, s.stop, d) - about[d], [n for n in range(axes) if n != axes - 1 - d])
        for d, s in enumerate(reversed(here))
    ]
    ones, none = np.ones(shape), np.zeros(shape)
    modes = [[ones if c == d else none for c in range(axes)] for d in range(axes)]
    for a, b in TURNS[axes]:
        turn = {a: np.broadcast_to(-off[b], shape), b: np.broadcast_to(off[a], shape)}
        modes.append([turn.get(c, none) for c in range(axes)])
    return modes


def _leave_images(share: np.ndarray, cut: tuple[bool, ...]) -> None:
    """Set to nothing what lies beyond the mirrors that cut a body."""
    for k, is_cut in enumerate(cut):
        lines = np.moveaxis(share, share.ndim - 1 - k // 2, 0)
        if is_cut and k % 2 == 0:
            lines[0] = 0
        elif is_cut:
            lines[-2:] = 0


def _rise(near: np.ndarray, axis: int) -> np.ndarray:
    """Return how much a field rises from cell to cell along an axis, without the first cell along each."""
    inner = (slice(1, None),) * near.ndim
    rise: np.ndarray = near[inner] - near[tuple(slice(None, -1) if n == axis else s for n, s in enumerate(inner))]
    return rise


def _work(mode: list[np.ndarray], shares: list[np.ndarray], parts: list[np.ndarray]) -> float:
    """Return what a mode does against a field, on the body's share of the faces."""
    total = 0.0
    for a, share, part in zip(mode, shares, parts, strict=True):
        total += (a * share * part).sum()
    return total


def _rim(water: Fluid, markers: Markers | SkinMarkers, about: tuple[float, ...], cut: tuple[bool, ...]) -> np.ndarray:
    """Return the mass over the density of the skin that the immersion holds with the body, per mode and mode."""
    axes, turns = water.axes, TURNS[water.axes]
    off = [points - place for points, place in zip(markers.points, about, strict=True)]
    skin = water.offset * water.grid.cell * 0.5 ** sum(cut) * markers.share
    none = 0 * skin
    modes = [*({d: skin} for d in range(axes)), *({a: -off[b] * skin, b: off[a] * skin} for a, b in turns)]
    rims = np.array([[mode.get(c, none) for mode in modes] for c in range(axes)])  # component, mode, marker
    moments = [(off[a] * rims[b] - off[b] * rims[a]).sum(axis=1) for a, b in turns]
    return np.array([*rims.sum(axis=2), *moments])


def _in_open_water(
    held: np.ndarray, own: np.ndarray, shores: list[list[np.ndarray]], inward: list[list[np.ndarray]], volume: float
) -> np.ndarray:
    """Return the added mass in open water from that with the sides held.

    The sides move as the water and the body together, ``held + own``, make them. What that does to the body needs no
    further solve: by Green's theorem it is the potential along the sides times their velocity.

    Args:
        held: added mass with the sides held, over the density, shape (mode, mode).
        own: mass of the body's region, over the density, shape (mode, mode).
        shores: potential along each side, per mode [m/s^2 cells].
        inward: velocity that each mode induces on each side, per mode; empty in other water [m/s^2].
        volume: of a cell [m^2, m^3].
    """
    if not inward[0]:
        return held
    gain = np.array([[sum(float((p * q).sum()) for p, q in zip(a, b, strict=True)) for b in inward] for a in shores])
    answer = np.linalg.solve((held + own).T, volume * gain.T).T  # per momentum of the mode
    open_water: np.ndarray = np.linalg.solve(np.eye(len(held)) - answer, held + answer @ own)
    return open_water
