"""Cases that get through the door: files and values that are nearly right, and the work that follows them.

As in ``hostile.py`` a case is a number. What is asked is more than a sentence: a robot that is read has the mass that
its file has, a walk ends in finite numbers or says when it did not, a record of other units is refused or means the
same, a film read in pixels says what it says in metres, a kernel's code is what was kept or none, and a whole command
leaves the files of a user as they are.
"""

import contextlib
import io
import math
import os
import pickle
import re
import shutil
import struct
import sys
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import mujoco
import numpy as np
import xarray as xr
from hostile import Range, Silent, commands, damaged, finite, foreign_records, judge, records

import suchus
from suchus.animals.capture import Tracks, film_animal, observe
from suchus.animals.capture.film import Camera
from suchus.apps.cli import main
from suchus.apps.viewer.replay import takes
from suchus.core.errors import Diverged, SuchusError
from suchus.core.files import save
from suchus.core.jobs.store import Store
from suchus.core.kernel_cache import SealedFiles
from suchus.experiments.optimise import READY, read_optimisation
from suchus.experiments.study import Plan, read_study
from suchus.robot import blueprint
from suchus.robot.design import Robot, layout, servo_names
from suchus.robot.design.ground import Bumps, Step, Stone
from suchus.robot.design.scale import rescale
from suchus.robot.motion import check_limits, draft_gait
from suchus.sim.land import (
    Backlash,
    Deaf,
    Ground,
    Lake,
    Limp,
    Locked,
    LostFoot,
    Offset,
    Push,
    Run,
    Slow,
    Weak,
    simulate,
)
from suchus.sim.model.importing import Words, import_robot

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "tests" / "model"), str(ROOT / "tests" / "capture")]

from hinge_trees import pendulum, quadruped, skewed  # noqa: E402
from menagerie import Filmed, apart, built, truth  # noqa: E402

_NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?(?![\w.])")
_ELEMENT = re.compile(r"<(\w+)[^<>]*/>|<(\w+)[^<>]*>[^<>]*</\2>")
_TOGETHER = 32  # runs of a batch
_FAST, _FAR = 300.0, 1e4  # m/s and m that no body of the shelf reaches within some ticks
_SMALL = 8000  # characters of a file that is read soon
_ANIMALS, _CYCLES = 8, 5  # of the films of known truth
_ERRORS = 4.0  # half widths of an interval, which holds the truth in 95 of 100 cases
_CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


class Doors(Range):
    """Sound files of every kind that a command reads, beside those of ``Range``."""

    def __init__(self, place: Path) -> None:
        super().__init__(place)
        legged = quadruped(), quadruped(axes=("0 1 0", "1 0 0"))
        self.trees = {"urdf": [*legged, pendulum(), pendulum(3, axis="0 1 0")], "xml": [skewed(), meshed()]}
        (place / "part.stl").write_bytes(stl(0.05))
        for name in suchus.ROBOTS:
            for form, end in (("urdf", "urdf"), ("mjcf", "xml")):
                folder = place / "bodies" / f"{name}_{form}"
                with contextlib.redirect_stdout(io.StringIO()):
                    main(["export", "--format", form, "--robot", name, "--out", str(folder)])
                made = [file.read_text() for file in folder.glob(f"*.{end}")]
                self.trees[end] += [text for text in made if "<include" not in text]
        needed = ["position", "centre_of_mass", "snout", "tail_tip", "acceleration", "orientation", "joint_angle"]
        needed += ["foot_position", "foot_force", "belly_force", "tail_force", "cause", "ended", "stands_on"]
        self.few = self.land[needed].isel(run=[0])
        self.was = takes(save(self.few, place / "few.nc"))[0].record
        self.suited = [(robot, gait) for robot in suchus.ROBOTS for gait in suchus.GAITS if _suits(robot, gait)]
        wet = Run(robot=suchus.ROBOTS["caiman"], gait=suchus.GAITS["belly_crawl"], lake=Lake(level=1.0))
        simulate([wet], duration=0.02)  # compiled once, by the parent of all who will need it
        sealed = SealedFiles(str(place), "k", "stamp").sealed
        self.kernel = sealed("k.nbi", pickle.dumps(("version", "stamp", {"a": "b"})))
        self.animals = [filmed(seed) for seed in range(_ANIMALS)]
        self.walks = [observe(animal.tracks).numbers for animal in self.animals]
        self.sound["tracks.csv"] = table_of(self.animals[0].tracks).encode()


def _suits(robot: str, gait: str) -> bool:
    try:
        check_limits(suchus.ROBOTS[robot], Run(robot=suchus.ROBOTS[robot], gait=suchus.GAITS[gait]).gait)
    except SuchusError:
        return False
    return True


def stl(size: float) -> bytes:
    """Return a cube as binary STL."""
    corners = [tuple(size * x for x in corner) for corner in _CUBE]
    halves = [half for a, b, c, d in _FACES for half in ((a, b, c), (a, c, d))]
    faces = [[corners[i] for i in half] for half in halves]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(x for corner in face for x in corner), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + body


def meshed() -> str:
    """Return a body of four meshes behind each other, as MJCF."""
    text = ""
    for i in range(4, 0, -1):
        joint = f'<joint name="j{i}" axis="0 0 1" range="-1 1"/>' if i > 1 else ""
        text = f'<body name="b{i}" pos="-0.12 0 0">{joint}<geom type="mesh" mesh="part" mass="0.3"/>{text}</body>'
    asset = '<asset><mesh name="part" file="part.stl"/></asset>'
    return f'<mujoco><compiler angle="radian"/>{asset}<worldbody>{text}</worldbody></mujoco>'


def altered(text: str, dice: Random) -> str:
    """Return XML with some numbers changed, an element lost, doubled or moved, or a word exchanged."""
    for _ in range(dice.choice((1, 1, 2, 5))):
        way = dice.random()
        if way < 0.85:
            found = dice.choice(list(_NUMBER.finditer(text)))
            value = float(found[0]) if len(found[0]) < 300 else 1.0
            mild = dice.random() < 0.8
            wild = dice.choice((0.0, -value, 1e3 * value, 1e-3 * value, 1.0))
            other = value * dice.uniform(0.8, 1.25) if mild else wild
            text = text[: found.start()] + f"{other:.6g}" + text[found.end() :]
        elif elements := list(_ELEMENT.finditer(text)):
            found, other = dice.choice(elements), dice.choice(elements)
            if way < 0.9:
                text = text[: found.start()] + text[found.end() :]
            elif way < 0.93:
                text = text[: found.end()] + found[0] + text[found.end() :]
            elif way < 0.97 and found.start() > other.end():
                text = text[: other.end()] + found[0] + text[other.end() : found.start()] + text[found.end() :]
            else:
                words = re.findall(r'"([A-Za-z_]\w*)"', text)
                text = text.replace(f'"{dice.choice(words)}"', f'"{dice.choice(words)}"', 1) if words else text
    return text


def _tree(self: Doors, dice: Random, end: str) -> str:
    """Return a sound file, seldom one of the large ones."""
    texts = self.trees[end]
    return dice.choice(texts if dice.random() < 0.1 else [text for text in texts if len(text) < _SMALL])


def _imported(self: Doors, dice: Random, end: str) -> None:
    """Read a robot; if there is one, it can be written and read, has the mass of the file, and moves."""
    text = _tree(self, dice, end)
    text = altered(text, dice) if dice.random() < 0.85 else damaged(text.encode(), dice).decode("utf-8", "replace")
    file = self.place / f"odd.{end}"
    file.write_text(text)
    draft = import_robot(file, name="odd", words=Words())
    robot = draft.robot
    if not (math.isfinite(robot.mass) and robot.mass > 0 and math.isfinite(robot.length)):
        raise Silent(f"a robot of {robot.mass} kg and {robot.length} m")
    with contextlib.suppress(ValueError):  # what MuJoCo does not compile we may read all the same
        whole = mujoco.MjModel.from_xml_path(str(file)).body_mass.sum()
        if whole > 0 and abs(robot.mass - whole) > 1e-3 * whole and not draft.remarks:
            raise Silent(f"a robot of {robot.mass:g} kg from a file of {whole:g} kg, and nothing is said")
    if dice.random() < 0.05:
        again = blueprint.read_design(blueprint.write(robot, self.place / "odd.toml"), Robot, suchus.ROBOTS)
        if again != robot:
            raise Silent("what was written is read as another robot")
    if dice.random() < 0.1:
        moved([Run(robot=robot, gait=draft_gait(robot, "odd"))], 0.05)


def urdf_files(self: Doors, dice: Random) -> None:
    _imported(self, dice, "urdf")


def mjcf_files(self: Doors, dice: Random) -> None:
    _imported(self, dice, "xml")


def moved(runs: list[Run], duration: float) -> xr.Dataset | None:
    """Simulate runs, and refuse what comes back without an end and without numbers, or at a speed that nothing has."""
    try:
        record = simulate(runs, duration=duration)
    except Diverged as error:
        judge(str(error))
        return None
    for run in range(len(runs)):
        one = record.isel(run=run)
        if one.cause.item():
            judge(str(one.cause.item()))
            continue
        finite([one.position.values, one.servo_torque.values, one.foot_force.values])
        steps = np.abs(np.diff(one.position.values, axis=0)).max() / float(one.time[1] - one.time[0])
        if steps > _FAST or np.abs(one.position.values).max() > _FAR:
            raise Silent(f"a body at {steps:g} m/s")
    return record


def _relief(dice: Random) -> Step | Stone | Bumps | None:
    at, high, wide = dice.uniform(0.1, 1.0), dice.uniform(0.001, 0.1), dice.uniform(0.05, 0.3)
    return dice.choice(
        (
            None,
            None,
            Step(at=at, height=high),
            Stone(at=at, aside=dice.uniform(-0.3, 0.3), height=high, length=0.1, width=wide),
            Bumps(height=0.5 * high, correlation=wide, start=0.1, seed=dice.randrange(9)),
        )
    )


def _troubled(robot: Robot, dice: Random, duration: float) -> dict[str, Any]:
    """Return faults and pushes of a run, all of them possible ones."""
    found: dict[str, Any] = {}
    if dice.random() < 0.5:
        servo, at = dice.choice(servo_names(robot)), dice.uniform(0.0, 0.8 * duration)
        kinds: list[Any] = [Limp(servo, at), Locked(servo, at), Weak(servo, dice.uniform(0.1, 0.9), at)]
        kinds += [Offset(servo, dice.uniform(-0.2, 0.2), at), Backlash(servo, dice.uniform(0.01, 0.1), at)]
        kinds += [Slow(servo, dice.uniform(0.5, 3.0), at)]
        if limbs := layout(robot).limb_names:
            kinds += [LostFoot(dice.choice(limbs), at), Deaf("foot_pressure", at)]
        found["faults"] = (dice.choice(kinds),)
    if dice.random() < 0.3:
        force = tuple(robot.mass * dice.uniform(-5.0, 5.0) for _ in "xyz")
        bodies = [segment.name for segment in robot.axis]
        lasts = 0.4 * duration
        found["pushes"] = (Push(force=force, at=dice.uniform(0.0, lasts), duration=lasts, body=dice.choice(bodies)),)
    return found


def walks(self: Doors, dice: Random) -> int:
    """Thirty-two runs of a body of the shelf, in another size and a gait of the shelf or its own.

    Each has slopes, a friction and troubles of its own, and is judged by itself.
    """
    name, other = dice.choice(self.suited)
    robot, duration = suchus.ROBOTS[name], dice.choice((0.02, 0.04, 0.06))
    if dice.random() < 0.5:
        factor = 10 ** dice.uniform(-0.5, 0.5)
        robot = rescale(robot, length_factor=factor, mass_factor=factor**3 * dice.uniform(0.5, 2.0))
    gait = draft_gait(robot, "own") if dice.random() < 0.1 else suchus.GAITS[other]
    if dice.random() < 0.5:
        one = dice.choice(sorted(gait.numbers()))
        gait = gait.with_numbers(**{one: dice.uniform(0.7, 1.3) * gait.number(one)})
    lake = {"lake": Lake(level=dice.uniform(0.0, 2.0) * robot.length)} if dice.random() < 0.03 else {}
    relief = _relief(dice)
    grounds = [
        Ground(
            friction_scale=10 ** dice.uniform(-2.0, 1.0),
            uphill=dice.uniform(-0.5, 0.5),
            sideways=dice.uniform(-0.3, 0.3),
            relief=relief,
        )
        for _ in range(_TOGETHER)
    ]
    runs = [
        Run(robot=robot, gait=gait, ground=ground, seed=n, **lake, **_troubled(robot, dice, duration))
        for n, ground in enumerate(grounds)
    ]
    record = moved(runs, duration)
    if record is None:
        return 1
    if dice.random() < 0.2:
        number = dice.randrange(_TOGETHER)
        alone = moved([runs[number]], duration)
        if alone is None or alone.position.values[0].tobytes() != record.position.values[number].tobytes():
            raise Silent(f"run {number} has other bytes beside others than alone")
    return _TOGETHER


_SAME = ("float32", "big-endian", "a further variable", "no label", "a history", "times in another type")
_OTHER = (
    "centimetres",
    "degrees",
    "dimensions in another order",
    "axes in another order",
    "two variables exchanged",
    "times in milliseconds",
    "times backwards",
    "a variable of whole numbers",
    "joints in another order",
)


def altered_records(self: Doors, dice: Random) -> None:
    """A sound record that somebody changed with other tools: it means what it says, or is refused."""
    record, was = self.few.copy(deep=True), self.was
    how = dice.choice(_SAME + _OTHER)
    lengths = ("position", "centre_of_mass", "foot_position")
    if how == "float32":
        record = record.assign({name: record[name].astype("f4") for name in dice.sample(lengths, 2)})
    elif how == "big-endian":
        record["position"] = record.position.astype(">f8")
    elif how == "a further variable":
        record["weather"] = ("time", np.ones(record.sizes["time"]), {"units": "1"})
    elif how == "no label":
        record = record.drop_vars("label")
    elif how == "a history":
        record.attrs["history"] = "changed"
    elif how == "times in another type":
        record = record.assign_coords(time=record.time.astype("f4"))
    elif how == "centimetres":
        name = dice.choice(lengths)
        record[name] = (record[name] * 100.0).assign_attrs(units="cm")
    elif how == "degrees":
        record["joint_angle"] = np.degrees(record.joint_angle).assign_attrs(units="deg")
    elif how == "dimensions in another order":
        record = record.transpose(*dice.sample(list(map(str, record.dims)), len(record.dims)))
    elif how == "axes in another order":
        record = record.isel(xyz=dice.choice(([2, 1, 0], [1, 0, 2])))
    elif how == "two variables exchanged":
        one, other = dice.sample(("position", "centre_of_mass", "snout", "tail_tip", "acceleration"), 2)
        record = record.rename({one: other, other: one})
    elif how == "times in milliseconds":
        record = record.assign_coords(time=("time", record.time.values * 1e3, {"units": "ms"}))
    elif how == "times backwards":
        record = record.isel(time=slice(None, None, -1))
    elif how == "a variable of whole numbers":
        record["position"] = np.round(record.position).astype("i8").assign_attrs(record.position.attrs)
    else:
        record = record.isel(joint=slice(None, None, -1))
    path = self.place / "altered.nc"
    save(record, path)
    seen = takes(path)[0]  # or it is refused
    if how == "a variable of whole numbers":
        return
    for name in ("position", "joint_angle", "foot_position", "centre_of_mass"):
        if was[name].dims != seen.record[name].dims:
            raise Silent(f"{name} is read with other dimensions after: {how}")
        if not np.allclose(was[name].values, seen.record[name].values, rtol=1e-5, atol=1e-6):
            raise Silent(f"{name} is read otherwise after: {how}")


def kernel_caches(self: Doors, dice: Random) -> None:
    """Kept code with flipped bytes, cut, of another name: what was kept, or nothing."""
    folder = self.place / "kernels"
    folder.mkdir(exist_ok=True)
    files, bad = SealedFiles(str(folder), "k", "stamp"), damaged(self.kernel, dice)
    (folder / "k.nbi").write_bytes(bad)
    read = files._read("k.nbi")
    if read != (("version", "stamp", {"a": "b"}) if bad == self.kernel else None):
        raise Silent(f"damaged code is taken: {read!r}")
    (folder / "other.nbi").write_bytes(self.kernel)
    if files._read("other.nbi") is not None:
        raise Silent("another kernel's code is taken")


def kept_parts(self: Doors, dice: Random) -> None:
    """Kept parts of a study, sound files that somebody changed and sealed again; a study goes on or says why not."""
    table = xr.Dataset({"x": ("sample", np.arange(3.0)), "error": ("sample", [""] * 3)}, {"sample": np.arange(3)})
    way = dice.randrange(5)
    if way == 0:
        table = table.rename(x=dice.choice(("y", "error2")))
    elif way == 1:
        table = table.isel(sample=slice(0, dice.randrange(3)))
    elif way == 2:
        table["x"] = ("sample", ["text"] * 3)
    elif way == 3:
        table = table.assign_coords(sample=np.arange(3) + dice.choice((-1, 1, 10**9)))
    store = Store(self.place / "parts", self.study)
    with store.opened():
        store.put(0, table)
        if not store.has(0):
            raise Silent("a part that was put is not there")
        gathered = store.gather(1)
        if way == 4 and gathered.x.values.tolist() != [0.0, 1.0, 2.0]:
            raise Silent("a part is read otherwise than it was put")


def walked_studies(self: Doors, dice: Random) -> None:
    """A study whose fields and values are possible ones; its plan is made, and a part of its runs is walked."""
    field, low, high = dice.choice(
        (
            ("ground.friction_scale", 0.2, 2.0),
            ("gait.stroke", 0.05, 0.4),
            ("gait.trunk_bend", 0.0, 0.5),
            ("gait.period", 0.5, 3.0),
            ("robot.contact.foot_friction", 0.1, 2.0),
            ("ground.uphill", -0.3, 0.3),
            ("noise", 0.0, 0.1),
            ("supply", 0.5, 1.5),
        )
    )
    low, high = sorted((dice.uniform(low, high), dice.uniform(low, high)))
    robot, gait = dice.choice((("caiman", "belly_crawl"), ("strider", "tripod"), ("salamander", "salamander_walk")))
    design = dice.choice(("factorial", "latin", "sobol"))
    steps = "steps = 3\n" if design == "factorial" else ""
    text = (
        f'name = "s"\nrobot = "{robot}"\ngait = "{gait}"\nmeasure = ["displacement"]\ndesign = "{design}"\n'
        f"samples = {dice.choice((1, 2, 4, 7))}\nduration = 1.2\nseed = {dice.randrange(99)}\n"
        f'[[vary]]\nfield = "{field}"\n{steps}low = {low:.5g}\nhigh = {high + 0.01:.5g}\n'
    )
    path = self.place / "walked.toml"
    path.write_text(text if dice.random() < 0.7 else damaged(text.encode(), dice).decode("utf-8", "replace"))
    plan = Plan(read_study(path))
    run = plan.run(dice.randrange(len(plan)))
    if plan.run(0) != Plan(read_study(path)).run(0):
        raise Silent("a study read twice has other runs")
    if dice.random() < 0.2:
        moved([run], 0.05)


def searches(self: Doors, dice: Random) -> None:
    """A search, ready or of a file, whose candidates lie anywhere in the box; some are walked."""
    if dice.random() < 0.5:
        spec = READY[dice.choice(list(READY))]()
    else:
        path = self.place / "searched.toml"
        text = self.sound["search.toml"].decode()
        bounds = [f"{bound:.3g}" for bound in sorted((dice.uniform(0.0, 0.1), dice.uniform(0.1, 0.4)))]
        path.write_text(text.replace("low = 0.0", f"low = {bounds[0]}").replace("high = 0.3", f"high = {bounds[1]}"))
        spec = read_optimisation(path)
    shares = [dice.choice((0.0, 1.0, dice.random())) for _ in spec.vary]
    run = spec.candidate(dict(zip((vary.field for vary in spec.vary), shares, strict=True)))
    if not 0.0 <= min(spec.start, default=0.0) <= max(spec.start, default=1.0) <= 1.0:
        raise Silent(f"a search begins outside its bounds, at {spec.start}")
    if dice.random() < 0.2:
        moved([run], 0.05)


def filmed(seed: int) -> Filmed:
    """Return an animal of known truth that walks for five cycles, and its film."""
    animal = built(np.random.default_rng(seed), seed, trunk=(0.1, 0.2), period=(0.8, 1.2))
    camera = Camera(rate=30.0, noise=0.0005, lost=0.0, heading=0.3 * seed, scale=None, heights=False, seed=seed)
    return Filmed(animal, np.ones(_CYCLES), film_animal(animal, camera, cycles=_CYCLES))


def table_of(tracks: Tracks) -> str:
    """Return a film as a table of keypoints."""
    rows = ["time [s], " + ", ".join(f"{point}_{axis} [m]" for point in tracks.points for axis in "xy")]
    rows += [
        ", ".join(f"{number:.6f}" for number in (time, *places[:, :2].ravel()))
        for time, places in zip(tracks.time, tracks.position, strict=True)
    ]
    return "\n".join(rows)


def films_of_known_truth(self: Doors, dice: Random) -> None:
    """A film of an animal, turned, moved, in other units: what is measured follows it.

    Half of them are worse films of it, noisier, with points lost or frames cut off: what is measured, if anything, is
    the truth about the animal, within some of the errors that it gives itself.
    """
    which = dice.randrange(_ANIMALS)
    tracks, worse = self.animals[which].tracks, dice.random() < 0.5
    position, time = tracks.position.copy(), tracks.time.copy()
    if worse:
        random = np.random.default_rng(dice.randrange(2**32))
        position += dice.choice((0.0, 0.001, 0.002)) * random.standard_normal(position.shape)
        position[random.uniform(size=position.shape[:2]) < dice.choice((0.0, 0.02, 0.05))] = np.nan
        keep = slice(dice.randrange(20), len(time) - dice.randrange(20))
        position, time = position[keep], time[keep]
    angle, factor = dice.uniform(-3.1, 3.1), 10 ** dice.uniform(-1.0, 1.0)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    position[..., :2] = position[..., :2] @ turn.T + [dice.uniform(-5, 5), dice.uniform(-5, 5)]
    position *= factor
    order = dice.sample(range(len(tracks.points)), len(tracks.points))
    seen = observe(
        replace(
            tracks,
            position=position[:, order],
            points=tuple(tracks.points[i] for i in order),
            time=time + dice.uniform(-100.0, 100.0),
        )
    ).numbers
    was = self.walks[which]
    if worse:
        _holds(seen, self.animals[which], was, factor)
        return
    for name, number in was.items():
        if name not in seen:
            raise Silent(f"{name} is no longer measured")
        slack = 1e-3 * max(1.0, abs(number.value)) + 0.2 * number.error
        scale = factor if number.unit in ("m", "m/s") else 1.0
        if math.isfinite(number.value) and apart(seen[name], scale * number.value) > scale * slack:
            raise Silent(f"{name} is {seen[name].value:g} instead of {scale * number.value:g} {number.unit}")


def _holds(seen: Any, animal: Filmed, was: Any, factor: float) -> None:
    """Refuse numbers that are further from the truth than some of their own errors."""
    for name, value in truth(animal).items():
        if name in seen:
            scale = factor if was[name].unit in ("m", "m/s") else 1.0
            off, error = apart(seen[name], scale * value), seen[name].error
            if not off <= _ERRORS * error + 0.01 * scale * max(1.0, abs(value)):
                raise Silent(f"{name} is {seen[name].value:g} ± {error:g} instead of {scale * value:g}")


def whole_commands(self: Doors, dice: Random) -> int:
    """A command with options that it has, carried out in a folder in which a user keeps files of their own."""
    desk = self.place / "desk"
    shutil.rmtree(desk, ignore_errors=True)
    desk.mkdir()
    words = dice.choice(_LINES)(self, dice, desk)
    names = ("notes.txt", "it.toml", "it.xml", "it.html", "it/notes.txt", "tables/x.csv")
    own = {desk / name: dice.randbytes(9) for name in names if dice.random() < 0.4}
    for path, data in own.items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
    replaces = dice.random() < 0.1
    before = Path.cwd()
    out, err = io.StringIO(), io.StringIO()
    os.chdir(desk)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main([*words, *["--replace"] * replaces])
    finally:
        os.chdir(before)
    said = [line for line in err.getvalue().splitlines() if line.startswith("suchus: ")]
    if code not in (0, 1, 2) or "Traceback" in err.getvalue() or (code and not said):
        raise Silent(f"{words}: exit code {code}, {err.getvalue()[-300:]!r}")
    if code:
        judge(said[-1])
    _look_after(self, words, own, replaces, desk)
    return 0 if code else 1


def _look_after(self: Doors, words: list[str], own: dict[Path, bytes], replaces: bool, desk: Path) -> None:
    """Refuse that a file of the user's is gone or changed, or that something half-written stays."""
    for path, data in own.items():
        kept = [one for one in desk.rglob("*") if one.is_file() and one.read_bytes() == data]
        if not kept or (not replaces and path not in kept):
            raise Silent(f"{words}: {path.name} of the user's is gone or changed")
    left = [one.name for one in desk.rglob(".*") if one.name != ".suchus-written"]
    if left:
        raise Silent(f"{words}: {left} is left behind")


def _line_export(self: Doors, dice: Random, desk: Path) -> list[str]:
    form = dice.choice(("mjcf", "urdf"))
    robot = dice.choice((*suchus.ROBOTS, "none", str(self.place / "robot.toml")))
    return ["export", "--format", form, "--robot", robot, "--out", dice.choice(("it", "it.xml", "notes.txt"))]


def _line_import(self: Doors, dice: Random, desk: Path) -> list[str]:
    end = dice.choice(("urdf", "xml"))
    text = _tree(self, dice, end)
    (desk / f"given.{end}").write_text(altered(text, dice) if dice.random() < 0.7 else text)
    (desk / "part.stl").write_bytes(stl(0.05))
    return ["import", f"given.{end}", "--out", dice.choice(("it.toml", "it.txt", "it/robot.toml"))]


def _line_compare(self: Doors, dice: Random, desk: Path) -> list[str]:
    for name in ("a", "b"):
        (desk / name).mkdir()
        data = self.sound["outcome.json"]
        (desk / name / "outcome.json").write_bytes(damaged(data, dice) if dice.random() < 0.3 else data)
    return ["compare", "a", "b", "--out", "it.html"]


def _line_replay(self: Doors, dice: Random, desk: Path) -> list[str]:
    shutil.copy(self.place / "land.nc", desk / "walk.nc")
    words = ["replay", "walk.nc", "--out", "it.html", "--run", dice.choice(("0", "1", "7"))]
    return words + dice.choice(([], ["--fps", dice.choice(("10", "0", "nan"))]))


def _line_refused(self: Doors, dice: Random, desk: Path) -> list[str]:
    number = dice.choice(("0", "-1", "nan", "1e9", "x"))
    lines = (
        ["run", "displacement", "--quick", "--cycles", number],
        ["run", "leg_kinematics", "--samples", number, "--out", "it"],
        ["study", "notes.txt", "--out", "it"],
        ["size", "caiman", "belly_crawl", "--slope", dice.choice(("nan", "1e9", "x"))],
        ["parts", "caiman", "--no-outlines", "--wall", number, "--out", "it"],
        ["export-commands", "belly_crawl", "--cycles", number, "--out", "it"],
        ["capture", "notes.txt", "--out", "it.toml"],
        ["optimise", "notes.txt", "--out", "it"],
    )
    return dice.choice(lines)


def _line_capture(self: Doors, dice: Random, desk: Path) -> list[str]:
    text = self.sound["tracks.csv"]
    (desk / "walk.csv").write_bytes(damaged(text, dice) if dice.random() < 0.5 else text)
    words = ["capture", "walk.csv", "--out", dice.choice(("it.toml", "it/notes.txt"))]
    return words + dice.choice(([], ["--tables", "tables"], ["--tables", "it"]))


def _line_commands(self: Doors, dice: Random, desk: Path) -> list[str]:
    robot, gait = dice.choice(self.suited)
    words = ["export-commands", gait, "--robot", robot, "--out", dice.choice(("it", "it.xml", "notes.txt"))]
    return ["export-commands", "--robot", robot, "--write-map", "it.toml"] if dice.random() < 0.5 else words


def _line_study(self: Doors, dice: Random, desk: Path) -> list[str]:
    (desk / "grip.toml").write_text(
        f'name = "grip"\nduration = 1.1\nmeasure = ["displacement"]\n[[vary]]\nfield = "ground.friction_scale"\n'
        f"values = [{dice.uniform(0.1, 2.0):.3g}]\n"
    )
    return ["study", "grip.toml", "--out", "it"]


_LINES = (
    *(_line_export, _line_import, _line_compare, _line_refused, _line_refused, _line_replay, _line_study) * 2,
    _line_capture,
    _line_commands,
)

WEIGHTS = {
    urdf_files: 2,
    mjcf_files: 1.4,
    walks: 2,
    altered_records: 0.4,
    kernel_caches: 12,
    kept_parts: 0.5,
    walked_studies: 4,
    searches: 0.5,
    films_of_known_truth: 0.5,
    whole_commands: 1,
    records: 0.8,
    foreign_records: 0.2,
    commands: 1.6,
}
"""Of a hundred numbers of the farm those of each kind; the rest are of the other ``hostile.KINDS``, each as often."""
