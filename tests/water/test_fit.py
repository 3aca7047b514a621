from dataclasses import dataclass

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.design import layout
from suchus.robot.motion import cycle_targets, lateral_servos, movement
from suchus.swimming.water import BodyWave, FilmedWave, Outline, fit, printed_wave


def bends(robot, gait):
    """Return how far each lateral servo bends the midline to either side, a cable at all its joints together [rad]."""
    yaw, servos = movement(robot, gait).yaw, layout(robot).servos
    moved = [[servos[i] == name for i in yaw.hinges.servos] for name in lateral_servos(robot)]
    return [float(yaw.amplitude()[0][mine].sum()) for mine in moved]


@pytest.mark.parametrize(
    ("waves", "misfit", "yaw", "tail"),
    [(1 / 1.5, 4, 11, 24), (1.0, 8, 20, 39), (1 / 0.7, 14, 30, 52)],  # the audit's table, of a body of 1.055 m
)
def test_reading_i_fits_as_the_audit_expects(robot, waves, misfit, yaw, tail):
    found = fit(robot, printed_wave(robot, "I", waves_per_body=waves))
    assert 100 * found.misfit == pytest.approx(misfit, abs=1.5)
    assert np.degrees(max(bends(robot, found.gait)[:-1])) == pytest.approx(yaw, abs=6)
    assert np.degrees(bends(robot, found.gait)[-1]) == pytest.approx(tail, abs=8)


def test_the_literal_reading_is_hardly_a_wave_and_fits_well(robot):
    found = fit(robot, printed_wave(robot, "A"))
    assert found.misfit < 0.03
    assert np.degrees(max(bends(robot, found.gait)[:-1])) == pytest.approx(5, abs=2)


def test_the_printed_sign_plays_the_motion_backwards(robot):
    printed, ours = (fit(robot, printed_wave(robot, sign=sign), name="w").gait for sign in (1, -1))
    clock = np.linspace(0.0, 1.0, 21)
    assert cycle_targets(robot, printed, clock) == pytest.approx(cycle_targets(robot, ours, -clock), abs=1e-6)
    assert bends(robot, printed) == pytest.approx(bends(robot, ours), abs=1e-9)


def test_a_wave_of_the_tail_leaves_the_trunk_nearly_alone(robot):
    *trunk, tail = bends(robot, fit(robot, printed_wave(robot, "H")).gait)
    assert max(trunk) < 0.25 * tail


@dataclass(frozen=True)
class Arc:
    """A body that bends evenly along the cable section and nowhere else, as far as small angles go."""

    robot: object
    bend: float
    period: float = 2.0

    def slope(self, x, time):
        share = Outline(self.robot).bending_at(np.atleast_1d(x))[:, 3]
        return self.bend * np.cos(np.pi * time) * share

    def displacement(self, x, time):
        return np.concatenate([[0.0], np.cumsum(np.diff(x) * self.slope(0.5 * (x[1:] + x[:-1]), time))])


def test_what_the_joints_can_make_is_found_again(robot):
    wave = Arc(robot, 0.01)
    assert isinstance(wave, BodyWave)
    found = fit(robot, wave)
    assert bends(robot, found.gait)[-1] == pytest.approx(0.01, rel=1e-3)
    assert max(bends(robot, found.gait)[:-1]) < 1e-5
    assert found.gait.frequency == 0.5
    assert found.misfit < 1e-3


@pytest.mark.parametrize(("reading", "joint"), [("B", "spine_yaw_1"), ("J", "spine_yaw_1"), ("G", "tail_yaw_")])
def test_a_wave_that_the_joints_cannot_make_names_the_joint(robot, reading, joint):
    with pytest.raises(OutsideLimits) as refused:
        fit(robot, printed_wave(robot, reading), name="printed")
    assert joint in str(refused.value)
    assert "rad" in str(refused.value)


def test_slopes_are_derivatives(robot):
    x = np.linspace(0.01, robot.length, 50)
    filmed = FilmedWave(length=robot.length, frequency=0.7, wavelength=0.9, head=0.02, tail=0.1)
    for wave in (printed_wave(robot), filmed):
        difference = (
            wave.displacement(x + 1e-6, np.float64(0.3)) - wave.displacement(x - 1e-6, np.float64(0.3))
        ) / 2e-6
        np.testing.assert_allclose(wave.slope(x, np.float64(0.3)), difference, atol=1e-7)


def test_wrong_requests_are_refused(robot):
    with pytest.raises(UnknownName):
        printed_wave(robot, "Z")
    with pytest.raises(InvalidDesign, match="period"):
        fit(robot, Arc(robot, 0.01, period=-1.0))
