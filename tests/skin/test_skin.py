"""The skin is closed, follows the bones, and lies on the robot's shapes."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from tests.bodies import eight, hatchling, six

from suchus.core.errors import InvalidDesign, SuchusError
from suchus.robot.design import LEGS, crocodile, joint_names, layout
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model, joint_addresses
from suchus.visual.skin import bone_names, poses, skin
from suchus.visual.skin.ankles import ankles, skin_with_ankles
from suchus.visual.skin.bones import Poses
from suchus.visual.skin.surface import _blended

STILL = np.array([1.0, 0.0, 0.0, 0.0])


def check_closed(found):
    """Every edge of every part is shared by two faces that run through it in opposite ways."""
    edges = found.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    there, back = edges @ [len(found.vertices), 1], edges @ [1, len(found.vertices)]
    assert len(np.unique(there)) == len(there)
    assert np.array_equal(np.sort(there), np.sort(back))
    assert np.array_equal(found.part_index[edges[:, 0]], found.part_index[edges[:, 1]])


def volumes(found, vertices):
    a, b, c = np.moveaxis(vertices[found.faces], 1, 0)
    return np.bincount(found.part_index[found.faces[:, 0]], weights=np.einsum("fi,fi->f", a, np.cross(b, c)) / 6)


@pytest.fixture(scope="module", params=sorted(ROBOTS))
def shelf(request):
    return ROBOTS[request.param]


@pytest.fixture(scope="module", params=[name for name in sorted(ROBOTS) if ROBOTS[name].tables is not None])
def animal(request):
    """The robots that wear a crocodile's skin."""
    return ROBOTS[request.param]


@pytest.fixture(scope="module")
def shaken(shelf):
    """Random angles, and where MuJoCo puts the bodies."""
    model = compile_model(shelf)
    data, rng = mujoco.MjData(model), np.random.default_rng(3)
    angles = rng.uniform(-0.6, 0.6, len(joint_names(shelf)))
    data.qpos[:3] = 0.3, -0.2, 0.5
    data.qpos[3:7] = [0.5, -0.5, 0.1, 0.7] / np.linalg.norm([0.5, -0.5, 0.1, 0.7])
    data.qpos[joint_addresses(model, joint_names(shelf))] = angles
    mujoco.mj_kinematics(model, data)
    return data, angles


def test_every_part_is_closed_and_faces_outward(shelf):
    found = skin(shelf)
    check_closed(found)
    assert (volumes(found, found.vertices) > 0).all()
    assert np.allclose(np.linalg.norm(found.normals, axis=1), 1.0)


def test_weights_sum_to_one(shelf):
    found = skin(shelf)
    assert np.allclose(found.weights.sum(axis=1), 1.0, atol=1e-12)
    assert found.weights.min() >= 0.0
    assert found.indices.min() >= 0
    assert found.indices.max() < len(found.bones)


def test_a_joint_is_shared_half_and_half_and_left_half_a_segment_away():
    """Between them a smooth step: 3 t^2 - 2 t^3, a quarter of the way 5/32."""
    along = np.array([0.4, 0.5, 0.75, 1.0, 1.25, 1.5])
    indices, weights = _blended(along, [1.0], np.array([1.0, 2.0]), [7, 3])
    of_second = np.where(indices == 3, weights, 0.0).sum(axis=1)
    assert of_second == pytest.approx([0.0, 0.0, 5 / 32, 0.5, 27 / 32, 1.0])
    assert weights.sum(axis=1) == pytest.approx(1.0)


def test_zero_posture_is_rest(shelf):
    found = skin(shelf)
    still = np.tile(STILL, (len(found.bones), 1))
    assert np.allclose(found.vertices, found.posed(found.rest_origins, still), rtol=0, atol=1e-15)


def test_bones_are_the_bodies_of_the_model(shelf, shaken):
    data, angles = shaken
    found = poses(shelf, data.qpos[:3], data.qpos[3:7], angles)
    assert set(bone_names(shelf)) == {data.model.body(i).name for i in range(1, data.model.nbody)}
    for name, position, quaternion in zip(bone_names(shelf), *found, strict=True):
        assert np.allclose(data.body(name).xpos, position, atol=1e-9)
        assert np.isclose(abs(data.body(name).xquat @ quaternion), 1.0, atol=1e-9)


def test_a_moved_robot_moves_its_skin_rigidly(shelf):
    found, count = skin(shelf), len(skin(shelf).bones)
    turn = np.array([np.cos(0.4), 0.0, 0.0, np.sin(0.4)])
    at = poses(shelf, np.array([1.0, 2.0, 3.0]), turn, np.zeros(len(joint_names(shelf))))
    R = np.array([[np.cos(0.8), -np.sin(0.8), 0.0], [np.sin(0.8), np.cos(0.8), 0.0], [0.0, 0.0, 1.0]])
    assert at.positions.shape == (count, 3)
    assert np.allclose(found.vertices @ R.T + [1.0, 2.0, 3.0], found.posed(*at), atol=1e-12)


def test_left_mirrors_right(shelf):
    found = skin(shelf)
    mirrored = found.vertices * [1.0, -1.0, 1.0]
    distance, other = cKDTree(found.vertices).query(mirrored)
    assert distance.max() < 1e-9
    assert np.abs(found.colours.astype(int) - found.colours[other]).max() <= 1


def test_mirrored_posture_mirrors_the_skin(shelf):
    found, rng, names = skin(shelf), np.random.default_rng(1), joint_names(shelf)
    one = rng.uniform(-0.5, 0.5, len(names))
    other, place = one.copy(), layout(shelf)
    for limb in place.limbs:
        other[limb.hinges] = one[place.limbs[limb.contralateral].hinges]
    for i in range(place.forward_hinges.start, len(names)):
        if "yaw" in names[i]:
            other[i] = -one[i]
    a, b = (found.posed(*poses(shelf, np.zeros(3), STILL, angles)) for angles in (one, other))
    distance, _ = cKDTree(b).query(a * [1.0, -1.0, 1.0])
    assert distance.max() < 1e-9


def test_the_volume_is_that_of_an_animal_of_this_mass(animal):
    litres = 1000 * volumes(skin(animal), skin(animal).vertices).sum()
    assert 0.5 < animal.mass / litres < 1.2  # [kg/l]; crocodilians float, our servos are not packed tight


def test_a_plain_skin_encloses_axis_limbs_and_feet_within_the_bodys_length(shelf):
    found, place = skin(shelf), layout(shelf)
    span = np.ptp(found.vertices[found.part_index == 0, 0])
    assert span == pytest.approx(shelf.length, rel=0.03)
    hung = {found.bones[bone] for bone in np.unique(found.indices[found.weights > 0.5])}
    assert {body.name for body in place.bodies} - hung <= {"neck"}  # a short segment may share all of its skin


def standing_out(robot, found, vertices, data):
    """How far the shapes that meet the ground stand out of the skin, by name of the shape [m]."""
    a, b, c = np.moveaxis(vertices[found.faces], 1, 0)
    areas = np.cross(b - a, c - a)
    normals = np.zeros_like(vertices)
    for i in range(3):
        np.add.at(normals, found.faces[:, i], areas)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    bulk = [
        found.part_index == part for part in np.flatnonzero(np.bincount(found.part_index) > 70)
    ]  # no scutes, teeth, eyes
    skins = [(vertices[own], normals[own], cKDTree(vertices[own])) for own in bulk]
    rng, model, out = np.random.default_rng(0), data.model, {}
    for i in range(model.ngeom):
        name = model.geom(i).name
        if model.geom_bodyid[i] == 0 or name.endswith("_foot"):
            continue
        ball = rng.normal(size=(300, 3))
        ball /= np.linalg.norm(ball, axis=1, keepdims=True)
        if model.geom_type[i] == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            local = ball * model.geom_size[i]
        else:
            radius, half = model.geom_size[i][:2]
            local = radius * ball + np.outer(rng.uniform(-half, half, 300), [0, 0, 1])
        points = data.geom_xpos[i] + local @ data.geom_xmat[i].reshape(3, 3).T
        from_each = []
        for at, away, tree in skins:
            _, near = tree.query(points)
            from_each.append(np.einsum("pi,pi->p", points - at[near], away[near]))
        out[name] = float(np.min(from_each, axis=0).max())
    return out


def test_the_skin_encloses_the_shapes_beneath(animal):
    model, found = compile_model(animal), skin(animal)
    data = mujoco.MjData(model)
    data.qpos[:7] = 0, 0, 0, 1, 0, 0, 0
    mujoco.mj_kinematics(model, data)
    out = standing_out(animal, found, found.vertices, data)
    head, end = out.pop("head"), out.pop([name for name in out if name.startswith("tail")][-1])
    assert max(far for name, far in out.items() if not name.endswith("_foam")) < 0.003  # foam is worn over the skin
    assert head < 0.016  # a snout is narrower than the ellipsoid that stands for it
    assert end < 0.010  # the last capsule ends half a ball beyond the tail's tip


def test_feet_touch_the_ground_where_the_soles_do(animal):
    found, names = skin(animal), bone_names(animal)
    for leg in LEGS:
        links = animal.leg(leg)
        sole = links.hip_offset + links.femur + links.tibia + links.foot_radius
        hung = (found.indices[:, 0] == names.index(f"{leg}_tibia")) & (found.weights[:, 0] > 0.99)
        assert np.isclose(np.abs(found.vertices[hung, 1]).max(), sole, atol=0.15 * links.foot_radius)


def test_wrong_numbers_are_refused(shelf):
    with pytest.raises(InvalidDesign, match="hinges"):
        poses(shelf, np.zeros(3), STILL, np.zeros(3))
    with pytest.raises(InvalidDesign, match="bones"):
        skin(shelf).posed(np.zeros((2, 3)), np.zeros((2, 4)))


@pytest.mark.parametrize(
    ("robot", "plain"), [(six(), False), (hatchling(), False), (eight(), True)], ids=["six", "hatchling", "eight"]
)
def test_who_has_the_chains_wears_a_crocodiles_skin_and_any_other_body_a_hide(robot, plain):
    found, still = skin(robot), poses(robot, np.zeros(3), STILL, np.zeros(len(joint_names(robot))))
    check_closed(found)
    assert found.plain == plain
    hung = {found.bones[bone] for bone in np.unique(found.indices[found.weights > 0.5])}
    assert {layout(robot).bodies[limb.tip].name for limb in layout(robot).limbs} <= hung
    feet = np.zeros((1, len(layout(robot).limbs), 3))
    turned = ankles(robot, Poses(*(part[None] for part in still)), feet)
    more = 0 if plain else 4  # a round foot has no ankle
    assert len(skin_with_ankles(robot).bones) == turned.positions.shape[1] == len(found.bones) + more


def test_a_hatchling_looks_like_the_robot_that_it_is_made_after():
    large, small = (np.ptp(skin(robot).vertices, axis=0) / robot.length for robot in (ROBOTS["caiman"], hatchling()))
    assert small == pytest.approx(large, rel=0.02)


@st.composite
def robots(draw):
    """A valid design: any part of the article's robot larger or smaller, other numbers of plates and segments."""
    base, share = ROBOTS["caiman"].tables, st.floats(0.4, 2.5)

    def scaled(part, *names):
        return replace(part, **{name: getattr(part, name) * draw(share) for name in names})

    try:
        return crocodile(
            replace(
                base,
                name="drawn",
                pelvis=scaled(base.pelvis, "length", "width", "height"),
                spine=scaled(base.spine, "base", "link", "radius"),
                thorax=scaled(base.thorax, "shoulder", "width", "height"),
                head=scaled(base.head, "snout", "width", "height"),
                hind_leg=scaled(base.hind_leg, "hip_offset", "femur", "tibia", "foot_radius", "radius"),
                front_leg=scaled(base.front_leg, "hip_offset", "femur", "tibia", "foot_radius", "radius"),
                tail=replace(
                    scaled(base.tail, "offset", "root", "plate", "gap", "fin_length", "radius_root", "radius_tip"),
                    joints=draw(st.integers(1, 12)),
                    fin_segments=draw(st.integers(1, 6)),
                ),
            )
        )
    except SuchusError:
        return ROBOTS["caiman"]


@settings(max_examples=12)
@given(robot=robots())
def test_any_design_gets_a_sound_skin(robot):
    found = skin(robot)
    assert np.isfinite(found.vertices).all()
    check_closed(found)
    assert (volumes(found, found.vertices) > 0).all()
    assert np.allclose(found.weights.sum(axis=1), 1.0)
    assert np.isclose(found.vertices[:, 0].min(), -robot.tail.length, atol=0.02 * robot.length)
    is_trunk = np.array([not name.startswith(layout(robot).limb_names) for name in found.bones])
    body = found.vertices[is_trunk[found.indices[:, 0]]]  # long front limbs reach beyond the snout
    assert np.isclose(body[:, 0].max(), robot.spine.length + robot.head.snout, atol=0.02 * robot.length)
    assert len(found.vertices) < 2**16
