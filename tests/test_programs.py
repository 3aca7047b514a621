"""Programs that are forked do what they do in an interpreter of their own."""

import os
import subprocess
import sys

import pytest

TOLD = """
import json, os, sys
suchus = [name for name in sys.modules if name.split(".")[0] == "suchus"]
print(json.dumps([sys.argv, os.getcwd(), os.environ.get("TOLD"), sorted(globals()), __name__, suchus]))
print("aside", file=sys.stderr)
"""


@pytest.fixture
def scripts(tmp_path):
    (tmp_path / "beside.py").write_text("WORD = 'beside'\n")
    (tmp_path / "told.py").write_text(f"import beside\n{TOLD}\nsys.exit(3)\n")
    return tmp_path


@pytest.mark.parametrize(
    "words", [["-c", TOLD, "x"], ["-c", TOLD + "raise SystemExit(5)"], ["told.py", "y"], ["-m", "told", "--z"]]
)
def test_a_forked_program_is_told_and_ends_as_one_alone(programs, scripts, words):
    environment = os.environ | {"TOLD": "of it"}
    forked = programs.run(words, cwd=scripts, environment=environment)
    alone = subprocess.run(
        [sys.executable, *words], cwd=scripts, env=environment, capture_output=True, text=True, check=False
    )
    assert (forked.returncode, forked.stderr) == (alone.returncode, alone.stderr)
    said, expected = (set(done.stdout.strip().split(", ")) for done in (forked, alone))
    different = {word.strip('"[]') for word in said ^ expected}
    assert {word for word in different if not word.startswith("__")} == set()  # runpy adds names like __spec__


def test_nothing_is_left_for_the_next_program(programs, tmp_path):
    leave = "import os, sys, suchus, numpy; os.environ['LEFT'] = 'x'; os.chdir('/'); numpy.LEFT = suchus.LEFT = 1"
    look = "import os, sys, numpy; print('suchus' in sys.modules, os.environ.get('LEFT'), hasattr(numpy, 'LEFT'))"
    assert programs.run(["-c", leave], cwd=tmp_path).returncode == 0
    assert programs.run(["-c", look], cwd=tmp_path).stdout == "False None False\n"


def test_a_program_that_breaks_or_is_killed_says_so_and_the_next_one_runs(programs, tmp_path):
    broken = programs.run(["-c", "print('so far'); 1 / 0"], cwd=tmp_path)
    assert (broken.returncode, broken.stdout) == (1, "so far\n")
    assert broken.stderr.endswith("ZeroDivisionError: division by zero\n")
    assert programs.run(["-c", "import os; os.kill(os.getpid(), 9)"], cwd=tmp_path).returncode == -9
    assert programs.run(["no_such_file.py"], cwd=tmp_path).returncode != 0
    assert programs.run(["-c", "print('here')"], cwd=tmp_path).stdout == "here\n"
