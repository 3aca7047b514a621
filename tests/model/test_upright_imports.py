"""The axis that points up in another tool's file is found and turned to z, or the file is refused by the option."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hinge_trees import pendulum, skewed
from scipy.spatial.transform import Rotation

from suchus.core.errors import UnreadableFile
from suchus.robot.motion import draft_gait
from suchus.sim.model import compile_model, joint_addresses
from suchus.sim.model.importing import Words, import_robot

FILES = Path(__file__).parent.parent / "data" / "imports"
UPRIGHT = (FILES / "walker.urdf").read_text()
PLACES = 1e-9  # m
TURNS = {
    "y": np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), "-y": np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "x": np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]), "-x": np.array([[0, 0, -1], [-1, 0, 0], [0, 1, 0]]),
}  # fmt: skip
"""From the upright robot to a file in which another axis points up."""


def read(text, tmp_path, **words):
    file = tmp_path / "it.xml"
    file.write_text(text)
    return import_robot(file, name="it", words=Words(**words))


def told(draft):
    return " ".join(draft.remarks)


def turned(matrix):
    """Return the walker as MJCF without gravity, its root turned: the same drawing in other axes."""
    model = mujoco.MjSpec.from_string(UPRIGHT)
    model.compiler.fusestatic = False
    quaternion = Rotation.from_matrix(matrix).as_quat(scalar_first=True)
    text = model.to_xml() if model.compile() else ""
    text = re.sub(r"<option[^>]*/>", "", text)
    text = text.replace("<worldbody>", f'<worldbody><frame quat="{" ".join(map(repr, quaternion.tolist()))}">', 1)
    return text.replace("</worldbody>", "</frame></worldbody>", 1)


def same_body(one, two):
    assert [match.file_hinge for match in one.matches] == [match.file_hinge for match in two.matches]
    here, there = compile_model(one.robot), compile_model(two.robot)
    for model in (here, there):
        data = mujoco.MjData(model)
        data.qpos[joint_addresses(model, [match.hinge for match in one.matches])] = 0.3
        mujoco.mj_kinematics(model, data)
        yield data


def test_the_walker_with_y_up_is_turned_upright_with_all_hinges_and_the_front_along_x(tmp_path):
    draft = import_robot(FILES / "walker_y_up.urdf", name="it")
    assert len(draft.matches) == 12
    assert "up is the file's y axis" in told(draft)
    assert "along the file's x axis" in told(draft)
    one, two = same_body(draft, import_robot(FILES / "walker.urdf", name="it"))
    np.testing.assert_allclose(one.xanchor, two.xanchor, atol=PLACES)
    np.testing.assert_allclose(one.xipos, two.xipos, atol=1e-8)


@pytest.mark.parametrize("up", TURNS)
def test_any_axis_that_points_up_gives_the_same_robot(up, tmp_path):
    draft = read(turned(TURNS[up]), tmp_path)
    assert f"up is the file's {up} axis" in told(draft)
    one, two = same_body(draft, read(turned(np.eye(3)), tmp_path))
    np.testing.assert_allclose(one.xanchor, two.xanchor, atol=PLACES)
    np.testing.assert_allclose(one.xipos, two.xipos, atol=1e-8)
    assert draft_gait(draft.robot, "walk").period > 0


def test_a_file_with_z_up_is_not_turned(tmp_path):
    for text in (UPRIGHT, skewed(), pendulum()):
        assert "Up:" not in told(read(text, tmp_path))
        assert "up is" not in told(read(text, tmp_path))


def test_gravity_says_which_axis_is_up(tmp_path):
    lying = re.sub(r"(?<=<mujoco>)", '<option gravity="0 -9.81 0"/>', pendulum_mjcf("0 1 0"))
    draft = read(lying, tmp_path)
    assert "against its gravity" in told(draft)
    assert [hinge.turn for hinge in draft.robot.axis_hinges] == ["yaw", "yaw"]
    swimmer = read(lying.replace("0 -9.81 0", "0 0 0"), tmp_path)
    assert [hinge.turn for hinge in swimmer.robot.axis_hinges] == ["pitch", "pitch"]
    slope = read(lying.replace("0 -9.81 0", "3 0 -9"), tmp_path)
    assert [hinge.turn for hinge in slope.robot.axis_hinges] == ["pitch", "pitch"]
    with pytest.raises(UnreadableFile, match="along none of its axes"):
        read(lying.replace("0 -9.81 0", "7 0 -7"), tmp_path)
    for bad in ("0 -9.81", "a b c", "0 nan 0"):
        with pytest.raises(UnreadableFile, match="three finite numbers are needed"):
            read(lying.replace("0 -9.81 0", bad), tmp_path)


def pendulum_mjcf(axis):
    """Return an MJCF of three rods behind each other along x."""
    rod = '<geom type="capsule" size="0.01" fromto="0 0 0 -0.1 0 0"/>'
    return (
        f'<mujoco><worldbody><body name="head"><freejoint/>{rod}'
        f'<body name="b" pos="-0.1 0 0"><joint name="h1" axis="{axis}" range="-40 40"/>{rod}'
        f'<body name="c" pos="-0.1 0 0"><joint name="h2" axis="{axis}" range="-40 40"/>{rod}'
        "</body></body></body></worldbody></mujoco>"
    )


def test_a_chain_that_stands_is_refused_by_the_option_and_read_with_it(tmp_path):
    standing = pendulum_mjcf("0 1 0").replace("-0.1 0 0", "0 0 -0.1")
    with pytest.raises(UnreadableFile, match="--up x or --up y"):
        read(standing, tmp_path)
    assert [hinge.turn for hinge in read(standing, tmp_path, up="y").robot.axis_hinges] == ["yaw", "yaw"]
    assert [hinge.turn for hinge in read(standing, tmp_path, up="x").robot.axis_hinges] == ["pitch", "pitch"]
    with pytest.raises(UnreadableFile, match="is no axis"):
        read(standing, tmp_path, up="w")


def test_the_option_decides_over_the_feet(tmp_path):
    with pytest.raises(UnreadableFile, match="--up where another axis"):
        read((FILES / "walker_y_up.urdf").read_text(), tmp_path, up="z")
