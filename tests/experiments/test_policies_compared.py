"""The experiment ``policies``: errors of a made record, gaits by hand, robots without a policy, policies told."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.bodies import six

from suchus.apps.cli.options import choose
from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.policies.experiment import Calibration, Case, comparison
from suchus.experiments.experiment import Outcome
from suchus.robot.control import Coordinated, Learned, Walking
from suchus.robot.control.policy import AXIS_ACTIONS, Replicate
from suchus.robot.motion import START
from suchus.robot.policies import POLICIES, save_policy
from suchus.robot.robots import ROBOTS

QUESTION = EXPERIMENTS["policies"]
CALIBRATION = Calibration(speed=0.2, turn_per_asymmetry=0.4, max_rate=2.0)


def made_record(robots=6):
    """Return a record of two arms, two commands and a heavier robot, with errors that are known."""
    cases = [("undisturbed", 0.2, 0.0), ("undisturbed", 0.1, 0.5), ("heavier", 0.2, 0.0)]
    commands = np.array([[speed, turn] for _, speed, turn in cases])
    spread = 0.002 * np.arange(robots)
    speed = np.stack([commands[:, :1] + 0.01 + spread, commands[:, :1] - 0.05 - spread])
    turn = np.stack([commands[:, 1:] + 0.0 * spread, commands[:, 1:] - 0.1 + 0.0 * spread])
    fallen = np.zeros(speed.shape)
    fallen[1, 1, 0] = 1.0
    dims = ("arm", "case", "robot")
    return xr.Dataset(
        {"speed": (dims, speed), "turn": (dims, turn), "fallen": (dims, fallen), "cost": (dims, 1.0 + speed)},
        coords={
            "arm": ["policy", "open_loop"],
            "condition": ("case", [case[0] for case in cases]),
            "commanded_speed": ("case", commands[:, 0]),
            "commanded_turn": ("case", commands[:, 1]),
        },
        attrs={"max_speed": 0.25, "max_turn": 0.5, "goal": 0.2},
    )


def test_errors_falls_and_intervals_of_a_made_record():
    values = {name: measure.value for name, measure in QUESTION.measure(made_record()).items()}
    median = 0.002 * 2.5
    assert values["speed_error_policy"] == pytest.approx((0.01 + median) / 0.25)
    assert values["speed_error_policy_low"] == pytest.approx(0.01 / 0.25)
    assert values["speed_error_policy_high"] == pytest.approx(0.02 / 0.25)
    assert values["turn_error_policy"] == 0.0
    assert values["turn_error_open_loop"] == pytest.approx(0.2)
    assert values["tracking_error_open_loop"] == pytest.approx(0.5 * ((0.05 + median) / 0.25 + 0.2))
    assert values["error_excess_open_loop"] == pytest.approx(0.5 * (0.04 / 0.25 + 0.2))
    assert values["error_excess_heavier_open_loop_low"] == pytest.approx(0.5 * (0.04 / 0.25 + 0.2))
    assert (values["within_policy"], values["within_open_loop"]) == (1.0, 0.0)
    assert values["fallen_policy"] == values["fallen_heavier_open_loop"] == 0.0
    assert values["fallen_open_loop"] == pytest.approx(1 / 6)
    assert values["cost_policy"] == pytest.approx(1.21 + median)


def test_fewer_than_six_robots_decide_nothing():
    values = {name: measure.value for name, measure in QUESTION.measure(made_record(5)).items()}
    assert np.isnan(values["error_excess_open_loop_low"])
    assert comparison(values, "error_excess_open_loop") == "open"


@pytest.mark.parametrize(("low", "high", "word"), [(0.01, 0.2, "better"), (-0.2, -0.01, "worse"), (-0.1, 0.1, "open")])
def test_an_interval_on_one_side_of_zero_decides(low, high, word):
    assert comparison({"x": 0.0, "x_low": low, "x_high": high}, "x") == word


def test_the_words_follow_the_numbers():
    question = replace(
        QUESTION, arms=("policy", "open_loop"), speeds=(2 / 3,), disturbances=("heavier",), faults=(), turns=(0.0, 1.0)
    )
    record = made_record()
    words = explained(question, record)
    assert "better than the gait by hand" in words
    assert "error is smaller undisturbed and with more mass" in words
    assert "17% with the gait by hand under some command" in words
    swapped = record.isel(arm=[1, 0]).assign_coords(arm=["policy", "open_loop"])
    words = explained(question, swapped)
    assert "worse than the gait by hand" in words
    assert "error is larger undisturbed and with more mass" in words


def test_commands_that_half_of_the_robots_do_not_follow_are_named():
    question = replace(
        QUESTION, arms=("policy", "open_loop"), speeds=(0.4, 0.8), turns=(0.0, 1.0), test_speed=0.8, faults=(),
        disturbances=(),
    )  # fmt: skip
    cases = question.cases()
    commands = np.array([[case.speed, case.turn] for case in cases])
    speed = np.repeat(commands[None, :, :1], 6, axis=2) + np.zeros((2, 1, 1))
    turn = np.repeat(commands[None, :, 1:], 6, axis=2) + np.zeros((2, 1, 1))
    turn[0, 1, :4] -= 0.25 * question.judged_policy.max_turn
    turn[0, 3, :2] -= 0.25 * question.judged_policy.max_turn
    dims = ("arm", "case", "robot")
    record = xr.Dataset(
        {"speed": (dims, speed), "turn": (dims, turn), "fallen": (dims, 0.0 * speed), "cost": (dims, 1.0 + speed)},
        coords={
            "arm": ["policy", "open_loop"],
            "condition": ("case", [case.condition for case in cases]),
            "commanded_speed": ("case", commands[:, 0]),
            "commanded_turn": ("case", commands[:, 1]),
        },
        attrs={"max_speed": 0.25, "max_turn": question.judged_policy.max_turn, "goal": 0.2},
    )
    values = {name: measure.value for name, measure in question.measure(record).items()}
    assert question.missed_commands(values) == [cases[1]]
    assert "The policy does not follow 0.10 m/s with +0.30 rad/s." in explained(question, record)


def explained(question, record):
    return question.explain({name: measure.value for name, measure in question.measure(record).items()})


def test_the_gait_by_hand_gets_frequency_and_strokes_in_proportion():
    gait, control = QUESTION._control("open_loop", Case("undisturbed", 0.1, 0.05), CALIBRATION)
    assert gait.period == pytest.approx(2.0 * QUESTION.judged_policy.gait.period)
    assert isinstance(control, Walking)
    assert control.asymmetry == pytest.approx(0.05 / (0.4 * 0.5))
    gait, control = QUESTION._control("open_loop", Case("undisturbed", 9.0, -9.0), CALIBRATION)
    assert gait.period == pytest.approx(QUESTION.judged_policy.gait.period / 2.0)
    assert control.asymmetry == -0.5
    assert isinstance(QUESTION._control("feedback", Case("undisturbed", 0.1, 0.3), CALIBRATION)[1], Coordinated)


def test_all_controls_get_the_same_robots():
    case = Case("heavier", 0.1, 0.0)
    runs = [QUESTION._run(*QUESTION._control(arm, case, CALIBRATION), "heavier", 7) for arm in QUESTION.arm_names()]
    assert len(runs) == len(QUESTION.arm_names()) > 4
    assert len({run.robot for run in runs}) == len({run.zero_error for run in runs}) == 1
    gait, control = QUESTION._control("policy", case, CALIBRATION)
    light = QUESTION._run(gait, control, "undisturbed", 7)
    assert runs[0].robot.mass == pytest.approx(1.1 * light.robot.mass)
    assert QUESTION._run(gait, control, "slippery", None).ground.friction_scale == 0.5


def test_a_policy_that_reads_failures_walks_told_and_untold():
    reading = replace(
        POLICIES["velocity_untold"],
        readings=("command", "failure"),
        layers=(),
        actions=(),
        spans=(),
        replicates=(),
    )
    question = replace(QUESTION, fault_policy=reading, arms=("policy", "fault_policy", "untold_policy", "feedback"))
    assert question.arm_names() == ("policy", "fault_policy", "fault_policy_told", "untold_policy", "feedback")
    case = Case("limp_LF_yaw", 0.1, 0.0)
    told, untold = (question._control(f"fault_policy{end}", case, CALIBRATION)[1] for end in ("_told", ""))
    assert told == Learned(policy=reading, forward=0.1, failures=((START, "LF_yaw"),))
    assert untold == Learned(policy=reading, forward=0.1)
    assert question._control("untold_policy", case, CALIBRATION)[1].policy.task == "velocity_untold"
    assert replace(question, untold_policy=reading).arm_names() == (
        "policy",
        "fault_policy",
        "fault_policy_told",
        "feedback",
    )


def test_each_robot_gets_its_own_policy_or_a_sentence(tmp_path):
    assert QUESTION.for_robot(ROBOTS["strider"]).judged_policy == POLICIES["velocity_strider"]
    swimmer = QUESTION.for_robot(ROBOTS["swimmer"])
    assert swimmer.judged_policy == POLICIES["swim_swimmer"]
    assert "slippery" not in {case.condition for case in swimmer.cases()}
    assert swimmer.arm_names() == ("policy", "open_loop")
    with pytest.raises(UnsuitedRobot, match="suchus train velocity --robot"):
        QUESTION.quick().for_robot(six()).run()
    path = save_policy(POLICIES["velocity_untold"], tmp_path / "mine.npz")
    chosen = choose(QUESTION, "policies", ["--policy", str(path)])
    assert chosen.experiment.judged_policy == POLICIES["velocity_untold"]
    assert choose(QUESTION, "policies", ["--control", "velocity"]).experiment.policy == POLICIES["velocity"]


@pytest.mark.parametrize(
    ("fields", "part"),
    [
        ({"arms": ("open_loop",)}, "'policy' is needed"),
        ({"disturbances": ("rain",)}, "there is heavier"),
        ({"joints": ("LF_nose",)}, "there is LF_yaw"),
        ({"robots": 0}, "robots"),
    ],
)
def test_settings_that_make_no_sense_are_refused(fields, part):
    with pytest.raises(InvalidDesign, match=part):
        replace(QUESTION, **fields)


def test_it_swims_too():
    outcome = QUESTION.quick().for_robot(ROBOTS["swimmer"]).run()
    assert isinstance(outcome, Outcome)
    assert outcome.measures["fallen_policy"].value == 0.0
    assert outcome.measures["speed_error_policy"].value < outcome.measures["speed_error_open_loop"].value + 0.5


def still_policy(policy=POLICIES["velocity"], **fields):
    """Return a policy whose spine and tail are held straight, with the rest of the table of another."""
    kept = [i for i, name in enumerate(policy.parameters) if name not in AXIS_ACTIONS]
    table = tuple(tuple(tuple(values[i] for i in kept) for values in row) for row in policy.table)
    names = tuple(policy.parameters[i] for i in kept)
    return replace(
        policy,
        name="straight",
        gait=policy.gait.without("axis"),
        parameters=names,
        table=table,
        replicates=(),
        **fields,
    )


def with_seeds(policy, count):
    """Return a policy with further seeds, whose tables differ in the first number alone."""

    def table(seed):
        first = policy.table[0][0]
        return (((first[0] + 0.001 * seed, *first[1:]), *policy.table[0][1:]), *policy.table[1:])

    replicates = tuple(
        Replicate(seed=seed, speeds=policy.speeds, turns=policy.turns, table=table(seed)) for seed in range(1, count)
    )
    return replace(policy, layers=(), actions=(), spans=(), readings=(), replicates=replicates)


def test_a_still_axis_is_told_from_one_that_bends():
    policy = POLICIES["velocity"]
    assert policy.bends_axis
    assert not still_policy().bends_axis
    assert replace(policy, gait=policy.gait.without("axis")).bends_axis
    assert replace(still_policy(), gait=policy.gait).bends_axis
    with pytest.raises(
        InvalidDesign, match="still_policy may bend spine and tail; a policy of suchus train --still-axis"
    ):
        replace(QUESTION, still_policy=policy)


def test_seeds_take_turns_and_a_still_axis_walks_undisturbed_beside_the_other():
    question = replace(QUESTION, policy=with_seeds(POLICIES["velocity"], 3), still_policy=with_seeds(still_policy(), 3))
    assert "still_axis" in question.arm_names()
    case = Case("undisturbed", 0.1, 0.0)
    for robot in range(6):
        for arm in ("policy", "still_axis"):
            policies = question.policy.seeds if arm == "policy" else question.still_policy.seeds
            gait, control = question._control(arm, case, CALIBRATION, robot)
            assert control.policy == policies[robot % 3]
            assert gait == policies[0].gait
    assert "still_axis" not in replace(question, policy=question.still_policy, still_policy=None).arm_names()


def axis_words(excess, cost, robots=6, **fields):
    """Return the explanation where a policy with a still axis has more error and cost than one that bends."""
    policy = with_seeds(POLICIES["velocity"], 3)
    question = replace(
        QUESTION, policy=policy, still_policy=with_seeds(still_policy(**fields), 3), arms=("policy", "still_axis"),
        speeds=(2 / 3,), turns=(0.0,), disturbances=(), faults=(), robots=robots,
    )  # fmt: skip
    spread = 0.0001 * np.arange(robots)
    speed = np.array([[0.19 + spread], [0.19 - 0.25 * 2 * excess + spread]])
    dims, shape = ("arm", "case", "robot"), (2, 1, robots)
    record = xr.Dataset(
        {
            "speed": (dims, speed.reshape(shape)), "turn": (dims, np.zeros(shape)), "fallen": (dims, np.zeros(shape)),
            "cost": (dims, np.stack([np.ones((1, robots)), np.ones((1, robots)) + cost])),
        },
        coords={
            "arm": ["policy", "still_axis"], "condition": ("case", ["undisturbed"]),
            "commanded_speed": ("case", [0.2]), "commanded_turn": ("case", [0.0]),
        },
        attrs={"max_speed": 0.25, "max_turn": 0.5, "goal": 0.2},
    )  # fmt: skip
    return explained(question, record)


def test_the_sentence_on_spine_and_tail_follows_the_numbers():
    words = axis_words(0.1, 0.2)
    assert "may bend spine and tail follows its commands better than one that may not" in words
    assert "+10.0% (+10.0% to +10.0%)" in words
    assert "over 6 pairs of a robot and one of 3 seeds; straight ahead it pays less" in words
    assert "not trained alike" not in words
    words = axis_words(-0.01, -0.2)
    assert "follows its commands worse than one that may not" in words
    assert "it pays more" in words
    assert "which fewer than six robots do not decide" in axis_words(0.1, 0.2, robots=5)
    assert "were not trained alike: they differ in table generations" in axis_words(
        0.1, 0.2, training=(("table generations", "99"),)
    )


def test_the_catalog_says_which_policy_may_not_bend(tmp_path, monkeypatch):
    assert QUESTION.quick().straight_policy is None or not QUESTION.straight_policy.bends_axis
    assert QUESTION.for_robot(ROBOTS["swimmer"]).straight_policy is None
    path = save_policy(still_policy(), tmp_path / "still.npz")
    chosen = choose(QUESTION, "policies", ["--still-policy", str(path)])
    assert chosen.experiment.straight_policy.gait == still_policy().gait
