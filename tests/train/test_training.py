"""A small training from beginning to end, from the command line too, on a hexapod of a file."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.apps.cli import main
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, UnsuitedRobot
from suchus.experiments import train as training_module
from suchus.experiments.train import Training, judge, motion, network_search, train, train_seeds
from suchus.experiments.train.conduct import repeat_command
from suchus.experiments.train.evaluate import draw_episodes, episode_run
from suchus.experiments.train.table_search import EXPLORATION, TableSearch
from suchus.experiments.train.tracking import tracking_loss
from suchus.robot.blueprint import read_design
from suchus.robot.control import Learned, OpenLoop, load_policy
from suchus.robot.control.policy import robot_digest, with_training
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.policies import POLICIES
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

STRIDER = ROBOTS["strider"]
TABLE_GENERATIONS = 2 * EXPLORATION + 1
SHORT = {"table_generations": TABLE_GENERATIONS, "network_generations": 1}


@pytest.fixture(scope="module", autouse=True)
def few_networks():
    """Let a generation have four networks, the fewest of which CMA-ES learns, and compare them in two episodes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(network_search, "POPULATION", 4)
        patch.setattr(network_search, "LOOP_EPISODES", 2)
        patch.setattr(training_module.conduct, "_CHECK_EPISODES", 2)
        yield


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("training")
    return train(Training(robot=STRIDER), folder, **SHORT), folder


@pytest.fixture
def judged_before(trained, monkeypatch):
    """Let full physics judge no policy again that it has judged; another one fails."""
    result, _ = trained
    judgements = {result.table: result.table_judgement, replace(result.policy, training=()): result.judgement}
    monkeypatch.setattr(training_module.conduct, "judge", lambda robot, policy, **_: judgements[policy])


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


def test_it_goes_on_where_it_was_and_ends_with_the_same_bytes(trained, judged_before, tmp_path, monkeypatch):
    """Interrupted in its first generation, in its last one of the table and in the network; nothing is done twice."""
    result, folder = trained
    shutil.copytree(folder / "generations", tmp_path / "generations")
    parts = sorted((tmp_path / "generations" / "parts").glob("*.nc"))
    assert len(parts) == TABLE_GENERATIONS + 1
    for part in parts[-2:]:
        part.unlink()
    calls = []

    def watch(name, *, is_interrupted):
        evaluate = getattr(training_module.conduct, name)

        def evaluated(*given):
            calls.append(name)
            if is_interrupted:
                raise KeyboardInterrupt
            return evaluate(*given)

        return patch.setattr(training_module.conduct, name, evaluated)

    for interrupted in ("evaluate_table", "evaluate_policies"):
        with monkeypatch.context() as patch:
            for name in ("evaluate_table", "evaluate_policies"):
                watch(name, is_interrupted=name == interrupted)
            with pytest.raises(KeyboardInterrupt):
                train(Training(robot=STRIDER), tmp_path, **SHORT)
    assert calls == ["evaluate_table", "evaluate_table", "evaluate_policies"]
    again = train(Training(robot=STRIDER), tmp_path, **SHORT)
    assert again.path.read_bytes() == result.path.read_bytes()
    assert (tmp_path / "learning_curve.csv").read_text() == (folder / "learning_curve.csv").read_text()


def test_a_network_starts_from_the_table_of_another_policy(trained, tmp_path, monkeypatch):
    result, _ = trained
    monkeypatch.setattr(training_module.conduct, "judge", lambda *_, **__: result.judgement)  # the full physics: above
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


def test_an_episode_has_the_faults_that_are_named_and_a_policy_is_told_of_them_at_their_onset():
    settings = {"faults": ("limp",), "joints": ("RM_yaw", "LH_yaw"), "onset": (0.5, 0.75)}
    told = Training(task="fault", robot=STRIDER, **settings)
    untold = Training(task="velocity_untold", robot=STRIDER, **settings)
    policy = POLICIES["velocity_strider"]
    episodes = draw_episodes(told, policy, 12, 3)
    faults = [fault for episode in episodes for fault in episode.faults]
    assert {fault.kind() for fault in faults} == {"limp"}
    assert {fault.part for fault in faults} == {"RM_yaw", "LH_yaw"}
    assert all(START + 0.5 <= fault.at <= START + 0.76 for fault in faults)
    assert len({fault.at for fault in faults}) > 3
    run, blind_run = (episode_run(training, policy, episodes[0]) for training in (told, untold))
    assert run.control.failures == ((faults[0].at, faults[0].part),)
    assert blind_run.control.failures == ()
    assert run.faults == blind_run.faults == episodes[0].faults
    both = draw_episodes(replace(told, faults=("limp", "locked")), policy, 12, 3)
    assert {fault.kind() for episode in both for fault in episode.faults} == {"limp", "locked"}


@pytest.mark.parametrize(
    ("fields", "error", "part"),
    [
        ({"task": "velocity", "faults": ("limp",)}, InvalidDesign, "nothing fails in the task velocity: leave it out"),
        (
            {"task": "swim", "onset": (0.0, 1.0), "robot": ROBOTS["swimmer"]},
            InvalidDesign,
            "tasks fault, velocity_untold",
        ),
        ({"task": "fault", "faults": ()}, InvalidDesign, "faults is empty"),
        ({"task": "fault", "faults": ("lost_foot",)}, UnknownName, "fault of a servo"),
        ({"task": "fault", "joints": ("LF_nose",)}, UnknownName, "LF_nose"),
        ({"task": "fault", "onset": (2.0, 1.0)}, InvalidDesign, "training.onset"),
        ({"task": "fault", "onset": (0.0, 1e3)}, InvalidDesign, "increasing pair within 0"),
        ({"task": "fault", "robot": ROBOTS["swimmer"]}, UnsuitedRobot, "has none: train swim"),
    ],
)
def test_faults_that_cannot_be_trained_are_refused(fields, error, part):
    with pytest.raises(error, match=part):
        Training(**fields)


def test_a_task_with_faults_needs_a_network_and_the_command_line_says_so(capsys, tmp_path):
    words = ["train", "fault", "--network-generations", "0", "--out", str(tmp_path / "made")]
    assert main(words) == 2
    assert "the task fault trains a network" in capsys.readouterr().err
    assert main(["train", "velocity", "--joints", "LF_yaw", "--out", str(tmp_path / "made")]) == 2
    assert "training.joints is given, and nothing fails" in capsys.readouterr().err
    assert main(["train", "velocity", "--seeds", "0", "--out", str(tmp_path / "made")]) == 2
    assert "train.seeds is 0; 1 to 20 are allowed" in capsys.readouterr().err
    assert not (tmp_path / "made").exists()


def test_the_command_that_repeats_a_training_names_its_faults_and_seeds():
    training = Training(task="fault", robot=STRIDER, faults=("limp",), joints=("LF_yaw",), onset=(0.5, 1.0), seed=4)
    words = repeat_command(training, 12, 3, 2)
    for part in ("--faults limp", "--joints LF_yaw", "--onset 0.5 1", "--seed 4 --seeds 2", "--network-generations 3"):
        assert part in words


def test_seeds_share_commands_and_budget_and_the_best_is_the_policy_of_the_file(tmp_path, monkeypatch):
    asked = []
    errors = {3: 0.3, 4: 0.1, 5: 0.2}

    def conduct(training, folder, **settings):
        asked.append((training, settings))
        policy = with_training(
            POLICIES["velocity_strider"], seed=str(training.seed), error=str(errors[training.seed]), command="one",
        )  # fmt: skip
        return training_module.TrainingResult(
            policy=policy, table=policy, path=folder, judgement=None, table_judgement=None, table_generations=14,
            network_generations=0,
        )  # fmt: skip

    monkeypatch.setattr(training_module.replicates, "train", conduct)
    result = train_seeds(Training(robot=STRIDER, seed=3), tmp_path, seeds=3, minutes=9.0)
    trainings, settings = zip(*asked, strict=True)
    assert [training.seed for training in trainings] == [3, 4, 5]
    assert [training.speed for training in trainings] == [None, *[POLICIES["velocity_strider"].max_speed] * 2]
    assert [setting["table_generations"] for setting in settings] == [None, 14, 14]
    assert [setting["minutes"] for setting in settings] == [3.0, 3.0, 3.0]
    policy = load_policy(tmp_path / "velocity_strider.npz")
    assert policy == result.policy
    assert [float(dict(seed.training)["error"]) for seed in policy.seeds] == [0.1, 0.3, 0.2]
    record = dict(policy.training)
    assert record["errors of the seeds"] == "0.3 0.1 0.2"
    assert "--seed 3 --seeds 3 --table-generations 14" in record["command"]


@pytest.mark.slow("two trainings of a hexapod take more than ten seconds")
def test_a_second_seed_is_what_it_would_be_alone(trained, tmp_path):
    result, _ = trained
    both = train_seeds(Training(robot=STRIDER), tmp_path / "both", seeds=2, **SHORT)
    commands = {"speed": result.policy.max_speed, "turn": result.policy.max_turn}
    alone = train(Training(robot=STRIDER, seed=1, **commands), tmp_path / "alone", **SHORT)
    tables = {seed.table for seed in both.policy.seeds}
    assert tables == {result.policy.table, alone.policy.table}
    assert len(tables) == 2
