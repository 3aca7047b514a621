from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.article.paper import LEG_CHAIN
from suchus.core.errors import InvalidDesign, Unreachable
from suchus.robot.kinematics import dh, leg, leg_solution


@dataclass(frozen=True)
class Links:
    hip_offset: float = 0.070
    femur: float = 0.086
    tibia: float = 0.089


HIND = Links()
HIP = np.array([0.070, 0.0, 0.0])
BRANCHES = [(knee, side) for knee in (1, -1) for side in (1, -1)]
length = st.floats(0.01, 1.0)
links = st.builds(Links, hip_offset=st.floats(0.0, 1.0), femur=length, tibia=length)
angle = st.floats(-np.pi, np.pi)
triple = st.tuples(angle, angle, angle).map(np.array)


def shell(count: int, seed: int = 0) -> np.ndarray:
    """Return points spread evenly over the workspace."""
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return HIP + way * np.cbrt(rng.uniform(0.003**3, 0.175**3, (count, 1)))


def test_straight_leg_reaches_the_sum_of_its_links():
    np.testing.assert_allclose(leg.forward(HIND, np.zeros(3)), [0.245, 0, 0], atol=1e-17)


def test_forward_is_the_dh_chain_of_table_1():
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (1000, 4))
    end = dh.frames(LEG_CHAIN, q)[:, -1, :3, 3]
    np.testing.assert_allclose(leg.forward(HIND, q[:, :3]), end, atol=1e-15)


def test_knee_is_a_femur_from_the_hip_and_a_tibia_from_the_foot():
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (1000, 3))
    knee = leg.knee_point(HIND, q)
    np.testing.assert_allclose(np.linalg.norm(knee - HIP, axis=1), 0.086, rtol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(leg.forward(HIND, q) - knee, axis=1), 0.089, rtol=1e-12)


@pytest.mark.parametrize(("knee", "side"), BRANCHES)
def test_forward_undoes_inverse_on_every_branch(knee, side):
    p = shell(100_000)
    q = leg.inverse(HIND, p, knee=knee, side=side)
    assert np.abs(leg.forward(HIND, q) - p).max() < 1e-15
    assert np.all(np.sign(q[:, 2]) == knee)
    assert np.all(np.abs(q) <= np.pi)


def test_one_branch_returns_the_original_angles():
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (5000, 3))
    p = leg.forward(HIND, q)
    found = np.stack([leg.inverse(HIND, p, knee=k, side=s) for k, s in BRANCHES])
    miss = np.abs(np.exp(1j * found) - np.exp(1j * q)).max(axis=-1).min(axis=0)
    assert miss.max() < 1e-9


def test_sides_put_knee_and_foot_at_the_same_points():
    p = shell(1000, seed=4)
    for knee in (1, -1):
        here, across = leg.inverse(HIND, p, knee=knee), leg.inverse(HIND, p, knee=-knee, side=-1)
        np.testing.assert_allclose(leg.knee_point(HIND, here), leg.knee_point(HIND, across), atol=1e-14)


def test_boundary_points_are_reached():
    np.testing.assert_allclose(leg.inverse(HIND, np.array([0.245, 0, 0])), 0, atol=1e-7)
    folded = leg.inverse(HIND, np.array([0.067, 0, 0]))
    assert abs(folded[2]) == pytest.approx(np.pi, abs=1e-7)


def test_foot_on_the_yaw_axis_is_reached():
    p = np.array([0.070, 0.0, 0.1])
    for knee, side in BRANCHES:
        np.testing.assert_allclose(leg.forward(HIND, leg.inverse(HIND, p, knee=knee, side=side)), p, atol=1e-16)


def test_points_out_of_reach_are_named():
    p = np.array([[0.156, 0, 0.089], [0.070, 0, 0.180], [0.072, 0, 0]])
    with pytest.raises(Unreachable, match=r"2 of 3 foot points.*0\.003 to 0\.175 m") as caught:
        leg.inverse(HIND, p)
    np.testing.assert_array_equal(caught.value.points, p[1:])
    assert caught.value.reach == pytest.approx((0.003, 0.175))
    np.testing.assert_array_equal(leg.reachable(HIND, p), [True, False, False])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e200])
def test_points_that_are_no_numbers_are_refused(bad):
    p = np.broadcast_to(np.array([0.156, 0, 0.089]), (3 * leg_solution.CHUNK, 3)).copy()
    p[2 * leg_solution.CHUNK + 7, 1] = bad
    with pytest.raises(Unreachable, match=f"1 of {3 * leg_solution.CHUNK}"):
        leg.inverse(HIND, p)


@pytest.mark.parametrize(("knee", "side"), [(0, 1), (1, 2), (-1, 0)])
def test_only_two_signs_are_branches(knee, side):
    with pytest.raises(InvalidDesign, match="1 or -1"):
        leg.inverse(HIND, np.array([0.156, 0, 0.089]), knee=knee, side=side)


def test_shapes_follow_the_batch():
    p = shell(24).reshape(2, 3, 4, 3)
    assert leg.inverse(HIND, p).shape == (2, 3, 4, 3)
    assert leg.jacobian(HIND, leg.inverse(HIND, p)).shape == (2, 3, 4, 3, 3)
    assert leg.inverse(HIND, np.empty((0, 3))).shape == (0, 3)
    np.testing.assert_array_equal(leg.inverse(HIND, p)[1, 2, 3], leg.inverse(HIND, p[1, 2, 3]))


def test_input_is_left_alone():
    p = shell(10)
    before = p.copy()
    leg.inverse(HIND, p, knee=-1, side=-1)
    np.testing.assert_array_equal(p, before)


def test_jacobian_is_the_derivative():
    q = np.random.default_rng(5).uniform(-3, 3, (200, 3))
    step = 1e-6
    for i, e in enumerate(np.eye(3)):
        slope = (leg.forward(HIND, q + step * e) - leg.forward(HIND, q - step * e)) / (2 * step)
        np.testing.assert_allclose(leg.jacobian(HIND, q)[..., i], slope, atol=1e-10)


def test_jacobian_is_singular_exactly_where_the_theory_says():
    q = np.random.default_rng(6).uniform(-3, 3, (200, 3))
    r = np.cos(q[:, 1]) * 0.086 + np.cos(q[:, 1] + q[:, 2]) * 0.089
    expected = -0.086 * 0.089 * r * np.sin(q[:, 2])
    np.testing.assert_allclose(np.linalg.det(leg.jacobian(HIND, q)), expected, atol=1e-16)


@given(links, triple)
def test_every_leg_finds_its_own_foot_again(built, q):
    p = leg.forward(built, q)
    back = leg.forward(built, leg.inverse(built, p))
    np.testing.assert_allclose(back, p, atol=2e-7 * (built.femur + built.tibia))


@given(links, st.tuples(*3 * (st.floats(),)).map(np.array))
def test_any_point_gives_a_valid_answer_or_a_sentence(built, p):
    if leg.reachable(built, p):
        assert np.isfinite(leg.inverse(built, p)).all()
    else:
        with pytest.raises(Unreachable, match="out of reach"):
            leg.inverse(built, p)


@pytest.mark.parametrize("count", [1, 3, leg_solution.CHUNK])
def test_legs_of_other_lengths_are_solved_at_once_to_the_same_bytes(count):
    legs = [HIND, Links(0.05, 0.08, 0.06), Links(0.0, 0.1, 0.12)]
    angles = np.random.default_rng(8).uniform(-1.0, 1.0, (3, count, 3))
    points = np.array([leg.forward(one, rows) for one, rows in zip(legs, angles, strict=True)])
    found, is_reachable = leg_solution.solve(leg_solution.Lengths.of(legs, count), points.reshape(-1, 3))
    apart = np.array([leg.inverse(one, rows) for one, rows in zip(legs, points, strict=True)])
    assert is_reachable
    assert found.tobytes() == apart.tobytes()
    points[2, -1] = 1.0
    assert not leg_solution.solve(leg_solution.Lengths.of(legs, count), points.reshape(-1, 3))[1]
