"""Swim in three dimensions on several grids, and keep how far the ladder's numbers lie apart on them.

Usage: python tools/ladder_grids.py FOLDER: swims as the experiment ``swimming`` does on the rung of three dimensions,
but on 68, 80 and 96 cells a length, some eight minutes of processor time. A folder that holds finished swims goes on.
It writes ``src/suchus/experiments/catalog/swimming/grids.json``, which the experiment reads.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import xarray as xr

from suchus.core.progress import silent
from suchus.experiments.catalog.swimming.experiment import experiment
from suchus.experiments.catalog.swimming.ladder import (
    GRIDS,
    LadderSetting,
    Swims,
    numbers_in_space,
    rules_digest,
    space_swims,
)

KEPT = Path(__file__).parents[1] / "src" / "suchus" / "experiments" / "catalog" / "swimming" / GRIDS
CELLS = (68, 80, 96)
"""Cells per body length, rising [-]."""


def swum(climb: LadderSetting, folder: Path) -> Swims:
    """Return the swims on one grid, from the folder if they lie there."""
    place = folder / f"{climb.digest}_{climb.space_cells}"
    if not place.is_dir():
        swims, draft = space_swims(climb, silent), place.with_suffix(".part")
        draft.mkdir(parents=True, exist_ok=True)
        for name, one in swims.items():
            one.to_netcdf(draft / f"{name}.nc")
        draft.rename(place)
    return {file.stem: xr.load_dataset(file) for file in sorted(place.glob("*.nc"))}


def study(folder: Path) -> dict[str, Any]:
    """Return what is kept: what it was made for, and the ends of each number's halves and sides over the grids."""
    climbs = [replace(experiment, space_cells=cells).ladder_setting() for cells in CELLS]
    found = [dict(numbers_in_space(climb, swum(climb, folder))) for climb in climbs]
    return {
        "rules": rules_digest(),
        "swim": climbs[0].digest,
        "cells": list(CELLS),
        "values": {name: [round(one[name].value, 6) for one in found] for name in found[0]},
        "measures": {
            name: [round(min(one[name].low for one in found), 6), round(max(one[name].high for one in found), 6)]
            for name in found[0]
        },
    }


def main(folder: Path) -> None:
    """Write the study."""
    KEPT.write_text(json.dumps(study(folder), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
