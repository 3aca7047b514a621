"""``suchus capture`` with a table of joint angles."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from suchus.animals.capture import is_angle_table, read_angles
from suchus.apps.cli.capture import capture
from suchus.core.errors import UnknownName, UnsuitedRobot
from suchus.core.files import load
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait

TABLE = Path(__file__).parent.parent / "data" / "animals" / "salamander_walking.csv"


def test_a_published_table_becomes_the_gait_of_the_shelf(tmp_path, capsys):
    out = tmp_path / "walk.toml"
    assert capture([str(TABLE), "--robot", "salamander", "--period", "2", "--out", str(out)]) == 0
    assert blueprint.read_design(out, Gait, GAITS) == replace(GAITS["animal_walk"], name="walk", period=2.0)
    assert "24 servos of salamander" in capsys.readouterr().out


def test_a_robot_without_those_joints_is_refused_and_nothing_is_written(tmp_path):
    with pytest.raises(UnknownName, match="joint of robot 'strider'"):
        capture([str(TABLE), "--robot", "strider", "--out", str(tmp_path / "walk.toml")])
    assert not list(tmp_path.iterdir())


def test_a_table_of_angles_is_measured_too(tmp_path, capsys):
    assert capture([str(TABLE), "--tables", str(tmp_path / "out")]) == 0
    data = load(tmp_path / "out" / "measured.nc")
    cycle = read_angles(TABLE)
    assert list(data.joint.values) == list(cycle.joints)
    np.testing.assert_allclose(data.angle.values[3], cycle.at(data.phase.values)[:, 3])
    peak = data.amplitude.values * np.cos(2 * np.pi * (data.phase.values[:, None] - data.phase_of_peak.values))
    first = np.fft.fft(data.angle.values, axis=1)[:, 1]
    np.testing.assert_allclose(np.fft.fft(peak, axis=0)[1], first, atol=1e-9)
    assert [one.name for one in tmp_path.iterdir() if not one.name.startswith(".")] == ["out"]


def test_tables_of_keypoints_are_told_from_tables_of_angles(tmp_path):
    tracks = tmp_path / "tracks.csv"
    tracks.write_text("time [s],hip_x [mm],hip_y [mm]\n0,0,0\n")
    assert is_angle_table(TABLE)
    assert not is_angle_table(tracks)
    assert not is_angle_table(tmp_path / "none.csv")
    with pytest.raises(UnsuitedRobot, match="a gait from tracked keypoints needs four limbs"):
        capture([str(tracks), "--robot", "strider", "--out", str(tmp_path / "walk.toml")])
