"""Limbs of any chain: what the inverse finds, the forward returns."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import NotConverged, Unreachable
from suchus.robot.design import Hinge, Limb, Link
from suchus.robot.kinematics import leg, limb
from suchus.robot.robots import ROBOTS

CAIMAN, SALAMANDER, PLEUROBOT = ROBOTS["caiman"], ROBOTS["salamander"], ROBOTS["pleurobot"]
LEG, ARM = CAIMAN.girdles[1].limb, SALAMANDER.girdles[0].limb
SERVO = CAIMAN.hind_leg.servo


def hinge(name, turn, low=-2.5, high=2.5):
    return Hinge(name=name, turn=turn, drive=SERVO, range=(low, high))


def link(name, hinges, length):
    return Link(name=name, hinges=hinges, end=(0.0, length, 0.0), radius=0.01, mass=0.1)


OTHER = Limb(
    links=(
        link("upper", (hinge("yaw", "yaw"), hinge("pitch", "pitch")), 0.10),
        link("middle", (hinge("knee", "pitch", -0.1, 2.5),), 0.08),
        link("lower", (hinge("ankle", "pitch", -0.1, 2.5),), 0.05),
    ),
    foot=LEG.foot,
)


def angles_of(design, seed=0, count=400):
    low, high = np.array([one.range for one in design.hinges]).T
    return np.random.default_rng(seed).uniform(low, high, (count, len(low)))


def test_each_kind_is_seen():
    assert (limb.kind(LEG), limb.kind(ARM), limb.kind(OTHER)) == ("leg", "arm", "other")
    bent = replace(ARM, links=(ARM.links[0], replace(ARM.links[1], end=(0.001, 0.005, 0.0))))
    assert limb.kind(bent) == "other"


def test_the_leg_is_the_articles():
    angles = angles_of(LEG)
    own = leg.forward(CAIMAN.hind_leg, angles)
    found = limb.forward(LEG, angles)
    base = np.stack([found[:, 1] + CAIMAN.hind_leg.hip_offset, found[:, 0], -found[:, 2]], axis=-1)
    np.testing.assert_allclose(base, own, atol=1e-15)
    np.testing.assert_allclose(limb.forward(LEG, limb.inverse(LEG, found)), found, atol=1e-12)


@given(
    out=st.floats(0.001, 0.008),
    ahead=st.floats(-0.006, 0.006),
    up=st.floats(-0.006, 0.002),
    plane=st.floats(-3.0, 3.0),
)
def test_an_arm_reaches_its_foot_and_stands_in_its_plane(out, ahead, up, plane):
    foot = np.array([ahead, out, up])
    if not 0.0011 < np.linalg.norm(foot) < 0.0109:
        return
    angles = limb.inverse(ARM, foot, swivel=plane)
    np.testing.assert_allclose(limb.forward(ARM, angles), foot, atol=1e-13)
    elbow = limb.forward(replace(ARM, links=ARM.links[:1]), angles[:3])
    along = foot / np.linalg.norm(foot)
    aside = elbow - (elbow @ along) * along
    upward = np.array([0.0, 0.0, 1.0]) - along[2] * along
    forward = np.cross(along, upward)
    assert np.arctan2(aside @ forward, aside @ upward) == pytest.approx(plane, abs=1e-6)


def test_an_arm_straight_below_the_hip_has_an_answer():
    foot = np.array([0.0, 0.0, -0.008])
    angles = limb.inverse(ARM, foot, swivel=0.0)
    np.testing.assert_allclose(limb.forward(ARM, angles), foot, atol=1e-15)
    elbow = limb.forward(replace(ARM, links=ARM.links[:1]), angles[:3])
    assert elbow[1] > 0.001  # the plane's zero, up, falls outward here


@pytest.mark.parametrize("design", [LEG, ARM, OTHER, PLEUROBOT.girdles[0].limb], ids=["leg", "arm", "other", "bones"])
def test_the_jacobian_is_the_derivative(design):
    angles = angles_of(design, count=50)
    _, jacobian = limb._chain(design, angles)
    for i in range(angles.shape[1]):
        step = np.zeros(angles.shape[1])
        step[i] = 1e-6
        slope = (limb.forward(design, angles + step) - limb.forward(design, angles - step)) / 2e-6
        np.testing.assert_allclose(jacobian[..., i], slope, atol=1e-8)


def test_steps_find_what_closed_forms_do_not_have():
    angles = angles_of(OTHER, count=300)
    foot = limb.forward(OTHER, angles)
    found = limb.inverse(OTHER, foot)
    np.testing.assert_allclose(limb.forward(OTHER, found), foot, atol=1e-7 * OTHER.reach * 1.01)
    low, high = np.array([one.range for one in OTHER.hinges]).T
    assert ((found >= low) & (found <= high)).all()
    warm = limb.inverse(OTHER, foot, start=angles + 0.02)
    assert np.abs(warm - angles).max() < np.abs(found - angles).max()


def test_steps_agree_with_the_closed_form_of_the_leg():
    angles = angles_of(LEG, count=100) * [0.5, 0.4, 0.0] + [0.0, 0.2, 0.9]
    foot = limb.forward(LEG, angles)
    found = limb._numeric(LEG, foot, angles + 0.05)
    np.testing.assert_allclose(found, angles, atol=1e-6)


def test_out_of_reach_is_said_of_the_points_beyond():
    far = np.array([[0.0, 0.02, 0.0], [0.0, 0.005, -0.003]])
    with pytest.raises(Unreachable, match=r"1 of 2 foot points are out of reach.*0.02 m away, and 0.001 to 0.011 m"):
        limb.inverse(ARM, far)
    with pytest.raises(Unreachable):
        limb.inverse(ARM, np.array([0.0, np.nan, 0.0]))
    np.testing.assert_allclose(limb.forward(ARM, limb.inverse(ARM, far[1])), far[1], atol=1e-12)


def test_a_point_that_the_ranges_forbid_is_said():
    hip = hinge("yaw", "yaw", -0.1, 0.1), hinge("pitch", "pitch", -0.1, 0.1)
    narrow = replace(OTHER, links=(replace(OTHER.links[0], hinges=hip), *OTHER.links[1:]))
    with pytest.raises(NotConverged, match="1 of 1 foot points were not reached within the joints' ranges"):
        limb.inverse(narrow, np.array([-0.15, 0.0, 0.0]))
