import pytest

from suchus.apps.cli import main
from suchus.core.errors import SuchusError
from suchus.experiments.study import read_study
from suchus.experiments.study.chunk import label_of
from suchus.experiments.study.plan import Plan
from suchus.robot.design import unit_at
from suchus.sim.land import Backlash, Limp, LostFoot, Offset, Slow, Weak

PAGE = """
name = "grip"
duration = 1.1
measure = ["displacement"]

[[vary]]
field = "ground.friction_scale"
values = [0.5, 1.0]

[[vary]]
field = "gait.height"
values = [0.51, 1.7]
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "grip.toml").write_text(PAGE)


def test_a_study_says_where_its_results_are_and_what_failed(tmp_path, capsys):
    assert main(["study", "grip.toml"]) == 0
    out, err = capsys.readouterr()
    assert "4 runs, 2 failed: out/studies/grip/results.nc" in out
    assert "the first that failed is sample 1: OutsideLimits: gait 'belly_crawl'" in out
    assert err == ""
    before = (tmp_path / "out" / "studies" / "grip" / "results.nc").stat().st_mtime_ns
    assert main(["study", "grip.toml", "--csv"]) == 0
    assert (tmp_path / "out" / "studies" / "grip" / "results.csv").is_file()
    header = (tmp_path / "out" / "studies" / "grip" / "csv" / "sample.csv").read_text().splitlines()[0].split(",")
    assert header[:3] == ["sample", "ground.friction_scale", "gait.height [reach of its limb]"]
    assert (tmp_path / "out" / "studies" / "grip" / "results.nc").stat().st_mtime_ns >= before


BAD = {
    ("ground.friction_scale", "ground.friction_skale"): "Did you mean 'friction_scale'?",
    (
        "[0.5, 1.0]",
        "[0.5, 100.0]",
    ): "but ground.friction_scale is 100; 0.01 to 10 is allowed",
    ("[0.5, 1.0]", '["much"]'): "varies ground.friction_scale, but ground.friction_scale is 'much'",
    ("field =", "feild ="): "did you mean vary[0].field?",
    ("duration = 1.1", "duration = -1.0"): "1.1 to 86400 s is allowed",
    ('"displacement"', '"displacment"'): "Did you mean 'displacement'?",
    ('name = "grip"', 'robot = "kaiman"'): "Did you mean 'caiman'?",
    ('name = "grip"', 'design = "sobol"'): "samples is missing",
    ('name = "grip"', 'name = "a/b"'): "say --out DIR",
    ("[[vary]]", "[[vary]"): "is not valid TOML",
}


@pytest.mark.parametrize("change", BAD)
def test_a_bad_file_is_one_sentence_and_leaves_nothing(change, tmp_path, capsys):
    (tmp_path / "grip.toml").write_text(PAGE.replace(*change, 1))
    assert main(["study", "grip.toml"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert BAD[change] in err
    assert [p.name for p in tmp_path.iterdir()] == ["grip.toml"]


def test_bad_places_are_one_sentence(tmp_path, capsys):
    for words, said in (
        ("none.toml", "there is no file none.toml"),
        ("grip.toml --out /dev/null/here", "cannot be written"),
        ("grip.toml --out .", "holds no study"),
        ("grip.toml --finished", "--finished is for claims only"),
        ("grip.toml --only terrain", "--only is for claims only"),
        (
            "claims --only terain --out nowhere",
            "terain cannot be asked again; those that can are bipedal_reach, ",
        ),
        ("claims --finished --only terrain --out nowhere", "nowhere holds too few points"),
        ("claims --finished --out nowhere", "nowhere/compared_2ms holds no study; start it first"),
    ):
        assert main(["study", *words.split()]) == 2
        err = capsys.readouterr().err
        assert said in err
        assert err.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["grip.toml"]


def test_robots_gaits_and_faults_are_named_or_described(tmp_path):
    (tmp_path / "mine.toml").write_text('base = "belly_crawl"\nstroke = 0.01\n')
    (tmp_path / "s.toml").write_text("""
measure = ["slip"]
[[faults]]
kind = "weak"
joint = "LH_knee"
fraction = 0.25
[[vary]]
field = "gait"
values = ["limbs_only", "mine.toml"]
[[vary]]
field = "robot.contact.foot_friction"
low = 0.4
high = 0.8
steps = 2
""")
    asked = read_study(tmp_path / "s.toml")
    assert asked.name == "s"
    assert asked.run.faults == (Weak("LH_knee", 0.25),)
    assert [g.limbs[0].stroke * 0.1575 for g in asked.vary[0].values] == pytest.approx([0.027, 0.01])
    (tmp_path / "f.toml").write_text("""
measure = ["slip"]
[[vary]]
field = "faults"
values = [[], [{kind = "limp", joint = "LF_yaw", at = 1.0}]]
""")
    assert read_study(tmp_path / "f.toml").vary[0].values == ((), (Limp("LF_yaw", 1.0),))


def test_every_fault_of_the_shelf_can_stand_in_a_file_and_its_numbers_vary_with_their_units(tmp_path):
    (tmp_path / "s.toml").write_text("""
measure = ["slip"]
[[faults]]
kind = "slow"
joint = "LH_knee"
speed = 2
[[faults]]
kind = "lost_foot"
limb = "LF"
at = 1.0
[[vary]]
field = "faults[0].speed"
low = 0.5
high = 4.0
steps = 2
""")
    asked = read_study(tmp_path / "s.toml")
    assert asked.run.faults == (Slow("LH_knee", 2), LostFoot("LF", 1.0))
    assert unit_at(asked.run, "faults[0].speed") == "rad/s"
    assert Plan(asked).run(1).faults[0] == Slow("LH_knee", 4.0)
    (tmp_path / "f.toml").write_text("""
measure = ["slip"]
[[vary]]
field = "faults"
values = [[], [{kind = "backlash", joint = "LF_yaw", gap = 0.2}, {kind = "offset", joint = "RF_yaw"}]]
""")
    varied = read_study(tmp_path / "f.toml").vary[0].values
    assert varied == ((), (Backlash("LF_yaw", 0.2), Offset("RF_yaw")))
    assert [label_of(value) for value in varied] == ["none", "backlash LF_yaw + offset RF_yaw"]
    page = 'measure = ["slip"]\nfaults = [{kind = "%s"}]\n[[vary]]\nfield = "noise"\nvalues = [0.0]\n'
    (tmp_path / "g.toml").write_text(page % ("x" * 9000))
    with pytest.raises(SuchusError, match="there is no fault named 'xxx") as caught:
        read_study(tmp_path / "g.toml")
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ('[{kind = "limpp", joint = "LF_yaw"}]', "Did you mean 'limp'"),
        ('["limp LF_yaw"]', "lists of tables"),
        (
            '[{kind = "limp", joint = "LF_yaw", angle = 1.0}]',
            "no field of the fault limp named 'angle'",
        ),
    ],
)
def test_a_fault_that_is_none_is_refused(fault, said, tmp_path):
    page = f'measure = ["slip"]\n[[vary]]\nfield = "faults"\nvalues = [{fault}]\n'
    (tmp_path / "f.toml").write_text(page)
    with pytest.raises(SuchusError, match=said):
        read_study(tmp_path / "f.toml")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--jobs", "0"], "--jobs is 0; at least 1 process is needed"),
        (["--jobs", "2", "--scheduler", "tcp://127.0.0.1:1"], "--jobs and --scheduler exclude each other"),
    ],
)
def test_processes_that_cannot_be_are_refused(words, said, tmp_path, capsys):
    for study in ("grip.toml", "claims"):
        assert main(["study", study, *words]) == 2
        assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
