"""Bad input is one sentence that names what is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.animals.capture import UnusableTracks, film, film_animal, observe, to_gait
from suchus.animals.capture.tracks import map_keypoint_names
from suchus.robot.gaits import GAITS


@pytest.fixture(scope="module")
def tracks(lizard, clean):
    return film_animal(lizard, replace(clean, heights=False), cycles=4)


@pytest.fixture(scope="module")
def whole(tracks):
    return observe(tracks).numbers


def without(tracks, *names):
    keep = [i for i, name in enumerate(tracks.points) if name not in names]
    return replace(tracks, points=tuple(tracks.points[i] for i in keep), position=tracks.position[:, keep])


def swapped(tracks, left, right, frames=slice(None)):
    position = tracks.position.copy()
    i, j = tracks.points.index(left), tracks.points.index(right)
    position[frames, i], position[frames, j] = tracks.position[frames, j], tracks.position[frames, i]
    return replace(tracks, position=position)


def refused(tracks, *words):
    with pytest.raises(UnusableTracks) as caught:
        observe(tracks)
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert sentence.endswith(".")
    for word in words:
        assert word in sentence
    return sentence


def test_missing_keypoints_are_named(caiman, tracks):
    for gone, named in ((("LF", "shoulder"), "keypoints shoulder, LF that"), (("neck",), "neck (or snout)")):
        walk = observe(without(tracks, *gone))
        with pytest.raises(UnusableTracks, match="--names") as caught:
            to_gait(walk, caiman, GAITS["belly_crawl"], name="x")
        assert named in str(caught.value)
        assert any(f"without {gone[0]}" in note for note in walk.notes)
    refused(without(tracks, "neck", "shoulder", "hip", "tail_base", "spine_1", "spine_2"), "fewer than two keypoints")


def test_a_part_of_the_keypoints_measures_what_it_shows(tracks, whole):
    for gone, unknown in (
        ("LH", "duty_LH"),
        ("neck", "spine_lateral"),
        ("tail_tip", "tail_lateral"),
        ("hip", "stride"),
    ):
        part = observe(without(tracks, gone)).numbers
        assert unknown in whole
        assert unknown not in part
        assert part["duty_RF"].value == pytest.approx(whole["duty_RF"].value, abs=0.01)
        assert part["phase_RF"].value == pytest.approx(whole["phase_RF"].value, abs=0.005)


def test_a_snout_does_where_there_is_no_neck(tracks, whole):
    points = tuple("snout" if name == "neck" else name for name in tracks.points)
    seen = observe(replace(tracks, points=points)).numbers
    assert {name: one.value for name, one in seen.items()} == {name: one.value for name, one in whole.items()}


def test_a_point_that_is_mostly_lost_is_named_and_left_out(tracks):
    position = tracks.position.copy()
    position[: int(0.7 * len(position)), tracks.points.index("RH")] = np.nan
    walk = observe(replace(tracks, position=position))
    assert walk.notes[0].startswith("RH is lost in 70 % of the frames")
    assert walk.lacks == ("RH",)


def test_points_lost_in_turns_are_told(tracks):
    position = tracks.position.copy()
    most = int(0.45 * len(position))
    position[:most, tracks.points.index("neck")] = np.nan
    position[-most:, tracks.points.index("tail_base")] = np.nan
    refused(replace(tracks, position=position), "the spine's bend", "lost in turns")


@pytest.mark.parametrize("cycles", [0.4, 0.7, 1.05])
def test_less_than_a_cycle(lizard, clean, cycles):
    refused(film_animal(lizard, clean, cycles=cycles), "cycles are needed")


def test_less_than_a_cycle_of_our_crawl(caiman, crawl, noisy):
    refused(film(caiman, crawl.sel(time=slice(0, 4.0)), noisy), "cycles are needed")


def test_swapped_pairs_are_named(tracks):
    refused(swapped(tracks, "LF", "RF"), "LF lies on the right", "100 %", "LF=RF RF=LF")
    refused(swapped(tracks, "LH", "RH"), "LH lies on the right", "LH=RH RH=LH")
    refused(swapped(swapped(tracks, "LF", "RF"), "LH", "RH"), "both pairs", "y points the other way")


def test_a_swap_for_a_while_is_named_with_its_frames(tracks):
    refused(swapped(tracks, "LH", "RH", slice(100, 130)), "30 frames", "frame 101 at 1.00 s", "frame 130")


@pytest.mark.parametrize("last", [1e308, 1e9, 20.0])
def test_a_time_far_from_all_others_is_named(tracks, last):
    time = tracks.time.copy()
    time[-1] = last
    refused(replace(tracks, time=time), f"nothing was filmed from frame {len(time) - 1} to frame {len(time)}")


def test_a_pause_shorter_than_the_rest_is_read(tracks):
    keep = np.r_[0:30, 60 : len(tracks.time)]
    observe(replace(tracks, time=tracks.time[keep], position=tracks.position[keep]))


def test_wrong_units_are_told(tracks):
    refused(replace(tracks, position=1000 * tracks.position), "the trunk measures 120 m", "unit is wrong")
    refused(replace(tracks, position=tracks.position / 1000), "unit is wrong")
    refused(replace(tracks, time=1000 * tracks.time), "milliseconds")
    refused(replace(tracks, time=tracks.time / 1000), "apart")


def test_time_must_increase(tracks):
    time = tracks.time.copy()
    time[7] = time[6]
    refused(replace(tracks, time=time), "frame 7 to frame 8")


def test_no_frame_and_one_frame(tracks):
    refused(tracks.between(50.0, None), "0 frames")
    refused(tracks.between(0.0, 0.0), "1 frame;")


def test_an_animal_at_rest(tracks):
    still = np.broadcast_to(tracks.position[:1], tracks.position.shape)
    refused(replace(tracks, position=still), "the animal stands", "--start")


def test_a_camera_that_goes_along(tracks, whole):
    """The hip stays where it is in the picture: standing feet show how fast the ground goes."""
    walk = observe(replace(tracks, position=tracks.position - tracks.at("hip")[:, None, :]))
    assert any("the camera follows it" in note for note in walk.notes)
    assert walk.value("stride") == pytest.approx(whole["stride"].value, rel=0.02)
    feet = [tracks.points.index(leg) for leg in ("LF", "RF", "LH", "RH")]
    position = tracks.position - tracks.at("hip")[:, None, :]
    position[:, feet] += np.linspace(0.0, 0.02, len(position))[:, None, None]  # fewer feet than show the ground
    refused(
        replace(without(tracks, "RH", "LH"), position=np.delete(position, feet[2:], axis=1)), "the camera goes along"
    )


def test_noise_that_hides_the_steps(lizard, clean):
    loud = film_animal(lizard, replace(clean, heights=False, noise=0.02), cycles=4)
    with pytest.raises(UnusableTracks):
        observe(loud)


def test_names_are_known_however_they_are_written():
    ours = map_keypoint_names(("Tail Base", "tailTip", "lf", "Spine1", "paw"), {"paw": "RH"}, "a file")
    assert ours == ("tail_base", "tail_tip", "LF", "spine_1", "RH")
    with pytest.raises(UnusableTracks, match="no keypoint 'foot'"):
        map_keypoint_names(("hip",), {"foot": "LF"}, "a file")
    with pytest.raises(UnusableTracks, match="more than one keypoint 'LF'"):
        map_keypoint_names(("lf", "LF"), {}, "a file")
