"""The push on the tail from its convex to its concave side, with forces and a bend that are given by hand."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline
from suchus.swimming.water.space_record import TetheredInSpace

OUTLINE = Outline(ROBOTS["caiman"])
EDGES = [0.0, *np.sort(OUTLINE.joint_positions), OUTLINE.robot.length]
TAIL_PARTS = [i for i, (front, rear) in enumerate(pairwise(EDGES)) if 0.5 * (front + rear) > OUTLINE.tail_root]
FORCE = 0.3
"""On each part of the tail [N]."""


def push(tip_heading, lateral_force, trunk_force=0.0):
    """Return the push [Pa] on a tail that bends evenly to ``tip_heading`` [rad], to the right where positive."""
    tail = (OUTLINE.s - OUTLINE.tail_root) / (OUTLINE.s[-1] - OUTLINE.tail_root)
    spine = SimpleNamespace(heading=tip_heading * np.maximum(tail, 0.0))
    body = SimpleNamespace(shape=SimpleNamespace(spine=lambda time: spine))
    flow = SimpleNamespace(setup=SimpleNamespace(bodies=[body]))
    force = np.zeros((2, len(EDGES) - 1))
    force[1] = trunk_force
    force[1, TAIL_PARTS] = lateral_force
    return TetheredInSpace(SimpleNamespace(outline=OUTLINE))._push(flow, 0.0, force)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_force_towards_the_side_to_which_the_tail_bends_is_positive(side):
    """The robot swims to -x, so that y points to its right; the convex side is the left where the tail bends right."""
    assert push(side * 0.01, side * FORCE) > 0.0
    assert push(side * 0.01, -side * FORCE) == pytest.approx(-push(side * 0.01, side * FORCE))


def test_it_is_the_force_across_the_tail_over_its_side_area():
    tail = OUTLINE.s >= OUTLINE.tail_root
    area = np.trapezoid(2.0 * OUTLINE.silhouette.half_height[tail], OUTLINE.s[tail])
    assert push(1e-4, FORCE) == pytest.approx(len(TAIL_PARTS) * FORCE / area, rel=1e-6)
    assert push(1e-4, FORCE, trunk_force=5.0) == push(1e-4, FORCE)  # the trunk's load is not the tail's
    assert 0.0 < push(1.0, FORCE) < push(1e-4, FORCE)  # what pulls along a bent tail pushes less across it
    assert push(0.0, FORCE) == 0.0  # a straight tail has no convex side
