"""The commands: one line each. What a command needs is imported when it is called."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pkgutil import resolve_name

from suchus.errors import SuchusError

PROJECT = "--project"
"""Option of every command: the project folder, see ``suchus.sources``."""


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

    def __call__(self, words: Sequence[str]) -> int:
        """Carry the command out and return the exit code."""
        function: Callable[[Sequence[str]], int] = resolve_name(self.function)
        return function(words)


COMMANDS = (
    Subcommand("demo", "[--no-browser] [--out FILE.html]", "see a first walk", "suchus.cli.demo:demo"),
    Subcommand(
        "reproduce",
        "[--out DIR] [--jobs N]",
        "run every experiment and write the report",
        "suchus.cli.reproduce:reproduce",
    ),
    Subcommand("run", "NAME [--FIELD VALUE ...]", "run one experiment", "suchus.cli.run:run"),
    Subcommand(
        "compare", "A B [--out FILE.html]", "set two outcomes side by side", "suchus.cli.compare:compare_outcomes"
    ),
    Subcommand(
        "capture",
        "TRACKS [--out FILE.toml]",
        "read a gait from tracked keypoints",
        "suchus.cli.capture:capture",
    ),
    Subcommand(
        "view",
        "[ROBOT] [GAIT] | RECORD.nc",
        "see it walk in the browser, live or played back",
        "suchus.cli.view:view",
    ),
    Subcommand(
        "replay",
        "RECORD.nc [--out FILE.html]",
        "make a page of a stored run that plays offline",
        "suchus.cli.replay:make_replay",
    ),
    Subcommand("study", "claims|FILE.toml [--out DIR]", "run many variants, resumable", "suchus.cli.study:study"),
    Subcommand(
        "optimise",
        "crawl|FILE.toml [--out DIR]",
        "search for a better gait or body, resumable",
        "suchus.cli.optimise:optimise",
    ),
    Subcommand(
        "import",
        "ROBOT.urdf|ROBOT.xml [--out FILE.toml]",
        "read a robot from a URDF or an MJCF",
        "suchus.cli.import_robot:import_file",
    ),
    Subcommand(
        "export",
        "[--format mjcf|urdf|usd] [--robot ROBOT]",
        "write a robot for other tools",
        "suchus.cli.export:export_robot",
    ),
    Subcommand(
        "export-commands",
        "GAIT [--map FILE.toml]",
        "write a gait as timed servo angles",
        "suchus.cli.export_commands:export_commands",
    ),
    Subcommand(
        "flow-atlas",
        "[ROW ...] [--out DIR] [--jobs N | --scheduler ADDRESS]",
        "compute published flows and draw ours beside theirs",
        "suchus.cli.flow_atlas:flow_atlas",
    ),
    Subcommand("doctor", "", "say whether suchus can run here, and what is missing", "suchus.cli.doctor:doctor"),
    Subcommand(
        "list", "", "show what stands on the shelves: robots, gaits, faults and so on", "suchus.cli.shelves:show"
    ),
)
"""Every command, in the order of the help."""
