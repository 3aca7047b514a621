"""What a checkpoint belongs to, and what becomes of one that is damaged."""

import copy
import dataclasses
import importlib.util
import io
import pickle
import sys
from functools import cached_property, lru_cache

import numpy as np
import pytest
from flow_cases import still_setup
from hypothesis import given
from hypothesis import strategies as st

from suchus import flow
from suchus.core import fingerprint as prints
from suchus.core.errors import UnreadableFile
from suchus.core.fingerprint import fingerprint
from suchus.flow.checkpoint import MARK, arrays


def heaving(amplitude, scale=1.0):
    def motion(time, rate=2.0):
        return flow.Pose(position=(0.0, amplitude * np.sin(rate * scale * time)))

    return motion


def pull(stiffness):
    def force(time, state):
        return -stiffness * state.position[0], 0.0, 0.0

    return force


def ribbon(width):
    spine = flow.foil(1.0, thickness=width).spine(0.0)
    return flow.Midline(spine=lambda time: spine, deforms=False)


def setup():
    """One of everything that a setup can hold."""
    return still_setup(
        stream=(0.3, 0.0), follow="ell", step=0.01, follow_axes=(False, False),
        contact=flow.BodyContact(gap=0.1, pressure=2.0),
        sides=flow.Sides(left=flow.Inflow(profile=lambda y: 0.3 + 0 * y), right=flow.Outflow(), bottom=flow.Slip(),
                         top=flow.Wall(speed=0.2)),
        bodies=(
            flow.Body(shape=flow.Cylinder(diameter=0.6), motion=flow.Pose(position=(0.2, 0.1), velocity=(0.1, 0.0)),
                      name="cyl"),
            flow.Body(shape=flow.Ellipse(length=0.9, width=0.5), motion=flow.Oscillation(frequency=0.7, pitch=0.1),
                      name="ell"),
            flow.Body(shape=flow.Plate(length=0.9, thick=0.4), motion=flow.Glide(start=(0.1, 0.2), velocity=(1.0, 0.0)),
                      name="plate"),
            flow.Body(shape=ribbon(0.2), motion=heaving(0.1), name="ribbon"),
            flow.FreeBody(shape=flow.Cylinder(diameter=0.7), start=(0.2, 0.3), density=800.0, name="free",
                          anchor=(0.2, 0.3, 0.1), force=pull(0.3)),
        ),
    )  # fmt: skip


def leaves(value, path=()):
    """Paths to all numbers, words and switches in a value."""
    if dataclasses.is_dataclass(value):
        return [p for f in dataclasses.fields(value) for p in leaves(getattr(value, f.name), (*path, f.name))]
    if isinstance(value, tuple):
        return [p for k, item in enumerate(value) for p in leaves(item, (*path, k))]
    return [path]


def changed(value, path, change):
    """The value with the leaf at a path changed, unchecked."""
    if not path:
        return change(value)
    if isinstance(value, tuple):
        return tuple(changed(item, path[1:], change) if k == path[0] else item for k, item in enumerate(value))
    other = copy.copy(value)
    object.__setattr__(other, path[0], changed(getattr(value, path[0]), path[1:], change))
    return other


def another(value, amount=0.5):
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    if isinstance(value, float):
        return value + amount
    if isinstance(value, str):
        return value + "x"
    return (lambda *given: 0) if callable(value) else 1.0


PATHS = leaves(setup())


def test_every_field_of_a_setup_is_among_the_paths():
    assert {path[0] for path in PATHS} == {f.name for f in dataclasses.fields(flow.Setup)}
    assert len(PATHS) > 60


@given(st.sampled_from(PATHS), st.floats(1e-9, 1e3))
def test_any_changed_value_is_another_setup(path, amount):
    mine = setup()
    assert fingerprint(changed(mine, path, lambda v: another(v, amount))) != fingerprint(mine)


def test_the_same_values_are_the_same_setup():
    assert fingerprint(setup()) == fingerprint(setup())
    assert fingerprint(still_setup(density=1)) == fingerprint(still_setup(density=1.0))


@pytest.mark.parametrize("name", [f.name for f in dataclasses.fields(flow.Setup)])
def test_a_field_left_out_would_be_noticed(name, monkeypatch):
    """The test of the test: without one field some change passes."""
    monkeypatch.setattr(prints, "fields", lambda v: [f for f in dataclasses.fields(v) if f.name != name])
    mine = setup()
    passed = [
        path for path in PATHS if path[0] == name and fingerprint(changed(mine, path, another)) == fingerprint(mine)
    ]
    assert passed


@pytest.mark.parametrize("other", [
    heaving(0.2), heaving(0.1, 2.0), lambda time: flow.Pose(position=(0.0, 0.1 * np.sin(time))),
    flow.Oscillation(frequency=1.0, heave=(0.0, 0.1)), flow.Pose(),
])  # fmt: skip
def test_a_motion_is_what_it_is_made_of(other):
    def bodies(motion):
        return still_setup(bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion),))

    assert fingerprint(bodies(heaving(0.1))) == fingerprint(bodies(heaving(0.1)))
    assert fingerprint(bodies(other)) != fingerprint(bodies(heaving(0.1)))


def test_a_force_is_what_it_is_made_of():
    def bodies(stiffness):
        return still_setup(bodies=(flow.FreeBody(shape=flow.Cylinder(diameter=1.0), force=pull(stiffness)),))

    assert fingerprint(bodies(0.3)) == fingerprint(bodies(0.3))
    assert fingerprint(bodies(0.3)) != fingerprint(bodies(0.4))


def test_a_midline_is_what_its_stations_are():
    def bodies(width):
        return still_setup(bodies=(flow.Body(shape=ribbon(width)),))

    assert fingerprint(bodies(0.2)) == fingerprint(bodies(0.2))
    assert fingerprint(bodies(0.2)) != fingerprint(bodies(np.nextafter(0.2, 1)))


class Heave:
    """A motion with a memory of its own, as users write them."""

    def __init__(self, amplitude):
        self.amplitude = amplitude

    @cached_property
    def rate(self):
        return 2.0 * self.amplitude

    def __call__(self, time):
        return flow.Pose(position=(0.0, self.rate * time))


def test_what_a_motion_remembers_of_being_asked_is_no_part_of_it():
    """Else a run that was killed would not know its own checkpoint."""

    def bodies(motion):
        return still_setup(bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion),))

    for make in (Heave, lambda a: lru_cache(maxsize=2)(Heave(a))):
        asked, fresh = make(0.1), make(0.1)
        asked(0.3)
        assert fingerprint(bodies(asked)) == fingerprint(bodies(fresh))
        assert fingerprint(bodies(asked)) != fingerprint(bodies(make(0.2)))


OWN = {
    "class": """
from helper import double
from suchus import flow
class Motion:
    def __call__(self, time):
        return self.place({factor} * time)
    def place(self, way):
        return flow.Pose(position=(0.0, double(way)))
motion = Motion()
""",
    "dataclass": """
from dataclasses import dataclass
import helper
from suchus import flow
@dataclass(frozen=True)
class Motion:
    start: float = 0.0
    @property
    def rate(self):
        return helper.double(1.0)
    def __call__(self, time):
        return flow.Pose(position=(0.0, {factor} * self.rate * time))
motion = Motion()
""",
    "function": """
import helper
from suchus import flow
def motion(time):
    return flow.Pose(position=(0.0, {factor} * helper.Doubled()(time)))
""",
}
HELPER = """
def {other}(): pass
def double(x):
    return {times} * x
class Doubled:
    def __call__(self, x):
        return double(x)
"""


@pytest.mark.parametrize("how", OWN)
def test_a_motion_is_its_class_and_the_helpers_it_imports(how, tmp_path, monkeypatch):
    """Users keep motions in files of their own, and helpers in others."""
    monkeypatch.syspath_prepend(tmp_path)

    def body(number, times=2, factor=3, other="unused"):
        (tmp_path / "helper.py").write_text(HELPER.format(times=times, other=other))
        (tmp_path / f"own{number}.py").write_text(OWN[how].format(factor=factor))
        importlib.invalidate_caches()
        spec = importlib.util.spec_from_file_location("own", tmp_path / f"own{number}.py")
        own = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "own", own)
        sys.modules.pop("helper", None)
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        spec.loader.exec_module(own)
        return fingerprint(still_setup(bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0), motion=own.motion),)))

    monkeypatch.setitem(sys.modules, "helper", None)  # so that it is gone afterwards
    first = body(1)
    assert body(2) == first == body(3, other="renamed")
    assert len({first, body(4, factor=4), body(5, times=3)}) == 3


def test_many_functions_that_know_each_other_are_walked_once():
    """Each calls the two below; written out, a hundred million functions."""
    known = {"__name__": "levels"}
    exec("def f0(x): return x\ndef f1(x): return 2 * x", known)
    for k in range(2, 41):
        exec(f"def f{k}(x): return f{k - 1}(x) + f{k - 2}(x)", known)
    assert fingerprint(known["f40"]) != fingerprint(known["f39"])


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("checkpoint") / "state.npz"
    flow.Simulation(still_setup(step=0.05)).run(0.1, checkpoint=path, progress=False)
    return path


def test_a_run_does_not_go_on_with_another_body(saved):
    other = still_setup(step=0.05, bodies=(flow.Body(shape=flow.Cylinder(diameter=0.9)),))
    with pytest.raises(UnreadableFile, match="another setup"):
        flow.Simulation(other).run(0.2, checkpoint=saved, progress=False)


@given(st.data())
def test_a_flipped_bit_is_found_and_said(saved, data):
    whole = bytearray(saved.read_bytes())
    at = data.draw(st.integers(0, len(whole) - 1))
    whole[at] ^= 1 << data.draw(st.integers(0, 7))
    damaged = saved.with_name("damaged.npz")
    damaged.write_bytes(bytes(whole))
    with pytest.raises(UnreadableFile, match="not a checkpoint" if at < len(MARK) else "is damaged"):
        flow.Simulation(still_setup(step=0.05)).run(0.2, checkpoint=damaged, progress=False)


def test_a_file_cut_short_is_found_and_said(saved):
    damaged = saved.with_name("short.npz")
    damaged.write_bytes(saved.read_bytes()[:-1])
    with pytest.raises(UnreadableFile, match="is damaged"):
        flow.Simulation(still_setup(step=0.05)).run(0.2, checkpoint=damaged, progress=False)


def test_arrays_of_a_damaged_archive_are_as_they_were_or_refused(tmp_path):
    content = io.BytesIO()
    np.savez_compressed(content, a=np.arange(9.0), b=np.array("text"))
    whole, refused = content.getvalue(), 0
    for at in range(len(whole)):
        for bit in (0, 3, 6):
            damaged = whole[:at] + bytes([whole[at] ^ 1 << bit]) + whole[at + 1 :]
            try:
                found = arrays(damaged, tmp_path / "x.npz")
            except UnreadableFile:
                refused += 1
                continue
            sound = {"a": np.arange(9.0), "b": np.array("text")}  # a flipped count of arrays may hide one
            assert all(np.array_equal(values, sound[name]) for name, values in found.items())
    assert refused > len(whole)
    for other in (b"", b"x", whole[:40], b"\x93NUMPY" + bytes(40), pickle.dumps(1)):
        with pytest.raises(UnreadableFile, match="holds no arrays"):
            arrays(other, tmp_path / "x.npz")
