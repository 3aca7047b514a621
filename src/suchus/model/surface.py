"""Geoms that meet the ground: feet and skin, each with its own friction."""

from typing import Any

import mujoco

from suchus.design import Contact

FOOT_COLOUR = (0.16, 0.20, 0.18, 1.0)
SKIN_COLOUR = (0.36, 0.46, 0.30, 1.0)
_IMPEDANCE = (0.9, 0.95, 0.5, 2.0)  # MuJoCo's defaults of solimp but for its width


def sole(body: Any, name: str, pos: list[float], radius: float, mass: float, contact: Contact) -> None:
    """Add a spherical foot."""
    geom = body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=pos, size=[radius, 0, 0], mass=mass)
    _touches(geom, contact.foot_friction, contact, 4, FOOT_COLOUR)


def skin(
    body: Any, name: str, start: list[float], end: list[float], radius: float, mass: float, contact: Contact
) -> None:
    """Add a capsule of skin from ``start`` to ``end``."""
    geom = body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[*start, *end],
        size=[radius, 0, 0],
        mass=mass,
    )
    _touches(geom, contact.skin_friction, contact, 3, SKIN_COLOUR)


def shell(
    body: Any, name: str, pos: list[float], half: tuple[float, float, float], mass: float, contact: Contact
) -> None:
    """Add an ellipsoid of skin with half axes ``half``."""
    geom = body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, pos=pos, size=list(half), mass=mass)
    _touches(geom, contact.skin_friction, contact, 3, SKIN_COLOUR)


def _touches(geom: Any, friction: float, contact: Contact, dimensions: int, colour: tuple[float, ...]) -> None:
    # MuJoCo takes the maximum of two frictions at equal priority, so the robot's surfaces take precedence.
    geom.priority = 1
    geom.friction = [friction, contact.torsion, contact.rolling]
    geom.condim = dimensions
    geom.solref = [contact.time_constant, 1.0]
    geom.solimp = [*_IMPEDANCE[:2], contact.depth, *_IMPEDANCE[2:]]
    geom.contype, geom.conaffinity = 0, 1  # the ground only: no self-collision
    geom.fluid_ellipsoid = 1  # how a fluid would act, where there is one
    geom.rgba = list(colour)
