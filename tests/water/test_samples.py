import io
from dataclasses import replace

import numpy as np
import pytest
from tests.swims import crocodile_swim

from suchus.core.errors import UnreadableFile
from suchus.core.files.store import sealed
from suchus.core.progress import silent
from suchus.swimming.water.resolved import FREE, TETHERED, SwimSetting, resolved_swim
from suchus.swimming.water.samples import Samples

MOTION = crocodile_swim(yaw=(0.35, 0.15, 0.1), yaw_lag=(0.1, -0.1, -0.3), tail_lag=-0.1)
SETTING = SwimSetting(cells=32, viscosity=1e-3, cycles=1, frames=6)


class _Killed(BaseException):
    """As abrupt as Ctrl-C."""


def _killed_at(share):
    def progress(stage, now):
        if now > share:
            raise _Killed

    return progress


@pytest.mark.parametrize("free", [FREE, TETHERED])
def test_a_killed_swim_goes_on_and_ends_with_the_same_numbers(robot, tmp_path, free):
    file, later, setting = tmp_path / "swim.npz", [], replace(SETTING, free=free)

    def tell(stage, share):
        later.append(share)

    with pytest.raises(_Killed):
        resolved_swim(robot, MOTION, setting, checkpoint=file, progress=_killed_at(0.7))
    again = resolved_swim(robot, MOTION, setting, checkpoint=file, progress=tell)
    assert min(later) > 0.5, "it began anew"
    assert again.identical(resolved_swim(robot, MOTION, setting, progress=silent))
    assert resolved_swim(robot, MOTION, setting, checkpoint=file, progress=tell).identical(again)


def test_another_swim_does_not_go_on_from_it(robot, tmp_path):
    file = tmp_path / "swim.npz"
    with pytest.raises(_Killed):
        resolved_swim(robot, MOTION, SETTING, checkpoint=file, progress=_killed_at(0.3))
    with pytest.raises(UnreadableFile, match=r"another (swim|setup)"):
        resolved_swim(robot, MOTION.with_numbers(tail_bend=0.7), SETTING, checkpoint=file)


def test_samples_come_back_as_they_were_and_no_later_than_asked(tmp_path):
    samples, file = Samples(), tmp_path / "samples"
    for time in (0.1, 0.2, 0.3):
        samples.add("track", time, ends=np.array([time, 2 * time]))
    samples.save(file, 0.3, "a swim")
    back = Samples()
    back.load(file, 0.2, "a swim")
    np.testing.assert_array_equal(back.series("track")["ends"], [[0.1, 0.2], [0.2, 0.4]])
    assert back.count("track") == 2
    assert back.count("frames") == 0


@pytest.mark.parametrize("text", [b"", b"no archive"])
def test_broken_samples_are_refused(tmp_path, text):
    file = tmp_path / "samples"
    file.write_bytes(text)
    with pytest.raises(UnreadableFile, match="delete it"):
        Samples().load(file, 0.0, "a swim")


def test_samples_that_end_too_soon_are_refused(tmp_path):
    samples = Samples()
    samples.add("track", 0.1, ends=np.zeros(2))
    samples.save(tmp_path / "samples", 0.1, "a swim")
    with pytest.raises(UnreadableFile, match="ends before"):
        Samples().load(tmp_path / "samples", 0.5, "a swim")


@pytest.mark.parametrize(
    "values",
    [{}, {"until": 1.0}, {"until": "x", "about": "a"}, {"until": 1.0, "about": "a", "no series": np.zeros(2)},
     {"until": 1.0, "about": "a", "track/ends": np.zeros(2)}, {"until": 1.0, "about": "a", "track/time": 1.0},
     {"until": 1.0, "about": "a", "track/time": np.zeros(2), "track/ends": np.zeros(3)}],
)  # fmt: skip
def test_samples_that_say_something_else_are_refused(tmp_path, values):
    content = io.BytesIO()
    np.savez(content, **values)
    (tmp_path / "samples.npz").write_bytes(sealed(content.getvalue()))
    with pytest.raises(UnreadableFile, match="holds no samples of a swim"):
        Samples().load(tmp_path / "samples.npz", 0.0, "a swim")


def test_a_flipped_bit_of_samples_is_found(tmp_path):
    samples, file = Samples(), tmp_path / "samples"
    samples.add("track", 0.1, ends=np.zeros(2))
    samples.save(file, 0.1, "a swim")
    whole = file.read_bytes()
    for at in range(0, len(whole), 7):
        file.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << at % 8]) + whole[at + 1 :])
        with pytest.raises(UnreadableFile, match="holds no samples of a swim"):
            Samples().load(file, 0.1, "a swim")


def test_samples_that_are_not_there_are_a_sentence(tmp_path):
    with pytest.raises(UnreadableFile, match=r"there is no file .*samples; delete its checkpoint"):
        Samples().load(tmp_path / "samples", 0.0, "a swim")
