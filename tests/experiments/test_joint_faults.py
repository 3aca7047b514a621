import csv
import io
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import xarray as xr

from suchus.article.paper import CLAIMS
from suchus.article.verdict import measure_with_interval
from suchus.core.errors import Diverged
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES
from suchus.robot.design import servo_names
from suchus.robot.gaits import GAITS
from suchus.robot.motion import cycle_targets, movement
from suchus.robot.robots import ROBOTS
from suchus.sim.land import FAILED_JOINTS, KINDS, LEGS_FAILED, Limp, Locked, Run, angle_at, joint_failure, simulate
from suchus.sim.metrics import displacement, loss, require_complete, swing_lift, swing_loads

CAIMAN = ROBOTS["caiman"]
CRAWL = GAITS["belly_crawl"]
ARMS = ("coordinated", "limbs_only")
KNEES = ("front_knee", "hind_knee")
JOINTS = (*FAILED_JOINTS, *KNEES)
CLAIMED = {f"fault_{joint}_{arm}" for joint in FAILED_JOINTS for arm in ARMS}


@pytest.fixture(scope="module")
def campaign():
    return EXPERIMENTS["joint_faults"].quick()


@pytest.fixture(scope="module")
def outcome(quick_outcome):
    return quick_outcome("joint_faults")


def test_the_full_campaign_is_as_large_as_asked():
    full = EXPERIMENTS["joint_faults"]
    runs = full.repeats * len(ARMS) * (1 + len(JOINTS) * len(KINDS) * len(LEGS_FAILED))
    assert runs == 300  # six robots, the fewest whose median has an interval, in 50 conditions
    assert full.unjudged() == ""
    assert 1.0 + full.cycles * full.gait.period == pytest.approx(9.0)


@pytest.mark.parametrize(
    ("joint", "servos"),
    [
        ("front_yaw", ("LF_yaw", "RF_yaw")),
        ("hind_pitch", ("LH_pitch", "RH_pitch")),
        ("hind_knee", ("LH_knee", "RH_knee")),
    ],
)
def test_lost_joints_are_those_of_the_girdle(joint, servos):
    assert joint_failure(CAIMAN, CRAWL, joint, "limp", "one") == (Limp(servos[0]),)
    assert joint_failure(CAIMAN, CRAWL, joint, "limp", "both") == tuple(Limp(name) for name in servos)
    held = joint_failure(CAIMAN, CRAWL, joint, "locked", "both")
    assert all(isinstance(fault, Locked) for fault in held)
    assert [fault.joint for fault in held] == list(servos)


def test_a_locked_joint_holds_in_the_middle_of_what_the_gait_asks_of_it():
    asked = cycle_targets(CAIMAN, CRAWL, np.linspace(0, 1, 4001))
    angles = asked[:, servo_names().index("LH_pitch")]
    assert angle_at(CAIMAN, CRAWL, "LH_pitch", 0.0) == pytest.approx(angles.min(), abs=1e-3)
    assert angle_at(CAIMAN, CRAWL, "LH_pitch", 1.0) == pytest.approx(angles.max(), abs=1e-3)
    assert angle_at(CAIMAN, CRAWL, "LH_pitch", 0.5) == pytest.approx((angles.min() + angles.max()) / 2, abs=1e-3)
    # strokes are symmetric: the middle of a yaw joint points straight outward
    assert angle_at(CAIMAN, CRAWL, "LF_yaw", 0.5) == pytest.approx(0.0, abs=1e-3)


def test_the_words_of_the_article_hold_for_its_own_numbers():
    others = {rule.claim for rule in EXPERIMENTS["joint_faults"].rules()} - CLAIMED
    assert others == {"fault_support", "fault_tolerance"}
    for key in CLAIMED:
        assert _says(key, CLAIMS[key].value)
        assert not _says(key, np.nan)
    assert [_says("fault_hind_pitch_coordinated", x) for x in (-0.05, -0.2, 0.3)] == [True, False, True]


def test_no_fault_costs_nothing_and_standing_still_costs_all():
    way = xr.DataArray([0.7, 0.0, -0.7, 1.4])
    assert np.allclose(loss(way, xr.DataArray(0.7)), [0.0, -1.0, -2.0, 1.0])


def test_every_cell_of_the_matrix_is_there_with_its_interval(outcome):
    cells = ["_".join(cell) for cell in product(JOINTS, KINDS, LEGS_FAILED)]
    assert len(cells) == 24
    names = [f"loss_{cell}_{arm}" for cell in cells for arm in ARMS]
    names += [f"{what}_{cell}{end}" for cell in cells for what, end in (("own_loss", "_limbs_only"), ("gain", ""))]
    for name in names:
        low, middle, high = (outcome.measures[f"{name}{end}"].value for end in ("_low", "", "_high"))
        assert low <= middle <= high or np.isnan([low, high]).all()  # two repeats are too few for an interval
        assert outcome.measures[name].unit == "-"
    for rule in EXPERIMENTS["joint_faults"].rules():
        assert rule.needs <= set(outcome.measures)
        assert rule.reason({name: measure.value for name, measure in outcome.measures.items()})
    assert outcome.verdicts == ()
    assert outcome.unjudged.startswith("Not judged")


def test_no_rule_pools_cells():
    """Every measure of a rule on losses is of one cell, by name."""
    cells = ["_".join(cell) for cell in product(JOINTS, KINDS, LEGS_FAILED)]
    for claim in (*CLAIMED, "fault_tolerance"):
        for name in {RULES[claim].measure, *(clause.measure for clause in RULES[claim].holds)}:
            assert any(cell in name for cell in cells), name


def test_losses_of_its_own_and_of_the_other_are_told_apart(campaign, outcome):
    record = outcome.record
    for arm, sign in (("coordinated", 1.0), ("limbs_only", 2.0)):
        for joint, kept in (("front_yaw", 0.9), ("hind_yaw", 0.5), ("front_pitch", -0.2)):
            at = {"arm": arm, "joint": joint}
            record = record.assign(forward=record.forward.copy())
            record.forward.loc[at] = kept**sign * record.intact_forward.sel(arm=arm) if kept > 0 else -0.1
    found = {name: measure.value for name, measure in campaign.measure(record).items()}
    share = (record.intact_forward.sel(arm="limbs_only") / record.intact_forward.sel(arm="coordinated")).median()
    assert found["loss_front_yaw_limp_one_coordinated"] == pytest.approx(-0.1)
    assert found["own_loss_front_yaw_limp_one_limbs_only"] == pytest.approx(-0.19)
    assert found["loss_front_yaw_limp_one_limbs_only"] == pytest.approx(0.81 * float(share) - 1.0)
    assert found["gain_front_yaw_limp_one"] == pytest.approx(0.09)
    assert found["gain_hind_yaw_locked_both"] == pytest.approx(0.25)
    assert found["gain_front_pitch_limp_one"] == 0.0  # of what goes backwards nothing is left


def test_a_robot_that_does_not_get_forward_has_nothing_to_lose(campaign, outcome):
    record = outcome.record
    backwards = record.assign(intact_forward=record.intact_forward * [[1.0], [-1.0]])
    found = {name: measure.value for name, measure in campaign.measure(backwards).items()}
    assert np.isnan(found["own_loss_front_yaw_limp_one_limbs_only"])
    assert np.isfinite(found["loss_front_yaw_limp_one_limbs_only"])
    told = campaign.explain(found)
    assert "With limbs only the intact robot does not get forward." in told
    assert "nan" not in told
    assert campaign.draw(replace(outcome, record=backwards, measures=campaign.measure(backwards)))
    neither = campaign.explain(found | {"forward_coordinated": -0.01})
    assert neither == "The intact robot does not get forward (-0.01 m), so that nothing can be lost."


def test_every_repeat_is_another_one_and_the_same_in_every_cell(campaign, outcome):
    forward = outcome.record.intact_forward
    assert forward.sizes["repeat"] == campaign.repeats
    assert len(np.unique(forward)) == forward.size
    runs = [Run(robot=CAIMAN, gait=CRAWL), Run(robot=CAIMAN, gait=GAITS["limbs_only"])]
    runs.append(Run(robot=CAIMAN, gait=CRAWL, faults=joint_failure(CAIMAN, CRAWL, "hind_yaw", "limp", "both")))
    repeated = simulate(campaign._repeat_runs(runs), duration=1.0 + CRAWL.period, timestep=campaign.timestep)
    way = displacement(repeated).sel(xyz="x").values.reshape(len(runs), campaign.repeats)
    assert forward.sel(arm="coordinated").values.tolist() == way[0].tolist()
    assert forward.sel(arm="limbs_only").values.tolist() == way[1].tolist()
    cell = outcome.record.forward.sel(arm="coordinated", joint="hind_yaw", kind="limp", legs="both")
    assert cell.values.tolist() == way[2].tolist()
    change = outcome.measures["loss_hind_yaw_limp_both_coordinated"].value
    assert change == pytest.approx(float(np.median(way[2] / way[0] - 1.0)))


def test_all_groups_have_the_same_legs(campaign):
    clock = np.linspace(0, 1, 50)[:, None] + np.zeros(4)
    ours = movement(CAIMAN, CRAWL).foot_positions(clock)
    assert list(campaign._gaits) == [*ARMS, "limbs_tail_lifted"]
    for name, gait in campaign._gaits.items():
        assert np.array_equal(ours, movement(CAIMAN, gait).foot_positions(clock))
        assert gait.number("tail_pitch") == GAITS["belly_crawl" if name == "coordinated" else name].number("tail_pitch")
        assert gait.has("wave") == (name == "coordinated")


def test_net_is_no_shorter_than_forward(outcome):
    assert np.all(outcome.record.net >= abs(outcome.record.forward) - 1e-12)


def test_the_table_has_a_row_for_every_reading_and_repeats_the_measures(outcome):
    rows = list(csv.DictReader(io.StringIO(outcome.tables["faults.csv"])))
    assert [tuple(row[k] for k in ("joint", "kind", "legs", "arm")) for row in rows] == list(
        product(JOINTS, KINDS, LEGS_FAILED, ARMS)
    )
    for row in rows:
        name = "_".join(row[k] for k in ("joint", "kind", "legs", "arm"))
        assert float(row["change"]) == pytest.approx(outcome.measures[f"loss_{name}"].value, abs=6e-4)
        claim = CLAIMS.get(f"fault_{row['joint']}_{row['arm']}")
        assert row["printed_change"] == ("" if row["joint"] in KNEES else f"{claim.value:.2f}")
        words = ("joint", "kind", "legs", "arm", "printed_change")
        assert all(np.isfinite(float(row[k])) for k in row if k not in words)


def test_a_cell_with_fewer_robots_has_their_median_and_no_interval(campaign, outcome):
    whole, is_first = outcome.record, outcome.record.repeat == 0
    walked = {name: whole[name].where((whole.legs == "one") | is_first) for name in ("forward", "turn")}
    lifted = {name: whole[name].where(is_first) for name in ("lifted_forward", "lifted_intact_forward")}
    record = whole.assign(walked | lifted)
    measures = campaign.measure(record)
    cell = record.isel(repeat=0).sel(joint="hind_yaw", kind="limp", legs="both", arm="limbs_only")
    intact = float(record.intact_forward.isel(repeat=0).sel(arm="coordinated"))
    assert measures["loss_hind_yaw_limp_both_limbs_only"].value == pytest.approx(float(cell.forward) / intact - 1)
    assert measures["loss_intact_limbs_tail_lifted"].value == pytest.approx(
        float(record.lifted_intact_forward[0]) / intact - 1
    )
    stated = [name for name in measures if "_both_" in name or "tail_lifted" in name]
    assert stated
    assert not [name for name in stated if name.endswith(("_low", "_high"))]
    judged = [name for name in measures if "_one_" in name and "tail_lifted" not in name and "steered" not in name]
    assert {name: measures[name] for name in judged if np.isfinite(measures[name].value)} == {
        name: outcome.measures[name] for name in judged if np.isfinite(outcome.measures[name].value)
    }


def test_for_the_verdicts_fewer_robots_walk_where_nothing_is_judged(campaign):
    short = replace(campaign.for_verdicts(), repeats=3, hinges=1)
    record = short._campaign(lambda *_: None)
    walked = record.forward.notnull()
    assert bool(walked.sel(legs="one").all())
    assert walked.sel(legs="both").sum("repeat").values.tolist() == np.full((2, 2, 2), 2).tolist()
    whole = replace(short, extent="whole")._campaign(lambda *_: None)
    assert np.array_equal(whole.forward.where(walked), record.forward, equal_nan=True)


def test_what_robust_physics_says_about_lost_joints(outcome):
    value = {name: measure.value for name, measure in outcome.measures.items()}
    # no feet on the ground in front: no forward motion; a held joint is better than a limp one
    assert value["loss_front_pitch_limp_one_coordinated"] < -0.9
    for joint, legs in product(("front_pitch", "hind_pitch"), LEGS_FAILED):
        assert value[f"loss_{joint}_locked_{legs}_coordinated"] > value[f"loss_{joint}_limp_{legs}_coordinated"] + 0.2
    # with spine and tail, two lost yaw joints cost more than one
    for joint in ("front_yaw", "hind_yaw"):
        assert value[f"loss_{joint}_limp_both_coordinated"] < value[f"loss_{joint}_limp_one_coordinated"]


def test_another_reading_of_a_lost_joint_is_measured_and_not_judged(campaign, outcome):
    full = EXPERIMENTS["joint_faults"]
    assert replace(full, kind="locked").unjudged() == (
        "Not judged: kind is locked, and its claims are judged with limp."
    )
    assert "legs is both" in replace(full, legs="both").unjudged()
    assert "repeats is 2" in replace(full, repeats=2).unjudged()
    locked = outcome.record.assign_attrs(judged_kind="locked")
    assert "loss_hind_yaw_locked_one_steered" in campaign.measure(locked)


def test_what_decides_follows_from_the_numbers(campaign, outcome):
    found = {name: measure.value for name, measure in outcome.measures.items()}
    told = campaign.explain(found | {"effect_of_kind": 0.4, "effect_of_joint": 0.1, "effect_of_legs": 0.1})
    assert "depends most on what 'failed' means" in told
    told = campaign.explain(found | {"effect_of_kind": 0.1, "effect_of_joint": 0.4, "effect_of_legs": 0.1})
    assert "depends most on which joint fails" in told
    steered = {"loss_hind_yaw_limp_one_coordinated": -0.07, "loss_hind_yaw_limp_one_steered": -0.15}
    assert "hind yaw -7% to -15% (more lost)" in campaign.explain(found | steered)
    steered |= {"loss_hind_yaw_limp_one_steered": -0.03}
    assert "hind yaw -7% to -3% (less lost)" in campaign.explain(found | steered)


def test_loads_while_a_leg_swings_carry_the_robot():
    record = simulate([Run(robot=CAIMAN, gait=CRAWL)], duration=5.0, timestep=0.005)
    loads = swing_loads(record, "RH").isel(run=0)
    assert set(loads.part.values) == {"LF", "RF", "LH", "RH", "tail", "belly"}
    # on average over a cycle the ground carries the weight; over a swing nearly so
    assert float(loads.sum()) == pytest.approx(CAIMAN.mass * 9.81, rel=0.1)
    assert float(loads.sel(part="RH")) < 0.5 * float(loads.sel(part="LH"))
    assert 0.005 < float(swing_lift(record, "RH").isel(run=0)) < 0.05


def test_a_run_that_comes_apart_is_not_measured():
    record = simulate([Run(robot=CAIMAN, gait=CRAWL)] * 2, duration=0.5, timestep=0.005)
    assert require_complete(record) is record
    broken = record.assign(cause=("run", ["", "a speed of 2e3 was reached"]), ended=("run", [0.5, 0.2]))
    with pytest.raises(Diverged, match=r"run 1 of 2, belly_crawl, diverged at 0\.20 s") as caught:
        require_complete(broken)
    assert caught.value.time == 0.2
    assert float(caught.value.record.time[-1]) == pytest.approx(0.2)


def _says(claim: str, change: float) -> bool:
    """Tell whether the sentence of a claim about a fault is true of a change of displacement."""
    rule = RULES[claim]
    return rule.held(measure_with_interval(rule.measure, change, change)) is True
