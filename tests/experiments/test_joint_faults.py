import csv
import io
import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import xarray as xr

from suchus.design import servo_names, value_at
from suchus.errors import Diverged
from suchus.experiments import EXPERIMENTS
from suchus.experiments.joint_faults.experiment import tolerance
from suchus.gaits import GAITS
from suchus.land import FAILED_JOINTS, KINDS, LEGS_FAILED, Limp, Locked, Run, angle_at, joint_failure, simulate
from suchus.metrics import displacement, loss, swing_lift, swing_loads, whole
from suchus.motion import cycle_targets, movement
from suchus.paper import CLAIMS
from suchus.robots import ROBOTS
from suchus.verdict import RULES, between, judge

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
    runs = full.variations * len(ARMS) * (1 + len(JOINTS) * len(KINDS) * len(LEGS_FAILED))
    assert full.variations >= 8
    assert runs >= 400
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


def test_every_measure_of_the_issue_is_there_with_its_range(outcome):
    for cell in product(JOINTS, KINDS, LEGS_FAILED, ARMS):
        name = f"loss_{'_'.join(cell)}"
        low, middle, high = (outcome.measures[f"{name}{end}"].value for end in ("_low", "", "_high"))
        assert low <= middle <= high
        assert outcome.measures[name].unit == "-"
    for rule in EXPERIMENTS["joint_faults"].rules():
        assert rule.needs <= set(outcome.measures)
        assert rule.reason({name: measure.value for name, measure in outcome.measures.items()})
    assert outcome.verdicts == ()
    assert outcome.unjudged.startswith("Not judged")


def test_the_first_variation_is_the_gait_as_given_and_the_rest_differ(campaign, outcome):
    record = outcome.record
    for one in GAITS.beside("belly_crawl", "chosen", ()):
        values = record["gait_" + "_".join(re.findall(r"\w+", one.field))].values
        assert values[0] == value_at(CRAWL, one.field)
        assert one.low <= values[1] <= one.high
        assert values[1] != values[0]
    assert record.grip[0] == 1.0
    assert abs(record.grip[1] - 1.0) <= campaign.friction_spread


def test_both_arms_of_a_variation_have_the_same_legs(campaign):
    for gaits, _ in campaign._varied():
        ours = movement(CAIMAN, gaits["coordinated"]).foot_places(np.linspace(0, 1, 50)[:, None] + np.zeros(4))
        for arm in ("limbs_only", "limbs_tail_lifted"):
            legs = movement(CAIMAN, gaits[arm]).foot_places(np.linspace(0, 1, 50)[:, None] + np.zeros(4))
            assert np.array_equal(ours, legs)
            assert not gaits[arm].has("wave")
            assert gaits[arm].number("tail_pitch") == GAITS[arm].number("tail_pitch")


def test_the_campaign_measures_what_lone_runs_do(campaign, outcome):
    record = outcome.record.isel(variation=0)
    runs = [
        Run(robot=CAIMAN, gait=CRAWL),
        Run(robot=CAIMAN, gait=CRAWL, faults=joint_failure(CAIMAN, CRAWL, "hind_yaw", "limp", "both")),
        Run(
            robot=CAIMAN, gait=GAITS["limbs_only"], faults=joint_failure(CAIMAN, CRAWL, "front_pitch", "locked", "one")
        ),
    ]
    alone = simulate(runs, duration=1.0 + CRAWL.period, timestep=campaign.timestep)
    way = displacement(alone).sel(xyz="x").values
    assert float(record.intact_forward.sel(arm="coordinated")) == way[0]
    assert float(record.forward.sel(arm="coordinated", joint="hind_yaw", kind="limp", legs="both")) == way[1]
    assert float(record.forward.sel(arm="limbs_only", joint="front_pitch", kind="locked", legs="one")) == way[2]
    change = outcome.measures["loss_hind_yaw_limp_both_coordinated_high"].value
    assert change >= way[1] / way[0] - 1.0


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
        "Not judged: kind is locked, and the article's claims are judged with limp."
    )
    assert "legs is both" in replace(full, legs="both").unjudged()
    assert "variations is 7" in replace(full, variations=7).unjudged()
    locked = outcome.record.assign_attrs(judged_kind="locked")
    assert "loss_hind_yaw_locked_one_steered" in campaign.measure(locked)


def test_the_judged_reading_of_the_lifted_tail_is_that_of_a_lone_run(campaign, outcome):
    gait = GAITS["limbs_tail_lifted"]
    runs = [Run(robot=CAIMAN, gait=gait, faults=joint_failure(CAIMAN, gait, "hind_yaw", "limp", "one"))]
    way = displacement(simulate(runs, duration=1.0 + CRAWL.period, timestep=campaign.timestep)).sel(xyz="x")
    assert float(outcome.record.lifted_forward.sel(lost="hind_yaw")[0]) == float(way[0])


def made_up(better: int, of: int = 8) -> xr.Dataset:
    """Return a campaign in which spine and tail keep more of their own in some of the variations."""
    forward = np.full((of, 2, len(JOINTS), 2, 2), 0.5)
    forward[:better, 0] = 0.6
    forward[better:, 0] = 0.4
    forward[:, 0, len(FAILED_JOINTS) :] = 0.0  # the knees do not count
    dims = ("variation", "arm", "joint", "kind", "legs")
    coords = {
        "arm": list(ARMS),
        "joint": list(JOINTS),
        "lost": list(FAILED_JOINTS),
        "kind": list(KINDS),
        "legs": list(LEGS_FAILED),
    }
    return xr.Dataset({"forward": (dims, forward), "intact_forward": (dims[:2], np.ones((of, 2)))}, coords=coords)


@pytest.mark.parametrize(
    ("better", "chance", "word"),
    [
        (8, 1 / 256, "reproduced"),
        (7, 9 / 256, "reproduced"),
        (6, 37 / 256, "contradicted"),
        (4, 163 / 256, "contradicted"),
        (0, 1.0, "contradicted"),
    ],
)
def test_faults_are_better_borne_only_beyond_chance(better, chance, word):
    found = {name: measure.value for name, measure in tolerance(made_up(better)).items()}
    assert found["share_spine_and_tail_bear_better"] == found["share_variations_bear_better"] == better / 8
    assert found["chance_spine_and_tail_bear_better"] == pytest.approx(chance)
    assert judge(RULES["fault_tolerance"], found, {}).verdict == word


def test_variations_that_are_alike_tell_nothing():
    record = made_up(4)
    alike = record.assign(forward=0.0 * record.forward + 0.5)
    assert tolerance(alike)["chance_spine_and_tail_bear_better"].value == 1.0


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
    assert whole(record) is record
    broken = record.assign(cause=("run", ["", "a speed of 2e3 was reached"]), ended=("run", [0.5, 0.2]))
    with pytest.raises(Diverged, match=r"run 1 of 2, belly_crawl, diverged at 0\.20 s") as caught:
        whole(broken)
    assert caught.value.time == 0.2
    assert float(caught.value.record.time[-1]) == pytest.approx(0.2)


def _says(claim: str, change: float) -> bool:
    """Tell whether the sentence of a claim about a fault is true of a change of displacement."""
    rule = RULES[claim]
    return rule.held(between(rule.measure, change, change)) is True
