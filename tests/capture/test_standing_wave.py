import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from suchus.animals.capture import standing_index

# first harmonics of the joints of Pleurobot's published salamander kinematics: amplitudes and phases [deg]
WALK = (
    [15.3, 4.6, 12.4, 12.8, 18.1, 7.6, 2.7, 13.8, 12.7, 15.2, 2.8],
    [-98, -12, -94, -97, -101, -93, -271, -279, -272, -275, -254],
)
SWIM = (
    [3.1, 6.6, 9.3, 7.9, 7.3, 7.4, 13.5, 15.3, 8.7, 14.5, 13.3],
    [94, -21, -92, -155, -174, -213, -213, -274, -284, -325, -362],
)


def test_one_phase_is_a_standing_wave_and_a_node_does_not_matter():
    np.testing.assert_allclose(standing_index([1, 2, 3], [0.4, 0.4, 0.4]), 1.0, atol=1e-12)
    np.testing.assert_allclose(standing_index([1, 2, 3], [0.4, 0.4, 0.4 + np.pi]), 1.0, atol=1e-12)


@given(st.integers(2, 20), st.integers(1, 3))
def test_whole_waves_along_equal_joints_travel(joints, waves):
    if 2 * waves % joints == 0:
        joints = 2 * waves + 1
    phase = 2 * np.pi * waves * np.arange(joints) / joints
    np.testing.assert_allclose(standing_index(np.ones(joints), phase), 0.0, atol=1e-12)


def test_salamander_walk_stands_and_swim_travels_as_published():
    np.testing.assert_allclose(standing_index(WALK[0], np.radians(WALK[1])), 0.912, atol=0.004)
    np.testing.assert_allclose(standing_index(SWIM[0], np.radians(SWIM[1])), 0.084, atol=0.004)


def test_a_straight_line_through_the_phases_cannot_tell_them_apart():
    # weighted by amplitude, without the first joint: the fit that field notes published
    slopes = [np.polyfit(np.arange(1, 11), phase[1:], 1, w=A[1:])[0] for A, phase in (WALK, SWIM)]
    np.testing.assert_allclose(slopes, [-33.2, -33.6], atol=0.06)
    assert standing_index(WALK[0], np.radians(WALK[1])) - standing_index(SWIM[0], np.radians(SWIM[1])) > 0.8


def test_what_does_not_bend_has_no_wave():
    assert np.isnan(standing_index([0.0, 0.0], [0.0, 1.0]))
