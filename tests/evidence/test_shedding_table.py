"""What ends of bodies shed: the bodies are those that are named, the table is kept with its intervals."""

from dataclasses import replace

import numpy as np
import pytest

from evidence import shedding, store
from evidence.shedding import ASPECTS, ENDS, HALF_HEIGHT, KEULEGAN_CARPENTER, Heave, shed_range, with_interval

HEAVE = Heave(end="square", aspect=2.0, keulegan_carpenter=4.0)


def test_ends_have_their_shapes():
    s = np.linspace(0.0, 1.0, 1001)
    square, blunt, pointed = (replace(HEAVE, end=end).half_heights(s) for end in ENDS)
    assert square[-1] == pytest.approx(HALF_HEIGHT)
    assert max(blunt[-1], pointed[-1]) < 0.05 * HALF_HEIGHT
    assert pointed[850] == pytest.approx(0.5 * HALF_HEIGHT, rel=1e-3)
    assert blunt[950] == pytest.approx(0.75**0.5 * HALF_HEIGHT, rel=1e-3)
    for heights in (square, blunt, pointed):
        np.testing.assert_allclose(heights[250:700], HALF_HEIGHT)


def test_a_heave_has_its_keulegan_carpenter_number_and_exact_rates():
    times = np.linspace(0.0, 3.0, 3001)
    poses = [HEAVE.pose(time) for time in times]
    y, rate = (np.array([getattr(pose, name)[1] for pose in poses]) for name in ("position", "velocity"))
    np.testing.assert_allclose(np.gradient(y, times)[5:-5], rate[5:-5], atol=0.02)
    assert np.abs(rate[times > 1.0]).max() / (2 * HALF_HEIGHT) == pytest.approx(4.0, rel=1e-4)
    steady = Heave(end="round", aspect=1.0, keulegan_carpenter=KEULEGAN_CARPENTER[-1])
    assert steady.pose(1.3).velocity == (0.0, 0.0, 0.0)
    stream = steady.setup().stream
    assert stream[1] / stream[0] == pytest.approx(np.tan(shedding.ANGLE))


def test_drag_that_is_even_along_the_body_is_no_shedding(monkeypatch):
    """A nose of one, a tail that gets again a quarter, and drag by length alone: the share is three quarters."""
    unit = np.pi * HALF_HEIGHT**2 * shedding.STRIDE * HEAVE.velocity
    drag = 3.0 * np.array([0.3, 0.4, 0.3])
    monkeypatch.setattr(Heave, "resistances", lambda self: unit * (drag + np.array([[1.0, 0.0, -0.25]] * 2)))
    nose, tail = HEAVE.ends()
    np.testing.assert_allclose(nose, 1.0)
    np.testing.assert_allclose(1.0 + tail, 0.75)


def test_the_interval_holds_the_share_in_both_units():
    row = with_interval({"share": 0.6, "nose": 0.8}, 0.05)
    assert row["low"] == pytest.approx(1.0 - 0.4 / 0.8 - 0.05)
    assert row["high"] == pytest.approx(0.65)


def test_the_kept_table_has_every_end_within_its_interval():
    values = store.load("shedding").values
    named = {(row["end"], row["aspect"]) for row in values["rows"]}
    assert named == {(e, a) for e in ENDS for a in ASPECTS} | {("pointed", shedding.THIN_ASPECT)}
    assert len(values["rows"]) == len(ENDS) * len(ASPECTS) * len(KEULEGAN_CARPENTER) + 1
    for row in values["rows"]:
        assert row == with_interval(row, values["error"])
    square, pointed = (shed_range(values, end) for end in ("square", "pointed"))
    assert square[0] > pointed[0]
    for value, low, high in (square, pointed):
        assert 0.0 <= low < value < high
