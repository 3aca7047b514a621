"""Pictures of robots at their tasks: water, its surface, and the goal."""

from math import cos, sin

import gymnasium
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from suchus.apps.envs.single import _draw_goal, draw_water
from suchus.apps.envs.task import Goal, Landing
from suchus.visual.figures import COLOURS

WATER = np.array(to_rgb(COLOURS["water"]))


def views(x=(-1.0, 1.0), y=(-0.5, 0.5), z=(-0.03, 0.7)):
    """Return empty views from above and from the side."""
    above, side = Figure().subplots(2, 1)
    above.set(xlim=x, ylim=y)
    side.set(xlim=x, ylim=z)
    return above, side


def lines(ax):
    """Return the ends of the lines of an axes, shape (line, point, 2)."""
    return np.array([line.get_xydata() for line in ax.lines])


def covered(above):
    """Return which x have water over the ground, in a view from above, from the outlines of what is filled."""
    parts = [path.vertices[:, 0] for one in above.collections for path in one.get_paths() if len(path.vertices)]
    return (min(p.min() for p in parts), max(p.max() for p in parts)) if parts else None


def test_level_water_covers_the_ground_and_its_surface_is_a_level_line():
    above, side = views()
    draw_water(above, side, 0.3, np.array([0.0, 0.0, 1.0]), 0.1)
    assert lines(side) == pytest.approx(np.array([[[-1.0, 0.3], [1.0, 0.3]]]))
    assert covered(above) == pytest.approx((-1.0, 1.0))


def test_there_is_no_water_where_the_level_is_below_the_ground():
    above, side = views()
    draw_water(above, side, -0.3, np.array([0.0, 0.0, 1.0]), 0.1)
    assert len(side.lines) == len(side.collections) == 0
    assert covered(above) is None


@pytest.mark.parametrize("uphill", [0.2, -0.2])
def test_on_a_shore_the_water_ends_at_the_water_line(uphill):
    above, side = views()
    up = np.array([sin(uphill), 0.0, cos(uphill)])
    draw_water(above, side, 0.05, up, 0.0)
    line = 0.05 / sin(uphill)
    deep = -1.0 if uphill > 0 else 1.0
    (surface,) = lines(side)
    ends = {round(float(x), 9): float(z) for x, z in surface}
    assert ends[round(line, 9)] == pytest.approx(0.0, abs=1e-12)
    assert ends[deep] == pytest.approx((0.05 - sin(uphill) * deep) / cos(uphill))
    assert sorted(covered(above)) == pytest.approx(sorted((deep, line)))


def test_a_goal_in_the_picture_is_a_ring_and_one_beyond_it_is_pointed_to():
    for place, arrows in ((np.array([0.4, -0.2]), 0), (np.array([3.0, -2.0]), 1)):
        above, side = views()
        _draw_goal(above, side, Goal(distance=2.0, within=0.15), place)
        (ring,) = above.patches
        assert ring.center == pytest.approx(tuple(place))
        assert ring.radius == 0.15
        assert len(above.texts) == arrows
    head, tail = np.array(above.texts[0].xy), np.array(above.texts[0].xyann)
    towards = (head - tail) / np.hypot(*(head - tail))
    assert towards == pytest.approx(place / np.hypot(*place))
    assert np.abs(head / [1.0, 0.5]).max() == pytest.approx(0.9)


def test_land_to_be_reached_is_a_line_across():
    above, side = views()
    _draw_goal(above, side, Landing(beyond=0.4), np.array([0.7, 0.2]))
    assert lines(above)[0, :, 0] == pytest.approx([0.7, 0.7])
    assert lines(side)[0, :, 0] == pytest.approx([0.7, 0.7])
    assert not above.texts
    above, side = views()
    _draw_goal(above, side, Landing(beyond=0.4), np.array([2.0, 0.4]))
    (arrow,) = above.texts
    assert arrow.xy[1] == arrow.xyann[1]  # straight ahead: how far to the side does not matter


@pytest.mark.parametrize(("task", "blue"), [("Swim", True), ("Shore", True), ("Crawl", False)])
def test_pictures_of_swimmers_are_blue_and_show_the_robot(task, blue):
    env = gymnasium.make(f"suchus/{task}-v0", render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render() / 255.0
    tint = 1.0 - 0.22 * (1.0 - WATER)
    assert ((np.abs(picture - tint).max(axis=2) < 0.02).mean() > 0.2) == blue
    assert (picture < 0.55).mean() > 0.005
