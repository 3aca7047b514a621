"""What holds for every command that the package, a project folder or another package adds."""

import io
import re
import sys
from contextlib import redirect_stdout
from dataclasses import FrozenInstanceError, fields, is_dataclass

import pytest

from suchus.apps.cli import main
from suchus.apps.cli.command import UserCommand
from suchus.apps.cli.entry import reserved_names
from suchus.apps.commands import COMMANDS
from suchus.robot.design.meaning import meanings


@pytest.fixture(params=list(COMMANDS))
def name(request):
    return request.param


def printed(*words):
    """Return what a command prints that ends well."""
    with redirect_stdout(io.StringIO()) as out:
        try:
            code = main(list(words))
        except SystemExit as end:  # tyro ends so after its help
            code = end.code
    assert code in (0, None)
    return out.getvalue()


def test_it_is_a_class_of_frozen_values(name):
    command = COMMANDS[name]
    assert issubclass(command, UserCommand)
    assert is_dataclass(command)
    for field in fields(command)[:1]:
        with pytest.raises(FrozenInstanceError):
            setattr(object.__new__(command), field.name, None)


def test_it_hides_no_command_of_suchus(name):
    assert name not in reserved_names()


def test_the_help_lists_it_with_a_summary(name):
    (line,) = [line for line in printed("--help").splitlines() if re.match(rf"  {re.escape(name)} ", line)]
    if COMMANDS.sources()[name].file:  # without the file there is nothing to read without importing it
        assert re.match(rf"  {re.escape(name)} +\w.{{10,}} \[", line)


def test_its_own_help_describes_each_option(name):
    text = " ".join(printed(name, "--help").split())
    assert f"usage: suchus {name}" in text
    assert (COMMANDS[name].__doc__ or "").split(".")[0] in text
    described = meanings(COMMANDS[name])
    assert {field.name for field in fields(COMMANDS[name])} == {option for option, words in described.items() if words}


def test_an_option_that_it_has_not_is_refused_in_a_sentence(name, capsys):
    assert main([name, "--no-such-option"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("suchus: there is no option named '--no-such-option'")
    assert err.count("\n") == 1


@pytest.mark.skipif(not list(COMMANDS), reason="no command is added")
def test_the_help_imports_none_of_them():
    for name, source in COMMANDS.sources().items():
        sys.modules.pop(source.module, None)
        assert name in printed("--help")
        assert source.module not in sys.modules
