"""Where the command line begins and ends: words in, an exit code out."""

import sys
from collections.abc import Sequence

from suchus.cli.commands import COMMANDS, PROJECT, BadCommand
from suchus.cli.streams import drop_output, prepare_streams, printable
from suchus.errors import Diverged, NotConverged, SuchusError, UnknownName, Unwritable, plain_warnings
from suchus.sources import within

_EXAMPLES = (
    ("suchus demo", "a first walk, in the browser"),
    ("suchus reproduce", "everything, into out/report.html"),
    ("suchus run displacement --quick", "one experiment, in its short form"),
    ("suchus run displacement --help", "what can be changed about it"),
    ("suchus run displacement --robot my_robot.toml", "with a robot of your own"),
)


def main(words: Sequence[str] | None = None) -> int:
    """Carry out a command line and return the exit code.

    0: sound, whatever the verdicts. 1: an experiment failed. 2: bad input, reported in one sentence on standard
    error. 130: stopped by Ctrl-C.

    Args:
        words: what follows ``suchus``; by default those of this process.
    """
    words = list(sys.argv[1:] if words is None else words)
    prepare_streams()
    try:
        words, folder = _apart(words)
        with plain_warnings(), within(folder):
            return _flushed(words)
    except (Diverged, NotConverged) as error:
        return _complain(str(error), 1)
    except SuchusError as error:
        return _complain(str(error), 2)
    except KeyboardInterrupt:
        return _complain("stopped; what was finished is kept, nothing half-written is left.", 130)
    except BrokenPipeError:  # the reader of our output has gone, as in `suchus list | head -1`
        drop_output()
        return 0


def _apart(words: list[str]) -> tuple[list[str], str | None]:
    """Return the words of the command, and the project folder that ``--project`` names among them; None for none.

    Raises:
        BadCommand: no folder follows, or two do.
    """
    rest, folders = list[str](), list[str]()
    left = iter(words)
    for word in left:
        if word == PROJECT:
            folders.append(next(left, ""))
        elif word.startswith(f"{PROJECT}="):
            folders.append(word.partition("=")[2])
        else:
            rest.append(word)
    if len(folders) > 1 or "" in folders:
        raise BadCommand(f"{PROJECT} needs one folder, as in suchus list {PROJECT} my_lab.")
    return rest, folders[0] if folders else None


def _flushed(words: list[str]) -> int:
    """Carry out a command line; what it printed is out when this returns.

    Raises:
        Unwritable: standard output takes nothing, or the system refused a file in a way that nobody foresaw.
    """
    try:
        try:
            return _dispatch(words)
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        if isinstance(error, SuchusError):
            raise
        drop_output()
        what = f"{error.filename} cannot be read or written" if error.filename else "what was to be printed is lost"
        raise Unwritable(f"{what}: {(error.strerror or str(error)).lower()}.") from error


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
            return command(words[1:])
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
            "suchus COMMAND --help describes a command; --version prints the version.",
            f"suchus COMMAND ... {PROJECT} DIR takes along what stands in a project folder; without it, what stands in",
            "the working folder, if that has a suchus.toml.",
        )
    )


def _complain(sentence: str, code: int) -> int:
    print("suchus: " + printable(" ".join(sentence.split())), file=sys.stderr)
    return code
