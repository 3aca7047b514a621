"""Commands of a project folder and of other packages: found, run, refused, and no burden for anything else."""

import os
import re
import subprocess
import sys

import pytest

from suchus.apps.cli import main
from suchus.core import sources

GREET = '''"""Greet a robot."""

from dataclasses import dataclass

from suchus.apps.cli.command import UserCommand
from suchus.core.errors import InvalidDesign


@dataclass(frozen=True, slots=True, kw_only=True)
class Greet(UserCommand):
    """Greet a robot by its name."""

    name: str = "caiman"
    """Name that is called."""
    times: int = 1
    """How often [-]."""

    def run(self):
        if self.times < 1:
            raise InvalidDesign(f"times is {self.times}; 1 at least is needed.")
        print(" ".join([f"hello {self.name}"] * self.times))
        return RETURNED


command = Greet
'''


@pytest.fixture
def lab(tmp_path, monkeypatch):
    """A project with the command ``greet``; it is the working folder."""
    monkeypatch.setenv(sources.VARIABLE, str(tmp_path))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "commands").mkdir()
    write(tmp_path, "greet", GREET.replace("RETURNED", "None"))
    yield tmp_path
    for module in [module for module in sys.modules if module.startswith("suchus.apps.commands.")]:
        del sys.modules[module]


def write(folder, name, text):
    """Write a command into the project, to be read anew."""
    (folder / f"commands/{name}.py").write_text(text)
    sys.modules.pop(f"suchus.apps.commands.{name}", None)


def sentence(capsys):
    """Return what was printed: one line on standard error."""
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


def test_it_runs_with_its_options(lab, capsys):
    assert main(["greet"]) == 0
    assert main(["greet", "--name", "strider", "--times", "2"]) == 0
    assert capsys.readouterr().out == "hello caiman\nhello strider hello strider\n"


@pytest.mark.parametrize(("returned", "code"), [("0", 0), ("None", 0), ("1", 1), ("255", 255), ("False", 0)])
def test_what_it_returns_is_the_exit_code(lab, returned, code):
    write(lab, "greet", GREET.replace("RETURNED", returned))
    assert main(["greet"]) == code


@pytest.mark.parametrize("returned", ["'done'", "256", "-1", "0.5"])
def test_what_is_no_exit_code_is_named(lab, capsys, returned):
    write(lab, "greet", GREET.replace("RETURNED", returned))
    assert main(["greet"]) == 2
    assert f"the command greet returned {returned}; an exit code of 0 to 255" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("greet --times 0", "times is 0; 1 at least is needed."),
        ("greet --times many", "--times: 'many' is no whole number; see suchus greet --help."),
        ("greet --nam x", "there is no option named '--nam'; there is --name, --times. Did you mean '--name'?"),
        ("greet you", "'you' is one word too many; see suchus greet --help."),
    ],
)
def test_bad_words_get_a_sentence(lab, capsys, words, told):
    assert main(words.split()) == 2
    assert sentence(capsys) == f"suchus: {told}\n"


def test_a_mistyped_name_is_suggested(lab, capsys):
    assert main(["gret"]) == 2
    assert "Did you mean 'greet'?" in sentence(capsys)
    assert main(["doctr"]) == 2
    assert "Did you mean 'doctor'?" in sentence(capsys)


def test_the_help_lists_it_and_imports_nothing(lab, capsys):
    write(lab, "loud", '"""Leave a trace."""\nopen("trace", "w").close()\n')
    assert main(["--help"]) == 0
    out = capsys.readouterr().out
    assert re.search(
        r"\nyour own commands:\n  greet +Greet a robot. \[commands/greet.py\]\n  loud +Leave a trace. ", out
    )
    assert not (lab / "trace").exists()
    assert main(["list", "--help"]) == 0
    assert not (lab / "trace").exists()
    assert main(["loud"]) == 2
    assert (lab / "trace").exists()


def test_without_any_the_help_has_no_such_part(lab, capsys, monkeypatch):
    monkeypatch.setenv(sources.VARIABLE, "")
    assert main(["--help"]) == 0
    assert "your own commands" not in capsys.readouterr().out
    assert main(["greet"]) == 2
    assert "there is no command named 'greet'" in sentence(capsys)


def test_the_list_shows_each_and_what_is_wrong_with_it(lab, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "110")
    write(lab, "torn", "def (\n")
    write(lab, "bare", "command = 3\n")
    write(lab, "list_of_robots", GREET.replace("RETURNED", "0"))
    write(lab, "view", GREET.replace("RETURNED", "0"))
    assert main(["list"]) == 0
    listed = " ".join(capsys.readouterr().out.partition("\ncommands\n")[2].split())
    assert "greet Greet a robot. [commands/greet.py]" in listed
    assert "list_of_robots Greet a robot. [commands/list_of_robots.py]" in listed
    assert "[broken: commands/torn.py, line 1, cannot be loaded: SyntaxError: invalid syntax.]" in listed
    assert "[broken: commands/bare.py must declare `command`, a subclass of UserCommand, but declares a int" in listed
    assert "[refused, since suchus itself has a command of this name: commands/view.py]" in listed


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("def (\n", "commands/torn.py, line 1, cannot be loaded: SyntaxError: invalid syntax."),
        ("\nimport no_such_library\n", "commands/torn.py, line 2, cannot be loaded: ModuleNotFoundError: No module"),
        ('"""Exit."""\nraise SystemExit(3)\n', "commands/torn.py, line 2, cannot be loaded: SystemExit: 3."),
        ("", "commands/torn.py must declare `command`, a subclass of UserCommand, but declares nothing"),
        (GREET.replace("def run(", "def walk("), "the command torn cannot be run: Greet has no method run; write one."),
        (GREET.replace("@dataclass(frozen=True, slots=True, kw_only=True)\n", ""), "Greet is no dataclass"),
    ],
)
def test_one_that_cannot_be_used_gets_a_sentence_and_harms_no_other(lab, capsys, text, told):
    write(lab, "torn", text)
    assert main(["torn"]) == 2
    assert told in sentence(capsys)
    assert main(["greet"]) == 0
    assert main(["--help"]) == 0
    assert "hello caiman" in capsys.readouterr().out


def test_one_that_would_hide_a_command_of_suchus_is_refused(lab, capsys):
    write(lab, "doctor", GREET.replace("RETURNED", "0"))
    write(lab, "help", GREET.replace("RETURNED", "0"))
    assert main(["doctor"]) == 2
    assert sentence(capsys) == (
        "suchus: there are two commands named 'doctor': that of suchus itself and commands/doctor.py; "
        "give one of them another name.\n"
    )
    assert main(["--help"]) == main(["help"]) == main(["greet"]) == 0
    out = capsys.readouterr().out
    for name in ("doctor", "help"):
        assert re.search(
            rf"  {name} +refused, since suchus itself has a command of this name \[commands/{name}.py\]", out
        )
    assert "hello caiman" in out


def test_a_project_that_cannot_be_read_stops_neither_the_help_nor_what_needs_no_project(lab, capsys, monkeypatch):
    monkeypatch.delenv(sources.VARIABLE)
    (lab / "suchus.toml").write_text("command = []\n")
    assert main(["--help"]) == 0
    assert "your own commands cannot be listed:\n  " in capsys.readouterr().out
    assert main(["doctor", "--help"]) == 0
    assert main(["greet"]) == 2
    assert "Did you mean 'commands'?" in capsys.readouterr().err


def test_the_settings_may_name_its_file(lab, capsys):
    (lab / "commands/greet.py").rename(lab / "greeting.py")
    (lab / "suchus.toml").write_text('commands = ["greeting.py"]\n')
    assert main(["greeting"]) == 0
    assert capsys.readouterr().out == "hello caiman\n"


def test_programs_of_the_evidence_have_no_commands_of_a_project(lab, capsys):
    assert main(["greet"], ()) == 2
    assert "there is no command named 'greet'" in capsys.readouterr().err


def test_a_study_goes_on_when_a_command_of_its_project_has_changed(lab):
    digest = sources.current().digest()
    write(lab, "greet", GREET.replace("RETURNED", "1"))
    assert sources.current().digest() == digest
    (lab / "gaits").mkdir()
    (lab / "gaits/slow.toml").write_text('base = "belly_crawl"\nperiod = 6.0\n')
    assert sources.current().digest() != digest


def installed(folder, *, metadata="my_lab-1.0.dist-info", group="suchus.commands"):
    """Install a package with the commands ``greet``, ``gone``, whose module is missing, and ``doctor``."""
    (folder / metadata).mkdir(parents=True)
    (folder / "my_lab.py").write_text(GREET.replace("RETURNED", "0"))
    (folder / metadata / ("PKG-INFO" if metadata.endswith(".egg-info") else "METADATA")).write_text(
        "Metadata-Version: 2.1\nName: my-lab\nVersion: 1.0\n"
    )
    (folder / metadata / "entry_points.txt").write_text(
        f"[console_scripts]\nx = y:z\n\n[{group}]\n"
        "greet = my_lab:Greet\ngone = my_lab.gone:Gone\ndoctor = my_lab:Greet\n"
    )
    return folder


def told(site, *words):
    """Return exit code, output and errors of a command in a process that finds packages in ``site`` too."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])}
    code = f"import sys; from suchus.apps.cli import main; sys.exit(main({list(words)!r}))"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("metadata", ["my_lab-1.0.dist-info", "my_lab.egg-info"])
def test_a_package_adds_commands_by_entry_points(tmp_path, metadata):
    site = installed(tmp_path / "site", metadata=metadata)
    assert told(site, "greet", "--name", "strider") == (0, "hello strider\n", "")
    code, _, err = told(site, "gone")
    assert code == 2
    assert err.startswith(
        "suchus: the entry point gone = 'my_lab.gone:Gone' of my-lab cannot be loaded: ModuleNotFound"
    )
    assert told(site, "doctor") == (
        2, "", "suchus: there are two commands named 'doctor': that of suchus itself and the entry point doctor = "
        "'my_lab:Greet' of my-lab; give one of them another name.\n",
    )  # fmt: skip
    code, out, err = told(site, "--help")
    assert (code, err) == (0, "")
    assert re.search(r"\n  greet +\[the entry point greet = 'my_lab:Greet' of my-lab\]\n", out)


def test_the_reader_of_entry_points_is_only_loaded_where_a_package_has_some(tmp_path):
    code = "import sys; from suchus.apps.cli import main; main(['--help']); print('importlib.metadata' in sys.modules)"
    for site, loaded in (
        (tmp_path / "none", "False"),
        (installed(tmp_path / "others", group="other.commands"), "False"),
        (installed(tmp_path / "ours"), "True"),
    ):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])}
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        assert done.stdout.splitlines()[-1] == loaded
