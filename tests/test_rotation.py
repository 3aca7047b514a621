"""The one module of rotations against scipy's, and against angles known by hand."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from suchus.core import rotation

X, Y, Z = np.eye(3)
turns = st.builds(
    lambda a, b, c: Rotation.from_euler("ZYX", [a, b, c]).as_quat(scalar_first=True),
    st.floats(-3.1, 3.1),
    st.floats(-1.55, 1.55),
    st.floats(-3.1, 3.1),
)


def scipys(q):
    return Rotation.from_quat(q, scalar_first=True)


@pytest.mark.parametrize(
    ("axis", "angle", "named", "what"),
    [
        (Z, 0.3, rotation.yaw, "facing left"),
        (Y, 0.3, rotation.pitch, "nose down"),
        (Y, 0.3, rotation.steep_pitch, "nose down"),
        (X, 0.3, rotation.roll, "left side up"),
    ],
)
def test_each_angle_has_the_sign_of_the_conventions(axis, angle, named, what):
    q = rotation.from_axis_angle(axis, angle)
    nose, left = rotation.rotate(q, X), rotation.rotate(q, Y)
    assert {"facing left": nose[1], "nose down": -nose[2], "left side up": left[2]}[what] > 0.2
    assert named(q) == pytest.approx(angle, abs=1e-15)
    assert named(rotation.from_axis_angle(axis, -angle)) == pytest.approx(-angle, abs=1e-15)
    others = {rotation.yaw, rotation.pitch, rotation.roll, rotation.steep_pitch} - {named}
    if named is rotation.pitch or named is rotation.steep_pitch:
        others -= {rotation.pitch, rotation.steep_pitch}
    assert all(abs(other(q)) < 1e-15 for other in others)


@given(q=turns)
def test_angles_follow_each_other_as_yaw_pitch_and_roll(q):
    yaw, pitch, roll = scipys(q).as_euler("ZYX")
    assume(abs(pitch) < 1.5)
    assert rotation.yaw(q) == pytest.approx(yaw, abs=1e-12)
    assert rotation.pitch(q) == pytest.approx(pitch, abs=1e-12)
    assert rotation.steep_pitch(q) == pytest.approx(pitch, abs=1e-12)
    assert rotation.roll(q) == pytest.approx(roll, abs=1e-12)


@given(p=turns, q=turns)
def test_products_and_turned_vectors_are_those_of_scipy(p, q):
    product = scipys(rotation.multiply(p, q)).as_matrix()
    np.testing.assert_allclose(product, (scipys(p) * scipys(q)).as_matrix(), atol=1e-12)
    many = np.arange(12.0).reshape(4, 3)
    np.testing.assert_allclose(rotation.rotate(q, many), scipys(q).apply(many), atol=1e-12)
    np.testing.assert_allclose(rotation.rotate(np.tile(q, (4, 1)), many), scipys(q).apply(many), atol=1e-12)
    np.testing.assert_allclose(rotation.rotate(np.tile(q, (2, 1)), X), scipys(q).apply([X, X]), atol=1e-12)
    np.testing.assert_allclose(rotation.matrix(q) @ many.T, scipys(q).apply(many).T, atol=1e-12)
    np.testing.assert_allclose(rotation.upward(q), scipys(q).inv().apply(Z), atol=1e-12)
    np.testing.assert_allclose(rotation.world_x(q), scipys(q).inv().apply(X), atol=1e-12)


@given(angle=st.floats(-3.1, 3.1))
def test_a_turn_about_an_axis_is_that_of_scipy(angle):
    axis = np.array([2.0, -3.0, 6.0]) / 7.0
    np.testing.assert_allclose(
        rotation.from_axis_angle(axis, angle), Rotation.from_rotvec(angle * axis).as_quat(scalar_first=True), atol=1e-15
    )


@pytest.mark.parametrize("off", [0.0, 1e-9, -1e-6])
def test_the_pitch_of_an_upright_body_keeps_its_digits(off):
    q = rotation.from_axis_angle(Y, np.pi / 2 - 1e-5 + off)
    assert rotation.steep_pitch(q) == pytest.approx(np.pi / 2 - 1e-5 + off, abs=1e-15)
    assert abs(rotation.pitch(q) - (np.pi / 2 - 1e-5 + off)) < 1e-9


def test_leading_dimensions_stay_and_lost_readings_go_through():
    q = np.stack([rotation.from_axis_angle(Z, 0.1 * np.arange(6.0)), np.full((6, 4), np.nan), np.zeros((6, 4))])
    assert rotation.yaw(q).shape == (3, 6)
    assert rotation.upward(q).shape == rotation.rotate(q, X).shape == (3, 6, 3)
    assert rotation.matrix(q[0]).shape == (6, 3, 3)
    assert rotation.multiply(q, q[0, 0]).shape == (3, 6, 4)
    np.testing.assert_allclose(rotation.yaw(q)[0], 0.1 * np.arange(6.0), atol=1e-15)
    assert np.isnan(rotation.roll(q)[1]).all()
    assert np.all(rotation.pitch(q)[2] == 0.0)


@given(yaw=st.floats(-3.1, 3.1), pitch=st.floats(-1.55, 1.55), roll=st.floats(-3.1, 3.1))
def test_three_angles_make_a_rotation_and_are_found_in_it(yaw, pitch, roll):
    q = rotation.from_angles(yaw, pitch, roll)
    exact = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    np.testing.assert_allclose(scipys(q).as_matrix(), exact, atol=1e-14)
    assert rotation.angles(q) == pytest.approx((yaw, pitch, roll), abs=1e-9)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-9, -np.pi / 2 + 3e-12])
@given(yaw=st.floats(-3.1, 3.1), roll=st.floats(-3.1, 3.1))
def test_upright_on_its_nose_the_angles_still_make_the_same_rotation(pitch, yaw, roll):
    q = rotation.from_angles(yaw, pitch, roll)
    found = rotation.angles(q)
    assert found[1] == pytest.approx(pitch, abs=1e-7)
    np.testing.assert_allclose(rotation.matrix(rotation.from_angles(*found)), rotation.matrix(q), atol=1e-12)


vectors = st.tuples(*[st.floats(-1.7, 1.7)] * 3).map(np.array)


@given(vector=vectors, turns=st.integers(-3, 3))
def test_rotation_vectors_are_those_of_scipy_and_the_nearest_among_whole_turns(vector, turns):
    q = rotation.from_vector(vector)
    exact = Rotation.from_rotvec(vector)
    np.testing.assert_allclose(scipys(q).as_matrix(), exact.as_matrix(), atol=1e-14)
    np.testing.assert_allclose(rotation.turn(vector), exact.as_matrix(), atol=1e-14)
    np.testing.assert_allclose(rotation.to_vector(q, np.zeros(3)), exact.as_rotvec(), atol=1e-9)
    size = np.linalg.norm(vector)
    assume(size > 1e-3)
    far = vector + 2 * np.pi * turns * vector / size
    np.testing.assert_allclose(rotation.to_vector(q, far + 0.1), far, atol=1e-9)
    np.testing.assert_allclose(rotation.turn(far), exact.as_matrix(), atol=1e-12)


def test_no_turn_has_no_axis_and_whole_turns_that_of_their_neighbour():
    none = np.array([1.0, 0.0, 0.0, 0.0])
    assert rotation.to_vector(none, np.zeros(3)) == pytest.approx(np.zeros(3))
    assert rotation.to_vector(none, 6.2 * Y) == pytest.approx(2 * np.pi * Y)
    assert rotation.turn(np.zeros(3)) == pytest.approx(np.eye(3))
    assert rotation.turn(1e-9 * Z)[1, 0] == pytest.approx(1e-9)
