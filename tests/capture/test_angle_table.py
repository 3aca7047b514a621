import numpy as np
import pytest

from suchus.animals.capture import read_angles
from suchus.core.errors import InvalidDesign, UnreadableFile

PHASE = np.arange(100) / 100


def written(path, phase, *columns):
    rows = ["time," + ",".join(f"Axis {i + 1}" for i in range(len(columns)))]
    rows += [",".join(f"{value:.12g}" for value in row) for row in zip(phase, *columns, strict=True)]
    path.write_text("\n".join(rows) + "\n")
    return path


def test_angles_come_back_in_radians_and_repeat(tmp_path):
    one, two = 5 + 10 * np.cos(2 * np.pi * (PHASE - 0.2)), 3 * np.sin(8 * np.pi * PHASE)
    cycle = read_angles(written(tmp_path / "walk.csv", PHASE, one, two), harmonics=4)
    assert cycle.joints == ("Axis 1", "Axis 2")
    np.testing.assert_allclose(cycle.at(PHASE), np.radians(np.column_stack([one, two])), atol=1e-10)
    np.testing.assert_allclose(cycle.at(PHASE + 3), cycle.at(PHASE), atol=1e-10)
    np.testing.assert_allclose(cycle.harmonics[0, 1], np.radians(10) * np.exp(-0.4j * np.pi), atol=1e-10)
    assert cycle.residual.max() < 1e-10


def test_a_jump_at_the_seam_is_closed_and_said(tmp_path):
    drifting = 10 * np.cos(2 * np.pi * PHASE) + 6 * PHASE
    cycle = read_angles(written(tmp_path / "walk.csv", PHASE, drifting))
    before, after = cycle.at(np.array([0.995, 0.005]))
    assert abs(after - before)[0] < np.radians(2.5)
    assert np.radians(0.1) < cycle.residual[0] < np.radians(1.0)


@pytest.mark.parametrize("text", ["", "time,a\n", "time,a\n0,x\n", "t,a\n0,1\n", "time,a\n0,1\n0.5,nan\n", "time\n0\n"])
def test_what_is_no_table_is_a_sentence(tmp_path, text):
    path = tmp_path / "walk.csv"
    path.write_text(text)
    with pytest.raises(UnreadableFile, match="is no table of joint angles"):
        read_angles(path)


def test_half_a_cycle_missing_files_and_other_harmonics_are_refused(tmp_path):
    half = written(tmp_path / "half.csv", PHASE[:50], PHASE[:50])
    with pytest.raises(UnreadableFile, match="does not go through one cycle"):
        read_angles(half)
    with pytest.raises(UnreadableFile):
        read_angles(tmp_path / "none.csv")
    with pytest.raises(InvalidDesign, match="4 to 6"):
        read_angles(half, harmonics=9)
