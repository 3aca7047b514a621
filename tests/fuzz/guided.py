"""Whether guidance by coverage finds more: lines of the importer that equally many cases reach, each way.

``python tests/fuzz/guided.py blind|targets|atheris [COUNT]``. The cases are those of ``doors.altered`` over three small
robots; ``targets`` lets hypothesis look for cases that reach new lines, ``atheris`` lets libFuzzer, with the same
changes as its mutations (it is in no extra: ``pip install atheris``). The results are kept in ``guided.json``, of which
``tools/reliability.py`` makes the passage of docs/reliability.md.
"""

import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from datetime import date
from pathlib import Path
from random import Random
from types import FrameType, FunctionType
from typing import Any

from doors import altered, pendulum, quadruped

from suchus.core.errors import SuchusError
from suchus.sim.model.importing import Words, import_robot

KEPT = Path(__file__).with_name("guided.json")
"""By way and number of cases: the lines that they reached, how many of them were robots, and when."""
COUNTS = (250, 500)
"""Numbers of cases after which that is noted."""
ROOM = str(Path(sys.modules[import_robot.__module__].__file__ or "").parent)
SEEDS = [text.encode() for text in (quadruped(), pendulum(), pendulum(3, axis="0 1 0"))]


class Reached:
    """The lines of the importer that cases reached so far."""

    def __init__(self, way: str, count: int) -> None:
        self.file, self.left, self.lines = Path(tempfile.mkdtemp()) / "it.urdf", count, set[tuple[str, int]]()
        self.way, self.done, self.passed = way, 0, 0

    def case(self, data: bytes) -> int:
        """Read a robot, and return how many lines nobody had reached before."""
        before, self.left, self.done = len(self.lines), self.left - 1, self.done + 1
        self.file.write_bytes(data)
        sys.settrace(self._trace)
        try:
            import_robot(self.file, name="it", words=Words())
            self.passed += 1
        except SuchusError:
            pass
        finally:
            sys.settrace(None)
        if self.done in COUNTS:
            self.note()
        return len(self.lines) - before

    def note(self) -> None:
        """Keep what was reached by now."""
        kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
        told = {"lines": len(self.lines), "robots": self.passed, "date": date.today().isoformat()}
        kept[self.way] = {**kept.get(self.way, {}), str(self.done): told}
        KEPT.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n", encoding="utf-8")

    def _trace(self, frame: FrameType, event: str, _: Any) -> Callable[..., Any] | None:
        return self._line if frame.f_code.co_filename.startswith(ROOM) else None

    def _line(self, frame: FrameType, event: str, _: Any) -> Callable[..., Any]:
        if event == "line":
            self.lines.add((frame.f_code.co_filename, frame.f_lineno))
        return self._line


def blind(reached: Reached, count: int) -> None:
    for number in range(count):
        dice = Random(number)
        reached.case(altered(dice.choice(SEEDS).decode(), dice).encode())


def targets(reached: Reached, count: int) -> None:
    from hypothesis import HealthCheck, given, settings, target  # noqa: PLC0415  where it is asked for
    from hypothesis import strategies as st  # noqa: PLC0415

    @settings(max_examples=count, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(st.randoms(use_true_random=False), st.sampled_from(SEEDS))
    def examples(dice: Random, seed: bytes) -> None:
        if reached.left:
            target(float(reached.case(altered(seed.decode(), dice).encode())))

    examples()


def of_the_importer() -> Iterator[FunctionType]:
    """Yield the importer's functions and methods: guidance is by what is reached of these."""
    package = import_robot.__module__.rpartition(".")[0]
    for name, module in list(sys.modules.items()):
        if name.startswith(package):
            for one in vars(module).values():
                if getattr(one, "__module__", "") == name:
                    yield from (part for part in (one, *vars(one).values()) if isinstance(part, FunctionType))


def atheris(reached: Reached, count: int) -> None:
    import atheris as fuzzer  # noqa: PLC0415

    def change(data: bytes, size: int, seed: int) -> bytes:
        try:
            return altered(data.decode(), Random(seed)).encode()[:size]
        except (ValueError, LookupError):
            return bytes(fuzzer.Mutate(data, size))

    def one(data: bytes) -> None:
        if not reached.left:
            os._exit(0)
        reached.case(data)

    corpus = Path(tempfile.mkdtemp())
    for number, seed in enumerate(SEEDS):
        (corpus / str(number)).write_bytes(seed)
    for function in of_the_importer():
        fuzzer.instrument_func(function)
    words = [sys.argv[0], str(corpus), f"-runs={2 * count}", "-max_len=20000", "-seed=1", "-verbosity=0"]
    fuzzer.Setup(words, one, custom_mutator=change)
    fuzzer.Fuzz()


if __name__ == "__main__":
    number_of_cases = int(sys.argv[2]) if len(sys.argv) > 2 else 500
    reached = Reached(sys.argv[1], number_of_cases)
    {"blind": blind, "targets": targets, "atheris": atheris}[sys.argv[1]](reached, number_of_cases)
