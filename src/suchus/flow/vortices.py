"""Vortices of a flow in space: the second invariant of the velocity gradient, and lambda 2."""

import numpy as np


def velocity_gradient(velocity: np.ndarray, h: float) -> np.ndarray:
    """Return the gradient of a velocity, shape (3, 3, z, y, x): component, then direction along x, y, z [1/s].

    Central differences inside, one-sided ones on the sides; both are exact where the velocity is linear.

    Args:
        velocity: velocity at the cell centres, shape (3, z, y, x) [m/s].
        h: cell [m].
    """
    return np.stack([np.stack(np.gradient(component, h)[::-1]) for component in velocity])


def second_invariant(velocity: np.ndarray, h: float) -> np.ndarray:
    """Return Q = (|W|^2 - |S|^2) / 2, positive where the water turns faster than it is strained [1/s^2].

    S and W are the symmetric and the antisymmetric part of the velocity's gradient.

    Args:
        velocity: see ``velocity_gradient`` [m/s].
        h: cell [m].

    Source: Hunt, Wray and Moin 1988, Center for Turbulence Research, CTR-S88, 193.
    """
    slope = velocity_gradient(velocity, h)
    invariant: np.ndarray = -0.5 * np.einsum("ij...,ji...->...", slope, slope)
    return invariant


def lambda2(velocity: np.ndarray, h: float) -> np.ndarray:
    """Return the middle eigenvalue of S^2 + W^2, negative in vortices, whose pressure is lowest there [1/s^2].

    Args:
        velocity: see ``velocity_gradient`` [m/s].
        h: cell [m].

    Source: Jeong and Hussain 1995, J. Fluid Mech. 285, 69.
    """
    slope = np.moveaxis(velocity_gradient(velocity, h), (0, 1), (-2, -1))
    transpose = np.swapaxes(slope, -1, -2)
    strain, spin = 0.5 * (slope + transpose), 0.5 * (slope - transpose)
    return np.linalg.eigvalsh(strain @ strain + spin @ spin)[..., 1]
