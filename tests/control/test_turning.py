import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.control import CURVES, AttitudeRule, TurningCurve, turn
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import heading_change, path_length

CURVE = TurningCurve(bend=0.8, asymmetry=0.5, mixtures=(0.0, 0.5, 1.0), curvatures=(0.0, 1.0, 2.5))


@given(radius=st.floats(0.41, 100.0))
def test_a_turn_reads_the_curve_backwards_and_mirrors_to_the_right(radius):
    left, right = turn(CURVE, radius), turn(CURVE, -radius)
    assert np.interp(left.bend / 0.8, CURVE.mixtures, CURVE.curvatures) == pytest.approx(1 / radius)
    assert left.asymmetry / 0.5 == pytest.approx(left.bend / 0.8)
    assert (right.bend, right.asymmetry) == (-left.bend, -left.asymmetry)


def test_points_of_the_curve_come_out_exactly_and_straight_ahead_is_straight():
    assert turn(CURVE, 1.0).bend == pytest.approx(0.4)
    assert turn(CURVE, 0.4).bend == pytest.approx(0.8)
    assert turn(CURVE, 1e9).bend == pytest.approx(0.0, abs=1e-6)
    assert turn(CURVE, 1.0, attitude=AttitudeRule()).feels


def test_a_circle_too_tight_is_refused_with_the_tightest():
    with pytest.raises(OutsideLimits, match=r"no tighter than 0\.4 m"):
        turn(CURVE, 0.3)


def test_a_curve_that_does_not_rise_is_refused():
    with pytest.raises(InvalidDesign, match="curvatures must increase"):
        TurningCurve(bend=0.8, asymmetry=0.0, mixtures=(0.0, 1.0), curvatures=(1.0, 0.5))
    with pytest.raises(InvalidDesign, match="as many mixtures"):
        TurningCurve(bend=0.8, asymmetry=0.0, mixtures=(0.0, 0.5, 1.0), curvatures=(0.0, 1.0))


def test_curves_on_the_shelf_walk_the_circle_to_either_side(robot):
    asked = np.array([1.1, -1.1])
    for name in ("semi_erect", "high_walk"):
        runs = [Run(robot=robot, gait=GAITS[name], control=turn(CURVES[name], radius)) for radius in asked]
        start, end = START + GAITS[name].period, START + 7 * GAITS[name].period
        record = simulate(runs, duration=end, timestep=0.005)
        walked = path_length(record, start, end).values / heading_change(record, start, end).values
        assert walked == pytest.approx(asked, rel=0.12)
