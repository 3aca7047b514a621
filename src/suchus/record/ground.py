"""The ground of a run, as its record holds it: JSON text, since every kind of relief has numbers of its own."""

import json
from dataclasses import asdict
from typing import Any

import xarray as xr

from suchus.design.ground import Bumps, Ground, Step, Stone
from suchus.errors import IncompatibleRecord, SuchusError

NAME = "stands_on"
"""Of the variable along ``run`` that holds it; empty text where a run floats."""
_KEYS = {"friction_scale": "grip"}
"""Keys of records whose names are not those of the fields: files of earlier releases have them too."""
_RELIEFS = {"step": Step, "stone": Stone, "bumps": Bumps}


def ground_text(ground: Ground | None) -> str:
    """Return a ground as text; the empty one stands for none."""
    if ground is None:
        return ""
    text = {_KEYS.get(name, name): value for name, value in asdict(ground).items()}
    if ground.relief is not None:
        fields = asdict(ground.relief)
        if fields.get("scale") == 1.0:  # as it was written before bumps had a scale
            del fields["scale"]
        text["relief"] = {"kind": type(ground.relief).__name__.lower(), **fields}
    return json.dumps(text, sort_keys=True)


def ground_of(record: xr.Dataset) -> Ground | None:
    """Return what a run stood on; None where it floats, or where the record is of before grounds were kept.

    Args:
        record: of one run, with or without the dimension ``run``.

    Raises:
        IncompatibleRecord: what the record says is no ground.
    """
    text = str(record[NAME].values.ravel()[0]) if NAME in record else ""
    if not text:
        return None
    try:
        names = {key: name for name, key in _KEYS.items()}
        fields: dict[str, Any] = {names.get(key, key): value for key, value in json.loads(text).items()}
        relief = fields.pop("relief")
        return Ground(**fields, relief=None if relief is None else _RELIEFS[relief.pop("kind")](**relief))
    except (ValueError, KeyError, TypeError, AttributeError, SuchusError) as error:
        raise IncompatibleRecord(f"the record holds no ground that this suchus knows: {text[:120]!r}.") from error
