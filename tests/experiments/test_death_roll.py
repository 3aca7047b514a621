from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
import xarray as xr

from suchus.control import Rolling
from suchus.design import crocodile
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.experiments import EXPERIMENTS
from suchus.gaits import GAITS
from suchus.land import VACUUM, WATER, Afloat, Run, simulate
from suchus.metrics import roll_angle, roll_rate
from suchus.motion import Roll, check_roll, roll_targets
from suchus.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]
TRUNK = Roll(
    frequency=2.0,
    trunk_lateral=radians(50),
    trunk_vertical=radians(50),
    tail_lateral=0.0,
    tail_vertical=0.0,
    lag=0.25,
    tail_lag=0.0,
)


def afloat(rolls, medium=VACUUM, timestep=0.002, duration=1.0):
    gait = replace(GAITS["limbs_only"], period=0.5)
    runs = [Run(robot=CAIMAN, gait=gait, control=Rolling(roll), afloat=medium) for roll in rolls]
    return simulate(runs, duration=duration, timestep=timestep)


def rate(record, run=0):
    """Return the rate of a run once its bends have grown [rad/s]."""
    return float(roll_rate(record.isel(run=run), 0.5))


@pytest.fixture(scope="module")
def in_vacuum():
    return afloat([TRUNK, replace(TRUNK, lag=-0.25), replace(TRUNK, trunk_vertical=0.0)])


def test_the_body_turns_while_its_angular_momentum_stays_zero(in_vacuum):
    run = in_vacuum.isel(run=0)
    assert rate(in_vacuum) > pi
    assert float(abs(run.angular_momentum).max()) < 1e-3 * 0.002 * rate(
        in_vacuum
    )  # the body's own moment is beyond 0.002 kg m2


def test_reversed_phase_reverses_the_roll(in_vacuum):
    forth, back = (rate(in_vacuum, i) for i in (0, 1))
    assert back == pytest.approx(-forth, rel=1e-6)


def test_one_bend_alone_turns_nothing(in_vacuum):
    assert abs(float(roll_rate(in_vacuum.isel(run=2)))) < 1e-9


def test_two_slow_bends_at_the_same_time_hardly_turn_it():
    slow = replace(
        TRUNK, frequency=1.0
    )  # faster, the passive end of the tail lags sideways more than it does up and down
    record = afloat([slow, replace(slow, lag=0.0)], duration=2.0)
    assert abs(float(roll_rate(record.isel(run=1), 1.0))) < 0.1 * float(roll_rate(record.isel(run=0), 1.0))


def test_the_centre_of_mass_stays_where_it_is(in_vacuum):
    moved = in_vacuum.centre_of_mass - in_vacuum.centre_of_mass.isel(time=0)
    assert float(abs(moved).max()) < 1e-4


def test_a_smaller_time_step_leaves_far_less_angular_momentum(in_vacuum):
    fine = afloat([TRUNK], timestep=0.001)
    coarse = float(abs(in_vacuum.isel(run=0).angular_momentum).max())
    assert float(abs(fine.angular_momentum).max()) < coarse / 4
    assert rate(fine) == pytest.approx(rate(in_vacuum), rel=1e-3)


def test_water_takes_angular_momentum_and_leaves_a_roll():
    record = afloat([TRUNK], WATER)
    assert float(abs(record.angular_momentum).max()) > 1e-3
    assert rate(record) > pi


def test_a_thinner_fluid_changes_less(in_vacuum):
    vacuum = rate(in_vacuum)
    thin, thick = (abs(rate(afloat([TRUNK], Afloat(density=rho, viscosity=0.0))) - vacuum) for rho in (10.0, 1000.0))
    assert 0.0 < thin < 0.1 * thick


def test_robots_of_several_designs_float_in_one_batch():
    heavy = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.25)))
    gait = replace(GAITS["limbs_only"], period=0.5)
    runs = [Run(robot=r, gait=gait, control=Rolling(TRUNK), afloat=VACUUM) for r in (CAIMAN, heavy)]
    both = simulate(runs, duration=0.6, timestep=0.002)
    alone = simulate(runs[1:], duration=0.6, timestep=0.002)
    assert float(abs(both.angular_momentum).max()) < 1e-4
    np.testing.assert_allclose(both.joint_angle.isel(run=1), alone.joint_angle.isel(run=0), atol=1e-9)


def rotations(axis: np.ndarray, angles: np.ndarray) -> np.ndarray:
    return np.column_stack([np.cos(angles / 2), np.sin(angles / 2)[:, None] * axis])


def record_of(orientation: np.ndarray) -> xr.Dataset:
    count = len(orientation)
    return xr.Dataset(
        {
            "orientation": (("time", "wxyz"), orientation),
            "snout": (("time", "xyz"), np.tile([0.5, 0.0, 0.0], (count, 1))),
            "tail_tip": (("time", "xyz"), np.tile([-0.5, 0.0, 0.0], (count, 1))),
        },
        coords={"time": np.linspace(0.0, 2.0, count), "xyz": list("xyz"), "wxyz": list("wxyz")},
    )


def test_roll_counts_every_turn():
    angles = np.linspace(0.0, 6 * pi, 301)
    turned = roll_angle(record_of(rotations(np.array([1.0, 0.0, 0.0]), angles)))
    np.testing.assert_allclose(turned, angles, atol=1e-9)


def test_turns_about_other_axes_are_no_roll():
    turned = roll_angle(record_of(rotations(np.array([0.0, 0.6, 0.8]), np.linspace(0.0, 2.0, 101))))
    np.testing.assert_allclose(turned, 0.0, atol=1e-12)


def test_a_pelvis_on_a_cone_that_comes_back_has_not_rolled():
    around = np.linspace(0.0, 2 * pi, 201)
    axes = np.column_stack([np.zeros_like(around), np.cos(around), np.sin(around)])
    cone = np.column_stack([np.full_like(around, np.cos(0.25)), np.sin(0.25) * axes])
    assert float(roll_rate(record_of(cone))) == pytest.approx(0.0, abs=1e-12)


def test_targets_start_straight_and_repeat_after_the_first_cycle():
    time = np.linspace(0.0, 2.0, 201)
    targets = roll_targets(CAIMAN, replace(TRUNK, tail_lateral=0.5, tail_vertical=0.3), time)
    assert np.all(targets[0, 12:] == 0.0)
    np.testing.assert_allclose(targets[time >= 0.5][:50], targets[time >= 1.0][:50], atol=1e-12)
    assert targets[-1, [12, 14, 16]].sum() == pytest.approx(TRUNK.trunk_lateral)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"trunk_lateral": 3.0, "frequency": 0.1}, ["spine_yaw_1", "0.785"]),
        ({"tail_lateral": 1.8}, ["tail", "1.571"]),
        ({"tail_vertical": 0.8}, ["tail_pitch", "7.00 rad/s"]),
    ],
)
def test_a_roll_that_the_robot_cannot_follow_is_refused(changes, said):
    with pytest.raises(OutsideLimits) as refused:
        check_roll(CAIMAN, replace(TRUNK, **changes))
    assert all(word in str(refused.value) for word in said)


def test_a_frequency_too_low_for_the_run_is_refused():
    with pytest.raises(InvalidDesign, match="two cycles"):
        replace(EXPERIMENTS["death_roll"], frequencies=(0.1,))
