"""Old names of fields go on working for one release, in code, files, paths and commands, and say the new name."""

import warnings
from dataclasses import asdict, dataclass, fields, replace
from importlib import import_module
from operator import attrgetter

import numpy as np
import pytest
import xarray as xr

from suchus import flow
from suchus.blueprint import read
from suchus.cli.entry import main
from suchus.cli.options import choose
from suchus.design import value_at, with_values
from suchus.design.chosen import unit_at
from suchus.errors import OldKey, OldName, SuchusError
from suchus.experiments import EXPERIMENTS
from suchus.land import Ground, Run
from suchus.motion import Swim
from suchus.optimise.page import EXAMPLE as SEARCH
from suchus.optimise.page import SearchFile
from suchus.record import ground_of, ground_text
from suchus.renamed import modern, names_of, old_names
from suchus.study.page import EXAMPLE as STUDY
from suchus.study.page import StudyFile


@old_names(breadth="width")
@dataclass(frozen=True, slots=True, kw_only=True)
class Door:
    width: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class House:
    doors: tuple[Door, ...] = ()
    back: Door | None = None


def test_a_value_is_made_by_the_old_name_and_says_the_new_one():
    with pytest.warns(OldName, match=r"Door\.breadth is now called width") as caught:
        assert Door(breadth=2.0) == Door(width=2.0)
    assert caught[0].filename == __file__


def test_it_is_read_by_the_old_name():
    with pytest.warns(OldName, match="width") as caught:
        assert Door(width=3.0).breadth == 3.0
    assert caught[0].filename == __file__


def test_the_new_name_is_silent_and_the_only_field():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        door = replace(Door(), width=4.0)
    assert asdict(door) == {"width": 4.0}
    assert [field.name for field in fields(Door)] == ["width"]


def test_replace_by_the_old_name_changes_the_field():
    with pytest.warns(OldName):
        assert replace(Door(width=1.0), breadth=5.0).width == 5.0


def test_a_file_is_brought_up_to_date_at_any_depth():
    with pytest.warns(OldKey) as caught:
        today = modern({"doors": [{"breadth": 1.0}, {"width": 2.0}], "back": {"breadth": 3.0}}, House)
    assert today == {"doors": [{"width": 1.0}, {"width": 2.0}], "back": {"width": 3.0}}
    assert len(caught) == 2


def test_what_was_never_a_name_stays_a_mistake():
    assert modern({"doors": [{"depth": 1.0}]}, House) == {"doors": [{"depth": 1.0}]}
    with pytest.raises(TypeError, match="depth"):
        Door(depth=1.0)


def test_a_study_and_a_search_with_the_old_keys_still_load(tmp_path):
    text = '[[vary]]\nfield = "gait.stroke"\nlow = 0.01\nhigh = 0.02\nsteps = 3\n'
    study, search = tmp_path / "study.toml", tmp_path / "search.toml"
    study.write_text(f'measure = ["displacement"]\nground = {{grip = 0.5}}\n{text}')
    search.write_text(f'grips = [0.5, 1.0]\naims = [{{name = "displacement"}}]\n{text}')
    with pytest.warns(OldKey, match=r"Ground\.grip is now called friction_scale"):
        assert read(study, StudyFile, {"example": STUDY}).ground == Ground(friction_scale=0.5)
    with pytest.warns(OldKey, match="friction_scales"):
        assert read(search, SearchFile, {"example": SEARCH}).friction_scales == (0.5, 1.0)


def test_a_dotted_path_of_before_finds_the_field(robot, crawl_gait):
    run = Run(robot=robot, gait=crawl_gait)
    with pytest.warns(OldKey):
        assert with_values(run, {"ground.grip": 0.5}).ground.friction_scale == 0.5
    with pytest.warns(OldKey):
        assert value_at(run, "ground.grip") == 1.0
    with pytest.warns(OldKey):
        assert unit_at(run, "ground.grip") == unit_at(run, "ground.friction_scale") == "-"


def test_a_command_takes_the_old_option():
    with pytest.warns(OldKey, match=r"Displacement\.grip_spread is now called friction_spread"):
        chosen = choose(EXPERIMENTS["displacement"], "displacement", ["--grip-spread", "0.3"])
    assert chosen.experiment.friction_spread == 0.3
    with pytest.raises(SuchusError, match="--slip-spread"):
        choose(EXPERIMENTS["displacement"], "displacement", ["--slip-spread", "0.3"])


def test_the_command_line_says_it_in_one_sentence(capsys):
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        assert main(["run", "displacement", "--grip-spread", "much"]) == 2
    err = capsys.readouterr().err
    assert "suchus: Displacement.grip_spread is now called friction_spread;" in err
    assert ".py:" not in err


def test_a_side_and_a_midline_of_the_flow_take_their_old_names():
    with pytest.warns(OldName, match=r"Stream\.endless is now called unbounded"):
        assert flow.Stream(endless=False) == flow.Stream(unbounded=False)
    spine = flow.eel(1.0, stations=33).spine(0.0)
    with pytest.warns(OldName, match=r"Spine\.blunted is now called thickened"):
        blunted = spine.blunted(0.01)
    assert np.array_equal(blunted.half_width, spine.thickened(0.01).half_width)


def test_records_keep_their_key_in_both_directions():
    ground = Ground(friction_scale=0.5)
    assert '"grip": 0.5' in ground_text(ground)
    assert ground_of(xr.Dataset({"stands_on": ((), ground_text(ground))})) == ground


@pytest.mark.parametrize("kind", [Ground, Swim, SearchFile, *(type(EXPERIMENTS[n]) for n in ("displacement",))])
def test_every_new_name_is_a_field_and_no_old_one_is(kind):
    there = {field.name for field in fields(kind)}
    assert set(names_of(kind).values()) <= there
    assert names_of(kind)
    assert not set(names_of(kind)) & there


@pytest.mark.parametrize(
    ("room", "old", "new"),
    [
        ("capture", "Animal", "SyntheticAnimal"), ("capture", "Reading", "ReadingOptions"),
        ("capture", "told", "summary"), ("optimise", "Found", "SearchResult"),
        ("control", "Oscillation", "OscillatorStates"), ("hardware", "Load", "ServoLoad"),
        ("land", "lost", "joint_failure"), ("land", "lost_joints", "failing_joints"), ("land", "LOST", "FAILED_JOINTS"),
        ("kinematics", "Wave", "TravellingWave"), ("metrics", "Border", "decisive.DecisionBoundary"),
        ("metrics", "border", "decisive.border"), ("metrics", "rank_correlation", "decisive.rank_correlation"),
        ("motion", "with_late_axis", "with_axis_lag"), ("optimise", "Told", "SearchProgress"),
        ("robots", "Beside", "RelativeSize"), ("study", "Told", "StudyProgress"),
        ("study", "write_claims", "claims_page.write_claims"),
        ("water", "Curve", "MidlineCurve"), ("water", "Silhouette", "BodySilhouette"),
    ],
)  # fmt: skip
def test_a_room_gives_what_it_exports_by_the_old_name(room, old, new):
    package = import_module(f"suchus.{room}")
    with pytest.warns(OldName, match=f"{old} is now called {new}") as caught:
        found = getattr(package, old)
    assert found is attrgetter(new)(package)
    assert caught[0].filename == __file__
    with pytest.raises(AttributeError, match="nothing_of_the_kind"):
        package.nothing_of_the_kind  # noqa: B018
