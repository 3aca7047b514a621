"""The page on swimming states how far the water of the runs is from the flow; the model's part of it is asked again."""

import copy

import pytest

import calibration
from calibration import WORTH, earned, held_out, judged, mean_off, off, worth
from pages.stated import kept
from suchus.core.progress import silent
from suchus.sim.land.prescribed import free_sections, held_sections, towed_sections
from suchus.swimming.water import Outline, Water, recoil
from water_coefficients import WaterCoefficients

KEPT = kept("calibration")


def test_the_model_of_the_runs_says_what_is_kept():
    """Renew with ``python tools/calibration.py``."""
    lake, whole = WaterCoefficients().lake(calibration.VISCOSITY), calibration.motions()[calibration.WHOLE]
    for name, one in KEPT["towed"].items():
        assert towed_sections(calibration.ROBOT, float(name.split()[0]), lake) == pytest.approx(
            one["drag"][1], rel=1e-6
        )
    outline = Outline(calibration.ROBOT, calibration.GRIDS[0] + 1)
    sway, turn = recoil(outline, whole, 0.0, Water(viscosity=calibration.VISCOSITY))
    felt = held_sections(calibration.ROBOT, whole, lake, sway=sway, turn=turn)
    held = KEPT["held"][calibration.WHOLE]
    assert float(felt.thrust.mean()) == pytest.approx(held["thrust"][1], rel=1e-3)
    assert float(felt.power.mean()) == pytest.approx(held["power"][1], rel=1e-3)


def test_the_model_swims_freely_as_is_kept():
    lake, swim = WaterCoefficients().lake(calibration.VISCOSITY), calibration.motions()["tail only"]
    swum = free_sections(calibration.ROBOT, swim, lake, calibration.FREE_CYCLES)
    one = KEPT["free"]["tail only"]
    assert (float(swum.speed[-1]), float(swum.power[-1])) == pytest.approx((one["speed"][1], one["power"][1]), rel=1e-3)


def test_what_is_kept_is_of_the_cases_that_are_asked():
    cases, coarse = calibration.cases(), calibration.GRIDS[0]
    for kind in ("held", "free", "towed"):
        assert [*KEPT[kind]] == [one.name for one in cases if one.kind == kind and one.cells == coarse]
    assert [one.cells for one in cases if one.kind == "free" and one.cells != coarse] == [*calibration.GRIDS[1:]]
    assert KEPT["grids"]["free speed"]["values"][0] == KEPT["free"][calibration.WHOLE]["speed"][0]


def test_three_grids_foretell_the_fourth_where_the_page_says_so():
    for name in ("held aside", "held power", "cross_drag"):
        one = KEPT["grids"][name]
        assert one["values"][3] == pytest.approx(one["foretold"], rel=0.08), name


def test_the_judgement_that_is_kept_follows_from_what_is_kept():
    assert judged(KEPT) == KEPT


def test_no_correction_is_earned_since_it_is_the_grids():
    """On the grid of the fit it is worth having; where the flow tends with finer cells it is farther off than none."""
    out = held_out(KEPT)
    assert out["power held"][1] < out["power held"][0] / WORTH
    assert not earned(KEPT)
    assert not worth(KEPT)["power held"]
    for name in ("held power", "held aside"):
        limit, (plain, fitted) = KEPT["grids"][name]["limit"], KEPT["models"][name]
        assert abs(off(limit, plain)) < abs(off(limit, fitted))


def test_a_correction_would_be_earned_if_the_flow_tended_there():
    there = copy.deepcopy(KEPT)
    for name, (_, fitted) in KEPT["models"].items():
        there["grids"][name]["limit"] = fitted
    assert worth(there)["power held"]
    assert earned(there)
    assert not worth(there)["drag towed"]  # the fit is far worse than the model
    for one in there["held"].values():
        one["power"][2] = one["power"][1]  # the fit is no better than the model
    assert not worth(there)["power held"]
    assert not earned(there)


def test_what_a_model_is_off_is_counted_over_the_flow():
    assert off(2.0, 3.0) == 0.5
    assert mean_off([(1.0, 2.0, 1.0), (2.0, 1.0, 2.0)], 1) == pytest.approx(0.75)
    assert mean_off([(1.0, 2.0, 1.0), (2.0, 1.0, 2.0)], 2) == 0.0


@pytest.mark.validate
def test_a_new_flow_around_a_held_body_has_the_forces_that_are_kept():
    case = next(one for one in calibration.cases() if (one.kind, one.name) == ("held", "half the frequency"))
    found = calibration.numbers("held", calibration.flowed(case, silent))
    for name, value in found.items():
        assert value == pytest.approx(KEPT["held"][case.name][name][0], rel=0.02), name
