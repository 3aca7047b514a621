"""What a command line says wrong that is known before the command's libraries are loaded, which takes seconds.

Only names in catalogs, input files and ``--out`` are looked at: the parser of each command reads all words, and
everything else is refused there.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

from suchus.apps.cli.entry import BadCommand, Subcommand
from suchus.core.errors import UnknownName
from suchus.core.reading import check_file, path_exists
from suchus.core.sources import DATA_SUFFIXES, SHELVES, Source, gather, shelf_of
from suchus.core.writing import check_replaceable, check_writable

_HELP = ("-h", "--help")


def check_words(command: Subcommand, words: Sequence[str]) -> None:
    """Refuse unknown names, missing input files and unusable output paths.

    Args:
        command: the command, which says what its words name.
        words: what follows it.

    Raises:
        BadCommand: a name or the end of an output file makes no sense.
        UnknownName: there is no such experiment.
        UnreadableFile: there is no such input file.
        Unwritable: the output cannot be written, or would replace what the user wrote.
    """
    if any(word in _HELP for word in (words[:1] if command.first_word == "experiment" else words)):
        return
    if command.first_word:
        _check_first(command, words)
    for kind in command.shelf_options:
        for name in option_values(words, f"--{kind}"):
            _check_name(kind, name)
    for output in option_values(words, "--out"):
        if command.output and output and not output.startswith("-"):
            _check_out(command.output, Path(output))


def option_values(words: Sequence[str], option: str) -> list[str]:
    """Return the values of an option among the words, before the parser reads them."""
    joined = [word.partition("=")[2] for word in words if word.startswith(f"{option}=")]
    return joined + [following for word, following in pairwise(words) if word == option]


def check_named_once(positional: Sequence[str], options: Sequence[str], words: Sequence[str]) -> None:
    """Refuse a word that names what an option names too.

    Args:
        positional: first words of a command, before its options.
        options: option that each of them stands for.
        words: all words.

    Raises:
        BadCommand: one of them is named twice.
    """
    for option, word in zip(options, positional, strict=False):
        for value in option_values(words, option):
            raise BadCommand(f"{word} and {option} {value} both name the {option.strip('-')}: give one of the two.")


def check_page(path: Path, option: str = "--out") -> None:
    """Refuse a page whose file name does not end in .html.

    Args:
        path: the page.
        option: option that names it.

    Raises:
        BadCommand: the name of its file does not end in .html.
    """
    if path.suffix.lower() not in (".html", ".htm"):
        raise BadCommand(f"the page would be {path}; say {option} FILE.html.")


def check_toml(path: Path, content: str) -> None:
    """Refuse a file for a gait or a robot whose name does not end in .toml.

    Raises:
        BadCommand: the name of the file does not end in .toml.
    """
    if path.suffix != ".toml":
        raise BadCommand(f"the {content} goes into a .toml file; --out is {str(path)!r}.")


def _check_first(command: Subcommand, words: Sequence[str]) -> None:
    """Refuse a first word that is no name in the catalog or no input file of the command."""
    word = words[0] if words else ""
    if not word or word.startswith("-"):
        if command.first_word == "experiment":
            names = ", ".join(_shelf("experiment"))
            raise BadCommand(
                f"the name of the experiment comes first, as in suchus {command.name} NAME --quick; there is {names}."
            )
        return
    if word in command.other_words:
        return
    if command.first_word == "file" or (command.first_word == "file or folder" and not Path(word).is_dir()):
        check_file(Path(word))
    elif command.first_word == "file or folder":
        return
    else:
        _check_name(command.first_word, word)


def _check_name(kind: str, name: str) -> None:
    """Refuse a name that is not in the catalog, and no file that could stand in its place."""
    shelf = _shelf(kind)
    if name in shelf or name.startswith("-"):
        return
    if shelf_of(kind) not in DATA_SUFFIXES:
        raise UnknownName(kind, name, shelf)
    suffix = DATA_SUFFIXES[shelf_of(kind)]
    if Path(name).suffix not in (suffix, ".nc") and not path_exists(Path(name)):
        file_text = "TOML" if suffix == ".toml" else suffix
        raise BadCommand(f"{UnknownName(kind, name, shelf)} A path to a {file_text} file will do as well.")


def _shelf(kind: str) -> Mapping[str, Source]:
    return gather(kind, SHELVES[shelf_of(kind)], scattered=False)


def _check_out(content: str, path: Path) -> None:
    """Refuse an output path of the wrong kind, or one that cannot be written or must not be replaced."""
    if content == "folder":
        check_writable(path)
        return
    if content == "page":
        check_page(path)
    else:
        check_toml(path, content)
    check_writable(path.parent)
    check_replaceable(path)
