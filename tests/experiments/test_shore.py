"""What counts as ashore, fallen and in the water, on hand-made records; and what is refused."""

from dataclasses import replace
from math import radians, sin, tan

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle, rotate
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.shore import experiment as shore
from suchus.experiments.catalog.shore.figure import _obliquely, draw_decides, levelled, posture_times
from suchus.robot.control import OpenLoop
from suchus.sim.land import Ground, simulate
from suchus.sim.record import ground_text

SHORE = EXPERIMENTS["shore"]


def kept(**changes):
    """Return three paths of 10 s: one that walks ashore, one that falls on its way, one that does not come so far."""
    moment = np.arange(0.0, 10.0, 0.5)
    ahead = np.array([-2.0 + 0.4 * moment, -2.0 + 0.4 * moment, -2.0 + 0.29 * moment])
    tilt = np.array([0.2 + 0 * moment, np.where(moment > 8.0, 1.1, 0.2), 0.2 + 0 * moment])
    walks = (ahead > -1.0).astype(float)
    values = {
        "ahead": ahead,
        "aside": 0.0 * ahead,
        "tilt": tilt,
        "walks": walks,
        "ground": walks * 0.5,
        "under": np.clip(-ahead, 0.0, 0.95),
        "power": 2.0 + 4.0 * walks,
    } | {name: np.array(value) for name, value in changes.items()}
    found = xr.Dataset({name: (("case", "moment"), value) for name, value in values.items()}, {"moment": moment})
    cases = {
        "kind": ["ashore"] * 3, "walk": ["crawl"] * 3, "slope": [0.1, 0.1, 0.2], "grip": [0.6, 1.0, 1.0],
        "air_released": [0.5] * 3, "switches": [1, 1, 2],
    }  # fmt: skip
    for name, value in cases.items():
        found[name] = ("case", np.array(value))
    metres = {"speed": [0.1, 0.2, 0.1], "power": [3.0, 1.2, 1.0], "depth": [-9.9, 0.1, 0.63], "swing": [0.2, 0.1, 0.1]}
    for name, value in metres.items():
        found[f"metre_{name}"] = ("where", np.array(value))
    found["metre_weight"] = ("where", np.full(3, 30.0))
    return found.assign_coords(where=["land", "surface", "deep"]).assign_attrs(
        beyond=1.0, depth=0.6, approach=0.0, shown=0, metacentric_height=0.01, length=0.8, beat=1.5
    )


@pytest.mark.parametrize(("beyond", "time"), [(0.99, 7.5), (1.01, 8.0), (1.81, np.nan)])
def test_it_is_ashore_as_soon_as_it_is_so_far_beyond_the_line(beyond, time):
    found = shore.times_ashore(kept().assign_attrs(beyond=beyond))
    assert found[0] == pytest.approx(time, nan_ok=True)


@pytest.mark.parametrize(("degrees", "fell"), [(59.0, False), (61.0, True)])
def test_who_tilts_by_more_than_sixty_degrees_has_fallen_and_is_not_ashore(degrees, fell):
    tilt = np.full((3, 20), 0.1)
    tilt[0, 5] = radians(degrees)
    record = kept(tilt=tilt)
    assert shore.find_fallen(record)[0] == fell
    assert np.isnan(shore.times_ashore(record)[0]) == fell
    tilt[0, 5] = np.nan  # diverged
    assert shore.find_fallen(kept(tilt=tilt))[0]


@pytest.mark.parametrize(
    ("tilt", "walks", "ground", "over"),
    [(61.0, 0.0, 0.009, True), (61.0, 1.0, 0.009, False), (61.0, 0.0, 0.011, False), (59.0, 0.0, 0.009, False)],
)
def test_who_falls_while_it_swims_and_floats_free_has_capsized(tilt, walks, ground, over):
    """What it does later does not count: at the end it lies on the ground and moves its limbs."""
    heel, legs, load = np.full((3, 20), 0.1), np.ones((3, 20)), np.full((3, 20), 0.5)
    heel[0, 4:], legs[0, :6], load[0, :6] = radians(tilt), walks, ground
    record = kept(tilt=heel, walks=legs, ground=load)
    assert shore.find_capsized(record).tolist() == [over, False, False]
    assert ("after 2 s it capsizes" in shore.ending(record)) == over
    measures = measured(record)
    assert measures["capsized"].value == over
    said = SHORE.explain({name: measure.value for name, measure in measures.items()})
    assert ("1 of these while they swam: upright its metacentric height is 10.0 mm" in said) == over


def test_nobody_ashore_is_said_of_the_time_that_was_simulated():
    measures = {name: measure.value for name, measure in measured(kept()).items()}
    assert "half of these within 8 s" in SHORE.explain(measures)
    none = measures | {"ashore_share": 0.0, "time_ashore": np.nan}
    assert "0% of the runs came ashore within the 2 s that were simulated" in SHORE.quick().explain(none)


@pytest.mark.parametrize(
    ("ahead", "share", "walks", "inside"),
    [(-0.5, 0.009, 0.0, True), (-0.5, 0.011, 0.0, False), (-0.5, 0.0, 1.0, False), (0.1, 0.0, 0.0, False)],
)
def test_it_is_in_the_water_if_it_swims_there_and_floats_free(ahead, share, walks, inside):
    full = np.ones((3, 20))
    record = kept(ahead=ahead * full, ground=share * full, walks=walks * full, tilt=0.1 * full)
    assert shore.in_water(record).all() == inside
    end = np.array(share * full)
    end[:, :14] = 0.5  # what was before the last seconds does not count
    other = kept(ahead=ahead * full, ground=end, walks=walks * full, tilt=0.1 * full)
    assert shore.in_water(other).all() == inside


def measured(record):
    """Return the measures of some paths to the shore, beside three into the water."""
    into = kept(ahead=np.full((3, 20), -1.0), ground=np.zeros((3, 20)), walks=np.zeros((3, 20)))
    into["kind"] = ("case", np.array(["into_water"] * 3))
    return SHORE.measure(xr.concat([record, into], "case", data_vars="minimal", combine_attrs="override"))


def test_measures_count_who_came_ashore_fell_and_changed_its_mind():
    found = measured(kept())
    assert found["ashore_share"].value == pytest.approx(1 / 3)
    assert found["falls"].value == 1.0
    assert found["switches"].value == 2.0
    assert found["time_ashore"].value == found["time_ashore_longest"].value == 7.5
    assert found["into_water_share"].value == pytest.approx(2 / 3)  # one fell
    assert found["ashore_share_steepest"].value == 0.0
    assert found["ashore_share_least_grip"].value == 1.0
    assert found["ashore_share_most_grip"].value == 0.0
    assert found["ashore_share_air_released_0"].value == 0.0
    assert found["air_released_0"].value == 0.5


def test_a_metre_costs_power_over_speed():
    record = kept().isel(case=[0])
    found = shore._costs(record)
    assert found["speed_ashore"].value == pytest.approx(0.4)
    assert found["work_per_metre_ashore"].value == pytest.approx(6.0 / 0.4)
    assert found["work_per_metre_wading"].value == pytest.approx(6.0 / 0.4)
    assert np.isnan(found["work_per_metre_swimming"].value)  # the first 3 s do not count


def test_a_metre_is_measured_along_the_course():
    """Aslant by 0.6435 rad 0.4 m up are 0.5 m along, and 0.3 m aside."""
    record = kept(aside=kept().ahead.values * 0.75).isel(case=[0]).assign_attrs(approach=np.arctan2(3, 4))
    assert shore._costs(record)["speed_ashore"].value == pytest.approx(0.5)
    assert shore._costs(record.assign_attrs(approach=0.0))["speed_ashore"].value == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("shown", "said"),
    [
        (0, "after 3 s it walks, and after 8 s it is 1 m beyond the water line"),
        (1, "after 3 s it walks, and it falls"),
        (2, "it walks, and it does not get 1 m beyond the water line"),
    ],
)
def test_what_is_shown_is_said_as_it_came(shown, said):
    assert said in shore.ending(kept().assign_attrs(shown=shown))
    swims = kept(walks=np.zeros((3, 20)))
    assert "does not begin to walk" in shore.ending(swims)


@pytest.mark.parametrize("into", [True, False])
def test_down_a_shore_the_water_is_ahead_and_up_a_shore_behind(into):
    """Of real runs, whose robot is put into the water, or onto dry land, by the level alone."""
    runs = [SHORE._run(SHORE.gait, uphill, 1.0, 0.0, 0) for uphill in (radians(10), radians(-10))]
    runs = [
        replace(run, lake=replace(run.lake, level=run.lake.level + (0.6 if into else -0.6)), control=OpenLoop())
        for run in runs
    ]
    found = shore.paths(simulate(runs, duration=0.1), runs, 1)
    found["ground"], found["walks"] = 0.0 * found.ground, 0.0 * found.walks  # as if it swam
    assert ((found.ahead < 0.0) == into).all()
    assert ((found.under > 0.5) == into).all()
    assert (shore.in_water(found) == into).all()


def test_a_metre_on_land_at_the_surface_and_at_depth_costs_power_over_speed_and_weight():
    found = shore._metre_costs(kept())
    assert [found[f"work_per_metre_{where}"].value for where in ("land", "surface", "deep")] == pytest.approx(
        [30, 6, 10]
    )
    assert found["net_cost_of_transport_surface"].value == pytest.approx(0.2)
    assert found["depth_error"].value == pytest.approx(0.03)
    assert found["strouhal_surface"].value == pytest.approx(1.5 * 0.1 / 0.2)
    assert found["froude_deep"].value == pytest.approx(0.1 / (9.81 * 0.8) ** 0.5, rel=1e-3)
    assert "strouhal_land" not in found


def test_metres_are_read_from_the_last_seconds_along_the_course():
    time = np.linspace(0.0, 4.0, 5)
    way = np.array([[0, 0, 0], [9, 0, 0], [0, 0, 0], [0.3, 0.4, 0], [0.6, 0.8, 0]], dtype=float)
    aside = np.array([9.0, 9.0, 0.1, -0.1, 0.05])[:, None] * np.array([-0.8, 0.6, 0.0])  # across the course
    record = xr.Dataset(
        {
            "centre_of_mass": (("run", "time", "xyz"), way[None]),
            "tail_tip": (("run", "time", "xyz"), way[None] + aside - [0.3, 0.4, 0.0]),
            "position": (("run", "time", "xyz"), way[None] + [0, 0, 2.4]),
            "water_level": (("run", "time"), np.full((1, 5), 3.0)),
            "servo_power": (("run", "time", "servo"), np.array([[9.0, 9.0, 2.0, 3.0, 4.0]])[..., None]),
            "mass": ("run", [2.0]),
        },
        {"time": time, "xyz": list("xyz")},
    )
    found = shore.metres(record, ["deep"], 2.0)
    assert found.metre_speed.item() == pytest.approx(0.5)
    assert found.metre_power.item() == pytest.approx(3.5)  # of the two intervals between three samples
    assert found.metre_depth.item() == pytest.approx(0.6)
    assert found.metre_swing.item() == pytest.approx(0.2)


def test_limbs_whose_phase_stands_still_do_not_walk():
    phase = np.array([[0.0, 0.0, 0.1, 0.2, 0.2]])
    assert shore.walking(phase).tolist() == [[False, False, True, True, False]]


@pytest.mark.parametrize("uphill", [radians(10), radians(-10)])
def test_the_water_line_is_where_the_slope_meets_the_level(uphill):
    run = SHORE._run(SHORE.gait, uphill, 1.0, 0.0, 0)
    line = shore.water_line(run)
    assert line * sin(uphill) == pytest.approx(run.lake.level)
    assert line > 0.0
    assert (run.lake.level > 0.0) == (uphill > 0.0)
    assert run.control.begins == ("swimming" if uphill > 0.0 else "walking")


def test_the_caption_says_that_a_robot_which_comes_obliquely_looks_shorter():
    assert "obliquely, at 49 degrees" in _obliquely(0.85)
    assert "obliquely, at 49 degrees" in _obliquely(-0.85)
    assert _obliquely(0.0) == ""


def test_a_robot_is_drawn_when_its_head_is_ahead_of_its_feet():
    time = np.arange(0.0, 40.0, 0.1)
    ahead = -2.0 + 0.08 * time
    reach = 0.1 + 0.1 * np.sin(2 * np.pi * time / 2.0)  # of the foremost foot, which hides the head above 0.13 m
    level = xr.Dataset(
        {
            "snout": (("time", "xyz"), np.stack([ahead + 0.13, 0 * ahead, 0 * ahead], axis=-1)),
            "foot_position": (("time", "leg", "xyz"), np.stack([ahead + reach, 0 * ahead, 0 * ahead], -1)[:, None]),
        },
        {"time": time, "xyz": ["x", "y", "z"]},
    )
    path = xr.Dataset({"ahead": ("moment", ahead)}, {"moment": time})
    times = posture_times(level, path, 1.0, 1.0)
    assert np.interp(times, time, reach) == pytest.approx([0.0] * 4, abs=0.02)
    assert np.diff(np.interp(times, time, ahead)) == pytest.approx([1.04] * 3, abs=0.25)
    for length, count in ((0.1, 4), (2.5, 3), (5.0, 2), (7.0, 1)):  # of longer ones fewer find room on the way
        assert len(posture_times(level, path, length, 1.0)) == count


@pytest.mark.parametrize("air", [False, True])
def test_a_robot_without_air_has_no_map_of_it_and_where_nobody_came_ashore_is_no_scale(air):
    record = kept(ahead=np.full((3, 20), -1.0)) if not air else kept()
    if air:
        record["kind"] = ("case", np.array(["ashore", "ashore", "air"]))
    figure = draw_decides(record.assign_attrs(air_released=0.0))
    assert len(figure.axes) == (3 if air else 1)
    assert [bool(ax.get_title("left")) for ax in figure.axes[:2]] == ([True, True] if air else [False])


def test_a_levelled_run_stands_on_a_slope_whose_water_line_is_the_origin():
    slope, line = 0.2, 1.5
    points = np.array([[line, 0.0, 0.0], [line + 1.0, 0.3, 0.0]])
    names = ("position", "centre_of_mass", "snout", "tail_tip")
    record = xr.Dataset(dict.fromkeys(names, (("time", "xyz"), points)), {"time": [0.0, 1.0]})
    record["foot_position"] = record["foot_force"] = (("time", "leg", "xyz"), points[:, None])
    record["orientation"] = (("time", "wxyz"), from_axis_angle(np.array([0.0, 0.0, 1.0]), np.zeros(2)))
    record["stands_on"] = ((), ground_text(Ground(uphill=slope)))
    found = levelled(record.assign_attrs(line=line))
    assert found.position[0].values == pytest.approx(np.zeros(3), abs=1e-12)
    assert float(found.position[1, 2]) == pytest.approx(sin(slope))
    assert float(found.position[1, 2] / found.position[1, 0]) == pytest.approx(tan(slope))
    up = rotate(found.orientation.values[0], np.array([1.0, 0.0, 0.0]))
    assert up == pytest.approx([np.cos(slope), 0.0, sin(slope)])


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"slopes": (0.2, 0.1)}, "slopes is"),
        ({"slopes": (0.0,)}, "slopes is"),
        ({"friction_scales": ()}, "friction_scales is \\(\\)"),
        ({"seeds": 0}, "seeds is 0"),
        ({"air_released": 1.5}, "air_released is 1.5"),
        ({"approach": 1.5}, "approach is 1.5"),
        ({"duration": 0.1}, "duration is 0.1 s"),
    ],
)
def test_shores_that_cannot_be_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(SHORE, **fields)


def test_each_run_is_a_robot_as_built_on_a_floor_that_is_told_as_designed(monkeypatch):
    seen = []

    def stopped(runs, **_):
        seen.extend(runs)
        raise KeyboardInterrupt

    monkeypatch.setattr(shore, "simulate", stopped)
    question = replace(SHORE, slopes=SHORE.slopes[:1], others=(), other_air_released=())
    with pytest.raises(KeyboardInterrupt):
        question.simulate()
    designed = [run for _, _, run in question._cases()]
    assert len(seen) == len(designed)
    assert len({run.zero_error for run in seen}) == len({run.seed for run in designed}) > 7
    for built, run in zip(seen, designed, strict=True):
        assert built.noise == run.noise == 0.0
        assert built.robot != run.robot
        assert built.ground.friction_scale != run.ground.friction_scale in question.friction_scales
