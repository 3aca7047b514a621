"""Which kept results are old, and what it costs to compute them again.

Usage: python -m evidence.stale [NAME ...]

A result is *current* while the code that it reaches is the same, or while its probe gives the same numbers; *possibly
old* where the code has changed and no probe can tell; *old* where the probe gives other numbers. The answers are kept
in ``out/stale.json`` for the built pages. The exit code is 0 whatever is old: only a release requires current results.
"""

import json
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

from evidence import probes, source, tolerance
from evidence.registry import RESULTS, Kept
from evidence.store import ROOT, StoredResult, load, names
from suchus.core.errors import SuchusError
from suchus.core.files import new_file

State = Literal["current", "possibly old", "old", "not checked here"]
"""What is known of a result."""
ANSWERS = ROOT / "out" / "stale.json"
"""File of the last answers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What is known of a result."""

    name: str
    """Name of the result."""
    state: State
    """State of the result."""
    reason: str
    """Reason, in a phrase."""
    seconds: float | None
    """Processor time that computing it took when it was last computed [s]; None where that is unknown."""
    renew: str
    """Command that computes it again."""
    version: str = ""
    """Version of suchus that computed it."""
    code: str = ""
    """Digest of the code that was compared."""


def status(kept: Kept, *, package: Path = source.PACKAGE, by_probe: bool = True) -> Status:
    """Return what is known of a result.

    Args:
        kept: the result.
        package: folder of the package whose sources count.
        by_probe: whether its probe may run where its code has changed; without it such a result is possibly old.
    """
    try:
        stored = load(kept.name)
    except SuchusError as error:
        return _status(kept, None, "not checked here", str(error))
    if not kept.modules:
        return _status(kept, stored, "not checked here", "the speed of a machine, which no other machine repeats")
    code = source.digest(source.reached(kept.modules), package)
    if stored.source == code:
        return _status(kept, stored, "current", "the same code", code)
    if kept.probe is None or not stored.probe:
        return _status(kept, stored, "possibly old", "its code has changed, and it was kept without a probe", code)
    if not by_probe:
        return _status(kept, stored, "possibly old", "its code has changed", code)
    try:
        numbers = probes.flat(kept.probe())
    except Exception as error:  # whatever a machine lacks: a probe that cannot run tells nothing of the result
        message = f"its probe cannot run on this machine: {type(error).__name__}: {error}"
        return _status(kept, stored, "not checked here", message, code)
    if moved := tolerance.moved(stored.probe, numbers):
        return _status(kept, stored, "old", _moved(moved), code)
    return _status(kept, stored, "current", "other code that does the same", code)


def _status(kept: Kept, stored: StoredResult | None, state: State, why: str, code: str = "") -> Status:
    seconds, version = (stored.origin.seconds, stored.origin.version) if stored else (None, "")
    return Status(
        name=kept.name, state=state, reason=why, seconds=seconds, renew=kept.renew, version=version, code=code
    )


def _moved(moved: Mapping[str, tuple[float, float]]) -> str:
    name, (before, now) = next(iter(moved.items()))
    return f"its probe gives {len(moved)} other number{'s' * (len(moved) > 1)}, as {name} {now:.6g} for {before:.6g}"


def with_parts(answers: Sequence[Status]) -> list[Status]:
    """Return the answers, in which a result that is made of others is as old as the oldest of them."""
    by_name = {answer.name: answer for answer in answers}
    order: tuple[State, ...] = ("current", "not checked here", "possibly old", "old")
    found = []
    for answer in answers:
        parts = [by_name[part] for part in RESULTS[answer.name].sources if part in by_name]
        worst = max([answer, *parts], key=lambda part: order.index(part.state))
        if worst is answer:
            found.append(answer)
            continue
        found.append(
            Status(**{**asdict(answer), "state": worst.state, "reason": f"{worst.name}, of which it is made, is"})
        )
    return found


def check(
    wanted: Iterable[str],
    *,
    package: Path = source.PACKAGE,
    by_probe: bool = True,
    tell: Callable[[Status], None] = lambda _: None,
) -> list[Status]:
    """Return what is known of some results, in their order.

    Args:
        wanted: names of the results.
        package: folder of the package whose sources count.
        by_probe: whether probes may run.
        tell: called with each answer as soon as there is one.
    """
    answers = []
    for name in wanted:
        answers.append(status(RESULTS[name], package=package, by_probe=by_probe))
        tell(answers[-1])
    return with_parts(answers)


def table(answers: Sequence[Status]) -> str:
    """Return the results that are not current as lines, and a last line with the sum."""
    lines = []
    for answer in (answer for answer in answers if answer.state != "current"):
        cost = "time unknown" if answer.seconds is None else f"{answer.seconds / 60:.1f} min"
        lines.append(f"{answer.name:24s} {answer.state:17s} {cost:>12s}  {answer.renew}\n{'':25s}{answer.reason}")
    old = [answer for answer in answers if answer.state in ("old", "possibly old")]
    known = sum(answer.seconds or 0.0 for answer in old)
    unknown = sum(answer.seconds is None for answer in old)
    more = f" and {unknown} whose time is unknown" * (unknown > 0)
    head = f"{len(answers) - len(old)} of {len(answers)} results are not old."
    return "\n".join([*lines, head + f" The others take {known / 60:.0f} min of processor time{more}." * bool(old)])


def keep(answers: Sequence[Status], file: Path = ANSWERS) -> None:
    """Keep answers beside earlier ones on other results."""
    try:
        before = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        before = {}
    file.parent.mkdir(parents=True, exist_ok=True)
    with new_file(file) as draft:
        draft.write_text(json.dumps(before | {answer.name: asdict(answer) for answer in answers}, indent=1) + "\n")


def main(words: Sequence[str]) -> int:
    """Print which results are old; return 2 where a name is unknown."""
    if unknown := [word for word in words if word not in RESULTS]:
        print(f"There is no result named {unknown[0]!r}; choose among {', '.join(RESULTS)}.", file=sys.stderr)
        return 2
    began = time.process_time()

    def tell(answer: Status) -> None:
        print(f"{answer.name}: {answer.state}", file=sys.stderr, flush=True)

    stored = set(names())
    answers = check(words or [name for name in RESULTS if name in stored], tell=tell)
    keep(answers)
    print(table(answers))
    print(f"Processor time of this look: {time.process_time() - began:.0f} s.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
