import sys
from dataclasses import replace
from types import ModuleType

import h5py
import numpy as np
import pytest
import xarray as xr

from suchus.animals.capture import ReadingOptions, UnusableTracks, film_animal, observe, read_tracks, write_table
from suchus.animals.capture.markers import upright
from suchus.core.errors import SuchusError, UnknownName, UnreadableFile

HEAD = "time [s],hip_x [mm],hip_y [mm]\n"


@pytest.mark.parametrize(("scale", "heights"), [(None, False), (None, True), (1500.0, False)])
def test_a_table_reads_back(lizard, clean, tmp_path, scale, heights):
    camera = replace(clean, scale=scale, heights=heights, lost=0.05)
    tracks = film_animal(lizard, camera, cycles=3)
    back = read_tracks(write_table(tracks, tmp_path / "a.csv"))
    assert (back.points, back.unit) == (tracks.points, tracks.unit)
    np.testing.assert_allclose(back.time, tracks.time, atol=1e-4)
    np.testing.assert_allclose(back.position, tracks.position, atol=0.06 if scale else 6e-5)
    assert observe(back).value("duty_LF") == pytest.approx(observe(tracks).value("duty_LF"), abs=0.01)


def test_a_path_may_be_a_text(lizard, clean, tmp_path):
    tracks = film_animal(lizard, clean, cycles=1)
    file = write_table(tracks, str(tmp_path / "a.csv"))
    np.testing.assert_array_equal(read_tracks(str(file)).position, read_tracks(file).position)


def test_units_and_confidence_of_a_table(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text(
        "time [s],Tail Base_x [cm],Tail Base_y [cm],Tail Base_confidence [-]\n0,1,2,0.9\n0.02,3,4,0.1\n0.04,,5,1\n"
    )
    tracks = read_tracks(file)
    assert tracks.points == ("tail_base",)
    np.testing.assert_allclose(tracks.at("tail_base"), [[0.01, 0.02], [np.nan] * 2, [np.nan] * 2])
    np.testing.assert_allclose(read_tracks(file, ReadingOptions(confidence=0.05)).at("tail_base")[1], [0.03, 0.04])
    np.testing.assert_allclose(read_tracks(file, ReadingOptions(y_down=True)).at("tail_base")[0], [0.01, -0.02])


def test_pixels_have_y_down(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("time [s],hip_x [px],hip_y [px]\n0,1,2\n")
    np.testing.assert_allclose(read_tracks(file).at("hip"), [[1.0, -2.0]])
    np.testing.assert_allclose(read_tracks(file, ReadingOptions(y_down=False)).at("hip"), [[1.0, 2.0]])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("\n\n", "is empty"),
        (HEAD, "holds a header and no frame"),
        ("clock,hip_x [mm]\n0,1\n", "'time [s]' is needed"),
        ("frame,hip_x [mm]\n0,1\n", "counts frames and does not give their rate; give it, as in --fps 50"),
        ("time [s],hip_x\n0,1\n", "column 'hip_x'"),
        ("time [s],hip_x [inch],hip_y [inch]\n0,1,2\n", "lengths in 'inch'; m, cm, mm, px"),
        ("time [s],hip_x [mm],hip_y [px]\n0,1,2\n", "in mm and in px"),
        ("time [s],hip_x [mm],hip_x [mm]\n0,1,2\n", "hip_x twice"),
        ("time [s]\n0\n", "no column with a position"),
        (HEAD + "0,1\n", "frame 1 of a.csv has 2 cells, the header 3"),
        (HEAD + "0,1,2\n0.02,1,left\n", "frame 2 of a.csv has 'left' in the column 'hip_y [mm]'"),
    ],
)
def test_a_bad_table_is_one_sentence(tmp_path, text, words):
    file = tmp_path / "a.csv"
    file.write_text(text)
    with pytest.raises(SuchusError) as caught:
        read_tracks(file)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_no_file_a_folder_and_no_text(tmp_path):
    for path, words in ((tmp_path / "no.csv", "there is no file"), (tmp_path, "is a folder")):
        with pytest.raises(UnreadableFile, match=words):
            read_tracks(path)
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(UnreadableFile, match="not a text file"):
        read_tracks(tmp_path / "b.csv")
    (tmp_path / "b.xyz").write_text("x")
    with pytest.raises(UnreadableFile, match="--software"):
        read_tracks(tmp_path / "b.xyz")
    with pytest.raises(UnknownName, match="SLEAP"):
        read_tracks(tmp_path / "b.xyz", ReadingOptions(software="Sleep"))


@pytest.fixture
def deeplabcut(tmp_path):
    """A file that only the library reads."""
    file = tmp_path / "dlc.h5"
    with h5py.File(file, "w") as store:
        table = np.array([(4,), (5,), (8,)], dtype=[("index", int)])
        store.create_dataset("df_with_missing/table", data=table)
    return file


def test_without_the_library_a_sentence_says_how_to_install_it(deeplabcut, monkeypatch):
    monkeypatch.setitem(sys.modules, "movement", None)
    monkeypatch.setitem(sys.modules, "movement.io", None)
    with pytest.raises(UnreadableFile, match=r'DeepLabCut.*pip install "suchus\[capture\]"'):
        read_tracks(deeplabcut)


@pytest.fixture
def movement(monkeypatch):
    """A stand-in with the library's own layout: time, space, keypoints, individuals."""
    said = {}

    def load_dataset(path, source_software, fps):
        said.update(software=source_software, fps=fps)
        if fps is None:
            return data().assign_attrs(time_unit="frames")
        return data()

    def data():
        position = np.arange(24.0).reshape(3, 2, 2, 2)
        return xr.Dataset(
            {
                "position": (("time", "space", "keypoints", "individuals"), position),
                "confidence": (
                    ("time", "keypoints", "individuals"),
                    np.array([[[0.9, 0.9], [0.9, 0.9]]] * 2 + [[[0.9, 0.9], [0.1, 0.9]]]),
                ),
            },
            coords={
                "time": [0.0, 0.1, 0.2],
                "space": ["x", "y"],
                "keypoints": ["hip", "LF"],
                "individuals": ["one", "two"],
            },
            attrs={"time_unit": "seconds"},
        )

    package, io = ModuleType("movement"), ModuleType("movement.io")
    io.load_dataset = load_dataset
    for module in (package, io):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    return said


def test_poses_of_one_individual_with_y_down(deeplabcut, movement):
    tracks = read_tracks(deeplabcut, ReadingOptions(rate=10.0, individual="one"))
    assert movement == {"software": "DeepLabCut", "fps": 10.0}
    assert (tracks.points, tracks.unit) == (("hip", "LF"), "px")
    np.testing.assert_allclose(tracks.time, [0.4, 0.5, 0.8])  # the file's frames, not the library's count
    np.testing.assert_allclose(tracks.at("hip"), [[0, -4], [8, -12], [16, -20]])
    assert np.isnan(tracks.at("LF")[2]).all()  # the tracker was not sure
    np.testing.assert_allclose(tracks.at("LF")[:2], [[2, -6], [10, -14]])


def test_poses_need_a_rate_and_a_choice(deeplabcut, movement):
    with pytest.raises(UnusableTracks, match="--fps"):
        read_tracks(deeplabcut)
    with pytest.raises(UnusableTracks, match="2 individuals; choose one with --individual: one, two"):
        read_tracks(deeplabcut, ReadingOptions(rate=10.0))
    with pytest.raises(UnusableTracks, match="no individual 'three'"):
        read_tracks(deeplabcut, ReadingOptions(rate=10.0, individual="three"))


def test_what_is_up_does_not_depend_on_where_the_animal_goes(lizard, noisy):
    for heading in (0.0, 1.57, 2.1, -2.5):
        camera = replace(noisy, heading=heading, heights=True, noise=0.0)
        tracks = film_animal(lizard, camera, cycles=4)
        np.testing.assert_array_equal(upright(tracks.position, tracks.points), tracks.position)


KINDS = ("DeepLabCut.h5", "DeepLabCut.csv", "SLEAP.analysis.h5", "SLEAP.slp", "Anipose.csv")


def poses(kind, tracks, path):
    """Write tracks as a file of a pose estimator; ``movement`` and the libraries that come with it do."""
    position = tracks.position if tracks.has_heights else tracks.position * [1.0, -1.0]  # images have y down
    if kind == "SLEAP.slp":
        sio = pytest.importorskip("sleap_io")
        skeleton, track = sio.Skeleton(list(tracks.points)), sio.Track("it")
        video = sio.Video(filename="film.mp4", backend=None, open_backend=False)
        frames = [
            sio.LabeledFrame(
                video=video,
                frame_idx=i,
                instances=[
                    sio.PredictedInstance.from_numpy(
                        points, point_scores=np.ones(len(points)), score=1.0, skeleton=skeleton, track=track
                    )
                ],
            )
            for i, points in enumerate(position)
        ]
        labels = sio.Labels(labeled_frames=frames, videos=[video], skeletons=[skeleton], tracks=[track])
        sio.save_file(labels, str(path), embed=False)
        return
    if kind == "Anipose.csv":
        columns = {}
        for name, place in zip(tracks.points, position.transpose(1, 2, 0), strict=True):
            columns |= {f"{name}_{axis}": row for axis, row in zip("xyz", place, strict=True)}
            columns |= {f"{name}_error": 0.0, f"{name}_score": 1.0, f"{name}_ncams": 2.0}
        columns |= {f"M_{i}{j}": float(i == j) for i in range(3) for j in range(3)}
        columns |= {f"center_{i}": 0.0 for i in range(3)} | {"fnum": np.arange(len(tracks.time))}
        rows = np.column_stack([np.broadcast_to(one, len(tracks.time)) for one in columns.values()])
        np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.6g")
        return
    load = pytest.importorskip("movement.io.load_poses")
    save_poses = pytest.importorskip("movement.io.save_poses")
    flat = position.transpose(0, 2, 1)[..., None]
    data = load.from_numpy(flat, keypoint_names=list(tracks.points), individual_names=["it"], fps=100)
    if kind.startswith("SLEAP"):
        save_poses.to_sleap_analysis_file(data, path)
    else:
        save_poses.to_dlc_file(data, path, split_individuals=False)


@pytest.mark.parametrize("kind", KINDS)
def test_the_real_library_reads_files_of_every_kind(kind, lizard, noisy, tmp_path):
    """Files of DeepLabCut and SLEAP as their own libraries write them, of Anipose as its manual has them."""
    pytest.importorskip("movement.io")
    camera = replace(noisy, rate=100.0, noise=0.0005, heights=kind.startswith("Anipose"), lost=0.01)
    tracks = film_animal(lizard, camera, cycles=4)
    poses(kind, tracks, tmp_path / kind)
    back = read_tracks(tmp_path / kind, ReadingOptions(rate=100.0))
    assert set(back.points) == set(tracks.points)
    assert back.unit == "px"
    np.testing.assert_allclose(back.time, tracks.time, atol=1e-9)
    for point in tracks.points:
        assert (np.isfinite(back.at(point)) == np.isfinite(tracks.at(point))).all()
    apart = [np.linalg.norm(one.at("hip") - one.at("LF"), axis=-1) for one in (back, tracks)]
    np.testing.assert_allclose(*apart, rtol=1e-4, atol=1e-2)
    assert observe(back).value("duty_LF") == pytest.approx(observe(tracks).value("duty_LF"), abs=1e-3)


def test_one_animal_of_several_in_a_real_file_is_chosen_by_its_name(lizard, noisy, tmp_path):
    load = pytest.importorskip("movement.io.load_poses")
    save_poses = pytest.importorskip("movement.io.save_poses")
    tracks = film_animal(lizard, replace(noisy, rate=100.0, lost=0.0), cycles=2)
    one = (tracks.position * [1.0, -1.0]).transpose(0, 2, 1)[..., None]
    both = np.concatenate([one, one + 500.0], axis=-1)
    data = load.from_numpy(both, keypoint_names=list(tracks.points), individual_names=["first", "other"], fps=100)
    save_poses.to_dlc_file(data, tmp_path / "two.h5", split_individuals=False)
    with pytest.raises(UnusableTracks, match="choose one with --individual: first, other"):
        read_tracks(tmp_path / "two.h5", ReadingOptions(rate=100.0))
    other = read_tracks(tmp_path / "two.h5", ReadingOptions(rate=100.0, individual="other"))
    np.testing.assert_allclose(other.position, tracks.position + np.array([500.0, -500.0]))
