"""Which values a study takes."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits, SuchusError, UnknownName
from suchus.experiments.study import MEASURES, Plan, Study, Vary
from suchus.experiments.study.arm import Arm
from suchus.experiments.study.chunk import label_of
from suchus.experiments.study.plan import value_of
from suchus.robot.design import with_values
from suchus.robot.gaits import GAITS
from suchus.sim.land import Limp, Run, Weak


@pytest.fixture
def base(robot, crawl_gait):
    return Run(robot=robot, gait=crawl_gait)


def study(base, *vary, **settings):
    return Study(**{"name": "s", "run": base, "vary": vary, "measure": ("displacement",), **settings})


def column(plan, field):
    return [point.values[field] for point in plan]


def test_a_factorial_study_takes_every_combination_once(base):
    plan = Plan(
        study(
            base,
            Vary(field="gait.stroke", low=0.0, high=0.04, steps=3),
            Vary(field="ground.friction_scale", values=(0.5, 1.0)),
            seeds=2,
            seed=7,
        )
    )
    assert len(plan) == 12
    rows = [(p.values["gait.stroke"], p.values["ground.friction_scale"], p.seed) for p in plan]
    assert len(set(rows)) == 12
    assert rows[0] == (0.0, 0.5, 7)
    assert rows[1] == (0.0, 0.5, 8)
    assert rows[-1] == (0.04, 1.0, 8)
    assert {r[0] for r in rows} == {0.0, 0.02, 0.04}


@pytest.mark.parametrize("design", ["sobol", "latin"])
def test_sampled_values_fill_their_range_evenly_and_are_the_same_again(design, base):
    asked = study(
        base,
        Vary(field="gait.stroke", low=0.01, high=0.05),
        Vary(field="gait.lift", low=0.01, high=0.04),
        design=design,
        samples=64,
        seed=3,
    )
    strokes = np.array(column(Plan(asked), "gait.stroke"))
    counts, _ = np.histogram(strokes, bins=8, range=(0.01, 0.05))
    assert counts.tolist() == [8] * 8  # both designs are exactly stratified
    assert abs(np.corrcoef(strokes, column(Plan(asked), "gait.lift"))[0, 1]) < 0.3
    assert column(Plan(asked), "gait.stroke") == strokes.tolist()
    assert column(Plan(replace(asked, seed=4)), "gait.stroke") != strokes.tolist()


def test_a_sobol_study_may_have_any_number_of_samples(base):
    asked = study(base, Vary(field="gait.stroke", low=0.0, high=0.05), design="sobol", samples=50)
    longer = replace(asked, samples=60)
    assert column(Plan(longer), "gait.stroke")[:50] == column(Plan(asked), "gait.stroke")
    assert len(Plan(replace(asked, samples=1))) == 1


def test_a_logarithmic_range_has_as_much_below_its_geometric_mean_as_above(base):
    vary = Vary(field="ground.friction_scale", low=0.1, high=10.0, scale="log")
    assert value_of(vary, 0.5) == pytest.approx(1.0)
    assert (value_of(vary, 0.0), value_of(vary, 1.0)) == (0.1, 10.0)


def test_a_normal_distribution_has_its_mean_and_spread_and_stays_inside(base):
    vary = Vary(field="ground.friction_scale", mean=1.0, spread=0.2)
    values = [value_of(vary, (i + 0.5) / 2000) for i in range(2000)]
    assert np.mean(values) == pytest.approx(1.0, abs=1e-6)
    assert np.std(values) == pytest.approx(0.2, rel=0.01)
    cut = Vary(field="ground.friction_scale", mean=1.0, spread=0.2, low=0.9, high=1.3)
    values = [value_of(cut, share) for share in (0.0, 0.3, 1.0)]
    assert values[0] == pytest.approx(0.9, abs=1e-9)
    assert values[2] == pytest.approx(1.3, abs=1e-9)
    assert 0.9 < values[1] < 1.3


def test_values_taken_with_each_pair_every_sample(base):
    gaits = (GAITS["belly_crawl"], GAITS["limbs_only"])
    plan = Plan(
        study(
            base,
            Vary(field="gait.stroke", low=0.0, high=0.05),
            Vary(field="gait", values=gaits, each=True),
            design="latin",
            samples=5,
        )
    )
    assert len(plan) == 10
    strokes = column(plan, "gait.stroke")
    assert strokes[::2] == strokes[1::2]
    assert [g.name for g in column(plan, "gait")[:2]] == ["belly_crawl", "limbs_only"]


def test_arms_and_seeds_of_a_point_share_its_robot_and_no_run_depends_on_those_asked_before(base):
    varied = study(
        base,
        Vary(field="robot.spine.link", low=0.04, high=0.06),
        Vary(field="ground.friction_scale", values=(1, 1.0), each=True),
        design="sobol",
        samples=3,
        seeds=2,
        arms=(Arm(name="calm", values={}), Arm(name="shaken", values={"noise": 0.01})),
    )
    plan = Plan(varied)
    runs = [plan.run(i) for i in range(len(plan))]
    assert [repr(plan.run(i)) for i in reversed(range(len(plan)))] == [repr(run) for run in reversed(runs)]
    assert [repr(Plan(varied).run(i)) for i in range(len(plan))] == [repr(run) for run in runs]
    assert len({run.robot for run in runs}) == 3
    assert len({id(run.robot) for run in runs}) == 3 * 2  # each combination of a sample has its own
    assert [type(run.ground.friction_scale) for run in runs[:3]] == [int, int, float]


def test_a_whole_gait_and_its_fields_can_vary_together(base):
    plan = Plan(
        study(base, Vary(field="gait.stroke", values=(0.013,)), Vary(field="gait", values=(GAITS["limbs_only"],)))
    )
    run = plan.run(0)
    assert run.gait == with_values(GAITS["limbs_only"], {"stroke": 0.013})


def test_faults_vary_as_wholes_and_by_their_numbers(base):
    both = study(base, Vary(field="faults", values=((), (Limp("LF_yaw"),))))
    assert [Plan(both).run(i).faults for i in range(2)] == [(), (Limp("LF_yaw"),)]
    assert [label_of(v) for v in column(Plan(both), "faults")] == ["none", "limp LF_yaw"]
    weak = replace(base, faults=(Weak("LH_knee"),))
    parts = study(weak, Vary(field="faults[0].fraction", values=(0.1, 0.9)))
    assert Plan(parts).run(1).faults[0].fraction == 0.9


BAD = [
    ([Vary(field="gait.strok", low=0.0, high=0.1)], {}, "Did you mean 'stroke'"),
    ([Vary(field="robot.tial.mass", low=0.1, high=1.0)], {}, "Did you mean 'tail'"),
    ([Vary(field="faults[0].fraction", low=0.1, high=1.0)], {}, "field"),
    ([Vary(field="gait.period", low=0.0001, high=5.0)], {}, r"gait\.period is 0\.0001 s; 0\.001 to 3600 s"),
    ([Vary(field="robot.tail.joints", low=4.5, high=8.0)], {}, r"tail\.joints, which takes whole numbers"),
    ([Vary(field="gait.stroke", low=0.0, high=0.1)], {"measure": ("displacment",)}, "Did you mean 'displacement'"),
    ([Vary(field="gait.stroke", low=0.0, high=0.1)], {"samples": None}, "samples is missing"),
    ([Vary(field="gait.stroke", low=0.0, high=0.1)], {"design": "factorial"}, "needs values or steps"),
    ([Vary(field="gait.stroke", low=0.0, high=0.1)], {"design": "random"}, "factorial, sobol, latin"),
    ([Vary(field="gait.stroke", low=0.0, high=0.1)] * 2, {}, "twice"),
    ([Vary(field="seed", values=(1, 2))], {}, "choose seed and seeds"),
    ([Vary(field="gait.stroke", values=(0.1,))], {"seed": 2**32 - 1, "seeds": 2}, "choose a smaller seed"),
    ([], {}, "name at least one field"),
]


@pytest.mark.parametrize(("vary", "settings", "said"), BAD)
def test_what_cannot_be_is_refused_before_anything_runs(vary, settings, said, base):
    with pytest.raises((InvalidDesign, UnknownName), match=said):
        study(base, *vary, **{"design": "sobol", "samples": 4, **settings})


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({}, "either values, or low and high, or mean and spread"),
        ({"low": 0.2, "high": 0.1}, "low must be less"),
        ({"low": 0.0, "high": 0.1, "scale": "log"}, "a logarithm needs more than 0"),
        ({"low": float("nan"), "high": 0.1}, "low is nan"),
        ({"mean": 0.1}, "a spread of more than 0"),
        ({"values": (), "low": 0.1, "high": 1.0}, "either"),
        ({"values": ()}, "no values"),
        ({"low": 0.0, "high": 0.1, "each": True}, "give values or steps"),
    ],
)
def test_a_field_needs_one_sensible_set_of_values(settings, said):
    with pytest.raises(InvalidDesign, match=said):
        Vary(field="gait.stroke", **settings)


def test_measures_take_a_record_and_a_window():
    assert {"displacement", "slip", "height_std", "work", "peak_torque"} <= set(MEASURES)
    assert not {"heading", "tilt", "whole", "between", "swing_loads"} & set(MEASURES)


def test_an_impossible_combination_of_possible_values_is_that_runs_own_error(base):
    plan = Plan(
        study(
            base,
            Vary(field="robot.thorax.shoulder", values=(0.05, 0.2)),
            Vary(field="robot.head.snout", values=(0.1, 0.2125)),
        )
    )
    with pytest.raises(SuchusError, match="ahead of the shoulders"):
        [plan.run(i) for i in range(len(plan))]
    assert not isinstance(plan.run(0), OutsideLimits)


@pytest.mark.parametrize(("samples", "chunk"), [(1, 32), (32, 32), (33, 32), (100, 32), (7, 3), (5, 5), (6, 1)])
def test_batches_hold_every_run_once_in_order_and_are_as_equal_as_can_be(base, samples, chunk):
    vary = Vary(field="gait.stroke", values=tuple(0.001 * i for i in range(samples)))
    plan = Plan(study(base, vary, chunk=chunk))
    batches = [plan.chunk(number) for number in range(plan.chunks)]
    assert [run for batch in batches for run in batch] == list(range(len(plan)))
    sizes = [len(batch) for batch in batches]
    assert max(sizes) <= chunk
    assert max(sizes) - min(sizes) <= 1
    assert len(sizes) == -(-len(plan) // chunk)
