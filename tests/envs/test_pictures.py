"""Pictures of robots at their tasks: the look of the replays, without OpenGL."""

import sys
from math import cos, sin

import gymnasium
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from suchus.apps.envs import CrocodileVectorEnv
from suchus.robot.design.ground import Bumps
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import COLOURS
from suchus.visual.replay.rendering import _WATER, HEIGHT, WIDTH, Renderer, Scenery
from suchus.visual.replay.scene import KEYS
from suchus.visual.skin import Poses, bone_names, bone_rest

CAIMAN = ROBOTS["caiman"]
LEVEL = np.array([0.0, 0.0, 1.0])
FLOOR, WATER, GOAL = np.array([0.925, 0.925, 0.905]), np.array(to_rgb(KEYS["water"])), to_rgb(COLOURS["limbs_only"])


def picture(robot=CAIMAN, *, at=(0.0, 0.0), height=0.1, upward=LEVEL, **scenery):
    """Return the picture of a robot in its zero posture, 0 to 1."""
    positions = bone_rest(robot) + np.array([*at, height])
    quaternions = np.tile([1.0, 0.0, 0.0, 0.0], (len(bone_names(robot)), 1))
    feet = np.tile([*at, 1.0], (2 * len(robot.girdles), 1))
    settings = Scenery(upward=upward, **scenery)
    return Renderer(robot).render(Poses(positions, quaternions), feet, np.array([*at, height]), settings) / 255.0


def near(shown, colour, tolerance=0.02):
    """Return which pixels have a colour."""
    return np.abs(shown - np.array(colour)).max(axis=-1) < tolerance


def test_the_camera_looks_at_the_robot_and_goes_with_it():
    shown = picture()
    assert shown.shape == (HEIGHT, WIDTH, 3)
    assert near(shown[0], FLOOR).mean() > 0.5
    rows, columns = np.nonzero(shown[..., 1] - shown[..., 2] > 0.08)  # the hide is green and brown, the floor is grey
    assert abs(columns.mean() / WIDTH - 0.5) < 0.12
    assert abs(rows.mean() / HEIGHT - 0.5) < 0.12
    moved = picture(at=(2.0, -3.0))  # the lines of the floor are alike in each metre
    assert np.abs(moved - shown).mean() < 2e-3
    assert np.abs(picture(at=(2.04, -3.0)) - shown).mean() > 5e-3


@pytest.mark.parametrize("name", ["caiman", "strider", "swimmer", "salamander"])
def test_every_body_fills_its_picture(name):
    shown = picture(ROBOTS[name], height=0.05 * ROBOTS[name].length)
    columns = np.nonzero((shown[..., 1] - shown[..., 2] > 0.08).any(axis=0))[0]
    assert 0.3 < (columns.max() - columns.min()) / WIDTH < 1.0


def test_the_shadow_lies_on_the_floor_away_from_the_light():
    shown = picture(height=0.3)
    shadow = near(shown, 0.78 * FLOOR, 0.015)
    assert shadow.mean() > 0.01
    rough = picture(height=0.3, relief=Bumps(height=0.02, correlation=0.05, start=0.9, seed=0))
    assert near(rough, 0.78 * FLOOR, 0.015).mean() < 0.2 * shadow.mean()  # the replays cast none on rough ground either


def test_water_tints_what_is_below_its_surface_alone():
    above, deep, half = (picture(height=0.3, level=level) for level in (0.02, 0.7, 0.32))
    tinted = (1.0 - _WATER) * FLOOR + _WATER * WATER
    assert near(deep, tinted).mean() > 0.3
    assert near(picture(height=0.3), tinted).sum() == 0
    hide = above[..., 1] - above[..., 2] > 0.12
    under = (1.0 - _WATER) * above + _WATER * WATER
    assert near(deep, under)[hide].mean() > 0.9
    assert 0.2 < near(half, above)[hide].mean() < 0.9  # the back is above the water


@pytest.mark.parametrize("uphill", [0.3, -0.3])
def test_on_a_shore_the_water_ends_at_the_water_line(uphill):
    """Forward is to the right of the picture: there is land where the ground rises."""
    upward = np.array([sin(uphill), 0.0, cos(uphill)])
    shown = picture(upward=upward, level=0.0)
    tinted = near(shown, (1.0 - _WATER) * FLOOR + _WATER * WATER)
    left, right = tinted[HEIGHT // 2 :, :80].mean(), tinted[HEIGHT // 2 :, -80:].mean()
    wet, dry = (left, right) if uphill > 0 else (right, left)
    assert wet > 0.5
    assert dry < 0.2


@pytest.mark.parametrize("level", [None, 0.4])
def test_a_goal_in_sight_is_a_ring_and_one_beyond_is_pointed_to(level):
    def marks(**goal):
        return near(picture(level=level, height=0.3, **goal), GOAL, 0.15)

    assert not marks().any()
    ring = marks(goal=np.array([0.3, -0.3]), goal_radius=0.1)
    assert 40 < ring.sum() < 2000
    far = marks(goal=np.array([9.0, 0.0]), goal_radius=0.1)
    assert np.nonzero(far)[1].mean() > WIDTH / 2  # forward is to the right
    behind = marks(goal=np.array([-9.0, 0.0]), goal_radius=0.1)
    assert np.nonzero(behind)[1].mean() < WIDTH / 2
    line = marks(goal=np.array([0.2, 0.0]))
    assert np.ptp(np.nonzero(line)[0]) > HEIGHT / 4


def test_bumps_are_seen():
    bumps = Bumps(height=0.04, correlation=0.06, start=0.0, seed=1)
    assert np.abs(picture(relief=bumps) - picture()).mean() > 0.02


@pytest.mark.parametrize("task", ["Crawl", "Velocity", "Swim", "Shore", "Stand"])
def test_an_environment_draws_its_robot_without_opengl(task, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("OpenGL was asked for")

    monkeypatch.setattr("mujoco.Renderer", refuse)
    monkeypatch.setitem(sys.modules, "OpenGL", None)
    monkeypatch.setitem(sys.modules, "glfw", None)
    env = gymnasium.make(f"suchus/{task}-v0", render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    assert first.dtype == np.uint8
    for _ in range(3):
        env.step(env.action_space.sample())
    assert (np.abs(env.render().astype(float) - first) > 20).mean() > 0.005
    is_wet = near(first / 255.0, (1.0 - _WATER) * FLOOR + _WATER * WATER).mean() > 0.2
    assert is_wet == (task in {"Swim", "Shore"})


def test_many_robots_have_a_picture_each():
    env = CrocodileVectorEnv(2, "Fault", render_mode="rgb_array")
    env.reset(seed=0)
    first, second = env.render()
    assert first.shape == second.shape == (HEIGHT, WIDTH, 3)
    assert (first != second).any()
    assert np.array_equal(env.render()[0], first)
