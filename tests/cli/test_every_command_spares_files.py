"""No command of the help page loses a file of its user's, wherever it writes.

Each command is watched once, to learn which files it makes. Then each of these places is taken by a file that suchus
did not write, and by its own that was edited since: what the user has there stays, or is kept as a backup if
``--replace`` is asked for. The list of commands and of options that name a path is read from the help.
"""

import contextlib
import io
import logging
import os
import re
import shutil
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image
from tests.cli.test_failing_writes import SEARCH, STUDY, film
from tests.model.hinge_trees import quadruped
from tests.wires import Obedient, wiring

from suchus.apps.cli import calibrate, demo, drive, main, size, train, view
from suchus.apps.cli.entry import COMMANDS
from suchus.apps.laboratory import page
from suchus.apps.laboratory.engine import Engine
from suchus.core.files import load, save
from suchus.core.writing import MANIFEST
from suchus.hardware import Rig, straight, write_map, write_wiring
from suchus.hardware.calibrate import FitEstimate
from suchus.hardware.emulator import Emulator, MemoryPort
from suchus.hardware.identification import QUANTITIES, ServoIdentification
from suchus.robot.control.policy import SUFFIX, save_policy
from suchus.robot.gaits import GAITS
from suchus.robot.policies import POLICIES
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate

SLOW = "more than ten seconds: a command is repeated with each of its places taken"
MOST = 12
"""Places that are taken one after the other; of more files these are spread over all."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A command that writes, with little to do."""

    words: tuple[str, ...]
    """What follows suchus."""
    needs: tuple[str, ...] = ()
    """Inputs, see GIVEN."""
    own: tuple[str, ...] = ()
    """Patterns of what suchus keeps to go on with; it is sealed, and what is damaged is made again."""
    doubles: Callable[[pytest.MonkeyPatch], None] = field(default=lambda patch: None)
    """Takes away what takes long and writes nothing."""
    long: bool = False
    """Whether it takes more than ten seconds of processor time."""


def short_walks(patch):
    patch.setattr(demo, "simulate", lambda runs, progress: simulate(runs, duration=5.0, timestep=0.01))


def once(module, name):
    """Return a double under which a function computes once what the same words ask for again."""

    def install(patch):
        compute, results = getattr(module, name), []

        def computed(*args, **named):
            if not results:
                results.append(compute(*args, **named))
            return deepcopy(results[0])

        patch.setattr(module, name, computed)

    return install


def blank_pictures(patch):
    """No picture is drawn: an empty one of its format is written in its place."""
    buffer = io.BytesIO()
    Image.new("RGB", (4, 4), "white").save(buffer, "png")
    blank = {"png": buffer.getvalue(), "svg": b'<svg xmlns="http://www.w3.org/2000/svg" width="4pt" height="4pt"/>'}

    def save(_, file, **settings):
        data = blank[settings["format"]]
        file.write(data.decode() if isinstance(file, io.TextIOBase) else data)

    patch.setattr(Figure, "savefig", save)


def emulated(patch):
    """Servos hang in this process, and whoever watches them is always right."""

    def rigged(robot, wiring, **_):
        return Rig(robot, wiring, [MemoryPort(Emulator(wiring, Obedient(), has_clock=True))], has_clock=True)

    patch.setattr(calibrate, "Rig", rigged)
    patch.setattr(calibrate, "find_wiring", lambda rig, clock, ask: wiring())


def no_engine(patch):
    """The page carries no engine: what counts is where it is written."""
    patch.setattr(page, "read_engine", lambda: Engine("", b""))


def trained(patch):
    """The policy of the catalog stands for one that was trained, which takes minutes."""
    policy = POLICIES["velocity"]
    judged = SimpleNamespace(speed_error=0.1, turn_error=0.1, max_speed=0.2, max_turn=0.3, falls=0, speed=[0.2])

    def conduct(training, folder, **_):
        path = save_policy(policy, folder / f"{training.name}{SUFFIX}")
        return SimpleNamespace(policy=policy, path=path, table_judgement=judged, judgement=judged)

    patch.setattr(train, "conduct", conduct)


def held(patch):
    """A log of a robot in the air shows one servo."""
    estimates = {name: FitEstimate(value=1.0, half=0.1) for name in QUANTITIES}
    shown = {"LF_yaw": ServoIdentification(**estimates, unexplained=0.1)}
    patch.setattr(calibrate, "identify_servos", lambda *_: (shown, {}))


CASES = {
    "demo": [Case(words=("demo", "--no-browser", "--out", "made/page.html"), doubles=short_walks)],
    "reproduce": [Case(words=("reproduce", "--anew", "--jobs", "1", "--out", "made"))],
    "run": [Case(words=("run", "wave", "--csv", "--out", "made"))],
    "compare": [Case(words=("compare", "one/wave", "one/wave", "--out", "made/it.html"), needs=("one",))],
    "capture": [
        Case(words=("capture", "walk.csv", "--out", "made/walk.toml", "--tables", "made/tables"), needs=("walk.csv",)),
        Case(words=("capture", "walk.csv", "--forces", "made/forces"), needs=("walk.csv",), long=True),
        Case(words=("capture", "walk.gif", "--digitise", "made/points.html"), needs=("walk.gif",)),
    ],
    "view": [],
    "page": [Case(words=("page", "strider", "--out", "made/it.html"), doubles=no_engine)],
    "replay": [
        Case(words=("replay", "walk.nc", "--out", "made/it.html"), needs=("walk.nc",)),
        Case(words=("replay", "walk.nc", "--video", "made/it.webp"), needs=("walk.nc",)),
    ],
    "lessons": [Case(words=("lessons", "--out", "made"), long=True)],
    "study": [
        Case(
            words=("study", "grip.toml", "--csv", "--out", "made"),
            needs=("grip.toml",),
            own=("parts/*", "study.json", ".*"),
        )
    ],
    "optimise": [
        Case(
            words=("optimise", "small.toml", "--out", "made"),
            needs=("small.toml",),
            own=("parts/*", "search.json", "study.json", "*/parts/*", ".*"),
        )
    ],
    "train": [Case(words=("train", "velocity", "--out", "made"), doubles=trained)],
    "import": [Case(words=("import", "it.urdf", "--out", "made/it.toml"), needs=("it.urdf",))],
    "export": [
        Case(words=("export", "--format", "urdf", "--out", "made/it")),
        Case(words=("export", "--format", "mjcf", "--out", "made/it")),
    ],
    "size": [
        Case(
            words=("size", "caiman", "belly_crawl", "--family", "Feetech STS 12 V", "--out", "made"),
            doubles=once(size, "size"),
        )
    ],
    "parts": [Case(words=("parts", "strider", "--out", "made"))],
    "export-commands": [
        Case(words=("export-commands", "limbs_only", "--out", "made")),
        Case(words=("export-commands", "--write-map", "made/map.toml")),
    ],
    "emulate": [
        Case(
            words=("emulate", "caiman", "--seconds", "0.05", "--hardware", "made/new.toml", "--out", "made/truth.nc"),
        )
    ],
    "drive": [
        Case(
            words=(
                "drive", "belly_crawl", "--dry-run", "--seconds", "0.3", "--hardware", "hardware.toml", "--out", "made"
            ),
            needs=("hardware.toml",),
            doubles=once(drive, "drive"),
        ),
        Case(
            words=("drive", "belly_crawl", "--dry-run", "--seconds", "0.3", "--map", "map.toml", "--out", "made"),
            needs=("map.toml",),
            doubles=once(drive, "drive"),
        ),
    ],
    "calibrate": [
        Case(words=("calibrate", "log", "driven/record.nc", "--out", "made/servos.csv"), needs=("driven",)),
        Case(
            words=(
                "calibrate", "log", "driven/record.nc", "--held", "--out", "made/servos.csv", "--json", "made/json",
            ),
            needs=("driven",),
            doubles=held,
        ),
        Case(
            words=("calibrate", "zero", "--hardware", "hardware.toml", "--out", "made/zeroed.toml"),
            needs=("hardware.toml",),
            doubles=emulated,
        ),
        Case(
            words=("calibrate", "wiring", "--hardware", "hardware.toml", "--clock", "bus", "--out", "made/wired.toml"),
            needs=("hardware.toml",),
            doubles=emulated,
        ),
    ],
    "doctor": [],
    "list": [],
}  # fmt: skip
"""Of each command, cases that go through all options that name a place to write to; none if it writes nothing."""

READS = {
    "capture": {"--video"},
    "view": {"--ghost", "--animal"},
    "import": {"--packages"},
    "size": {"--motors"},
    "parts": {"--motors"},
    "drive": {"--hardware", "--map"},
    "calibrate": {"--hardware"},
    "export-commands": {"--map"},
}
"""Options that name what is read."""
HELPS = {"run": [("run", "displacement")], "view": [("view",), ("view", "swim", "it.nc"), ("view", "it.nc")]}
"""Of commands whose options depend on further words: these."""
FAKED = ("run", "reproduce", "compare")
"""Commands for which only the fake experiment stands on the shelf."""
NOTHING = {"view": ("view", "strider"), "doctor": ("doctor",), "list": ("list",)}
"""Commands that write nothing, and how they are begun."""


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """What commands read, made once."""
    place = tmp_path_factory.mktemp("inputs")
    (place / "it.urdf").write_text(quadruped())
    (place / "grip.toml").write_text(STUDY)
    (place / "small.toml").write_text(SEARCH)
    write_wiring(wiring(), place / "hardware.toml")
    write_map(straight(ROBOTS["caiman"]), place / "map.toml")
    return place


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder of a user's."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    blank_pictures(monkeypatch)
    return tmp_path


def give(name, inputs, desk):
    """Put an input into the folder; what takes long to make is made once."""
    kept = inputs / name
    if not kept.exists():
        if name == "walk.csv":
            kept.write_text(film())
        elif name == "walk.gif":
            shots = [Image.new("L", (8, 8), shade) for shade in (0, 255)]
            shots[0].save(kept, save_all=True, append_images=shots[1:], duration=40)
        elif name == "walk.nc":
            run = Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"])
            save(simulate([run], duration=1.0, timestep=0.01), kept)
        elif name == "one":
            assert main(["run", "wave", "--out", str(kept)]) == 0
        elif name == "driven":
            hardware = str(inputs / "hardware.toml")
            words = ["drive", "belly_crawl", "--dry-run", "--seconds", "1", "--hardware", hardware, "--out", str(kept)]
            assert main(words) == 0
    (shutil.copytree if kept.is_dir() else shutil.copy)(kept, desk / name)


def files(place):
    """All that a user finds in a folder and below, by name."""
    found = [Path(folder, name) for folder, _, names in os.walk(place) for name in names if name != MANIFEST]
    return {file: file.read_bytes() for file in found}


def told(words):
    """Carry a command out, and return its exit code and what it says of itself; nothing half-written may stay."""
    err, logger = io.StringIO(), logging.getLogger("suchus")
    handler = logging.StreamHandler(err)
    logger.addHandler(handler)
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(err):
            code = main(list(words))
    finally:
        logger.removeHandler(handler)
    said = [line for line in err.getvalue().splitlines() if line.startswith("suchus: ")]
    assert code in (0, 2), err.getvalue()
    assert code == 0 or said, err.getvalue()
    left = [one for one in Path().rglob(".*-*") if one.name != MANIFEST]
    assert not left, f"{words} left {left}"
    return code, "\n".join(said)


def spread(places):
    """Some of many places, spread over all."""
    step = max(len(places) / MOST, 1.0)
    return [places[int(i * step)] for i in range(int(len(places) / step))]


def spared(case, desk):
    """Take the places that a command writes to, one after the other and all together; return how many they are."""
    before = files(desk)
    code, said = told(case.words)
    assert code == 0, said
    made = desk / "made"
    after = files(desk)
    assert before.items() <= after.items(), "an input was changed"
    own = {file for pattern in case.own for file in made.glob(pattern)}
    places = sorted(after.keys() - before.keys() - own)
    assert places
    assert all(place.is_relative_to(made) for place in places), "a file where nobody asked for one"
    refused = []
    for place in spread(places):
        whole = place.read_bytes()
        place.write_bytes(whole + b"\nmine")
        code, said = told(case.words)
        assert place.read_bytes() == whole + b"\nmine", place
        refused += [said] * code
        place.write_bytes(whole)
    assert any("changed since suchus wrote it" in said and "--replace" in said for said in refused)
    _notes_stay(case, made)
    _are_backed_up(case, desk, places)
    for place in spread(places):
        shutil.rmtree(made)
        for one in (_as_file, _as_link, _as_folder):
            _stays(case, desk, place, one)
    shutil.rmtree(made)
    for number, place in enumerate(places):
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(f"mine {number}")
    code, said = told([*case.words, "--replace"])
    contents = set(files(desk).values())
    assert all(f"mine {number}".encode() in contents for number in range(len(places)))
    assert code == 2 or "is kept as" in said
    return len(places)


def _notes_stay(case, made):
    """Notes in every folder that a command makes stay when it is carried out again."""
    notes = [Path(folder) / "notes.md" for folder, _, _ in os.walk(made) if Path(folder) != made]
    for note in notes:
        note.write_text(f"mine, in {note.parent.name}")
    code, said = told(case.words)
    assert code == 0, said
    assert all(note.read_text() == f"mine, in {note.parent.name}" for note in notes)


def _are_backed_up(case, desk, places):
    """With --replace all that was edited is kept beside what takes its place."""
    edited = [place.read_bytes() + f"\nedited {number}".encode() for number, place in enumerate(places)]
    for place, data in zip(places, edited, strict=True):
        place.write_bytes(data)
    code, said = told([*case.words, "--replace"])
    assert set(edited) <= set(files(desk).values())
    assert code == 2 or "is kept as" in said


def _as_file(place, _):
    place.write_text("mine")
    return place


def _as_link(place, desk):
    place.symlink_to(desk / "elsewhere.txt")
    return desk / "elsewhere.txt"


def _as_folder(place, _):
    place.mkdir()
    return place / "letter.txt"


def _stays(case, desk, place, taken):
    """What a user has at a place is there afterwards, whatever else is."""
    shutil.rmtree(desk / "made", ignore_errors=True)
    place.parent.mkdir(parents=True, exist_ok=True)
    file = taken(place, desk)
    file.write_text("mine")
    before = files(desk)
    code, said = told(case.words)
    assert code == 0 or files(desk) == before, f"{said} All the same something was written."
    assert file.read_text() == "mine", (place, taken.__name__)
    assert place.is_symlink() == (taken is _as_link), (place, taken.__name__)


def of(case):
    return pytest.param(case, id=" ".join(case.words[:2]), marks=pytest.mark.slow(SLOW) if case.long else ())


@pytest.mark.parametrize("case", [of(case) for cases in CASES.values() for case in cases])
def test_what_a_user_has_where_a_command_writes_stays(case, desk, inputs, monkeypatch, request):
    if case.words[0] in FAKED:
        request.getfixturevalue("fakes")
    for name in case.needs:
        give(name, inputs, desk)
    case.doubles(monkeypatch)
    assert spared(case, desk) > 0


@pytest.mark.parametrize("name", ["doctor", "list", "view"])
def test_what_writes_nothing_changes_nothing(name, desk, monkeypatch):
    monkeypatch.setattr(view, "_serve", lambda *_, **__: 0)
    for file in ("out", "notes.md", "hardware.toml", "suchus_demo.html"):
        (desk / file).write_text("mine")
    before = files(desk)
    assert told(NOTHING[name])[0] == 0
    assert files(desk) == before


def test_every_command_of_the_help_and_every_option_that_names_a_path_has_a_case(desk, capsys):
    with contextlib.suppress(SystemExit):
        main(["--help"])
    named = re.findall(r"^  ([a-z][\w-]*) .*  \S", capsys.readouterr().out.partition("\nexamples:")[0], re.M)
    assert named == [command.name for command in COMMANDS] == list(CASES)
    assert {name for name, cases in CASES.items() if not cases} == set(NOTHING)
    for name, cases in CASES.items():
        words = {word for case in cases for word in case.words}
        asked = set()
        for line in HELPS.get(name, [(name,)]):
            with contextlib.suppress(SystemExit):
                main([*line, "--help"])
            asked |= set(re.findall(r"(--[\w-]+) (?:\{None\}\|)?(?:PATH|FOLDER)", capsys.readouterr().out))
        assert asked <= words | READS.get(name, set()), name
        assert asked or not cases, name


def test_the_log_of_a_stopped_drive_finds_a_free_place(desk):
    log = xr.Dataset({"x": ("time", [1.0])}, {"time": [0.0]})
    for name in ("driven", "driven_stopped1"):
        (desk / name).mkdir()
        (desk / name / "record.nc").write_text("mine")
    drive._SavedLog(desk / "driven").save(log)
    drive._SavedLog(desk / "new").save(log)
    assert load(desk / "driven_stopped2" / "record.nc").x.item() == load(desk / "new" / "record.nc").x.item() == 1.0
    assert (desk / "driven" / "record.nc").read_text() == (desk / "driven_stopped1" / "record.nc").read_text() == "mine"


def test_what_truly_happened_has_a_place_before_the_emulator_begins(desk, capsys):
    (desk / "truth.nc").write_text("mine")
    assert main(["emulate", "caiman", "--out", "truth.nc"]) == 2  # and does not serve for an hour first
    assert "truth.nc exists" in capsys.readouterr().err
    assert (desk / "truth.nc").read_text() == "mine"
    assert not (desk / "hardware.toml").exists()
