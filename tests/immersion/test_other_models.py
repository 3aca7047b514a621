"""Models with the structure of what others publish go into waves, in at most ten lines."""

import json
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.spatial import ConvexHull

import suchus
from suchus.core.errors import InvalidDesign

TEN_LINES = """
import mujoco, suchus
from suchus.sim.immersion import Wave

model = suchus.wet(source, waves=Wave(height=0.1, length=2.0)).compile()
data = mujoco.MjData(model)
heights, shares = [], []
while data.time < 20.0:
    mujoco.mj_step(model, data, 5)
    heights.append(data.body("torso").xpos[2])
    shares.append(1000.0 * suchus.water_loads(model, data).volume.sum() / model.body_mass.sum())
"""

LEGS = {"front_left": (0.3, 0.2), "front_right": (0.3, -0.2), "back_left": (-0.3, 0.2), "back_right": (-0.3, -0.2)}
LEG = """
<body name="hip_{name}" pos="{x} {y} -0.05" euler="0 0 {yaw}" childclass="leg">
  <joint name="yaw_{name}" class="yaw"/><joint name="lift_{name}" class="lift"/>
  <geom name="thigh_{name}" fromto="0 0 0 0.25 0 0.1"/><site name="hip_{name}" class="marker"/>
  <body name="shin_{name}" pos="0.25 0 0.1">
    <joint name="extend_{name}" class="extend"/><geom name="shin_{name}" fromto="0 0 0 0.1 0 -0.32"/>
    <body name="foot_{name}" pos="0.1 0 -0.32">
      <joint name="ankle_{name}" class="ankle"/><geom name="toe_{name}" class="toe"/>
      <site name="toe_{name}" class="toe"/>
    </body>
  </body>
</body>"""
PARTS = """
<mujocoinclude>
  <asset>
    <texture name="grid" type="2d" builtin="checker" rgb1="0.1 0.2 0.3" rgb2="0.2 0.3 0.4" width="32" height="32"/>
    <material name="grid" texture="grid"/><material name="self" rgba="0.7 0.5 0.3 1"/>
    <hfield name="terrain" nrow="11" ncol="11" size="5 5 0.5 0.1"/>
    <mesh name="head" file="head.obj" scale="0.12 0.1 0.1"/>
  </asset>
</mujocoinclude>
"""
QUADRUPED = f"""
<mujoco model="quadruped">
  <include file="./common/parts.xml"/>
  <option timestep="0.005"/>
  <default>
    <geom solimp="0.9 0.99 0.003" density="600"/>
    <default class="body">
      <geom type="capsule" size="0.07" condim="1" material="self"/>
      <joint damping="20" armature="0.01" limited="true"/>
      <default class="leg">
        <geom size="0.05"/>
        <default class="yaw"><joint axis="0 0 1" range="-50 50"/></default>
        <default class="lift"><joint axis="0 1 0" range="-20 60" ref="30" springref="30" stiffness="5"/></default>
        <default class="extend"><joint axis="0 1 0" range="-50 70"/></default>
        <default class="ankle"><joint axis="0 1 0" range="-45 55"/></default>
        <default class="toe"><geom type="sphere" size="0.07" condim="3"/><site size="0.04"/></default>
      </default>
    </default>
    <default class="marker"><site size="0.01" rgba="1 0 0 1"/></default>
    <general ctrllimited="true" ctrlrange="-1 1" dyntype="filter" dynprm="0.1" gainprm="300" biasprm="0 -300"
      biastype="affine"/>
    <default class="coupling"><tendon limited="true" range="-0.8 0.8"/></default>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="9 9 0.5" pos="0 0 -3" material="grid"/>
    <geom name="terrain" type="hfield" hfield="terrain" pos="0 0 -3"/>
    <camera name="global" pos="-9 9 9" mode="targetbody" target="torso"/>
    <body name="torso" childclass="body" pos="0 0 0.3">
      <freejoint name="root"/><light pos="0 0 5" mode="trackcom"/>
      <site name="torso" class="marker"/><site name="ray" class="marker" pos="0.3 0 0"/>
      <geom name="eye" type="sphere" size="0.05" pos="0.5 0.05 0.1" mass="0" contype="0" conaffinity="0"/>
      <geom name="torso" type="ellipsoid" size="0.4 0.25 0.18" density="500"/>
      <geom name="head" type="mesh" mesh="head" pos="0.45 0 0.08"/>
      {"".join(LEG.format(name=n, x=x, y=y, yaw=round(np.degrees(np.arctan2(y, x)))) for n, (x, y) in LEGS.items())}
    </body>
    <body name="ball" pos="2 0 0.5"><freejoint/><geom name="ball" size="0.15" density="45"/><site name="target"/></body>
  </worldbody>
  <contact>{"".join(f'<exclude body1="torso" body2="shin_{n}"/>' for n in LEGS)}</contact>
  <tendon>
    {
    "".join(
        f'''<fixed class="coupling" name="lift_{n}"><joint joint="lift_{n}" coef="0.5"/>
      <joint joint="extend_{n}" coef="0.3"/><joint joint="ankle_{n}" coef="0.3"/></fixed>'''
        for n in LEGS
    )
}
    <spatial name="strap" stiffness="5" damping="2" springlength="0.4">
      <site site="torso"/><site site="toe_front_left"/>
    </spatial>
  </tendon>
  <actuator>
    {
    "".join(
        f'''<general name="yaw_{n}" joint="yaw_{n}"/><general name="lift_{n}" tendon="lift_{n}"/>
    <position name="extend_{n}" joint="extend_{n}" kp="200" ctrlrange="-1 1"/>'''
        for n in LEGS
    )
}
  </actuator>
  <sensor>
    <accelerometer site="torso"/><velocimeter site="torso"/><rangefinder site="ray"/><force site="toe_front_left"/>
    <touch site="toe_front_right"/><framequat objtype="body" objname="torso"/><subtreelinvel body="torso"/>
  </sensor>
  <keyframe><key name="home" qpos="0 0 0.3 1 0 0 0{" 0" * 16} 2 0 0.5 1 0 0 0"/></keyframe>
</mujoco>
"""


def egg() -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces of a closed surface with the shape of an egg of radius 1."""
    rng = np.random.default_rng(2)
    vertices = rng.normal(size=(150, 3))
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    hull = ConvexHull(vertices)
    faces = hull.simplices.copy()
    corners = vertices[faces]
    inward = np.einsum(
        "ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    faces[inward < 0.0] = faces[inward < 0.0][:, ::-1]
    return vertices, faces


def wavefront(vertices: np.ndarray, faces: np.ndarray) -> str:
    rows = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    return "\n".join(rows) + "\n"


def duck() -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces of a duck: one closed surface, not convex, 0.25 m long."""
    around, along = 24, 32
    angle = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    s = np.linspace(0.0, 1.0, along + 1)[1:-1]
    belly = np.sqrt(np.clip(1.0 - ((s - 0.45) / 0.46) ** 2, 0.01, None))
    radius = np.where(
        s < 0.8, belly, np.maximum(belly, 0.55 * np.sqrt(np.clip(1.0 - ((s - 0.9) / 0.11) ** 2, 0.0, 1.0)))
    )
    centre = np.where(s < 0.75, 0.0, 1.6 * (s - 0.75) / 0.25)
    rings = [
        np.column_stack([np.full(around, 0.25 * s[i] - 0.12), 0.08 * radius[i] * np.cos(angle),
                         0.06 * (radius[i] * np.sin(angle) + centre[i])]) for i in range(len(s))
    ]  # fmt: skip
    ends = np.array([[-0.12, 0.0, 0.0], [0.13, 0.0, 0.06 * 1.6]])
    vertices, count = np.concatenate([*rings, ends]), len(rings)
    faces = []
    for j in range(around):
        k = (j + 1) % around
        for i in range(count - 1):
            a, b, c, d = i * around + j, i * around + k, (i + 1) * around + j, (i + 1) * around + k
            faces += [(a, b, c), (b, d, c)]
        first, last = (count - 1) * around, count * around
        faces += [(last, k, j), (last + 1, first + j, first + k)]
    return vertices, np.array(faces)


@pytest.fixture
def quadruped(tmp_path: Path) -> Path:
    (tmp_path / "common").mkdir()
    (tmp_path / "common" / "parts.xml").write_text(PARTS, encoding="utf-8")
    (tmp_path / "head.obj").write_text(wavefront(*egg()), encoding="utf-8")
    path = tmp_path / "quadruped.xml"
    path.write_text(QUADRUPED, encoding="utf-8")
    return path


def into_waves(source: object) -> dict:
    lines = [line for line in TEN_LINES.splitlines() if line]
    assert len(lines) <= 10
    names = {"source": source}
    exec(compile(TEN_LINES, "ten_lines", "exec"), names)
    return names


def kinetic_energy(model, data) -> float:
    mujoco.mj_energyVel(model, data)
    return float(data.energy[1])


def test_ten_lines_put_a_quadruped_of_files_into_waves(quadruped):
    names = into_waves(quadruped)
    model, data = names["model"], names["data"]
    last = len(names["heights"]) // 2
    assert np.isfinite(data.qpos).all()
    assert not data.warning.number.any()
    assert np.abs(names["heights"][last:]).max() < 0.2
    assert np.mean(names["shares"][last:]) == pytest.approx(1.0, abs=0.02)
    assert data.body("torso").xmat[8] > 0.9
    assert (model.nu, model.ntendon, model.nsensor, model.nkey) == (12, 5, 7, 1)
    assert model.body("ball").id == 14


def test_ten_lines_put_a_duck_of_a_mesh_into_waves(tmp_path):
    (tmp_path / "duck.obj").write_text(wavefront(*duck()), encoding="utf-8")
    spec = mujoco.MjSpec()
    spec.meshdir = str(tmp_path)
    spec.add_mesh(name="duck", file="duck.obj")
    body = spec.worldbody.add_body(name="torso", pos=[0, 0, 0.2], euler=[60, 0, 0])
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="duck", density=150)
    body.add_geom(name="lead", size=[0.015, 0, 0], pos=[-0.03, 0, -0.045], density=11000)
    names = into_waves(spec)
    last = len(names["heights"]) // 2
    assert np.abs(names["heights"][last:]).max() < 0.1
    assert np.mean(names["shares"][last:]) == pytest.approx(1.0, abs=0.02)
    assert not names["data"].warning.number.any()


def test_files_in_memory_are_read_by_mujoco_and_get_wet(quadruped):
    """As dm_control has its models: text, and a dictionary of what it includes and loads."""
    files = {"./common/parts.xml": PARTS.encode(), "head.obj": (quadruped.parent / "head.obj").read_bytes()}
    spec = mujoco.MjSpec.from_string(QUADRUPED, files, files)
    here, there = suchus.wet(spec).compile(), suchus.wet(quadruped).compile()
    assert list(here.body_mass) == list(there.body_mass)
    assert list(here.numeric("water").data) == list(there.numeric("water").data)


def test_a_quadruped_whose_motors_are_off_comes_to_rest_and_never_has_more_than_its_fall_gave(quadruped):
    model = suchus.wet(quadruped, dry="eye").compile()
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    energies = []
    for _ in range(4000):
        mujoco.mj_step(model, data)
        energies.append(kinetic_energy(model, data))
    fall = 9.81 * model.body_mass.sum() * 0.3
    assert max(energies) < fall
    assert max(energies[2000:]) < 1e-2 * max(energies)
    assert energies[-1] < 1e-3 * max(energies)
    assert data.body("torso").xpos[2] == pytest.approx(0.0, abs=0.1)


def test_a_quadruped_that_paddles_spends_what_its_motors_give(quadruped):
    """In flat water the energy of the bodies does not grow from cycle to cycle."""
    model = suchus.wet(quadruped).compile()
    data = mujoco.MjData(model)
    energies = []
    while data.time < 20.0:
        data.ctrl[:] = 0.8 * np.sin(2.0 * np.pi * data.time + np.arange(model.nu))
        mujoco.mj_step(model, data)
        energies.append(kinetic_energy(model, data))
    cycles = np.array(energies).reshape(-1, 200).max(axis=1)
    assert np.isfinite(data.qpos).all()
    assert 0.0 < cycles[-5:].max() < 1.5 * cycles[5:10].max()
    assert abs(data.body("torso").xpos[2]) < 0.25


def test_added_mass_of_a_body_that_is_turned_is_whole_where_static_bodies_are_fused():
    """MuJoCo fuses an empty child with its parent, whose mass matrix would be diagonal then: URDF files ask for it."""
    box = '<body euler="20 30 40"><freejoint/><geom type="box" size="0.3 0.2 0.05" density="500"/></body>'
    matrices = []
    for word in ("true", "false"):
        xml = f'<mujoco><compiler fusestatic="{word}"/><worldbody>{box}</worldbody></mujoco>'
        model = suchus.wet(xml, level=3.0).compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        full = np.zeros((6, 6))
        mujoco.mj_fullM(model, data, full)
        matrices.append(full)
    assert abs(matrices[1][0, 2]) > 1.0
    assert matrices[0] == pytest.approx(matrices[1], rel=1e-12)


def test_bodies_without_geoms_get_no_room_and_copies_of_bodies_do():
    ball = '<body><freejoint/><geom size="0.1" density="500"/></body>'
    flex = (
        '<flexcomp type="grid" count="2 2 2" spacing="0.1 0.1 0.1" name="f" dim="3" mass="1"><edge equality="true"/>'
        "</flexcomp>"
    )
    xml = f'<mujoco><worldbody><replicate count="3" offset="1 0 0">{ball}</replicate>{flex}</worldbody></mujoco>'
    dry, model = mujoco.MjModel.from_xml_string(xml), suchus.wet(xml).compile()
    assert model.nbody == dry.nbody + 3
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.count_nonzero(suchus.water_loads(model, data).volume) == 3


BALL = '<body name="ball"><freejoint/><geom name="ball" size="0.1" density="500"/></body>'
REFUSED = {
    "enable one of the flags": '<option><flag spring="disable" damper="disable"/></option>',
    "set the option gravity to 0 0 0": '<option><flag gravity="disable"/></option>',
    "compiler boundmass 0.5, boundinertia 0": '<compiler boundmass="0.5"/>',
    "compiler boundmass 0, boundinertia 0.1": '<compiler boundinertia="0.1"/>',
}


@pytest.mark.parametrize("words", REFUSED)
def test_options_under_which_water_would_act_wrongly_get_a_sentence(words):
    with pytest.raises(InvalidDesign) as caught:
        suchus.wet(f"<mujoco>{REFUSED[words]}<worldbody>{BALL}</worldbody></mujoco>")
    assert words in str(caught.value)
    assert str(caught.value).startswith("this model")


@pytest.mark.parametrize("flag", ["spring", "damper"])
def test_water_acts_where_one_kind_of_passive_forces_is_off(flag):
    xml = f'<mujoco><option><flag {flag}="disable"/></option><worldbody>{BALL}</worldbody></mujoco>'
    model = suchus.wet(xml).compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 2000)
    assert data.qpos[2] == pytest.approx(0.0, abs=1e-3)


ARGUMENTS = {
    "water.waves is (0.3,); a tuple, each a Wave": {"waves": 0.3},
    "coefficients is {'ball': 1.0}; names of geoms with their coefficients": {"coefficients": {"ball": 1.0}},
    "coefficients is ['ball']; names of geoms with their coefficients": {"coefficients": ["ball"]},
    "pairs of a time and such a number are allowed": {"level": [0.0, 1.0]},
    "current.velocity has 3 numbers": {"current": (1.0, 0.0, 0.0)},
}


@pytest.mark.parametrize("words", ARGUMENTS)
def test_arguments_of_other_kinds_get_a_sentence(words):
    with pytest.raises(InvalidDesign) as caught:
        suchus.wet(f"<mujoco><worldbody>{BALL}</worldbody></mujoco>", **ARGUMENTS[words])
    assert words in str(caught.value)


def test_pairs_of_time_and_level_may_be_tuples_lists_and_arrays_and_one_name_may_be_dry():
    other = BALL.replace('"ball"', '"other"').replace("<body ", '<body pos="1 0 0" ')
    xml = f"<mujoco><worldbody>{BALL}{other}</worldbody></mujoco>"
    pairs = ((0.0, 0.0), (10.0, 1.0))
    tables = [
        json.dumps(list(suchus.wet(xml, level=level, dry="other").compile().numeric("water").data))
        for level in (pairs, [list(pair) for pair in pairs], np.array(pairs))
    ]
    assert tables[1:] == tables[:1] * 2
