import io
from dataclasses import replace

import numpy as np
import pytest

from suchus.design import crocodile
from suchus.errors import UnreadableFile
from suchus.motion import Swim
from suchus.record.seal import sealed
from suchus.water import Tether, free_swim, tether
from suchus.water.diary import Diary

MOTION = Swim(name="wave", frequency=1.0, yaw=(0.35, 0.15, 0.1), yaw_lag=(0.1, -0.1, -0.3), tail=0.75, tail_lag=-0.1)
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
        free_swim(robot, crocodile(replace(MOTION.tables, tail=0.7)), SETTING, checkpoint=file)


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


@pytest.mark.parametrize(
    "values",
    [{}, {"until": 1.0}, {"until": "x", "about": "a"}, {"until": 1.0, "about": "a", "no page": np.zeros(2)},
     {"until": 1.0, "about": "a", "track/ends": np.zeros(2)}, {"until": 1.0, "about": "a", "track/time": 1.0},
     {"until": 1.0, "about": "a", "track/time": np.zeros(2), "track/ends": np.zeros(3)}],
)  # fmt: skip
def test_notes_that_say_something_else_are_refused(tmp_path, values):
    content = io.BytesIO()
    np.savez(content, **values)
    (tmp_path / "notes.npz").write_bytes(sealed(content.getvalue()))
    with pytest.raises(UnreadableFile, match="holds no notes of a swim"):
        Diary().load(tmp_path / "notes.npz", 0.0, "a swim")


def test_a_flipped_bit_of_notes_is_found(tmp_path):
    diary, file = Diary(), tmp_path / "notes"
    diary.note("track", 0.1, ends=np.zeros(2))
    diary.save(file, 0.1, "a swim")
    whole = file.read_bytes()
    for at in range(0, len(whole), 7):
        file.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << at % 8]) + whole[at + 1 :])
        with pytest.raises(UnreadableFile, match="holds no notes of a swim"):
            Diary().load(file, 0.1, "a swim")


def test_notes_that_are_not_there_are_a_sentence(tmp_path):
    with pytest.raises(UnreadableFile, match="cannot be read: no such file"):
        Diary().load(tmp_path / "notes", 0.0, "a swim")
