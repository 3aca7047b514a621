"""Each formula misprint: the printed form fails, ours holds."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

from suchus.article.paper import ERRATA, LEG_CHAIN, SPINE_CHAIN, TABLE_I, TABLE_II
from suchus.article.paper.errata import FORMULAS
from suchus.article.paper.tables import Chain
from suchus.robot.kinematics import dh, leg, printed, spine, tail, wave

LEG = SimpleNamespace(hip_offset=0.070, femur=0.086, tibia=0.089)
SPINE = SimpleNamespace(base=0.0505, link=0.0605)
TAIL = SimpleNamespace(joints=6, plate=0.030, gap=0.015, cord_spacing=0.050, pulley=0.025)
SHOWN: set[str] = set()


def shows(*keys: str):
    """Note which misprints a test shows."""
    SHOWN.update(keys)
    assert set(keys) <= set(ERRATA)
    return lambda test: test


def shell(count: int = 20_000) -> np.ndarray:
    rng = np.random.default_rng(0)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return np.array([0.070, 0, 0]) + way * np.cbrt(rng.uniform(0.003**3, 0.175**3, (count, 1)))


def misses(p: np.ndarray) -> np.ndarray:
    """Return how far off the foot lands with the printed inverse."""
    return np.linalg.norm(leg.forward(LEG, printed.leg_inverse(LEG, p)) - p, axis=-1)


@shows("table_1_columns")
def test_table_1_under_its_labels_is_another_mechanism():
    q = np.random.default_rng(1).uniform(-1, 1, (500, 4))
    end = printed.leg_table_by_label(q)
    c = np.cos
    x = 0.070 * c(q[:, 0]) + c(q[:, :2].sum(1)) * (0.086 * c(q[:, 2]) + 0.089 * c(q[:, 2:].sum(1)))
    np.testing.assert_allclose(end[:, 0], x, atol=1e-15)
    miss = np.linalg.norm(end - leg.forward(LEG, q[:, :3]), axis=1)
    assert np.median(miss) > 0.010
    ours = dh.frames(LEG_CHAIN, q)[:, -1, :3, 3]
    np.testing.assert_allclose(ours, leg.forward(LEG, q[:, :3]), atol=1e-15)
    assert [row.a_mm for row in TABLE_I] == [70, 0, 86, 89]


@shows("table_2_columns")
def test_table_2_under_its_labels_misses_even_the_right_part_of_15():
    q = np.random.default_rng(2).uniform(-1, 1, (500, 5))
    z = printed.spine_position(SPINE, q)[:, 2]
    literal = Chain(a=(0.0, *SPINE_CHAIN.a[:4]), alpha=(0.0, *SPINE_CHAIN.alpha[:4]), d=SPINE_CHAIN.d)
    np.testing.assert_allclose(dh.frames(SPINE_CHAIN, q)[:, -1, 2, 3], z, atol=1e-15)
    assert np.abs(dh.frames(literal, q)[:, -1, 2, 3] - z).max() > 0.010
    assert [row.a_mm for row in TABLE_II] == [50.5, 60.5, 60.5, 60.5, 60.5]


@shows("eq_2_5_subscripts")
def test_subscripts_of_2_to_5_shorten_the_leg_of_7():
    assert printed.leg_by_matrix_subscripts(np.zeros(3))[0] == pytest.approx(0.156)
    assert leg.forward(LEG, np.zeros(3))[0] == pytest.approx(0.245)


@shows("eq_7_third_column")
def test_third_column_completes_the_rotation():
    q = np.array([0.4, 0.2, -0.3, 0.5])
    R = dh.frames(LEG_CHAIN, q)[-1, :3, :3]
    np.testing.assert_allclose(R[:, 2], [np.sin(q[0]), -np.cos(q[0]), 0], atol=1e-15)
    assert np.linalg.norm(R[:, :2] @ R[:, :2].T - np.eye(3)) > 0.9  # two columns alone are no rotation


@shows("eq_8_origin")
def test_plane_coordinates_are_measured_from_the_hip():
    p = leg.forward(LEG, np.array([0.3, 0.2, 0.9]))
    rho = np.hypot(p[0] - 0.070, p[1])
    assert np.hypot(rho, p[2]) == pytest.approx(np.sqrt(0.086**2 + 0.089**2 + 2 * 0.086 * 0.089 * np.cos(0.9)))
    assert np.linalg.norm(p) != pytest.approx(np.hypot(rho, p[2]), rel=0.05)  # from O it is longer


@shows("eq_9_arctan")
def test_printed_yaw_is_half_a_turn_off_inboard_of_the_hip():
    p = shell()
    inboard = p[:, 0] < 0.070
    off = np.angle(np.exp(1j * (printed.leg_inverse(LEG, p)[:, 0] - leg.inverse(LEG, p)[:, 0])))
    np.testing.assert_allclose(np.abs(off[inboard]), pi, atol=1e-9)
    np.testing.assert_allclose(off[~inboard], 0, atol=1e-9)
    above = np.array([0.070, 0.0, 0.1])
    assert np.isnan(printed.leg_inverse(LEG, above)[0])
    assert np.isfinite(leg.inverse(LEG, above)).all()


@shows("eq_10_denominator")
def test_printed_denominator_bends_the_knee_wrongly():
    p = shell(100_000)
    right, wrong = leg.inverse(LEG, p)[:, 2], printed.knee_by_wrong_side(LEG, p)
    assert np.isnan(wrong).mean() == pytest.approx(0.05, abs=0.01)
    off = np.degrees(np.nanmedian(np.abs(wrong - right)))
    assert off == pytest.approx(8, abs=1)
    np.testing.assert_allclose(printed.leg_inverse(LEG, p)[:, 2], right, atol=1e-6)  # (11) is right again


@shows("eq_11_branch")
def test_other_knee_reaches_the_same_point_and_is_not_printed():
    p = np.array([0.156, 0, 0.089])
    up, down = leg.inverse(LEG, p, knee=1), leg.inverse(LEG, p, knee=-1)
    np.testing.assert_allclose(leg.forward(LEG, np.stack([up, down])), np.stack([p, p]), atol=1e-15)
    assert printed.leg_inverse(LEG, p)[2] == pytest.approx(up[2])
    assert np.linalg.norm(leg.knee_point(LEG, up) - leg.knee_point(LEG, down)) > 0.05


@shows("eq_12_arctan")
def test_printed_pitch_is_half_a_turn_off_above_the_hip():
    p = shell()
    above, outboard = p[:, 2] < 0, p[:, 0] > 0.070
    off = np.angle(np.exp(1j * (printed.leg_inverse(LEG, p)[:, 1] - leg.inverse(LEG, p)[:, 1])))
    np.testing.assert_allclose(np.abs(off[above]), pi, atol=1e-6)
    np.testing.assert_allclose(off[~above], 0, atol=1e-6)
    assert np.median(misses(p[above & outboard])) > 0.2


@shows("eq_14_domain")
def test_printed_inverse_holds_in_one_quarter_only():
    p = shell()
    good = (p[:, 0] > 0.070) & (p[:, 2] > 0)
    assert misses(p[good]).max() < 1e-12
    assert misses(p[~good]).min() > 1e-6
    assert good.mean() == pytest.approx(0.25, abs=0.01)
    assert np.abs(leg.forward(LEG, leg.inverse(LEG, p)) - p).max() < 1e-15


@shows("eq_14_theta4", "eq_14_primes")
def test_fourth_angle_does_not_move_the_foot():
    q = np.tile([0.3, 0.2, 0.9, 0.0], (50, 1))
    q[:, 3] = np.linspace(-3, 3, 50)
    ends = dh.frames(LEG_CHAIN, q)[:, -1, :3, 3]
    np.testing.assert_allclose(ends, np.broadcast_to(leg.forward(LEG, q[0, :3]), (50, 3)), atol=1e-16)


@shows("eq_15_position")
def test_printed_spine_is_short_and_bent():
    q = np.random.default_rng(3).uniform(-0.52, 0.52, (2000, 5))
    true, wrong = spine.forward(SPINE, q)[:, :3, 3], printed.spine_position(SPINE, q)
    c, s = np.cos(q), np.sin(q)
    lost = (0.0005 - 0.0605 * c[:, 3]) * c[:, 1] * c[:, 2]
    expected = np.stack([lost * c[:, 0], lost * s[:, 0], 0 * lost], axis=1)
    np.testing.assert_allclose(wrong - true, expected, atol=1e-15)
    straight = np.zeros(5)
    assert printed.spine_position(SPINE, straight)[0] == pytest.approx(0.2325)
    assert spine.forward(SPINE, straight)[0, 3] == pytest.approx(0.2925)


@shows("eq_15_theta5")
def test_fifth_angle_turns_the_head_and_moves_nothing_else():
    q = np.array([0.2, -0.1, 0.3, 0.2, 0.0])
    turned = q + np.array([0, 0, 0, 0, 0.7])
    np.testing.assert_array_equal(printed.spine_position(SPINE, q), printed.spine_position(SPINE, turned))
    here, there = spine.forward(SPINE, q), spine.forward(SPINE, turned)
    np.testing.assert_allclose(here[:3, 3], there[:3, 3], atol=1e-17)
    assert np.arccos(here[:3, 0] @ there[:3, 0]) == pytest.approx(0.7)


@shows("eq_16_per_joint", "eq_16_symbols")
def test_printed_cord_changes_are_those_of_one_joint():
    bend = np.radians([30, 90, 180])
    toward, away = tail.cable_changes(TAIL, bend)
    np.testing.assert_allclose(6 * np.array(printed.cable_changes(TAIL, bend)), [toward, away], rtol=1e-12)
    # The hole-to-hole distance in one gap, from the points alone.
    half = bend / 12
    hole = np.array([0.015 / 2, 0.050 / 2])
    turned = np.stack([np.cos(half) * hole[0] - np.sin(half) * hole[1]] * 2)
    np.testing.assert_allclose(toward, 6 * (2 * turned[0] - 0.015), rtol=1e-12)


@shows("eq_17_slack")
def test_exact_changes_leave_slack_that_17_hides():
    bend = np.radians(90)
    assert 1000 * np.sum(tail.cable_changes(TAIL, bend)) == pytest.approx(-1.54, abs=0.01)
    assert np.sum(printed.cable_changes_shortened(TAIL, bend)) == 0


@shows("eq_18_degrees")
def test_printed_servo_angle_is_in_degrees():
    bend = np.radians([10.0, 90.0])
    np.testing.assert_allclose(
        np.radians(printed.servo_angle_deg(TAIL, bend)), tail.servo_angle(TAIL, bend), rtol=1e-15
    )
    assert printed.servo_angle_deg(TAIL, bend[1]) == pytest.approx(89.74, abs=0.01)


@shows("eq_19_x", "eq_19_y")
def test_printed_tail_is_neither_straight_nor_whole():
    straight = printed.joint_positions(TAIL, 0.0)
    np.testing.assert_allclose(straight[1:, 1], straight[1:, 0])
    assert straight[1, 0] - straight[0, 0] == pytest.approx(0.0225)
    assert np.linalg.norm(straight - tail.joint_positions(TAIL, 0.0), axis=1)[-1] == pytest.approx(0.226, abs=1e-3)
    bent = printed.joint_positions(TAIL, pi) - tail.joint_positions(TAIL, pi)
    assert np.linalg.norm(bent[-1]) == pytest.approx(0.464, abs=1e-3)
    gaps = np.linalg.norm(np.diff(printed.joint_positions(TAIL, pi), axis=0), axis=1)
    assert np.ptp(gaps) > 0.05
    ours = np.linalg.norm(np.diff(tail.joint_positions(TAIL, pi), axis=0), axis=1)
    np.testing.assert_allclose(ours, 0.045, rtol=1e-12)


@shows("eq_20_sign")
def test_printed_wave_runs_from_tail_to_head():
    for sign, way in ((1, -1), (-1, 1)):
        swim = wave.reading("I", length=1.0, angular_frequency=2 * pi, sign=sign)
        here = wave.displacement(swim, 0.5, 0.2) / wave.envelope(swim, 0.5)
        later = wave.displacement(swim, 0.5 + way * 0.1, 0.3) / wave.envelope(swim, 0.5 + way * 0.1)
        assert later == pytest.approx(here)  # the crests moved by 0.1 body lengths in 0.1 s
        t = np.linspace(0, 1, 400, endpoint=False)[:, None]
        body = np.linspace(0, 1, 401)
        product = np.mean(wave.speed(swim, body, t) * wave.slope(swim, body, t), axis=0)
        assert np.sign(np.trapezoid(product, body)) == sign  # the reactive thrust goes with its negative
    assert wave.printed_wave(angular_frequency=2 * pi).sign == 1


@shows("eq_20_units")
def test_no_reading_in_one_system_of_units_is_a_fish():
    for letter in "ADE":
        swim = wave.reading(letter, length=1.0, angular_frequency=2 * pi)
        waves, tip = swim.wave_number / (2 * pi), wave.envelope(swim, 1.0)
        assert not (0.5 < waves < 2 and 0.05 < tip < 0.2)
    ours = wave.reading("I", length=1.0, angular_frequency=2 * pi)
    assert ours.wave_number == pytest.approx(2 * pi)
    assert wave.envelope(ours, 1.0) == pytest.approx(0.109, abs=1e-3)


def test_every_misprint_of_a_formula_is_shown():
    assert {m.key for m in FORMULAS} == SHOWN
