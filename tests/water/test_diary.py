from dataclasses import replace

import numpy as np
import pytest

from suchus.errors import UnreadableFile
from suchus.motion import Swim
from suchus.water import Tether, free_swim, tether
from suchus.water.diary import Diary

MOTION = Swim(name="wave", frequency=1.0, yaw=(0.35, 0.15, 0.1), yaw_late=(0.1, -0.1, -0.3), tail=0.75, tail_late=-0.1)
SETTING = Tether(cells=32, viscosity=1e-3, cycles=1, frames=6)


class _Killed(BaseException):
    """As abrupt as Ctrl-C."""


def _killed_at(share):
    def progress(now):
        if now > share:
            raise _Killed

    return progress


@pytest.mark.parametrize("swim", [free_swim, tether])
def test_a_killed_swim_goes_on_and_ends_with_the_same_numbers(robot, tmp_path, swim):
    file, later = tmp_path / "swim.npz", []
    with pytest.raises(_Killed):
        swim(robot, MOTION, SETTING, checkpoint=file, progress=_killed_at(0.7))
    again = swim(robot, MOTION, SETTING, checkpoint=file, progress=later.append)
    assert min(later) > 0.5, "it began anew"
    assert again.identical(swim(robot, MOTION, SETTING, progress=lambda _: None))
    assert swim(robot, MOTION, SETTING, checkpoint=file, progress=later.append).identical(again)


def test_another_swim_does_not_go_on_from_it(robot, tmp_path):
    file = tmp_path / "swim.npz"
    with pytest.raises(_Killed):
        free_swim(robot, MOTION, SETTING, checkpoint=file, progress=_killed_at(0.3))
    with pytest.raises(UnreadableFile, match=r"another (swim|setup)"):
        free_swim(robot, replace(MOTION, tail=0.7), SETTING, checkpoint=file)


def test_notes_come_back_as_they_were_and_no_later_than_asked(tmp_path):
    diary, file = Diary(), tmp_path / "notes"
    for time in (0.1, 0.2, 0.3):
        diary.note("track", time, ends=np.array([time, 2 * time]))
    diary.save(file, 0.3, "a swim")
    back = Diary()
    back.load(file, 0.2, "a swim")
    np.testing.assert_array_equal(back.page("track")["ends"], [[0.1, 0.2], [0.2, 0.4]])
    assert back.count("track") == 2
    assert back.count("frames") == 0


@pytest.mark.parametrize("text", [b"", b"no archive"])
def test_broken_notes_are_refused(tmp_path, text):
    file = tmp_path / "notes"
    file.write_bytes(text)
    with pytest.raises(UnreadableFile, match="delete it"):
        Diary().load(file, 0.0, "a swim")


def test_notes_that_end_too_soon_are_refused(tmp_path):
    diary = Diary()
    diary.note("track", 0.1, ends=np.zeros(2))
    diary.save(tmp_path / "notes", 0.1, "a swim")
    with pytest.raises(UnreadableFile, match="ends before"):
        Diary().load(tmp_path / "notes", 0.5, "a swim")
