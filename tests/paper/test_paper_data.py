import ast
import json
import re
import sys
from dataclasses import FrozenInstanceError
from pathlib import Path

import pytest

import suchus.article.paper
from suchus.article.paper import (
    CLAIMS,
    CRAWL_END,
    CYCLE_PERIOD,
    ERRATA,
    LEG_CHAIN,
    SNAPSHOT_TIMES,
    SPINE_CHAIN,
    TABLE_I,
    TABLE_II,
    Claim,
)

SOURCES = sorted(Path(suchus.article.paper.__file__).parent.glob("*.py"))
UNITS = {"-", "m", "s", "m/s", "rad", "N", "Pa"}


@pytest.mark.parametrize("source", SOURCES, ids=lambda p: p.stem)
def test_paper_imports_the_standard_library_only(source):
    for node in ast.walk(ast.parse(source.read_text())):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        for name in names:
            assert name.split(".")[0] in sys.stdlib_module_names or name.startswith("suchus.article.paper")


def test_tables_are_those_of_the_article():
    assert [(r.i, r.theta, r.d_mm, r.a_mm) for r in TABLE_I] == [
        (1, "theta_1", 0, 70),
        (2, "theta_2", 0, 0),
        (3, "theta_3", 0, 86),
        (4, "theta_4", 0, 89),
    ]
    assert [r.a_mm for r in TABLE_II] == [50.5, 60.5, 60.5, 60.5, 60.5]
    assert [round(r.alpha, 4) for r in TABLE_I] == [0, 1.5708, 0, 0]
    assert [round(r.alpha, 4) for r in TABLE_II] == [0, -1.5708, 1.5708, -1.5708, 1.5708]


def test_chains_are_the_tables_in_metres():
    assert LEG_CHAIN.a == pytest.approx((0.070, 0, 0.086, 0.089))
    assert SPINE_CHAIN.a == pytest.approx((0.0505, 0.0605, 0.0605, 0.0605, 0.0605))
    assert sum(SPINE_CHAIN.a) == pytest.approx(0.2925)


@pytest.mark.parametrize("key", list(CLAIMS))
def test_claims_are_complete(key):
    claim = CLAIMS[key]
    assert claim.key == key
    assert re.fullmatch(r"[a-z0-9_]+", key)
    assert claim.unit in UNITS
    assert claim.rounding >= 0
    assert claim.sense.endswith(".")
    assert claim.of or claim.where.startswith(("I", "II", "III", "IV", "V"))
    assert str(claim).endswith(f"({claim.of}, {claim.where})" if claim.of else f"({claim.where})")
    assert 0 < len(claim.quote) < 200
    if claim.value is None:
        assert claim.rounding == 0
    assert claim.quantity in str(claim)


def test_issue_2_finds_its_claims():
    faults = [
        f"fault_{e}_{j}_{a}" for e in ("front", "hind") for j in ("yaw", "pitch") for a in ("coordinated", "limbs_only")
    ]
    wanted = {
        "com_fluctuation": None,
        "com_on_support_line": None,
        "displacement_coordinated": 0.73,
        "displacement_limbs_only": 0.16,
        "displacement_ratio": 4.5625,
        "height_crawl": 0.16,
        "height_standing": 0.68,
        "height_ratio": 4.25,
        "actuator_count": 19,
        "cycle_period": 4,
        "wave_c1": 0.027,
        "wave_c2": 0.30,
        "wave_k": 0.023,
        **dict(zip(faults, (-0.22, -0.80, -1, -1, -0.17, -0.75, 0, -0.55), strict=True)),
    }
    for key, value in wanted.items():
        assert CLAIMS[key].value == (None if value is None else pytest.approx(value))


def test_ratios_follow_from_their_parts():
    assert CLAIMS["height_standing"].value / CLAIMS["height_crawl"].value == pytest.approx(CLAIMS["height_ratio"].value)


def test_no_claim_is_wider_than_its_number():
    for claim in CLAIMS.values():
        if claim.value:
            assert claim.rounding < 0.6 * abs(claim.value), claim.key


def test_claims_and_errata_cannot_be_changed():
    with pytest.raises(TypeError):
        CLAIMS["displacement_ratio"] = 5  # type: ignore[index]
    with pytest.raises(FrozenInstanceError):
        CLAIMS["displacement_ratio"].value = 5.0  # type: ignore[misc]
    assert isinstance(CLAIMS["height_crawl"], Claim)


@pytest.mark.parametrize("key", list(ERRATA))
def test_misprints_are_complete(key):
    misprint = ERRATA[key]
    assert misprint.key == key
    assert misprint.printed != misprint.ours
    assert misprint.shows.endswith(".")
    assert misprint.where


def test_snapshots_lie_in_the_first_fifth_of_the_cycle():
    assert "snapshots_in_one_fifth" in ERRATA
    assert all(0 < (t - 1.0) / CYCLE_PERIOD <= 0.2 for t in SNAPSHOT_TIMES)
    assert CRAWL_END == 9.0


@pytest.mark.parametrize(("key", "share"), [("fault_75_percent", 1.14), ("fault_55_percent", 2.05)])
def test_two_fault_percentages_contradict_the_displacements(key, share):
    assert key in ERRATA
    claim = {"fault_75_percent": "fault_hind_yaw_limbs_only", "fault_55_percent": "fault_hind_pitch_limbs_only"}[key]
    left = (1 + CLAIMS[claim].value) * CLAIMS["displacement_coordinated"].value
    assert left / CLAIMS["displacement_limbs_only"].value == pytest.approx(share, abs=0.01)


def test_times_higher_is_times_as_high():
    assert "times_higher" in ERRATA
    assert pytest.approx(CLAIMS["height_ratio"].value) == 0.68 / 0.16


@pytest.mark.parametrize(
    ("claim", "error", "species"),
    [("largest_length", "largest_species", "Nile"), ("smallest_length", "smallest_species", "Chinese alligator")],
)
def test_a_claim_about_a_species_that_is_another_stands_among_the_errata(claim, error, species):
    misprint = ERRATA[error]
    assert misprint.where == CLAIMS[claim].where
    assert species in CLAIMS[claim].sense
    assert species in misprint.printed
    assert species not in misprint.ours


def test_vectors_travel_with_the_tests():
    file = Path(__file__).parents[1] / "data/test-vectors.json"
    assert len(json.loads(file.read_text())) == 40
