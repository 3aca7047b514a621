"""The search of a network: a heading loop first, then all weights."""

import numpy as np
import pytest

from suchus.experiments.train import Training
from suchus.experiments.train.evaluate import weight_count, with_network
from suchus.experiments.train.network_search import (
    EPISODES,
    FAILURE_ACTIONS,
    LOOP_EPISODES,
    LOOP_GENERATIONS,
    NetworkSearch,
    heading_column,
    loop_weights,
)
from suchus.robot.control.observation import observation_layout
from suchus.robot.control.policy import ACTIONS, Networks
from suchus.robot.policies import POLICIES
from suchus.robot.robots import ROBOTS

CAIMAN = Training(task="fault", start=POLICIES["velocity"])
STRIDER = Training(robot=ROBOTS["strider"], start=POLICIES["velocity_strider"], hidden=3)


def answers(training, heading, failure):
    """Return policy, observations and corrections of a network whose weights of the first stage are given numbers."""
    weights = NetworkSearch(training).mean
    for group in loop_weights(training):
        weights[group.indices] = heading if len(group.indices) == 1 else failure
    policy = with_network(training, training.taken_table, weights)
    observations = np.random.default_rng(0).uniform(-1.0, 1.0, (8, len(policy.layers[0].weights)))
    return policy, observations, lambda rows: Networks([policy] * len(rows), training.robot).answer(rows)


@pytest.mark.parametrize("training", [CAIMAN, STRIDER])
def test_the_parameters_that_steer_answer_to_the_heading_alone(training):
    policy, observations, answer = answers(training, 0.5, 0.0)
    error = observations[:, heading_column(training)]
    reading = error / (1.0 + np.abs(error)) if training.hidden else error
    is_odd = np.array([ACTIONS[name].is_odd for name, _ in policy.action_columns])
    assert is_odd.sum() > 1
    expected = 0.5 * reading[:, None] * np.where(is_odd, policy.spans, 0.0)
    np.testing.assert_allclose(answer(observations), expected, rtol=1e-12, atol=1e-15)


def test_a_known_failure_changes_rate_strokes_and_heights_whichever_servo_failed():
    policy, observations, answer = answers(CAIMAN, 0.0, 0.25)
    (failure,) = (s.columns for s in observation_layout(CAIMAN.robot, CAIMAN.readings) if s.name == "failure")
    rows = np.zeros((3, observations.shape[1]))
    rows[1, failure.start + 2] = rows[2, failure.stop - 1] = 1.0
    names = [name for name, _ in policy.action_columns]
    expected = 0.25 * np.where(np.isin(names, FAILURE_ACTIONS), policy.spans, 0.0)
    np.testing.assert_allclose(answer(rows), [np.zeros(len(names)), expected, expected], rtol=1e-12)
    untold = Training(task="velocity_untold", start=POLICIES["velocity"])
    assert all(len(group.indices) == 1 for group in loop_weights(untold))


def test_the_first_generations_search_the_loop_and_the_others_all_weights():
    search, loop = NetworkSearch(CAIMAN), loop_weights(CAIMAN)
    searched = np.concatenate([group.indices for group in loop])
    target = np.linspace(1.0, -0.5, len(loop))
    others = np.setdiff1d(np.arange(weight_count(CAIMAN)), searched)
    assert not search.mean.any()

    def numbers(networks):
        return np.stack([networks[..., group.indices[0]] for group in loop], axis=-1)

    for _ in range(LOOP_GENERATIONS):
        assert search.episode_count == LOOP_EPISODES
        networks = search.ask()
        assert not networks[:, others].any()
        assert len({row.tobytes() for row in networks}) == len(networks)
        search.tell(((numbers(networks) - target) ** 2).sum(axis=1))
    mean = search.mean
    assert search.episode_count == EPISODES
    assert np.linalg.norm(numbers(mean) - target) < np.linalg.norm(target)
    networks = search.ask()
    np.testing.assert_array_equal(networks[-1], mean)
    assert networks[:-1, others].all()


def test_one_parameter_that_steers_is_searched_with_the_others():
    still = Training(robot=ROBOTS["strider"], axis=False, seed=3)
    assert len(loop_weights(still)) == 1
    search = NetworkSearch(still)
    assert search.episode_count == EPISODES
    assert search.ask()[:-1].all()
    np.testing.assert_array_equal(NetworkSearch(still).ask(), NetworkSearch(still).ask())
