"""Every experiment runs on every robot of the shelf, or says in a sentence what the robot lacks."""

from dataclasses import fields, replace
from math import isfinite, sqrt

import numpy as np
import pytest
from tests.bodies import eel, eight, hatchling, six

from body_files import giant
from suchus.apps.cli.entry import main
from suchus.apps.cli.options import choose
from suchus.apps.cli.run import gait_sentence
from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot import blueprint
from suchus.robot.design import NEEDS, lacking, layout
from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.gaits import DRAFTED, GAITS, conditions_of, default_gait, suits
from suchus.robot.robots import ROBOTS

WALKERS = ("caiman", "long_tail", "pleurobot", "salamander", "salamandra", "strider")
LEAST = {
    "crawl_stability": {"cycles": 1, "repeats": 1},
    "displacement": {
        "cycles": 1,
        "repeats": 1,
        "phases": (0.0,),
        "strokes": (0.5, 1.0),
        "bends": (0.5, 1.0),
    },
    "feedback": {"starts": 1, "cycles": 1, "hold": 0.1, "after": 1},
    "gait_diagram": {"cycles": 2},
    "joint_faults": {"cycles": 1, "repeats": 1, "holds": (0.5,)},
    "joint_loops": {"integrals": (0.0, 20.0), "cycles": 1},
    "speed_range": {"slower": (1.0,), "cycles": 1},
    "terrain": {"bumps": (), "steps": (), "transitions": 1, "seeds": 1, "walked": 1.0, "surfaces": ("even",)},
    "turning": {"bends": (0.0, 0.2), "asymmetries": (0.0, 0.5), "mixtures": (0.0, 1.0), "asked": (1.0,), "cycles": 1},
}
"""The least with which the experiments on walkers answer at all."""


def robot_of(name):
    return six() if name == "six" else ROBOTS[name]


def shortest(name, robot):
    experiment = replace(EXPERIMENTS[name].quick(), **LEAST[name]).for_robot(robot)
    return replace(experiment, timestep=coarse_step(robot)) if hasattr(experiment, "timestep") else experiment


@pytest.mark.parametrize("name", list(EXPERIMENTS))
@pytest.mark.parametrize("robot", [*ROBOTS, "six"])
def test_a_robot_without_what_is_needed_is_refused_in_a_sentence(name, robot):
    experiment, body = EXPERIMENTS[name].quick(), robot_of(robot)
    missing = lacking(body, experiment.needs)
    if not missing:
        assert experiment.for_robot(body).robot == body
        return
    with pytest.raises(UnsuitedRobot) as refused:
        experiment.for_robot(body)
    text = str(refused.value)
    assert text.startswith(f"{name} needs ")
    assert repr(body.name) in text
    assert all(NEEDS[need].text in text for need in missing)
    assert text.count(". ") == 0


def test_what_runs_on_all_walkers_needs_nothing_that_one_of_them_lacks():
    free = [name for name in LEAST if name not in ("terrain",)]
    for name in free:
        assert [robot for robot in (*WALKERS, "six") if lacking(robot_of(robot), EXPERIMENTS[name].needs)] == [], name
    assert lacking(ROBOTS["salamandra"], EXPERIMENTS["terrain"].needs) == ["foot_paths"]


@pytest.mark.parametrize("name", ["gait_diagram", "speed_range"])
@pytest.mark.parametrize(
    "robot",
    [
        "pleurobot",
        "salamandra",
        "salamander",
        "strider",
        "six",
    ],
)
def test_it_runs_and_is_not_judged(name, robot):
    answers(name, robot)


@pytest.mark.parametrize(
    ("name", "robot"),
    [("displacement", "strider"), ("crawl_stability", "salamandra"), ("turning", "pleurobot"), ("joint_loops", "six")],
)
def test_one_that_takes_longer_runs_on_one_other_body(name, robot):
    answers(name, robot)


@pytest.mark.validate
@pytest.mark.parametrize("name", list(LEAST))
@pytest.mark.parametrize("robot", ["long_tail", "pleurobot", "salamander", "salamandra", "strider", "six"])
def test_every_one_runs_on_every_walker(name, robot):
    if not lacking(robot_of(robot), EXPERIMENTS[name].needs):
        answers(name, robot)


def answers(name, robot):
    """Run an experiment in its shortest form; look at everything that a user gets."""
    body = robot_of(robot)
    experiment = shortest(name, body)
    outcome = experiment.run()
    assert outcome.verdicts == ()
    if experiment.rules():
        assert outcome.unjudged.startswith("Not judged: ")
    assert sum(isfinite(measure.value) for measure in outcome.measures.values()) > 3
    assert len(outcome.decides) > 60
    assert "nan" not in outcome.decides.split()
    assert experiment.draw(outcome)
    for replay in outcome.replays.values():
        assert "<canvas" in replay.html
    missing = [key for key, values in outcome.record.data_vars.items() if "units" not in values.attrs]
    assert missing == []


@pytest.mark.parametrize("robot", [*ROBOTS, "six"])
def test_every_robot_has_one_gait_of_its_own_that_it_can_follow(robot):
    body = robot_of(robot)
    gait = default_gait(body)
    assert suits(body, gait)
    made = [name for name in GAITS if robot in GAITS.beside(name, "made_for", ())]
    assert made == ([gait.name] if robot != "six" else [])


@pytest.mark.parametrize("body", [eight(), eel()], ids=lambda body: body.name)
def test_a_robot_that_no_gait_of_the_shelf_suits_gets_one_drafted_and_that_is_said(body, tmp_path, capsys):
    assert not any(suits(body, gait) for gait in GAITS.values())
    gait = default_gait(body)
    assert (gait.name, suits(body, gait)) == (DRAFTED, True)
    assert gait is default_gait(body)
    blueprint.write(body, tmp_path / "body.toml")
    words = ["run", "gait_diagram", "--quick", "--cycles", "2", "--out", str(tmp_path / "out")]
    if not lacking(body, EXPERIMENTS["gait_diagram"].needs):
        assert main([*words, "--robot", str(tmp_path / "body.toml")]) == 0
        assert f"No gait in the catalog suits {body.name}: it moves in one that was drafted" in capsys.readouterr().out


def test_of_a_robot_that_a_gait_of_the_shelf_suits_none_is_said_to_be_drafted(tmp_path, capsys):
    assert main(["run", "gait_diagram", "--quick", "--cycles", "2", "--out", str(tmp_path / "out")]) == 0
    assert "drafted" not in capsys.readouterr().out


def test_which_gaits_another_robot_moves_in_is_said_with_their_period_in_its_size():
    asked = EXPERIMENTS["gait_diagram"]
    assert gait_sentence(asked) == gait_sentence(asked.for_robot(ROBOTS["caiman"])) == []
    assert gait_sentence(asked.for_robot(ROBOTS["strider"])) == ["strider moves in the gait tripod."]
    (told,) = gait_sentence(asked.for_robot(hatchling()))
    assert told == "hatchling moves in the gait belly_crawl (a cycle in 2.18 s; 4 s in the catalog)."
    (told,) = gait_sentence(EXPERIMENTS["turning"].for_robot(hatchling()))
    assert told.startswith("hatchling moves in the gaits ")
    assert " and " in told
    assert (
        gait_sentence(EXPERIMENTS["leg_kinematics"])
        == gait_sentence(EXPERIMENTS["floating"].for_robot(hatchling()))
        == []
    )


def test_a_robot_that_floats_goes_ashore_itself_under_the_pattern_generator():
    asked = EXPERIMENTS["pattern_generator"]
    floats = asked.for_robot(ROBOTS["pleurobot"])
    longer = ROBOTS["pleurobot"].length / asked.swimmer.length
    assert (floats.swimmer, floats.swimmer_gait) == (ROBOTS["pleurobot"], default_gait(ROBOTS["pleurobot"]))
    assert floats.water_line == pytest.approx(longer * asked.water_line)
    assert floats.shore_time == pytest.approx(sqrt(longer) * asked.shore_time)
    sinks = asked.for_robot(ROBOTS["strider"])
    assert (sinks.swimmer, sinks.swimmer_gait) == (asked.swimmer, asked.swimmer_gait)
    assert (sinks.water_line, sinks.shore_time) == (asked.water_line, asked.shore_time)
    assert asked.for_robot(ROBOTS["salamander"]) == asked


def test_a_turn_is_measured_over_cycles_that_are_no_whole_number_of_samples():
    """The path is taken at the samples nearest to the ends of the cycles, so that one cycle is enough."""
    body = eight()
    assert default_gait(body).period % control_period(body) > 1e-4
    record = shortest("turning", body).simulate().record
    for name in ("curvature_bend", "curvature_asymmetry", "curvature_mixture"):
        assert np.isfinite(record[name]).all(), name


def test_a_robot_that_no_gait_suits_is_refused_in_a_sentence():
    body = ROBOTS["strider"]
    limb = body.girdles[0].limb
    short = replace(limb, links=tuple(replace(link, end=tuple(0.55 * x for x in link.end)) for link in limb.links))
    stiff = tuple(
        replace(link, hinges=tuple(replace(hinge, range=(-0.05, 0.05)) for hinge in link.hinges))
        for link in short.links
    )
    girdles = tuple(replace(girdle, limb=replace(short, links=stiff)) for girdle in body.girdles)
    with pytest.raises(UnsuitedRobot, match="no gait in the catalog suits robot 'stiff', which has LF, RF, LM"):
        default_gait(replace(body, name="stiff", girdles=girdles))


@pytest.mark.parametrize(
    ("robot", "names"),
    [
        ("caiman", ["coordinated", "limbs_only", "limbs_tail_lifted", "tail_still", "spine_only", "tail_drag"]),
        ("salamander", ["coordinated", "limbs_only", "tail_still", "tail_drag"]),
        ("strider", ["coordinated", "limbs_only"]),
    ],
)
def test_the_conditions_are_those_that_the_bodys_parts_make_possible(robot, names):
    body = ROBOTS[robot]
    own = default_gait(body)
    assert list(conditions_of(body, own, own.without("axis", name="limbs_only"))) == names


def test_on_the_command_line_the_robot_brings_its_gait_and_size():
    chosen = choose(EXPERIMENTS["displacement"], "displacement", ["--robot", "salamander"]).experiment
    assert (chosen.robot.name, chosen.gait.name) == ("salamander", "salamander_walk")
    assert chosen.control_group == chosen.gait.without("axis", name="limbs_only")
    other = choose(EXPERIMENTS["turning"], "turning", ["--robot=strider", "--cycles", "2"]).experiment
    assert other.cycles == 2
    assert other.asked[0] == pytest.approx(0.6 * ROBOTS["strider"].length / ROBOTS["caiman"].length)
    assert other.timestep == coarse_step(ROBOTS["strider"])


def test_a_gait_that_was_asked_for_is_not_replaced():
    words = ["--robot", "strider", "--gait", "belly_crawl", "--quick"]
    wrong = choose(EXPERIMENTS["gait_diagram"], "gait_diagram", words).experiment
    assert wrong.gait == GAITS["belly_crawl"]
    with pytest.raises(OutsideLimits, match="choose a gait made for it"):
        wrong.run()
    asked = EXPERIMENTS["displacement"].quick()
    with pytest.raises(OutsideLimits, match="gait 'belly_crawl' has phases for 4 limbs; robot 'strider' has 6"):
        replace(asked, robot=ROBOTS["strider"]).run()  # by its own name, not as the control group made of it


@pytest.mark.parametrize("name", list(EXPERIMENTS))
def test_time_steps_divide_the_control_period_of_a_robot_of_another_size(name):
    """In the full form and in the quick one; lengths and times go with the size where no gait is walked too."""
    small = hatchling()
    for question in (EXPERIMENTS[name], EXPERIMENTS[name].quick()):
        if not hasattr(question, "robot") or lacking(small, question.needs):
            return
        sized = question.for_robot(small)
        for field in (field.name for field in fields(sized) if "timestep" in field.name):
            steps = control_period(small) / np.atleast_1d(getattr(sized, field))
            assert steps == pytest.approx(np.round(steps), abs=1e-9), field
        if name in ("death_roll", "swim_sweep"):
            faster = sqrt(question.robot.length / small.length)
            assert sized.frequencies == pytest.approx([faster * f for f in question.frequencies])


def test_a_robot_that_can_follow_the_gait_changes_nothing_else():
    here = EXPERIMENTS["terrain"].quick()
    assert here.for_robot(six()) == replace(here, robot=six())


def test_the_six_joint_crocodile_crawls_with_spine_and_tail_of_its_own():
    body = six()
    place = layout(body)
    assert len(place.trunk_yaw) == 3
    assert len(place.tail_yaw) == body.tail.joints
    assert place.cables == ()
    measures = shortest("gait_diagram", body).run().measures
    assert measures["spine_gain"].value == pytest.approx(1.0, abs=0.1)
    assert measures["tail_gain"].value == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("body", [hatchling, giant], ids=["0.3 m", "3 m"])
@pytest.mark.parametrize("name", list(EXPERIMENTS))
def test_every_question_can_be_asked_of_a_body_of_another_size(name, body):
    """Bounds of fields that grow with the body grow too: time steps, torques, lengths."""
    for question in (EXPERIMENTS[name], EXPERIMENTS[name].quick()):
        if not lacking(body(), question.needs):
            asked = question.for_robot(body())
            assert getattr(asked, "robot", None) in (None, body())


def test_a_time_step_is_at_most_the_control_period_of_the_robot():
    for name in ("joint_faults", "turning", "floating"):
        asked = EXPERIMENTS[name].quick().for_robot(giant())
        assert replace(asked, timestep=control_period(giant())).timestep == 0.02
        with pytest.raises(InvalidDesign, match=rf"{name}.timestep is 0.04 s; 1e-05 to 0.02 s is allowed"):
            replace(asked, timestep=0.04)
        with pytest.raises(InvalidDesign, match=rf"{name}.timestep is 0.02 s; 1e-05 to 0.01 s is allowed"):
            replace(EXPERIMENTS[name].quick(), timestep=0.02)
