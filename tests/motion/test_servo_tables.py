"""Movements as tables of servo angles: exact curves, and tables for other robots refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import blueprint
from suchus.control.pattern_posture import PatternPosture
from suchus.design import layout
from suchus.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.gaits import GAITS
from suchus.motion import AngleTable, AnyGait, Curve, check_limits, hip_height, intended, middle_stance
from suchus.robots import ROBOTS


@pytest.fixture
def walk():
    return GAITS["animal_walk"]


@pytest.mark.parametrize("count", [5, 6, 13])
def test_a_harmonic_is_met_everywhere_not_only_at_the_samples(count):
    clock, phase = np.linspace(-1.0, 2.0, 31), np.arange(count) / count

    def wave(t):
        return 0.2 + 0.5 * np.cos(2 * np.pi * t) - 0.3 * np.sin(4 * np.pi * t)

    curve = Curve(servo="a", angles=tuple(wave(phase)))
    assert curve.at(clock) == pytest.approx(wave(clock), abs=1e-12)


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-3, 3), min_size=1, max_size=20))
def test_a_curve_passes_through_its_samples_and_repeats(angles):
    curve, phase = Curve(servo="a", angles=tuple(angles)), np.arange(len(angles)) / len(angles)
    assert curve.at(phase) == pytest.approx(np.array(angles), abs=1e-9)
    assert curve.at(phase + 3.0) == pytest.approx(curve.at(phase), abs=1e-9)


def test_servos_without_a_curve_stay_at_zero_and_before_the_start_nothing_moves():
    robot = ROBOTS["salamander"]
    servos = layout(robot).servos
    gait = AngleTable(
        name="nod",
        period=2.0,
        duty_factor=0.5,
        limb_phases=(0.0,) * 4,
        curves=(Curve(servo="neck_yaw_1", angles=(0.1, 0.0, -0.1, 0.0)),),
    )
    told = intended(robot, gait, np.array([0.0, 1.0, 1.5, 2.0])).targets
    assert told[:, servos.index("neck_yaw_1")] == pytest.approx([0.1, 0.1, 0.0, -0.1], abs=1e-12)
    assert np.abs(np.delete(told, servos.index("neck_yaw_1"), axis=1)).max() == 0.0


def test_in_the_middle_of_stance_limbs_are_where_the_table_has_them_and_the_axis_is_straight(walk):
    robot = ROBOTS["salamander"]
    place, still = layout(robot), middle_stance(robot, walk)
    assert np.abs(still[list(place.axial_yaw)]).max() == 0.0
    limb, curves = place.limbs[0], {curve.servo: curve for curve in walk.curves}
    clock = 1.0 - walk.duty_factor / 2 - walk.limb_phases[0]
    assert still[limb.servos] == pytest.approx([float(curves[place.servos[i]].at(clock)) for i in range(4)])
    assert hip_height(robot, walk) == 0.0


def test_a_table_is_written_and_read_back(walk, tmp_path):
    path = blueprint.write(walk, tmp_path / "walk.toml")
    assert blueprint.read(path, AnyGait, GAITS) == walk


def test_tables_for_others_are_refused(walk):
    robot = ROBOTS["salamander"]
    with pytest.raises(OutsideLimits, match="phases for 4 limbs; robot 'strider' has 6"):
        check_limits(ROBOTS["strider"], walk)
    with pytest.raises(UnknownName, match="servo of robot 'salamander' named 'neck'"):
        check_limits(robot, replace(walk, curves=(Curve(servo="neck", angles=(0.0,)),)))
    with pytest.raises(OutsideLimits, match=r"neck_yaw_1 of robot 'salamander' for 2\.000 rad"):
        check_limits(robot, replace(walk, curves=(Curve(servo="neck_yaw_1", angles=(2.0,)),)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"curves": ()}, "has no curve"),
        ({"curves": 2 * (Curve(servo="a", angles=(0.0,)),)}, "two curves for a"),
        ({"limb_phases": (2.0,)}, "-1 to 1 cycle"),
        ({"period": 0.0}, "period is 0 s"),
    ],
)
def test_impossible_tables_are_refused(walk, change, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(walk, **change)


@pytest.mark.parametrize("angles", [(), (float("nan"),), (7.0,)])
def test_impossible_curves_are_refused(angles):
    with pytest.raises(InvalidDesign, match=r"allowed"):
        Curve(servo="a", angles=angles)


def test_oscillators_refuse_a_table_in_a_sentence(walk):
    with pytest.raises(OutsideLimits, match="'animal_walk' is a table of angles"):
        PatternPosture(ROBOTS["salamander"], walk, standing=True)
