from dataclasses import replace

import numpy as np
import pytest
from tests.swims import crocodile_swim

import suchus
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.motion import straight_gait
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import (
    Outline,
    Water,
    cruise,
    cycle,
    displaced_mass,
    fit,
    printed_wave,
    reactive,
    recoil,
    resistive,
    wave_speed,
)

STILL = straight_gait(ROBOTS["caiman"])
SMOOTH = Water(thickening=0.0)


@pytest.fixture(scope="module")
def outline():
    return Outline(suchus.ROBOTS["caiman"])


@pytest.fixture(scope="module")
def forward():
    """The wave of (20), from head to tail."""
    robot = suchus.ROBOTS["caiman"]
    return fit(robot, printed_wave(robot), name="forward").gait


@pytest.mark.parametrize("model", [resistive, reactive])
def test_no_motion_no_force(outline, model):
    effort = model(outline, cycle(outline, STILL), 0.0, Water())
    assert effort.thrust == 0.0
    assert effort.power == 0.0


@pytest.mark.parametrize("model", [resistive, reactive])
def test_a_straight_body_that_glides_feels_a_plates_friction(outline, model):
    speed, water = 0.3, Water()
    effort = model(outline, cycle(outline, STILL), speed, water)
    wide, high = outline.silhouette
    around = np.pi * (3 * (wide + high) - np.sqrt((3 * wide + high) * (wide + 3 * high)))
    plate = 1.328 / np.sqrt(speed * outline.robot.length / water.viscosity)
    area = np.trapezoid(around, outline.s)
    assert effort.thrust == pytest.approx(-0.5 * water.density * water.thickening * plate * area * speed**2, rel=1e-9)
    assert effort.power == pytest.approx(0.0, abs=1e-12)


def test_reversed_wave_reversed_thrust(outline, forward):
    ahead, back = (
        resistive(outline, cycle(outline, some), 0.0, Water()).thrust for some in (forward, forward.reversed())
    )
    assert ahead > 0
    assert back == pytest.approx(-ahead, rel=1e-9)


def test_the_printed_wave_swims_tail_first_and_ours_head_first(outline, robot):
    printed, ours = (
        cruise(outline, fit(robot, printed_wave(robot, sign=sign)).gait, resistive, Water()).speed for sign in (1, -1)
    )
    assert ours > 0.1
    assert printed == pytest.approx(-ours, rel=1e-3)


def test_a_single_hinge_gets_nowhere_by_drag(outline, forward):
    """A motion that retraces its way gives no thrust: Purcell's scallop, whose drag is resistive too."""
    flap = crocodile_swim(yaw=(0.0, 0.0, 0.0), tail_lag=0.0)
    held = resistive(outline, cycle(outline, flap, *recoil(outline, flap, 0.0, Water())), 0.0, Water())
    assert abs(held.thrust) < 1e-8
    assert cruise(outline, flap, resistive, Water()).speed == 0.0


def test_without_friction_thrust_grows_with_the_square_of_the_frequency(outline, forward):
    fast = replace(forward, period=0.5)
    for model in (resistive, reactive):
        once, twice = (model(outline, cycle(outline, some), 0.0, SMOOTH) for some in (forward, fast))
        assert twice.thrust == pytest.approx(4 * once.thrust, rel=1e-9)
        assert twice.power == pytest.approx(8 * once.power, rel=1e-9)


def test_small_motions_give_lighthills_linear_thrust(outline):
    speed, sway, turn = 0.4, 1e-4 + 2e-4j, 3e-4 - 1e-4j
    omega = 2 * np.pi
    effort = reactive(outline, cycle(outline, STILL, sway, turn), speed, SMOOTH)
    rate = 1j * omega * (sway + outline.robot.length * turn)  # of the tail's tip
    added = 1000.0 * np.pi * outline.silhouette.half_height[-1] ** 2
    expected = 0.25 * added * (abs(rate) ** 2 - speed**2 * abs(turn) ** 2)
    power = 0.5 * added * speed * float(np.real(np.conj(rate) * (rate + speed * turn)))
    assert effort.thrust == pytest.approx(expected, rel=1e-3)
    assert effort.power == pytest.approx(power, rel=1e-3)


def test_recoil_leaves_no_lateral_momentum_at_rest(outline, forward):
    small = forward.bent(1e-4)
    curve = cycle(outline, small, *recoil(outline, small, 0.0, Water()))
    wide, high = outline.silhouette
    weight = wide * high + high**2
    scale = np.trapezoid(weight * np.abs(curve.y_rate), outline.s, axis=-1).max()
    for arm in (1.0, outline.s):
        left = np.trapezoid(weight * arm * curve.y_rate, outline.s, axis=-1)
        assert np.abs(left).max() < 1e-4 * scale


def test_it_swims_slower_than_its_wave(robot, forward):
    record = suchus.swim(robot, forward)
    assert np.all((record.slip > 0) & (record.slip < 1))
    thick = suchus.swim(robot, forward, water=Water(viscosity=1e-3))
    for swum, viscosity in ((record, 1e-6), (thick, 1e-3)):
        np.testing.assert_allclose(swum.reynolds, swum.speed * robot.length / viscosity)
        np.testing.assert_allclose(swum.froude, swum.speed / np.sqrt(9.81 * robot.length), rtol=1e-3)
        np.testing.assert_allclose(swum.swimming_number, 2 * np.pi * swum.strouhal * swum.reynolds)
    assert np.all(record.power > 0)


def test_the_wave_runs_to_the_tail_or_to_the_head(outline, forward):
    there, back = (wave_speed(outline, some, cycle(outline, some)) for some in (forward, forward.reversed()))
    assert there > 0
    assert back == pytest.approx(-there, rel=1e-6)


class OneByOne(np.ndarray):
    """Numbers that are in no product of matrices, whose last digits change with the threads of the algebra."""

    def __array_ufunc__(self, ufunc, method, *inputs, **how):
        assert ufunc is not np.matmul
        return getattr(ufunc, method)(*(np.asarray(one) for one in inputs), **how)


def test_the_speed_of_the_wave_has_the_same_digits_on_any_number_of_threads(outline, forward):
    """A worker of a cluster gives the algebra one thread, and the machine that asks gives it all: records are alike."""
    curve = cycle(outline, forward)
    with pytest.raises(AssertionError):
        _ = np.ones(len(curve.y)) @ curve.y.view(OneByOne)
    assert wave_speed(outline, forward, curve._replace(y=curve.y.view(OneByOne))) == wave_speed(outline, forward, curve)


def test_a_record_has_units_and_the_same_bytes_twice(robot, forward):
    record = suchus.swim(robot, forward)
    assert all("units" in values.attrs for values in record.data_vars.values())
    assert record.identical(suchus.swim(robot, forward))
    assert dict(record.sizes) == {"model": 2, "time": 96, "station": 257}
    length = np.hypot(record.x.diff("station"), record.y.diff("station")).sum("station")
    np.testing.assert_allclose(length, robot.length, atol=1e-9)


def test_the_reactive_power_is_never_less_than_what_moves_it_on(outline, forward):
    for speed in (0.0, 0.1, 0.5):
        curve = cycle(outline, forward)
        effort = reactive(outline, curve, speed, SMOOTH)
        assert effort.power >= effort.thrust * speed


def test_the_displaced_mass_is_that_of_its_ellipses(robot):
    assert displaced_mass(Outline(robot, 2049)) == pytest.approx(displaced_mass(Outline(robot)), rel=1e-3)
    assert 1.5 < displaced_mass(Outline(robot)) < robot.mass


def test_impossible_requests_are_refused(robot, forward):
    with pytest.raises(OutsideLimits, match="tail_cable"):
        suchus.swim(robot, replace(forward, period=1 / 3))
    with pytest.raises(InvalidDesign, match="cross_drag"):
        Water(cross_drag=-1.0)
