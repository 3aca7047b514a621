from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from evidence.league import find, swims
from evidence.league.cases import CONTESTANTS, alligator_slope, amphibot, swimming_law
from evidence.league.swims import LEAST_TICKS, ModelSwimmer, SwimTask, _coasting, _from_rest, _lake, held_swim, theory
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.control import Swimming
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.pieces import masses, volumes
from suchus.robot.design.scale import control_period, servo_for
from suchus.robot.design.water import Water
from suchus.robot.motion.swim import straight_gait, swimming_gait
from suchus.robot.robots._animals import pleurodeles
from suchus.sim.land import Run, simulate
from suchus.swimming.water import Outline, reactive, resistive, undulation
from suchus.swimming.water.slender import Effort

ROW = Drawing(
    name="rod",
    length=0.6,
    mass=1.0,
    density=990.0,
    stations=(0.0, 0.05, 0.95, 1.0),
    half_width=(0.02, 0.035, 0.035, 0.03),
    half_height=(0.02, 0.04, 0.04, 0.04),
    joints=(0.25, 0.5, 0.75),
)


@pytest.mark.parametrize(("length", "mass", "density"), [(0.05, 4e-4, 900.0), (0.6, 1.0, 990.0), (3.0, 100.0, 1050.0)])
def test_a_drawing_gets_its_length_mass_and_volume_at_any_size(length, mass, density):
    robot = replace(ROW, length=length, mass=mass, density=density).robot()
    assert robot.length == pytest.approx(length)
    assert robot.mass == pytest.approx(mass)
    assert sum(volumes(robot).values()) == pytest.approx(mass / density)
    outline = Outline(robot, 257)
    high, wide = outline.silhouette.half_height, outline.silhouette.half_width
    assert high[-1] / high[128] == pytest.approx(1.0, abs=0.06)  # the trailing edge is as high as it is drawn
    np.testing.assert_allclose(high[20:-20], 0.04 / 0.035 * wide[20:-20], rtol=0.02)


@pytest.mark.parametrize(
    "change", [{"stations": (0.0, 1.0)}, {"half_width": (0.02,) * 3 + (0.6,)}, {"joints": (0.7, 0.5)}]
)
def test_a_drawing_that_cannot_be_is_refused(change):
    with pytest.raises(InvalidDesign):
        replace(ROW, **change)


@pytest.mark.parametrize(("ticks", "refused"), [(LEAST_TICKS, False), (LEAST_TICKS - 1, True)])
def test_sections_have_no_word_of_a_beat_that_servos_cannot_be_commanded(ticks, refused, monkeypatch):
    robot = ROW.robot()

    def build(numbers, frequency):
        return ModelSwimmer(robot=robot, gait=straight_gait(robot, frequency=1.0 / (ticks * control_period(robot))))

    monkeypatch.setattr(swims, "sections", lambda swimmers, **_: [swims._NO_SWIM] * len(swimmers))
    monkeypatch.setattr(swims, "_sound", lambda *_: {"speed": 1.0})
    asked = SwimTask(build=build, read_quantities=lambda *_: {})
    if refused:
        with pytest.raises(OutsideLimits, match=r"15 times a cycle at .* Hz; 16 are needed"):
            swims._by_sections(asked, [{}], lambda *_: None)
    else:
        assert swims._by_sections(asked, [{}], lambda *_: None) == [{"speed": 1.0}]


def test_from_rest_follows_the_exact_solution_of_square_drag():
    """Constant thrust T and drag c U^2: U = sqrt(T / c) tanh(t sqrt(T c) / m), its mean over time a logarithm."""
    robot = ROW.robot()
    swimmer = ModelSwimmer(robot=robot, gait=straight_gait(robot, frequency=1.0))
    push, rub = 0.5, 2.0
    last, rate = (push / rub) ** 0.5, (push * rub) ** 0.5 / robot.mass

    def model(outline, curve, speed, water):
        return Effort(push - rub * speed * abs(speed), 0.0)

    outline = Outline(robot, 33)
    found = _from_rest(outline, undulation(outline, swimmer.gait), model, swimmer, last, periods=4)
    ends = np.arange(5)
    exact = last / rate * np.diff(np.log(np.cosh(rate * ends)))
    np.testing.assert_allclose(found, exact, rtol=0.03)


def test_a_straight_body_coasts_as_its_friction_says_and_a_bent_one_stops_sooner():
    robot, speed = ROW.robot(), 0.5
    straight = ModelSwimmer(robot=robot, gait=straight_gait(robot, frequency=2.0), water=Water(), ramp=0.0)
    (found,) = _coasting([straight], [speed], lambda *_: None)
    outline = Outline(robot, 257)
    wide, high = outline.silhouette
    girth = np.pi * (3 * (wide + high) - np.sqrt((3 * wide + high) * (wide + 3 * high)))
    nose = 0.1 * np.pi * wide.max() * high.max()
    ends = [
        0.5 * Water().density * (Water().friction(u, robot.length) * np.trapezoid(girth, outline.s) + nose) / robot.mass
        for u in (speed, 0.3 * speed)
    ]
    assert 0.95 * ends[0] < found < 1.05 * ends[1]
    bent = replace(straight, gait=_waving(robot))
    (stops,) = _coasting([bent], [speed], lambda *_: None)
    assert stops > 1.5 * found
    assert theory(resistive, bent, coasts=True).coast > 1.5 * theory(reactive, bent, coasts=True).coast


def _waving(robot):
    return swimming_gait(robot, name="wave", frequency=2.0, amplitude=[0.5] * 3, lag=[0.0, 0.2, 0.4])


def test_a_frequency_is_found_that_holds_a_speed():
    one = find(CONTESTANTS, "catshark_2")
    asked = one.rungs["resistive"].work.args[1]
    swimmer, swum = held_swim(asked, one.likely, partial(theory, resistive))
    assert swum.speed == pytest.approx(2.0 * one.likely["length"])
    free = asked.build(one.likely, swum.frequency)
    again = theory(resistive, replace(free, gait=free.gait.bent(swimmer.bend)))
    assert again.speed == pytest.approx(swum.speed, rel=0.02)


def test_a_salamander_has_its_own_length_mass_and_volume_and_its_parts_float_alike():
    robot = pleurodeles(0.176, 0.0163, 900.0, 0.25, beat=3.8)
    assert robot.length == pytest.approx(0.176)
    assert robot.mass == pytest.approx(0.0163)
    volume, weight = volumes(robot), masses(robot)
    assert robot.mass / sum(volume.values()) == pytest.approx(900.0, rel=1e-6)
    for segment in robot.axis:
        assert weight[segment.name] / volume[segment.name] == pytest.approx(900.0, rel=0.35)


def test_on_a_slope_the_ground_pushes_with_the_part_of_the_weight_that_lies_along_it():
    """Whatever the gait: a steady walk is not accelerated."""
    found = alligator_slope._walk("high_walk", {"length": 1.0, "friction": 0.8}, lambda *_: None)
    assert found["push_up"] == pytest.approx(np.sin(np.radians(15.0)), rel=0.05)
    assert found["push_down"] == pytest.approx(-np.sin(np.radians(15.0)), rel=0.05)
    assert found["cadence_down"] < 1.0 < found.get("cadence_up", 3.0)


def test_in_thin_water_drag_with_the_square_gives_the_turbulent_exponent():
    """Without friction that depends on the Reynolds number all forces go with the square: Re is proportional to Sw."""
    numbers = {"cross_drag": 1.1, "thickening": 1e-6, "thick": 1e-4, "thin": 1e-7, "sample": 0.0}
    (found,) = swimming_law.law(resistive, [numbers], lambda *_: None)
    assert found["turbulent"] == pytest.approx(found["laminar"], abs=1e-3)


@pytest.mark.parametrize(("made", "follows"), [(None, True), (servo_for, False)])
def test_a_servo_that_holds_the_water_follows_within_two_degrees_and_one_by_weight_swings_on(made, follows):
    """AmphiBot's motors follow within 2 degrees; a servo in proportion to the weight overshoots in its body."""
    one = amphibot.build(find(CONTESTANTS, "amphibot").likely, None)
    if made is not None:
        servo = made(one.robot.mass, one.robot.length)
        hinges = {hinge.name: replace(hinge, drive=servo) for hinge in one.robot.axis_hinges}
        axis = [replace(part, hinges=tuple(hinges[each.name] for each in part.hinges)) for part in one.robot.axis]
        one = replace(one, robot=replace(one.robot, axis=tuple(axis)))
    run = Run(robot=one.robot, gait=one.gait, lake=_lake(one), control=Swimming(ramp=0.3))
    record = simulate([run], duration=6 * one.gait.period).isel(run=0)
    last = record.time > 4 * one.gait.period
    angles = record.joint_angle.sel(joint=record.servo.values).isel(time=last.values)
    swing = np.degrees(np.ptp(angles.transpose("joint", "time").values, axis=1)) / 2
    asked = np.degrees(np.ptp(record.servo_target.transpose("servo", "time").values[:, last.values], axis=1)) / 2
    assert bool(np.abs(swing - asked).max() < 2.0) is follows
