from dataclasses import replace

import pytest

from suchus.experiments import EXPERIMENTS


def test_what_was_finished_is_kept_and_the_rest_goes_on(tmp_path):
    quick = EXPERIMENTS["swimming"].quick()
    experiment, seen = replace(quick, keep=str(tmp_path)), []

    def interrupted(stage, share):
        if stage == "free" and share > 0.35:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        experiment.run(interrupted)
    assert {path.name for path in tmp_path.iterdir()} >= {
        "held_ours.npz",
        "held_as_printed.npz",
        "free_trunk_and_tail.npz",
    }
    outcome = experiment.run(lambda stage, share: seen.append((stage, share)))
    assert [share for stage, share in seen if stage == "held"] == [], "the held swim began anew"
    assert min(share for stage, share in seen if stage == "free") > 0.3
    assert list(tmp_path.iterdir()) == []
    assert outcome.films
    assert all(name.endswith(".gif") for name in outcome.films)
