from dataclasses import replace

import numpy as np
import pytest

from suchus.animals.capture import film_animal
from suchus.animals.capture.feet import GRID, FootContact, contact, grid, path_shape, sweep
from suchus.animals.capture.swings import Swing
from suchus.robot.motion.limbs import foot_path


@pytest.mark.parametrize("duty", [0.4, 0.5, 0.7])
def test_the_path_is_that_of_a_gait(duty):
    np.testing.assert_allclose(path_shape(duty), foot_path(grid(), duty)[0], atol=1e-9)


@pytest.mark.parametrize(("leg", "touch_down"), [("LF", 0.3), ("RF", 0.8), ("LH", 0.05), ("RH", 0.55)])
def test_contact_edges_of_a_foot_that_starts_smoothly(lizard, clean, leg, touch_down):
    tracks = film_animal(lizard, clean, cycles=4)
    found = contact(tracks, leg, lizard.period)
    apart = (found.touch_down - touch_down + 0.5) % 1.0 - 0.5
    assert abs(apart) < 0.01
    np.testing.assert_allclose(found.duty, 0.7, atol=0.015)
    np.testing.assert_allclose(found.stance.mean(), found.duty, atol=1.5 / GRID)


def test_the_speed_of_a_standing_foot_is_nearly_nothing(lizard, clean):
    found = contact(film_animal(lizard, clean, cycles=4), "LF", lizard.period)
    assert found.speed[(grid() > 0.4) & (grid() < 0.9)].max() < 0.03 * found.speed.max()


def test_a_stance_across_the_end_of_the_cycle():
    none = Swing._make(np.empty(0) for _ in Swing._fields)
    edges = FootContact(
        speed=np.zeros(GRID),
        stance=np.zeros(GRID, dtype=bool),
        lift_off=0.2,
        touch_down=0.8,
        middle=0.0,
        middle_error=0.0,
        duty_error=0.0,
        scatter=0.0,
        hidden=0.0,
        swings=none,
    )
    np.testing.assert_allclose(edges.duty, 0.4, atol=1e-12)


@pytest.mark.parametrize("leg", ["LF", "RF", "LH", "RH"])
def test_the_middle_of_a_stance_lies_between_its_edges(lizard, clean, leg):
    found = contact(film_animal(lizard, clean, cycles=4), leg, lizard.period)
    apart = found.middle - (found.touch_down + found.duty / 2)
    assert abs((apart + 0.5) % 1.0 - 0.5) < 0.005


def test_a_slip_does_not_belong_to_the_swing(lizard, clean):
    tracks = film_animal(lizard, clean, cycles=4)
    position = tracks.position.copy()
    foot = position[:, tracks.points.index("LF")]
    phase = (tracks.time / lizard.period) % 1.0
    slid = 0.02 * (np.floor(tracks.time / lizard.period) + np.clip((phase - 0.6) / 0.1, 0.0, 1.0))
    foot[:, 0] += slid  # at a quarter of the top speed of the swing
    found = contact(replace(tracks, position=position), "LF", lizard.period)
    still = contact(tracks, "LF", lizard.period)
    np.testing.assert_allclose(found.duty, still.duty, atol=0.02)


def test_a_straight_trunk_makes_the_sweep_that_of_the_ground(lizard, clean):
    tracks = film_animal(replace(lizard, spine_bend=0.0), clean, cycles=4)
    found = sweep(tracks, "LF", lizard.period)
    np.testing.assert_allclose(np.ptp(found.forward) / 2, lizard.stride * lizard.duty_factor / 2, rtol=0.05)
    np.testing.assert_allclose(found.outward, lizard.outward, rtol=1e-6)
    np.testing.assert_allclose(found.lift, lizard.lift, rtol=0.02)
