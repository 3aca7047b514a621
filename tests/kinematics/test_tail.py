from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.kinematics import tail


@dataclass(frozen=True)
class Plates:
    joints: int = 6
    plate: float = 0.030
    gap: float = 0.015
    cord_spacing: float = 0.050
    pulley: float = 0.025


TAIL = Plates()
plates = st.builds(
    Plates,
    joints=st.integers(1, 30),
    plate=st.floats(0.001, 0.1),
    gap=st.floats(0.001, 0.1),
    cord_spacing=st.floats(0.001, 0.1),
    pulley=st.floats(0.005, 0.1),
)


def gap_lengths(built: Plates, bend: float) -> tuple[float, float]:
    """Return both cords' lengths inside the tail from plates and holes alone, without (16)."""
    toward = away = 0.0
    half = bend / built.joints / 2
    for side in (1, -1):
        hole = np.array([-built.gap / 2, side * built.cord_spacing / 2])  # on the plate before the pivot
        c, s = np.cos(2 * half), np.sin(2 * half)
        other = np.array([[c, -s], [s, c]]) @ np.array([built.gap / 2, side * built.cord_spacing / 2])
        length = built.joints * float(np.linalg.norm(other - hole))
        toward, away = (length, away) if side == 1 else (toward, length)
    return toward, away


def test_straight_tail_changes_nothing():
    assert tail.cable_changes(TAIL, 0.0) == (0.0, 0.0)
    assert tail.servo_angle(TAIL, 0.0) == 0.0
    expected = 0.0225 + 0.045 * np.arange(6)
    np.testing.assert_allclose(tail.joint_positions(TAIL, 0.0)[:, 0], expected, rtol=1e-15)
    np.testing.assert_array_equal(tail.joint_positions(TAIL, 0.0)[:, 1], 0)


@given(plates, st.floats(-1, 1))
def test_cords_change_as_plates_and_holes_say(built, share):
    bend = share * tail.bend_limit(built)
    straight, bent = gap_lengths(built, 0.0), gap_lengths(built, bend)
    found = tail.cable_changes(built, bend)
    np.testing.assert_allclose(found, np.subtract(bent, straight), atol=1e-14)


@given(plates, st.floats(-1, 1))
def test_both_cords_and_the_slack_add_up_to_nothing(built, share):
    bend = share * tail.bend_limit(built)
    toward, away = tail.cable_changes(built, bend)
    sag = 4 * built.joints * built.gap * np.sin(bend / built.joints / 4) ** 2
    assert tail.slack(built, bend) == pytest.approx(sag, rel=1e-9, abs=1e-15)
    assert toward + away + tail.slack(built, bend) == pytest.approx(0, abs=1e-15)


@given(plates, st.floats(-1, 1))
def test_mirrored_bend_swaps_the_cords(built, share):
    bend = share * tail.bend_limit(built)
    np.testing.assert_allclose(tail.cable_changes(built, bend), tail.cable_changes(built, -bend)[::-1], atol=1e-16)


def test_quadratic_over_linear_term_is_the_tangent():
    bend = np.radians(np.arange(5, 181, 5.0))
    toward, away = tail.cable_changes(TAIL, bend)
    quadratic, linear = -(toward + away) / 2, (away - toward) / 2
    np.testing.assert_allclose(quadratic / linear, 0.3 * np.tan(bend / 24), rtol=1e-12)


@given(plates, st.floats(-1, 1))
def test_servo_inverse_undoes_servo(built, share):
    bend = 0.99 * share * built.joints * np.pi
    assert tail.bend_of_servo(built, tail.servo_angle(built, bend)) == pytest.approx(bend, rel=1e-7, abs=1e-9)


def test_closed_gaps_and_too_much_cord_are_refused():
    limit = tail.bend_limit(TAIL)
    assert np.degrees(limit) == pytest.approx(200.4, abs=0.1)
    tail.cable_changes(TAIL, limit)
    for bad in (1.01 * limit, -1.01 * limit):
        with pytest.raises(OutsideLimits, match="closes the gaps"):
            tail.cable_changes(TAIL, np.array([0.0, bad]))
    for bad in (12.1, -12.1):
        with pytest.raises(OutsideLimits, match="-12 to 12 rad"):
            tail.bend_of_servo(TAIL, np.array([0.0, bad]))
    every = (
        tail.cable_changes,
        tail.slack,
        tail.servo_angle,
        tail.bend_of_servo,
        tail.joint_positions,
        tail.end_position,
    )
    for function in (*every, tail.end_position):
        for bad in (np.nan, np.inf, -np.inf):
            with pytest.raises(InvalidDesign, match="finite numbers are needed"):
                function(TAIL, np.array([0.0, bad]))


@given(plates, st.floats(-4, 4))
def test_neighbouring_joints_are_one_pitch_apart(built, bend):
    places = np.vstack([tail.joint_positions(built, bend), tail.end_position(built, bend)])
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    pitch = built.plate + built.gap
    np.testing.assert_allclose(steps[:-1], pitch, rtol=1e-9)
    assert steps[-1] == pytest.approx(pitch / 2, rel=1e-9)
    np.testing.assert_allclose(places[0], [pitch / 2, 0], rtol=1e-15)


@given(plates, st.floats(0.01, 4))
def test_joint_positions_follow_the_closed_sum(built, bend):
    i, beta, p = np.arange(1, built.joints + 1), bend / built.joints, built.plate + built.gap
    ratio = p * np.sin((i - 1) * beta / 2) / np.sin(beta / 2)
    expected = np.stack([p / 2 + ratio * np.cos(i * beta / 2), ratio * np.sin(i * beta / 2)], axis=-1)
    np.testing.assert_allclose(tail.joint_positions(built, bend), expected, atol=1e-12)


def test_positive_bend_turns_the_tip_right():
    assert tail.end_position(TAIL, 0.5)[1] > 0  # y to the robot's right


def test_shapes_follow_the_batch():
    bend = np.zeros((2, 3))
    assert tail.cable_changes(TAIL, bend)[0].shape == (2, 3)
    assert tail.joint_positions(TAIL, bend).shape == (2, 3, 6, 2)
    assert tail.end_position(TAIL, bend).shape == (2, 3, 2)
