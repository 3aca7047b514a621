"""Added mass of a body, from the pressure equation that the solver itself uses."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from suchus.flow.markers import Markers
from suchus.flow.pose import ROTATION_PLANES
from suchus.flow.twist import Twists, face_differences, held_faces, part_indices, resting_twists
from suchus.flow.water import Fluid

_RESIDUAL_TOLERANCE = 1e-5
"""Divergence that the pressure solve may leave, relative to the accelerations [-]."""
_GUESS_TOLERANCE = 1e-4
"""The same where the added mass only starts an iteration that solves for the pressure itself [-]."""


class AddedMass(NamedTuple):
    """Response of the water to accelerations of the bodies' parts, mode by mode."""

    matrix: np.ndarray
    """Added mass, shape (mode, mode): the force in mode i is ``-matrix[i, k]`` per unit acceleration of mode k."""
    internal_pressure: np.ndarray
    """Integral of the pressure inside the parts and its first moments, as ``log.FlowLoads.internal_pressure`` but
    about the origin of the grid's frame, shape (mode, row, 1 + axis)."""


def added_mass(
    water: Fluid,
    markers: Markers,
    reference_point: tuple[float, ...],
    density: float,
    body: int = 0,
    requested_modes: Sequence[bool] | np.ndarray | None = None,
) -> np.ndarray:
    """Return the added mass for accelerations along each axis and about a point: (3, 3) in the plane, (6, 6) in space.

    In space the order is along x, y and z, then about x, y and z. The force of mode k is ``-Ma[:, k]`` per unit
    acceleration; other bodies stay still. The added mass is the momentum that the immersion gives to the water, as
    ``momentum`` finds it. Units: kg/m in the plane and kg in space for the translations; times m between translations
    and rotations; times m^2 for the rotations.

    Where the sides move as in open water the result is that of open water. What lies beyond mirrors is counted. Motions
    through a mirror that cuts the body are not symmetric and have NaN, and so have the modes that are not requested.

    Args:
        water: water with the bodies placed.
        markers: markers of the body.
        reference_point: point that the rotations are about [m].
        density: density of the water [kg/m^3].
        body: which body, counted from 0 [-].
        requested_modes: which modes are needed; None is all.

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    ndim, mirror_cuts = water.ndim, water.mirror_cuts[body]
    mode_mask = symmetric(mirror_cuts)
    if requested_modes is not None:  # in open water the body's whole momentum counts, that along other axes too
        unbounded = water.layers[-1].border.water is not None and ndim == 3
        request_mask = [
            bool(is_requested) or (unbounded and k < ndim) for k, is_requested in enumerate(requested_modes)
        ]
        mode_mask = [keep and is_requested for keep, is_requested in zip(mode_mask, request_mask, strict=True)]
    modes = [mode for mode, keep in zip(_rigid(water, reference_point, body), mode_mask, strict=True) if keep]
    responses = _ModeResponses.solve(water, modes, _RESIDUAL_TOLERANCE, sides_held=False)
    volume, mode_block = water.grid.cell**ndim, np.ix_(mode_mask, mode_mask)
    matrix = np.full((len(mode_mask), len(mode_mask)), np.nan)
    shore = water.layers[-1].grid.cell ** ndim
    open_water_mass = _in_open_water(
        volume * responses.fixed_side_mass,
        volume * responses.region_mass,
        responses.side_potentials,
        responses.inward,
        shore,
    )
    of_body = slice(water.rows[body].start, water.rows[body].stop)
    body_modes = [_body_motion(mode, of_body) for mode in modes]
    matrix[mode_block] = (
        2 ** sum(mirror_cuts) * density * (open_water_mass + _rim(water, [markers], [body_modes], [mirror_cuts]))
    )
    return matrix


def generalised_added_mass(
    water: Fluid, outlines: Sequence[Markers], modes: Sequence[Twists], density: float
) -> AddedMass:
    """Return the added mass for motions of all bodies together, such as those of joints.

    The sides of the domain are held, so the result is rather too large than too small. What lies beyond mirrors counts.

    Args:
        water: water with the bodies placed.
        outlines: outlines of each body.
        modes: velocities of all parts of all bodies for unit rates, symmetric about mirrors that cut the bodies.
        density: density of the water [kg/m^3].

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    responses, body_modes = _ModeResponses.solve(water, modes, _GUESS_TOLERANCE, sides_held=True), []
    for rows in water.rows:
        body_rows = slice(rows.start, rows.stop)
        body_modes.append([_body_motion(mode, body_rows) for mode in modes])
    rim = _rim(water, outlines, body_modes, water.mirror_cuts)
    responses.fixed_side_mass += _link_joint_work_matrix(water, modes, responses.joint_correction)
    times = 2 ** max(sum(mirror_cuts) for mirror_cuts in water.mirror_cuts)
    h = water.grid.cell
    corner = np.array(water.grid.origin)
    matrix: np.ndarray = times * density * (h**water.ndim * responses.fixed_side_mass + rim)
    pressed = times * density * h ** (water.ndim + 1) * responses.internal_pressure
    pressed[..., 1:] = h * pressed[..., 1:] + pressed[..., :1] * corner
    return AddedMass(0.5 * (matrix + matrix.T), pressed)


def _link_joint_work_matrix(water: Fluid, modes: Sequence[Twists], joint_correction: np.ndarray) -> np.ndarray:
    """Return the work of each mode against the joint correction of each other mode, shape (mode, mode) [m^2/s^2].

    The correction removes the force with which the pressure pushes links apart at the cuts between them.

    Args:
        water: water with the bodies placed.
        modes: motions of all parts.
        joint_correction: correction of force and torque on each row for each mode, shape (mode, row, axis + rotation):
            force [m/s^2], then torque about the corner of the grid [m/s^2 cells], both over density and volume of a
            cell. Further columns do not count.
    """
    ndim, h, corner = water.ndim, water.grid.cell, np.array(water.grid.origin)
    turns = len(ROTATION_PLANES[ndim])
    moves = np.array(
        [
            np.concatenate(
                [replace(mode, reference_points=mode.reference_points - corner).at_origin(), h * mode.angular], axis=1
            )
            for mode in modes
        ]
    )
    return np.asarray(np.einsum("irc,jrc->ij", moves, joint_correction[:, :, : ndim + turns]))


def symmetric(mirror_cuts: tuple[bool, ...]) -> list[bool]:
    """Return whether each rigid mode is symmetric about the mirrors that cut a body; translations come first.

    Args:
        mirror_cuts: whether a mirror cuts the body at the low and at the high end of each axis; see ``body.cuts``.
    """
    has_mirror = [
        has_lower_mirror or has_upper_mirror
        for has_lower_mirror, has_upper_mirror in zip(mirror_cuts[::2], mirror_cuts[1::2], strict=True)
    ]
    return [
        *(not is_cut for is_cut in has_mirror),
        *(not (has_mirror[a] or has_mirror[b]) for a, b in ROTATION_PLANES[len(has_mirror)]),
    ]


def _rigid(water: Fluid, reference_point: tuple[float, ...], body: int) -> list[Twists]:
    """Return the rigid motions of one body along each axis and about a point, the others at rest.

    Args:
        water: water with the bodies placed.
        reference_point: point that the rotations are about [m].
        body: which body, counted from 0 [-].
    """
    ndim, rows, modes = water.ndim, water.rows[body], []
    turns = len(ROTATION_PLANES[ndim])
    for k in range(ndim + turns):
        mode = resting_twists(len(water.immersion_sums), ndim)
        mode.reference_points[:] = reference_point
        (mode.linear if k < ndim else mode.angular)[rows.start : rows.stop, k if k < ndim else k - ndim] = 1.0
        modes.append(mode)
    return modes


def _body_motion(mode: Twists, rows: slice) -> Twists:
    """Return the motion of the parts of one body."""
    return Twists(reference_points=mode.reference_points[rows], linear=mode.linear[rows], angular=mode.angular[rows])


@dataclass(slots=True)
class _ModeResponses:
    """Response of the water to accelerations of the bodies, per density and per volume of a cell."""

    fixed_side_mass: np.ndarray
    """Work of the pressure of one mode against another, with the sides held, shape (mode, mode) [m^2/s^2]."""
    region_mass: np.ndarray
    """The same work for the mass of the bodies' own region, filled with water."""
    side_potentials: list[list[np.ndarray]]
    """Potential along each side, mode by mode [m/s^2 cells]."""
    inward: list[list[np.ndarray]]
    """Acceleration that each mode induces on each side; empty in bounded water [m/s^2]."""
    internal_pressure: np.ndarray
    """Integral of the potential inside each part, mode by mode; see ``Fluid.pressures``."""
    joint_correction: np.ndarray
    """Correction that removes the push of the potential between links, (mode, row, ...).

    See ``Fluid.joint_pressure_sums``."""

    @classmethod
    def solve(cls, water: Fluid, modes: Sequence[Twists], limit: float, *, sides_held: bool) -> "_ModeResponses":
        """Return the water's response to each mode.

        Args:
            water: water with the bodies placed.
            modes: motions of all parts.
            limit: divergence that may be left, relative to the accelerations [-].
            sides_held: whether the sides are held; then nothing is computed for sides that move as in open water.
        """
        faces, ndim = held_faces(water), water.ndim
        shape = tuple(s.stop - s.start for s in water.window_slices)
        rises, moves, side_potentials, inward, part_pressures, joint_corrections = [], [], [], [], [], []
        for mode in modes:
            face_accelerations = [
                mode.velocity_at(component_faces.row, component_faces.points)[c]
                for c, component_faces in enumerate(faces)
            ]
            scale = max(float(np.abs(acceleration).max(initial=0.0)) for acceleration in face_accelerations) or 1.0
            acceleration_field = np.zeros((ndim, *shape))
            for c, (component_faces, acceleration) in enumerate(zip(faces, face_accelerations, strict=True)):
                acceleration_field[c].ravel()[component_faces.face_indices] = (
                    component_faces.closed_fraction * acceleration / scale
                )
            x = water.potential(acceleration_field, limit)
            side_potentials.append([scale * line.astype(np.float64) for line in water.along_sides(x)])
            rises.append(
                [scale * face_differences(water, x, component_faces, c) for c, component_faces in enumerate(faces)]
            )
            part_pressures.append(water.pressures(x, scale))
            joint_corrections.append(water.joint_pressure_sums(x, scale))
            inward.append([] if sides_held else [scale * side for side in water.side_accelerations(acceleration_field)])
            moves.append(
                [
                    component_faces.closed_fraction * acceleration
                    for component_faces, acceleration in zip(faces, face_accelerations, strict=True)
                ]
            )
        fixed_side_mass, region_mass = (
            np.array([[_work(mode, face_accelerations) for face_accelerations in responses] for mode in moves])
            for responses in (
                rises,
                [
                    [
                        m.velocity_at(component_faces.row, component_faces.points)[c]
                        for c, component_faces in enumerate(faces)
                    ]
                    for m in modes
                ],
            )
        )
        return cls(
            fixed_side_mass, region_mass, side_potentials, inward, np.array(part_pressures), np.array(joint_corrections)
        )


def _work(mode: list[np.ndarray], responses: list[np.ndarray]) -> float:
    """Return the work of a mode against a field, both on the faces that belong to the bodies."""
    return float(sum((a * response).sum() for a, response in zip(mode, responses, strict=True)))


def _rim(
    water: Fluid, outlines: Sequence[Markers], modes: Sequence[Sequence[Twists]],
    mirror_cuts: Sequence[tuple[bool, ...]],
) -> np.ndarray:  # fmt: skip
    """Return the mass of the skin of water that moves with the bodies, over the density, shape (mode, mode).

    Args:
        water: water with the bodies placed.
        outlines: outlines of each body.
        modes: motions of the parts of each body.
        mirror_cuts: which mirrors cut each body.
    """
    total = np.zeros((len(modes[0]), len(modes[0])))
    for outline, body_modes, ends in zip(outlines, modes, mirror_cuts, strict=True):
        skin = water.offset * water.grid.cell * 0.5 ** sum(ends) * outline.weight
        row = part_indices(outline)
        moves = np.array([mode.velocity_at(row, outline.points) for mode in body_modes])
        total += np.einsum("icm,jcm,m->ij", moves, moves, skin)
    return total


def _in_open_water(
    fixed_side_mass: np.ndarray,
    region_mass: np.ndarray,
    side_potentials: list[list[np.ndarray]],
    inward: list[list[np.ndarray]],
    volume: float,
) -> np.ndarray:
    """Return the added mass in open water from the added mass with the sides held.

    The velocity of the sides follows from water and body together, ``fixed_side_mass + region_mass``. Its action on the
    body needs no further solve: by Green's theorem it is the potential along the sides times their velocity.

    Args:
        fixed_side_mass: added mass with the sides held, over the density, shape (mode, mode).
        region_mass: mass of the body's region, over the density, shape (mode, mode).
        side_potentials: potential along each side, per mode [m/s^2 cells].
        inward: velocity that each mode induces on each side, per mode; empty in other water [m/s^2].
        volume: volume of a cell at the sides [m^2, m^3].
    """
    if not inward[0]:
        return fixed_side_mass
    gain = np.array(
        [[sum(float((p * q).sum()) for p, q in zip(a, b, strict=True)) for b in inward] for a in side_potentials]
    )
    answer = np.linalg.solve((fixed_side_mass + region_mass).T, volume * gain.T).T  # per momentum of the mode
    open_water: np.ndarray = np.linalg.solve(
        np.eye(len(fixed_side_mass)) - answer, fixed_side_mass + answer @ region_mass
    )
    return open_water
