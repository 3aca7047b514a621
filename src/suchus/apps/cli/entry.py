"""Where the command line begins and ends: words in, an exit code out."""

import os
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass
from pkgutil import resolve_name
from shutil import get_terminal_size
from unicodedata import category

from suchus.apps.cli.command import carry_out, check_single, help_lines, own_commands
from suchus.core import large
from suchus.core.errors import (
    BusFailure,
    Diverged,
    NoMemory,
    NotConverged,
    SuchusError,
    UnknownName,
    Unwritable,
    out_of_memory,
    plain_warnings,
)
from suchus.core.printable import name_complaint
from suchus.core.sources import project_context
from suchus.core.stopping import StopSignal, stopping
from suchus.core.writing import is_text, replacing

PROJECT = "--project"
"""Option of every command: the project folder, see ``suchus.core.sources``."""
REPLACE = "--replace"
"""Option of every command: what a user wrote or changed may be replaced, see ``suchus.core.writing``."""
MIXED = "--mixed"
"""Option of every command: what another arithmetic began may be continued, see ``suchus.core.machine``."""
MIN_ADDRESS_SPACE = 2**30
"""Address space that suchus and its libraries need to begin with, 0.5 GB were too little [byte]."""
PORTABLE = "SUCHUS_PORTABLE"
"""Environment variable that asks for portable arithmetic, see ``suchus.core.machine``."""


class BadCommand(SuchusError):
    """Words on the command line that make no sense."""


@dataclass(frozen=True, slots=True)
class Subcommand:
    """A word after ``suchus``."""

    name: str
    """The word."""
    usage: str
    """Words that may follow it, for the help."""
    summary: str
    """Summary in one line, for the help."""
    function: str
    """``module:function`` that takes the remaining words and returns the exit code."""
    first_word: str = ""
    """Kind of what the first word names: experiment, robot, gait, file, file or folder; empty: not checked early."""
    other_words: tuple[str, ...] = ()
    """Words that may stand in the place of that name."""
    shelf_options: tuple[str, ...] = ()
    """Kinds of what an option of that name names: robot, gait, protocol."""
    output: str = ""
    """What ``--out`` names: a folder, a page, or a file for a gait or a robot; empty where it is not checked early."""

    def __call__(self, words: Sequence[str]) -> int:
        """Check the words, carry out the command, and return the exit code."""
        check: Callable[[Subcommand, Sequence[str]], None] = resolve_name("suchus.apps.cli.word_checks:check_words")
        check(self, words)
        function: Callable[[Sequence[str]], int] = resolve_name(self.function)
        return function(words)


COMMANDS = (
    Subcommand(
        "demo", "[--no-browser] [--out FILE.html]", "see a first walk", "suchus.apps.cli.demo:demo", output="page"
    ),
    Subcommand(
        "reproduce",
        "[--out DIR] [--jobs N]",
        "run every experiment and write the report",
        "suchus.apps.cli.reproduce:reproduce",
    ),
    Subcommand(
        "run",
        "NAME [--FIELD VALUE ...]",
        "run one experiment",
        "suchus.apps.cli.run:run",
        first_word="experiment",
        shelf_options=("robot", "gait"),
        output="folder",
    ),
    Subcommand(
        "compare",
        "A B [--out FILE.html]",
        "set two outcomes side by side",
        "suchus.apps.cli.compare:compare_outcomes",
        output="page",
    ),
    Subcommand(
        "capture",
        "TRACKS [--out FILE.toml]",
        "read a gait from tracked keypoints",
        "suchus.apps.cli.capture:capture",
        first_word="file or folder",
        shelf_options=("robot",),
        output="gait",
    ),
    Subcommand(
        "view",
        "[ROBOT] [GAIT] | RECORD.nc",
        "see it walk in the browser, live or played back",
        "suchus.apps.cli.view:view",
        first_word="robot",
        other_words=("swim",),
        shelf_options=("robot", "gait", "policy"),
    ),
    Subcommand(
        "page",
        "[ROBOT] [GAIT] [--out FILE.html]",
        "make a page in which it walks in a browser, offline, to try and to break",
        "suchus.apps.cli.page:make_page",
        first_word="robot",
        shelf_options=("robot", "gait"),
        output="page",
    ),
    Subcommand(
        "replay",
        "RECORD.nc [--out FILE.html]",
        "make a page of a stored run that plays offline, or a film",
        "suchus.apps.cli.replay:make_replay",
        first_word="file",
        shelf_options=("robot",),
        output="page",
    ),
    Subcommand(
        "lessons",
        "[--out DIR] [--serve]",
        "write five lessons for a class, that play offline",
        "suchus.apps.cli.lessons:lessons",
    ),
    Subcommand(
        "study",
        "claims|FILE.toml [--out DIR]",
        "run many variants, resumable",
        "suchus.apps.cli.study:study",
        first_word="file",
        other_words=("claims",),
    ),
    Subcommand(
        "optimise",
        "crawl|FILE.toml [--out DIR]",
        "search for a better gait or body, resumable",
        "suchus.apps.cli.optimise:optimise",
        shelf_options=("robot",),
    ),
    Subcommand(
        "train",
        "TASK [--robot ROBOT] [--minutes 15]",
        "train a policy that follows commands, resumable",
        "suchus.apps.cli.train:train",
        shelf_options=("robot", "gait"),
    ),
    Subcommand(
        "import",
        "ROBOT.urdf|ROBOT.xml [--out FILE.toml]",
        "read a robot from a URDF or an MJCF",
        "suchus.apps.cli.import_robot:import_file",
        first_word="file",
        output="robot",
    ),
    Subcommand(
        "export",
        "[--format mjcf|urdf|usd] [--robot ROBOT]",
        "write a robot for other tools",
        "suchus.apps.cli.export:export_robot",
        shelf_options=("robot", "gait"),
    ),
    Subcommand(
        "size",
        "[ROBOT] [GAIT ...] [--family NAME]",
        "find the servos that a robot needs",
        "suchus.apps.cli.size:size_servos",
        first_word="robot",
        shelf_options=("robot",),
    ),
    Subcommand(
        "parts",
        "[ROBOT] [--out DIR]",
        "write what a robot is built of",
        "suchus.apps.cli.parts:list_parts",
        first_word="robot",
        shelf_options=("robot", "gait"),
    ),
    Subcommand(
        "export-commands",
        "GAIT [--map FILE.toml]",
        "write a gait as timed servo angles",
        "suchus.apps.cli.export_commands:export_commands",
        first_word="gait",
        shelf_options=("robot", "gait"),
    ),
    Subcommand(
        "emulate",
        "ROBOT [--view] [--hardware FILE.toml]",
        "emulate a robot's servos on a bus",
        "suchus.apps.cli.emulate:emulate",
        first_word="robot",
        shelf_options=("robot", "gait", "protocol"),
    ),
    Subcommand(
        "drive",
        "GAIT [--robot ROBOT] [--hardware FILE.toml]",
        "drive a robot of servos",
        "suchus.apps.cli.drive:run",
        first_word="gait",
        other_words=("swim",),
        shelf_options=("robot", "gait"),
    ),
    Subcommand(
        "calibrate",
        "wiring|zero|log [RECORD.nc] [--robot ROBOT]",
        "find out how a robot is wired and how stiff it is",
        "suchus.apps.cli.calibrate:calibrate",
        shelf_options=("robot",),
    ),
    Subcommand("doctor", "", "say whether suchus can run here, and what is missing", "suchus.apps.cli.doctor:doctor"),
    Subcommand(
        "list", "", "show what stands in the catalogs: robots, gaits, faults and so on", "suchus.apps.cli.shelves:show"
    ),
)
"""Every command that suchus comes with, in the order of the help."""
_HELP_WORDS = ("-h", "--help", "help")


_NARROWEST, _WIDEST = 40, 500  # columns of a terminal that a help is set for
_EXAMPLES = (
    ("suchus demo", "a first walk, in the browser"),
    ("suchus reproduce", "everything, into out/report.html"),
    ("suchus run displacement --quick", "one experiment, in its short form"),
    ("suchus run displacement --help", "what can be changed about it"),
    ("suchus run displacement --robot my_robot.toml", "with a robot of your own"),
)


def main(words: Sequence[str] | None = None, commands: Sequence[Subcommand] | None = None) -> int:
    """Carry out a command line and return the exit code.

    0: sound, whatever the verdicts. 1: an experiment failed. 2: bad input, reported in one sentence on standard
    error. 3: servos could not be reached, or had to be stopped. 130: stopped by Ctrl-C; 129 and 143: by SIGHUP, as of a
    terminal that is closed, and SIGTERM.

    Args:
        words: what follows ``suchus``; by default those of this process.
        commands: commands that the first word may name; programs of ``evidence`` have commands of their own. By default
            those of suchus, of the project folder and of other packages.
    """
    of_this_process = words is None
    words = list(sys.argv[1:] if words is None else words)
    _prepare_streams()
    try:
        if of_this_process and PORTABLE in os.environ:
            _begin_portable()
        words, folder = _split_project(words)
        replace, mixed, any_size = (option in words for option in (REPLACE, MIXED, large.OPTION))
        words = [word for word in words if word not in (REPLACE, MIXED, large.OPTION)]
        with (
            stopping(),
            out_of_memory(),
            plain_warnings(),
            project_context(folder),
            replacing(replace),
            _mixing(mixed),
            large.allowing(any_size),
        ):
            _check_words(words)
            _check_memory()
            return _dispatch_and_flush(words, commands)
    except (Diverged, NotConverged) as error:
        return _complain(str(error), 1)
    except BusFailure as error:
        return _complain(str(error), 3)
    except SuchusError as error:
        return _complain(str(error), 2)
    except MemoryError:
        return _complain(str(NoMemory()), 2)
    except KeyboardInterrupt as stop:
        number = stop.number if isinstance(stop, StopSignal) else signal.SIGINT
        return _complain("stopped; what was finished is kept, nothing half-written is left.", 128 + number)
    except BrokenPipeError:  # the reader of our output has gone, as in `suchus list | head -1`
        _drop_output()
        return 0


def _check_words(words: Sequence[str]) -> None:
    """Refuse words that are not UTF-8 or steer a terminal, since every result stores its command as text.

    Raises:
        BadCommand: a word has bytes that are no UTF-8, or characters that must not be printed.
    """
    for word in words:
        if not is_text(word):
            raise BadCommand(f"{word!r} is no text in UTF-8, as results, which hold their command, are: rename it.")
        complaint = name_complaint(word)
        if complaint is not None:
            raise BadCommand(f"{complaint}.")


def _check_memory() -> None:
    """Refuse to start with too little memory for the libraries, whose own errors would be obscure.

    Raises:
        BadCommand: this process may take too little memory.
    """
    memory_limit = large.memory()
    if memory_limit is not None and memory_limit < MIN_ADDRESS_SPACE:
        raise BadCommand(
            f"this process may take {memory_limit / 1e9:.2g} GB of memory, and suchus needs "
            f"{MIN_ADDRESS_SPACE / 1e9:.2g} GB: "
            "raise the limit, as with ulimit -v unlimited."
        )


def _begin_portable() -> None:
    """Restart this process where its libraries do not yet use the portable arithmetic that it requests.

    Raises:
        OutsideLimits: this machine has no such arithmetic.
    """
    from suchus.core.machine import portable_environment  # noqa: PLC0415  NumPy takes a tenth of a second, needed here only

    environment = portable_environment(os.environ)
    if environment is not None:
        os.execve(sys.executable, [sys.executable, *sys.orig_argv[1:]], environment)


def _mixing(allow_mixed: bool) -> AbstractContextManager[None]:
    """Return a context in which results of another arithmetic may be continued, if that is allowed."""
    if not allow_mixed:
        return nullcontext()
    from suchus.core.machine import mixing  # noqa: PLC0415  as above

    return mixing()


def _split_project(words: list[str]) -> tuple[list[str], str | None]:
    """Return the words of the command, and the project folder that ``--project`` names among them; None for none.

    Raises:
        BadCommand: no folder follows, or two do.
    """
    command_words, folders = list[str](), list[str]()
    word_iterator = iter(words)
    for word in word_iterator:
        if word == PROJECT:
            folders.append(next(word_iterator, ""))
        elif word.startswith(f"{PROJECT}="):
            folders.append(word.partition("=")[2])
        else:
            command_words.append(word)
    if len(folders) > 1 or "" in folders:
        raise BadCommand(f"{PROJECT} needs one folder, as in suchus list {PROJECT} my_lab.")
    return command_words, folders[0] if folders else None


def _dispatch_and_flush(words: list[str], commands: Sequence[Subcommand] | None) -> int:
    """Carry out a command line and flush standard output.

    Raises:
        Unwritable: standard output takes nothing, or the system refused a file in a way that nobody foresaw.
    """
    try:
        try:
            return _dispatch(words, commands)
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        if isinstance(error, SuchusError):
            raise
        _drop_output()
        problem = f"{error.filename} cannot be read or written" if error.filename else "what was to be printed is lost"
        raise Unwritable(f"{problem}: {(error.strerror or str(error)).lower()}.") from error


def _dispatch(words: list[str], commands: Sequence[Subcommand] | None) -> int:
    """Carry out the command that the first word names, or print version or help, and return the exit code.

    Args:
        words: what follows ``suchus``.
        commands: commands that the first word may name; None for those of suchus, of the project folder and of other
            packages.

    Raises:
        UnknownName: there is no such command.
        AmbiguousName: there are two of this name.
    """
    if words and words[0] in ("--version", "-V"):
        if words[1:]:
            raise BadCommand(f"{words[0]} stands alone; leave out {' '.join(words[1:])!r}.")
        from importlib.metadata import version  # noqa: PLC0415  half of the start-up time, needed here only

        print(f"suchus {version('suchus')}")
        return 0
    if not words or words[0] in _HELP_WORDS:
        print(_help())
        return 0
    name, *options = words
    known_commands = {command.name: command for command in (COMMANDS if commands is None else commands)}
    if name in known_commands:
        if commands is None:
            check_single(name)
        return known_commands[name](options)
    others = own_commands() if commands is None else {}
    if name in others:
        return carry_out(name, options)
    raise UnknownName("command", name, [*known_commands, *others])


def reserved_names() -> set[str]:
    """Return the words after ``suchus`` that mean something by themselves, which no command of a user may be named."""
    return {*(command.name for command in COMMANDS), *_HELP_WORDS}


def _help() -> str:
    """Return the help: every command with its usage and summary, those of a user's own, then examples."""
    command_width = max(len(f"{c.name} {c.usage}") for c in COMMANDS)
    example_width = max(len(example) for example, _ in _EXAMPLES)
    return "\n".join(
        (
            "suchus: the open laboratory for crocodile-like robots",
            "",
            "usage: suchus COMMAND ...",
            "",
            *(f"  {f'{c.name} {c.usage}':<{command_width}}  {c.summary}" for c in COMMANDS),
            *help_lines(reserved_names(), command_width),
            "",
            "examples:",
            *(f"  {example:<{example_width}}  {text}" for example, text in _EXAMPLES),
            "",
            "suchus COMMAND --help describes a command; --version prints the version.",
            f"suchus COMMAND ... {PROJECT} DIR takes along what stands in a project folder; without it, what stands in",
            "the working folder, if that has a suchus.toml.",
            f"suchus COMMAND ... {REPLACE} replaces files that you wrote or changed too, and keeps a backup; without",
            "it they are never touched.",
            f"suchus COMMAND ... {large.OPTION} begins what takes more than half of the memory, or a day of a",
            "processor; without it that is estimated and refused.",
            f"suchus COMMAND ... {MIXED} goes on with a study that a machine with other last bits began; the results",
            "then tell so. SUCHUS_PORTABLE=1 in the environment computes the same bits on every x86-64 with Linux.",
        )
    )


def _complain(sentence: str, code: int) -> int:
    print("suchus: " + printable(" ".join(sentence.split())), file=sys.stderr)
    return code


# --- the surroundings of a command --------------------------------------------------------------------------------


def _prepare_streams() -> None:
    """Make sure that there are streams that take every letter, a width that text can be set in, and a way to draw.

    A stream that is closed becomes one that swallows everything: the next file that is opened must not take its
    number, and what is meant for people must not end up in it. Figures are only ever saved, so that no window is
    needed, whatever ``MPLBACKEND`` says.
    """
    if sys.stdout is None or sys.stderr is None:
        for number in range(3):
            _hold(number)
        sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123  until we end
        sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    columns = get_terminal_size().columns
    if not _NARROWEST <= columns <= _WIDEST:
        os.environ["COLUMNS"] = str(min(max(columns, _NARROWEST), _WIDEST))
    if "matplotlib" not in sys.modules:
        os.environ["MPLBACKEND"] = "agg"


def _hold(number: int) -> None:
    try:
        os.fstat(number)
    except OSError:
        os.open(os.devnull, os.O_RDWR)  # the system assigns the lowest free number


def _drop_output() -> None:
    """Redirect standard output to nowhere, so that the exit of the process reports no second error."""
    with suppress(OSError, ValueError):  # not every stream is a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def printable(text: str) -> str:
    """Return a text with control characters escaped; spaces of every kind stay."""
    return "".join(c if c.isprintable() or category(c) == "Zs" else c.encode("unicode_escape").decode() for c in text)
