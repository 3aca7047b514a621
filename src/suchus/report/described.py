"""What ``outcome.json`` may say, so that a page can be made of it."""

from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, FiniteFloat, ValidationError

from suchus.errors import IncompatibleRecord


class _Described(BaseModel):
    model_config = ConfigDict(strict=True, extra="allow")


class _Measure(_Described):
    value: FiniteFloat | None
    unit: str


class _Share(_Described):
    share: FiniteFloat
    low: FiniteFloat
    high: FiniteFloat
    designs: int
    turned_by: str = ""
    at: FiniteFloat | None = None
    above: bool = False


class _Verdict(_Described):
    claim: str
    quantity: str
    statement: str
    where: str
    printed: FiniteFloat | None
    measured: FiniteFloat | None
    unit: str
    verdict: str
    why: str
    low: FiniteFloat | None = None
    high: FiniteFloat | None = None
    repeats: str = ""
    quote: str = ""
    rule: list[str] = []
    fragile: bool = False
    share: _Share | None = None
    unswept: str = ""


class _Provenance(_Described):
    config_hash: str
    seed: Any
    seconds: FiniteFloat


class _Outcome(_Described):
    experiment: str
    title: str
    shows: str
    decides: str
    command: str
    measures: dict[str, _Measure]
    verdicts: list[_Verdict]
    provenance: _Provenance
    unjudged: str = ""


def check_described(outcome: Any, file: Path) -> None:
    """Refuse what no outcome says.

    Args:
        outcome: what a file says, as JSON is read.
        file: which, for the message.

    Raises:
        IncompatibleRecord: naming the place and what is wrong there.
    """
    try:
        _Outcome.model_validate(outcome)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(map(str, first["loc"]))
        if first["type"] == "missing":
            raise IncompatibleRecord(f"{file} lacks {place}.") from error
        raise IncompatibleRecord(
            f"{file} is no outcome of suchus: {place or 'it'} is of another kind ({first['msg'].lower()})."
        ) from error
