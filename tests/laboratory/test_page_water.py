"""Forces and added mass of the water in the page are those of the kernel in MuJoCo's step."""

import mujoco
import numpy as np
import pytest
from tests.laboratory.page_modules import needs_node, run

from suchus.apps.laboratory.description import physics_facts, piece_facts
from suchus.core import water_table as table
from suchus.robot.design import GRAVITY
from suchus.robot.design.pieces import pieces
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.immersion import wetting
from suchus.sim.land import Lake
from suchus.sim.model.wet import wet_model

pytestmark = needs_node
MODEL = (
    "body_parentid", "body_rootid", "body_dofadr", "body_dofnum", "dof_bodyid", "M_rownnz", "M_rowadr", "M_colind",
)  # fmt: skip
DATA = ("qvel", "xpos", "xmat", "subtree_com", "cvel", "cdof", "cdof_dot", "qfrc_passive", "M")


@pytest.mark.parametrize(("name", "count"), [("swimmer", 600), ("floating_caiman", 400)])
def test_a_thousand_random_states(name, count):
    robot, rng = ROBOTS[name], np.random.default_rng(0)
    wetting.install()
    dry, wet = (wet_model(robot, 0.002, None, len(pieces(robot)), acting=acting) for acting in (False, True))
    dry_gravity, wet_gravity = dry.opt.gravity.copy(), wet.opt.gravity.copy()
    states, expected = [], []
    data, wet_data = mujoco.MjData(dry), mujoco.MjData(wet)
    try:
        for _ in range(count):
            up = rng.normal(size=3) * [0.3, 0.2, 0.0] + [0.0, 0.0, 1.0]
            up /= np.linalg.norm(up)
            dry.opt.gravity[:] = wet.opt.gravity[:] = -GRAVITY * up
            level = rng.uniform(-0.1, 0.3)
            qpos = rng.uniform(-0.8, 0.8, dry.nq)
            qpos[:3], qpos[3:7] = rng.normal(size=3) * [1.0, 1.0, 0.15], rng.normal(size=4)
            qpos[3:7] /= np.linalg.norm(qpos[3:7])
            data.qpos[:] = wet_data.qpos[:] = qpos
            data.qvel[:] = wet_data.qvel[:] = rng.normal(size=dry.nv) * rng.choice([0.01, 1.0, 10.0])
            wet_data.userdata[:] = Lake(level=level).numbers(up)
            for model, of_model in ((dry, data), (wet, wet_data)):
                mujoco.mj_fwdPosition(model, of_model)
                mujoco.mj_fwdVelocity(model, of_model)
            states.append(
                {name: getattr(data, name).ravel().tolist() for name in DATA} | {"up": up.tolist(), "level": level}
            )
            expected.append(
                (wet_data.userdata[table.SUBMERGED_VOLUME], wet_data.qfrc_passive.copy(), wet_data.M.copy())
            )
    finally:
        dry.opt.gravity[:], wet.opt.gravity[:] = dry_gravity, wet_gravity
    water = physics_facts(robot, default_gait(robot), swims=True)["water"]
    found = run(
        "water",
        pieces=[piece | {"body": dry.body(piece["body"]).id} for piece in piece_facts(robot)],
        water=water | {"length": robot.length, "gravity": GRAVITY},
        model={name: getattr(dry, name).tolist() for name in MODEL},
        states=states,
    )
    volumes = np.array([volume for volume, _, _ in expected])
    assert 0.2 < np.mean(volumes > 0.0) < 1.0  # wet and dry
    for state, (volume, passive, mass) in zip(found, expected, strict=True):
        assert state["volume"] == pytest.approx(volume, abs=1e-15)
        scale = np.maximum(np.abs(passive), 1.0)
        assert np.max(np.abs(np.array(state["passive"]) - passive) / scale) < 1e-9
        assert np.max(np.abs(np.array(state["mass"]) - mass)) < 1e-9
