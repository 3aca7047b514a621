"""Where the command line begins and ends: words in, an exit code out."""

import os
import sys
from collections.abc import Sequence

from suchus.cli.commands import COMMANDS, BadCommand
from suchus.errors import Diverged, NotConverged, SuchusError, UnknownName

_EXAMPLES = (
    ("suchus reproduce", "everything, into out/report.html"),
    ("suchus run displacement --quick", "one experiment, in its short form"),
    ("suchus run displacement --help", "what can be changed about it"),
    ("suchus run displacement --robot my_robot.toml", "with a robot of your own"),
)


def main(words: Sequence[str] | None = None) -> int:
    """Carry out a command line and return the exit code.

    0: sound, whatever the verdicts. 1: an experiment failed. 2: bad input, told in one sentence on standard
    error. 130: stopped by Ctrl-C.

    Args:
        words: what follows ``suchus``; by default those of this process.
    """
    words = list(sys.argv[1:] if words is None else words)
    try:
        return _dispatch(words)
    except (Diverged, NotConverged) as error:
        return _complain(str(error), 1)
    except SuchusError as error:
        return _complain(str(error), 2)
    except KeyboardInterrupt:
        return _complain("stopped; what was finished is kept, nothing half-written is left.", 130)
    except BrokenPipeError:  # the reader of our output has gone, as in `suchus list | head -1`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _dispatch(words: list[str]) -> int:
    if words and words[0] in ("--version", "-V"):
        if words[1:]:
            raise BadCommand(f"{words[0]} stands alone; leave out {' '.join(words[1:])!r}.")
        from importlib.metadata import version  # noqa: PLC0415  half of the start-up time, needed here only

        print(f"suchus {version('suchus')}")
        return 0
    if not words or words[0] in ("-h", "--help", "help"):
        print(_help())
        return 0
    for command in COMMANDS:
        if command.name == words[0]:
            code = command(words[1:])
            sys.stdout.flush()
            return code
    raise UnknownName("command", words[0], [command.name for command in COMMANDS])


def _help() -> str:
    left = max(len(f"{c.name} {c.usage}") for c in COMMANDS)
    right = max(len(example) for example, _ in _EXAMPLES)
    return "\n".join(
        (
            "suchus: the open laboratory for crocodile-like robots",
            "",
            "usage: suchus COMMAND ...",
            "",
            *(f"  {f'{c.name} {c.usage}':<{left}}  {c.summary}" for c in COMMANDS),
            "",
            "examples:",
            *(f"  {example:<{right}}  {text}" for example, text in _EXAMPLES),
            "",
            "suchus COMMAND --help says more about a command; --version tells the version.",
        )
    )


def _complain(sentence: str, code: int) -> int:
    print("suchus: " + " ".join(sentence.split()), file=sys.stderr)
    return code
