"""A trunk with rigid pieces: distance, volume, moments and wall velocity of the union."""

import numpy as np
import pytest
from tests.flow.test_trunk import POSE, eel, rod

from suchus import flow
from suchus.core.errors import InvalidDesign

LIMBS = (
    flow.Capsule(arc_position=0.3, start=(0.0, 0.12), end=(0.2, 0.12), radius=0.03),
    flow.Capsule(arc_position=0.3, start=(0.0, -0.12), end=(0.2, -0.12), radius=0.03),
    flow.Capsule(arc_position=0.6, start=(0.0, 0.05), end=(0.15, 0.08), radius=0.04),  # partly inside the trunk
    flow.Capsule(arc_position=0.6, start=(0.15, 0.08), end=(0.15, 0.08), radius=0.05),  # a ball on its end
)


def straight(limbs=LIMBS, radius=0.06, cuts=()):
    body = rod(np.linspace(0.0, 1.0, 81), np.full(81, radius), np.full(81, radius))
    return flow.Limbed(spine=body.spine, half_height=body.half_height, limbs=limbs, cuts=cuts, deforms=False)


def bending():
    trunk = eel(taper=False)
    return flow.Limbed(spine=trunk.spine, half_height=trunk.half_height, limbs=LIMBS[:2], cuts=(0.2, 0.5))


def outside(x, y, z):
    """How far points are from the straight body, from the formulas of its pieces; negative inside."""
    found = np.maximum(np.hypot(y, z) - 0.06, np.abs(x - 0.5) - 0.5)
    for limb in LIMBS:
        a, b = (np.array([limb.arc_position + p[0], p[1], 0.0]) for p in (limb.start, limb.end))
        axis, p = b - a, np.stack([x, y, z], axis=-1)
        share = np.clip((p - a) @ axis / max(axis @ axis, 1e-30), 0.0, 1.0)
        found = np.minimum(found, np.linalg.norm(p - a - share[..., None] * axis, axis=-1) - limb.radius)
    return found


def inside(x, y, z):
    """Whether points lie in the straight body."""
    return outside(x, y, z) < 0


def test_the_volume_of_the_union_is_that_of_random_points():
    rng = np.random.default_rng(1)
    low, high = np.array([-0.1, -0.2, -0.1]), np.array([1.1, 0.2, 0.1])
    x, y, z = (rng.uniform(low, high, (400_000, 3))).T
    there, box = inside(x, y, z), float(np.prod(high - low))
    mass = straight().mass(0.0)
    assert mass.volume == pytest.approx(box * there.mean(), rel=0.01)
    centre = x[there].mean(), y[there].mean()
    assert mass.centre == pytest.approx((*centre, 0.0), abs=2e-3)
    moment = box * ((x - centre[0]) ** 2 + (y - centre[1]) ** 2)[there].sum() / x.size
    assert mass.moments[2, 2] == pytest.approx(moment, rel=0.01)
    apart = straight(LIMBS[:2]).mass(0.0).volume - straight(()).mass(0.0).volume
    assert apart == pytest.approx(2 * (np.pi * 0.03**2 * 0.2 + 4 / 3 * np.pi * 0.03**3), rel=3e-3)


def test_distance_and_normal_are_those_of_the_nearest_piece():
    body, h = straight(), 0.01
    window = [np.arange(a, b, h) for a, b in ((0.2, 0.9), (-0.2, 0.2), (-0.02, 0.1))]
    found = body.measure(window, 0.0, flow.Pose(), 4 * h)
    z, y, x = np.meshgrid(*window[::-1], indexing="ij")
    assert ((found.distance < 0) == inside(x, y, z))[np.abs(found.distance) > 1e-9].all()
    alone = np.hypot(y - 0.12, z) - 0.03
    beside = (x > 0.3) & (x < 0.5) & (y > 0.1) & (np.abs(alone) < 2 * h)
    assert beside.sum() > 100
    assert found.distance[beside] == pytest.approx(alone[beside], abs=1e-9)
    assert found.normal[1][beside] == pytest.approx(((y - 0.12) / (alone + 0.03))[beside], abs=1e-9)
    assert (found.thickness[beside] == 0.06).all()
    joined = (np.abs(x - 0.62) < 0.02) & (y > 0.07) & (np.abs(z) < 0.02) & (np.abs(found.distance) < h)
    assert joined.sum() > 10
    assert np.isinf(found.thickness[joined]).any()  # behind it is the trunk
    assert found.thickness[joined].min() > 4 * h  # farther through than the kernel sees


def test_the_skin_of_the_union_has_its_area_and_stands_outside_of_it():
    skin, bare = (straight(limbs).markers(0.0, flow.Pose(), 0.01) for limbs in (LIMBS[:2], ()))
    extra = 2 * (2 * np.pi * 0.03 * 0.2 + 4 * np.pi * 0.03**2)
    assert skin.weight.sum() - bare.weight.sum() == pytest.approx(extra, rel=1e-3)
    whole = straight().markers(0.0, flow.Pose(), 0.005)
    shown = whole.weight > 0
    far = outside(*whole.points)
    assert np.abs(far[shown]).max() < 5e-4
    assert far[~shown].max() < 5e-4
    assert far[~shown].min() < -0.02
    sunk = (whole.weight == 0).sum()
    assert 0 < sunk < 0.3 * whole.weight.size


def test_attached_pieces_move_with_their_section():
    body, time, dt = bending(), 0.7, 1e-5
    pose = POSE

    def ends(t):
        moved = flow.Pose(
            position=tuple(p + v * (t - time) for p, v in zip(pose.position, pose.velocity, strict=True)),
            angle=pose.angle + pose.spin * (t - time), velocity=pose.velocity, spin=pose.spin,
        )  # fmt: skip
        return body.markers(t, moved, 0.02)

    early, now, late = (ends(time + step) for step in (-dt, 0.0, dt))
    limbs = slice(-2 * (now.points.shape[1] - flow.Trunk.markers(body, time, pose, 0.02).points.shape[1]) // 2, None)
    rate = (late.points - early.points) / (2 * dt)
    assert now.velocities[:, limbs] == pytest.approx(rate[:, limbs], abs=2e-4)
    field_at = now.points[:, limbs][:, 3]
    found = body.measure([np.array([p, p + 0.01]) for p in field_at], time, pose, 0.05)
    told = [float(part[0, 0, 0]) for part in found.velocity]
    assert told == pytest.approx(now.velocities[:, limbs][:, 3].tolist(), abs=1e-9)
    assert found.part_index[0, 0, 0] == 1  # that of its section


def test_the_momentum_of_the_pieces_of_a_bending_body_is_that_of_where_they_go():
    body, time, dt = bending(), 0.8, 1e-4

    def pieces(t):
        whole, bare = body.mass(t), flow.Trunk.mass(body, t)
        return [whole.volume * np.array(getattr(whole, name)) - bare.volume * np.array(getattr(bare, name))
                for name in ("centre", "centre_rate")]  # fmt: skip

    rate = (pieces(time + dt)[0] - pieces(time - dt)[0]) / (2 * dt)
    assert pieces(time)[1] == pytest.approx(rate, rel=1e-4)
    assert np.abs(rate).max() > 1e-4
    assert body.mass(time).moments[2, 2] > flow.Trunk.mass(body, time).moments[2, 2]
    box = body.bounds(time, flow.Pose())
    skin = body.markers(time, flow.Pose(), 0.01)
    assert (skin.points.min(axis=1) >= np.array(box[::2]) - 1e-9).all()
    assert (skin.points.max(axis=1) <= np.array(box[1::2]) + 1e-9).all()


def test_a_ball_beside_the_trunk_adds_its_own_tensor_of_inertia():
    """Two fifths of its mass times its radius squared about each axis, and what its place adds (Steiner)."""
    radius, place = 0.1, np.array([0.5, 0.3, 0.0])
    ball = flow.Capsule(arc_position=0.5, start=(0.0, 0.3), end=(0.0, 0.3), radius=radius)
    whole, trunk = straight((ball,)).mass(0.0), straight(()).mass(0.0)
    volume = 4 / 3 * np.pi * radius**3
    middle = (trunk.volume * np.array(trunk.centre) + volume * place) / (trunk.volume + volume)
    exact = trunk.moments + 0.4 * volume * radius**2 * np.eye(3)
    for size, at in ((trunk.volume, trunk.centre), (volume, place)):
        off = np.array(at) - middle
        exact = exact + size * (off @ off * np.eye(3) - np.outer(off, off))
    assert whole.centre == pytest.approx(middle, rel=3e-3)
    assert whole.moments == pytest.approx(exact, rel=3e-3, abs=1e-6)


def test_a_turning_body_has_the_swirl_of_a_rigid_one():
    """A midline that turns as a whole: the angular momentum is the moment of inertia times the rate."""
    s, spin = np.linspace(0.0, 1.0, 41), 0.7
    zero = np.zeros(41)
    spine = flow.MidlineState(x=s, y=zero, heading=zero, half_width=zero + 0.06, x_rate=zero, y_rate=spin * s,
                       heading_rate=zero + spin)  # fmt: skip
    mass = flow.Limbed(spine=lambda _: spine, half_height=zero + 0.06, limbs=LIMBS).mass(0.0)
    assert mass.swirl == pytest.approx((0.0, 0.0, spin * mass.moments[2, 2]), rel=1e-9)
    assert mass.centre_rate == pytest.approx((-spin * mass.centre[1], spin * mass.centre[0], 0.0), rel=1e-9)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"radius": 0.0}, "radius"),
        ({"arc_position": np.nan}, "arc_position of a capsule is nan"),
        ({"end": (np.inf, 0.0)}, "end of a capsule"),
    ],
)
def test_impossible_capsules_are_refused(fields, said):
    with pytest.raises(InvalidDesign, match=said):
        flow.Capsule(**{"arc_position": 0.3, "start": (0.0, 0.1), "end": (0.1, 0.1), "radius": 0.02} | fields)


def test_a_capsule_beyond_the_trunk_is_refused():
    with pytest.raises(InvalidDesign, match=r"attached at 1\.2 m of a trunk that is 1 m long"):
        straight((flow.Capsule(arc_position=1.2, start=(0.0, 0.1), end=(0.1, 0.1), radius=0.02),))
