"""Hostile cases: byte flips and made-up values over every file format, every command and the public functions.

A case is a number. The same number is the same case, so that one that failed can be run again by itself. Each case
must end in a result or in a ``SuchusError`` with one short sentence, soon, and must not turn numbers into NaN.
"""

import contextlib
import inspect
import io
import json
import math
import shutil
import signal
import time
import warnings
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from random import Random
from typing import Any

import jaxtyping
import numpy as np
import xarray as xr

import suchus
from suchus import flow
from suchus.animals.capture import observe, read_tracks
from suchus.animals.capture.tracks import GAIT_KEYPOINTS
from suchus.apps.cli import main
from suchus.apps.cli.entry import COMMANDS
from suchus.apps.report import load_result, render_page
from suchus.apps.viewer.replay import Player, takes
from suchus.apps.viewer.swim import films
from suchus.core.errors import OutsideLimits, SuchusError
from suchus.core.files import load, save
from suchus.core.jobs.store import Store
from suchus.experiments.optimise import read_optimisation
from suchus.experiments.study import MEASURES, Arm, Plan, Study, Vary, conduct, conducted, read_study
from suchus.hardware import read_map, straight, write_map
from suchus.robot import blueprint, kinematics
from suchus.robot.design import Robot, layout, servo_names, value_at, with_values
from suchus.robot.motion import check_limits
from suchus.sim.land import Deaf, Limp, Locked, Push, Run, Weak, simulate
from suchus.visual.replay.frames import check_record

PATIENCE = 10
"""A case that takes more of a processor's time hangs, and one that waits for something else for longer [s]."""
_LOOK = 2.0  # [s]; between two looks whether it waits
_COUNTS = Path("/proc/self/schedstat")
_CLOCKS = (signal.SIGPROF, signal.SIGALRM)
LONGEST = 3500
"""Characters of a message."""
FORBIDDEN = (
    "Traceback",
    "object at 0x",
    "invalid literal",
    "int()",
    "NoneType",
    "<class",
    "indices must be",
    "could not convert",
    "has no attribute",
    "unexpected keyword",
    "positional argument",
    "not subscriptable",
    "not iterable",
    "unhashable",
    "out of bounds",
    "codec can't",
)
WORDS = (
    "",
    " ",
    ".",
    "..",
    "/",
    "\0",
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-1",
    "0",
    "x",
    "é",
    "\x1b[31m",
    "\ud800",
    "٣",
    "{}",
    "[]",
    "9" * 400,
    "9" * 5000,
    "a" * 300,
    "n" * 5000,
    "../../etc/passwd",
    "/dev/null/x",
    "/dev/zero",
    "--help ",
    "%s%n",
)
NUMBERS = (0, -1, 1, 3, 1e-300, 1e300, -1e300, math.nan, math.inf, -math.inf, 2**63, -(2**63), 10**400, 0.5)
THINGS = (None, True, "", "x", b"x", [], (), {}, [[]], {"a": 1}, object, 1j, "n" * 5000, *NUMBERS)


class Hang(BaseException):
    """A case that took too long."""


class Silent(AssertionError):
    """NaN out of numbers, or a message that is none."""


STUDY = """
name = "s"
robot = "caiman"
gait = "belly_crawl"
measure = ["displacement", "slip"]
design = "latin"
samples = 4
duration = 1.2
faults = [{kind = "locked", joint = "LF_yaw", at = 0.5, angle = 0.1}]
ground = {friction_scale = 0.9, uphill = 0.1}
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.05
[[vary]]
field = "gait"
values = ["belly_crawl", "limbs_only"]
[[arms]]
name = "a"
values = {"gait.trunk_bend" = 0.1}
"""
SEARCH = """
name = "o"
evaluations = 8
pareto = true
aims = [{name = "displacement"}, {name = "stability"}]
limits = [{name = "torque", value = 2.0}]
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.3
"""


class Range:
    """Where the cases happen: sound files of every kind, to be damaged."""

    def __init__(self, place: Path) -> None:
        self.place = place
        robot, gait = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
        run = Run(robot=robot, gait=gait, label="a")
        land = simulate([run, replace(run, label="b")], duration=0.06, timestep=0.01)
        self.land, self.study = (
            land,
            Study(
                name="s",
                run=run,
                vary=(Vary(field="ground.friction_scale", values=(1.0,)),),
                measure=("displacement",),
                duration=1.2,
            ),
        )
        save(land, place / "land.nc")
        self.swim = _swim()
        save(self.swim, place / "swim.nc")
        blueprint.write(robot, place / "robot.toml")
        blueprint.write(gait, place / "gait.toml")
        write_map(straight(suchus.ROBOTS["caiman"]), place / "map.toml")
        (place / "study.toml").write_text(STUDY)
        (place / "search.toml").write_text(SEARCH)
        (place / "tracks.csv").write_text(_tracks())
        table = xr.Dataset({"x": ("sample", np.arange(3.0)), "error": ("sample", [""] * 3)}, {"sample": np.arange(3)})
        with Store(place / "store", self.study).opened() as store:
            store.put(0, table)
        (place / "outcome").mkdir()
        (place / "outcome" / "outcome.json").write_text(json.dumps(_outcome()))
        self.sound = {path.name: path.read_bytes() for path in place.iterdir() if path.is_file()}
        self.sound["part.nc"] = Store(place / "store", self.study).part(0).read_bytes()
        self.sound["study.json"] = (place / "store" / "study.json").read_bytes()
        self.sound["outcome.json"] = (place / "outcome" / "outcome.json").read_bytes()

    def case(self, number: int) -> None:
        """Run a case.

        Raises:
            BaseException: whatever must not happen; ``Hang`` and ``Silent`` are ours.
        """
        self.carry_out(KINDS[number % len(KINDS)], number)

    def carry_out(self, kind: Any, number: int) -> int:
        """Run a case of a kind, as ``case`` does, and return how many it was; 0 if it was refused.

        Some kinds judge several at once.
        """
        dice = Random(number)
        before = [signal.signal(clock, self._alarm) for clock in _CLOCKS]
        signal.setitimer(signal.ITIMER_PROF, PATIENCE, _LOOK)
        signal.setitimer(signal.ITIMER_REAL, _LOOK, _LOOK)
        self.idle, self.ran = _idle(), time.thread_time()
        checks = jaxtyping.config.jaxtyping_disable
        jaxtyping.config.update("jaxtyping_disable", True)  # what the tests switch on nobody else has
        try:
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")
                count = kind(self, dice)
                return 1 if count is None else count
        except SuchusError as error:
            judge(str(error))
            self.refusal = str(error)
            return 0
        finally:
            jaxtyping.config.update("jaxtyping_disable", checks)
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            for clock, handler in zip(_CLOCKS, before, strict=True):
                signal.signal(clock, handler)

    def _alarm(self, number: int, _: object) -> None:
        if number == signal.SIGPROF and time.thread_time() - self.ran > PATIENCE:  # its clock counts other threads too
            raise Hang(f"more than {PATIENCE} s of a processor")
        if _idle() - self.idle > PATIENCE:
            raise Hang(f"waits for more than {PATIENCE} s")


def judge(sentence: str) -> None:
    """Refuse what is no message for people."""
    if not sentence.strip() or len(sentence) > LONGEST or any(word in sentence for word in FORBIDDEN):
        raise Silent(f"no message for people: {sentence[:400]!r}")


def _idle() -> float:
    """Return how long this process neither ran nor stood in line for a processor since the machine started [s].

    Others may be at this machine too: what only stands in line does not hang.
    """
    ran, queued = _COUNTS.read_text().split()[:2] if _COUNTS.exists() else (0, 0)
    return time.monotonic() - (int(ran) + int(queued)) / 1e9


# files


def damaged(data: bytes, dice: Random) -> bytes:
    """Return bytes with some flipped, lost, doubled or made up."""
    data = bytearray(data)
    way = dice.randrange(6)
    if way == 0:
        return bytes(data[: dice.randrange(len(data) + 1)])
    if way == 1:
        return dice.randbytes(dice.randrange(200))
    start = dice.randrange(len(data) or 1)
    if way == 2:
        return bytes(data[:start] + data[start + dice.randrange(1, 64) :])
    if way == 3:
        return bytes(data[:start] + data[start : start + dice.randrange(1, 64)] * 2 + data[start:])
    for _ in range(dice.choice((1, 1, 2, 8, 64))):
        data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
    return bytes(data)


def reworded(data: bytes, dice: Random) -> bytes:
    """Return a text with a word, a number or a line exchanged for a hostile one."""
    lines = data.decode().split("\n")
    at = dice.randrange(len(lines))
    key, equals, _ = lines[at].partition("=")
    made = dice.choice(
        (
            "nan",
            "-inf",
            "1e999",
            "9" * 5000,
            '"x"',
            '""',
            "[]",
            "{}",
            "true",
            "1979-05-27",
            "[" * 3000,
            "'''",
            "-1",
            "0",
            '"' + "n" * 5000 + '"',
            '"../x"',
            "[1, 2]",
            "[[]]",
            "{kind = 1}",
            "0x",
            "1.5",
        )
    )
    lines[at] = f"{key}= {made}" if equals and dice.random() < 0.8 else dice.choice((made, f"[{made}]", ""))
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def written(self: Range, name: str, dice: Random, how: Any = None, to: str | None = None) -> Path:
    """Write a damaged copy of a sound file and return its path."""
    how = how or dice.choice((damaged, reworded))
    path = self.place / (to or f"bad_{name}")
    path.write_bytes(how(self.sound[name], dice))
    return path


def robot_files(self: Range, dice: Random) -> None:
    made = blueprint.read_design(written(self, "robot.toml", dice), Robot, suchus.ROBOTS)
    check_limits(made, suchus.GAITS["belly_crawl"])


def gait_files(self: Range, dice: Random) -> None:
    robot = suchus.ROBOTS["caiman"]
    check_limits(robot, blueprint.read_gait(written(self, "gait.toml", dice), robot, suchus.GAITS))


def study_files(self: Range, dice: Random) -> None:
    plan = Plan(read_study(written(self, "study.toml", dice)))
    plan.run(dice.randrange(len(plan)))


def search_files(self: Range, dice: Random) -> None:
    spec = read_optimisation(written(self, "search.toml", dice))
    finite([spec.start])


def servo_maps(self: Range, dice: Random) -> None:
    read_map(written(self, "map.toml", dice), suchus.ROBOTS["caiman"])


def keypoint_tables(self: Range, dice: Random) -> None:
    read_tracks(written(self, "tracks.csv", dice))


def outcomes(self: Range, dice: Random) -> None:
    written(self, "outcome.json", dice, to="outcome/outcome.json")
    result = load_result(self.place / "outcome")
    if dice.random() < 0.03:  # a page takes seconds
        render_page([result], [])


def parts(self: Range, dice: Random) -> None:
    store = Store(self.place / "store", self.study)
    if dice.random() < 0.3:
        (self.place / "store" / "study.json").write_bytes(damaged(self.sound["study.json"], dice))
        with contextlib.ExitStack() as stack, contextlib.suppress(SuchusError):
            stack.enter_context(store.opened())
        (self.place / "store" / "study.json").write_bytes(self.sound["study.json"])
        return
    bad = damaged(self.sound["part.nc"], dice)
    store.part(0).write_bytes(bad)
    if store.has(0) and bad != self.sound["part.nc"]:
        raise Silent("a damaged part is taken for sound")


def records(self: Range, dice: Random) -> None:
    """NetCDF with flipped bytes; half of them without the seal, so that HDF5 has to read them."""
    name = dice.choice(("land.nc", "swim.nc"))
    data = self.sound[name] if dice.random() < 0.2 else self.sound[name][:-80]
    path = self.place / "bad.nc"
    path.write_bytes(damaged(data, dice))
    dice.choice((load, takes, films))(path)


_IDLE = {"angular_momentum", "servo_angle", "servo_velocity", "servo_torque", "servo_target", "limb_phase"}
_IDLE |= {"angular_velocity", "acceleration", "snout", "mass", "period", "duty_factor"}
"""Variables that neither a replay nor the viewer reads; a file without them is read in half the time."""


def foreign_records(self: Range, dice: Random) -> None:
    """Sound NetCDF that holds something else than it should."""
    record = (self.land if dice.random() < 0.6 else self.swim).copy()
    name = dice.choice(sorted(map(str, record.variables)))
    record = record.drop_vars([one for one in record.data_vars if one in _IDLE and one != name])
    way = dice.randrange(6)
    if way == 0:
        record = record.drop_vars(name)
    elif way == 1 and name not in record.dims:
        record[name] = ((), dice.choice((1.0, "x", math.nan)))
    elif way == 2:
        record = record.isel({dim: slice(0, dice.randrange(3)) for dim in record[name].dims})
    elif way == 3 and record[name].dtype.kind == "f" and name not in record.dims:
        record[name] = record[name] * dice.choice(NUMBERS[:8])
    elif way == 4 and record[name].dims and name not in record.dims:
        record[name] = (record[name].dims, np.full(record[name].shape, "text"))
    else:
        record = record.assign_attrs({"schema": dice.choice(WORDS[:8])}).rename({name: f"other_{name}"})
    save(record, self.place / "foreign.nc")
    there = load(self.place / "foreign.nc")
    if dice.random() < 0.5:
        one = there.isel(run=0) if "run" in there.dims and there.sizes["run"] else there
        check_record(one, suchus.ROBOTS["caiman"])
    else:
        dice.choice((takes, films))(self.place / "foreign.nc")


# commands


def commands(self: Range, dice: Random) -> int:
    """A command with hostile words; what would run for long has a word that stops it."""
    command = dice.choice(COMMANDS)
    options = (
        "--out",
        "--robot",
        "--gait",
        "--map",
        "--timestep",
        "--port",
        "--host",
        "--samples",
        "--seed",
        "--jobs",
        "--fps",
        "--scheduler",
        "--evaluations",
        "--cycles",
        "--format",
        "--run",
        "--ghost",
        "--title",
        "--quick",
        "--nope",
    )
    files = [
        str(self.place / name) for name in ("land.nc", "bad_robot.toml", "bad_study.toml", "map.toml", "bad.nc", "none")
    ]
    words = [dice.choice((*WORDS, *files))] if dice.random() < 0.7 else []
    for _ in range(dice.randrange(3)):
        words += [dice.choice(options), dice.choice((*WORDS, *files[1:]))]
    if command.name in (
        "run",
        "reproduce",
        "view",
        "capture",
        "optimise",
        "study",
        "export",
        "export-commands",
        "replay",
        "demo",
        "lessons",
        "doctor",
        "emulate",
        "drive",
        "calibrate",
        "size",
        "parts",
    ):
        words += ["--no-such-option"]
    return 0 if told(main, [command.name if dice.random() < 0.95 else dice.choice(WORDS), *words]) else 1


def told(command: Any, words: list[str]) -> int:
    """Run a command, look at what it says, and return its exit code."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = command(words)
        except SystemExit as stop:
            code = stop.code
    complaint = err.getvalue()
    if code not in (0, None, 2) or (code == 2 and complaint.count("\n") != 1):
        raise Silent(f"exit code {code}, {complaint[:200]!r}")
    if code == 2:
        judge(complaint)
    return code or 0


# values


def designs(self: Range, dice: Random) -> None:
    """Robots, gaits and runs with fields of other kinds and sizes."""
    run, path = self.study.run, "run"
    value: Any = run
    while is_dataclass(value) and fields(value):
        step = dice.choice(fields(value)).name
        path, value = f"{path}.{step}", getattr(value, step)
        if dice.random() < 0.1:
            break
    made = with_values(run, {path.removeprefix("run."): dice.choice((*THINGS, value))})
    hash(made)
    value_at(made, path.removeprefix("run."))
    check_limits(made.robot, made.gait)


def studies(self: Range, dice: Random) -> int:
    """Small studies of every design, conducted; in a third of them a field is of another kind or size."""
    vary = [_varied(dice, field) for field in dice.sample(list(_VARIED), dice.choice((1, 1, 2)))]
    design = dice.choice(("factorial", "latin", "sobol"))
    given = {
        "vary": tuple(vary),
        "design": design,
        "samples": None if design == "factorial" else dice.choice((1, 2, 3)),
        "measure": tuple(dice.sample(list(MEASURES), dice.choice((1, 2)))),
        "seed": dice.choice((0, 7, 2**32 - 1)),
        "seeds": dice.choice((1, 1, 2)),
        "chunk": dice.choice((1, 2, 32)),
        "every": dice.choice((1, 1, 2)),
        "duration": 1.1,
        "timestep": 0.01,
        "arms": dice.choice(((), (), (Arm(name="a"), Arm(name="b", values={"gait.trunk_bend": 0.1})))),
    }
    if dice.random() < 0.2:
        given[dice.choice(fields(Study)).name] = dice.choice(THINGS)
    if dice.random() < 0.15:
        given["vary"] = (replace(vary[0], **{dice.choice(fields(Vary)).name: dice.choice((*THINGS, "gait.stroke"))}),)
    asked = replace(self.study, **given)
    plan = Plan(asked)
    if len(plan) > _RUNS or asked.duration > 2.0:
        return 0
    kept = dice.random() < 0.25
    results = conduct(asked, _emptied(self.place / "conducted")) if kept else conducted(asked)
    if results.sizes["sample"] != len(plan):
        raise Silent(f"{results.sizes['sample']} results of {len(plan)} runs")
    told = [str(error) for error in results.error.values]
    for error in filter(None, told):
        judge(error)
    if any(told):
        raise OutsideLimits(next(filter(None, told)))
    if dice.random() < 0.1 and not results.equals(conducted(replace(asked, chunk=1))):
        raise Silent("other results in other batches")
    return 1


_RUNS = 6  # of a study that is conducted, at most
_VARIED: dict[str, tuple[float, float]] = {
    "ground.friction_scale": (0.3, 2.0),
    "ground.uphill": (-0.1, 0.1),
    "gait.stroke": (0.05, 0.3),
    "gait.trunk_bend": (0.0, 0.4),
    "robot.contact.foot_friction": (0.3, 1.5),
    "robot.tail.joints": (4, 8),
    "supply": (0.8, 1.2),
}
"""Fields that a study of the fuzzer's varies, and between what."""


def _varied(dice: Random, field: str) -> Vary:
    """Return a field with values, a range or a distribution, all of them possible."""
    low, high = _VARIED[field]
    if field == "robot.tail.joints":
        return Vary(field=field, values=tuple(dice.sample(range(int(low), int(high)), dice.choice((1, 2)))))
    one, other = sorted((dice.uniform(low, high), dice.uniform(low, high) + 1e-3))
    steps = {"steps": 2, "each": dice.random() < 0.3}
    ways: list[dict[str, Any]] = [{"values": (one,)}, {"values": (one, other)}, {"low": one, "high": other, **steps}]
    ways.append({"mean": 0.5 * (one + other), "spread": other - one, "low": low, "high": high + 1e-3, **steps})
    if one > 0.0:
        ways.append({"low": one, "high": other, "scale": "log", **steps})
    return Vary(field=field, **dice.choice(ways))


def _emptied(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    return folder


def runs(self: Range, dice: Random) -> None:
    """Runs of a few ticks, with hostile faults, pushes and times; what comes back has no NaN before it ended."""
    joint = dice.choice((*servo_names(), "x"))
    number = lambda: dice.choice((0.0, 0.02, 0.1, *NUMBERS))  # noqa: E731
    fault = dice.choice(
        (Limp(joint, number()), Locked(joint, number(), number()), Weak(joint, number()), Deaf(joint, number()))
    )
    push = (
        {"pushes": (Push(force=(number(), 0.0, 0.0), at=number(), duration=number()),)} if dice.random() < 0.3 else {}
    )
    run = replace(self.study.run, faults=(fault,), **push)
    record = simulate([run], duration=dice.choice((0.05, number())) if dice.random() < 0.3 else 0.05, timestep=0.01)
    if not record.cause.item():
        finite([record.position.values])


def closed_forms(self: Range, dice: Random) -> None:
    """Every public function of the kinematics with hostile arrays."""
    room = dice.choice(list(ROOMS))
    function = dice.choice([f for _, f in inspect.getmembers(room, inspect.isfunction) if _public(f, room)])
    known = {"knee": dice.choice((1, -1, 1.0, 0)), "side": 1, "branch": dice.choice((1, -1, 2)), "name": _leg(dice)}
    known |= ROOMS[room] | {"name": dice.choice(("A", "I", "x", None))} if room is kinematics.wave else ROOMS[room]
    given = {
        p.name: known[p.name] if p.name in known else _array(dice)
        for p in inspect.signature(function).parameters.values()
        if p.default is p.empty or dice.random() < 0.3
    }
    came = function(**given)
    made = [value for name, value in given.items() if name not in known]
    numeric = [np.asarray(g, dtype=float) for g in made]
    told = room is kinematics.printed or function.__name__ in ("candidates",)  # which say that they may give NaN
    if not told and all(np.isfinite(g).all() and (np.abs(g) < 1e6).all() for g in numeric):
        finite(came if isinstance(came, tuple) else [came])


def _leg(dice: Random) -> Any:
    return dice.choice(("LF", "RH", "x", None))


def flows(self: Range, dice: Random) -> None:
    """Grids and setups that are never run."""
    grid = {"cells": (64, 64), "cell": 0.1, "origin": (0.0, 0.0)}
    if dice.random() < 0.5:
        odd = (*THINGS, (8, 8), (7, 64), (64, math.nan), ("a", "b"), (10**400, 8))
        grid[dice.choice(list(grid))] = dice.choice(odd)
    setup = {"grid": flow.Grid(**grid), "viscosity": 1e-2}
    if dice.random() < 0.7:
        setup[dice.choice([f.name for f in fields(flow.Setup)])] = dice.choice((*THINGS, (0.0, math.nan), (1.0,)))
    made = flow.Setup(**setup)
    finite([made.grid.x[:3], made.grid.y[:3]])
    made.check_bodies()
    span, cell = ((0, 1), 0.1) if dice.random() < 0.5 else (dice.choice(THINGS), dice.choice(THINGS))
    flow.Grid.covering(span, (0.0, 1.0), cell=cell)


def players(self: Range, dice: Random) -> None:
    """What a browser says to a replay."""
    player = Player(0.0, 3.0)
    for _ in range(5):
        player.seek(dice.choice(THINGS))
        player.advance(dice.choice((0.1, 1e9)))
    finite([np.array(player.time)])


def captures(self: Range, dice: Random) -> None:
    """Keypoints that can be read and are no walk."""
    rows = self.sound["tracks.csv"].decode().split("\n")
    head, body = rows[0], rows[1 : dice.randrange(2, len(rows))]
    for _ in range(dice.randrange(1, 20)):
        at = dice.randrange(len(body))
        cells = body[at].split(",")
        cells[dice.randrange(len(cells))] = dice.choice(("", "nan", "inf", "1e308", "-1e308", "0", "x", "9" * 400))
        body[at] = ",".join(cells)
    path = self.place / "odd.csv"
    path.write_text("\n".join([head, *body]))
    walk = observe(read_tracks(path))
    for number in walk.numbers.values():
        finite([np.array(number[0])])


KINDS = (
    robot_files,
    gait_files,
    study_files,
    search_files,
    servo_maps,
    keypoint_tables,
    outcomes,
    parts,
    records,
    foreign_records,
    commands,
    designs,
    studies,
    runs,
    closed_forms,
    flows,
    players,
    captures,
    commands,
    closed_forms,
    designs,
    records,
)


def finite(came: Any) -> None:
    """Refuse NaN in what came of numbers."""
    for one in came:
        array = np.asarray(one)
        if array.dtype.kind == "f" and np.isnan(array).any():
            raise Silent("NaN came of numbers")


def _rooms() -> dict[Any, dict[str, Any]]:
    """Return the rooms of closed forms, and what their functions are given that is no array."""
    robot = suchus.ROBOTS["caiman"]
    limb, other = layout(robot).limbs[0].girdle.limb, layout(suchus.ROBOTS["strider"]).limbs[0].girdle.limb
    wave = kinematics.wave.reading("I", length=1.0, angular_frequency=1.0)
    parts = {"leg": robot.hind_leg, "spine": robot.spine, "tail": robot.tail, "robot": robot, "limb": limb}
    rooms = (kinematics.leg, kinematics.spine, kinematics.tail, kinematics.tree)
    return {
        **dict.fromkeys(rooms, parts),
        kinematics.limb: {**parts, "limb": other, "girdle": layout(robot).limbs[0].girdle},
        kinematics.wave: {"wave": wave, "sign": 1},
        kinematics.printed: parts,
        kinematics.dh: {"chain": kinematics.spine.chain(robot.spine)},
    }


def _public(function: Any, room: Any) -> bool:
    return not function.__name__.startswith("_") and function.__module__ == room.__name__


def _array(dice: Random) -> Any:
    size = dice.choice((0, 1, 3, 3, 5, 5, 13, 17, 30, 30))
    shape = dice.choice(((size,), (size,), (2, size), (0, size), ()))
    made = np.array([dice.uniform(-3, 3) for _ in range(math.prod(shape))]).reshape(shape)
    if dice.random() < 0.3 and made.size:
        made.flat[dice.randrange(made.size)] = dice.choice((math.nan, math.inf, -math.inf, 1e300))
    return made if dice.random() < 0.8 else dice.choice((made.tolist(), made.astype(str), *THINGS[:12]))


def _swim() -> xr.Dataset:
    x, y = np.linspace(0.0, 1.0, 6), np.linspace(-0.2, 0.2, 5)
    data = xr.Dataset(coords={"x": x, "y": y, "phase": np.arange(4.0)})
    for name in ("vorticity", "pressure"):
        data[f"held_{name}"] = (("instant", "y", "x"), np.ones((2, 5, 6)), {"units": "1/s"})
    for part in ("x", "y", "heading", "half_width"):
        data[f"held_midline_{part}"] = (("instant", "station"), np.ones((2, 7)))
    data["held_thrust"], data["held_aside"] = ("phase", np.ones(4)), ("phase", np.ones(4))
    data["held_phase"] = ("phase", np.arange(4.0))
    return data


def _tracks() -> str:
    """Return a walk of three seconds as a table; the points go about as those of a sprawling animal do."""
    rng = np.random.default_rng(0)
    names = list(GAIT_KEYPOINTS)
    rows = ["time [s], " + ", ".join(f"{name}_{axis} [m]" for name in names for axis in "xy")]
    for i in range(90):
        time = i / 30
        ahead = [0.1 * time + 0.05 * n + 0.02 * math.sin(6.3 * time + n) for n in range(len(names))]
        aside = [0.02 * math.sin(6.3 * time - n) + rng.normal(0, 1e-4) for n in range(len(names))]
        cells = [f"{x:.5f}, {y:.5f}" for x, y in zip(ahead, aside, strict=True)]
        rows.append(f"{time:.5f}, " + ", ".join(cells))
    return "\n".join(rows)


def _outcome() -> dict[str, Any]:
    verdict = {
        "claim": "a",
        "quantity": "q",
        "statement": "s",
        "where": "w",
        "printed": 1.0,
        "measured": 1.0,
        "unit": "m",
        "verdict": "reproduced",
        "why": "y",
    }
    return {
        "experiment": "e",
        "title": "t",
        "shows": "s",
        "decides": "d",
        "command": "c",
        "settings": {},
        "figures": [],
        "measures": {"m": {"value": 1.0, "unit": "m"}},
        "verdicts": [verdict],
        "tables": [],
        "films": [],
        "replays": [],
        "provenance": {"config_hash": "0", "versions": {}, "seed": None, "seconds": 1.0},
    }


ROOMS = _rooms()
