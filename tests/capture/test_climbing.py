"""Animals on slopes, walls and ceilings: what is measured is what the same animal shows on level ground."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zoo import specimen

from suchus.animals.capture import UnusableTracks, film_animal, observe, write_table
from suchus.animals.capture.markers import upright
from suchus.animals.capture.surface import level_surface
from suchus.animals.forces import walked_forces
from suchus.apps.cli import main

TURNS = {  # rotation of the world of the film, and the slope that it makes [degree]
    "a slope": ("y", -35.0, 35.0),
    "a bank": ("x", 50.0, 50.0),
    "a wall, upward": ("y", -90.0, 90.0),
    "a wall, along it": ("x", 90.0, 90.0),
    "an overhang": ("y", 140.0, 140.0),
    "a ceiling": ("x", 180.0, 180.0),
}


@pytest.fixture(scope="module")
def level(lizard, clean):
    return film_animal(lizard, replace(clean, noise=0.0005, lost=0.02, heading=0.4), cycles=4)


@pytest.fixture(scope="module")
def seen(level):
    return observe(level)


@pytest.mark.parametrize("name", TURNS)
def test_a_surface_of_any_slope_is_walked_as_the_ground(name, level, seen):
    axis, angle, slope = TURNS[name]
    turned = Rotation.from_euler(axis, angle, degrees=True).apply(level.position.reshape(-1, 3))
    walk = observe(replace(level, position=turned.reshape(level.position.shape)))
    assert np.degrees(walk.slope) == pytest.approx(slope, abs=2.0)
    note = next(note for note in walk.notes if "the feet show that the animal" in note)
    assert ("hangs" in note) == (slope > 100.0)
    assert walk.numbers.keys() == seen.numbers.keys()
    assert not walk.wrong
    for quantity in ("period", "stride", "duty_LF", "duty_RH", "phase_LH", "spine_lateral", "tail_lateral", "lift_LF"):
        assert walk.value(quantity) == pytest.approx(seen.value(quantity), rel=0.02, abs=0.005), quantity


def test_level_ground_is_left_as_it_is(level, seen):
    assert seen.slope == 0.0
    assert not any("the feet show" in note for note in seen.notes)
    tilted = Rotation.from_euler("y", 6.0, degrees=True).apply(level.position.reshape(-1, 3))
    for tracks in (level, replace(level, position=tilted.reshape(level.position.shape))):
        assert level_surface(tracks).tracks is tracks
    flat = replace(level, position=level.position[..., :2])
    assert level_surface(flat).tracks is flat


def test_a_few_points_far_off_do_not_tilt_the_ground(level):
    random = np.random.default_rng(0)
    position = level.position.copy()
    off = random.uniform(size=position.shape[:2]) < 0.05
    position[off] += random.normal(0.0, 0.3, (off.sum(), 3))
    assert level_surface(replace(level, position=position)).slope == 0.0


def test_marker_files_of_a_hanging_animal_are_read(level):
    hanging = level.position * [1.0, -1.0, -1.0]
    np.testing.assert_array_equal(upright(hanging, level.points), hanging)
    y_up = hanging[..., [1, 2, 0]]
    np.testing.assert_array_equal(upright(y_up, level.points), hanging)


def test_a_film_from_the_side_of_an_animal_under_a_branch(level, seen):
    side = replace(level, view="side", position=level.position[..., [0, 2]])
    upside_down = replace(side, position=-side.position)
    walks = observe(side), observe(upside_down)
    assert walks[1].slope == pytest.approx(np.pi, abs=0.05)
    for quantity in ("period", "stride", "duty_LF", "phase_RH"):
        assert walks[1].value(quantity) == pytest.approx(walks[0].value(quantity), abs=1e-6)


def test_sides_that_are_exchanged_are_still_refused(level):
    mirrored = replace(level, position=level.position * [1.0, 1.0, -1.0])  # z points down: not a rotation
    with pytest.raises(UnusableTracks, match="left and right are swapped in both pairs"):
        observe(mirrored)


def test_forces_of_a_climbing_animal_are_refused(level, caiman, tmp_path, capsys):
    wall = replace(level, position=level.position[..., [2, 1, 0]] * [-1.0, 1.0, 1.0])
    with pytest.raises(UnusableTracks, match=r"climbs on a surface at 90 degrees.*level ground"):
        walked_forces(observe(wall), caiman)
    file = write_table(wall, tmp_path / "wall.csv")
    assert main(["capture", str(file), "--forces", str(tmp_path / "newtons")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "newtons").exists()


def test_films_from_above_of_a_climbing_animal_are_read_as_they_are():
    animal = specimen(6, path="climbing", points="all")
    assert level_surface(animal.tracks).tracks is animal.tracks
