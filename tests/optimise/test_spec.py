"""What cannot be searched is refused before anything runs, in a sentence."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.apps.cli import main
from suchus.core.errors import SuchusError
from suchus.experiments.optimise import AIMS, LIMITS, READY, Aim, Limit
from suchus.experiments.optimise.evaluate import evaluate
from suchus.experiments.study import Arm, Vary
from suchus.robot.control import Runs
from suchus.robot.design import value_at
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import FAILED_JOINTS, Limp, Run, failing_joints, simulate
from suchus.sim.metrics import displacement

STROKE = Vary(field="gait.stroke", low=0.0, high=0.75)
BAD = [
    ({"vary": (Vary(field="gait.strok", low=0.0, high=0.1),)}, "Did you mean 'stroke'"),
    ({"vary": (Vary(field="gait.stroke", low=0.05, high=0.1),)}, r"0\.171429, outside its range of 0\.05 to 0\.1"),
    ({"vary": (Vary(field="gait.stroke", low=0.0, high=90.0),)}, r"stroke is 90"),
    ({"vary": (Vary(field="gait.stroke", values=(0.0, 0.1)),)}, "needs low and high"),
    ({"vary": (Vary(field="gait", low=0.0, high=0.1),)}, "no number"),
    ({"vary": (STROKE, STROKE)}, "twice"),
    ({"vary": ()}, "name at least one field"),
    ({"aims": ()}, "name at least one aim"),
    ({"pareto": True}, "a front needs two"),
    ({"population": 2}, "4 to"),
    ({"friction_scales": (50.0,)}, r"0\.01 to 10"),
    ({"arms": (Arm(name="a"), Arm(name="a"))}, "each once"),
    ({"arms": (Arm(name="a", values={"gait.strok": 0.1}),)}, "Did you mean 'stroke'"),
    ({"arms": (Arm(name="a", values={"gait.stroke": 0.1, "gait.trunk_bend": 0.0}),)}, "sets every field"),
]


@pytest.mark.parametrize(("change", "said"), BAD)
def test_what_cannot_be_searched_is_a_sentence(change, said, small):
    with pytest.raises(SuchusError, match=said):
        replace(small, **change)


def test_names_of_aims_limits_and_arms_are_checked():
    with pytest.raises(SuchusError, match="Did you mean 'displacement'"):
        Aim(name="displacment")
    with pytest.raises(SuchusError, match="Did you mean 'slip'"):
        Limit(name="slipp", value=1.0)
    with pytest.raises(SuchusError, match="letters, digits"):
        Arm(name="a/b")


def test_shares_and_values_are_the_same_thing(small):
    assert small.candidate({v.field: s for v, s in zip(small.vary, small.start, strict=True)}) == small.run
    log = replace(small, vary=(Vary(field="ground.friction_scale", low=0.1, high=10.0, scale="log"),))
    assert log.start == pytest.approx([0.5])
    assert log.candidate({"ground.friction_scale": 0.25}).ground.friction_scale == pytest.approx(10**-0.5)


def test_what_an_arm_sets_does_not_vary_in_it(small):
    arm = Arm(name="straight", values={"gait.trunk_bend": 0.0})
    alone = small.for_arm(arm)
    assert [v.field for v in alone.vary] == ["gait.stroke"]
    assert value_at(alone.run, "gait.trunk_bend") == 0.0
    assert alone.arms == (Arm(name="straight"),)
    assert alone.for_arm(alone.arms[0]) == alone


@pytest.mark.parametrize("name", READY)
def test_ready_made_searches_can_be_and_start_within_their_ranges(name):
    spec = READY[name]()
    assert spec.name == name
    assert all(0.0 <= share <= 1.0 for share in spec.start)
    assert READY[name].__doc__


def test_the_crawls_arms_have_the_same_legs_ranges_and_budget():
    spec = READY["crawl"]()
    free, bare = (spec.for_arm(arm) for arm in spec.arms)
    legs = [v for v in free.vary if v in bare.vary]
    assert legs == list(bare.vary)
    assert len(legs) == 8
    assert (free.evaluations, free.population, free.limits) == (bare.evaluations, bare.population, bare.limits)
    assert value_at(bare.run, "gait.trunk_bend") == value_at(bare.run, "gait.tail_bend") == 0.0
    assert value_at(free.run, "gait.period") == 4.0


def test_every_quantity_says_what_it_is():
    for kind in (*AIMS.values(), *LIMITS.values()):
        assert kind.tells
        assert kind.unit


PAGE = """
name = "mine"
population = 4
evaluations = 4
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.5
[[aims]]
name = "displacement"
"""
WRONG = {
    ("gait.stroke", "gait.stroek"): "Did you mean 'stroke'?",
    ("displacement", "displacment"): "displacement",
    ("high = 0.5", "high = 0.01"): "outside its range",
    ("population = 4", "poplation = 4"): "population",
    ("population = 4", 'task = "fly"'): "crawl",
    ('name = "mine"', 'name = "a/b"'): "say --out DIR",
    ("[[aims]]", "[[aims]"): "is not valid TOML",
}


@pytest.mark.parametrize("change", WRONG)
def test_a_bad_file_is_one_sentence_and_leaves_nothing(change, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(PAGE.replace(*change, 1))
    assert main(["optimise", "mine.toml"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert WRONG[change] in err
    assert [p.name for p in tmp_path.iterdir()] == ["mine.toml"]


def test_a_search_that_is_not_there_is_one_sentence(capsys):
    assert main(["optimise", "crwal"]) == 2
    assert "Did you mean 'crawl'?" in capsys.readouterr().err


@pytest.mark.parametrize("name", list(READY))
def test_what_a_ready_made_search_begins_with_can_be_steered(name):
    """Before a candidate is simulated its control plans a single tick."""
    spec = READY[name]()
    for arm in spec.arms:
        run = spec.for_arm(arm).run
        run.control.start(Runs.identical(run.control, run.robot, run.gait), control_period(run.robot))


def test_the_search_of_a_fault_has_a_condition_for_each_joint_that_the_article_breaks_and_for_none():
    spec = READY["fault"]()
    joints = [joint for joint in failing_joints(ROBOTS["caiman"]) if joint in FAILED_JOINTS]
    assert [arm.name for arm in spec.arms] == [
        f"{joint}_{group}" for joint in ("intact", *joints) for group in ("coordinated", "limbs_only")
    ]
    intact, others = spec.arms[:2], spec.arms[2:]
    for arm, group in zip(intact, READY["crawl"]().arms, strict=True):
        assert spec.for_arm(arm).run.faults == ()
        assert spec.for_arm(arm).run.gait == READY["crawl"]().for_arm(group).run.gait
    for arm in others:
        run = spec.for_arm(arm).run
        (fault,) = run.faults
        assert isinstance(fault, Limp)
        assert fault.part == {"front": "LF_", "hind": "LH_"}[arm.name.partition("_")[0]] + arm.name.split("_")[1]
        group = next(each for each in READY["crawl"]().arms if arm.name.endswith(each.name))
        assert run.gait == READY["crawl"]().for_arm(group).run.gait
    other = READY["fault"](ROBOTS["strider"])
    assert other.name == "fault_strider"
    assert all(other.for_arm(arm).run.faults for arm in other.arms[2:])


def test_the_first_candidate_of_a_fault_is_the_robot_that_is_not_told():
    spec = replace(READY["fault"](), duration=3.0)
    arm = next(arm for arm in spec.arms if arm.name == "front_pitch_coordinated")
    alone = spec.for_arm(arm)
    start = evaluate(alone, np.array([alone.start]))
    run = Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"], faults=(Limp("LF_pitch"),))
    record = simulate([run], duration=3.0, timestep=spec.timestep, sample_stride=2)
    told = float(displacement(record).sel(xyz="x").item())
    assert float(start["aim_displacement"][0]) == pytest.approx(told, rel=1e-3, abs=1e-4)
    intact = simulate([replace(run, faults=())], duration=3.0, timestep=spec.timestep, sample_stride=2)
    assert told < 0.9 * float(displacement(intact).sel(xyz="x").item())
