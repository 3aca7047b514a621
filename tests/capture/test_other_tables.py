"""Tables as other programs write them: separators, gaps, names of feet, kinds that are not read."""

from dataclasses import replace

import h5py
import numpy as np
import pytest

from suchus.animals.capture import ReadingOptions, UnusableTracks, film_animal, observe, read_tracks, write_table
from suchus.animals.capture.names import nearest_name
from suchus.animals.capture.tracks import with_gaps
from suchus.core.errors import UnreadableFile


@pytest.fixture(scope="module")
def film(lizard, clean):
    return film_animal(lizard, replace(clean, rate=50.0, noise=0.001, heights=False), cycles=6)


@pytest.mark.parametrize(("separator", "decimal"), [(";", ","), (";", "."), ("\t", "."), (",", ".")])
def test_a_table_may_be_separated_as_spreadsheets_do(separator, decimal, film, tmp_path):
    """With semicolons the whole header was quoted as the name of its first column."""
    text = write_table(film, tmp_path / "a.csv").read_text()
    text = text.replace(",", separator).replace(".", decimal)
    (tmp_path / "b.csv").write_text(text)
    np.testing.assert_array_equal(read_tracks(tmp_path / "b.csv").position, read_tracks(tmp_path / "a.csv").position)


def test_a_table_of_deeplabcut_with_semicolons_is_known(tmp_path):
    (tmp_path / "a.csv").write_text("scorer;s;s;s\nbodyparts;hip;hip;hip\ncoords;x;y;likelihood\n0;1,5;2,5;0,9\n")
    tracks = read_tracks(tmp_path / "a.csv", ReadingOptions(rate=50.0))
    np.testing.assert_allclose(tracks.at("hip"), [[1.5, -2.5]])


def test_a_stride_is_right_where_a_file_leaves_out_half_a_cycle(film):
    """The advance in the cycle with the gap was extrapolated: 1.83 trunk lengths for 1.25."""
    keep = np.r_[0:80, 100 : len(film.time)]
    walk = observe(replace(film, time=film.time[keep], position=film.position[keep]))
    whole = observe(film)
    assert abs(walk.value("stride") - whole.value("stride")) < 0.02
    assert walk.numbers["stride"].error < 0.03
    assert walk.value("period") == pytest.approx(0.8, abs=0.005)


def test_points_lost_in_half_of_one_cycle_do_not_widen_the_bend(film):
    """Its interval was 31 degrees, by a fit that went anywhere in the gap."""
    position = film.position.copy()
    position[20:40] = np.nan
    walk = observe(replace(film, position=position))
    assert walk.value("spine_lateral") == pytest.approx(0.5, abs=0.01)
    assert walk.numbers["spine_lateral"].error < 0.03


def test_frames_that_are_left_out_become_lost_points(film):
    keep = np.r_[0:10, 13:30]
    gaps = with_gaps(replace(film, time=film.time[keep], position=film.position[keep]))
    np.testing.assert_allclose(gaps.time, film.time[:30])
    assert np.isnan(gaps.position[10:13]).all()
    np.testing.assert_array_equal(gaps.position[13:], film.position[13:30])
    assert with_gaps(film) is film


def renamed(tracks, names):
    return replace(tracks, points=tuple(names.get(name, name) for name in tracks.points))


def test_feet_without_a_side_in_their_names_are_asked_for(film):
    """Four paws with numbers were measured as an animal without feet."""
    paws = dict(zip(("LF", "RF", "LH", "RH"), ("paw_1", "paw_2", "paw_3", "paw_4"), strict=True))
    with pytest.raises(UnusableTracks, match=r"paw_1 and paw_2 and paw_3 and paw_4 seem to be feet; say which"):
        observe(renamed(film, paws))
    others = {leg: f"other_{i}" for i, leg in enumerate(paws)}
    assert not any(name.startswith("duty") for name in observe(renamed(film, others)).numbers)


@pytest.mark.parametrize(
    ("name", "keypoint"),
    [
        ("patte_avant_gauche", "LF"), ("pied_gauche_arrière", "LH"), ("vorne_rechts", "RF"),
        ("Pfote hinten links", "LH"), ("pata_delantera_derecha", "RF"), ("left_hind_paw", "LH"), ("nose", "snout"),
    ],
)  # fmt: skip
def test_names_in_other_languages_have_the_nearest_keypoint(name, keypoint):
    assert nearest_name(name) == keypoint


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("a.xlsx", "save the sheet as CSV"), ("a.mat", "write it as a CSV table"),
        ("a.json", "write it as a CSV table"),
        ("a.zip", "unpack it"), ("a.h5", "is damaged or cut"),
    ],
)  # fmt: skip
def test_what_is_not_read_is_refused_with_its_remedy(name, words, tmp_path):
    with h5py.File(tmp_path / "whole.h5", "w") as store:
        store["x"] = np.zeros(1000)
    (tmp_path / name).write_bytes((tmp_path / "whole.h5").read_bytes()[:200])
    with pytest.raises(UnreadableFile, match=words):
        read_tracks(tmp_path / name, ReadingOptions(rate=50.0))


def test_keypoints_with_one_fault_share_a_clause(film):
    with pytest.raises(UnusableTracks) as caught:
        observe(replace(film, position=film.position * np.nan))
    assert str(caught.value).count("is lost in 100 % of the frames") == 1
    assert str(caught.value).endswith("ask for less with --confidence.")
