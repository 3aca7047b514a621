from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.article.paper import SPINE_CHAIN
from suchus.core.errors import InvalidDesign, Unreachable
from suchus.robot.kinematics import dh, spine

SPINE = SimpleNamespace(base=0.0505, link=0.0605)


def postures(count: int, degrees: float = 60, seed: int = 0) -> np.ndarray:
    return np.radians(np.random.default_rng(seed).uniform(-degrees, degrees, (count, 5)))


def azimuth_of(T: np.ndarray) -> np.ndarray:
    return np.arctan2(T[..., 1, 0], T[..., 0, 0])


def test_straight_spine_is_as_long_as_its_links_and_upright():
    T = spine.forward(SPINE, np.zeros(5))
    np.testing.assert_allclose(T[:3, 3], [0.2925, 0, 0], atol=1e-16)
    np.testing.assert_allclose(T[:3, :3], np.eye(3), atol=1e-15)


def test_forward_is_the_dh_chain_of_table_2():
    q = postures(2000, 180)
    np.testing.assert_allclose(spine.forward(SPINE, q), dh.frames(SPINE_CHAIN, q)[:, -1], atol=1e-15)


def test_positive_yaw_bends_left_and_positive_pitch_bends_down():
    for joint in (0, 2):
        assert spine.forward(SPINE, 0.3 * np.eye(5)[joint])[1, 3] > 0
    for joint in (1, 3):
        assert spine.forward(SPINE, 0.3 * np.eye(5)[joint])[2, 3] < 0
    assert spine.forward(SPINE, 0.3 * np.eye(5)[4])[1, 0] > 0


def test_links_keep_their_length():
    places = spine.joints(SPINE, postures(500, 180))
    np.testing.assert_allclose(np.linalg.norm(np.diff(places, axis=1), axis=-1), 0.0605, rtol=1e-12)
    np.testing.assert_allclose(places[:, 0], np.broadcast_to([0.0505, 0, 0], (500, 3)), atol=1e-17)


def test_planar_spine_is_a_two_link_arm():
    q = postures(500, 90)
    q[:, [1, 3]] = 0
    T = spine.forward(SPINE, q)
    xy = 0.0505 + 0.121 * np.exp(1j * q[:, 0]) + 0.121 * np.exp(1j * (q[:, 0] + q[:, 2]))
    np.testing.assert_allclose(T[:, 0, 3] + 1j * T[:, 1, 3], xy, atol=1e-15)
    np.testing.assert_allclose(np.exp(1j * azimuth_of(T)), np.exp(1j * q[:, [0, 2, 4]].sum(1)), atol=1e-14)


def test_pitched_spine_lies_in_the_sagittal_plane():
    q = postures(500, 60)
    q[:, [0, 2, 4]] = 0
    T = spine.forward(SPINE, q)
    both = q[:, 1] + q[:, 3]
    np.testing.assert_allclose(T[:, 0, 3], 0.111 + 0.121 * np.cos(q[:, 1]) + 0.0605 * np.cos(both), atol=1e-15)
    np.testing.assert_allclose(T[:, 2, 3], -0.121 * np.sin(q[:, 1]) - 0.0605 * np.sin(both), atol=1e-15)


@pytest.mark.parametrize("ahead", [0.0, 0.2125])
def test_jacobian_is_the_derivative(ahead):
    q = postures(100)
    J = spine.jacobian(SPINE, q, forward_offset=ahead)
    assert J.shape == (100, 6, 5)
    step = 1e-6
    for i, e in enumerate(np.eye(5)):
        T, high, low = (spine.forward(SPINE, q + s * e) for s in (0.0, step, -step))
        tips = [A[:, :3, 3] + ahead * A[:, :3, 0] for A in (high, low)]
        np.testing.assert_allclose(J[:, :3, i], (tips[0] - tips[1]) / (2 * step), atol=1e-9)
        W = (high - low)[:, :3, :3] / (2 * step) @ np.swapaxes(T[:, :3, :3], 1, 2)
        turns = np.stack([W[:, 2, 1], W[:, 0, 2], W[:, 1, 0]], axis=-1)
        np.testing.assert_allclose(J[:, 3:, i], turns, atol=1e-9)


def test_straight_spine_is_singular():
    J = spine.jacobian(SPINE, np.zeros(5))
    np.testing.assert_allclose(J[1], [0.242, 0, 0.121, 0, 0], atol=1e-15)
    np.testing.assert_allclose(J[2], [0, -0.1815, 0, -0.0605, 0], atol=1e-15)
    assert np.linalg.matrix_rank(J[:3], tol=1e-12) == 2
    assert np.linalg.matrix_rank(J, tol=1e-12) == 4


def test_inverse_finds_position_azimuth_and_the_original_angles():
    q = postures(20_000)
    T = spine.forward(SPINE, q)
    p, psi = T[:, :3, 3], azimuth_of(T)
    same = np.zeros(len(q), dtype=bool)
    for branch in (1, -1):
        found = spine.inverse(SPINE, p, psi, first_yaw=q[:, 0], branch=branch)
        back = spine.forward(SPINE, found)
        np.testing.assert_allclose(back[:, :3, 3], p, atol=1e-14)
        np.testing.assert_allclose(np.exp(1j * azimuth_of(back)), np.exp(1j * psi), atol=1e-9)
        same |= np.abs(found - q).max(axis=1) < 1e-6
    assert same.all()


def test_straight_spine_is_found_although_it_is_singular():
    p = np.array([0.2925, 0, 0])
    np.testing.assert_allclose(spine.inverse(SPINE, p, 0.0, first_yaw=0.0), 0, atol=1e-7)
    np.testing.assert_allclose(spine.least_bending(SPINE, p, 0.0), 0, atol=1e-6)


@pytest.mark.parametrize("p", [(0.6, 0, 0), (0.0505, 0, 0.242), (np.nan, 0, 0), (np.inf, 0, 0), (0, 1e200, 0)])
def test_points_out_of_reach_are_named(p):
    for solve in (
        lambda p: spine.inverse(SPINE, p, 0.0, first_yaw=0.0),
        lambda p: spine.least_bending(SPINE, p, 0.0),
    ):
        with pytest.raises(Unreachable, match="1 points cannot be reached") as caught:
            solve(np.array([(0.28, 0, 0.01), p]))
        np.testing.assert_array_equal(caught.value.points, [p])
    with pytest.raises(InvalidDesign, match="1 or -1"):
        spine.inverse(SPINE, np.array(p), 0.0, first_yaw=0.0, branch=3)


def test_least_bending_is_no_worse_than_any_posture_that_does_the_same():
    q = postures(300, 40, seed=3)
    T = spine.forward(SPINE, q)
    found = spine.least_bending(SPINE, T[:, :3, 3], azimuth_of(T))
    back = spine.forward(SPINE, found)
    np.testing.assert_allclose(back[:, :3, 3], T[:, :3, 3], atol=1e-13)
    np.testing.assert_allclose(np.exp(1j * azimuth_of(back)), np.exp(1j * azimuth_of(T)), atol=1e-9)
    assert np.all(np.sum(found**2, axis=1) <= np.sum(q**2, axis=1) + 1e-12)


def test_least_bending_beats_a_dense_scan_of_the_first_yaw():
    p, psi = np.array([0.25, 0.06, -0.04]), 0.5
    scan = np.linspace(-np.pi, np.pi, 20_001)
    every = spine.candidates(SPINE, p, psi, first_yaw=scan, branch=np.array([[1], [-1]]))
    best = float(np.nanmin(np.sum(every**2, axis=-1)))
    found = float(np.sum(spine.least_bending(SPINE, p, psi) ** 2))
    assert found <= best + 1e-12
    assert found == pytest.approx(best, rel=1e-5)


def test_least_bending_in_the_plane_stays_in_the_plane():
    q = np.radians([[20.0, 0, 25, 0, 10], [-30, 0, -5, 0, 20]])
    T = spine.forward(SPINE, q)
    found = spine.least_bending(SPINE, T[:, :3, 3], azimuth_of(T))
    mirrored = spine.least_bending(SPINE, T[:, :3, 3] * [1, -1, 1], -azimuth_of(T))
    np.testing.assert_allclose(np.sum(found**2, axis=1), np.sum(mirrored**2, axis=1), rtol=1e-9)


@given(st.tuples(*3 * (st.floats(-0.35, 0.35),)).map(np.array), st.floats(-3, 3))
def test_feasible_yaws_and_closed_form_agree(p, psi):
    every = spine.candidates(SPINE, p, psi, first_yaw=np.linspace(-np.pi, np.pi, 721), branch=1)
    if np.isfinite(every).any():
        found = spine.least_bending(SPINE, p, psi)
        np.testing.assert_allclose(spine.forward(SPINE, found)[:3, 3], p, atol=1e-9)
        return
    try:
        found = spine.least_bending(SPINE, p, psi)
    except Unreachable:
        return
    np.testing.assert_allclose(spine.forward(SPINE, found)[:3, 3], p, atol=1e-9)  # between two of the yaws


def test_shapes_follow_the_batch():
    q = postures(6).reshape(2, 3, 5)
    T = spine.forward(SPINE, q)
    p, psi = T[..., :3, 3], azimuth_of(T)
    assert spine.inverse(SPINE, p, psi, first_yaw=q[..., 0]).shape == (2, 3, 5)
    assert spine.least_bending(SPINE, p, psi).shape == (2, 3, 5)
    assert spine.least_bending(SPINE, p, 0.1).shape == (2, 3, 5)
    assert spine.least_bending(SPINE, p[0, 0], 0.1).shape == (5,)


def test_least_bending_shuns_a_vertical_head():
    q = postures(300, 50, seed=3)
    T = spine.forward(SPINE, q)
    found = spine.forward(SPINE, spine.least_bending(SPINE, T[:, :3, 3], azimuth_of(T)))
    level, was = (np.hypot(A[:, 0, 0], A[:, 1, 0]) for A in (found, T))
    assert np.all(level[was > 0.06] >= 0.05)
    np.testing.assert_allclose(np.exp(1j * azimuth_of(found)), np.exp(1j * azimuth_of(T)), atol=1e-9)


def test_many_points_are_solved_as_few_are(monkeypatch):
    T = spine.forward(SPINE, postures(7))
    p, psi = T[:, :3, 3], azimuth_of(T)
    whole = spine.least_bending(SPINE, p, psi)
    monkeypatch.setattr(spine, "CHUNK", 3)
    np.testing.assert_array_equal(spine.least_bending(SPINE, p, psi), whole)
    assert spine.least_bending(SPINE, np.empty((0, 3)), 0.0).shape == (0, 5)
