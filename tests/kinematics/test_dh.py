import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.article.paper import LEG_CHAIN, SPINE_CHAIN
from suchus.core.errors import InvalidDesign
from suchus.robot.kinematics import dh

number = st.floats(-3, 3)


def rotation(axis: int, angle: float) -> np.ndarray:
    """Return a homogeneous turn about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[i, j], T[j, i] = -np.sin(angle), np.sin(angle)
    return T


def shift(x: float, y: float, z: float) -> np.ndarray:
    """Return a homogeneous translation."""
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


@given(number, number, number, number)
def test_transform_is_turn_go_turn_go(a, alpha, d, theta):
    expected = rotation(0, alpha) @ shift(a, 0, 0) @ rotation(2, theta) @ shift(0, 0, d)
    np.testing.assert_allclose(dh.transform(a, alpha, d, np.array(theta)), expected, atol=1e-14)


def test_leg_matrices_are_those_of_the_article():
    q = np.array([0.3, -0.4, 0.5, -0.6])
    c, s = np.cos(q), np.sin(q)
    a0, a1, a2, a3 = LEG_CHAIN.a
    T1 = np.array([[c[0], -s[0], 0, a0], [s[0], c[0], 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    T2 = np.array([[c[1], -s[1], 0, a1], [0, 0, -1, 0], [s[1], c[1], 0, 0], [0, 0, 0, 1]])
    T3 = np.array([[c[2], -s[2], 0, a2], [s[2], c[2], 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    T4 = np.array([[c[3], -s[3], 0, a3], [s[3], c[3], 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    for i, T in enumerate((T1, T2, T3, T4)):
        found = dh.transform(LEG_CHAIN.a[i], LEG_CHAIN.alpha[i], LEG_CHAIN.d[i], q[i])
        np.testing.assert_allclose(found, T, atol=1e-16)
    np.testing.assert_allclose(dh.frames(LEG_CHAIN, q)[-1], T1 @ T2 @ T3 @ T4, atol=1e-16)


def test_leg_rotation_is_equation_7_with_its_third_column():
    q = np.random.default_rng(0).uniform(-3, 3, 4)
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    c, s = np.cos(q[1:].sum()), np.sin(q[1:].sum())
    R = np.array([[c1 * c, -c1 * s, s1], [s1 * c, -s1 * s, -c1], [s, c, 0]])
    np.testing.assert_allclose(dh.frames(LEG_CHAIN, q)[-1, :3, :3], R, atol=1e-15)
    np.testing.assert_allclose(np.cross(R[:, 0], R[:, 1]), R[:, 2], atol=1e-15)


def test_frames_are_rigid():
    T = dh.frames(SPINE_CHAIN, np.random.default_rng(1).uniform(-3, 3, (100, 5)))
    R = T[..., :3, :3]
    np.testing.assert_allclose(R @ np.swapaxes(R, -1, -2), np.broadcast_to(np.eye(3), R.shape), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(R), 1, rtol=1e-13)


def test_a_chain_wants_one_angle_per_link():
    with pytest.raises(InvalidDesign, match="4 numbers are needed"):
        dh.frames(LEG_CHAIN, np.zeros(3))
