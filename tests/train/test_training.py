"""A small training from beginning to end, from the command line too, on a hexapod of a file."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.apps.cli import main
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, UnsuitedRobot
from suchus.experiments import train as training_module
from suchus.experiments.train import Training, judge, motion, train
from suchus.experiments.train.conduct import repeat_command
from suchus.experiments.train.table_search import EXPLORATION, TableSearch
from suchus.experiments.train.tracking import tracking_loss
from suchus.robot.blueprint import read_design
from suchus.robot.control import Learned, OpenLoop, load_policy
from suchus.robot.control.policy import robot_digest
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

STRIDER = ROBOTS["strider"]
SHORT = {"table_generations": 2 * EXPLORATION + 1, "network_generations": 1}


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("training")
    return train(Training(robot=STRIDER), folder, **SHORT), folder


def test_what_is_trained_walks_and_turns(trained):
    result, _ = trained
    policy = load_policy(result.path)
    assert policy == result.policy
    assert policy.robot_digest == robot_digest(STRIDER)
    assert policy.max_speed > 0.2
    assert policy.max_turn > 0.3
    assert result.table_judgement.falls == 0
    assert result.table_judgement.speed_error < 0.3
    assert result.table_judgement.turn_error < 0.3
    record = dict(policy.training)
    assert record["command"] == repeat_command(Training(robot=STRIDER), 11, 1)
    assert float(record["error"]) == pytest.approx(result.judgement.error, rel=1e-3)


def test_it_goes_on_where_it_was_and_ends_with_the_same_bytes(trained, tmp_path, monkeypatch):
    result, _ = trained
    calls = []
    evaluate = training_module.conduct.evaluate_table

    def interrupted(training, candidates):
        if len(calls) == 4:
            raise KeyboardInterrupt
        calls.append(len(candidates))
        return evaluate(training, candidates)

    monkeypatch.setattr(training_module.conduct, "evaluate_table", interrupted)
    with pytest.raises(KeyboardInterrupt):
        train(Training(robot=STRIDER), tmp_path, **SHORT)
    monkeypatch.setattr(training_module.conduct, "evaluate_table", evaluate)
    again = train(Training(robot=STRIDER), tmp_path, **SHORT)
    assert again.path.read_bytes() == result.path.read_bytes()
    assert (tmp_path / "learning_curve.csv").read_text().splitlines()[0] == "stage,generation,loss"


def test_a_network_starts_from_the_table_of_another_policy(trained, tmp_path):
    result, _ = trained
    training = Training(task="fault", robot=STRIDER, start=result.policy)
    told = train(training, tmp_path, network_generations=1)
    assert told.policy.table == result.policy.table
    assert told.table_generations == 0
    assert told.policy.task == "fault"
    assert "failure" in training.readings
    assert "tracking_error" in training.readings


@pytest.mark.slow("a training of a file and an experiment by the command line take more than ten seconds")
def test_a_hexapod_of_a_file_is_trained_and_walks_in_an_experiment(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "six_legs.toml"
    file.write_text('base = "strider"\nname = "six_legs"\n')
    words = ["train", "velocity", "--robot", "six_legs.toml", "--minutes", "9", "--table-generations", "11"]
    assert main([*words, "--network-generations", "0", "--out", "made"]) == 0
    said = capsys.readouterr().out
    assert "see it: suchus view six_legs.toml --policy made/velocity_six_legs.npz" in said
    policy = load_policy(tmp_path / "made" / "velocity_six_legs.npz")
    assert policy.robot == "six_legs"
    options = ["--robot", "six_legs.toml", "--control", "made/velocity_six_legs.npz", "--quick"]
    assert main(["run", "displacement", *options]) == 0
    assert "Too short to answer" in capsys.readouterr().out
    assert "forward_policy" in (tmp_path / "out" / "displacement" / "outcome.json").read_text()
    assert read_design(file, Robot, ROBOTS).name == "six_legs"
    assert main(["run", "displacement", "--control", "made/velocity_six_legs.npz", "--quick"]) == 2
    assert "was trained for robot 'six_legs' with 6 limbs; robot 'caiman' has 4" in capsys.readouterr().err


def test_what_cannot_be_trained_is_refused():
    with pytest.raises(UnknownName, match="velocity"):
        Training(task="velocty")
    with pytest.raises(UnsuitedRobot, match="has none: train swim"):
        Training(robot=ROBOTS["swimmer"])
    with pytest.raises(InvalidDesign, match=r"heavier"):
        Training(task="swim", robot=ROBOTS["caiman"])
    with pytest.raises(OutsideLimits, match="measured curves"):
        Training(robot=ROBOTS["salamander"], gait=GAITS["animal_walk"])
    with pytest.raises(InvalidDesign, match=r"minutes is 0 min"):
        train(Training(), "nowhere", minutes=0.0)
    with pytest.raises(InvalidDesign, match="table_generations is 3"):
        train(Training(), "nowhere", table_generations=3)


def test_the_bounds_follow_the_body():
    axis = Training(robot=STRIDER).bounds
    still = Training(robot=STRIDER, axis=False).bounds
    assert set(axis) - set(still) == {"bend", "wave", "lag"} | ({"tail"} & set(axis))
    swim = Training(task="swim", robot=ROBOTS["swimmer"]).bounds
    assert "stroke" not in swim
    assert "wave" in swim


def test_motion_is_that_of_the_record():
    """A walk straight ahead: the speed is displacement over time, the turning rate that of the heading."""
    run = Run(robot=STRIDER, gait=GAITS["tripod"], control=OpenLoop())
    record = simulate([run], duration=START + 2.0, timestep=0.005, sample_stride=5)
    moved = motion(record, START, START + 2.0)
    com = record.centre_of_mass.isel(run=0).sel(xyz=["x", "y"]).sel(time=[START, START + 2.0], method="nearest").values
    assert moved.speed[0] == pytest.approx(np.hypot(*(com[1] - com[0])) / 2.0, rel=0.02)
    assert not moved.has_fallen[0]
    turned = record.copy(deep=True)
    angle = 0.7
    quarter = np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    w, x, y, z = record.orientation.transpose(..., "wxyz").values[0].T
    a, _, _, d = quarter
    turned["orientation"] = xr.DataArray(
        np.stack([a * w - d * z, a * x - d * y, a * y + d * x, a * z + d * w], axis=-1)[None],
        dims=("run", "time", "wxyz"), coords=record.orientation.coords,
    )  # fmt: skip
    position = record.centre_of_mass.transpose("run", "time", "xyz").values
    matrix = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    turned["centre_of_mass"] = record.centre_of_mass.transpose("run", "time", "xyz").copy(data=position @ matrix.T)
    other = motion(turned, START, START + 2.0)
    assert other.speed == pytest.approx(moved.speed, rel=1e-6)
    assert other.turn == pytest.approx(moved.turn, abs=1e-9)


def test_a_loss_of_nothing_and_of_a_fall():
    moved = training_module.TrackedMotion(np.array([0.1, 0.0]), np.array([0.2, 0.0]), np.array([False, True]))
    assert tracking_loss(moved, 0.1, 0.2, 0.1, 0.2).tolist() == [0.0, 3.0]
    assert tracking_loss(moved, 0.0, 0.0, 0.1, 0.2)[0] == pytest.approx(2.0)


def test_the_same_seed_asks_the_same_again_and_another_asks_something_else():
    def asked(seed):
        return TableSearch(Training(robot=STRIDER, seed=seed)).ask()

    assert np.array_equal(asked(1), asked(1))
    assert not np.array_equal(asked(1), asked(2))


def test_a_policy_follows_its_commands_better_than_standing_still(trained):
    result, _ = trained
    still = replace(result.table, table=tuple(tuple((0.0, *row[1:]) for row in rows) for rows in result.table.table))
    assert judge(STRIDER, still, timestep=0.005).error > 2 * result.table_judgement.error
    assert Learned(policy=result.policy).speed_course == 0.5 * result.policy.max_speed
