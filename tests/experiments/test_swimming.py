from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.errors import InvalidDesign
from suchus.experiments import EXPERIMENTS
from suchus.experiments._swimming_findings import ARMS
from suchus.experiments.swimming import Swimming


def _no_arms(self, ours, printed, free, progress):
    """Stand in for five more swims that are kept as the first is."""
    speed = np.ones((len(ARMS), self.arm_cycles))
    data = xr.Dataset({"arm_speed": (("arm", "cycle"), speed)})
    return data.assign_coords(arm=list(ARMS), cycle=np.arange(1, self.arm_cycles + 1))


def test_what_was_finished_is_kept_and_the_rest_goes_on(tmp_path, monkeypatch):
    quick = EXPERIMENTS["swimming"].quick()
    monkeypatch.setattr(Swimming, "_arms", _no_arms)
    experiment, seen = replace(quick, keep=str(tmp_path), readings=(), frames=1), []

    def interrupted(stage, share):
        if stage == "free" and share > 0.4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        experiment.run(interrupted)
    assert {path.name for path in tmp_path.iterdir()} >= {
        "held_ours.npz",
        "held_as_printed.npz",
        "free_ours.npz",
    }
    outcome = experiment.run(lambda stage, share: seen.append((stage, share)))
    assert [share for stage, share in seen if stage == "held"] == [], "the held swim began anew"
    assert min(share for stage, share in seen if stage == "free") > 0.3
    assert list(tmp_path.iterdir()) == []
    assert outcome.films
    assert all(name.endswith(".gif") for name in outcome.films)


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
