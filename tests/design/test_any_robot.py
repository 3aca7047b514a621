"""Any robot as data: what is refused, how it is laid out, and how it scales."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, UnknownName, UnsuitedRobot
from suchus.robot import blueprint
from suchus.robot.design import (
    Cable,
    Hinge,
    Inertia,
    Robot,
    Spring,
    check_needs,
    crocodile,
    layout,
    servo_names,
    servo_ranges,
)
from suchus.robot.design.body import servos_of
from suchus.robot.design.scale import check_step, control_period, gravity_time, physics_step, rescale, servo_for
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

CAIMAN, SALAMANDER, STRIDER = ROBOTS["caiman"], ROBOTS["salamander"], ROBOTS["strider"]
BODY = CAIMAN
SMALL = rescale(BODY, length_factor=0.1)
STRONG = replace(SMALL.axis[5].hinges[0], drive=CAIMAN.tail.pitch_servo)


def with_segment(body, segment, **changes):
    return replace(body, axis=tuple(replace(s, **changes) if s.name == segment else s for s in body.axis))


def with_cable(body, **changes):
    return replace(body, cables=(replace(body.cables[0], **changes),))


def with_girdle(body, number, **changes):
    girdles = list(body.girdles)
    girdles[number] = replace(girdles[number], **changes)
    return replace(body, girdles=tuple(girdles))


def short(limb):
    return replace(limb, links=tuple(replace(link, end=tuple(0.1 * x for x in link.end)) for link in limb.links))


BAD = {
    "a girdle off its segment": (
        lambda: with_girdle(BODY, 0, at=2.0),
        r"girdle F sits 2 m along segment thorax.*do not join",
    ),
    "a girdle on nothing": (lambda: with_girdle(BODY, 0, segment="chest"), r"'chest', no segment of the axis"),
    "a shape off its segment": (
        lambda: with_segment(
            BODY, "spine_1", shapes=(replace(BODY.axis[4].shapes[0], start=(1.0, 0, 0), end=(1.1, 0, 0)),)
        ),
        r"along segment spine_1.*do not join",
    ),
    "a limb that does not reach the ground": (
        lambda: with_girdle(BODY, 1, limb=short(BODY.girdles[1].limb)),
        r"limb H reaches .* cannot reach the ground",
    ),
    "a cable with a gap": (
        lambda: with_cable(BODY, hinges=("tail_yaw_1", "tail_yaw_3")),
        r"tail_yaw_1, tail_yaw_3, which do not follow each other",
    ),
    "a cable over two turns": (
        lambda: with_cable(BODY, hinges=("fin_yaw_1", "fin_pitch_1")),
        r"do not follow each other along the axis as hinges of one turn",
    ),
    "a cable over what is not there": (lambda: with_cable(BODY, hinges=("tail_yaw_9",)), r"tail_yaw_9, no hinge"),
    "two drives": (
        lambda: with_segment(
            BODY, "tail_root", hinges=(replace(BODY.axis[6].hinges[0], drive=CAIMAN.tail.pitch_servo),)
        ),
        r"hinge tail_yaw_1 has two drives, cable tail_cable and a servo of its own",
    ),
    "two cables on a hinge": (
        lambda: replace(BODY, cables=(*BODY.cables, replace(BODY.cables[0], name="second", hinges=("tail_yaw_2",)))),
        r"hinge tail_yaw_2 has two drives, cable second and cable tail_cable",
    ),
    "a mass like a mountain's": (
        lambda: replace(BODY.axis[0].shapes[0], mass=1e9),
        r"mass is 1e\+09 kg; 1e-08 to 100000 kg is allowed",
    ),
    "a length like an atom's": (lambda: replace(BODY.girdles[0].limb.foot, radius=1e-10), r"radius is 1e-10 m"),
    "four hinges in a joint": (
        lambda: with_segment(BODY, "tail_root", hinges=4 * BODY.axis[6].hinges),
        r"has 4 hinges at its rear; up to 3 are allowed",
    ),
    "hinges behind the tip": (
        lambda: with_segment(
            BODY, "tail_9", hinges=(Hinge(name="x", turn="yaw", range=(-1, 1), drive=CAIMAN.tail.pitch_servo),)
        ),
        r"segment tail_9 is the last one",
    ),
    "a root elsewhere": (lambda: replace(BODY, root="thorax"), r"root in the hindmost girdle's segment, 'pelvis'"),
    "girdles in the wrong order": (lambda: replace(BODY, girdles=BODY.girdles[::-1]), r"from the front to the hind"),
    "a trunk's hinge by another name": (
        lambda: with_segment(BODY, "spine_1", hinges=(replace(BODY.axis[4].hinges[0], name="waist"),)),
        r"yaw hinges between root and foremost girdle are .*waist",
    ),
    "equal names": (
        lambda: with_segment(BODY, "tail_3", name="tail_2"),
        r"several segments or links are called tail_2",
    ),
    "servos of a larger robot": (
        lambda: with_segment(SMALL, "pelvis", hinges=(STRONG,)),
        r"armature of 0.015 kg m2, .*belongs to a larger robot",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_bad_body_is_refused_in_one_sentence(name):
    make, says = BAD[name]
    with pytest.raises(InvalidDesign, match=says) as refusal:
        make()
    assert "\n" not in str(refusal.value)


def test_a_crank_has_no_range_and_any_other_hinge_needs_one():
    servo = CAIMAN.tail.pitch_servo
    with pytest.raises(InvalidDesign, match="range"):
        Hinge(name="x", turn="yaw", drive=servo)
    crank = ROBOTS["salamandra"].girdles[0].limb.hinges[0]
    assert crank.range is None
    with pytest.raises(InvalidDesign, match="turns all round: remove its range"):
        replace(crank, range=(-1.0, 1.0))


def test_the_caimans_order_is_that_of_its_goldens():
    place = layout(CAIMAN)
    assert place.servos == servo_names()
    assert [place.servos[i] for i in place.trunk_yaw] == ["spine_yaw_1", "spine_yaw_2", "spine_yaw_3"]
    assert [place.servos[i] for i in place.trunk_pitch] == ["spine_pitch_1", "spine_pitch_2"]
    assert [place.servos[i] for i in (*place.tail_pitch, *place.cables)] == ["tail_pitch", "tail_cable"]
    assert place.limb("RH").servos == slice(9, 12)
    with pytest.raises(UnknownName, match="there is no limb named 'LM'"):
        place.limb("LM")
    assert BODY.mass == pytest.approx(CAIMAN.mass, rel=1e-14)
    assert BODY.length == pytest.approx(CAIMAN.length, rel=1e-14)


def test_limbs_know_their_neighbours():
    names = layout(CAIMAN).limb_names
    lf = layout(CAIMAN).limb("LF")
    assert (names[lf.contralateral], [names[i] for i in lf.ipsilateral], [names[i] for i in lf.diagonal]) == (
        "RF", ["LH"], ["RH"],
    )  # fmt: skip
    names = layout(STRIDER).limb_names
    rm = layout(STRIDER).limb("RM")
    assert names == ("LF", "RF", "LM", "RM", "LH", "RH")
    assert (names[rm.contralateral], [names[i] for i in rm.ipsilateral], [names[i] for i in rm.diagonal]) == (
        "LM", ["RF", "RH"], ["LF", "LH"],
    )  # fmt: skip


@pytest.mark.parametrize("name", list(ROBOTS))
def test_every_hinge_and_servo_has_one_place(name):
    place = layout(ROBOTS[name])
    assert len(set(place.hinges)) == len(place.hinges)
    driven = {i for i in place.servo_hinges if i >= 0}
    assert driven | set(place.passive) == set(range(len(place.hinges)))
    assert not driven & set(place.passive)
    limbs = [i for limb in place.limbs for i in range(limb.hinges.start, limb.hinges.stop)]
    axis = [
        *range(place.forward_hinges.start, place.forward_hinges.stop),
        *range(place.backward_hinges.start, place.backward_hinges.stop),
    ]
    assert limbs + axis == list(range(len(place.hinges)))
    assert list(place.axial_positions) == sorted(place.axial_positions)
    assert servo_ranges(ROBOTS[name]).shape == (len(place.servos), 2)


def test_a_field_of_another_kind_is_named_once():
    with pytest.raises(
        InvalidDesign, match=r"^tail\.drive is object; 'cable' or 'linear_actuator' or 'servos' is needed\.$"
    ):
        replace(CAIMAN.tables.tail, drive=object)


def test_who_needs_a_chain_that_a_robot_lacks_says_so():
    chains = ("legs", "shells", "article_spine", "cable_tail")
    assert check_needs(CAIMAN, chains, "it") is CAIMAN
    with pytest.raises(UnsuitedRobot, match=r"standing up needs four legs of yaw, pitch and knee.*'salamander'"):
        check_needs(SALAMANDER, chains, "standing up")
    six = crocodile(replace(CAIMAN.tables, spine=replace(CAIMAN.tables.spine, joints=6)))
    with pytest.raises(UnsuitedRobot, match=r"needs the article's spine of 5 joints"):
        check_needs(six, chains, "standing up")
    servos = crocodile(replace(CAIMAN.tables, tail=replace(CAIMAN.tables.tail, drive="servos")))
    with pytest.raises(UnsuitedRobot, match="the article's tail with a cable"):
        check_needs(servos, chains, "standing up")
    assert "tail_yaw_6" in servo_names(servos)


@given(factor=st.floats(0.2, 5.0), heavier=st.floats(1e-2, 1e2))
def test_scaling_there_and_back_is_nothing(factor, heavier):
    servo = CAIMAN.hind_leg.servo
    back = rescale(
        rescale(servo, length_factor=factor, mass_factor=heavier), length_factor=1 / factor, mass_factor=1 / heavier
    )
    for name in ("kp", "kd", "torque", "speed", "armature", "friction", "damping"):
        assert getattr(back, name) == pytest.approx(getattr(servo, name), rel=1e-9)


def test_each_unit_scales_by_its_powers():
    big = rescale(CAIMAN.hind_leg.servo, length_factor=4.0, mass_factor=10.0)
    own = CAIMAN.hind_leg.servo
    assert big.torque == pytest.approx(40 * own.torque)  # N m: mass times length
    assert big.speed == pytest.approx(own.speed / 2)  # rad/s: one over the root of the length
    assert big.armature == pytest.approx(160 * own.armature)
    assert big.kd == pytest.approx(80 * own.kd)
    gait = rescale(GAITS["belly_crawl"], length_factor=4.0)
    assert gait.period == pytest.approx(2 * GAITS["belly_crawl"].period)
    assert (gait.limbs, gait.axis) == (GAITS["belly_crawl"].limbs, GAITS["belly_crawl"].axis)  # shares and angles
    spring = rescale(Spring(stiffness=1.0, damping=1.0, armature=1.0), length_factor=4.0, mass_factor=1.0)
    assert (spring.stiffness, spring.damping, spring.armature) == pytest.approx((4.0, 8.0, 16.0))
    with pytest.raises(InvalidDesign, match=r"scaled.length_factor is 0"):
        rescale(CAIMAN, length_factor=0.0)


def test_the_rules_give_back_the_servo_that_the_articles_robot_had_before_it_was_bought():
    former = blueprint.read_design(Path(__file__).parents[2] / "examples" / "former_caiman.toml", Robot, ROBOTS)
    rule, own = servo_for(CAIMAN.mass, CAIMAN.length), former.hind_leg.servo
    for name in ("kp", "kd", "torque", "speed", "armature", "damping"):
        assert getattr(rule, name) == pytest.approx(getattr(own, name), rel=0.1), name


def test_a_motor_in_another_size_is_as_warm_and_none_that_is_sold():
    """Its power grows as the body's weight times its speed, and its thermal resistance falls as much."""
    own, small = CAIMAN.hind_leg.servo.winding, servos_of(rescale(BODY, length_factor=0.25))["LH_knee"].winding
    power = 0.25**3 * 0.25**0.5  # weight times speed
    assert (own.motor, small.motor, small.volts) == ("STS3250", "", own.volts)
    assert small.stall_current == pytest.approx(power * own.stall_current)
    for share in (0.01, 0.02):
        loss = share * own.volts * own.stall_current
        assert small.heat.steady_temperature(power * loss) == pytest.approx(own.heat.steady_temperature(loss))


@pytest.mark.parametrize(("length", "period"), [(0.1, 0.005), (0.5, 0.01), (1.01, 0.01), (3.0, 0.02)])
def test_the_time_step_follows_the_length(length, period):
    robot = rescale(BODY, length_factor=length / BODY.length)
    assert control_period(robot) == period
    assert gravity_time(length) / 640 < physics_step(robot) < gravity_time(length) / 20
    check_step(robot, physics_step(robot))
    with pytest.raises(InvalidDesign, match=r"needs at most .* a twentieth"):
        check_step(robot, gravity_time(length) / 15)


def test_cable_hinges_are_named_at_least_once():
    with pytest.raises(InvalidDesign, match="bends no hinge"):
        Cable(name="c", hinges=(), cord_spacing=0.1, pulley=0.1, bend_limit=1.0, servo=CAIMAN.tail.cable_servo)


def test_ranges_of_cranks_are_endless():
    ranges = servo_ranges(ROBOTS["salamandra"])
    cranks = [i for i, name in enumerate(servo_names(ROBOTS["salamandra"])) if name.endswith("crank")]
    assert np.isinf(ranges[cranks]).all()
    assert np.isfinite(np.delete(ranges, cranks, axis=0)).all()


TENSOR = Inertia(centre=(0.001, 0.0005, -0.0003), moments=(3e-7, 5e-7, 6e-7), products=(1e-8, -2e-8, 3e-8))


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"moments": (1.0, 1.0, 2.1)}, "which no body has: each must be positive and at most the sum of the other two"),
        ({"products": (0.0, 6e-7, 0.0)}, "which no body has"),
        ({"moments": (-1e-7, 5e-7, 6e-7)}, r"moments\[0\] is -1e-07 kg m2"),
        ({"centre": (0.0, float("nan"), 0.0)}, r"centre\[1\] is nan m"),
        ({"moments": (1.0, 1.0)}, "xx, yy, zz need one each"),
    ],
)
def test_an_inertia_that_no_body_has_is_refused(wrong, told):
    with pytest.raises(InvalidDesign, match=told):
        replace(TENSOR, **wrong)
    assert replace(TENSOR, moments=(1.0, 1.0, 2.0)).tensor[2, 2] == 2.0  # a flat disc is a body


def test_an_inertia_of_a_link_is_mirrored_on_the_right_and_scales_with_mass_and_length():
    first, *others = SALAMANDER.girdles[0].limb.links
    limb = replace(SALAMANDER.girdles[0].limb, links=(replace(first, inertia=TENSOR), *others))
    robot = with_girdle(SALAMANDER, 0, limb=limb)
    left, right = (body.inertia for body in layout(robot).bodies if body.inertia is not None)
    assert left == TENSOR
    flip = np.diag([1.0, -1.0, 1.0])
    np.testing.assert_array_equal(right.tensor, flip @ TENSOR.tensor @ flip)
    assert right.centre == (0.001, -0.0005, -0.0003)
    double = rescale(robot, length_factor=2.0).girdles[0].limb.links[0].inertia
    np.testing.assert_allclose(double.tensor, 32 * TENSOR.tensor)
    assert double.centre == (0.002, 0.001, -0.0006)
