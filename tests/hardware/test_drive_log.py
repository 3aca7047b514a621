"""The log of a drive is on the disk, signed, before anything is drawn; its first line and its last."""

import signal

import numpy as np
import pytest
from tests.hardware.test_drive import GAIT, Drive
from tests.wires import wiring

from suchus.apps.cli import main
from suchus.apps.report import save_outcome
from suchus.core.errors import BusFailure
from suchus.core.files import check_replaceable, load
from suchus.core.stopping import deferred_signals
from suchus.experiments.catalog._driven import Driven
from suchus.hardware import BusClock, drive, walked_distance, write_wiring
from suchus.hardware.bus import open_port
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

WORDS = ["drive", "belly_crawl", "--dry-run", "--seconds", "0.3"]


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_wiring(wiring(boards=True), tmp_path / "hardware.toml")
    return tmp_path


def test_signals_wait_until_the_block_has_ended():
    done = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        former = signal.signal(number, lambda signum, frame: done.append(signum))
        try:
            with deferred_signals():
                signal.raise_signal(number)
                assert number not in done
            assert done[-1] == number
        finally:
            signal.signal(number, former)


def test_a_signal_that_waited_acts_at_the_end():
    done = []

    def work():
        with deferred_signals():
            signal.raise_signal(signal.SIGINT)
            done.append("end")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["end"]


def test_ctrl_c_while_the_log_is_saved_waits_for_it():
    kept = []
    robot = Drive()

    def save(record):
        signal.raise_signal(signal.SIGINT)
        kept.append(record)

    with pytest.raises(KeyboardInterrupt):
        drive(robot.rig, GAIT, None, robot.settings, clock=BusClock(robot.rig), save_log=save)
    assert kept[0].sizes["time"] > 10
    assert robot.limp


class Interrupting(BusClock):
    """A clock in which a signal comes at some of its ticks."""

    def __init__(self, rig, ticks, error=KeyboardInterrupt):
        super().__init__(rig)
        self.ticks, self.error = set(ticks), error

    def wait(self, tick):
        if tick in self.ticks:
            self.ticks.discard(tick)
            raise self.error
        return super().wait(tick)


@pytest.mark.parametrize("ticks", [(20,), (45,), (20, 25)], ids=["walking", "let down", "twice"])
def test_the_log_is_saved_wherever_ctrl_c_comes(ticks):
    robot, kept = Drive(), []
    with pytest.raises(KeyboardInterrupt) as caught:
        drive(robot.rig, GAIT, None, robot.settings, clock=Interrupting(robot.rig, ticks), save_log=kept.append)
    assert kept[0].identical(caught.value.record)
    assert kept[0].sizes["time"] >= min(20, ticks[0])
    assert kept[0].cause.item() == "asked to stop: a signal."
    assert robot.limp


def test_the_log_is_saved_where_a_fault_of_a_program_ends_the_drive():
    robot, kept = Drive(), []
    clock = Interrupting(robot.rig, (20,), ZeroDivisionError)
    with pytest.raises(ZeroDivisionError):
        drive(robot.rig, GAIT, None, robot.settings, clock=clock, save_log=kept.append)
    assert kept[0].cause.item().startswith("ZeroDivisionError")
    assert robot.limp


def test_ctrl_c_while_figures_are_drawn_leaves_a_signed_log_and_the_command_runs_again(desk, monkeypatch, capsys):
    with monkeypatch.context() as patch:
        patch.setattr(Driven, "draw", lambda self, outcome: signal.raise_signal(signal.SIGINT))
        assert main(WORDS) == 130
    assert "the log: out/drive_belly_crawl/record.nc" in capsys.readouterr().out
    log = load(desk / "out/drive_belly_crawl/record.nc", require_seal=True)
    assert log.sizes["time"] > 10
    check_replaceable(desk / "out/drive_belly_crawl")
    assert main(WORDS) == 0
    assert (desk / "out/drive_belly_crawl/index.html").is_file()
    assert [path.name for path in (desk / "out").iterdir()] == ["drive_belly_crawl"]


def test_a_log_that_begins_with_the_way_to_the_first_posture_is_drawn(tmp_path):
    """Nearly every real robot stands otherwise at first, and gets there before time zero."""
    log = Drive(start=0.3).go()
    assert log.time.values[0] < -0.5
    experiment = Driven(robot=ROBOTS["caiman"], gait=GAIT, control="open", stop="sag")
    outcome = experiment.tell(log, 1.0)
    save_outcome(outcome, experiment.draw(outcome), experiment, tmp_path / "drive", command="suchus drive")
    assert (tmp_path / "drive" / "index.html").is_file()


def test_an_earlier_log_stays_until_the_new_one_has_its_page(desk, monkeypatch):
    assert main(WORDS) == 0
    former = (desk / "out/drive_belly_crawl/record.nc").read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr(Driven, "draw", lambda self, outcome: signal.raise_signal(signal.SIGINT))
        assert main(WORDS) == 130
    assert (desk / "out/drive_belly_crawl/record.nc").read_bytes() == former
    assert load(desk / "out/drive_belly_crawl_stopped1/record.nc").sizes["time"] > 10


def test_the_first_line_says_what_to_start_and_the_last_what_came_of_it(desk, capsys):
    assert main(["drive", "belly_crawl", "--clock", "bus"]) == 3
    first, error = capsys.readouterr()
    assert "start `suchus emulate caiman --hardware hardware.toml --clock bus` in another terminal" in first
    assert "start suchus emulate for this robot first" in error
    assert main(WORDS) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "dry run of caiman in belly_crawl: no port is opened."
    assert "by its legs it walked about" in lines[-1]
    assert "servos followed to" in lines[-1]
    assert "got warmest" in lines[-1]


def test_a_port_that_an_emulator_makes_is_told_from_an_adapter(tmp_path):
    with pytest.raises(BusFailure, match=r"start suchus emulate for this robot first"):
        open_port(str(tmp_path / "hardware.port"), 1_000_000)
    with pytest.raises(BusFailure, match=r"there is no port /dev/ttyUSB97; "):
        open_port("/dev/ttyUSB97", 1_000_000)


def without(record, *names):
    return record.assign({name: record[name].copy(data=np.full(record[name].shape, np.nan)) for name in names})


@pytest.mark.parametrize(
    ("robot", "gait", "tolerance"), [("caiman", "high_walk", 0.05), ("caiman", "belly_crawl", 0.3)]
)
def test_the_legs_tell_how_far_a_robot_walked(robot, gait, tolerance):
    """Of the high walk to 5 %, whose feet roll without slip; of the crawl, whose feet slip, to 30 %."""
    body = ROBOTS[robot]
    record = simulate([Run(robot=body, gait=GAITS[gait])], duration=5.0).isel(run=0)
    walk = record.sel(time=slice(0.0, None)).position.values
    distance = np.hypot(*(walk[-1] - walk[0])[:2])
    assert walked_distance(record, body) == pytest.approx(distance, rel=1e-12)
    assert walked_distance(without(record, "position", "foot_force"), body) == pytest.approx(distance, rel=tolerance)


def test_a_body_without_legs_tells_no_distance():
    body, record = ROBOTS["swimmer"], Drive().go()
    assert not body.girdles
    assert np.isfinite(walked_distance(record, ROBOTS["caiman"]))
    assert np.isnan(walked_distance(record, body))
