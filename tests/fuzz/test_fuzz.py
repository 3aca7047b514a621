"""The fuzzer; see docs/reliability.md.

``hostile.py`` and ``doors.py`` hold the cases, ``farm.py`` runs each in a process, ``long_form.py`` runs all of them.
"""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import long_form
import pytest
from doors import WEIGHTS
from farm import Came
from hostile import KINDS, Hang, Range
from long_form import COUNT, OUTCOME, PAGE, again, passage, renewed, run

SHORT, SAMPLE = 2_000, 1_000
"""Numbers of the cases of the short form, which run in this process, and of the sample of the long one."""
FARM = Path(__file__).with_name("farm.py")


@pytest.fixture(scope="session")
def place(tmp_path_factory):
    return Range(tmp_path_factory.mktemp("fuzz"))


@pytest.mark.parametrize("part", range(8))
def test_two_thousand_hostile_cases_end_in_a_result_or_a_sentence(place, part):
    for number in range(part, SHORT, 8):
        try:
            place.case(number)
        except BaseException as error:
            error.add_note(f"case {number}: {KINDS[number % len(KINDS)].__name__}")
            raise


def test_what_waits_is_a_hang_and_what_the_code_raises_passes(place, monkeypatch):
    def waits(place, dice):
        time.sleep(60.0)

    def breaks(place, dice):
        raise IndexError("a bare one")

    def works(place, dice):
        while True:
            pass

    monkeypatch.setattr("hostile.PATIENCE", 0.2)
    monkeypatch.setattr("hostile._LOOK", 0.1)
    monkeypatch.setattr("hostile.KINDS", (waits, breaks, works))
    with pytest.raises(Hang, match="waits"):
        place.case(0)
    with pytest.raises(IndexError, match="bare"):
        place.case(1)
    monkeypatch.setattr("hostile._idle", lambda: 0.0)  # a host may take the processor away from this machine
    with pytest.raises(Hang, match="of a processor"):
        place.case(2)


def test_what_other_threads_compute_is_no_hang(place, monkeypatch):
    monkeypatch.setattr("hostile.PATIENCE", 1.0)
    place.idle, place.ran = time.monotonic(), time.thread_time()
    place._alarm(signal.SIGPROF, None)  # the clock of the whole process is over, this thread's is not
    place.ran -= 1.1
    with pytest.raises(Hang, match="of a processor"):
        place._alarm(signal.SIGPROF, None)


@pytest.mark.slow("more than ten seconds: a thousand cases of the long form")
def test_a_sample_of_the_farm_ends_in_results_and_sentences():
    words = [sys.executable, str(FARM), f"0-{SAMPLE - 1}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    assert int(done.stdout.split()[-4]) > SAMPLE  # some numbers stand for a batch


DEADLY = """
import os, signal, sys, time
sys.path[:0] = [sys.argv[1]]
import farm
farm.BATCH, farm.STUCK, farm.WAITS, farm.MEMORY = 4, 1.0, 30.0, 2**28

def sound(): return 3
def refused(): return 0
def breaks(): raise IndexError("a bare one")
def dies(): os.kill(os.getpid(), signal.SIGSEGV)
def eats(): return len(bytearray(2**30))
def spins():
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    while True: pass
def waits(): time.sleep(60)
def leaves(): os._exit(7)

class Place:
    def carry_out(self, kind, number): return kind()

kinds = [sound, dies, refused, eats, breaks, spins, waits, sound, leaves, sound]
farm.kind_of = lambda number: kinds[number]
for came in farm.carried_out(Place(), range(len(kinds))):
    print(came.number, came.kind, came.count, int(came.refused), came.error, sep="|")
"""


@pytest.mark.slow("processes die in every way")
def test_what_kills_a_case_kills_no_other_one_and_is_named():
    words = [sys.executable, "-c", DEADLY, str(FARM.parent)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=300)
    came = [line.split("|") for line in done.stdout.splitlines()]
    assert [line[1] for line in came] == [
        "sound", "dies", "refused", "eats", "breaks", "spins", "waits", "sound", "leaves", "sound"
    ], done.stderr  # fmt: skip
    assert [line[0] for line in came] == [str(number) for number in range(10)]
    counts = [line[2:4] for line in came if line[1] in ("sound", "refused")]
    assert counts == [["3", "0"], ["1", "1"], ["3", "0"], ["3", "0"]]
    said = {line[1]: line[4] for line in came}
    assert said["sound"] == said["refused"] == ""
    assert "SIGSEGV" in said["dies"]
    assert "MemoryError" in said["eats"]
    assert said["breaks"] == "IndexError: a bare one"
    assert "SIGXCPU" in said["spins"]
    assert "SIGKILL" in said["waits"]
    assert said["leaves"] == "the process ended with 7"


def test_the_page_says_what_the_long_form_found():
    found = json.loads(OUTCOME.read_text())
    assert passage(found) in PAGE.read_text()
    assert found["cases"] == sum(found["kinds"].values())
    assert found["asked"] == COUNT
    assert set(found["kinds"]) == {kind.__name__ for kind in (*KINDS, *WEIGHTS)}
    assert all(0 <= found["refused"][kind] <= count for kind, count in found["kinds"].items())
    assert f"**{len(found['failures'])}** of them failed" in PAGE.read_text()


def test_the_long_form_goes_on_where_it_stopped_but_not_on_other_code(tmp_path, monkeypatch):
    numbers = []

    def carried_out(place, asked):
        for number in asked:
            numbers.append(number)
            if number == 4 and len(numbers) == 5:
                raise KeyboardInterrupt
            error = "IndexError: a bare one" if number == 2 else ""
            yield Came(number, 2 if number == 3 else 1, number == 1, "walks", 0.1, error)

    monkeypatch.setattr(long_form, "carried_out", carried_out)
    monkeypatch.setattr(long_form, "Doors", lambda place: None)
    for name in ("OUTCOME", "PROGRESS", "PAGE"):
        monkeypatch.setattr(long_form, name, tmp_path / name)
    long_form.PAGE.write_text(PAGE.read_text())
    long_form.OUTCOME.write_text('{"cases": 6}')
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, 7, keep=True)
    first = long_form.kept()
    assert (first["cases"], first["next"], [one["case"] for one in first["failures"]]) == (5, 4, [2])
    assert long_form.PAGE.read_text() == PAGE.read_text()  # which tells of more cases
    found = run(tmp_path, 7, keep=True, so_far=first)
    assert numbers == [0, 1, 2, 3, 4, 4, 5, 6]
    assert (found["cases"], found["kinds"], found["refused"]) == (7, {"walks": 7}, {"walks": 1})
    assert found["failures"] == first["failures"]
    assert json.loads(long_form.OUTCOME.read_text()) == found
    assert "Of the long form 7 of the 100 000 cases" in long_form.PAGE.read_text()
    assert "6 of them got through the door" in long_form.PAGE.read_text()
    monkeypatch.setattr(long_form, "code_digest", lambda room: "other")
    assert long_form.kept() is None


def test_what_was_mended_is_run_again_and_told(tmp_path, monkeypatch):
    monkeypatch.setattr(long_form, "Doors", lambda place: None)
    errors = {3: "", 5: "IndexError: still"}
    monkeypatch.setattr(
        long_form, "carried_out", lambda place, asked: [Came(n, 1, False, "x", 0.1, errors[n]) for n in asked]
    )
    failed = [{"case": n, "kind": long_form.kind_of(n).__name__, "error": "IndexError: was"} for n in errors]
    found = again(tmp_path, {**json.loads(OUTCOME.read_text()), "failures": failed, "mended": []})
    assert [one["case"] for one in found["mended"]] == [3]
    assert [(one["case"], one["error"]) for one in found["failures"]] == [(5, "IndexError: still")]
    assert "**1** of them failed. 1 more had failed, were mended" in passage(found)
    assert f"case 3 ({failed[0]['kind'].replace('_', ' ')})" in passage(found)
    with pytest.raises(ValueError, match="are others"):
        again(tmp_path, {**found, "failures": [{"case": 3, "kind": "another", "error": ""}]})


def test_a_kind_that_became_another_is_run_again_and_told(tmp_path, monkeypatch):
    asked = []

    def carried_out(place, numbers):
        asked.extend(numbers)
        return [Came(n, 1, n == numbers[0], "studies", 0.5, "IndexError: new" * (n == numbers[1])) for n in numbers]

    monkeypatch.setattr(long_form, "Doors", lambda place: None)
    monkeypatch.setattr(long_form, "carried_out", carried_out)
    before = {**json.loads(OUTCOME.read_text()), "failures": [{"case": 1, "kind": "studies", "error": "old"}]}
    found = renewed(tmp_path, before, "studies")
    assert {long_form.kind_of(number).__name__ for number in asked} == {"studies"}
    assert max(asked) < before["next"]
    assert (found["kinds"]["studies"], found["refused"]["studies"]) == (len(asked), 1)
    others = {kind: count for kind, count in before["kinds"].items() if kind != "studies"}
    assert found["cases"] == sum(others.values()) + len(asked)
    assert [(one["case"], one["error"]) for one in found["failures"]] == [(asked[1], "IndexError: new")]
    assert "Those of the kind studies ran again on " in passage(found)


@pytest.mark.validate
def test_a_hundred_thousand_cases():
    words = [sys.executable, str(FARM.with_name("long_form.py")), os.environ.get("SUCHUS_FUZZ", str(COUNT))]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
