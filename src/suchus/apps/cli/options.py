"""From the words after ``suchus run NAME`` to an experiment with its fields set."""

import io
import re
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr
from dataclasses import dataclass, field, fields, make_dataclass
from pathlib import Path
from textwrap import fill
from typing import Annotated, Any, TypeVar

import tyro
from tyro.constructors import ConstructorRegistry, PrimitiveConstructorSpec, PrimitiveTypeInfo

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.foreign_robot import drop_notes, print_notes, resolve_robot
from suchus.apps.cli.word_checks import option_values
from suchus.core.errors import SuchusError, UnknownName
from suchus.experiments.experiment import Experiment
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS, gait_of
from suchus.robot.motion import Gait
from suchus.robot.policies import POLICIES, SUFFIX, Policy, policy_of
from suchus.robot.robots import ROBOTS

_DEFAULT_ROBOT = "caiman"
_LINE_WIDTH = 110  # characters of a line of the description in the help

QUICK_FLAG = Annotated[
    bool,
    tyro.conf.FlagCreatePairsOff,
    tyro.conf.arg(help="Start from the quick form, small enough for a test."),
]
FOR_VERDICTS = "--for-verdicts"
"""Option of ``suchus run`` for what ``suchus reproduce`` runs."""
FOR_VERDICTS_FLAG = Annotated[
    bool,
    tyro.conf.FlagCreatePairsOff,
    tyro.conf.arg(help="Leave out what no verdict needs, such as most points of maps."),
]
RESULTS_FOLDER_OPTION = Annotated[
    Path, tyro.conf.arg(help="Folder for results; each experiment gets a folder of its own in it.")
]
TABLES = "csv"
"""Folder of a record as CSV files, beside the record."""
CSV = Annotated[
    bool,
    tyro.conf.FlagCreatePairsOff,
    tyro.conf.arg(help="Write the record as CSV files too, into the folder csv beside it."),
]

JSON = Annotated[
    bool,
    tyro.conf.FlagCreatePairsOff,
    tyro.conf.arg(help="Print the outcome as JSON, for programs, and nothing else on standard output."),
]
SCHEDULER = Annotated[
    str | None,
    tyro.conf.arg(help="Address of a Dask scheduler whose workers run it, as tcp://127.0.0.1:8786."),
]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRequest:
    """The experiment and the output that a command line asks for."""

    experiment: Experiment
    """The question with its fields set."""
    quick: bool
    """Whether it started from its quick form."""
    out: Path
    """The folder for results."""
    csv: bool
    """Whether the record is wanted as CSV too."""
    json: bool
    """Whether the outcome is printed for programs."""


def choose(experiment: Experiment, name: str, words: Sequence[str]) -> RunRequest:
    """Return what the words after ``suchus run NAME`` ask for.

    Raises:
        SuchusError: an option or a value makes no sense; the message is one sentence.
        SystemExit: help was asked for, and printed.
    """
    is_quick = "--quick" in words
    start = experiment.quick() if is_quick else experiment.for_verdicts() if FOR_VERDICTS in words else experiment
    words = _policy_words(start, name, words)
    robot = _robot(words)
    if robot is not None:
        start = start.for_robot(robot)
    prog = f"suchus run {name}"
    options: type[Any] = make_dataclass(
        "Options",
        [
            ("quick", QUICK_FLAG, field(default=False)),
            ("for_verdicts", FOR_VERDICTS_FLAG, field(default=False)),
            ("out", RESULTS_FOLDER_OPTION, field(default=Path("out"))),
            ("csv", CSV, field(default=False)),
            ("json", JSON, field(default=False)),
            ("experiment", Annotated[type(start), tyro.conf.arg(name="")], field(default=start)),
        ],
    )
    names = ["quick", "for_verdicts", "out", "csv", "json", *(f.name for f in fields(start))]  # type: ignore[arg-type]
    description = f"{start.title}\n\nAnswers: {start.shows}"
    settings = parse(options, prog, words, description, names, robot=getattr(start, "robot", None))
    return RunRequest(
        experiment=settings.experiment, quick=is_quick, out=settings.out, csv=settings.csv, json=settings.json
    )


def _policy_words(experiment: Experiment, name: str, words: Sequence[str]) -> list[str]:
    """Return the words with ``--policy`` in the place of ``--control`` where that names a policy.

    ``--control`` of an experiment with two groups names the gait of the control group.

    Raises:
        BadCommand: the experiment takes no policy.
    """
    words = [part for word in words for part in ([*word.split("=", 1)] if word.startswith("--control=") else [word])]
    for i, word in enumerate(words[:-1]):
        value = words[i + 1]
        is_policy = Path(value).suffix == SUFFIX or (value not in GAITS and value in POLICIES)
        if word == "--control" and is_policy:
            if not hasattr(experiment, "policy"):
                raise BadCommand(f"the experiment {name} takes no policy; displacement and policies do.")
            words[i] = "--policy"
    return words


def _robot(words: Sequence[str]) -> Robot | None:
    """Return the robot that the words name, so that the defaults of the other options can be its own.

    None where they name none, or none that there is: what is wrong is said when all words are read.
    """
    robot_words = option_values(words, "--robot")
    if not robot_words or robot_words[-1].startswith("-"):
        return None
    try:
        return resolve_robot(robot_words[-1])
    except SuchusError:
        return None


Options = TypeVar("Options")


def parse(
    options: type[Options],
    prog: str,
    words: Sequence[str],
    description: str,
    names: Sequence[str] = (),
    robot: Robot | None = None,
) -> Options:
    """Parse the words with tyro; a refusal becomes one sentence.

    Args:
        options: dataclass of what can be said.
        prog: the command, for messages.
        words: what follows it.
        description: the head of the help.
        names: what can be set, for the message about an option that cannot; by default the fields.
        robot: robot for which gait files are read where the words name none; the caiman if None.

    Raises:
        UnknownName: there is no such option.
        BadCommand: an option or a value makes no sense.
        SystemExit: help was asked for, and printed.
    """
    drop_notes()
    box = io.StringIO()
    names = names or [f.name for f in fields(options)]  # type: ignore[arg-type]
    settings: Any
    try:
        with redirect_stderr(box):
            settings, unknown = tyro.cli(
                options,
                prog=prog,
                description="\n".join(fill(line, _LINE_WIDTH) for line in description.splitlines()),
                args=list(words),
                registry=_registry(lambda: _robot(words) or robot or ROBOTS[_DEFAULT_ROBOT]),
                return_unknown_args=True,
            )
    except _NoWordError:
        odd = (word.partition("=")[0] for word in words if word.startswith("-"))
        unknown = [word for word in odd if word.strip("-").replace("-", "_") not in names]
        raise UnknownName("option", (unknown or ["-"])[0], [f"--{n.replace('_', '-')}" for n in names]) from None
    except SystemExit as error:
        if error.code:
            raise BadCommand(f"{_sentence(box.getvalue(), options.__name__)}; see {prog} --help.") from None
        raise
    except ValueError as error:
        raise error if isinstance(error, SuchusError) else BadCommand(f"{str(error).rstrip('.')}.") from error
    if unknown:
        if unknown[0].startswith("-"):
            raise UnknownName("option", unknown[0].partition("=")[0], [f"--{n.replace('_', '-')}" for n in names])
        raise BadCommand(f"{unknown[0]!r} is one word too many; see {prog} --help.")
    print_notes()
    return settings


def _registry(default_robot: Callable[[], Robot]) -> ConstructorRegistry:
    """Robots, gaits and policies are named on the command line, or written in a file.

    Args:
        default_robot: returns the robot for which a gait is read.
    """
    registry = ConstructorRegistry()
    robots: tuple[Any, ...] = (Robot, Robot | None)
    for kind in robots:
        registry.primitive_rule(_shelf_rule(kind, "ROBOT", "the record's", resolve_robot))
    for kind in (Policy, Policy | None):
        registry.primitive_rule(
            _shelf_rule(kind, "POLICY", "none", lambda word: policy_of(default_robot(), word), SUFFIX)
        )
    for kind in (Gait, Gait | None):
        registry.primitive_rule(_shelf_rule(kind, "GAIT", "own", lambda word: gait_of(default_robot(), word)))
    return registry


def _shelf_rule(
    kind: Any, metavar: str, default_label: str, resolve: Callable[[str], Any], suffix: str = ".toml"
) -> Callable[[PrimitiveTypeInfo], PrimitiveConstructorSpec[Any] | None]:
    """Return the rule by which tyro reads a robot or a gait from one word.

    Args:
        kind: type of the option that the rule reads.
        metavar: word that stands for the value in the help.
        default_label: how the help names the default None.
        resolve: returns what a word names.
        suffix: ending of the files that may stand in the place of a name.
    """
    spec: PrimitiveConstructorSpec[Any] = PrimitiveConstructorSpec(
        nargs=1,
        metavar=f"{metavar}|FILE{suffix}",
        instance_from_str=lambda words: _resolve_word(_first_word(words), resolve, suffix),
        is_instance=lambda value: isinstance(value, kind),
        str_from_instance=lambda value: [default_label if value is None else str(value.name)],
    )
    return lambda info: spec if info.type == kind else None


class _NoWordError(Exception):
    """Only an option that is not known stands where a name could stand."""


def _first_word(words: Any) -> str:
    """Return the first word; beside options that it does not know, tyro hands lists of lists over."""
    while not isinstance(words, str):
        if not words:
            raise _NoWordError
        words = words[0]
    return words


def _resolve_word(word: str, resolve: Callable[[str], Any], suffix: str) -> Any:
    """Return the object that a word names, by a name in the catalog or a file with an ending."""
    try:
        return resolve(word)
    except UnknownName as error:
        file_text = "TOML" if suffix == ".toml" else suffix
        raise BadCommand(f"{error} A path to a {file_text} file will do as well.") from error
    except SuchusError as error:  # some are ValueErrors, which tyro would take for its own
        raise BadCommand(str(error)) from error


def _sentence(box: str, owner: str) -> str:
    """What tyro draws as a titled box, up to its first line across, as a sentence without a stop.

    tyro offers the parts of the sentence in a module only that it calls private and may change at any time; what it
    prints is the most stable thing that it says.

    Args:
        box: what tyro wrote.
        owner: name of the options' class, which the user has never heard of.
    """
    lines: list[str] = []
    for line in re.sub(r"\x1b\[[0-9;]*m", "", box).splitlines()[1:]:
        text = line.strip(" │╰╯")
        if not set(text) <= {"─", "-"}:
            lines.append(text)
        elif lines:
            break
    sentence = " ".join(lines).removeprefix("Error parsing ").removeprefix(f"{owner}: ").rstrip(".")
    for pattern, plain in _PLAIN:
        sentence = re.sub(pattern, plain, sentence)
    return re.sub(r"^[A-Z]|\. [A-Z]", lambda start: start[0].lower().replace(".", ";"), sentence)


_PLAIN = (
    (r"invalid literal for int\(\) with base 10: (.*)", r"\1 is no whole number"),
    (r"could not convert string to float: (.*)", r"\1 is no number"),
    (r"Exceeds the limit .* value has (\d+) digits.*", r"a number of \1 digits is more than can be read"),
    (
        r"no type matching \{None\}\|(?:INT|FLOAT) could be instantiated from \[(.*)\]",
        r"\1 is no number",
    ),
    (r"no type matching .* could be instantiated from \[(.*)\]", r"\1 is not what is needed"),
)
"""Messages of Python as patterns, and the plain words that replace them."""


def gait_first(words: Sequence[str]) -> list[str]:
    """Let the gait of a command that takes it as its first word be named as an option too, as everywhere else.

    Raises:
        BadCommand: the option lacks its value.
    """
    words = list(words)
    for i, word in enumerate(words):
        if word == "--gait":
            if words[i + 1 : i + 2] == []:
                raise BadCommand("--gait lacks its value: the name of a gait, or a TOML file.")
            return [words[i + 1], *words[:i], *words[i + 2 :]]
        if word.startswith("--gait="):
            return [word.partition("=")[2], *words[:i], *words[i + 1 :]]
    return words
