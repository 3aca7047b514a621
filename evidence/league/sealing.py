"""Predict, seal, and only then open what was measured.

A prediction is two files: ``prediction.json``, and ``seal.json`` with the date, the state of the code and the digest of
the first. What was measured stands in another place and is read by ``opened`` alone, which asks for the seal.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from evidence.league.contestant import Contestant, Found, Interval, Quantity, Value
from evidence.league.spread import drawn, of_answers, of_draws, widest
from suchus.core.errors import InvalidDesign, NotConverged, SuchusError, UnreadableFile
from suchus.core.files import check_replaceable, package_digest, path_exists, read_json, versions, write
from suchus.core.files.provenance import plain
from suchus.core.jobs import conduct_sweep
from suchus.core.progress import Progress, silent

PREDICTION, SEAL = "prediction.json", "seal.json"
"""Files of a contestant's folder."""
_ANSWERS = "answers"
"""Folder beside them of what the rungs answered, from which an interrupted prediction goes on."""
_ROOMS = (
    "swimming/water", "sim/land", "sim/hydro", "sim/model", "flow", "robot",
)  # fmt: skip
"""Rooms whose source decides a prediction."""

Prediction = Mapping[str, Mapping[str, Interval]]
"""By quantity and rung."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Seal:
    """When a prediction was made, by which code, and what it was."""

    contestant: str
    """Name of the contestant."""
    date: str
    """When it was sealed, in UTC, as ISO 8601 has it."""
    code: str
    """First digits of the digest of every file of suchus."""
    versions: Mapping[str, str]
    """Versions of the packages that decide numbers."""
    given: Mapping[str, Any]
    """All numbers that the prediction rests on, with their ranges and sources."""
    refused: Mapping[str, str]
    """Why models gave no prediction, by rung."""
    prediction: str
    """SHA-256 of the file of the prediction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """What was measured of one quantity."""

    value: Value
    """The number, or several in a row."""
    low: Value
    """Lower end of what the measurement says."""
    high: Value
    """Upper end of what the measurement says."""
    unit: str
    """Unit, that of the prediction."""
    source: str
    """Source of the measurement, and how sure it is."""


def sealed_prediction(
    contestant: Contestant, out: Path, *, progress: Progress = silent, jobs: int = 1, date: datetime | None = None
) -> Seal:
    """Predict a contestant by every rung, write and seal the prediction, and return the seal.

    One that is sealed already by this state of the code is left as it is.

    Args:
        contestant: who.
        out: folder of the league; the contestant gets a folder of its name in it.
        progress: told the share that is done.
        jobs: rungs that are asked side by side, in processes of their own [-].
        date: of the seal; now if None.

    Raises:
        InvalidDesign: another state of the code has sealed a prediction there.
        UnreadableFile: the prediction there was changed after it had been sealed.
    """
    folder = out / contestant.name
    if path_exists(folder / SEAL):
        seal = read_seal(folder)
        if seal.code != code_state():
            raise InvalidDesign(
                f"{folder} holds a prediction that was sealed on {seal.date} by another state of the code, and "
                f"a sealed "
                "prediction is never replaced; choose another --out."
            )
        return seal
    check_replaceable(folder / PREDICTION)
    names = list(contestant.rungs)
    answers = conduct_sweep(
        f"league_{contestant.name}", _answers, [(contestant, name) for name in names],
        folder / _ANSWERS / _own_digest(),
        rooms=_ROOMS, progress=progress, jobs=jobs,
    )  # fmt: skip
    prediction, refused = predicted(contestant, dict(zip(names, answers, strict=True)))
    text = prediction_text({name: one.unit for name, one in contestant.predicts.items()}, prediction)
    write(folder / PREDICTION, text)
    seal = Seal(
        contestant=contestant.name,
        date=(date or datetime.now(UTC)).strftime("%Y-%m-%dT%H:%M:%SZ"),
        code=code_state(),
        versions=versions(),
        given=plain(contestant.inputs),
        refused={**refused, **contestant.excluded_models},
        prediction=_digest(text),
    )
    write(folder / SEAL, json.dumps(plain(seal), indent=2) + "\n")
    return seal


def _answers(item: tuple[Contestant, str], progress: Progress) -> xr.Dataset:
    """Return what a rung answers to each choice of the numbers, or why it cannot."""
    contestant, name = item
    rung = contestant.rungs[name]
    try:
        found = list(rung.work(drawn(contestant, rung.draws), progress))
    except SuchusError as error:
        return xr.Dataset(attrs={"refused": str(error)})
    data = {}
    for quantity in contestant.predicts:
        rows = [np.atleast_1d(np.asarray(one.get(quantity, np.nan), float)) for one in found]
        width = max(len(row) for row in rows)
        values = np.array([row if len(row) == width else np.full(width, np.nan) for row in rows])
        data[quantity] = (("answer", f"{quantity}_part"), values)
    return xr.Dataset(data, attrs={"refused": ""})


def predicted(contestant: Contestant, answers: Mapping[str, xr.Dataset]) -> tuple[Prediction, dict[str, str]]:
    """Return the intervals that follow from the answers of the rungs, and why some rungs gave none.

    Args:
        contestant: whose.
        answers: by rung, a variable for each quantity.
    """
    found: dict[str, dict[str, Interval]] = {quantity: {} for quantity in contestant.predicts}
    refused: dict[str, str] = {}
    for name, rung in contestant.rungs.items():
        said = answers[name]
        if said.attrs["refused"]:
            refused[name] = said.attrs["refused"]
            continue
        for quantity in contestant.predicts:
            rows = _rows(said, quantity)
            try:
                interval = (
                    of_draws(quantity, rows)
                    if rung.draws
                    else of_answers(
                        quantity, rows, found[quantity].get(rung.interval_source) or widest(found[quantity].values())
                    )
                )
            except NotConverged as error:
                refused[name] = str(error)
                continue
            if interval is not None:
                found[quantity][name] = interval
        if name not in refused and not any(name in rungs for rungs in found.values()):
            refused[name] = "it gave no answer with the most likely numbers."
    return found, refused


def _rows(said: xr.Dataset, quantity: str) -> list[Found]:
    rows: list[Found] = []
    for row in said[quantity].values:
        number: Value = float(row[0]) if len(row) == 1 else tuple(float(value) for value in row)
        rows.append({quantity: number} if np.isfinite(row).all() else {})
    return rows


def prediction_text(units: Mapping[str, str], prediction: Prediction) -> str:
    """Return a prediction as its file has it: ``{quantity: {rung: {value, low, high, unit}}}``.

    Args:
        units: of the quantities.
        prediction: by quantity and rung.
    """
    data = {
        quantity: {
            rung: {"value": one.value, "low": one.low, "high": one.high, "unit": units[quantity]}
            for rung, one in rungs.items()
        }
        for quantity, rungs in prediction.items()
    }
    return json.dumps(data, indent=2, allow_nan=False) + "\n"


def read_seal(folder: Path) -> Seal:
    """Return the seal of a contestant's folder, its prediction unchanged since.

    Raises:
        UnreadableFile: there is none, it says something else, or the prediction is another one.
    """
    data = read_json(folder / SEAL)
    try:
        seal = Seal(**data)
    except TypeError as error:
        raise UnreadableFile(f"{folder / SEAL} is no seal: {error}.") from error
    if _digest((folder / PREDICTION).read_text(encoding="utf-8")) != seal.prediction:
        raise UnreadableFile(
            f"{folder / PREDICTION} is not the prediction that was sealed on {seal.date}: it was changed since; "
            f"take it "
            "out, or restore it."
        )
    return seal


def read_prediction(folder: Path) -> dict[str, dict[str, Interval]]:
    """Return the sealed prediction of a folder.

    Raises:
        UnreadableFile: there is none, or it was changed.
    """
    read_seal(folder)
    return {
        quantity: {
            rung: Interval(*(bound_value(one[end]) for end in ("value", "low", "high"))) for rung, one in rungs.items()
        }
        for quantity, rungs in read_json(folder / PREDICTION).items()
    }


def bound_value(number: float | list[float]) -> Value:
    """Return a number of a JSON file, a list as a tuple."""
    return tuple(number) if isinstance(number, list) else float(number)


def opened(folder: Path, predicts: Mapping[str, Quantity], measured: Path) -> dict[str, Measured]:
    """Return what was measured, which is not read before the prediction of the folder is sealed; nothing if unknown.

    Args:
        folder: of the contestant.
        predicts: its quantities.
        measured: file of the measurement, ``{quantity: {value, low, high, unit, source}}``.

    Raises:
        UnreadableFile: there is no seal, or the measurement is in another unit, of another quantity or has no source.
    """
    read_seal(folder)
    return _measurements(predicts, measured) if path_exists(measured) else {}


def check_measured(predicts: Mapping[str, Quantity], measured: Path) -> None:
    """Refuse a file of a measurement by its form, before anything is predicted; its values are not looked at.

    Args:
        predicts: quantities of the contestant.
        measured: file of the measurement.

    Raises:
        UnreadableFile: it is no such file.
    """
    _measurements(predicts, measured)


def _measurements(predicts: Mapping[str, Quantity], measured: Path) -> dict[str, Measured]:
    """Return what a file of a measurement holds, by quantity; see ``opened``."""
    tables = read_json(measured)
    if not isinstance(tables, dict):
        raise UnreadableFile(
            f"{measured} holds a {type(tables).__name__}; a table is needed: "
            "{quantity: {value, low, high, unit, source}}."
        )
    measurements = {}
    for name, data in tables.items():
        if name not in predicts:
            raise UnreadableFile(f"{measured} measures {name!r}, which is not predicted; {', '.join(predicts)} are.")
        if not isinstance(data, dict):
            raise UnreadableFile(
                f"{measured} has {data!r} for {name}; a table of value, low, high, unit and source is needed."
            )
        lacking = [
            field
            for field in ("value", "low", "high", "unit", "source")
            if not data.get(field) and data.get(field) != 0
        ]
        if lacking:
            raise UnreadableFile(f"{measured} says nothing of {', '.join(lacking)} of {name}; give it.")
        if data["unit"] != predicts[name].unit:
            raise UnreadableFile(
                f"{measured} has {name} in {data['unit']}, and it is predicted in {predicts[name].unit}: convert it."
            )
        _check_interval(measured, name, data)
        ends = {end: bound_value(data[end]) for end in ("value", "low", "high")}
        measurements[name] = Measured(**ends, unit=data["unit"], source=data["source"])
    return measurements


def _check_interval(measured: Path, name: str, ends: Mapping[str, Any]) -> None:
    """Refuse a value outside its interval, and what is no finite number.

    Args:
        measured: file of the measurement.
        name: of the quantity.
        ends: value, low and high, each a number or several.

    Raises:
        UnreadableFile: they are none, not as many, or in another order.
    """
    try:
        low, value, high = (np.atleast_1d(np.asarray(ends[end], float)) for end in ("low", "value", "high"))
    except (TypeError, ValueError):
        low = value = high = np.array([np.nan])
    numbers_text = ", ".join(f"{end} {ends[end]}" for end in ("low", "value", "high"))
    if not (low.shape == value.shape == high.shape) or not np.isfinite([*low, *value, *high]).all():
        raise UnreadableFile(f"{measured} has {numbers_text} of {name}; finite numbers are needed, as many of each.")
    if not ((low <= value) & (value <= high)).all():
        raise UnreadableFile(f"{measured} has {numbers_text} of {name}; the value lies between low and high.")


@cache
def code_state() -> str:
    """Return the first 12 digits of the SHA-256 of suchus and of the league's own files.

    What was measured of the cases is left out: no prediction may depend on it, and nothing opens it before the seal.
    """
    return hashlib.sha256((package_digest() + _own_digest()).encode()).hexdigest()[:12]


@cache
def _own_digest() -> str:
    """Return the first 12 digits of the SHA-256 of the league's own files, but for what was measured."""
    folder, text = Path(__file__).parent, hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if not {"__pycache__", "measured"} & {*file.relative_to(folder).parts} and file.is_file():
            text.update(file.relative_to(folder).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()[:12]


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
