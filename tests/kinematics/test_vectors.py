"""The 40 published test vectors, each computed twice in 40-digit arithmetic by different routes."""

import json
from math import pi
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from suchus.robot.kinematics import leg, spine, tail, wave

VECTORS = {c["id"]: c for c in json.loads((Path(__file__).parents[1] / "data/test-vectors.json").read_text())}
HIND_LEG = SimpleNamespace(hip_offset=0.070, femur=0.086, tibia=0.089)
SPINE = SimpleNamespace(base=0.0505, link=0.0605)
NEAR = {"rtol": 1e-9, "atol": 1e-14}


def ids(prefix: str) -> list[str]:
    return [name for name in VECTORS if name.startswith(prefix)]


def given(name: str, key: str) -> np.ndarray:
    return np.asarray(VECTORS[name]["input"][key], dtype=float)


def outputs(name: str, *keys: str) -> np.ndarray:
    found = VECTORS[name]["output"]
    return np.array([float(found[key]) for key in keys])


def test_all_forty_vectors_are_used():
    used = [i for p in ("LFK", "LIK", "SFK", "SJ", "SIK", "TC", "TP", "W") for i in ids(p)]
    assert sorted(used) == sorted(VECTORS)
    assert len(VECTORS) == 40


@pytest.mark.parametrize("name", ids("LFK"))
def test_leg_forward(name):
    foot = leg.forward(HIND_LEG, np.radians(given(name, "theta_deg")))
    np.testing.assert_allclose(1000 * foot, outputs(name, "px", "py", "pz"), **NEAR)


@pytest.mark.parametrize("name", ids("LIK"))
def test_leg_inverse(name):
    knee = 1 if "elbow=+1" in VECTORS[name]["kind"] else -1
    side = 1 if "side=+1" in VECTORS[name]["kind"] else -1
    angles = leg.inverse(HIND_LEG, given(name, "p_mm") / 1000, knee=knee, side=side)
    expected = outputs(name, "theta1_deg", "theta2_deg", "theta3_deg")
    np.testing.assert_allclose(np.degrees(angles), expected, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("name", ids("SFK"))
def test_spine_forward(name):
    T = spine.forward(SPINE, np.radians(given(name, "theta_deg")))
    np.testing.assert_allclose(1000 * T[:3, 3], outputs(name, "Px", "Py", "Pz"), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(T[:3, 0], outputs(name, "x5x", "x5y", "x5z"), **NEAR)


def test_spine_jacobian():
    J = spine.jacobian(SPINE, np.radians(given("SJ1", "theta_deg")))
    expected = np.array([outputs("SJ1", *(f"dP{axis}/dth{i}" for i in range(1, 5))) for axis in "xyz"])
    np.testing.assert_allclose(1000 * J[:3, :4], expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(J[:3, 4], 0, atol=1e-17)


@pytest.mark.parametrize("name", ids("SIK"))
def test_spine_inverse(name):
    branch = 1 if "=+1" in VECTORS[name]["kind"] else -1
    first, psi = np.radians(given(name, "theta1_deg")), np.radians(given(name, "psi_deg"))
    angles = spine.inverse(SPINE, given(name, "P_mm") / 1000, psi, first_yaw=first, branch=branch)
    expected = outputs(name, *(f"theta{i}_deg" for i in range(2, 6)))
    np.testing.assert_allclose(np.degrees(angles[1:]), expected, rtol=1e-9)
    np.testing.assert_allclose(angles[0], first, **NEAR)


@pytest.mark.parametrize("name", ids("TC"))
def test_tail_cables(name):
    d, h, H = (float(given(name, key)) / 1000 for key in "dhH")
    plates = SimpleNamespace(joints=int(given(name, "N")), cord_spacing=d, gap=h, plate=H, pulley=0.020)
    bend = np.radians(given(name, "theta_deg"))
    toward, away = tail.cable_changes(plates, bend)
    phi = tail.servo_angle(plates, bend)
    found = [1000 * toward, 1000 * away, 1000 * tail.slack(plates, bend), np.degrees(phi), phi * 20]
    expected = outputs(name, "dL_toward", "dL_away", "slack", "phi_deg", "X=N d sin(theta/2N)")
    np.testing.assert_allclose(found, expected, **NEAR)


@pytest.mark.parametrize("name", ids("TP"))
def test_tail_joint_positions(name):
    plates = SimpleNamespace(joints=6, cord_spacing=0.05, gap=0.015, plate=0.030, pulley=0.020)
    bend = np.radians(given(name, "theta_deg"))
    places = np.vstack([tail.joint_positions(plates, bend), tail.end_position(plates, bend)])
    names = [*(str(i) for i in range(1, 7)), "_tip"]
    expected = np.array([outputs(name, f"x{n}", f"y{n}") for n in names])
    np.testing.assert_allclose(1000 * places, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ids("W"))
def test_wave(name):
    letter = VECTORS[name]["kind"].split("reading ")[1][0]
    swim = wave.reading(letter, length=1.0, angular_frequency=2 * pi)
    x, t = given(name, "x"), given(name, "t")
    found = [wave.displacement(swim, x, t), wave.envelope(swim, x), wave.slope(swim, x, t)]
    np.testing.assert_allclose(found, outputs(name, "y", "envelope", "dy/dx"), **NEAR)
