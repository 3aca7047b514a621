from dataclasses import replace
from math import pi

import numpy as np
import pytest
from matplotlib.figure import Figure
from tests.metres import with_metres

from suchus.article.verdict import judge
from suchus.core.errors import OutsideLimits
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.leg_kinematics.experiment import _FRAME_ANGLES as LEG_SHOWN
from suchus.experiments.catalog.spine_kinematics.experiment import _FRAME_ANGLES as SPINE_SHOWN
from suchus.experiments.experiment import Outcome
from suchus.robot.design import crocodile
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics import leg, spine
from suchus.robot.motion import suits
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import caption, save

MODULES = {name: EXPERIMENTS[name] for name in ("leg_kinematics", "spine_kinematics", "tail_bending")}


@pytest.fixture(scope="module")
def outcomes(quick_outcome) -> dict[str, Outcome]:
    return {name: quick_outcome(name) for name in MODULES}


def words_of(experiment, found: dict[str, float]) -> dict[str, str]:
    return {rule.claim: judge(rule, found, {}).verdict for rule in experiment.rules()}


def values(outcome: Outcome) -> dict[str, float]:
    return {name: measure.value for name, measure in outcome.measures.items()}


@pytest.mark.parametrize("name", MODULES)
def test_a_short_form_is_not_judged_and_every_number_is_finite(name, outcomes):
    outcome = outcomes[name]
    assert outcome.verdicts == ()
    assert outcome.unjudged.startswith("Not judged: ")
    assert outcome.decides
    assert all(np.isfinite(m.value) for m in outcome.measures.values())
    assert outcome.experiment == name


@pytest.mark.parametrize("name", MODULES)
def test_every_variable_has_a_unit(name, outcomes):
    record = outcomes[name].record
    numbers = [v for v in {**record.data_vars, **record.coords}.values() if v.dtype.kind == "f"]
    assert numbers
    assert [v.name for v in numbers if "units" not in v.attrs] == []


@pytest.mark.parametrize("name", MODULES)
def test_figures_are_drawn_with_captions(name, outcomes):
    figures = MODULES[name].draw(outcomes[name])
    assert len(figures) == 4 if name == "tail_bending" else "frames" in figures
    for figure in figures.values():
        assert isinstance(figure, Figure)
        assert len(caption(figure)) > 60


@pytest.mark.parametrize("name", MODULES)
def test_figures_are_written(name, outcomes, tmp_path):
    for stem, figure in MODULES[name].draw(outcomes[name]).items():
        for file in save(figure, tmp_path, stem):
            assert file.stat().st_size > 3000


def test_the_frames_that_are_drawn_are_those_of_the_tables(outcomes):
    drawn, back = (outcomes[name].record for name in ("leg_kinematics", "spine_kinematics"))
    for record, count in ((drawn, 5), (back, 6)):
        turned = record.frame_axis.values
        assert turned.shape == (count, 3, 3)
        np.testing.assert_allclose(turned @ np.swapaxes(turned, 1, 2), np.tile(np.eye(3), (count, 1, 1)), atol=1e-12)
        np.testing.assert_allclose(np.linalg.det(turned), 1.0)  # right-handed beside the robot too
    np.testing.assert_allclose(drawn.frame_axis[0], [[0, 1, 0], [1, 0, 0], [0, 0, -1]])  # outward, forward, down
    np.testing.assert_allclose(drawn.frame_origin[2], drawn.frame_origin[1])
    robot = ROBOTS["caiman"]
    end = spine.forward(robot.spine, np.array(SPINE_SHOWN))[:3, 3]
    np.testing.assert_allclose(back.frame_origin[-1], end, atol=1e-12)
    outward, ahead, down = leg.forward(robot.hind_leg, np.array(LEG_SHOWN[:3]))
    np.testing.assert_allclose(drawn.frame_origin[-1], [ahead, outward, -down], atol=1e-12)
    figure = MODULES["leg_kinematics"].draw(outcomes["leg_kinematics"])["frames"]
    words = {text.get_text() for text in figure.axes[0].texts}
    assert {f"${name}_{i}$" for name in "XZ" for i in range(5)} <= words
    assert {word for word in words if word.startswith("$a_")} == {"$a_0$", "$a_2$", "$a_3$"}  # a_1 is 0
    assert {word for word in words if "theta" in word} == {rf"$\theta_{i}$" for i in (1, 2, 3)}  # the foot has none


def test_the_angles_that_are_drawn_are_those_of_the_joints(outcomes):
    """The arc of each joint subtends, seen along its axis, the angle of the posture that is drawn."""
    axes = outcomes["spine_kinematics"].record.frame_axis.values
    for i, angle in enumerate(SPINE_SHOWN, start=1):
        before, x, z = axes[i - 1, 0], axes[i, 0], axes[i, 2]
        assert np.arctan2(x @ np.cross(z, before), x @ before) == pytest.approx(angle, abs=1e-12)


def test_printed_leg_inverse_holds_in_a_quarter_and_ours_everywhere(outcomes):
    found = values(outcomes["leg_kinematics"])
    assert found["printed_inverse_holds"] == pytest.approx(0.25, abs=0.03)
    assert found["printed_inverse_holds"] + found["printed_inverse_fails"] == 1
    assert found["round_trip_error"] < 1e-14
    assert found["reach_near"] == pytest.approx(0.003)
    assert found["reach_far"] == pytest.approx(0.175)
    assert found["printed_inverse_holds_outboard_below"] == 1.0
    assert found["printed_inverse_holds_elsewhere"] == 0.0
    words = words_of(MODULES["leg_kinematics"], found)
    assert set(words.values()) == {"by construction"}


def test_the_printed_leg_inverse_holds_where_the_crawl_puts_its_feet_and_not_inboard_of_the_hips(outcomes):
    assert values(outcomes["leg_kinematics"])["printed_inverse_holds_crawl"] == 1.0
    leg = MODULES["leg_kinematics"]
    inboard = replace(leg.quick(), gait=with_metres(leg.gait, hind_reach=-0.03))
    found = values(inboard.run())
    assert found["printed_inverse_holds_crawl"] == 0.5  # the front feet stay outboard
    assert words_of(leg, found)["leg_inverse"] == "contradicted"
    assert "exact 50.0% of the time" in inboard.explain(found)


def test_spine_is_292_and_a_half_millimetres_long_and_printed_a_link_less(outcomes):
    found = values(outcomes["spine_kinematics"])
    assert found["straight_length"] == pytest.approx(0.2925)
    assert found["straight_length_printed"] == pytest.approx(0.2325)
    assert 0.038 < found["printed_error_min"] < found["printed_error_max"] <= 0.060
    assert found["printed_error_mean"] == pytest.approx(0.052, abs=1e-3)
    assert found["round_trip_error"] < 1e-14
    assert found["original_angles_found"] == 1
    assert found["bending_saved_median"] > 0
    assert found["straight_jacobian_rank"] == 4
    assert found["printed_error_share"] == pytest.approx(found["printed_error_max"] / 0.2925)
    assert found["printed_error_upward_max"] < 1e-14
    assert found["mended_error_max"] < 1e-14
    words = words_of(MODULES["spine_kinematics"], found)
    assert words["spine_forward"] == "contradicted"
    assert set(words.values()) == {"contradicted", "by construction"}


def test_tail_numbers_are_those_of_the_audit(outcomes):
    found = values(outcomes["tail_bending"])
    assert found["cord_toward_90"] == pytest.approx(-0.0399278, abs=1e-7)
    assert found["cord_away_90"] == pytest.approx(0.0383879, abs=1e-7)
    assert found["slack_180"] == pytest.approx(0.0061334, abs=1e-7)
    assert found["error_of_eq_17_toward_180"] == pytest.approx(-0.0380, abs=1e-4)
    assert found["error_of_eq_17_away_180"] == pytest.approx(0.0411, abs=1e-4)
    assert np.degrees(found["bend_deficit_max"]) == pytest.approx(6.74, abs=0.01)
    assert found["printed_last_joint_error_straight"] == pytest.approx(0.226, abs=1e-3)
    assert found["printed_last_joint_error_max"] == pytest.approx(0.472, abs=1e-3)
    assert found["cords_opposed_share"] == 1.0
    words = words_of(MODULES["tail_bending"], found)
    assert (words["tail_quadratic_small"], words["tail_cords_inextensible"]) == ("reproduced", "by construction")
    assert words["tail_share"] == words["tail_joints"] == words["tail_actuators"] == "by construction"
    assert words["tail_joint_positions"] == words["tail_equal_bends"] == "contradicted"


def test_worst_plausible_tail_has_the_widest_gap_and_the_narrowest_cords(outcomes):
    ratio = 0.018 / 0.04  # of the ends of their ranges
    dropped = ratio * np.tan(pi / 24)  # of what (17) keeps, at a half turn
    error = values(outcomes["tail_bending"])["error_of_eq_17_plausible"]
    assert error == pytest.approx(1 / (1 - dropped) - 1)
    assert error > values(outcomes["tail_bending"])["error_of_eq_17_max"]


def test_joints_of_the_tail_differ_in_the_crawl_as_single_runs_told(outcomes):
    found = values(outcomes["tail_bending"])
    assert np.degrees(found["tail_joint_spread"]) == pytest.approx(20, abs=2)
    assert np.degrees(found["tail_joint_spread_straight"]) == pytest.approx(34, abs=2)
    assert 0 < found["tail_joint_spread_share"] < found["tail_joint_spread_share_straight"] < 1


def test_measures_of_a_tail_whose_joints_all_turn_alike(outcomes):
    record = outcomes["tail_bending"].record
    alike = record.assign(crawl_angle=record.crawl_angle.mean("joint").broadcast_like(record.crawl_angle))
    found = {name: m.value for name, m in MODULES["tail_bending"].measure(alike).items()}
    assert found["tail_joint_spread"] == found["tail_joint_spread_share"] == 0.0
    assert words_of(MODULES["tail_bending"], found)["tail_equal_bends"] == "reproduced"


def test_neglected_term_is_the_tangent(outcomes):
    record = outcomes["tail_bending"].record.isel(bend=slice(1, None))
    kept, exact = record.shortened, -record.toward
    np.testing.assert_allclose((exact - kept) / kept, record.neglected, rtol=1e-9)


def test_impossible_settings_are_refused():
    tail = MODULES["tail_bending"]
    for bad in (
        replace(tail, furthest=np.nan),
        replace(tail, furthest=-1.0),
        replace(tail, steps=1),
        replace(tail, cycles=0),
    ):
        with pytest.raises(OutsideLimits, match="positive angle"):
            bad.run()


def test_sweep_ends_where_the_gaps_close():
    outcome = replace(MODULES["tail_bending"], furthest=2 * pi, steps=5, cycles=1).run()
    assert float(outcome.record.bend[-1]) == values(outcome)["bend_limit_of_gaps"]


@pytest.mark.parametrize(
    ("femur", "tibia", "joints", "gap"),
    [(0.05, 0.02, 1, 0.005), (0.03, 0.2, 30, 0.01)],
)
def test_odd_robots_are_examined_too(femur, tibia, joints, gap):
    robot = ROBOTS["caiman"]
    odd = crocodile(
        replace(
            robot.tables,
            hind_leg=replace(robot.tables.hind_leg, femur=femur, tibia=tibia),
            spine=replace(robot.tables.spine, base=0.2, link=0.03),
            tail=replace(robot.tables.tail, joints=joints, gap=gap),
        )
    )
    for experiment in MODULES.values():
        quick = replace(experiment.quick(), robot=odd)
        outcome = quick.run()
        unknown = {name for name, measure in outcome.measures.items() if not np.isfinite(measure.value)}
        lame = experiment is MODULES["tail_bending"] and not suits(odd, GAITS["belly_crawl"])
        assert {name.startswith(("tail_joint_spread", "end_bend")) for name in unknown} == ({True} if lame else set())
        assert ("cannot follow the crawl" in outcome.decides) == lame
        for figure in quick.draw(outcome).values():
            figure.draw_without_rendering()


def test_shorter_sweep_is_drawn_too():
    short = replace(MODULES["tail_bending"], furthest=1.0, steps=11, cycles=1)
    outcome = short.run()
    for figure in short.draw(outcome).values():
        figure.draw_without_rendering()
    assert "slack_30" in outcome.measures
    assert "slack_90" not in outcome.measures
