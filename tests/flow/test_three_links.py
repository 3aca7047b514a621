"""What the three-link swimmer is held against: momentum in potential flow, and how its links hang together."""

import numpy as np
import pytest
from three_links import REACH, gait, in_potential_flow, links


def test_links_meet_in_their_joints_and_move_as_they_say():
    root, rate = np.array([0.3, -0.2, 0.7]), np.array([0.1, 0.4, -0.5])
    angles, rates = gait(0.6, 0.4)
    (places, moving), h = links(root, rate, angles, rates), 1e-6
    ahead, _ = links(root + h * rate, rate, angles + h * rates, rates)
    assert (ahead - places) / h == pytest.approx(moving, abs=1e-5)
    way = np.stack([np.cos(places[:, 2]), np.sin(places[:, 2])], axis=1)
    for one in (0, 1):
        assert places[one, :2] + REACH * way[one] == pytest.approx(places[one + 1, :2] - REACH * way[one + 1])


@pytest.mark.parametrize("time", [0.3, 1.4])
def test_the_gait_has_the_rates_that_it_says(time):
    h = 1e-6
    assert (gait(0.4, time + h)[0] - gait(0.4, time - h)[0]) / (2 * h) == pytest.approx(gait(0.4, time)[1], abs=1e-6)


def test_a_cycle_in_potential_flow_goes_with_the_square_of_its_size():
    small, large = (in_potential_flow(size, 1, points=8, count=48) for size in (0.05, 0.1))
    assert large[0] == pytest.approx(4 * small[0], rel=0.02)
    assert abs(large[2]) < 1e-6  # a circle about the straight swimmer turns it nowhere
