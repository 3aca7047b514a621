import numpy as np
import pytest

import suchus


@pytest.fixture(scope="session")
def crawled(robot, crawl_gait):
    """A second and a half of crawling."""
    return suchus.crawl(robot, crawl_gait, duration=2.5, timestep=0.005)


@pytest.fixture(scope="session")
def limped(robot, crawl_gait):
    return suchus.crawl(robot, crawl_gait, duration=2.5, timestep=0.005, faults=(suchus.Limp("LF_pitch"),))


@pytest.fixture
def rng():
    return np.random.default_rng(0)
