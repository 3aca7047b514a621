import json

from suchus.apps.report import save_outcome
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Outcome, Replay


def test_replays_stand_beside_the_figures_and_are_listed(crawled, tmp_path):
    replays = {"walk.html": Replay(caption="It walks.", make=lambda: "<!doctype html><p>å</p>")}
    outcome = Outcome(experiment="x", measures={}, verdicts=(), record=crawled, settings={}, replays=replays)
    folder = save_outcome(outcome, {}, EXPERIMENTS["displacement"], tmp_path / "x", command="suchus run x")
    assert (folder / "walk.html").read_text(encoding="utf-8") == replays["walk.html"].html
    told = json.loads((folder / "outcome.json").read_text())
    assert told["replays"] == [{"name": "walk.html", "caption": "It walks."}]
