"""The swims of swim_free in a flow: what is measured of a record, and a whole run in space."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import Doubtful, InvalidDesign, UnreadableFile
from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_free.in_flow import (
    compare_section_speeds,
    fin_runs,
    flow_settled_speed,
    flow_speed,
    reduces_speed_error,
    residual_text,
    water_of,
)
from suchus.robot.blueprint import read_correction, write
from suchus.robot.control import Swimming
from suchus.robot.design import LinkFactors, SectionCorrection
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run
from suchus.sim.land.waters import Slice, Space
from suchus.swimming.coupling import Swim
from suchus.swimming.water import swim_of


def test_the_speed_is_that_of_the_last_cycle():
    time = np.linspace(0.0, 3.0, 301)
    x = np.where(time < 2.0, 0.1 * time, 0.2 + 0.4 * (time - 2.0))
    centre = np.stack([x, 0 * x, 0 * x], axis=1)[None]
    record = xr.Dataset(
        {"flow_centre_of_mass": (("flow_run", "flow_time", "xyz"), centre), "flow_period": ((), 1.0)},
        coords={"flow_run": ["whole"], "flow_time": time, "xyz": list("xyz")},
    )
    assert flow_speed(record, "whole") == pytest.approx(0.4)


def flow_record(*centres, period=1.0):
    """A record of swims in a flow with given places along x, of which each has 20 samples a cycle."""
    x = np.array(centres)
    centre = np.stack([x, 0 * x, 0 * x], axis=-1)
    return xr.Dataset(
        {"flow_centre_of_mass": (("flow_run", "flow_time", "xyz"), centre), "flow_period": ((), period)},
        coords={"flow_run": np.arange(len(x)), "flow_time": np.arange(x.shape[1]) * period / 20, "xyz": list("xyz")},
    )


def agree(speeds):
    """Whether each speed is too short to be settled, or the settled ones lie in each other's intervals."""
    settled = [speed for speed in speeds if speed.is_settled]
    return all(one.low <= other.high for one in settled for other in settled)


@pytest.mark.parametrize("cycles", [4, 30])
def test_the_speed_does_not_depend_on_the_ramp_where_it_is_settled(cycles):
    """Two approaches to one speed that begin otherwise: early cycles differ, and are said to be no settled ones."""
    time, wobble = np.arange(20 * cycles + 1) / 20, np.random.default_rng(5).normal(size=20 * cycles + 1)
    speeds = [0.1 * (1 - slow * np.exp(-time / 2.0)) + 0.002 * wobble for slow in (1.0, -0.8)]
    centres = [np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) / 20)]) for v in speeds]
    record = flow_record(*centres)
    found = [flow_settled_speed(record, name) for name in (0, 1)]
    assert [speed.is_settled for speed in found] == [cycles == 30] * 2
    assert agree(found)
    if cycles == 30:
        assert [speed.mean for speed in found] == pytest.approx([0.1, 0.1], rel=0.02)
    else:
        assert [speed.mean for speed in found] == [flow_speed(record, name) for name in (0, 1)]
        assert abs(found[0].mean - found[1].mean) > 0.01


def test_swims_that_begin_with_two_ramps_are_too_short_to_be_settled_or_agree():
    """On these cells the third cycles of two ramps differ by far more than a swim's cycles would, once settled."""
    robot, places = ROBOTS["swimmer"], []
    for ramp in (0.25, 1.0):
        run = Run(robot=robot, gait=swim_of(robot, frequency=1.0), water=Slice(cells=40, reynolds=600.0),
                  control=Swimming(ramp=ramp))  # fmt: skip
        swim = Swim(run, 2.0)
        swim.go(2.0, progress=silent)
        record = swim.record().isel(run=0)
        times = np.arange(41) / 20
        places.append(np.interp(times, record.time.values, record.centre_of_mass.sel(xyz="x").values))
    found = [flow_settled_speed(flow_record(*places), name) for name in (0, 1)]
    assert agree(found)
    assert not any(speed.is_settled for speed in found)  # two cycles are never enough
    assert found[0].mean != pytest.approx(found[1].mean, rel=0.01)


def test_the_rung_has_the_settings_that_were_asked_for():
    assert water_of("space", 64, 1e3, 0.0, floor=0.3) == Space(cells=64, reynolds=1e3, floor=0.3)
    assert water_of("slice", 64, 1e3, 0.1) == Slice(cells=64, reynolds=1e3)
    assert water_of("space", 64, 1e3, 0.1) == Space(cells=64, reynolds=1e3, tail_height=0.1)
    assert water_of("space", 64, 1e3, 0.0, linked=True) == Space(cells=64, reynolds=1e3, linked=True)


def test_a_robot_and_a_gait_from_files_swim_with_other_passive_tails(tmp_path):
    caiman = ROBOTS["floating_caiman"]
    robot = write(replace(caiman, name="mine"), tmp_path / "mine.toml")
    gait = write(swim_of(caiman, frequency=1.0), tmp_path / "wave.toml")
    run = Run(robot=str(robot), gait=str(gait), water=Slice(cells=40, reynolds=600.0), control=Swimming(ramp=0.5))
    found = []
    for one in (run, *fin_runs(run, (0.5, 0.002))):
        swim = Swim(one, 0.2)
        for _ in range(4):
            swim.step(0.2)
        found.append(swim.stepper.coordinates.position[-1])
        assert swim.series.residual[-1][1] < 0.01
    assert len(set(found)) == 3  # the end of the tail goes another way with each
    assert swim.run.robot.name == "mine"


def test_impossible_settings_are_refused():
    one = EXPERIMENTS["swim_free"]
    with pytest.raises(InvalidDesign, match="in_flow names sideways"):
        replace(one, in_flow=("sideways",))
    with pytest.raises(InvalidDesign, match="flow_cycles is 1"):
        replace(one, flow_cycles=1)
    for rung in ("slice", "sections"):
        with pytest.raises(InvalidDesign, match=f'linked is of swims in space, and water is "{rung}"'):
            replace(one, water=rung, linked=True)
    for changes in ({"water": "slice"}, {"water": "space", "linked": True}):
        with pytest.raises(InvalidDesign, match="floor is below a body that swims in its plane in space"):
            replace(one, floor=0.3, **changes)
    with pytest.raises(InvalidDesign, match=r"tail_height raises its tail to 0.1 m; leave out one"):
        replace(one, water="space", linked=True, tail_height=0.1)


def test_a_robot_swims_in_space_beside_its_swims_at_the_surface():
    outcome = replace(EXPERIMENTS["swim_free"].quick(), water="space").run()
    m = {name: measure.value for name, measure in outcome.measures.items()}
    assert 0.0 < m["coupling_residual"] < 0.01
    assert m["coupling_residual"] < m["coupling_first"]
    assert m["energy_error"] < 0.02
    assert m["power_error"] < 0.05
    assert abs(m["speed_space"]) > 1e-3
    assert m["link_added"] > 0
    assert {"link_r2", "joint_r2"} <= m.keys()  # which the words name
    drawn = EXPERIMENTS["swim_free"].draw(outcome)
    assert {"flow_speeds", "flow_links", "flow_residual", "flow_balance"} <= {*drawn}
    assert "residual.md" in outcome.tables
    assert "swim_in_flow.gif" in outcome.films
    assert "solved together" in outcome.decides
    assert m["unsettled_space"] == 1.0
    assert np.isnan(m["half_width_space"])
    assert "The swim is too short to be settled" in outcome.decides


@pytest.mark.slow("more than ten seconds: two cycles of a robot on its links in a flow")
def test_a_robot_swims_on_its_links_beside_its_swims_at_the_surface():
    outcome = replace(EXPERIMENTS["swim_free"].quick(), water="space", linked=True).run()
    m = {name: measure.value for name, measure in outcome.measures.items()}
    assert 0.0 < m["coupling_residual"] < 0.01
    assert m["power_error"] < 2e-3
    assert abs(m["speed_space"]) > 1e-3
    assert {"link_r2", "joint_r2"} <= m.keys()
    assert "LF_tibia" in outcome.record.link.values
    drawn = EXPERIMENTS["swim_free"].draw(outcome)
    assert {"flow_speeds", "flow_links", "flow_residual", "flow_balance"} <= {*drawn}
    assert "residual.md" in outcome.tables
    assert not outcome.films  # its vortices would be drawn around a midline


def test_a_correction_of_another_reynolds_number_or_robot_is_said(tmp_path):
    caiman = EXPERIMENTS["swim_free"]
    link = LinkFactors(bodies=("pelvis",), added=2.0, drag=3.0)
    file = write(SectionCorrection(name="found", reynolds=(7e3, 7e3), links=(link,)), tmp_path / "found.toml")
    one = replace(caiman, correction=str(file))
    assert one._lake.correction is not None
    assert one._lake.correction.factors == {"pelvis": link}
    with pytest.warns(
        Doubtful, match=r"'found' of the section model was found at f L2 / nu = 7e\+03, and this swim is at"
    ):
        one._doubt_correction()
    with pytest.raises(InvalidDesign, match=r"factors for pelvis, and robot 'swimmer' has"):
        replace(one, robot=ROBOTS["swimmer"]).quick().simulate()
    with pytest.raises(UnreadableFile, match=r"there is no file"):
        replace(caiman, correction=str(tmp_path / "none.toml")).quick().simulate()


def test_the_page_says_whether_a_correction_is_earned():
    names = ("rms", "rms_sections", "r2", "added", "added_low", "added_high", "drag", "drag_low", "drag_high")
    values = {f"residual_{name}": ("part", [1.0]) for name in (*names, "r2_fitted", "r2_held_out")}
    swims = {f"swim_{name}": (("flow_run", "part"), [[1.0]]) for name in ("r2", "added", "drag", "r2_fitted")}
    about = {"part_kind": ("part", ["link"]), "reynolds": ((), 7e3)}
    record = xr.Dataset(values | swims | about, coords={"part": ["link_1"], "flow_run": ["whole"]})
    assert "earned" not in residual_text(record)
    assert "None is earned, and no file is written." in residual_text(record, "| link |\n")
    assert "`correction.toml` beside this page" in residual_text(record, "| link |\n", is_earned=True)


def test_the_page_has_the_links_of_every_swim_that_came_to_its_end():
    about = {"part_kind": ("part", ["link", "link", "joint"]), "reynolds": ((), 7e3)}
    shapes = {"rms", "rms_sections", "r2", "added", "added_low", "added_high", "drag", "drag_low", "drag_high",
              "r2_fitted", "r2_held_out"}  # fmt: skip
    values = {f"residual_{name}": ("part", [1.0, 1.0, 1.0]) for name in shapes}
    swims = np.array([[0.1, 0.1, 0.1], [0.25, 0.75, 0.9], [np.nan] * 3])
    by_swim = {f"swim_{name}": (("flow_run", "part"), swims) for name in ("r2", "added", "drag", "r2_fitted")}
    names = {"part": ["front", "rear", "hinge"], "flow_run": ["whole", "tail_only", "broken_off"]}
    text = residual_text(xr.Dataset(values | by_swim | about, coords=names))
    assert "| tail_only | links | 0.50 (0.25 to 0.75) |" in text
    assert "| tail_only | joints | 0.90 (0.90 to 0.90) |" in text
    assert "broken_off" not in text


@pytest.mark.slow("more than ten seconds: three swims of five cycles in a slice")
def test_what_swims_in_a_slice_earn_is_a_file_that_is_taken(tmp_path):
    asked = replace(
        EXPERIMENTS["swim_free"].quick(), water="slice", cells=48, reynolds=1500.0, flow_cycles=5,
        in_flow=("whole", "tail_only", "trunk_only"),
    )  # fmt: skip
    outcome = asked.run()
    text = outcome.tables["residual.md"]
    assert "| tail_only | links |" in text
    m = {name: measure.value for name, measure in outcome.measures.items()}
    assert m["link_r2_in_tail_only"] < m["link_r2_fitted_in_tail_only"] <= 1.0
    links = [name for name in m if name.startswith("link_r2_of_")]
    assert min(m[name] for name in links) <= m["link_r2"] <= max(m[name] for name in links)
    assert "R2 in tail_only, shipped | corrected | R2 in trunk_only" in text
    assert text.count("| yes |") > 0  # plane sections feel several times what round ones do
    is_nearer = "speeds are nearer to the flow" in text
    assert is_nearer or "speeds are no nearer to the flow" in text
    assert ("correction.toml" in outcome.tables) == is_nearer
    links = tuple(LinkFactors(bodies=(one.name,), added=1.0, drag=3.0) for one in asked.robot.axis)
    file = write(SectionCorrection(name="mine", reynolds=(7e3, 7e3), links=links), tmp_path / "mine.toml")
    assert read_correction(file).links == links
    with pytest.warns(Doubtful, match="may mislead"):
        other = replace(asked, water="sections", correction=str(file)).run()
    plain, corrected = (one.measures["speed_whole"].value for one in (outcome, other))
    assert abs(corrected - plain) > 0.02 * abs(plain)


def test_forces_that_are_nearer_do_not_earn_a_correction_whose_speeds_are_not():
    assert reduces_speed_error([0.02, 0.0], [0.07, 0.03], [0.05, 0.03])
    assert not reduces_speed_error([0.02, 0.0], [0.07, -0.01], [0.07, 0.05])
    assert not reduces_speed_error([0.02], [0.05], [0.05])


def test_speeds_beside_a_flow_are_of_its_water_and_decide():
    robot = ROBOTS["floating_caiman"]
    gait = swim_of(robot, frequency=1.0)
    run = Run(robot=robot, gait=gait, water="space", control=Swimming(ramp=1.0), label="tail_only")
    links = tuple(LinkFactors(bodies=(one.name,), added=1.0, drag=3.0) for one in robot.axis)
    factors = SectionCorrection(name="mine", reynolds=(7e3, 7e3), links=links)
    text, _ = compare_section_speeds([run], [0.0], 2, 1.5e-4, factors)
    row = next(line for line in text.splitlines() if line.startswith("| tail_only"))
    shipped, corrected = (1e-3 * float(cell.split()[0]) for cell in row.split("|")[3:5])
    assert abs(shipped - corrected) > 1e-3
    for at, expected in ((corrected, True), (shipped, False)):
        text, is_nearer = compare_section_speeds([run], [at], 2, 1.5e-4, factors)
        assert is_nearer is expected
        assert ("no file is written" in text) is not expected
