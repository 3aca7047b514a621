from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
import xarray as xr
from tests.bodies import eel, six

from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.control import OpenLoop
from suchus.robot.design import crocodile, layout
from suchus.robot.motion import FixedLimbs, intended, roll
from suchus.robot.robots import ROBOTS
from suchus.sim.land import VACUUM, WATER, Afloat, Run, simulate
from suchus.sim.metrics import roll_angle, roll_rate

CAIMAN = ROBOTS["caiman"]
BOTH = (radians(50), radians(50))


def run_of(robot=CAIMAN, medium=VACUUM, period=0.5, **changes):
    gait = roll(robot, period=period, **({"trunk": BOTH} | changes))
    return Run(robot=robot, gait=gait, control=OpenLoop(begin=0.0, ramp=period), afloat=medium)


def afloat(*changes, medium=VACUUM, timestep=0.002, duration=1.0, robot=CAIMAN):
    runs = [run_of(robot, medium, **change) for change in changes or ({},)]
    return simulate(runs, duration=duration, timestep=timestep)


def rate(record, run=0):
    """Return the rate of a run once its bends have grown [rad/s]."""
    return float(roll_rate(record.isel(run=run), 0.5))


@pytest.fixture(scope="module")
def in_vacuum():
    return afloat({}, {"lag": -0.25}, {"trunk": (BOTH[0], 0.0)})


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
    # faster, the passive end of the tail lags sideways more than it does up and down
    record = afloat({"period": 1.0}, {"period": 1.0, "lag": 0.0}, duration=2.0)
    assert abs(float(roll_rate(record.isel(run=1), 1.0))) < 0.1 * float(roll_rate(record.isel(run=0), 1.0))


def test_the_centre_of_mass_stays_where_it_is(in_vacuum):
    moved = in_vacuum.centre_of_mass - in_vacuum.centre_of_mass.isel(time=0)
    assert float(abs(moved).max()) < 1e-4


def test_a_smaller_time_step_leaves_far_less_angular_momentum(in_vacuum):
    fine = afloat(timestep=0.001)
    coarse = float(abs(in_vacuum.isel(run=0).angular_momentum).max())
    assert float(abs(fine.angular_momentum).max()) < coarse / 4
    assert rate(fine) == pytest.approx(rate(in_vacuum), rel=1e-3)


def test_water_takes_angular_momentum_and_leaves_a_roll():
    record = afloat(medium=WATER)
    assert float(abs(record.angular_momentum).max()) > 1e-3
    assert rate(record) > pi


def test_a_thinner_fluid_changes_less(in_vacuum):
    vacuum = rate(in_vacuum)
    thin, thick = (abs(rate(afloat(medium=Afloat(density=rho, viscosity=0.0))) - vacuum) for rho in (10.0, 1000.0))
    assert 0.0 < thin < 0.1 * thick


def test_robots_of_several_designs_float_in_one_batch():
    heavy = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.25)))
    runs = [run_of(robot) for robot in (CAIMAN, heavy)]
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


@pytest.mark.parametrize("robot", [CAIMAN, six(), eel()], ids=lambda robot: robot.name)
def test_targets_start_straight_repeat_after_the_first_cycle_and_are_two_perpendicular_waves(robot):
    run = run_of(robot, trunk=(0.3, 0.4), tail=(0.5, 0.2), tail_lag=0.5)
    time, place = np.linspace(0.0, 2.0, 201), layout(robot)
    targets = intended(robot, run.gait, time, begin=0.0, ramp=0.5).targets
    assert np.abs(targets[0, place.limbs[-1].servos.stop if place.limbs else 0 :]).max() < 1e-12
    np.testing.assert_allclose(targets[time >= 0.5][:50], targets[time >= 1.0][:50], atol=1e-12)
    t = time[time >= 0.5] / 0.5
    late = targets[time >= 0.5]
    np.testing.assert_allclose(late[:, place.trunk_yaw].sum(axis=1), 0.3 * np.cos(2 * pi * t), atol=1e-12)
    np.testing.assert_allclose(late[:, place.trunk_pitch].sum(axis=1), 0.4 * np.sin(2 * pi * t), atol=1e-12)
    np.testing.assert_allclose(late[:, place.tail_pitch].sum(axis=1), -0.2 * np.sin(2 * pi * t), atol=1e-12)
    if place.tail_yaw:  # positive is to the right
        np.testing.assert_allclose(late[:, place.tail_yaw].sum(axis=1), 0.5 * np.cos(2 * pi * t), atol=1e-12)


@pytest.mark.parametrize(("robot", "turns"), [(six(), 0.9), (eel(), 0.05)], ids=["six", "eel"])
def test_another_body_rolls_without_angular_momentum_either_way(robot, turns):
    record = afloat({"period": 1.0}, {"period": 1.0, "lag": -0.25}, robot=robot, timestep=0.001, duration=2.0)
    rates = [float(roll_rate(record.isel(run=i), 1.0)) / (2 * pi) for i in (0, 1)]
    assert rates[0] > 0.5 * turns
    assert rates[1] == pytest.approx(-rates[0], rel=1e-3)
    assert float(abs(record.angular_momentum).max()) < 1e-5


@pytest.mark.parametrize("name", ["salamander", "strider", "swimmer"])
def test_who_cannot_bend_up_and_down_is_refused_by_what_is_missing(name):
    with pytest.raises(UnsuitedRobot, match=f"death roll needs a trunk that bends up and down; robot '{name}' lacks"):
        roll(ROBOTS[name], period=2.0, trunk=(0.2, 0.2))
    assert roll(ROBOTS["swimmer"], period=2.0, trunk=(0.2, 0.0)).limbs == ()


def test_limbs_lie_back_as_far_as_they_can():
    assert roll(CAIMAN, period=2.0).limbs == (FixedLimbs(angles=(-pi / 2, 0.0, 0.0)),) * 2
    stiff = replace(CAIMAN.tables, hind_leg=replace(CAIMAN.tables.hind_leg, yaw_range=(-1.0, 1.0)))
    assert roll(crocodile(stiff), period=2.0).limbs == (
        FixedLimbs(angles=(-pi / 2, 0.0, 0.0)),
        FixedLimbs(angles=(-1.0, 0.0, 0.0)),
    )
    assert roll(ROBOTS["salamandra"], period=2.0).limbs == (FixedLimbs(angles=(0.0,)),) * 2


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"trunk": (3.0, 0.0), "period": 10.0}, ["spine_yaw_1", "0.785"]),
        ({"tail": (1.8, 0.0)}, ["tail", "1.571"]),
        ({"tail": (0.0, 0.8)}, ["tail_pitch", "10.05 rad/s", "7.87 rad/s", "0.638 s"]),
    ],
)
def test_a_roll_that_the_robot_cannot_follow_is_refused(changes, said):
    with pytest.raises(OutsideLimits) as refused:
        roll(CAIMAN, **({"trunk": BOTH, "period": 0.5} | changes))
    assert all(word in str(refused.value) for word in said)


def test_a_frequency_too_low_for_the_run_is_refused():
    with pytest.raises(InvalidDesign, match="two cycles"):
        replace(EXPERIMENTS["death_roll"], frequencies=(0.1,))
