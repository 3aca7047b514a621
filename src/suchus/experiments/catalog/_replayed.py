"""The page of a run that stands beside the figures of an experiment."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import xarray as xr

from suchus.experiments.experiment import Replay
from suchus.robot.design import Robot
from suchus.visual.replay import replay


def replayed(file: str, record: xr.Dataset, robot: Robot, *, caption: str, **page: Any) -> Mapping[str, Replay]:
    """Return the replay of a run by the name of its file.

    Args:
        file: its name, ending in ``_replay.html``.
        record: record of one run.
        robot: robot of the record.
        caption: what the replay shows.
        **page: what else the page takes, such as ``ghost`` and ``labels``; see ``suchus.visual.replay.replay``.
    """
    return {file: Replay(caption=caption, make=partial(replay, record, robot, caption=caption, **page))}
