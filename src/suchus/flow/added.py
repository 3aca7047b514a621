"""Added mass of a body, from the pressure equation that the solver itself uses."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from suchus.flow.markers import Markers
from suchus.flow.pose import TURNS
from suchus.flow.twist import Twists, held_faces, none, part_of, rise
from suchus.flow.water import Fluid

_LIMIT = 1e-5
"""Divergence left over, relative to the accelerations [-]."""
_ROUGH = 1e-4
"""The same where the matrix is to guess what a step's own solve then tells [-]."""


class AddedMass(NamedTuple):
    """What the water does as parts of bodies are accelerated together, in each of some modes."""

    matrix: np.ndarray
    """Added mass, shape (mode, mode): the force in mode i is ``-matrix[i, k]`` per unit acceleration of mode k."""
    pressed: np.ndarray
    """What the pressure then does inside the parts, as ``log.FlowLoads.pressed`` but about the origin of the grid's
    frame, shape (mode, row, 1 + axis)."""


def added_mass(
    water: Fluid, markers: Markers, about: tuple[float, ...], density: float, body: int = 0,
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
    axes, cut = water.axes, water.cut[body]
    kept = symmetric(cut)
    if wanted is not None:  # in open water the body's whole momentum counts, that along other axes too
        unbounded = water.layers[-1].border.water is not None and axes == 3
        asked = [bool(one) or (unbounded and k < axes) for k, one in enumerate(wanted)]
        kept = [keep and one for keep, one in zip(kept, asked, strict=True)]
    modes = [mode for mode, keep in zip(_rigid(water, about, body), kept, strict=True) if keep]
    answers = _Answers.of(water, modes, _LIMIT, sides_held=False)
    volume, both = water.grid.cell**axes, np.ix_(kept, kept)
    whole = np.full((len(kept), len(kept)), np.nan)
    shore = water.layers[-1].grid.cell ** axes
    held = _in_open_water(volume * answers.held, volume * answers.own, answers.shores, answers.inward, shore)
    of_body = slice(water.rows[body].start, water.rows[body].stop)
    mine = [_part(mode, of_body) for mode in modes]
    whole[both] = 2 ** sum(cut) * density * (held + _rim(water, [markers], [mine], [cut]))
    return whole


def generalised_added_mass(
    water: Fluid, outlines: Sequence[Markers], modes: Sequence[Twists], density: float
) -> AddedMass:
    """Return the added mass for motions of all bodies together, such as those of joints.

    The sides of the domain are held, so that it is, if anything, too large. What lies beyond mirrors is counted.

    Args:
        water: with the bodies placed.
        outlines: of each body.
        modes: velocities of all parts of all bodies for unit rates, symmetric about mirrors that cut the bodies.
        density: of the water [kg/m^3].

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    answers, mine = _Answers.of(water, modes, _ROUGH, sides_held=True), []
    for rows in water.rows:
        own = slice(rows.start, rows.stop)
        mine.append([_part(mode, own) for mode in modes])
    rim = _rim(water, outlines, mine, water.cut)
    answers.held += _apart(water, modes, answers.across)
    times, h, corner = 2 ** max(sum(cut) for cut in water.cut), water.grid.cell, np.array(water.grid.origin)
    whole: np.ndarray = times * density * (h**water.axes * answers.held + rim)
    pressed = times * density * h ** (water.axes + 1) * answers.pressed
    pressed[..., 1:] = h * pressed[..., 1:] + pressed[..., :1] * corner
    return AddedMass(0.5 * (whole + whole.T), pressed)


def _apart(water: Fluid, modes: Sequence[Twists], across: np.ndarray) -> np.ndarray:
    """Return the work of each mode against what takes away that links are pushed apart, shape (mode, mode)."""
    axes, h, corner = water.axes, water.grid.cell, np.array(water.grid.origin)
    turns = len(TURNS[axes])
    moves = np.array([
        np.concatenate([replace(mode, about=mode.about - corner).at_origin(), h * mode.angular], axis=1)
        for mode in modes
    ])  # fmt: skip
    return np.asarray(np.einsum("irc,jrc->ij", moves, across[:, :, : axes + turns]))


def symmetric(cut: tuple[bool, ...]) -> list[bool]:
    """Return which modes are symmetric about the mirrors that cut a body; see ``body.cuts``."""
    across = [low or high for low, high in zip(cut[::2], cut[1::2], strict=True)]
    return [*(not off for off in across), *(not (across[a] or across[b]) for a, b in TURNS[len(across)])]


def _rigid(water: Fluid, about: tuple[float, ...], body: int) -> list[Twists]:
    """Return the rigid motions of one body along each axis and about a point, the others at rest."""
    axes, rows, found = water.axes, water.rows[body], []
    turns = len(TURNS[axes])
    for k in range(axes + turns):
        mode = none(len(water.given), axes)
        mode.about[:] = about
        (mode.linear if k < axes else mode.angular)[rows.start : rows.stop, k if k < axes else k - axes] = 1.0
        found.append(mode)
    return found


def _part(mode: Twists, rows: slice) -> Twists:
    """Return the motion of the parts of one body."""
    return Twists(about=mode.about[rows], linear=mode.linear[rows], angular=mode.angular[rows])


@dataclass(slots=True)
class _Answers:
    """What the water does as the bodies are accelerated in some modes, over the density and the volume of a cell."""

    held: np.ndarray
    """What the pressure does against each mode in each, the sides held, shape (mode, mode) [m^2/s^2]."""
    own: np.ndarray
    """The same of the bodies' own region in the place of the water."""
    shores: list[list[np.ndarray]]
    """Potential along each side, mode by mode [m/s^2 cells]."""
    inward: list[list[np.ndarray]]
    """Acceleration that each mode induces on each side; empty in bounded water [m/s^2]."""
    pressed: np.ndarray
    """What the potential does inside each part, mode by mode; see ``Fluid.pressures``."""
    across: np.ndarray
    """What takes away that it pushes links apart, mode by mode, shape (mode, row, ...); see ``Fluid.across``."""

    @classmethod
    def of(cls, water: Fluid, modes: Sequence[Twists], limit: float, *, sides_held: bool) -> "_Answers":
        """Return the answers of the water around placed bodies to a limit [-]; of sides that are held there is none."""
        faces, axes = held_faces(water), water.axes
        shape = tuple(s.stop - s.start for s in water.here)
        rises, moves, shores, inward, inside, across = [], [], [], [], [], []
        for mode in modes:
            parts = [mode.at(one.row, one.points)[c] for c, one in enumerate(faces)]
            scale = max(float(np.abs(part).max(initial=0.0)) for part in parts) or 1.0
            given = np.zeros((axes, *shape))
            for c, (one, part) in enumerate(zip(faces, parts, strict=True)):
                given[c].ravel()[one.place] = one.closed * part / scale
            x = water.potential(given, limit)
            shores.append([scale * line.astype(np.float64) for line in water.along_sides(x)])
            rises.append([scale * rise(water, x, one, c) for c, one in enumerate(faces)])
            inside.append(water.pressures(x, scale))
            across.append(water.across(x, scale))
            inward.append([] if sides_held else [scale * side for side in water.answer(given)])
            moves.append([one.closed * part for one, part in zip(faces, parts, strict=True)])
        held, own = (
            np.array([[_work(mode, parts) for parts in what] for mode in moves])
            for what in (rises, [[m.at(one.row, one.points)[c] for c, one in enumerate(faces)] for m in modes])
        )
        return cls(held, own, shores, inward, np.array(inside), np.array(across))


def _work(mode: list[np.ndarray], parts: list[np.ndarray]) -> float:
    """Return what a mode does against a field, on the bodies' share of the faces."""
    return float(sum((a * part).sum() for a, part in zip(mode, parts, strict=True)))


def _rim(
    water: Fluid, outlines: Sequence[Markers], modes: Sequence[Sequence[Twists]],
    cut: Sequence[tuple[bool, ...]],
) -> np.ndarray:  # fmt: skip
    """Return the mass over the density of the skin that the immersion holds with the bodies, per mode and mode.

    Args:
        water: with the bodies placed.
        outlines: of each body.
        modes: motions of the parts of each body.
        cut: which mirrors cut each body.
    """
    total = np.zeros((len(modes[0]), len(modes[0])))
    for outline, own, ends in zip(outlines, modes, cut, strict=True):
        skin = water.offset * water.grid.cell * 0.5 ** sum(ends) * outline.share
        row = part_of(outline)
        moves = np.array([mode.at(row, outline.points) for mode in own])
        total += np.einsum("icm,jcm,m->ij", moves, moves, skin)
    return total


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
        volume: of a cell at the sides [m^2, m^3].
    """
    if not inward[0]:
        return held
    gain = np.array([[sum(float((p * q).sum()) for p, q in zip(a, b, strict=True)) for b in inward] for a in shores])
    answer = np.linalg.solve((held + own).T, volume * gain.T).T  # per momentum of the mode
    open_water: np.ndarray = np.linalg.solve(np.eye(len(held)) - answer, held + answer @ own)
    return open_water
