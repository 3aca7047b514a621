"""The environments by name: ``suchus/Crawl-v0`` and so on, one for each task."""

from collections.abc import Mapping
from types import MappingProxyType

import gymnasium

from suchus.envs.shelf import TASKS

STEPS = 200
"""Greatest number of steps of an episode [-]: 10 s, two and a half cycles of the article's crawl."""
LONGER: Mapping[str, int] = MappingProxyType({"Swim": 400, "Shore": 1000})
"""Steps of an episode of the tasks that take longer [-]: 20 s, three times what the steered swim to the goal
takes; 50 s, as in the experiment ``shore``."""
IDS = tuple(f"suchus/{name}-v0" for name in TASKS)
"""Names of the environments."""


def register() -> None:
    """Make the environments known to ``gymnasium.make`` and ``gymnasium.make_vec``; once is enough."""
    for name, identity in zip(TASKS, IDS, strict=True):
        if identity not in gymnasium.registry:
            gymnasium.register(
                identity,
                entry_point="suchus.envs.single:CrocodileEnv",
                vector_entry_point="suchus.envs.vector:CrocodileVectorEnv",
                max_episode_steps=LONGER.get(name, STEPS),
                kwargs={"task": name},
            )
