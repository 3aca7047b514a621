import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.errors import InvalidDesign
from suchus.experiments import EXPERIMENTS
from suchus.experiments._taken import TAKEN
from suchus.experiments.swim_sweep.figure import draw_maps
from suchus.experiments.swimming.experiment import ARMS, PlaneSwims, _compared, _track, _wave
from suchus.paper import ERRATA
from suchus.water import fit, printed_wave, swim


def _no_conditions(self, ours, printed, free, progress):
    """Stand in for five more swims that are kept as the first is."""
    speed = np.ones((len(ARMS), self.arm_cycles))
    data = xr.Dataset({"arm_speed": (("arm", "cycle"), speed)})
    return data.assign_coords(arm=list(ARMS), cycle=np.arange(1, self.arm_cycles + 1))


@pytest.mark.slow("a second run of an experiment")
def test_what_was_finished_is_kept_and_the_rest_goes_on(tmp_path, monkeypatch):
    quick = EXPERIMENTS["swimming"].quick()
    monkeypatch.setattr(PlaneSwims, "_conditions", _no_conditions)
    experiment, seen = replace(quick, keep=str(tmp_path), readings=(), frames=1), []

    def interrupted(stage, share):
        if stage == "free" and share > 0.4:
            raise KeyboardInterrupt

    others = [tmp_path / "mine.npz", tmp_path / "another.kept-swim"]
    for file in others:
        file.write_bytes(b"of another")
    with pytest.raises(KeyboardInterrupt):
        experiment.run(interrupted)
    assert {path.stem for path in tmp_path.iterdir()} >= {"held_ours", "held_as_printed", "free_ours"}
    outcome = experiment.run(lambda stage, share: seen.append((stage, share)))
    assert [share for stage, share in seen if stage == "held"] == [], "the held swim began anew"
    assert min(share for stage, share in seen if stage == "free") > 0.3
    assert {*outcome.kept} >= {*tmp_path.iterdir()} - {*others}, "what is kept is not known, and stays for ever"
    assert not {*outcome.kept} & {*others}
    assert (tmp_path / "free_ours.kept-swim").is_file(), "forgotten before anything is saved"
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


def test_what_tail_and_spine_add_is_what_is_missing_without_them():
    speeds = [[0.1, 0.2, 0.3], [0.0, 0.05, 0.1], [0.0, 0.3, 0.25], *[[0.0, 0.1, 0.1]] * 3]
    record = xr.Dataset({"arm_speed": (("arm", "cycle"), speeds)}, coords={"arm": list(ARMS)})
    found = {name: measure.value for name, measure in _compared(record)}
    assert found["speed_trunk_and_tail"] == 0.3
    assert found["gain_tail_swim"] == pytest.approx(0.2)  # without the tail only the trunk is left
    assert (found["gain_tail_swim_low"], found["gain_tail_swim_high"]) == pytest.approx((0.15, 0.2))
    assert found["gain_spine_swim"] == pytest.approx(0.05)
    assert found["gain_spine_swim_low"] == pytest.approx(-0.1)
    assert found["gain_tail_swim_share_low"] == pytest.approx(2 / 3)


def free_track(sway):
    """Return the track of six cycles: in the last four the centre of mass sways by so much [m]."""
    t = np.arange(6 * 40 + 1) / 40
    y = np.where(t < 2.0, 0.2, sway) * np.sin(2 * np.pi * t) + 0.05 * t
    return xr.Dataset(
        {"centre_y": ("moment", y), "speed": ("cycle", np.ones(6)), "swing": ("station", [0.03, 0.01, 0.1])}
    )


def test_the_track_is_that_of_the_centre_of_mass_over_the_last_cycles(robot):
    found = {name: m.value for name, m in _track(free_track(0.02), robot)}
    assert found["track_cycles"] == 4
    assert found["track_sway"] == pytest.approx(0.02 / robot.length, rel=1e-3)
    assert found["track_noise"] < 1e-6
    assert found["snout_sway"] == pytest.approx(0.03 / robot.length)
    straight = {name: m.value for name, m in _track(free_track(0.0), robot)}
    assert straight["track_sway"] == pytest.approx(0.0, abs=1e-9)


def test_a_wave_and_its_envelope_are_read_from_the_free_body(robot):
    s = np.linspace(0.0, 1.0, 65)
    swing = robot.length * (0.02 * s + 0.08 * s**2)
    free = xr.Dataset(
        {
            "swing": ("station", np.where(np.isclose(s, 0.5), 0.5 * swing, swing)),
            "swing_late": ("station", np.mod(1.1 * s, 1.0)),
            "sine_share": ("station", np.full(65, 0.98)),
            "tip_share": ("single", [0.97, 0.99]),
        }
    )
    found = {name: m.value for name, m in _wave(free, robot)}
    assert found["wave_waves_per_body"] == pytest.approx(1.1, rel=0.01)
    assert found["wave_share"] == pytest.approx(0.98, abs=0.01)
    assert found["wave_envelope_tip"] == pytest.approx(0.1, rel=0.02)
    assert found["wave_envelope_middle"] == pytest.approx(0.03, rel=0.05)
    assert found["envelope_dip"] == pytest.approx(0.5, abs=0.03)
    assert (found["tail_sine_share"], found["tail_sine_share_low"], found["tail_sine_share_high"]) == (0.98, 0.97, 0.99)


def test_the_erratum_on_the_sign_says_what_the_resistive_model_does(robot):
    printed = fit(robot, printed_wave(robot, "I", frequency=1.0, sign=1)).gait
    assert float(swim(robot, printed).speed.sel(model="resistive")) == pytest.approx(-0.20, abs=0.005)
    assert "tail first with it, by 0.20 m/s at 1 Hz" in ERRATA["eq_20_sign"].shows


def test_midlines_as_taken_swim_beside_those_commanded(monkeypatch):
    """The joints of six degrees of freedom bend otherwise than commanded, and these bends are what is let swim."""
    swum = []

    def free(self, name, motion, cells, cycles, progress):
        swum.append((name, motion, cells, cycles))
        return xr.Dataset({"speed": ("cycle", np.full(cycles, 0.1 * len(swum)))})

    monkeypatch.setattr(PlaneSwims, "_free", free)
    for name in ("_SETTLE", "_AVERAGED"):  # of which the experiment itself takes more
        monkeypatch.setattr(f"suchus.experiments._taken.{name}", 2)
    quick = replace(EXPERIMENTS["swimming"].quick(), taken=True, coarse_cells=64)
    motion = quick._fit(-1).gait
    (record,) = quick._taken(motion, lambda stage, share: None)
    assert [one[0] for one in swum] == list(TAKEN)
    assert [one[2:] for one in swum] == [(64, quick.arm_cycles)] * 2
    assert swum[0][1].frequency == quick.frequency
    assert record.taken_speed.values[:, -1] == pytest.approx([0.1, 0.2])
    # the tail alone folds more than the whole body; neither is what was commanded
    assert 0.1 < float(record.taken_away[0]) < float(record.taken_away[1]) < 1.5
    arms = _no_conditions(quick, None, None, None, None)
    told = dict(_compared(xr.merge([arms, record])))
    assert told["speed_tail_only_as_taken"].value == pytest.approx(0.2)
    assert told["misfit_trunk_and_tail_as_taken"].value == float(record.taken_away[0])
    assert "speed_tail_only_as_taken" not in dict(_compared(arms))
