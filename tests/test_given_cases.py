"""Inputs of other people that were read wrong: each case of ``../shared/cases`` gives the right value or refusal.

The inputs are in ``tests/data``. Where the cases lie beside the checkout, each folder must have a test here.
"""

import copy
import json
import pickle
import shlex
import time
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from tests.wires import emulated

import suchus.apps.envs  # noqa: F401  registers the environments
from evidence.league.command import main as league
from suchus import flow
from suchus.animals.capture import ReadingOptions, observe, read_tracks
from suchus.animals.capture.table import read_table
from suchus.apps.cli import main
from suchus.core.errors import UnreadableFile
from suchus.hardware.bus import Instruction, Packet
from suchus.robot import blueprint
from suchus.robot.design import Robot, layout
from suchus.robot.robots import ROBOTS
from suchus.sim.model.importing import import_robot

DATA = Path(__file__).parent / "data"
SHARED = Path(__file__).parents[2] / "shared" / "cases"
COPIES = {  # of the inputs that are not written by a test
    "fins_as_limbs/fish.xml": "imports/minnow.xml",
    "gap_dlc/gaps.csv": "animals/gaps.csv",
    "gap_dlc/whole.csv": "animals/whole.csv",
    "gear_ignored/eel_motor_gear8.xml": "imports/eel_motor_gear8.xml",
    "min_keypoints/needed_points.csv": "animals/needed_points.csv",
    "min_keypoints/snout_first.csv": "animals/snout_first.csv",
    "package_renamed/ws/walker_description-main/meshes/trunk.stl": (
        "imports/ws_walker/walker_description-main/meshes/trunk.stl"
    ),
    "package_renamed/ws/walker_description-main/package.xml": "imports/ws_walker/walker_description-main/package.xml",
    "package_renamed/ws/walker_description-main/urdf/walker.urdf": (
        "imports/ws_walker/walker_description-main/urdf/walker.urdf"
    ),
    "reading/deep_robot.toml": "reading/deep_robot.toml",
    "reading/list.json": "reading/list.json",
    "reading/name_escape.toml": "reading/name_escape.toml",
    "sideways_quadruped/walker.urdf": "imports/walker.urdf",
    "sleap_csv/analysis.csv": "animals/analysis.csv",
    "two_hinge_legs/fourleg.xml": "imports/fourleg.xml",
    "unique_bodyparts/two_and_corner.csv": "animals/two_and_corner.csv",
    "y_up_quadruped/walker.urdf": "imports/walker_y_up.urdf",
    "zero_effort/zero_limits.urdf": "imports/zero_limits.urdf",
}


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def imported(name):
    return import_robot(DATA / "imports" / name, name="it")


def film(name, individual=None):
    return observe(read_tracks(DATA / "animals" / name, ReadingOptions(rate=50.0, individual=individual)))


def refused(words, capsys, command=main):
    """Return the one sentence with which a command refuses its words."""
    assert command(words) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "Traceback" not in err
    return err


def case_bus_bulk(desk, capsys):
    emulator, bus = emulated("dynamixel")
    blocks = b"".join(bytes([number, address, 0, size, 0]) for number, address, size in ((1, 132, 4), (2, 126, 2)))
    answers = emulator.hear(0, bus.protocol.request(Packet(254, Instruction.BULK_READ, blocks)))
    assert len(answers) == 2


def case_bus_offset(desk, capsys):
    emulator, bus = emulated("dynamixel")
    table = emulator.servos[0].table
    before = bus.read(1, table["present_position"])
    bus.write(1, table["homing_offset"], 300)
    assert bus.read(1, table["present_position"]) == before + 300
    bus.write(1, table["operating_mode"], 4)
    bus.write(1, table["goal_position"], 5000)
    assert bus.read(1, table["goal_position"]) == 5000


def case_env_deepcopy(desk, capsys):
    env = gymnasium.make("suchus/Crawl-v0").unwrapped
    env.reset(seed=1)
    copies = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    step = env.step(0 * env.action_space.sample())
    for other in copies:
        np.testing.assert_array_equal(other.step(0 * env.action_space.sample())[0], step[0])


def case_fins_as_limbs(desk, capsys):
    draft = imported("minnow.xml")
    assert not draft.robot.girdles
    assert [match.file_hinge for match in draft.matches] == ["tail"]
    assert any("fin_left and fin_right are fins" in remark for remark in draft.remarks)


def case_free_fall_one_step(desk, capsys):
    """A cylinder twice as dense as the water falls by t^2/6 without drag; friction takes a part of it."""
    grid = flow.Grid.covering((-2.0, 2.0), (-3.0, 2.0), cell=1 / 12)
    body = flow.FreeBody(shape=flow.Cylinder(diameter=1.0), density=2.0, gravity=(0.0, -1.0))
    run = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-4, bodies=(body,), coarse=True))
    run.run(1.0, progress=False)
    assert 0.85 < run.pose("body").position[1] / (-1.0 / 6) < 1.0


def case_gap_dlc(desk, capsys):
    for name in ("whole.csv", "gaps.csv"):
        assert film(name).value("period") == pytest.approx(1.6, abs=0.01)


def case_gear_ignored(desk, capsys):
    hinges = [hinge for segment in imported("eel_motor_gear8.xml").robot.axis for hinge in segment.hinges]
    assert [hinge.drive.torque for hinge in hinges] == pytest.approx([8.0] * len(hinges))


def case_min_keypoints(desk, capsys):
    walk = film("needed_points.csv")
    assert not walk.wrong
    for quantity, value in (("period", 1.6), ("stride", 0.9), ("duty_LF", 0.7), ("trunk_length", 0.12)):
        assert walk.value(quantity) == pytest.approx(value, rel=0.02)
    assert film("snout_first.csv").value("stride") == pytest.approx(0.9, abs=0.01)


def case_package_renamed(desk, capsys):
    folder = DATA / "imports" / "ws_walker"
    file = folder / "walker_description-main" / "urdf" / "walker.urdf"
    for packages in (folder, folder / "walker_description-main"):
        assert main(["import", str(file), "--packages", str(packages), "--out", "it.toml"]) == 0
        robot = blueprint.read_design("it.toml", Robot, ROBOTS)
        assert robot.axis[0].shapes[0].half == pytest.approx((0.17, 0.06, 0.025), abs=1e-6)
        Path("it.toml").unlink()
        Path("it_walk.toml").unlink()
        capsys.readouterr()


def case_reading(desk, capsys):
    deep, named = DATA / "reading" / "deep_robot.toml", DATA / "reading" / "name_escape.toml"
    for words in (
        ["run", "displacement", "--quick", "--robot", str(deep)],
        ["export", "--home", str(deep)],
        ["study", str(deep)],
        ["optimise", str(deep)],
        ["export-commands", "belly_crawl", "--map", str(deep)],
        ["drive", "--hardware", str(deep)],
    ):
        assert "levels deep" in refused(words, capsys)
    for words in (["export", "--robot", str(named), "--out", "out"], ["parts", str(named), "--out", "out"]):
        text = refused(words, capsys)
        assert "\x1b" not in text
        assert "steers a terminal" in text
    assert not list(desk.iterdir())
    file = DATA / "reading" / "list.json"
    assert "list.json" in refused(["amphibot", "--out", "league", "--measured", str(file)], capsys, league)
    assert not list(desk.iterdir())
    columns = ",".join(f"k{i}_x [px],k{i}_y [px]" for i in range(50_000))
    Path("wide.csv").write_text(f"time [s],{columns}\n{','.join(['1'] * 100_001)}\n")
    begin = time.process_time()
    with pytest.raises(UnreadableFile, match="100001 columns"):
        read_table(Path("wide.csv"), names={}, confidence=0.5, y_down=None)
    assert time.process_time() - begin < 1.0


def case_sideways_quadruped(desk, capsys):
    draft = imported("walker.urdf")
    assert draft.robot.length == pytest.approx(0.34)
    limb = draft.robot.girdles[0].limb
    assert [hinge.turn for link in limb.links for hinge in link.hinges] == ["yaw", "pitch", "pitch"]
    names = {match.file_hinge: match.hinge for match in draft.matches}
    assert all(hinge[:2] in ("LF", "RF") for name, hinge in names.items() if "front" in name)


def case_sleap_csv(desk, capsys):
    assert film("analysis.csv").value("period") == pytest.approx(1.6, abs=0.01)


def case_two_hinge_legs(desk, capsys):
    assert main(["import", str(DATA / "imports" / "fourleg.xml"), "--out", "it.toml"]) == 0
    line = capsys.readouterr().out.strip().splitlines()[-1]
    assert main([*shlex.split(line.removeprefix("run it: suchus ")), "--quick", "--out", "out"]) == 0
    (outcome,) = Path("out").rglob("outcome.json")
    assert json.loads(outcome.read_text())["measures"]


def case_unique_bodyparts(desk, capsys):
    walk = film("two_and_corner.csv", "a")
    assert (walk.value("period"), walk.value("stride")) == pytest.approx((1.6, 0.9), abs=0.015)


def case_y_up_quadruped(desk, capsys):
    draft, upright = imported("walker_y_up.urdf"), imported("walker.urdf")
    assert len(draft.matches) == 12
    assert [match.hinge for match in draft.matches] == [match.hinge for match in upright.matches]
    assert {match.file_hinge: match.hinge for match in draft.matches} == {
        match.file_hinge: match.hinge for match in upright.matches
    }
    assert (draft.robot.mass, draft.robot.length) == pytest.approx((upright.robot.mass, upright.robot.length))
    assert any("up is the file's y axis" in remark for remark in draft.remarks)


def case_zero_effort(desk, capsys):
    draft = imported("zero_limits.urdf")
    (remark,) = [remark for remark in draft.remarks if "not filled in" in remark]
    assert "lower and upper, effort, velocity of all 12 joints" in remark
    assert all(hinge.range[0] < hinge.range[1] for hinge in draft.robot.girdles[0].limb.hinges)
    assert len(layout(draft.robot).servos) == 12


CASES = {name.removeprefix("case_"): test for name, test in list(globals().items()) if name.startswith("case_")}


@pytest.mark.parametrize("case", CASES)
def test_the_right_value_or_the_true_refusal(case, desk, capsys):
    CASES[case](desk, capsys)


def test_every_case_has_a_test_and_its_inputs_are_as_given():
    if not SHARED.is_dir():
        pytest.skip("the cases do not lie beside this checkout")
    assert {path.name for path in SHARED.iterdir() if path.is_dir()} <= CASES.keys()
    for given, ours in COPIES.items():
        assert (SHARED / given).read_bytes() == (DATA / ours).read_bytes(), given
