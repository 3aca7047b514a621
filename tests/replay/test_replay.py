"""The page holds what was recorded, is small, and refuses what it cannot show."""

import base64
import json
import re
from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import IncompatibleRecord, InvalidDesign
from suchus.core.rotation import rotate
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import LEGS
from suchus.robot.design.ground import Bumps, Ground, Step, Stone, field
from suchus.robot.gaits import GAITS
from suchus.sim.record import ground_text
from suchus.visual.replay import replay, save
from suchus.visual.replay.frames import MAX_FRAMES, frames
from suchus.visual.skin import ankles, poses, skin, skin_with_ankles
from suchus.visual.skin.ankles import FLAT_FOOT_HEIGHTS, REACH


def opened(page):
    """Return what the page tells the player, and its bytes."""
    meta = re.search(r'<script id="meta"[^>]*>(.*?)</script>', page, re.S)
    data = re.search(r'<script id="data"[^>]*>(.*?)</script>', page, re.S)
    return json.loads(meta[1]), base64.b64decode(data[1])


def read(raw, ref):
    return np.frombuffer(raw, ref["kind"], ref["count"], ref["start"])


def test_positions_are_those_of_the_bodies_to_a_tenth_of_a_millimetre(robot, crawled):
    meta, raw = opened(replay(crawled, robot))
    actor = meta["actors"][0]
    places = read(raw, actor["arrays"]["places"]).reshape(actor["frames"], -1, 3)
    shown = actor["origin"] + places / 32767 * actor["reach"]
    for i in (0, actor["frames"] // 2, actor["frames"] - 1):
        now = crawled.sel(time=meta["start"] + i / meta["rate"], method="nearest")
        at = poses(robot, now.position.values, now.orientation.values, now.joint_angle.values)
        assert np.allclose(at.positions, shown[i, :-4], atol=1e-4)
        assert np.allclose(now.foot_position.values, shown[i, -4:], atol=1e-4)
    turns = read(raw, actor["arrays"]["turns"]).reshape(actor["frames"], -1, 4) / 32767
    assert np.allclose(np.linalg.norm(turns, axis=-1), 1.0, atol=1e-4)


def test_every_run_is_shown_and_each_needs_a_name(robot, crawled):
    for ghost in (None, crawled):
        meta, _ = opened(replay(crawled, robot, ghost=ghost))
        assert len(meta["actors"]) == 1 + (ghost is not None)
        with pytest.raises(InvalidDesign, match=r"of (1|2) runs has (0|1) labels; give each run a name"):
            replay(crawled, robot, ghost=ghost, labels=("this run",) * (ghost is not None))


def test_a_single_gait_of_many_is_replayed_too(crawled):
    one = replace(EXPERIMENTS["speed_range"], gaits=(GAITS["belly_crawl"],))
    (shown,) = one._replays([crawled]).values()
    assert '"label":"belly crawl"' in shown.html


def test_the_tail_and_its_load_are_told_so_that_it_can_support(robot, crawled):
    meta, raw = opened(replay(crawled, robot))
    told = read(raw, meta["actors"][0]["arrays"]["tail"]).reshape(-1, 4)
    last = crawled.sel(time=meta["start"] + (len(told) - 1) / meta["rate"], method="nearest")
    assert np.allclose(told[-1, :3], last.tail_tip.values, atol=1e-5)
    assert told[-1, 3] == pytest.approx(float(last.tail_force.sel(xyz="z")), rel=1e-5, abs=1e-5)
    assert (told[:, 3] > meta["loaded"]).any()  # the crawl drags its tail


def test_feet_of_the_bones_are_the_recorded_feet(robot, crawled):
    """The forward kinematics of the bones agrees with MuJoCo's sites."""
    shown = frames(crawled, robot)
    for i, leg in enumerate(LEGS):
        bone = skin(robot).bones.index(f"{leg}_tibia")
        links, side = robot.leg(leg), 1.0 if leg.startswith("L") else -1.0
        q = shown.bones.quaternions[:, bone]
        w, x, y, z = q.T
        out = np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)
        foot = shown.bones.positions[:, bone] + side * links.tibia * out
        assert np.allclose(shown.feet[:, i], foot, atol=1e-6)


def test_standing_feet_lie_flat_and_balls_stay(robot, crawled):
    """The soles of feet near the ground face down, as far as an ankle turns; in the air they follow the shank."""
    shown, surface = frames(crawled, robot), skin(robot)
    for lift, reach in ((0.0, None), (1.0, 0.0)):
        feet = shown.feet + np.array([0.0, 0.0, lift])
        bones = ankles(robot, shown.bones, feet)
        assert np.array_equal(feet, bones.positions[:, -4:])
        assert np.allclose(np.linalg.norm(bones.quaternions, axis=-1), 1.0)
        for i, leg in enumerate(LEGS):
            out = np.array([0.0, 1.0 if leg.startswith("L") else -1.0, 0.0])
            shank = rotate(shown.bones.quaternions[:, surface.bones.index(f"{leg}_tibia")], out)
            sole = rotate(bones.quaternions[:, -4 + i], out)
            turned = np.arccos(np.clip(np.sum(shank * sole, axis=-1), -1.0, 1.0))
            leaned = np.arccos(np.clip(-shank[:, 2], -1.0, 1.0))
            assert (turned <= REACH + 1e-6).all()
            if reach == 0.0:
                assert np.allclose(turned, 0.0, atol=1e-6)
            else:
                flat = feet[:, i, 2] < robot.leg(leg).foot_radius + FLAT_FOOT_HEIGHTS[0]
                assert np.allclose(turned[flat], np.minimum(leaned[flat], REACH), atol=1e-4)


def test_feet_hang_on_ankles_and_nothing_else_does(robot):
    surface, bodies = skin_with_ankles(robot), len(skin(robot).bones)
    on_foot = surface.indices[:, 0] >= bodies
    away = surface.vertices - surface.rest_origins[surface.indices[:, 0]]
    for i, leg in enumerate(LEGS):
        radius = robot.leg(leg).foot_radius
        assert np.linalg.norm(away[surface.indices[:, 0] == bodies + i], axis=1).max() < 6 * radius
    assert 0.1 < on_foot.mean() < 0.3
    assert (surface.weights[on_foot, 0] > 0.999).all()


def test_the_head_is_the_foremost_point_of_the_front(robot, crawled):
    head, surface = opened(replay(crawled, robot))[0]["head"], skin(robot)
    assert surface.bones[head["bone"]] == robot.axis[0].name
    assert head["at"][0] == pytest.approx(surface.vertices[:, 0].max(), abs=1e-5)


def test_feet_are_spoken_of_only_where_they_stand(robot, crawled):
    assert page_shows_feet(replay(crawled, robot))
    afloat = crawled.assign(foot_force=0.0 * crawled.foot_force)
    assert not page_shows_feet(replay(afloat, robot))


def page_shows_feet(page):
    return [f'<label><input id="{name}"' in page for name in ("forces", "tracks")] == [True, True]


def test_skin_comes_through(robot, crawled):
    meta, raw = opened(replay(crawled, robot))
    told, surface = meta["skin"], skin(robot)
    vertices = read(raw, told["vertices"]).reshape(-1, 3) / 32767 * told["scale"]
    assert np.allclose(surface.vertices, vertices, atol=5e-5)
    assert np.array_equal(surface.faces.ravel(), read(raw, told["faces"]))
    assert np.allclose(surface.weights[:, 0], read(raw, told["weights"]) / 255, atol=0.5 / 255 + 1e-9)


def test_the_page_is_small_alone_and_the_same_twice(robot, crawled, limped):
    one = replay(crawled, robot, ghost=limped, labels=("intact", "limp"))
    assert len(one.encode()) < 1_000_000
    assert one == replay(crawled, robot, ghost=limped, labels=("intact", "limp"))
    addresses = set(re.findall(r"https?://([^/\"]*)", one))
    assert addresses <= {"www.w3.org", "purl.org", "creativecommons.org"}  # names of SVG's vocabularies, never asked
    assert "<title>caiman: belly crawl</title>" in one


@pytest.mark.parametrize("label", ["</script><b>", "<!--<script>"])  # the latter swallows the rest of a page
def test_words_cannot_break_the_page(robot, crawled, label):
    page = replay(crawled, robot, ghost=crawled, labels=(label, "x"), title="<i>&", caption='"><script>')
    assert "<i>" not in page
    assert label not in page
    assert opened(page)[0]["actors"][0]["label"] == label


def test_frames_are_thirty_a_second_and_fewer_of_long_runs(robot, crawled):
    assert 25 < frames(crawled, robot).rate < 40
    long = crawled.isel(time=np.resize(np.arange(crawled.sizes["time"]), 3 * MAX_FRAMES * 4))
    long = long.assign_coords(time=0.01 * np.arange(long.sizes["time"]))
    assert len(frames(long, robot).mass) <= MAX_FRAMES
    assert len(replay(long, robot).encode()) < 5_000_000


def test_an_arrow_that_is_as_long_as_the_page_says_stands_for_the_weight(robot, crawled):
    page = replay(crawled, robot)
    length = opened(page)[0]["metres_per_newton"] * robot.mass * 9.81
    assert f"{100 * length:.0f} cm is the robot's weight" in " ".join(page.split())


def test_one_frame_is_a_still(robot, crawled):
    meta, _ = opened(replay(crawled.isel(time=slice(0, 1)), robot))
    assert meta["actors"][0]["frames"] == 1


def test_a_run_that_came_apart_ends_there(robot, crawled):
    broken = crawled.copy(deep=True)
    broken.position[100:] = np.nan
    assert len(frames_of(replay(broken, robot))) < len(frames_of(replay(crawled, robot)))


def frames_of(page):
    meta, raw = opened(page)
    return read(raw, meta["actors"][0]["arrays"]["mass"]).reshape(-1, 3)


def on(record, ground):
    """Return a record that tells another ground."""
    return record.assign(stands_on=((), ground_text(ground)))


def test_a_slope_is_told_in_words_and_leans_the_picture(robot, crawled):
    ground = Ground(uphill=np.radians(10), sideways=np.radians(-5))
    page = replay(on(crawled, ground), robot, ghost=on(crawled, replace(ground, friction_scale=0.5)))
    meta, _ = opened(page)
    assert "The ground rises by 10° ahead and falls by 5° to the left." in page
    assert "other ground" not in page
    ahead = rotate(np.array(meta["slope"]), np.array([1.0, 0.0, 0.0]))
    assert ahead[2] == pytest.approx(np.sin(ground.uphill))
    assert meta["relief"] is None


def test_a_record_of_before_grounds_were_kept_is_shown_on_level_ground(robot, crawled):
    assert replay(crawled.drop_vars("stands_on"), robot) == replay(crawled, robot)


def test_a_foot_on_a_step_lies_as_flat_as_on_even_ground(robot, crawled):
    shown = frames(crawled, robot)
    step = Step(at=-0.9, height=0.1)
    raised = shown.feet + np.array([0.0, 0.0, step.height])
    level, high = ankles(robot, shown.bones, shown.feet), ankles(robot, shown.bones, raised, step)
    assert np.allclose(level.quaternions, high.quaternions)
    assert not np.allclose(level.quaternions, ankles(robot, shown.bones, raised).quaternions, atol=0.01)


@pytest.mark.parametrize(
    "relief",
    [
        Step(at=0.6, height=0.02),
        Stone(at=0.5, aside=0.1, height=0.03, length=0.1, width=0.2),
        Bumps(height=0.03, correlation=0.06, start=0.3, seed=1),
    ],
    ids=lambda relief: type(relief).__name__,
)
def test_relief_is_told_and_no_robot_stands_beside_it(robot, crawled, relief):
    page = replay(on(crawled, Ground(relief=relief)), robot, ghost=crawled)
    meta, raw = opened(page)
    assert meta["overlaid"]
    assert 'value="beside"' not in page
    assert "other ground, which is not shown" in page
    piece = meta["relief"]
    if isinstance(relief, Bumps):
        heights = piece["scale"] * read(raw, piece["heights"]).reshape(piece["shape"])
        assert np.allclose(field(relief), heights, atol=1e-5)
    else:
        assert piece["block"][4] == relief.height


def test_what_cannot_be_shown_is_told_in_one_sentence(robot, crawled, long_tail):
    several = crawled.expand_dims(run=[0, 1])
    nothing = crawled.copy(deep=True)
    nothing.position[:] = np.nan
    for record, who, words in (
        (crawled.drop_vars("joint_angle"), robot, "joint_angle"),
        (several, robot, "2 runs"),
        (crawled, long_tail, "long_tail"),
        (crawled, replace(long_tail, name="caiman"), "joints"),
        (crawled.isel(time=slice(0, 0)), robot, "no frame"),
        (nothing, robot, "no frame"),
    ):
        with pytest.raises(IncompatibleRecord, match=words) as told:
            replay(record, who)
        assert "\n" not in str(told.value)


def test_saving_leaves_nothing_half_written(robot, crawled, tmp_path):
    page = replay(crawled, robot)
    assert save(page, tmp_path / "run.html").read_text(encoding="utf-8") == page
    assert [file.name for file in tmp_path.glob("[!.]*")] == ["run.html"]


def test_the_water_is_told_frame_by_frame_and_level_whatever_the_slope(robot, crawled):
    assert opened(replay(crawled, robot))[0]["water"] is None
    level = np.linspace(0.1, 0.3, crawled.sizes["time"])
    wet = crawled.assign(
        water_level=("time", level), stands_on=crawled.stands_on.copy(data=ground_text(Ground(uphill=0.2)))
    )
    meta, raw = opened(replay(wet, robot))
    shown = read(raw, meta["water"]["levels"])
    assert len(shown) == meta["actors"][0]["frames"]
    assert shown[[0, -1]] == pytest.approx(level[[0, -1]], abs=0.01)
    assert meta["water"]["up"] == pytest.approx([np.sin(0.2), 0.0, np.cos(0.2)], abs=1e-9)
    dry = crawled.assign(water_level=("time", np.full(crawled.sizes["time"], np.nan)))
    assert opened(replay(dry, robot))[0]["water"] is None
