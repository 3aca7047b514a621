"""Tables of pose estimators: frames that are left out are gaps, and other names are never silence."""

from pathlib import Path

import numpy as np
import pytest

from suchus.animals.capture import ReadingOptions, UnusableTracks, observe, read_tracks
from suchus.animals.capture.names import is_keypoint, nearest_name, unused_points
from suchus.core.errors import SuchusError, UnreadableFile

DATA = Path(__file__).parents[1] / "data" / "animals"
HEADER = "scorer,n,n,n\nbodyparts,hip,hip,hip\ncoords,x,y,likelihood\n"


@pytest.mark.parametrize(
    ("file", "individual"),
    [("whole.csv", None), ("gaps.csv", None), ("analysis.csv", None), ("two_and_corner.csv", "a")],
)
def test_the_walk_is_the_same_in_every_layout(file, individual):
    """DeepLabCut with and without gaps, SLEAP's analysis table, and one animal of two beside a corner."""
    walk = observe(read_tracks(DATA / file, ReadingOptions(rate=50.0, individual=individual)))
    assert not walk.wrong
    assert walk.value("period") == pytest.approx(1.6, abs=0.01)
    assert walk.value("stride") == pytest.approx(0.9, abs=0.015)


def test_frames_that_are_left_out_are_gaps():
    tracks = read_tracks(DATA / "gaps.csv", ReadingOptions(rate=50.0))
    steps = np.round(np.diff(tracks.time) * 50).astype(int)
    assert sorted(set(steps)) == [1, 15]
    assert (steps == 15).sum() == 4
    tracks = read_tracks(DATA / "analysis.csv", ReadingOptions(rate=50.0))
    assert np.round(np.diff(tracks.time) * 50).max() > 1


def test_individuals_are_chosen_and_the_corner_is_none():
    path = DATA / "two_and_corner.csv"
    with pytest.raises(UnusableTracks, match=r"2 individuals; choose one with --individual: a, b\."):
        read_tracks(path, ReadingOptions(rate=50.0))
    with pytest.raises(UnusableTracks, match="no individual 'c'; it holds a, b"):
        read_tracks(path, ReadingOptions(rate=50.0, individual="c"))
    a, b = (read_tracks(path, ReadingOptions(rate=50.0, individual=name)) for name in "ab")
    assert "corner" not in a.points
    assert np.nanmedian(b.at("hip")[:, 0] - a.at("hip")[:, 0]) > 100.0


def test_likelihood_pictures_and_heights_of_deeplabcut(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text(HEADER + "labeled-data/film/img0007.png,1,2,0.9\nlabeled-data/film/img0011.png,3,4,0.1\n")
    tracks = read_tracks(file, ReadingOptions(rate=10.0))
    np.testing.assert_allclose(tracks.time, [0.7, 1.1])
    np.testing.assert_allclose(tracks.at("hip"), [[1.0, -2.0], [np.nan, np.nan]])
    file.write_text(HEADER.replace("likelihood", "z") + "3,1,2,5\n4,1,2,\n")
    tracks = read_tracks(file, ReadingOptions(rate=10.0))
    np.testing.assert_allclose(tracks.at("hip"), [[1.0, 2.0, 5.0], [np.nan] * 3])


def test_a_table_may_have_frames_and_times(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("frame,time [s],hip_x [mm],hip_y [mm]\n7,0.5,1,2\n9,0.75,3,4\n")
    tracks = read_tracks(file)
    np.testing.assert_allclose(tracks.time, [0.5, 0.75])
    assert tracks.points == ("hip",)


def trc(path, frames, times, rate=100.0):
    lines = [
        "PathFileType\t4\t(X/Y/Z)\ta.trc",
        "DataRate\tUnits",
        f"{rate:g}\tmm",
        "Frame#\tTime\thip\t\t",
        "\t\tX1\tY1\tZ1",
    ]
    rows = [f"{frame}\t{time}\t{i}\t0\t0" for i, (frame, time) in enumerate(zip(frames, times, strict=True))]
    path.write_text("\n".join([*lines, *rows]) + "\n")
    return path


def test_frames_and_times_of_a_marker_file(tmp_path):
    time = read_tracks(trc(tmp_path / "a.trc", [1, 2, 9], [0.0, 0.01, 0.08])).time
    np.testing.assert_allclose(np.diff(time), [0.01, 0.07])
    time = read_tracks(trc(tmp_path / "b.trc", ["", "", ""], [0.0, 0.01, 0.08])).time
    np.testing.assert_allclose(np.diff(time), [0.01, 0.07])
    with pytest.raises(UnreadableFile, match="50 frames a second, and its DataRate is 100"):
        read_tracks(trc(tmp_path / "c.trc", [1, 2, 3], [0.0, 0.02, 0.04]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEADER, "holds a header and no frame"),
        ("scorer,n\nbodyparts,hip\n0,1\n", "is no table of DeepLabCut"),
        (HEADER + "0,1,2\n", "frame 1 of a.csv has 3 cells, the header 4"),
        (HEADER + "0,1,left,1\n", "has 'left' in the column 'hip y'"),
        (HEADER + "one,1,2,1\n", "begins with 'one'; the number of a frame is needed"),
        ("track,frame_idx,hip.x,hip.y\n,0,1,2\n,0,3,4\n", "two instances without a track in frame 0"),
        ("track,frame_idx,hip.x,hip.y\na,0,1,2\nb,0,3,4\n", "choose one with --individual: a, b"),
        ("time [s]" + ",k_x [px]" * 6000 + "\n", "6001 columns; at most 5000 are read"),
    ],
)
def test_a_bad_table_of_poses_is_one_sentence(tmp_path, text, words):
    file = tmp_path / "a.csv"
    file.write_text(text)
    with pytest.raises(SuchusError) as caught:
        read_tracks(file, ReadingOptions(rate=50.0))
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "keypoint"),
    [
        ("left_fore_paw", "LF"),
        ("hindpaw_right", "RH"),
        ("FL", "LF"),
        ("RR", "RH"),
        ("paw_l_hind", "LH"),
        ("right_hand", "RF"),
        ("nose", "snout"),
        ("tail_root", "tail_base"),
        ("tailtip", "tail_tip"),
        ("pelvis", "hip"),
        ("shoulderr", "shoulder"),
        ("left_eye", None),
        ("object", None),
    ],
)
def test_the_nearest_keypoint_of_a_name(name, keypoint):
    assert nearest_name(name) == keypoint
    assert not is_keypoint(name)


def renamed(names):
    tracks = read_tracks(DATA / "needed_points.csv")
    return tracks.__class__(
        time=tracks.time,
        points=tuple(names.get(name, name) for name in tracks.points),
        position=tracks.position,
        unit=tracks.unit,
        source=tracks.source,
    )


def test_feet_with_other_names_are_never_no_feet():
    names = {"LF": "left_forepaw", "RF": "right_forepaw", "LH": "left_hindpaw", "RH": "right_hindpaw"}
    with pytest.raises(UnusableTracks, match="give --names left_forepaw=LF right_forepaw=RF left_hindpaw=LH"):
        observe(renamed(names))
    with pytest.raises(UnusableTracks, match="without feet, --names left_forepaw=other_1"):
        observe(renamed(names))
    walk = observe(renamed({name: f"other_{i}" for i, name in enumerate(names)}))
    assert "duty_LF" not in walk.numbers
    assert any("other_0, other_1, other_2, other_3 are not used" in note for note in walk.notes)


def test_unused_names_are_listed_with_what_to_give():
    walk = observe(renamed({"RH": "hind_right", "neck": "left_eye"}))
    note = next(note for note in walk.notes if "not used" in note)
    assert note == "left_eye, hind_right are not used: give --names hind_right=RH, if that is what they are"
    assert unused_points(("hip", "spine_4", "tail_2")) == {}
    with pytest.raises(UnusableTracks, match="--names nape=neck withers=shoulder pelvis=hip tail_root=tail_base"):
        observe(renamed({"neck": "nape", "shoulder": "withers", "hip": "pelvis", "tail_base": "tail_root"}))


def test_names_may_be_given_as_the_notes_spell_them(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("time [s],Left Fore Paw_x [mm],Left Fore Paw_y [mm]\n0,1,2\n")
    for name in ("Left Fore Paw", "left_fore_paw"):
        assert read_tracks(file, ReadingOptions(names={name: "LF"})).points == ("LF",)
