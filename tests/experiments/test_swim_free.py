"""Measures of swims in six degrees of freedom, on hand-made records; and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.start_batch import start_batch
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_free.experiment import _ends, _radius, _settled_speed, _uneven
from suchus.experiments.catalog.swim_free.figure import draw_below
from suchus.experiments.catalog.swim_free.flow_figure import _fins
from suchus.experiments.catalog.swim_free.in_flow import fins, passive_joints
from suchus.experiments.catalog.swim_free.submerged import DIVE_LABELS
from suchus.robot.control import Swimming
from suchus.robot.design import GRAVITY
from suchus.robot.motion import LIMBS_UP, intended
from suchus.robot.robots import ROBOTS

SWIM = crocodile_swim(yaw=(0.1, 0.2, 0.3), yaw_lag=(0.0, 0.0, 0.0), tail=0.5, tail_lag=0.0, limbs=LIMBS_UP)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_circle_has_its_radius_and_its_side(sign):
    time = np.linspace(0, 6, 601)
    angle = sign * 0.3 * time
    track = 0.8 * np.stack([np.sin(angle), sign * (1 - np.cos(angle)), 0 * time], axis=-1)
    part = xr.Dataset(
        {
            "centre_of_mass": (("time", "xyz"), track),
            "orientation": (("time", "wxyz"), from_axis_angle(np.array([0.0, 0.0, 1.0]), angle)),
        },
        coords={"time": time, "xyz": list("xyz")},
    )
    assert _radius(part, 1.0) == pytest.approx(sign * 0.8, rel=0.01)
    record = part.assign_attrs(frequency=1.0, measured_cycles=4)
    speed = _settled_speed(part.centre_of_mass, record)
    assert not speed.is_settled
    assert speed.mean == pytest.approx((track[600, 0] - track[200, 0]) / 4)


@pytest.mark.parametrize(("amplitudes", "expected"), [((0.2, 0.2, 0.2), 1.0), ((0.4, 0.1, 0.1), 2.0)])
def test_joints_that_share_unevenly_are_told(amplitudes, expected):
    phase = 2 * np.pi * np.arange(100) / 100
    angles = np.sin(phase)[:, None] * np.array(amplitudes)
    part = xr.Dataset({"joint_angle": (("time", "joint"), angles)}, coords={"joint": ["a", "b", "c"]})
    assert _uneven(part, ["a", "b", "c"]) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("drag", "expected"), [(1.0, (0.7, 1.5)), (2.3, (0.7, 2.3)), (0.3, (0.3, 1.5)), (1.5, (0.7, 1.5))]
)
def test_the_band_is_as_wide_as_the_table_of_sections_asks(drag, expected):
    found = _ends(("cross_drag", "thickening"), {"cross_drag": drag, "added_mass": 3.0})
    assert found == {"cross_drag": expected, "thickening": (0.5, 2.0)}


def test_the_table_is_read_where_this_body_swims():
    """A wider swing has larger Keulegan numbers: more drag beyond the attached layer, and more added mass."""
    one = EXPERIMENTS["swim_free"]
    found = [one._by_table(motion) for motion in (SWIM.bent(0.2), SWIM)]
    for name in ("cross_drag", "added_mass"):
        assert 0.2 < found[0][name] < found[1][name] < 3.0


def posture(robot, gait, time):
    """Return what ``Swimming`` commands over time, and watch that it is the gait that grows."""
    swims = start_batch(Swimming(), [robot], [gait], [0], len(time), time[1])
    targets = np.array([swims.command(tick, None).targets[0] for tick in range(len(time))])
    assert targets == pytest.approx(intended(robot, gait, time, begin=0.0, ramp=1.0).targets, abs=1e-12)
    return targets


def test_a_swim_grows_and_a_mean_bend_goes_to_its_side():
    robot = ROBOTS["caiman"]
    time = np.linspace(0, 3, 301)
    turned = SWIM.with_numbers(tail_offset=0.4, trunk_offset=0.3)
    plain, steered = (posture(robot, gait, time) for gait in (SWIM, turned))
    assert np.abs(plain[0, 12:]).max() == 0.0
    assert np.abs(plain[200:]).max(axis=0)[[14, 16]] == pytest.approx((0.2, 0.3), rel=0.01)
    more = steered - plain
    assert more[:, 14] == pytest.approx(0.1)
    assert (more[:, -1] < 0).all()
    assert plain[:, 1] == pytest.approx(-0.3)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"cycles": 0}, "cycles is 0"),
        ({"spread": ("salt",)}, "spread names salt; there is cross_drag"),
        ({"level": 0.1}, "level is 0.1 m"),
        ({"stiffness": 0.0}, "stiffness is 0 N m/rad"),
    ],
)
def test_bad_swims_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(EXPERIMENTS["swim_free"], **fields)


@pytest.mark.parametrize(
    ("fields", "message"), [({"points": 1000}, "a power of two is needed"), ({"heels": (4.0,)}, "heels is")]
)
def test_bad_floats_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(EXPERIMENTS["floating"], **fields)


def test_pitch_is_drawn_nose_down_positive_as_in_fig_11():
    time = np.arange(3.0)
    record = xr.Dataset(
        {
            "deep_depth": (("dive", "dive_time"), [[0.0, 0.1, 0.2]]),
            "deep_pitch": (("dive", "dive_time"), [[0.0, 0.1, 0.2]]),
        },
        coords={"dive": [next(iter(DIVE_LABELS))], "dive_time": time},
        attrs={"depth": 0.2, "deep_from": 1.0},
    )
    pitch = draw_below(record, DIVE_LABELS).axes[1]
    assert "nose down positive" in pitch.get_ylabel()
    assert pitch.lines[0].get_ydata().tolist() == np.degrees(record.deep_pitch.values[0]).tolist()


def swum_with_fins(speeds, powers):
    """What is kept of swims in a flow with softer and stiffer passive ends: steady ones, two cycles of 1 s."""
    time = np.linspace(0.0, 2.0, 201)
    names = ["whole", *(f"whole_fin_{k:g}" for k in (0.1, 0.4, 1.6))]
    x = np.array([0.1, *speeds])[:, None] * time
    centre = np.stack([x, 0 * x, 0 * x], axis=-1)
    power = np.array([1.0, *powers])[:, None] + 0 * x
    return xr.Dataset(
        {
            "flow_centre_of_mass": (("flow_run", "flow_time", "xyz"), centre),
            "flow_servo_power": (("flow_run", "flow_time"), power),
            "flow_period": ((), 1.0),
            "reynolds": ((), 3000.0),
            "mass": ("run", [2.0]),
        },
        coords={"flow_run": names, "flow_time": time, "xyz": list("xyz")},
        attrs={"flow": "slice"},
    )


@pytest.mark.parametrize(("speeds", "at"), [((0.1, 0.2, 0.15), 1), ((0.3, 0.2, 0.15), 0), ((0.1, np.nan, 0.15), 2)])
def test_the_best_fin_is_the_fastest_of_those_that_were_tried(speeds, at):
    record = swum_with_fins(speeds, (1.0, 4.0, 1.0))
    tried = fins(record)
    assert tried.stiffness.values.tolist() == [0.1, 0.4, 1.6]
    assert tried.speed.values == pytest.approx(speeds, nan_ok=True)
    costs = np.array([1.0, 4.0, 1.0]) / (2.0 * GRAVITY * np.array(speeds))
    assert tried.cost.values == pytest.approx(costs, nan_ok=True)
    assert int(np.nanargmax(tried.speed.values)) == at
    titles = [ax.get_title(loc="left") for ax in _fins(record, tried).axes]
    assert titles[0] == f"best at {tried.stiffness[at]:g} N m/rad" + ("" if at == 1 else ", the end of what was tried")


def test_a_swim_backwards_has_no_cost_of_transport():
    assert np.isnan(fins(swum_with_fins((-0.1, 0.2, 0.1), (1.0, 1.0, 1.0))).cost.values[0])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"fin": (0.1,)}, 'water is "sections"'),
        ({"fin": (-0.1,), "water": "slice"}, "fin.0. is -0.1 N m/rad"),
        ({"fin": (float("nan"),), "water": "slice"}, "fin.0. is nan"),
        ({"fin": (0.1,), "water": "slice", "robot": ROBOTS["swimmer"]}, "no passive lateral joint"),
    ],
)
def test_a_fin_that_cannot_be_is_refused(changes, words):
    with pytest.raises(InvalidDesign, match=words):
        replace(EXPERIMENTS["swim_free"], **changes)


def test_fins_are_swum_from_the_softest_on_and_nothing_else_changes():
    experiment = replace(EXPERIMENTS["swim_free"], water="slice", fin=(0.8, 0.2, 0.8), in_flow=("whole",))
    runs = experiment._flow_runs({"whole": SWIM, "reversed": SWIM.reversed()})
    assert [run.label for run in runs] == ["whole", "whole_fin_0.2", "whole_fin_0.8"]
    joints = passive_joints(experiment.robot)
    for run, stiffness in zip(runs[1:], (0.2, 0.8), strict=True):
        hinges = {hinge.name: hinge for hinge in run.robot.axis_hinges}
        assert {hinges[name].drive.stiffness for name in joints} == {stiffness}
        assert replace(run, robot=runs[0].robot, label="whole") == runs[0]
