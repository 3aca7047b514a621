"""``suchus.wet`` puts water into any MuJoCo model, which runs as any other does."""

from math import pi, sqrt, tau

import mujoco
import mujoco.rollout
import numpy as np
import pytest
from scipy.spatial import ConvexHull

import suchus
from suchus.core.errors import InvalidDesign, UnknownName, UnreadableFile, UnsuitedRobot
from suchus.core.water_table import FORCE, NUMBERS, SUBMERGED_VOLUME
from suchus.sim.immersion import Current, GeomCoefficients, Wave, sea, water_loads, wet
from suchus.sim.immersion.meshes import box_triangles, solid

IDEAL = GeomCoefficients(drag=0.0, linear_drag=0.0, linear_turning_drag=0.0)
BALL = '<body name="ball"><freejoint/><geom name="ball" size="0.1" density="500"/></body>'


def scene(bodies: str, options: str = "", rest: str = "") -> str:
    return f"<mujoco><option {options}/>{rest}<worldbody>{bodies}</worldbody></mujoco>"


def still(model, steps=6000):
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, steps)
    mujoco.mj_forward(model, data)
    return data


def matrix(model, data):
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return full


def test_a_ball_floats_half_under_and_its_load_is_its_weight():
    model = wet(scene(BALL)).compile()
    data = still(model)
    loads, weight = water_loads(model, data), model.body_mass[1] * 9.81
    assert data.qpos[2] == pytest.approx(0.0, abs=1e-3)
    assert loads.volume[1] == pytest.approx(2 / 3 * pi * 1e-3, rel=0.02)
    assert loads.force[1, 2] == pytest.approx(weight, rel=0.02)
    assert loads.force[0] == pytest.approx(0.0)


def test_the_specification_that_was_given_stays_dry():
    spec = mujoco.MjSpec.from_string(scene(BALL))
    before = spec.to_xml()
    wet(spec)
    assert spec.to_xml() == before


def test_rollout_threads_and_steps_give_the_same_bytes():
    model = wet(scene(BALL), waves=Wave(height=0.05, length=1.0)).compile()
    data = mujoco.MjData(model)
    start = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states, _ = mujoco.rollout.rollout(
        model, [mujoco.MjData(model) for _ in range(2)], np.tile(start, (4, 1)), nstep=50
    )
    mujoco.mj_step(model, data, 50)
    mujoco.mj_getState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    assert (states[:, -1] == start).all()
    assert data.qpos[2] != 0.0


def test_a_reset_keeps_the_water():
    model = wet(scene(BALL)).compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    first = np.array(data.qpos)
    mujoco.mj_resetData(model, data)
    mujoco.mj_step(model, data, 10)
    assert (data.qpos == first).all()
    assert water_loads(model, data).volume[1] > 0.0


def test_what_the_model_keeps_in_numbers_and_user_data_is_left_alone():
    xml = scene(BALL, rest='<size nuserdata="5"/><custom><numeric name="mine" data="1 2 3 4"/></custom>')
    model = wet(xml).compile()
    data = mujoco.MjData(model)
    data.userdata[:5] = range(5)
    mujoco.mj_forward(model, data)
    assert list(data.userdata[:5]) == [0, 1, 2, 3, 4]
    assert list(model.numeric("mine").data) == [1, 2, 3, 4]
    assert data.userdata[5 + SUBMERGED_VOLUME] == water_loads(model, data).volume.sum() > 0.0
    assert data.userdata[5 + FORCE + 2] == pytest.approx(water_loads(model, data).force[:, 2].sum())
    assert len(data.userdata) == 5 + NUMBERS + 7 * model.nbody


def test_bodies_that_are_added_after_the_water_are_refused():
    spec = wet(scene(BALL))
    spec.worldbody.add_body(name="late").add_geom(size=[0.1, 0, 0])
    with pytest.raises(ValueError, match="plugin->init failed"):
        spec.compile()


def test_ground_carries_what_the_water_does_not():
    xml = scene(
        '<geom type="plane" size="1 1 0.1"/>' + BALL.replace("<body ", '<body pos="0 0 0.1" ').replace("500", "2000")
    )
    model = wet(xml, level=0.1).compile()
    data = still(model)
    force = np.zeros(6)
    mujoco.mj_contactForce(model, data, 0, force)
    half = 2 / 3 * pi * 1e-3 * 1000 * 9.81
    assert force[0] == pytest.approx(model.body_mass[1] * 9.81 - half, rel=0.01)


def test_bodies_that_cannot_move_and_pictures_stay_dry():
    picture = '<geom name="picture" size="0.3" contype="0" conaffinity="0" mass="0"/>'
    xml = scene('<geom name="rock" size="0.5"/>' + BALL.replace("</body>", picture + "</body>"))
    one, two = wet(xml, level=9.0).compile(), wet(xml, level=9.0, coefficients={"picture": IDEAL}).compile()
    volume = 4 / 3 * pi * 1e-3
    for model, expected in ((one, volume), (two, 28 * volume)):
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        assert water_loads(model, data).volume.sum() == pytest.approx(expected)


def test_names_make_geoms_and_bodies_dry_and_scale_their_volume():
    second = BALL.replace('"ball"', '"other"').replace("<body ", '<body pos="1 0 0" ')
    for options, expected in (
        ({"dry": ["other"]}, 1.0), ({"dry": ("ball",)}, 1.0), ({}, 2.0),
        ({"coefficients": {"ball": GeomCoefficients(volume=0.25)}}, 1.25),
    ):  # fmt: skip
        model = wet(scene(BALL + second), level=9.0, **options).compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        assert water_loads(model, data).volume.sum() == pytest.approx(expected * 4 / 3 * pi * 1e-3)


def test_a_mesh_of_a_box_does_what_the_box_does():
    half = np.array([0.3, 0.15, 0.07])
    corners = box_triangles(half).reshape(-1, 3)
    vertices = " ".join(f"{x:.17g}" for x in corners.ravel())
    faces = " ".join(str(i) for i in range(len(corners)))
    mesh = f'<asset><mesh name="m" vertex="{vertices}" face="{faces}"/></asset>'
    tilted = '<body pos="0.1 0.2 0.02" euler="20 30 40"><freejoint/><geom name="g" {} density="500"/></body>'
    forces = []
    for geom, rest in ((f'type="box" size="{half[0]} {half[1]} {half[2]}"', ""), ('type="mesh" mesh="m"', mesh)):
        model = wet(scene(tilted.format(geom), rest=rest), added_mass=0.0, coefficients={"g": IDEAL}).compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        forces.append(np.r_[data.qacc, water_loads(model, data).volume.sum()])
    assert forces[1] == pytest.approx(forces[0], rel=1e-5, abs=1e-5)


def test_a_solid_has_volume_centre_and_half_axes_of_its_ellipsoid():
    points = np.random.default_rng(1).normal(size=(4000, 3))
    points *= np.array([0.3, 0.2, 0.1]) / np.linalg.norm(points, axis=1)[:, None]
    shifted = points + np.array([1.0, 2.0, 3.0])
    faces = ConvexHull(shifted).simplices
    surface = solid(shifted, faces, "egg", is_convex=True)
    assert surface.volume == pytest.approx(4 / 3 * pi * 0.006, rel=5e-3)
    assert surface.centre == pytest.approx([1.0, 2.0, 3.0], abs=2e-3)
    assert sorted(surface.half) == pytest.approx([0.1, 0.2, 0.3], rel=5e-3)


def test_an_open_mesh_is_refused_and_its_hull_is_not():
    box = box_triangles(np.array([0.1, 0.1, 0.1])).reshape(-1, 3)
    vertices = " ".join(str(x) for x in box[3:].ravel())
    faces = " ".join(str(i) for i in range(len(box) - 3))
    xml = scene(
        '<body><freejoint/><geom name="tub" type="mesh" mesh="m"/></body>',
        rest=f'<asset><mesh name="m" vertex="{vertices}" face="{faces}" inertia="convex"/></asset>',
    )
    with pytest.raises(InvalidDesign, match=r"'tub' is an open mesh: 3 of its 33 edges .*is_convex=True"):
        wet(xml)
    model = wet(xml, level=9.0, coefficients={"tub": GeomCoefficients(is_convex=True)}).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert water_loads(model, data).volume[1] == pytest.approx(0.008)


TWO_LINKS = """
<body pos="0 0 0"><freejoint/><geom name="a" type="capsule" fromto="-0.3 0 0 0 0 0" size="0.05" density="900"/>
<body><joint axis="0 1 0.3"/><geom name="b" type="box" size="0.15 0.1 0.02" pos="0.2 0 0" density="700"/>
<body pos="0.35 0 0"><joint axis="0 0 1"/><geom name="c" type="ellipsoid" size="0.1 0.05 0.15" pos="0.1 0 0"/></body>
</body></body>
"""


def test_a_chain_in_ideal_water_without_gravity_keeps_energy_and_momentum():
    """Water and body together: the added mass is in the matrix, its other terms are forces."""
    xml = scene(TWO_LINKS, 'integrator="RK4" timestep="0.0005" gravity="0 0 0"')
    model = wet(xml, level=99.0, coefficients=dict.fromkeys("abc", IDEAL), splash=0.0).compile()
    data = mujoco.MjData(model)
    data.qvel[:] = [0.3, -0.2, 0.1, 0.5, -0.8, 0.4, 1.0, -1.5]
    kept = []
    for _ in range(2):
        mujoco.mj_forward(model, data)
        momentum = matrix(model, data) @ data.qvel
        kept.append(np.r_[0.5 * data.qvel @ momentum, momentum[:3]])
        mujoco.mj_step(model, data, 4000)
    assert kept[1] == pytest.approx(kept[0], rel=1e-6)
    assert np.abs(data.qpos[7:]).max() > 0.3


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize("density", [20, 500])
def test_a_chain_that_falls_into_water_never_gains_energy(integrator, density):
    xml = scene(TWO_LINKS.replace("900", f"{density}").replace("700", f"{density}"), f'integrator="{integrator}"')
    xml = xml.replace('"0 0 0"><freejoint', '"0 0 0.5"><freejoint').replace(
        'size="0.1 0.05 0.15"', f'size="0.1 0.05 0.15" density="{density}"'
    )
    model = wet(xml).compile()
    data = mujoco.MjData(model)
    heights = []
    for _ in range(50):
        mujoco.mj_step(model, data, 100)
        heights.append(float(data.subtree_com[1, 2]))
    assert np.isfinite(data.qpos).all()
    assert max(heights[5:]) < 0.35
    assert np.abs(data.qvel).max() < 3.0


def test_a_flat_plate_lifts_at_right_angles_to_the_flow_and_takes_no_power():
    xml = scene(
        '<body euler="0 -20 0"><freejoint/><geom name="g" type="box" size="0.2 0.4 0.004"/></body>', 'gravity="0 0 0"'
    )
    forces = []
    for lift in (0.0, 2.0):
        model = wet(xml, level=9.0, added_mass=0.0, coefficients={"g": IDEAL}, lift=lift).compile()
        data = mujoco.MjData(model)
        data.qvel[0] = 1.5
        mujoco.mj_forward(model, data)
        forces.append(np.array(data.qfrc_passive[:3]))
    assert forces[0] == pytest.approx(0.0, abs=1e-9)
    area, sine, cosine = 0.32, np.sin(np.radians(20)), np.cos(np.radians(20))
    assert forces[1][0] == pytest.approx(0.0, abs=1e-9)
    assert forces[1][2] == pytest.approx(0.5 * 1000 * area * 2.0 * 1.5**2 * sine * cosine)


def test_drag_coefficients_count_along_the_axes_of_the_geom():
    xml = scene(
        '<body euler="0 0 90"><freejoint/><geom name="g" type="box" size="0.1 0.2 0.3"/></body>', 'gravity="0 0 0"'
    )
    chosen = GeomCoefficients(drag=(1.0, 2.0, 3.0), linear_drag=(5.0, 0.0, 0.0), linear_turning_drag=0.0)
    model = wet(xml, level=9.0, added_mass=0.0, coefficients={"g": chosen}).compile()
    for world, area, drag, linear in ((0, 4 * 0.03, 2.0, 0.0), (1, 4 * 0.06, 1.0, 5.0), (2, 4 * 0.02, 3.0, 0.0)):
        data = mujoco.MjData(model)
        data.qvel[world] = 2.0
        mujoco.mj_forward(model, data)
        assert data.qfrc_passive[world] == pytest.approx(-0.5 * 1000 * drag * area * 4.0 - 2.0 * linear)


def test_a_current_carries_a_body_as_fast_as_it_is_at_its_depth_and_time():
    xml = scene('<body pos="0 0 -2"><freejoint/><geom size="0.1" density="1000"/></body>')
    current = Current(velocity=(0.5, -0.2), shear=(0.1, 0.0), factor=((0.0, 0.0), (5.0, 1.0)))
    model = wet(xml, current=current).compile()
    data = still(model, 20000)
    # at 2 m below the surface the current is 0.1 1/s times 2 m slower
    assert data.qvel[:2] == pytest.approx([0.5 - 0.2, -0.2], abs=0.02)


def test_a_level_that_rises_lifts_what_floats():
    model = wet(scene(BALL), level=((0.0, 0.0), (10.0, 1.0))).compile()
    data = still(model, 10000)
    assert data.qpos[2] == pytest.approx(1.0, abs=0.02)


def test_up_is_against_gravity():
    model = wet(scene(BALL, 'gravity="-9.81 0 0"'), level=0.5).compile()
    assert still(model).qpos[:3] == pytest.approx([0.5, 0.0, 0.0], abs=0.01)


def test_a_raft_tilts_with_a_long_wave_and_a_small_one_stays_level_in_a_short_wave():
    raft = '<body><freejoint/><geom type="box" size="{0} {0} 0.02" density="500"/></body>'
    slope = {}
    for half, length in ((0.3, 30.0), (0.3, 0.3)):
        wave = Wave(height=0.02 * length, length=length, phase=-0.25)
        model = wet(scene(raft.format(half)), waves=wave).compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        slope[length] = abs(float(data.qacc[4]))
    assert slope[0.3] < 0.35 * slope[30.0]


def test_a_sea_has_its_height_and_period():
    waves = sea(1.2, 6.0, count=60, seed=3)
    energy = sum(wave.height**2 / 8 for wave in waves)
    assert 4 * sqrt(energy) == pytest.approx(1.2)
    highest = max(waves, key=lambda wave: wave.height)
    assert 1 / highest.frequency == pytest.approx(6.0, rel=0.1)
    assert sea(1.2, 6.0, seed=3) == sea(1.2, 6.0, seed=3) != sea(1.2, 6.0, seed=4)
    assert len({round(wave.heading, 6) for wave in sea(1.0, 6.0, spread=0.3)}) > 20


def test_the_surface_of_a_sea_is_the_sum_of_its_waves():
    waves = sea(0.4, 4.0, count=5)
    model = wet(scene(BALL.replace("0.1", "0.001")), waves=waves, added_mass=0.0).compile()
    data = mujoco.MjData(model)
    data.time = 1.7
    phase = [tau * (wave.phase - wave.frequency * 1.7) for wave in waves]
    height = sum(wave.height / 2 * np.cos(angle) for wave, angle in zip(waves, phase, strict=True))
    data.qpos[2] = height
    mujoco.mj_forward(model, data)
    assert water_loads(model, data).volume[1] == pytest.approx(2 / 3 * pi * 1e-9, rel=1e-3)


def test_a_urdf_file_gets_wet():
    path = suchus.sample("quadruped")
    model = suchus.wet(path, level=5.0).compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    assert suchus.water_loads(model, data).volume.sum() > 0.0


BAD = {
    "level is 'high'": ({"level": "high"}, InvalidDesign),
    "level is nan m": ({"level": float("nan")}, InvalidDesign),
    "density is 0 kg/m3": ({"density": 0.0}, InvalidDesign),
    "splash is 2": ({"splash": 2.0}, InvalidDesign),
    "no geom named 'bal'; there is ball. Did you mean 'ball'": ({"coefficients": {"bal": IDEAL}}, UnknownName),
    "no geom or body named 'x'": ({"dry": ["x"]}, UnknownName),
    "no geom of this model can get wet": ({"dry": ["ball"]}, InvalidDesign),
}


@pytest.mark.parametrize("words", BAD)
def test_bad_numbers_and_names_get_a_sentence(words):
    options, kind = BAD[words]
    with pytest.raises(kind) as caught:
        wet(scene(BALL), **options)
    assert words in str(caught.value)


def test_a_model_whose_geoms_have_no_names_says_so():
    nameless = scene(BALL).replace('name="ball"', "")
    with pytest.raises(UnknownName, match="there is no geom named 'fin'; no geom there has a name"):
        wet(nameless, coefficients={"fin": IDEAL})


MODELS = {
    "has a fluid of MuJoCo's own (option density 1000": scene(BALL, 'density="1000"'),
    "PGS or the noslip iterations": scene(BALL, 'solver="PGS"'),
    "noslip_iterations to 0": scene(BALL, 'noslip_iterations="2"'),
    "lets bodies sleep": scene(BALL).replace("<option />", '<option><flag sleep="enable"/></option>'),
    "there is no such file": "nothing.xml",
    "cannot read the model": "<mujoco><nonsense/></mujoco>",
}


@pytest.mark.parametrize("words", MODELS)
def test_models_in_which_water_cannot_act_get_a_sentence(words):
    with pytest.raises((InvalidDesign, UnreadableFile)) as caught:
        wet(MODELS[words])
    assert words in str(caught.value)


def test_what_is_no_model_and_what_is_wet_already_get_a_sentence():
    with pytest.raises(InvalidDesign, match="got a MjModel"):
        wet(mujoco.MjModel.from_xml_string(scene(BALL)))
    with pytest.raises(InvalidDesign, match="wet already"):
        wet(wet(scene(BALL)))
    dry = mujoco.MjModel.from_xml_string(scene(BALL))
    with pytest.raises(UnsuitedRobot, match="no water"):
        water_loads(dry, mujoco.MjData(dry))


def test_a_geom_without_volume_and_one_that_cannot_move_get_a_sentence_when_named():
    xml = scene('<geom name="floor" type="plane" size="1 1 1"/><geom name="rock" size="0.2"/>' + BALL)
    with pytest.raises(InvalidDesign, match="'floor' is of type plane, which has no volume"):
        wet(xml, coefficients={"floor": IDEAL})
    with pytest.raises(InvalidDesign, match="'rock' cannot move"):
        wet(xml, coefficients={"rock": IDEAL})


def test_waves_that_would_break_and_waves_without_gravity_get_a_sentence():
    with pytest.raises(InvalidDesign, match=r"steeper than 0\.142, where waves break"):
        Wave(height=0.2, length=1.0)
    with pytest.raises(InvalidDesign, match="where seas break: at this period at most"):
        sea(2.0, 3.0)
    with pytest.raises(InvalidDesign, match="no gravity, and waves need it"):
        wet(scene(BALL, 'gravity="0 0 0"'), waves=Wave(height=0.1, length=2.0))


def test_coefficients_outside_their_ranges_get_a_sentence():
    with pytest.raises(InvalidDesign, match=r"coefficients\.drag is -1"):
        GeomCoefficients(drag=-1.0)
    with pytest.raises(InvalidDesign, match=r"coefficients\.drag has 2 numbers"):
        GeomCoefficients(drag=(1.0, 2.0))
