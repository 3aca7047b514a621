"""The one gait: what is refused, its named numbers, and what follows from it: control groups, shares, mirror images."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.control.pattern_posture import PatternPosture
from suchus.robot.design import layout, unit_at, value_at, with_values
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import (
    NUMBERS,
    Bend,
    Curve,
    FixedLimbs,
    FootPath,
    Gait,
    Sweep,
    check_limits,
    cycle_targets,
    hip_height,
    intended,
    middle_stance,
)
from suchus.robot.robots import ROBOTS

BODIES = ("caiman", "pleurobot", "salamander", "salamandra", "strider", "swimmer")
SALAMANDER, WALK, FILMED = ROBOTS["salamander"], GAITS["salamander_walk"], GAITS["animal_walk"]
CLOCK = np.linspace(0.0, 1.0, 27)
SHELF = [pytest.param(GAITS[name], id=name) for name in GAITS]


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: replace(WALK, limb_phases=(0.0, 0.5)), "2 limb phases for 2 girdles"),
        (lambda: replace(WALK, limb_phases=(0.0, 0.5, 0.5, 7.0)), "-1 to 1 cycle is allowed"),
        (lambda: replace(WALK, coupling=(0.0,)), "1 phases of coupling for 4 limbs"),
        (lambda: replace(WALK, period=0.0), r"gait.period is 0 s"),
        (lambda: replace(WALK, duty_factor=1.0), r"gait.duty_factor is 1"),
        (lambda: replace(WALK, period=float("nan")), r"gait.period is nan"),
        (lambda: replace(WALK, height=-0.1), r"gait.height is -0.1 limb reach"),
        (lambda: replace(WALK, name=float("-inf")), r"gait.name"),
        (lambda: replace(WALK.limbs[0], stroke=2.0), r"foot_path.stroke is 2 limb reach"),
        (lambda: replace(WALK.limbs[0], stroke=10**400), r"foot_path.stroke"),
        (lambda: Bend(part="trunk", amplitude=()), r"bend.amplitude is \(\); 1 to 100 numbers"),
        (lambda: Bend(part="trunk", lag=(float("nan"),)), r"bend.lag is"),
        (lambda: Bend(part="nose"), r"bend.part"),
        (lambda: Sweep(stance=7.0, down=0.0), r"sweep.stance is 7 rad"),
        (lambda: replace(FILMED, curves=2 * FILMED.curves[:1]), "two curves for neck_yaw_1"),
        (lambda: Curve(servo="a", part="limb", angles=()), "1 to 1000 are allowed"),
        (lambda: Curve(servo="a", part="limb", angles=(float("nan"),)), "-6.28 to 6.28 rad is allowed"),
        (lambda: Curve(servo="a", part="limb", angles=(7.0,)), "-6.28 to 6.28 rad is allowed"),
    ],
)
def test_an_impossible_gait_is_refused(make, says):
    with pytest.raises(InvalidDesign, match=says):
        make()


# measured curves


@pytest.mark.parametrize("count", [5, 6, 13])
def test_a_harmonic_is_met_everywhere_not_only_at_the_samples(count):
    clock, phase = np.linspace(-1.0, 2.0, 31), np.arange(count) / count

    def wave(t):
        return 0.2 + 0.5 * np.cos(2 * np.pi * t) - 0.3 * np.sin(4 * np.pi * t)

    curve = Curve(servo="a", part="limb", angles=tuple(wave(phase)))
    assert curve.angle_at(clock) == pytest.approx(wave(clock), abs=1e-12)
    assert curve.lagged(0.3).angle_at(clock) == pytest.approx(wave(clock - 0.3), abs=1e-12)


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-3, 3), min_size=1, max_size=20))
def test_a_curve_passes_through_its_samples_and_repeats(angles):
    curve, phase = Curve(servo="a", part="limb", angles=tuple(angles)), np.arange(len(angles)) / len(angles)
    assert curve.angle_at(phase) == pytest.approx(np.array(angles), abs=1e-9)
    assert curve.angle_at(phase + 3.0) == pytest.approx(curve.angle_at(phase), abs=1e-9)


def test_servos_without_a_curve_stay_at_zero_and_before_the_start_nothing_moves():
    servos = layout(SALAMANDER).servos
    nod = Curve(servo="neck_yaw_1", part="neck", angles=(0.1, 0.0, -0.1, 0.0))
    gait = Gait(name="nod", period=2.0, limb_phases=(0.0,) * 4, curves=(nod,))
    angles = intended(SALAMANDER, gait, np.array([0.0, 1.0, 1.5, 2.0])).targets
    assert angles[:, servos.index("neck_yaw_1")] == pytest.approx([0.1, 0.1, 0.0, -0.1], abs=1e-12)
    assert np.abs(np.delete(angles, servos.index("neck_yaw_1"), axis=1)).max() == 0.0


def test_a_curve_stands_in_the_place_of_what_limbs_and_axis_say():
    servos = layout(SALAMANDER).servos
    still = replace(WALK, curves=(Curve(servo="spine_yaw_1", part="trunk", angles=(0.05,)),))
    angles, before = cycle_targets(SALAMANDER, still, CLOCK), cycle_targets(SALAMANDER, WALK, CLOCK)
    column = servos.index("spine_yaw_1")
    assert angles[:, column] == pytest.approx(0.05)
    assert np.delete(angles, column, axis=1) == pytest.approx(np.delete(before, column, axis=1))


def test_in_the_middle_of_stance_limbs_are_where_their_curves_have_them_and_the_axis_is_straight():
    place, still = layout(SALAMANDER), middle_stance(SALAMANDER, FILMED)
    assert np.abs(still[list(place.axial_yaw)]).max() == 0.0
    limb, curves = place.limbs[0], {curve.servo: curve for curve in FILMED.curves}
    clock = 1.0 - FILMED.duty_factor / 2 - FILMED.limb_phases[0]
    assert still[limb.servos] == pytest.approx([float(curves[place.servos[i]].angle_at(clock)) for i in range(4)])
    assert hip_height(SALAMANDER, FILMED) == 0.0


def test_curves_for_others_are_refused():
    with pytest.raises(OutsideLimits, match="phases for 4 limbs; robot 'strider' has 6"):
        check_limits(ROBOTS["strider"], FILMED)
    with pytest.raises(UnknownName, match="servo of robot 'salamander' named 'neck'"):
        check_limits(SALAMANDER, replace(FILMED, curves=(Curve(servo="neck", part="neck", angles=(0.0,)),)))
    with pytest.raises(OutsideLimits, match=r"neck_yaw_1 of robot 'salamander' for 2\.000 rad"):
        check_limits(SALAMANDER, replace(FILMED, curves=(Curve(servo="neck_yaw_1", part="neck", angles=(2.0,)),)))


def test_who_steers_refuses_measured_curves_in_a_sentence():
    assert not FILMED.has("steering")
    with pytest.raises(OutsideLimits, match="steering needs a gait of foot paths and bends"):
        FILMED.needs_steering("steering")
    with pytest.raises(OutsideLimits, match="'animal_walk' has measured curves"):
        PatternPosture(SALAMANDER, FILMED, standing=True)


# what follows from a gait


@pytest.mark.parametrize("gait", SHELF)
def test_a_share_of_one_and_a_lag_of_nothing_change_nothing(gait):
    assert gait.strode(1.0) == gait
    assert gait.bent(1.0) == gait
    assert gait.lagged(0.0) == gait


@pytest.mark.parametrize("name", BODIES[1:-1])
def test_what_is_held_straight_bends_no_more_and_the_rest_as_before(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    place, whole = layout(robot), cycle_targets(robot, default_gait(robot), CLOCK)
    ahead = [i for i in place.axial_yaw if i not in place.tail_yaw]
    for parts, still in ((("axis",), (True, True)), (("neck", "trunk"), (True, False)), (("tail",), (False, True))):
        held = cycle_targets(robot, gait.straightened(*parts), CLOCK)
        for servos, straight in zip((ahead, list(place.tail_yaw)), still, strict=True):
            expected = 0.0 * whole[:, servos] if straight else whole[:, servos]
            assert held[:, servos] == pytest.approx(expected, abs=1e-12)
        limbs = [i for limb in place.limbs for i in range(limb.servos.start, limb.servos.stop)]
        assert (held[:, limbs] == whole[:, limbs]).all()


def test_control_groups_differ_in_nothing_but_the_part_that_they_lack():
    crawl = GAITS["belly_crawl"]
    assert crawl.without("axis", name="limbs_only") == GAITS["limbs_only"]
    assert crawl.without("tail").without("trunk") == crawl.without("axis")
    assert crawl.without("axis").limbs == crawl.limbs
    assert crawl.without("axis").number("tail_pitch") == 0.2  # a steady bend stays
    assert crawl.lifted(-0.25).number("tail_pitch") == -0.25
    assert crawl.without("limbs").axis == crawl.axis
    feet = cycle_targets(ROBOTS["caiman"], crawl.without("limbs"), CLOCK)[:, :12]
    assert np.ptp(feet, axis=0).max() < 1e-12


def test_limbs_without_motion_stand_in_the_middle_of_their_stance():
    for name in BODIES[:-1]:
        robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
        place = layout(robot)
        limbs = [i for limb in place.limbs for i in range(limb.servos.start, limb.servos.stop)]
        still = cycle_targets(robot, gait.without("limbs"), np.array([0.3]))[0, limbs]
        middle = middle_stance(robot, gait)[limbs]
        assert np.exp(1j * still) == pytest.approx(np.exp(1j * middle), abs=1e-9)  # a crank may be turns away


def test_measured_curves_are_straightened_shrunk_and_shifted_too():
    place, clock = layout(SALAMANDER), np.arange(26) / 26
    yaw = list(place.axial_yaw)
    assert abs(cycle_targets(SALAMANDER, FILMED.without("axis"), clock)[:, yaw]).max() == 0.0
    late, before = FILMED.lagged(0.5), cycle_targets(SALAMANDER, FILMED, clock - 0.5)
    assert cycle_targets(SALAMANDER, late, clock)[:, yaw] == pytest.approx(before[:, yaw], abs=1e-9)
    half = cycle_targets(SALAMANDER, FILMED.bent(0.5), clock)
    assert half[:, yaw] == pytest.approx(0.5 * cycle_targets(SALAMANDER, FILMED, clock)[:, yaw], abs=1e-12)
    assert not FILMED.has("strokes")


def test_a_whole_axis_is_straightened_whole_or_refused():
    wave = GAITS["undulation"]
    assert not wave.straightened().has("wave")
    with pytest.raises(OutsideLimits, match="bends the whole axis as one part"):
        wave.straightened("tail")


@settings(max_examples=30)
@given(st.sampled_from([name for name in GAITS if not GAITS[name].curves]), st.floats(0.0, 1.0))
def test_a_mirror_image_mirrors_every_servo(name, clock):
    gait = GAITS[name]
    robot = next(ROBOTS[body] for body in (*GAITS.beside(name, "made_for", ()), "caiman") if body in ROBOTS)
    place = layout(robot)
    there = cycle_targets(robot, gait, np.array(clock))
    back = cycle_targets(robot, gait.mirrored(), np.array(clock))
    for limb in place.limbs:
        other = place.limbs[limb.contralateral]
        assert np.exp(1j * there[limb.servos]) == pytest.approx(np.exp(1j * back[other.servos]), abs=1e-9)
    yaw, pitch = [*place.axial_yaw, *place.cables], list(place.axial_pitch)
    assert there[yaw] == pytest.approx(-back[yaw], abs=1e-12)
    assert there[pitch] == pytest.approx(back[pitch], abs=1e-12)
    assert gait.mirrored().mirrored().limb_phases == gait.limb_phases


def test_a_bound_is_mirrored_though_its_limbs_are_not_in_turn():
    bound = replace(GAITS["belly_crawl"], limb_phases=(0.0, 0.0, 0.5, 0.5), coupling=())
    robot, place = ROBOTS["caiman"], layout(ROBOTS["caiman"])
    there, back = (cycle_targets(robot, gait, CLOCK) for gait in (bound, bound.mirrored()))
    assert there[:, list(place.trunk_yaw)] == pytest.approx(-back[:, list(place.trunk_yaw)], abs=1e-12)
    with pytest.raises(OutsideLimits, match="cannot be mirrored"):
        FILMED.mirrored()


# named numbers


@pytest.mark.parametrize("gait", SHELF)
@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_that_is_written_is_read_again_and_writing_what_stands_changes_nothing(gait, name):
    if name not in gait.numbers():
        with pytest.raises(OutsideLimits, match=f"nothing that '{name}' could change"):
            gait.with_numbers(**{name: 0.5})
        return
    assert gait.with_numbers(**{name: gait.number(name)}).number(name) == pytest.approx(gait.number(name), abs=1e-12)
    assert gait.with_numbers(**{name: 0.3}).number(name) == pytest.approx(0.3)


def test_a_number_of_all_limbs_keeps_their_proportion_and_a_lag_that_of_the_parts():
    crawl = GAITS["belly_crawl"]
    front, hind = crawl.limbs
    longer = crawl.with_numbers(stroke=2.0 * front.stroke)
    assert [path.stroke for path in longer.limbs] == pytest.approx([2.0 * front.stroke, 2.0 * hind.stroke])
    assert crawl.with_numbers(ahead=0.1).limbs[1].ahead == 0.1  # both were zero
    late = crawl.with_numbers(axis_lag=0.2)
    assert (late.axis[0].lag, late.axis[1].lag) == ((0.2,), (0.7,))
    assert late.number("tail_lag") == pytest.approx(0.5)
    assert late.with_numbers(tail_lag=0.25).axis[1].lag[0] == pytest.approx(0.45)
    bent = GAITS["salamander_walk"].with_numbers(tail_bend=0.1).axis[1].amplitude
    was = GAITS["salamander_walk"].axis[1].amplitude
    assert np.array(bent) / np.array(was) == pytest.approx(0.1 / np.mean(was))


def test_numbers_are_addressed_like_fields_by_studies_and_searches():
    crawl = GAITS["belly_crawl"]
    changed = with_values(crawl, {"stroke": 0.2, "limbs[1].ahead": 0.05, "tail_pitch": 0.1, "period": 3.0})
    assert changed.limbs[0].stroke == 0.2
    assert changed.limbs[1].ahead == 0.05
    assert (changed.period, changed.number("tail_pitch")) == (3.0, 0.1)
    assert value_at(crawl, "trunk_bend") == pytest.approx(np.radians(70))
    assert value_at(crawl, "limbs[0].outward") == crawl.limbs[0].outward
    assert unit_at(crawl, "stroke") == "limb reach"
    assert unit_at(crawl, "axis_lag") == "cycle"
    assert unit_at(crawl, "period") == "s"
    with pytest.raises(UnknownName, match="'strok'"):
        value_at(crawl, "strok")
    with pytest.raises(UnknownName, match="number of a gait"):
        crawl.with_numbers(strok=1.0)


def test_abilities_say_what_a_gait_has():
    held = replace(WALK, limbs=(FixedLimbs(angles=()),) * 2)
    names = ("belly_crawl", "salamandra_walk", "undulation", "animal_walk")
    assert [GAITS[name].has("foot paths") for name in names] == [True, False, False, False]
    assert GAITS["salamandra_walk"].has("strokes")
    assert not held.has("strokes")
    assert not replace(WALK, limbs=(FootPath(stroke=0.0, lift=0.1, outward=0.5),) * 2).has("strokes")
    assert GAITS["belly_crawl"].has("tail pitch")
    assert not WALK.has("tail pitch")
    assert not GAITS["limbs_only"].has("wave")
