"""The study of the claims from its first run to its page."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from suchus.article.verdict.judging import Share, digest
from suchus.core.catalog import Catalog
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.jobs.made_by import source_versions
from suchus.experiments.claims import RULES
from suchus.experiments.study import Claims, answer_finished, claims, conduct_claims
from suchus.experiments.study.answers import first_order
from suchus.experiments.study.claim_measures import RUNS, swept_rules
from suchus.experiments.study.claims_page import OUTCOME, SHARES, TABLE, write_claims
from suchus.experiments.study.claims_table import border_texts, claim_row, deciders
from suchus.experiments.study.claims_table import shares as shares_of
from suchus.robot.gaits import GAITS

EVERY = Catalog.beside


def few(shelf, name, attribute, default, **options):
    found = EVERY(shelf, name, attribute, default, **options)
    return found[:4] if attribute == "chosen" else found  # each number is a column of three stores


@pytest.fixture(scope="module")
def small():
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(claims, "FINE", 0.01)
        patched.setattr(Catalog, "beside", few)
        gait = replace(GAITS["belly_crawl"], period=2.0)
        yield Claims(gait=gait, samples=2, together=1, compared=1, cycles=1, coarse=(0.01,))


@pytest.fixture(scope="module")
def conducted(small, tmp_path_factory):
    folder = tmp_path_factory.mktemp("claims")
    places = []
    record = conduct_claims(small, folder, progress=lambda stage, _: places.append(stage.partition(":")[0]))
    some = record.isel(claim=slice(0, 2))  # every further claim is a further picture
    return record, write_claims(some, folder / "result"), list(dict.fromkeys(places)), folder


def test_a_time_step_agrees_with_itself_and_is_taken(conducted):
    record, _, places, _ = conducted
    assert places == ["compared 10ms", "runs"]  # FINE is 10 ms here: the same store, asked twice
    (tried,) = json.loads(record.attrs["agreed"])
    assert (tried["timestep"], tried["same"], tried["wide"], tried["chance"]) == (0.01, 1.0, 0.0, 1.0)
    assert record.attrs["timestep"] == 0.01


def test_every_claim_without_an_excuse_is_answered_from_every_run(conducted):
    record = conducted[0]
    assert record.claim.values.tolist() == [rule.claim for rule in swept_rules()]
    assert record.sizes["run"] == len(RUNS)
    assert np.isfinite(record.displacement_x.values).all()
    assert record.number.sel(claim="displacement_coordinated").values == pytest.approx(
        record.displacement_x.sel(run="coordinated").values
    )


def test_the_page_the_table_and_the_numbers_say_the_same(conducted):
    record, result, _, _ = conducted
    told = json.loads((result / OUTCOME).read_text())
    rows = (result / TABLE).read_text().splitlines()[1:]
    assert (
        [row.split(",")[0] for row in rows] == [c["claim"] for c in told["claims"]] == record.claim.values[:2].tolist()
    )
    assert told["samples"] == {"walked": 2}
    page = (result / "index.html").read_text()
    assert "The study ran with 10 ms." in page
    assert f"over {record.sizes['parameter']} numbers" in page


def test_the_shares_are_written_as_the_verdicts_read_them(conducted):
    record, result, _, _ = conducted
    written = json.loads((result / SHARES).read_text())
    assert written["digest"] == digest(written["claims"])
    assert (written["samples"], written["became"], written["timestep"]) == (2, {"walked": 2}, 0.01)
    assert written["source"]["runs"] == source_versions()["source"]
    few = {claim: row for claim, row in written["claims"].items() if "words" in row}
    assert all(sum(row["words"].values()) == 2 and row["of"] == "" for row in few.values())
    for claim, row in written["claims"].items():
        if claim in few:
            continue
        share = Share(claim=claim, **row)
        assert (share.of, share.rule) == ("", RULES[claim].asked)
        one = record.sel(claim=claim)
        judged = np.isfinite(one.number.values)  # of a claim of a control group those designs on which it walks
        assert share.share == float(one.holds.values[judged].mean())
        assert share.designs == judged.sum() > 0
        assert share.low < share.share or share.share == 0.0


def test_what_is_finished_is_answered_without_a_run_and_the_same(conducted, small, monkeypatch):
    record, _, _, folder = conducted
    monkeypatch.setattr(claims, "conduct", None)
    again = answer_finished(small, folder)
    assert again.attrs == record.attrs
    assert again.identical(record)


def test_of_an_unfinished_store_a_power_of_two_of_samples_is_answered(conducted, small, tmp_path):
    record, _, _, folder = conducted
    shutil.copytree(folder, tmp_path / "store", ignore=shutil.ignore_patterns("result", "000001.nc"))
    part = answer_finished(replace(small, samples=4), tmp_path / "store")  # how many were asked stands in the store
    assert part.sizes["sample"] == 1
    assert part.displacement_x.values.tobytes() == record.displacement_x.isel(sample=[0]).values.tobytes()
    (tmp_path / "store" / "runs" / "parts" / "000000.nc").unlink()
    with pytest.raises(UnreadableFile, match="runs holds no finished batch"):
        answer_finished(small, tmp_path / "store")


def test_another_source_goes_on_with_no_store_but_may_answer_from_it(conducted, small, tmp_path):
    folder = conducted[3]
    shutil.copytree(folder, tmp_path / "store", ignore=shutil.ignore_patterns("result"))
    mark = tmp_path / "store" / "runs" / "study.json"
    mark.write_text(mark.read_text().replace(source_versions()["source"], "of last year"))
    with pytest.raises(IncompatibleRecord, match="source of last year"):
        conduct_claims(small, tmp_path / "store")
    assert json.loads(answer_finished(small, tmp_path / "store").attrs["made_by"])["source"] == "of last year"


def test_what_turns_a_claim_is_told_where_designs_disagree():
    edge = {"parameter": "gait.lift", "unit": "m", "at": 0.03, "true": "below", "separation": 0.5}
    row = {"claim": "tail_swing", "samples": 100, "interval": (0.5, 0.7), "border": edge}
    assert border_texts([row | {"true": 0.6}]) == {"tail_swing": "lift (gait) below 0.03 m"}
    assert border_texts([row | {"true": 0.91}]) == border_texts([row | {"true": 0.09}]) == {}
    assert border_texts([row | {"true": 0.6, "border": None}]) == {}
    assert shares_of([row | {"true": 0.6, "samples": 0}], {}) == {}


def test_a_parameter_that_goes_with_a_stronger_one_is_not_named_beside_it():
    random = np.random.default_rng(0)
    points = random.random((500, 3))
    points[:, 1] = 0.7 * points[:, 0] + 0.3 * points[:, 1]
    index = first_order(points, points[:, 0] + 0.5 * points[:, 2])
    assert index.low[1] > 0.2  # though it decides nothing
    assert deciders(points, index) == [0, 2]


def test_rows_hold_what_the_record_holds(conducted):
    record = conducted[0]
    for claim in record.claim.values:
        row = claim_row(record, str(claim))
        one = record.sel(claim=claim)
        judged = one.holds.values[np.isfinite(one.number.values)]
        assert row["samples"] == len(judged)
        assert row["true"] == pytest.approx(judged.mean() if len(judged) else np.nan, nan_ok=True)
