"""The search for a first walk says what ended it: the ranges of the limbs, or the number of numerical solutions."""

from dataclasses import replace

import pytest

import suchus
from suchus.core.errors import OutsideLimits
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion import draft, draft_gait
from suchus.robot.robots import ROBOTS

SALAMANDER = ROBOTS["salamander"]


def without_closed_form(girdle):
    """Return a girdle whose lower links point a little forward, so that its limbs are solved numerically."""
    upper, lower = girdle.limb.links
    x, y, z = lower.end
    return replace(girdle, limb=replace(girdle.limb, links=(upper, replace(lower, end=(x + 0.05 * y, y, z)))))


NUMERIC = replace(SALAMANDER, girdles=tuple(without_closed_form(girdle) for girdle in SALAMANDER.girdles))


def with_narrow_ranges(girdle):
    """Return a girdle whose joints turn by a hundredth of a radian to either side."""
    links = tuple(
        replace(link, hinges=tuple(replace(hinge, range=(-0.01, 0.01)) for hinge in link.hinges))
        for link in girdle.limb.links
    )
    return replace(girdle, limb=replace(girdle.limb, links=links))


def test_a_search_that_runs_out_of_solutions_does_not_blame_the_ranges(monkeypatch):
    assert {limb_kinematics.kind(girdle.limb) for girdle in NUMERIC.girdles} == {"other"}
    assert draft_gait(NUMERIC, "walk").limbs
    monkeypatch.setattr(draft, "_MAX_SOLVES", 1)
    with pytest.raises(OutsideLimits, match="the search ended after 1 numerical solutions") as refusal:
        draft_gait(NUMERIC, "walk")
    assert "within their ranges" not in str(refusal.value)


def test_limbs_with_a_closed_form_are_refused_for_their_ranges():
    narrow = replace(SALAMANDER, girdles=tuple(with_narrow_ranges(girdle) for girdle in SALAMANDER.girdles))
    with pytest.raises(OutsideLimits, match=r"its limbs reach no path of 0\.06 of their reach within their ranges"):
        draft_gait(narrow, "walk")


def test_the_first_walk_of_a_robot_has_the_longest_strokes_that_it_can_follow():
    gait = draft_gait(suchus.ROBOTS["caiman"], "walk")
    assert {limb.stroke for limb in gait.limbs} == {max(draft._HALF_STROKES)}
