from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from suchus.apps.viewer.bodies import BodyPoses, pieces, support
from suchus.apps.viewer.history import columns
from suchus.apps.viewer.plots import gait_bars
from suchus.apps.viewer.replay import _VARIABLES, Player, takes
from suchus.apps.viewer.stage import RodShape, rod, upright
from suchus.apps.viewer.swim import films
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.files import save
from suchus.core.rotation import rotate
from suchus.robot.design import LEGS
from suchus.robot.design.ground import Bumps, Ground, heights, slope
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate

stage = pytest.importorskip("suchus.apps.viewer.stage", reason="the extra viewer is not installed")


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    runs = [Run(robot=ROBOTS["caiman"], gait=GAITS[name], label=name) for name in ("belly_crawl", "limbs_only")]
    return save(
        simulate(runs, duration=1.5, timestep=0.005, sample_stride=5), tmp_path_factory.mktemp("record") / "walk.nc"
    )


def test_a_record_gives_a_take_for_every_run(walk):
    found = takes(walk)
    assert [take.label for take in found] == ["0: belly_crawl", "1: limbs_only"]
    assert found[0].end == pytest.approx(1.5)
    record = found[0].record
    np.testing.assert_array_equal(found[0].sample_at(0.71)["position"], record.position.sel(time=0.7, method="nearest"))
    np.testing.assert_array_equal(found[0].sample_at(99.0)["position"], record.position.isel(time=-1))
    assert set(found[0].table()) == set(columns(LEGS))
    assert found[0].table()["forward"][20] == pytest.approx(0.0, abs=1e-9)  # at one second the walk begins


def test_bodies_stand_where_the_record_says(walk):
    take = takes(walk)[0]
    posture = BodyPoses(take.robot)
    for time in (0.0, 1.2):
        now = take.sample_at(time)
        posture.set_state(now)
        np.testing.assert_allclose(posture.body("pelvis")[0], now["position"], atol=1e-12)
        feet = [number for number in posture.geoms() if posture.model.geom(number).name.endswith("_foot")]
        found = {posture.model.geom(number).name: posture.geom(number)[0] for number in feet}
        np.testing.assert_allclose(found["LF_foot"], now["foot_position"][0], atol=1e-9)


def test_a_take_knows_the_ground_it_was_walked_on(tmp_path):
    ground = Ground(uphill=0.1, relief=Bumps(height=0.03, correlation=0.06, start=0.4, seed=1))
    runs = [Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"], ground=g) for g in (ground, Ground())]
    record = simulate(runs, duration=0.05, timestep=0.01)
    assert [take.ground for take in takes(save(record, tmp_path / "new.nc"))] == [ground, Ground()]
    sloped, level = takes(tmp_path / "new.nc")
    told = pytest.importorskip("suchus.apps.viewer.replay_page").status_text
    assert "other ground" in told(sloped, level, 0.0)
    assert "other ground" not in told(level, level, 0.0)
    old = save(record.isel(run=1).drop_vars("stands_on"), tmp_path / "old.nc")
    assert [take.ground for take in takes(old)] == [Ground()]


def test_a_take_says_where_the_water_stands_and_a_dry_one_that_there_is_none(tmp_path):
    rising = Lake(level=((0.0, 0.0), (0.1, 0.1)))
    runs = [Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"], lake=lake) for lake in (rising, None)]
    record = simulate(runs, duration=0.1, timestep=0.01)
    wet, dry = takes(save(record, tmp_path / "wet.nc"))
    assert wet.level(0.05) == pytest.approx(0.05, abs=0.011)
    assert wet.level(9.0) == pytest.approx(0.1, abs=0.011)
    assert dry.level(0.05) is None
    assert takes(save(record.drop_vars("water_level"), tmp_path / "dry.nc"))[0].level(0.05) is None
    odd = record.assign(water_level=("run", np.zeros(2)))
    assert takes(save(odd, tmp_path / "odd.nc"))[0].level(0.05) is None


@pytest.mark.parametrize(
    ("visible", "height", "follow", "below"),
    [(True, 0.6, True, 0.48), (True, 0.1, True, 0.0), (False, 0.6, True, 0.0), (None, 0.6, True, 0.0),
     (True, 0.6, False, 0.0)],
)  # fmt: skip
def test_the_camera_follows_a_swimmer_up_and_down_and_a_walker_along_the_ground(visible, height, follow, below):
    water = None if visible is None else SimpleNamespace(visible=visible)
    seen = SimpleNamespace(_world=SimpleNamespace(), _water=water, _size=1.0)
    stage.WalkScene.set_pose(seen, {"centre_of_mass": np.array([2.0, 0.0, height])}, (0.0, 0.0), follow=follow)
    np.testing.assert_allclose(seen._world.position, [-2.0 if follow else 0.0, 0.0, -below], atol=1e-12)


def test_water_that_a_run_does_not_have_is_hidden():
    box = SimpleNamespace(visible=True, position=None)
    seen = SimpleNamespace(_world=SimpleNamespace(position=np.array([0.0, 0.0, -0.2])), _water=box)
    stage.WalkScene.flood(seen, None)
    assert not box.visible
    stage.WalkScene.flood(seen, 0.6)
    assert box.visible
    assert box.position[2] == pytest.approx(0.4)


@pytest.mark.parametrize("relief", [None, Bumps(height=0.03, correlation=0.1, start=-1.0, seed=1)])
def test_feet_that_stand_do_not_dip_into_the_ground(relief, monkeypatch):
    """The toes of an erect leg would, without ankles: 16 mm."""
    monkeypatch.setattr("suchus.sim.land.batch.check_clear", lambda *_: None)  # it is pushed out within a second
    robot, gait = ROBOTS["caiman"], GAITS["high_walk"]
    record = simulate([Run(robot=robot, gait=gait, ground=Ground(relief=relief))], duration=1.5, timestep=0.005)
    posture = BodyPoses(robot)
    (piece,) = pieces(robot, 1)
    feet = piece.weights[:, [name.endswith("ankle") for name in piece.bones]].sum(axis=1) > 0.5
    for sample in (100, 120, 140):
        posture.set_state({name: values.values[0, sample] for name, values in record[list(_VARIABLES)].items()})
        at = np.zeros_like(piece.vertices)
        for i, (place, turn) in enumerate(posture.bones(relief)[name] for name in piece.bones):
            at += piece.weights[:, i : i + 1] * (place + rotate(turn, piece.vertices - piece.rest_origins[i]))
        dip = heights(relief, at[:, 0], at[:, 1]) - at[:, 2]
        assert -0.003 < dip[feet].max() < 0.005


def test_a_record_of_another_robot_is_refused(walk):
    with pytest.raises(IncompatibleRecord, match="--robot"):
        takes(walk, ROBOTS["long_tail"])


def test_files_that_are_no_records_are_told_in_a_sentence(tmp_path, walk):
    with pytest.raises(UnreadableFile):
        takes(tmp_path / "none.nc")
    other = save(xr.Dataset({"free_midline_x": ("s", [1.0])}), tmp_path / "other.nc")
    with pytest.raises(IncompatibleRecord, match="suchus view swim"):
        takes(other)
    with pytest.raises(IncompatibleRecord, match="no fields of water"):
        films(walk)


@pytest.mark.parametrize(("asked", "found"), [(2.0, 2.0), (-1.0, 0.0), (9.0, 4.0), ("x", 1.0), (float("nan"), 1.0)])
def test_a_player_jumps_to_what_there_is(asked, found):
    player = Player(0.0, 4.0)
    player.advance(1.0)
    player.seek(asked)
    assert player.time == found


def test_a_player_begins_again_at_the_end_and_stands_when_paused():
    player = Player(0.0, 4.0)
    player.speed = 3.0
    player.advance(1.5)
    assert player.time == 0.0
    player.playing = False
    player.advance(1.0)
    assert player.time == 0.0


def test_the_pieces_of_the_skin_are_the_whole_skin():
    robot = ROBOTS["caiman"]
    cut, whole = pieces(robot), pieces(robot, 1)[0]
    assert sum(len(piece.faces) for piece in cut) == len(whole.faces)
    for piece in cut:
        np.testing.assert_allclose(piece.weights.sum(axis=1), 1.0)
        assert piece.faces.max() == len(piece.vertices) - 1


def test_a_ground_seen_uphill_rises_ahead_and_gravity_points_down():
    turned = slope(0.2, 0.1)
    down = np.array([-np.sin(0.2), -np.cos(0.2) * np.sin(0.1), -np.cos(0.2) * np.cos(0.1)])  # as the simulation has it
    np.testing.assert_allclose(rotate(turned, down), [0.0, 0.0, -1.0], atol=1e-12)
    assert rotate(turned, np.array([1.0, 0.0, 0.0]))[2] == pytest.approx(np.sin(0.2))


def test_the_support_of_four_feet_goes_round():
    feet = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]])
    corners = support(feet, np.ones(4, dtype=bool))
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    np.testing.assert_allclose(sides, 2.0)
    assert len(support(feet, np.array([True, False, False, True]))) == 2


def test_gait_bars_show_every_stance_of_every_foot():
    time = np.linspace(0.0, 4.0, 401)
    table = {name: np.where(np.sin(2 * np.pi * time) > 0, 5.0, 0.0) for name in columns(LEGS)} | {"time": time}
    assert (
        gait_bars(ROBOTS["caiman"], table).count('height="15" fill="#0072B2"') == 4
    )  # the left front foot, four times


def test_a_film_of_a_swim_has_a_frame_for_every_instant(tmp_path):
    line = np.linspace(0.0, 1.0, 9)
    data = {"free_vorticity": (("free_frame", "free_y", "free_x"), np.arange(3 * 8 * 20.0).reshape(3, 8, 20) - 240)}
    for name, values in (("x", line), ("y", 0 * line), ("heading", 0 * line), ("half_width", 0.05 + 0 * line)):
        data[f"free_midline_{name}"] = (("free_frame", "free_station"), np.tile(values, (3, 1)))
    coords = {"free_x": np.linspace(-0.3, 2.0, 20), "free_y": np.linspace(-0.5, 0.5, 8), "free_frame": [0.3, 0.6, 1.0]}
    (film,), curves = films(save(xr.Dataset(data, coords=coords), tmp_path / "swim.nc"))
    assert curves == ()
    assert film.title == "free, from rest"
    assert film.picture("vorticity", 2).shape == (8, 20, 3)
    np.testing.assert_allclose(film.sides[1, 0, :, 1], 0.05)
    np.testing.assert_allclose(film.sides[1, 1, :, 1], -0.05)


@pytest.mark.parametrize("way", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, 0.0, 0.8), (0.0, -1.0, 0.0)])
def test_a_rod_points_where_it_should(way):
    np.testing.assert_allclose(rotate(upright(np.array(way)), np.array([0.0, 0.0, 1.0])), way, atol=1e-12)


def test_a_rod_is_closed():
    for shape in (RodShape(radius=0.1), RodShape(radius=0.1, head=0.3, head_radius=0.2)):
        _, faces, weights = rod(shape)
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        ahead, back = {tuple(edge) for edge in edges.tolist()}, {tuple(edge) for edge in edges[:, ::-1].tolist()}
        assert len(ahead) == len(edges)
        lone = {point for edge in ahead - back for point in edge}
        assert lone <= set(range(12, 24))  # the shaft's end stands open inside the head
        np.testing.assert_array_equal(weights.sum(axis=1), 1.0)
