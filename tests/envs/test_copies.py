"""Environments copy and pickle: a copy goes on as the original does, to the last bit."""

import copy
import pickle

import gymnasium
import numpy as np
import pytest

import suchus.apps.envs


def pickled(env):
    return pickle.loads(pickle.dumps(env))


def walked(env, steps, seed=0):
    """Act at random for some steps; return what happened."""
    rng = np.random.default_rng(seed)
    return [env.step(rng.uniform(-1, 1, env.action_space.shape)) for _ in range(steps)]


def same(one, two):
    for (seen, reward, *ends), (other_seen, other_reward, *other_ends) in zip(one, two, strict=True):
        np.testing.assert_array_equal(seen, other_seen)
        np.testing.assert_array_equal(reward, other_reward)
        assert str(ends) == str(other_ends)


@pytest.mark.parametrize("copied", [copy.deepcopy, pickled], ids=["deepcopy", "pickle"])
@pytest.mark.parametrize("task", ["Crawl", "Fault", "Shore"])
def test_a_copy_steps_as_the_original_and_leaves_it_alone(task, copied):
    env = gymnasium.make(f"suchus/{task}-v0").unwrapped
    env.reset(seed=3)
    walked(env, 4)
    env.reset()  # a second episode, whose random numbers go on
    walked(env, 3, seed=1)
    other = copied(env)
    walked(copied(env), 2, seed=9)  # what a third one does is its own
    same(walked(env, 3, seed=2), walked(other, 3, seed=2))
    np.testing.assert_array_equal(env.reset()[0], other.reset()[0])


def test_an_environment_copies_with_its_wrappers_and_before_its_first_reset():
    env = gymnasium.make("suchus/Crawl-v0", max_episode_steps=5)
    fresh = copy.deepcopy(env)
    np.testing.assert_array_equal(env.reset(seed=1)[0], fresh.reset(seed=1)[0])
    walked(env, 3)
    other = pickled(env)
    assert [step[3] for step in walked(other, 2)] == [False, True]  # the wrapper's time goes on


def test_robots_of_a_vector_copy_each_in_its_own_episode():
    envs = suchus.apps.envs.CrocodileVectorEnv(3, "Crawl", max_episode_steps=4)
    envs.reset(seed=5)
    walked(envs, 3)
    envs.reset(options={"reset_mask": np.array([False, True, False])})
    walked(envs, 2, seed=1)  # the first and the last have begun anew meanwhile
    other = copy.deepcopy(envs)
    same(walked(envs, 4, seed=2), walked(other, 4, seed=2))


def test_what_no_episode_needs_is_forgotten():
    env = gymnasium.make("suchus/Crawl-v0").unwrapped
    for _ in range(3):
        env.reset(seed=0)
        walked(env, 4)
    assert len(env.pack._history._steps) == 4
