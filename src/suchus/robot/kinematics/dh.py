"""Denavit-Hartenberg transforms in the modified convention (Craig)."""

import numpy as np
from jaxtyping import Float

from suchus.article.paper.tables import Chain
from suchus.robot.kinematics.given import number, numbers, rows
from suchus.robot.kinematics.links import Numbers


def transform(a: float, alpha: float, d: float, theta: Numbers) -> Float[np.ndarray, "*batch 4 4"]:
    """Return the transform from frame n to frame n - 1: turn about x, go along x, turn about z, go along z.

    Args:
        a: a_(n-1), along x of frame n - 1 [m].
        alpha: alpha_(n-1), about x of frame n - 1 [rad].
        d: d_n, along z of frame n [m].
        theta: theta_n, about z of frame n [rad].

    Paper: Eq. (1).
    """
    a, alpha, d = number(a, "a"), number(alpha, "alpha"), number(d, "d")
    angle = numbers(theta, "theta", finite=False)
    s, c = np.sin(angle), np.cos(angle)
    sa, ca = np.sin(alpha), np.cos(alpha)
    T = np.zeros((*angle.shape, 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 3] = c, -s, a
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = s * ca, c * ca, -sa, -d * sa
    T[..., 2, 0], T[..., 2, 1], T[..., 2, 2], T[..., 2, 3] = s * sa, c * sa, ca, d * ca
    T[..., 3, 3] = 1.0
    return T


def frames(chain: Chain, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch joint 4 4"]:
    """Return the transforms from every frame of a chain to frame 0.

    Args:
        chain: the links.
        angles: one angle per link [rad].

    Raises:
        InvalidDesign: the number of angles is not the number of links.

    Paper: Eq. (6).
    """
    count = len(chain.a)
    angles = rows(angles, count, "the chain's angles")
    T = np.empty((*angles.shape, 4, 4))
    for i in range(count):
        step = transform(chain.a[i], chain.alpha[i], chain.d[i], angles[..., i])
        T[..., i, :, :] = step if i == 0 else T[..., i - 1, :, :] @ step
    return T
