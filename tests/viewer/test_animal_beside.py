"""An animal's film beside a robot's walk: size, pace and place follow from both, and gaps are closed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from suchus.animals.capture import Camera, SyntheticAnimal, UnusableTracks, film_animal, write_table
from suchus.apps.cli.entry import main
from suchus.apps.viewer.replay import Take, place_animal, takes
from suchus.core.files import save
from suchus.robot.design.ground import Ground
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

LIZARD = SyntheticAnimal(
    trunk=0.12, tail=0.20, period=0.8, duty_factor=0.7, limb_phases=(0.0, 0.5, 0.25, 0.75), stride=0.15, outward=0.06,
    lift=0.02, spine_bend=0.5, spine_rightmost=0.2, tail_bend=0.7, tail_lag=1 / 3, tail_wave=0.0,
)  # fmt: skip
CAMERA = Camera(rate=50.0, noise=0.0, lost=0.0, heading=0.7, scale=None, heights=True, seed=0)
CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    record = simulate([Run(robot=CAIMAN, gait=CRAWL)], duration=1.2, timestep=0.005, sample_stride=5)
    return save(record, tmp_path_factory.mktemp("record") / "walk.nc")


@pytest.fixture(scope="module")
def take(walk):
    return takes(walk)[0]


@pytest.fixture(scope="module")
def tracks():
    return film_animal(LIZARD, CAMERA, cycles=3)


def spine_length(animal):
    """Length of the midline from frame to frame [m]."""
    chain = animal.position[:, : len(animal.bones) - 3]
    return np.linalg.norm(np.diff(chain[..., :2], axis=1), axis=-1).sum(axis=1)


def test_the_animal_is_as_long_as_the_robot_whatever_its_own_size(take, tracks):
    animal, pixels = (
        place_animal(tracks, take),
        place_animal(replace(tracks, position=700.0 * tracks.position, unit="px"), take),
    )
    assert np.median(spine_length(animal)) == pytest.approx(CAIMAN.length)
    assert pixels.scale == pytest.approx(animal.scale / 700.0)
    np.testing.assert_allclose(pixels.position, animal.position, atol=1e-9)


def test_its_cycle_takes_as_long_as_the_robots(take, tracks):
    animal = place_animal(tracks, take)
    assert animal.pace == pytest.approx(CRAWL.period / LIZARD.period, rel=0.01)
    hip = [np.interp(START + k * CRAWL.period, animal.time, animal.position[:, 0, 0]) for k in range(3)]
    assert np.diff(hip) == pytest.approx(
        animal.scale * LIZARD.stride, rel=0.03
    )  # a stride in each of the robot's cycles


def test_it_begins_to_the_left_of_the_robot_and_walks_where_the_robot_faces(take, tracks):
    animal = place_animal(tracks, take)
    first, last = animal.keypoints_at(0.0), animal.keypoints_at(1e6)
    assert first[:, 1].mean() - take.origin[1] == pytest.approx(0.35 * CAIMAN.length, abs=0.15 * CAIMAN.length)
    assert last[0, 0] - first[0, 0] > 2 * animal.scale * LIZARD.stride
    assert abs(last[0, 1] - first[0, 1]) < 0.1 * CAIMAN.length
    assert abs(first[list(animal.feet), 2].min()) < 0.01 * CAIMAN.length


def test_lost_points_are_bridged_and_a_film_without_heights_lies_above_the_ground(take, tracks):
    flat = replace(tracks, position=tracks.position[..., :2].copy())
    flat.position[20:22, 3] = np.nan
    animal = place_animal(flat, take)
    assert np.isfinite(animal.position).all()
    assert np.unique(animal.position[..., 2]).tolist() == pytest.approx([0.0, 0.06 * CAIMAN.length])
    whole = place_animal(replace(tracks, position=tracks.position[..., :2]), take)
    assert abs(animal.position - whole.position).max() < 0.03 * CAIMAN.length


def test_a_record_that_names_no_period_plays_the_film_at_its_own_pace(take, tracks):
    bare = Take(label=take.label, robot=take.robot, record=take.record.drop_vars("period"), ground=Ground())
    assert place_animal(tracks, bare).pace == 1.0


def test_what_does_not_walk_is_refused(take, tracks):
    still = replace(tracks, position=np.repeat(tracks.position[:1], len(tracks.time), axis=0))
    with pytest.raises(UnusableTracks):
        place_animal(still, take)


def test_the_command_refuses_a_file_without_tracks_in_one_sentence(walk, tmp_path, capsys):
    (tmp_path / "empty.csv").write_text("")
    assert main(["view", str(walk), "--animal", str(tmp_path / "empty.csv")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_lines_and_feet_are_drawn_where_the_animal_is(take, tracks):
    drawn = pytest.importorskip("suchus.apps.viewer.drawn", reason="the extra viewer is not installed")
    made: dict[str, SimpleNamespace] = {}

    def node(name, *_, **settings):
        return made.setdefault(name, SimpleNamespace(**settings))

    animal = place_animal(tracks, take)
    drawn.DrawnAnimal(SimpleNamespace(add_line_segments=node, add_icosphere=node), "/w", animal).show(2.0)
    place = animal.keypoints_at(2.0)
    assert made["/w/lines"].points.shape == (len(animal.bones), 2, 3)
    np.testing.assert_allclose(made["/w/lines"].points[0], place[list(animal.bones[0])], atol=1e-6)
    np.testing.assert_allclose(made["/w/foot_3"].position, place[animal.feet[3]])


def test_the_head_of_the_page_names_the_film_and_its_pace(take, tracks):
    status_text = pytest.importorskip("suchus.apps.viewer.replay_page").status_text
    animal = place_animal(replace(tracks, source="<lizard>.csv"), take)
    text = status_text(take, None, 1.0, animal)
    assert "&lt;lizard&gt;.csv" in text
    assert "slowed down by a factor of 5" in text
    assert "slowed down" not in status_text(take, None, 1.0)


def test_a_table_of_tracks_is_read_by_the_command_line(walk, tracks, tmp_path, monkeypatch):
    view = pytest.importorskip("suchus.apps.cli.view")
    file = tmp_path / "lizard.csv"
    write_table(tracks, file)
    options = view.ViewRecordOptions(record=walk, animal=file)
    (animal,) = view._animals(options, takes(walk))
    assert animal.pace == pytest.approx(5.0, rel=0.01)
    assert view._animals(view.ViewRecordOptions(record=walk), takes(walk)) == ()
