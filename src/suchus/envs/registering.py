"""The environments by name: ``suchus/Crawl-v0``, ``suchus/Stand-v0``, ``suchus/Fault-v0``."""

import gymnasium

from suchus.envs.task import TASKS

STEPS = 200
"""Of an episode: 10 s, two and a half cycles of the article's crawl."""
IDS = tuple(f"suchus/{name}-v0" for name in TASKS)
"""Their names."""


def register() -> None:
    """Make the environments known to ``gymnasium.make`` and ``gymnasium.make_vec``; once is enough."""
    for name, identity in zip(TASKS, IDS, strict=True):
        if identity not in gymnasium.registry:
            gymnasium.register(
                identity,
                entry_point="suchus.envs.single:CrocodileEnv",
                vector_entry_point="suchus.envs.vector:CrocodileVectorEnv",
                max_episode_steps=STEPS,
                kwargs={"task": name},
            )
