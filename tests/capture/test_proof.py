"""Film a walk that is known, with camera noise, and get it back."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr

from suchus.animals.capture import Camera, Walk, driven_fraction, film, film_animal, observe, to_gait, write_gait
from suchus.animals.capture.film import keypoints
from suchus.core.errors import UnsuitedRobot
from suchus.robot import blueprint
from suchus.robot.design import LEGS, layout
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, Gait, limb_reaches, movement
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl as let_crawl
from suchus.sim.metrics import displacement

PHASE = 0.02  # [cycle]
AMPLITUDE = 0.05


def apart(a, b):
    return np.abs((np.asarray(a) - np.asarray(b) + 0.5) % 1.0 - 0.5)


def first_harmonic(time, values, period):
    return 2 * np.mean((values - values.mean()) * np.exp(-2j * np.pi * time / period))


def metres(robot, gait, field):
    """Return a length of the front and the hind foot paths [m]."""
    return [reach * getattr(limb, field) for limb, reach in zip(gait.limbs, limb_reaches(robot), strict=True)]


@pytest.fixture(scope="module")
def filmed(caiman, crawl):
    """What is read of a film of the crawl, and the gait that it makes; once for each camera."""

    @cache
    def read(camera) -> tuple[Walk, Gait]:
        walk = observe(film(caiman, crawl, camera), tail_share=driven_fraction(caiman))
        return walk, to_gait(walk, caiman, GAITS["belly_crawl"], name="back").gait

    return read


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_our_crawl_comes_back_as_commanded(caiman, filmed, noisy, seed):
    told = GAITS["belly_crawl"]
    rng = np.random.default_rng(seed)
    camera = replace(noisy, seed=seed, heading=float(rng.uniform(-3, 3)), scale=float(rng.uniform(200, 2000)))
    _, back = filmed(camera)
    np.testing.assert_allclose(back.period, told.period, rtol=0.005)
    assert apart(back.limb_phases, told.limb_phases).max() < PHASE
    assert apart(back.number("axis_lag"), told.number("axis_lag")) < PHASE
    # under load the trunk lags its command by 0.02 cycle and the tail does not: what is seen differs by as much
    assert apart(back.number("tail_lag"), told.number("tail_lag")) < 0.025
    np.testing.assert_allclose(back.number("trunk_bend"), told.number("trunk_bend"), rtol=AMPLITUDE)
    np.testing.assert_allclose(back.number("tail_bend"), told.number("tail_bend"), rtol=AMPLITUDE)
    np.testing.assert_allclose(metres(caiman, back, "stroke"), metres(caiman, told, "stroke"), rtol=AMPLITUDE)
    np.testing.assert_allclose(back.duty_factor, told.duty_factor, atol=0.04)
    np.testing.assert_allclose(metres(caiman, back, "outward"), metres(caiman, told, "outward"), atol=0.004)
    np.testing.assert_allclose(metres(caiman, back, "ahead"), metres(caiman, told, "ahead"), atol=0.006)


@pytest.mark.parametrize(("name", "rate"), [("salamander", 200.0), ("pleurobot", 100.0)])
def test_the_walk_of_another_body_comes_back_as_commanded(name, rate):
    robot = ROBOTS[name]
    told, step = default_gait(robot), coarse_step(robot)
    walked = let_crawl(robot, told, duration=START + 5 * told.period, timestep=step)
    camera = Camera(rate=rate, noise=2e-4 * robot.length, lost=0.02, heading=1.0, scale=500.0, heights=False, seed=0)
    walk = observe(film(robot, walked, camera), tail_share=driven_fraction(robot))
    back = to_gait(walk, robot, told, name="back").gait
    assert back.period == pytest.approx(told.period, rel=0.005)
    assert apart(back.limb_phases, told.limb_phases).max() < PHASE
    assert back.duty_factor == pytest.approx(told.duty_factor, abs=0.04)
    assert back.number("trunk_bend") == pytest.approx(told.number("trunk_bend"), rel=AMPLITUDE)
    assert back.number("tail_bend") == pytest.approx(told.number("tail_bend"), rel=AMPLITUDE)
    assert back.number("stroke") == pytest.approx(told.number("stroke"), rel=AMPLITUDE)


def test_who_has_not_the_points_of_the_tracks_cannot_be_filmed():
    robot = ROBOTS["strider"]
    record = xr.Dataset({"joint_angle": (("time", "joint"), np.zeros((2, len(layout(robot).hinges))))})
    missing = "four limbs, and a tail that bends sideways"
    with pytest.raises(UnsuitedRobot, match=f"a made-up film needs {missing}; robot 'strider' lacks that"):
        keypoints(robot, record)


def test_our_crawl_comes_back_as_simulated(crawl, filmed, noisy):
    walk, _ = filmed(noisy)
    part = crawl.sel(time=slice(START, START + 8.0 - 1e-6))
    time = part.time.values - START
    trunk = first_harmonic(time, -sum(part.joint_angle.sel(joint=f"spine_yaw_{i}") for i in (1, 2, 3)).values, 4.0)
    tail = first_harmonic(time, sum(part.joint_angle.sel(joint=f"tail_yaw_{i}") for i in range(1, 7)).values, 4.0)
    np.testing.assert_allclose(walk.value("spine_lateral"), abs(trunk), rtol=0.03)
    np.testing.assert_allclose(walk.value("tail_lateral"), abs(tail), rtol=AMPLITUDE)
    assert apart(walk.value("tail_lag"), np.angle(trunk / tail) / (2 * np.pi)) < 0.01
    assert walk.value("standing_trunk") > 0.98  # one servo command for all three joints
    # a foot is seen to stand while it is commanded to; it still bears load when it has begun to slide
    loaded = (part.foot_force.sel(xyz="z") > 0.5).mean("time").values
    for leg, load in zip(LEGS[:2], loaded[:2], strict=True):
        assert GAITS["belly_crawl"].duty_factor - 0.04 < walk.value(f"duty_{leg}") < load + 0.04


def test_heights_give_lift_and_tail_pitch(caiman, crawl, filmed, noisy):
    walk, back = filmed(replace(noisy, heights=True))
    pitch = float(crawl.joint_angle.sel(joint="tail_pitch", time=slice(START, None)).mean())
    np.testing.assert_allclose(back.number("tail_pitch"), pitch, atol=0.02)
    heights = crawl.foot_position.sel(xyz="z", time=slice(START, None))
    lifts = (heights.max("time") - heights.min("time")).values / (caiman.spine.length + caiman.thorax.shoulder)
    np.testing.assert_allclose([walk.value(f"lift_{leg}") for leg in LEGS], lifts, atol=0.02)
    assert walk.has_heights


def test_what_was_captured_runs_as_far(caiman, crawl, filmed, noisy, tmp_path):
    walk, _ = filmed(noisy)
    captured = to_gait(walk, caiman, GAITS["belly_crawl"], name="caiman_walk")
    file = write_gait(captured, walk, tmp_path / "caiman_walk.toml")
    read = blueprint.read_design(file, Gait, GAITS)
    assert read == captured.gait
    again = let_crawl(caiman, read, duration=START + 2 * read.period, timestep=0.005)
    np.testing.assert_allclose(displacement(again)[0], displacement(crawl)[0], rtol=0.1)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_lateral_sequence_walk_of_a_lizard_comes_back(caiman, lizard, noisy, seed):
    camera = replace(noisy, rate=100.0, noise=0.0008, seed=seed)
    walk = observe(film_animal(lizard, camera, cycles=5))
    phases = [walk.value(f"phase_{leg}") for leg in LEGS]
    assert apart(phases, lizard.limb_phases).max() < PHASE
    np.testing.assert_allclose([walk.value(f"duty_{leg}") for leg in LEGS], 0.7, atol=0.03)
    np.testing.assert_allclose(walk.value("spine_lateral"), lizard.spine_bend, rtol=AMPLITUDE)
    np.testing.assert_allclose(walk.value("tail_lateral"), lizard.tail_bend, rtol=AMPLITUDE)
    assert apart(walk.value("tail_lag"), 1 / 3) < PHASE
    assert apart(walk.value("spine_rightmost"), lizard.spine_rightmost) < PHASE
    np.testing.assert_allclose(walk.value("stride"), lizard.stride / lizard.trunk, rtol=AMPLITUDE)
    gait = to_gait(walk, caiman, GAITS["belly_crawl"], name="lizard").gait
    np.testing.assert_allclose(gait.duty_factor, 0.7, atol=0.02)
    assert walk.value("standing_trunk") > 0.95
    assert walk.value("standing_tail") > 0.95


@pytest.mark.parametrize("duty", ["retraction", "contact"])
def test_the_gait_bends_as_the_animal_did(caiman, lizard, clean, read_film, duty):
    walk = read_film(lizard, clean, 4)
    gait = to_gait(walk, caiman, GAITS["belly_crawl"], name="lizard", duty=duty).gait
    clock, here = np.linspace(0.0, 1.0, 200, endpoint=False), movement(caiman, gait)
    axis = here.axis_phase(clock[:, None] + np.array(gait.limb_phases))
    # the animal's clock: both have LF's mid-stance in common
    phase = clock + (gait.duty_factor - lizard.duty_factor) / 2
    spine = lizard.spine_bend * np.cos(2 * np.pi * (phase - lizard.spine_rightmost))
    tail = lizard.tail_bend * np.cos(2 * np.pi * (phase - lizard.spine_rightmost - lizard.tail_lag))
    np.testing.assert_allclose(-here.bend_of("trunk", axis), spine, atol=0.03)
    np.testing.assert_allclose(-here.bend_of("tail", axis), tail, atol=0.03)


def test_a_travelling_tail_is_told_not_dropped(caiman, lizard, clean):
    walk = observe(film_animal(replace(lizard, tail_wave=0.6), clean, cycles=4))
    assert walk.value("standing_tail") < 0.5
    assert walk.value("standing_trunk") > 0.95
    notes = " ".join(to_gait(walk, caiman, GAITS["belly_crawl"], name="x").notes)
    assert "the tail bends as a travelling wave" in notes
    assert "the trunk bends" not in notes


def test_a_footfall_in_which_the_girdles_pull_against_each_other_bends_as_it_was_seen(caiman, lizard, clean, read_film):
    pace = replace(lizard, limb_phases=(0.0, 0.5, 0.0, 0.5))
    walk = observe(film_animal(pace, clean, cycles=4))
    gait = to_gait(walk, caiman, GAITS["belly_crawl"], name="x").gait
    other = to_gait(read_film(lizard, clean, 4), caiman, GAITS["belly_crawl"], name="x").gait
    for number in ("trunk_bend", "tail_bend", "axis_lag", "tail_lag"):
        np.testing.assert_allclose(gait.number(number), other.number(number), atol=0.01)
    np.testing.assert_allclose(gait.number("trunk_bend"), lizard.spine_bend, rtol=AMPLITUDE)


def test_girdles_stroke_alike_or_apart(caiman, filmed, noisy):
    """Slip lets hind feet go back farther than front feet, of which the mean is what was commanded."""
    walk, _ = filmed(noisy)
    alike, apart = (to_gait(walk, caiman, GAITS["belly_crawl"], name="x", girdles=how) for how in ("alike", "apart"))
    front, hind = metres(caiman, apart.gait, "stroke")
    assert hind > 1.1 * front
    np.testing.assert_allclose(metres(caiman, alike.gait, "stroke"), (front + hind) / 2, rtol=1e-3)
    assert replace(apart.gait, limbs=alike.gait.limbs) == alike.gait
    assert any("half strokes differ" in note for note in alike.notes)
    assert not any("half strokes differ" in note for note in apart.notes)


def test_heading_scale_and_losses_change_nothing_on_clean_tracks(filmed, clean):
    first, _ = filmed(replace(clean, heights=False))
    second, _ = filmed(replace(clean, heights=False, heading=-2.5, scale=913.0))
    third, _ = filmed(replace(clean, heights=False, lost=0.1))
    for name, seen in first.numbers.items():
        if seen.unit.startswith("m"):
            continue  # in pixels in the second film
        # edges of a swing are found by steps, which end a little differently in other coordinates
        np.testing.assert_allclose(second.value(name), seen.value, rtol=1e-5, atol=1e-4, err_msg=name)
        if name.startswith(("duty", "spine_lateral")) and name.count("_") == 1:
            np.testing.assert_allclose(third.value(name), seen.value, atol=0.02, err_msg=name)


def test_mirrored_tracks_give_the_mirrored_walk(lizard, clean, read_film):
    tracks = film_animal(lizard, clean, cycles=4)
    other = {"LF": "RF", "RF": "LF", "LH": "RH", "RH": "LH"}
    mirrored = replace(
        tracks,
        points=tuple(other.get(name, name) for name in tracks.points),
        position=tracks.position * np.array([1.0, -1.0, 1.0]),
    )
    one, two = read_film(lizard, clean, 4), observe(mirrored)
    np.testing.assert_allclose(two.value("duty_RF"), one.value("duty_LF"), atol=1e-6)
    np.testing.assert_allclose(two.value("tail_lag"), one.value("tail_lag"), atol=1e-6)
    # seen from RF's stance, which is half a cycle away, the mirrored spine bends the same way
    assert apart(two.value("spine_rightmost"), one.value("spine_rightmost")) < 0.01


def test_a_film_of_one_seed_is_one_film(caiman, crawl, noisy):
    one, two = (film(caiman, crawl, noisy) for _ in range(2))
    np.testing.assert_array_equal(one.position, two.position)


def test_too_fast_an_animal_is_slowed_down_and_it_is_told(caiman, lizard, clean, read_film):
    captured = to_gait(read_film(lizard, clean, 4), caiman, GAITS["belly_crawl"], name="x")
    assert captured.gait.period > lizard.period
    assert any("turn faster than its servo can" in note for note in captured.notes)
