"""The study of the claims from its first run to its page."""

import json

import numpy as np
import pytest

from suchus.catalog import Catalog
from suchus.study import Claims, claims, conduct_claims, write_claims
from suchus.study.answers import first_order
from suchus.study.claims_page import OUTCOME, TABLE, deciders

EVERY = Catalog.beside


def few(shelf, *asked):
    return EVERY(shelf, *asked)[:4]  # each number is a column of three stores


@pytest.fixture(scope="module")
def conducted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("claims")
    places = []
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(claims, "FINE", 0.01)
        patched.setattr(Catalog, "beside", few)
        asked = Claims(samples=1, compared=1, cycles=1, coarse=(0.01,))
        record = conduct_claims(asked, folder, progress=lambda place, told: places.append(place))
    some = record.isel(claim=slice(0, 2))  # every further claim is a further picture
    return some, write_claims(some, folder / "result"), list(dict.fromkeys(places))


def test_a_time_step_agrees_with_itself_and_is_taken(conducted):
    record, _, places = conducted
    assert places == ["compared_2ms", "compared_10ms", "runs"]
    (tried,) = json.loads(record.attrs["agreed"])
    assert (tried["timestep"], tried["same"], tried["wide"], tried["chance"]) == (0.01, 1.0, 0.0, 1.0)
    assert record.attrs["timestep"] == 0.01


def test_the_page_the_table_and_the_numbers_say_the_same(conducted):
    record, result, _ = conducted
    told = json.loads((result / OUTCOME).read_text())
    rows = (result / TABLE).read_text().splitlines()[1:]
    assert [row.split(",")[0] for row in rows] == [c["claim"] for c in told["claims"]] == record.claim.values.tolist()
    assert told["samples"] == {"walked": 1}
    page = (result / "index.html").read_text()
    assert "The study ran with 10 ms." in page
    assert f"over {record.sizes['parameter']} numbers" in page


def test_a_parameter_that_goes_with_a_stronger_one_is_not_named_beside_it():
    random = np.random.default_rng(0)
    points = random.random((500, 3))
    points[:, 1] = 0.7 * points[:, 0] + 0.3 * points[:, 1]
    index = first_order(points, points[:, 0] + 0.5 * points[:, 2])
    assert index.low[1] > 0.2  # though it decides nothing
    assert deciders(points, index) == [0, 2]
