"""Commands that a project folder or another package adds to the command line, each in one file."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import is_dataclass
from inspect import cleandoc, isabstract
from pkgutil import resolve_name
from typing import Any

from suchus.core.errors import AmbiguousName, InvalidDesign, SuchusError
from suchus.core.sources import SHELVES, Source, gather

REFUSAL = "refused, since suchus itself has a command of this name"
"""What lists say of a command that would hide one of suchus."""
_MAX_EXIT_CODE = 255


class UserCommand(ABC):
    """A command of a user's own. Subclasses are frozen dataclasses; their fields are the options.

    The docstring under each field is the help text of the option, and that of the class the head of the help. The
    first line of the module's docstring is the summary in ``suchus --help``. A field of the type ``Robot`` or ``Gait``
    takes a name or a TOML file, and ``tyro.conf.Positional[...]`` makes a word of an option.
    """

    __slots__ = ()

    @abstractmethod
    def run(self) -> int | None:
        """Carry out the command and return the exit code, 0 to 255; None stands for 0.

        Raises:
            SuchusError: bad input, which the command line reports in one sentence with the exit code 2.
        """


def own_commands() -> Mapping[str, Source]:
    """Return where each command of a project folder or of another package comes from, by name; none is imported.

    Raises:
        SuchusError: the project cannot be read, or two of these commands have the same name.
    """
    return gather("command", SHELVES["commands"])


def check_single(name: str) -> None:
    """Refuse a command of suchus whose name another command has, so that none is taken for the other.

    Commands that cannot be listed hide nothing: suchus's own go on working where a project cannot be read.

    Raises:
        AmbiguousName: a project folder or another package has a command of this name.
    """
    sources: Mapping[str, Source] = {}
    with suppress(SuchusError):
        sources = own_commands()
    if name in sources:
        raise AmbiguousName("command", name, "that of suchus itself", sources[name].place)


def help_lines(reserved: Iterable[str], width: int) -> Iterator[str]:
    """Yield the lines of the help on commands of project folders and other packages; none where there are none.

    Args:
        reserved: names that no such command may have, since suchus itself has it.
        width: width of the column of names [characters].
    """
    try:
        sources = own_commands()
    except SuchusError as error:
        yield from ("", "your own commands cannot be listed:", f"  {error}")
        return
    if not sources:
        return
    title: Callable[[Source], str] = resolve_name("suchus.apps.cli.shelves:title")
    reserved_names = set(reserved)
    yield from ("", "your own commands:")
    for name, source in sources.items():
        summary = REFUSAL if name in reserved_names else title(source)
        yield f"  {name:<{width}}  {f'{summary} [{source.place}]'.lstrip()}"


def carry_out(name: str, words: Sequence[str]) -> int:
    """Carry out a command of a project folder or of another package and return the exit code.

    Args:
        name: name of the command.
        words: what follows it.

    Raises:
        UnknownName: there is no such command, or no such option.
        BrokenFile: its module cannot be loaded.
        InvalidDesign: the module declares no command that can be run.
        SuchusError: an option or a value makes no sense, or the command itself says so.
    """
    command_class: Any = resolve_name("suchus.apps.commands:COMMANDS")[name]
    class_name = command_class.__name__
    if isabstract(command_class):
        raise InvalidDesign(f"the command {name} cannot be run: {class_name} has no method run; write one.")
    if not is_dataclass(command_class):
        raise InvalidDesign(f"the command {name} has no options: {class_name} is no dataclass; decorate it as one.")
    parse: Callable[..., UserCommand] = resolve_name("suchus.apps.cli.options:parse")
    code: Any = parse(command_class, f"suchus {name}", words, cleandoc(command_class.__doc__ or "")).run()
    if code is None:
        return 0
    if not isinstance(code, int) or not 0 <= code <= _MAX_EXIT_CODE:
        raise InvalidDesign(
            f"the command {name} returned {code!r:.60}; an exit code of 0 to {_MAX_EXIT_CODE}, or None, is needed."
        )
    return int(code)
