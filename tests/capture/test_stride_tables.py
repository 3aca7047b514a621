"""Tables of what was measured: every stride and the mean, with intervals that hold the truth, as files."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from suchus.animals.capture import (
    Camera,
    ReadingOptions,
    SyntheticAnimal,
    UnusableTracks,
    compare_joints,
    comparison_lines,
    film_animal,
    observe,
    read_tracks,
    tables,
    to_gait,
    write_table,
)
from suchus.animals.overlay import overlay
from suchus.apps.cli import main
from suchus.core.errors import UnreadableFile
from suchus.core.files import load
from suchus.robot.design import LEGS
from suchus.robot.gaits import GAITS

TURN = 0.06  # [rad per cycle]


@pytest.fixture(scope="module")
def camera_above():
    return Camera(rate=60.0, noise=0.0008, lost=0.03, heading=1.0, scale=None, heights=False, seed=3)


@pytest.fixture(scope="module")
def animal():
    return SyntheticAnimal(
        trunk=0.12,
        tail=0.20,
        period=0.8,
        duty_factor=0.7,
        limb_phases=(0.0, 0.5, 0.25, 0.75),
        stride=0.15,
        outward=0.06,
        lift=0.02,
        spine_bend=0.5,
        spine_rightmost=0.2,
        tail_bend=0.7,
        tail_lag=1 / 3,
        tail_wave=0.0,
    )


@pytest.fixture(scope="module")
def filmed(animal, camera_above):
    return film_animal(animal, camera_above, cycles=6)


@pytest.fixture(scope="module")
def walk(filmed):
    return observe(filmed)


def holds(data, name, value, least=0.9):
    """Whether most of the intervals of a variable hold a value."""
    low, high = data[f"{name}_low"].values, data[f"{name}_high"].values
    seen = np.isfinite(low)
    return np.mean((low[seen] <= value) & (value <= high[seen])) >= least


def test_every_stride_has_its_numbers_and_its_intervals_hold_the_truth(walk, animal):
    data = tables(walk)
    assert data.sizes["stride"] == 5
    assert holds(data, "stride_length", animal.stride, 0.8)
    assert holds(data, "speed", animal.stride / animal.period, 0.8)
    assert holds(data, "turning", 0.0, 0.8)
    assert holds(data, "duty", animal.duty_factor)
    assert holds(data, "step_length", animal.stride)
    assert holds(data, "spine_lateral_amplitude", animal.spine_bend, 0.6)
    later = data.touch_down.values - data.lift_off.values
    np.testing.assert_allclose(later[np.isfinite(later)], 0.3 * animal.period, atol=0.03)
    assert np.nanmax(data.speed_high - data.speed_low) < 0.1 * animal.stride / animal.period


def test_angles_over_phase_are_those_of_the_animal(walk, animal):
    data = tables(walk)
    spine = animal.spine_bend * np.cos(2 * np.pi * (data.phase.values - animal.spine_rightmost))
    np.testing.assert_allclose(data.spine_lateral.values, spine, atol=0.08)
    inside = (data.spine_lateral_low.values <= spine) & (spine <= data.spine_lateral_high.values)
    assert inside.mean() > 0.9
    bends = data.bend.values[list(data.keypoint.values).index("spine_2")]
    np.testing.assert_allclose(bends, spine / 3, atol=0.03)
    along = data.curvature_amplitude.values[list(data.keypoint.values).index("spine_2")]
    np.testing.assert_allclose(along, animal.spine_bend / 3 / (animal.trunk / 4), rtol=0.1)


def test_the_mean_is_that_of_the_numbers(walk):
    data = tables(walk).sel(quantity=["duty_LF", "period", "speed"])
    for name in data.quantity.values:
        seen = walk.numbers[str(name)]
        one = data.sel(quantity=name)
        np.testing.assert_allclose(
            [one.value, one.low, one.high], [seen.value, seen.value - seen.error, seen.value + seen.error]
        )
        assert str(one.unit.values) == seen.unit
        assert str(one.meaning.values)


def test_a_walk_in_a_curve_is_as_long_and_turns_as_much_as_it_does(animal, filmed, camera_above):
    straight = film_animal(animal, replace(camera_above, heading=0.0, noise=0.0004), cycles=6)
    bend = TURN / animal.stride  # [rad/m]
    place, turn = straight.position, bend * straight.position[..., 0]
    out = (1 / bend - place[..., 1])[..., None]
    curved = out * np.stack([np.sin(turn), -np.cos(turn)], axis=-1) + [0.0, 1 / bend]
    numbers = observe(replace(straight, position=curved)).numbers
    for name, value in (("turning", TURN), ("stride_length", animal.stride), ("duty_LF", animal.duty_factor)):
        assert abs(numbers[name].value - value) < max(numbers[name].error, 0.01 * value), name
    assert abs(numbers["turning"].value) > 5 * abs(observe(straight).numbers["turning"].value)


def test_from_the_side_bends_up_and_down_and_steps_are_measured(animal, caiman):
    side = film_animal(animal, _camera(heights=True), cycles=5)
    seen = replace(side, position=side.position[..., [0, 2]] * [-1.0, 1.0], view="side")
    walk = observe(seen)
    assert walk.numbers["duty_LF"].value == pytest.approx(animal.duty_factor, abs=0.04)
    assert walk.numbers["stride_length"].value == pytest.approx(animal.stride, rel=0.01)
    assert "spine_vertical" in walk.numbers
    assert "spine_lateral" not in walk.numbers
    assert any("seen from the side" in note for note in walk.notes)
    with pytest.raises(UnusableTracks, match="film from above"):
        to_gait(walk, caiman, GAITS["belly_crawl"], name="x")


def _camera(**options):
    usual = {"rate": 60.0, "noise": 0.0004, "lost": 0.0, "heading": 0.0, "scale": None, "heights": False, "seed": 1}
    return Camera(**{**usual, **options})


def test_the_command_writes_tables_that_read_back(filmed, tmp_path, capsys):
    file = write_table(filmed, tmp_path / "tracks.csv")
    assert main(["capture", str(file), "--tables", str(tmp_path / "out")]) == 0
    with (tmp_path / "out" / "stride_leg.csv").open() as text:
        rows = list(csv.DictReader(text))
    assert {row["leg"] for row in rows} == set(LEGS)
    assert 0.6 < float(rows[0]["duty"]) < 0.8
    assert "lift_off [s]" in rows[0]
    kept = load(tmp_path / "out" / "measured.nc")
    assert float(kept.value.sel(quantity="duty_LF")) == pytest.approx(0.7, abs=0.04)
    assert {"strides.png", "curvature.png", "cycle.png"} <= {one.name for one in (tmp_path / "out").iterdir()}
    assert not (tmp_path / "captured.toml").exists()
    assert "5 strides" in capsys.readouterr().out


def test_frames_need_a_rate_and_give_the_same_tracks(filmed, tmp_path):
    file = write_table(filmed, tmp_path / "tracks.csv")
    head, *rows = file.read_text().splitlines()
    counted = "\n".join(
        [head.replace("time [s]", "frame"), *(f"{i}{row[row.index(',') :]}" for i, row in enumerate(rows))]
    )
    (tmp_path / "frames.csv").write_text(counted + "\n")
    with pytest.raises(UnusableTracks, match="--fps"):
        read_tracks(tmp_path / "frames.csv")
    again = read_tracks(tmp_path / "frames.csv", ReadingOptions(rate=60.0))
    np.testing.assert_allclose(again.time, filmed.time, atol=1e-4)
    with pytest.raises(UnusableTracks, match="frame rate"):
        read_tracks(tmp_path / "frames.csv", ReadingOptions(rate=-1.0))


def trc(tracks):
    """The text of a TRC file with y up."""
    names, n = tracks.points, len(tracks.time)
    axes = "\t".join("XYZ"[k] + str(i) for i in range(len(names)) for k in range(3))
    lines = [
        "PathFileType\t4\t(X/Y/Z)\ta.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"60\t60\t{n}\t{len(names)}\tmm\t60\t1\t{n}",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        f"\t\t{axes}",
        "",
    ]
    for i, place in enumerate(tracks.position):
        turned = 1000 * place[:, [0, 2, 1]] * np.array([1.0, 1.0, -1.0])
        cells = ["" if np.isnan(x) else f"{x:.3f}" for x in turned.ravel()]
        lines.append(f"{i + 1}\t{tracks.time[i]:.4f}\t" + "\t".join(cells))
    return "\n".join(lines) + "\n"


def test_marker_files_hold_what_was_filmed_whichever_axis_is_up(animal, tmp_path):
    tracks = film_animal(animal, _camera(heights=True, lost=0.02), cycles=2)
    (tmp_path / "a.trc").write_text(trc(tracks))  # y up, as OpenSim has it
    back = read_tracks(tmp_path / "a.trc")
    assert back.points == tracks.points
    assert back.unit == "m"
    np.testing.assert_allclose(back.time, tracks.time, atol=1e-6)
    # right-handed with z up: turned about it by a quarter
    np.testing.assert_allclose(back.position[..., 2], tracks.position[..., 2], atol=1e-6)
    np.testing.assert_allclose(np.hypot(*back.position[..., :2].T), np.hypot(*tracks.position[..., :2].T), atol=1e-6)
    (tmp_path / "b.trc").write_text("nothing")
    with pytest.raises(UnreadableFile, match="no TRC file"):
        read_tracks(tmp_path / "b.trc")


@pytest.mark.filterwarnings("ignore:No analog data")  # says the library that writes it
def test_c3d_files_are_read(animal, tmp_path):
    c3d = pytest.importorskip("c3d")
    tracks = film_animal(animal, _camera(heights=True), cycles=2)
    writer = c3d.Writer(point_rate=60.0, point_units="mm ")
    writer.set_point_labels([name.ljust(16) for name in tracks.points])
    for place in tracks.position:
        points = np.zeros((len(place), 5))
        points[:, :3] = 1000 * place
        writer.add_frames([(points, np.zeros((0, 0)))])
    with (tmp_path / "a.c3d").open("wb") as file:
        writer.write(file)
    back = read_tracks(tmp_path / "a.c3d")
    assert back.points == tracks.points
    np.testing.assert_allclose(back.position, tracks.position, atol=2e-4)
    (tmp_path / "b.c3d").write_bytes(b"nothing")
    with pytest.raises(UnreadableFile, match="C3D"):
        read_tracks(tmp_path / "b.c3d")


def test_skeleton_and_contacts_are_drawn_on_the_film(animal, tmp_path):
    tracks = film_animal(animal, _camera(rate=20.0, scale=300.0), cycles=2)
    low = np.nanmin(tracks.position, axis=(0, 1)) - 20
    tracks = replace(tracks, position=tracks.position - [low[0], low[1] + 200.0])
    for i in range(len(tracks.time)):
        Image.new("RGB", (260, 200), "white").save(tmp_path / f"{i:03d}.png")
    walk = observe(tracks)
    (tmp_path / "out.gif").write_bytes(overlay(tracks, walk.strides, walk.wrong, tmp_path))
    with Image.open(tmp_path / "out.gif") as drawn:
        assert drawn.n_frames == len(tracks.time)
        assert np.asarray(drawn.convert("RGB")).min() < 120
    (tmp_path / "000.png").unlink()
    with pytest.raises(UnusableTracks, match="frame by frame"):
        overlay(tracks, walk.strides, (), tmp_path)
    with pytest.raises(UnusableTracks, match="in pixels"):
        overlay(replace(tracks, unit="m"), walk.strides, (), tmp_path)


def test_time_goes_with_the_square_root_of_length_unless_told(walk, caiman, animal):
    gait = GAITS["belly_crawl"]
    scaled, own = (to_gait(walk, caiman, gait, name="x", time=time) for time in ("froude", "own"))
    assert "square root of length" in scaled.timing
    assert "the animal's own" in own.timing
    factor = float(scaled.timing.split("scaled by ")[1].split(",")[0])
    assert factor == pytest.approx(np.sqrt(0.3425 / animal.trunk), rel=0.02)
    pixels = replace(walk, numbers=walk.numbers | {"trunk_length": walk.numbers["trunk_length"]._replace(unit="px")})
    assert "--trunk" in to_gait(pixels, caiman, gait, name="x").timing
    told = to_gait(pixels, caiman, gait, name="x", trunk=animal.trunk).timing
    assert "scaled by 1.6" in told
    with pytest.raises(UnusableTracks, match="above 0"):
        to_gait(walk, caiman, gait, name="x", trunk=-1.0)


def test_the_animal_beside_the_robot_joint_by_joint(walk, caiman):
    captured = to_gait(walk, caiman, GAITS["belly_crawl"], name="x")
    data = compare_joints(walk, caiman, captured.gait)
    trunk = [f"spine_yaw_{i}" for i in (1, 2, 3)]
    np.testing.assert_allclose(data.animal.sel(joint=trunk), 0.5 / 3 / np.sqrt(2), rtol=0.1)
    assert float(data.residual.sel(joint=trunk).max()) < np.radians(2.0)
    assert "does not reach" in str(data.why.sel(joint="LH_yaw").values)
    straight = captured.gait.bent(0.0)
    apart = compare_joints(walk, caiman, straight)
    np.testing.assert_allclose(apart.residual.sel(joint=trunk), apart.animal.sel(joint=trunk), rtol=0.1)
    assert len(comparison_lines(data, "caiman")) == 1 + data.sizes["joint"]
