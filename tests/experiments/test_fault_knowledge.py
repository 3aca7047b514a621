"""What knowing a failed joint brings: gaits of the search, walks that are equal until they differ, exact measures."""

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign, UnreadableFile, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.fault_knowledge.experiment import (
    ARMS,
    KEPT,
    STATES,
    FaultWalk,
    settled_displacement,
    states_of,
)
from suchus.experiments.catalog.fault_knowledge.searched import INTACT, KEPT_SEARCHES, read_searches
from suchus.experiments.optimise import READY
from suchus.robot.design import value_at
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import suits
from suchus.robot.robots import ROBOTS
from suchus.sim.land import FAILED_JOINTS, KINDS, simulate

CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]


def outcome_of(spec, joints=None):
    """Return the outcome of a search that found nothing better than its beginning."""
    arms = {}
    for arm in spec.arms:
        alone = spec.for_arm(arm)
        fields = {vary.field: {"best": float(value_at(alone.run, vary.field))} for vary in alone.vary}
        if joints is None or arm.name.startswith((INTACT, *joints)):
            arms[arm.name] = {"tried": 1, "best": {arm.name: {"fields": fields}}}
    run = spec.run
    return {"optimisation": spec.name, "robot": run.robot.name, "gait": run.gait.name, "seed": 1, "arms": arms}


@pytest.fixture(scope="module")
def outcome(quick_outcome):
    return quick_outcome("fault_knowledge")


def test_the_kept_gaits_are_of_every_joint_that_the_article_breaks_and_can_be_walked():
    searched = read_searches("", CAIMAN, CRAWL)
    assert searched.joints == FAILED_JOINTS
    assert set(searched.gaits) == {f"{joint}_{arm}" for joint in (INTACT, *FAILED_JOINTS) for arm in ARMS}
    for name, gait in searched.gaits.items():
        assert suits(CAIMAN, gait), name
        assert (gait == gait.without("axis", name=gait.name)) == name.endswith("_limbs_only")
        assert gait.period == CRAWL.period


def test_what_made_the_kept_gaits_is_kept_with_them():
    kept = json.loads(KEPT_SEARCHES.read_text(encoding="utf-8"))
    spec = READY["fault"]()
    assert (kept["seed"], kept["population"], kept["timestep"]) == (spec.seed, spec.population, spec.timestep)
    assert "suchus" in kept["versions"]
    for name, arm in kept["arms"].items():
        assert arm["tried"] >= spec.evaluations, name
        assert arm["best"][name]["aims"]["displacement"] > arm["start"]["displacement"], name
        assert set(arm["best"][name]["fields"]) <= {vary.field for vary in spec.vary}


def test_a_file_that_is_no_search_of_faults_is_refused(tmp_path):
    file = tmp_path / "outcome.json"
    for text in ("{}", "[]", json.dumps(outcome_of(READY["fault"]()) | {"optimisation": "crawl"})):
        file.write_text(text)
        with pytest.raises(UnreadableFile, match=r"no outcome of a search for failed joints; name the outcome\.json"):
            read_searches(file, CAIMAN, CRAWL)
    lacking = outcome_of(READY["fault"]())
    lacking["arms"]["front_yaw_coordinated"]["best"] = {}
    file.write_text(json.dumps(lacking))
    with pytest.raises(UnreadableFile, match="lacks the best gait of the condition 'front_yaw_coordinated'"):
        read_searches(file, CAIMAN, CRAWL)
    with pytest.raises(UnreadableFile, match="there is no"):
        read_searches(tmp_path / "nothing.json", CAIMAN, CRAWL)


def test_another_robot_is_told_how_to_search_its_own_gaits():
    question = EXPERIMENTS["fault_knowledge"].quick().for_robot(ROBOTS["strider"])
    with pytest.raises(
        UnsuitedRobot, match=r"walks in 'tripod'; search its own with suchus optimise fault --robot stri"
    ):
        question.simulate()


def test_another_robot_walks_in_the_gaits_that_were_searched_for_it(tmp_path):
    strider, file = ROBOTS["strider"], tmp_path / "outcome.json"
    file.write_text(json.dumps(outcome_of(READY["fault"](strider), joints=("hind_yaw",))))
    question = replace(EXPERIMENTS["fault_knowledge"].quick().for_robot(strider), searches=str(file))
    assert question.gait == default_gait(strider)
    result = question.run()
    assert list(result.record.joint.values) == ["hind_yaw"]
    assert np.isfinite(result.measures["gain_limp_coordinated"].value)
    assert result.unjudged.startswith("Not judged: robot is")
    assert question.draw(result)


def test_too_few_cycles_for_the_change_of_gait_are_refused():
    with pytest.raises(InvalidDesign, match=r"cycles is 3; delay, change of gait and 2 settled cycles .* need 4"):
        replace(EXPERIMENTS["fault_knowledge"], cycles=3).simulate()


def test_walks_are_equal_until_the_fault_and_then_until_the_robot_knows_of_it():
    question = replace(EXPERIMENTS["fault_knowledge"].quick(), onset=0.1, delay=0.1)
    searched = read_searches("", CAIMAN, CRAWL)
    cells = [("coordinated", "", "", KEPT), ("coordinated", "limp", "front_pitch", KEPT)]
    cells.append(("coordinated", "limp", "front_pitch", "front_pitch"))
    runs = [question.walk(FaultWalk(*cell), searched) for cell in cells]
    record = simulate(runs, duration=2.6, timestep=0.01)
    intact, kept, told = (record.servo_angle.isel(run=run).transpose("time", "servo").values for run in range(3))
    fault, known = (np.searchsorted(record.time.values, time + 1e-9) for time in (1.4, 1.8))
    assert np.array_equal(intact[:fault], kept[:fault])
    assert np.array_equal(kept[:known], told[:known])
    assert not np.allclose(intact[fault:known], kept[fault:known], atol=1e-3)
    assert not np.allclose(kept[known:], told[known:], atol=1e-3)


@pytest.mark.parametrize("turned", [0.0, 1.0, -2.5])
def test_the_settled_displacement_counts_along_the_heading(turned):
    """A body that sways about its heading and goes along it, whichever way it was turned before."""
    time, period, speed = np.arange(0.0, 20.01, 0.1), 4.0, 0.05
    yaw = turned + 0.3 * np.sin(2 * np.pi * time / period)
    position = speed * time[:, None] * np.array([np.cos(turned), np.sin(turned), 0.0])
    zero = np.zeros_like(yaw)
    quaternion = np.stack([np.cos(yaw / 2), zero, zero, np.sin(yaw / 2)], axis=-1)
    record = xr.Dataset(
        {
            "centre_of_mass": (("run", "time", "xyz"), position[None]),
            "orientation": (("run", "time", "wxyz"), quaternion[None]),
            "joint_angle": (("run", "time", "joint"), np.zeros((1, len(time), 1))),
        },
        coords={"time": time, "xyz": list("xyz"), "joint": ["spine_yaw_1"]},
    )
    assert float(settled_displacement(record, 2, period).item()) == pytest.approx(2 * period * speed, rel=1e-3)


def test_the_robot_that_knows_walks_in_the_gait_of_its_own_joint():
    joints = ["front_yaw", "hind_yaw"]
    values = xr.DataArray(
        [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]],
        dims=("joint", "gait"),
        coords={"joint": joints, "gait": [KEPT, INTACT, *joints]},
    )
    assert states_of(values).transpose("joint", "state").values.tolist() == [[1.0, 2.0, 3.0], [5.0, 6.0, 8.0]]


def test_gains_are_differences_of_the_means_over_the_joints(outcome):
    """Told 0.3 m with spine and tail and 0.2 m with limbs only, kept 0.1 m: gains of 0.2 m and 0.1 m."""
    record = outcome.record.copy(deep=True)
    values = {KEPT: 0.1, INTACT: 0.15, "told": 0.3}
    for state in STATES:
        record.forward.loc[{"state": state}] = values[state]
    record.forward.loc[{"state": "told", "arm": "limbs_only"}] = 0.2
    record.unbroken_forward.loc[{"reference": INTACT}] = 0.4
    record.gait_forward[:] = 0.12
    record.gait_forward.loc[{"gait": "hind_pitch"}] = 0.25
    measures = {name: measure.value for name, measure in EXPERIMENTS["fault_knowledge"].measure(record).items()}
    for kind in KINDS:
        assert measures[f"gain_{kind}_coordinated"] == pytest.approx(0.2)
        assert measures[f"gain_{kind}_limbs_only"] == pytest.approx(0.1)
        assert measures[f"search_gain_{kind}_coordinated"] == pytest.approx(0.05)
        assert measures[f"difference_{kind}"] == pytest.approx(0.1)
        assert measures[f"loss_{kind}_limbs_only_told"] == pytest.approx(-0.5)
        assert measures[f"tolerance_{kind}"] == pytest.approx(0.25)
    assert measures["forward_limp_coordinated_single"] == pytest.approx(0.25)
    assert measures["joint_gain_limp_coordinated"] == pytest.approx(0.05)


def test_payback_is_the_time_from_which_on_the_robot_that_knows_is_ahead(outcome):
    record = outcome.record.copy(deep=True)
    time, period = record.time.values, float(record.period)
    record.track.loc[{"state": KEPT}] = 0.1 * time
    record.track.loc[{"state": "told"}] = np.where(time < 1.0, 0.0, 0.3 * (time - 1.0))  # ahead after 1.5 s
    record.track.loc[{"state": "told", "arm": "limbs_only"}] = 0.0
    measures = EXPERIMENTS["fault_knowledge"].measure(record)
    assert measures["payback_limp_coordinated"].value == pytest.approx(1.5 / period, abs=0.11 / period)
    assert np.isnan(measures["payback_limp_limbs_only"].value)
