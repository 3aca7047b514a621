import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.article.paper import ERRATA
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_sweep.figure import draw_maps
from suchus.experiments.catalog.swimming.experiment import ARMS, PlaneSwims
from suchus.swimming.water import fit, printed_wave, swim


def _no_conditions(self, printed, slices, progress):
    """Stand in for three more swims that are kept as the first are."""
    data = xr.Dataset({"arm_speed": (("arm", "cycle"), np.ones((len(ARMS), self.cycles)))})
    return data.assign_coords(arm=list(ARMS), cycle=np.arange(1, self.cycles + 1))


@pytest.mark.slow("a second run of an experiment")
def test_what_was_finished_is_kept_and_the_rest_goes_on(tmp_path, monkeypatch):
    quick = EXPERIMENTS["swimming"].quick()
    monkeypatch.setattr(PlaneSwims, "_conditions", _no_conditions)
    experiment, seen = replace(quick, keep=str(tmp_path), readings=(), frames=1), []

    def interrupted(stage, share):
        if stage == "slice" and share > 0.1:
            raise KeyboardInterrupt

    others = [tmp_path / "mine.npz", tmp_path / "another.kept-swim"]
    for file in others:
        file.write_bytes(b"of another")
    with pytest.raises(KeyboardInterrupt):
        experiment.run(interrupted)
    assert {path.stem for path in tmp_path.iterdir()} >= {"slice_trunk_and_tail", "slice_tail_only"}
    outcome = experiment.run(lambda stage, share: seen.append((stage, share)))
    assert min(share for stage, share in seen if stage == "slice") > 0.07, "what was finished began anew"
    assert {*outcome.checkpoint_files} >= {*tmp_path.iterdir()} - {*others}, (
        "what is kept is not known, and stays for ever"
    )
    assert not {*outcome.checkpoint_files} & {*others}
    assert (tmp_path / "slice_trunk_and_tail.kept-swim").is_file(), "forgotten before anything is saved"
    assert outcome.films
    assert all(name.endswith(".gif") for name in outcome.films)


def test_a_map_of_motions_that_no_servo_can_follow_says_so_and_shows_no_number(quick_outcome):
    record = quick_outcome("swim_sweep").record
    none = {f"possible_by_{axis}": 0 * record[f"possible_by_{axis}"] for axis in ("frequency", "waves")}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figures = [draw_maps(one, "resistive") for one in (record, record.assign(none))]
    told = [[text.get_text() for ax in figure.axes for text in ax.texts] for figure in figures]
    assert not any("empty" in text for text in told[0])
    assert told[1] == ["empty: joints or servos can follow none"] * 6


@pytest.mark.parametrize(
    ("name", "fields", "said"),
    [
        ("swimming", {"readings": ("A", "Z")}, "there is no Z"),
        ("swimming", {"tow": 0.0}, "tow is 0 body lengths"),
        ("swim_sweep", {"frequencies": (0.5,)}, "a map needs two"),
        ("swim_sweep", {"waves": (1.0, 0.5)}, "increasing numbers within 0.1 to 1.4"),
        ("swim_sweep", {"points": ((1.0, 3.0),)}, "points is"),
        ("swim_sweep", {"points": ()}, "points is"),
    ],
)
def test_impossible_settings_are_refused(name, fields, said):
    with pytest.raises(InvalidDesign, match=said):
        replace(EXPERIMENTS[name], **fields)


def test_the_erratum_on_the_sign_says_what_the_resistive_model_does(robot):
    printed = fit(robot, printed_wave(robot, "I", frequency=1.0, sign=1)).gait
    assert float(swim(robot, printed).speed.sel(model="resistive")) == pytest.approx(-0.20, abs=0.005)
    assert "tail first with it, by 0.20 m/s at 1 Hz" in ERRATA["eq_20_sign"].shows
