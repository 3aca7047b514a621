"""``suchus page``: one file with everything in it, or a sentence."""

import gzip
import json
import re
import subprocess
from base64 import b64decode

import pytest
from tests.laboratory.page_modules import NODE, needs_engine, needs_node
from tests.model.hinge_trees import quadruped

from suchus.apps.cli import main
from suchus.apps.laboratory import engine, page
from suchus.apps.laboratory.engine import BINARY, INTEGRITY, SCRIPT, Engine, NoEngine, read_engine, unpack_engine
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export import mjcf

TOY = Engine("var loadMujoco = 1;\nexport default loadMujoco;\n", b"\x1f\x8b")


@pytest.fixture
def toy(monkeypatch):
    monkeypatch.setattr(page, "read_engine", lambda: TOY)


def part(text, name):
    return re.search(rf'<script id="{name}"[^>]*>(.*?)</script>', text, re.S).group(1)


def test_the_file_holds_model_gait_sliders_and_engine(toy, tmp_path, capsys):
    out = tmp_path / "walk.html"
    assert main(["page", "strider", "--out", str(out)]) == 0
    assert "strider, tripod" in capsys.readouterr().out
    text = out.read_text()
    facts = json.loads(part(text, "facts"))
    robot = ROBOTS["strider"]
    assert facts["files"]["strider.xml"] == mjcf(robot, default_gait(robot), timestep=0.002)[0]
    assert facts["knobs"]["stroke"]["unit"] == "% of reach"
    assert facts["settings"]["level"] is None
    assert b64decode(part(text, "engine-binary")) == TOY.binary
    assert "export " not in part(text, "meta")
    assert re.findall(r'(?:src|href)="(?!#|data:)[^"]+"', text) == []  # nothing is fetched


def test_what_swims_begins_in_water_and_a_walker_may(toy):
    swimmer, caiman = ROBOTS["swimmer"], ROBOTS["caiman"]
    made = json.loads(part(page.laboratory_page(swimmer, GAITS["undulation"]), "facts"))
    assert made["settings"]["level"] == pytest.approx(0.5 * swimmer.length, abs=1e-3)
    assert made["physics"]["control"] == {"begin": 0.0, "ramp": 1.0}
    made = json.loads(part(page.laboratory_page(caiman, GAITS["belly_crawl"], level=0.05), "facts"))
    assert made["settings"]["level"] == 0.05
    assert made["physics"]["control"] == {"begin": 1.0, "ramp": 0.0}


def test_a_body_whose_axis_cannot_bend_is_compared_with_its_first_numbers(toy, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "dog.urdf").write_text(quadruped())
    assert main(["page", "dog.urdf"]) == 0
    text = (tmp_path / "dog.html").read_text()
    assert json.loads(part(text, "facts"))["reference"] == "first"
    assert '<th scope="col">first numbers</th>' in text
    assert "keeps the first numbers" in text
    assert "axis still" not in text.partition("<script")[0]
    assert "<code>suchus page dog.urdf my_gait.toml</code> begins with it" in text


def test_a_body_without_limbs_has_no_words_of_feet(toy):
    swimmer = page.laboratory_page(ROBOTS["swimmer"], GAITS["undulation"])
    caiman = page.laboratory_page(ROBOTS["caiman"], GAITS["belly_crawl"])
    for words in ("duty factors", "support by feet and tail", "A thick track is a foot"):
        assert words in caiman
        assert words not in swimmer
    assert "suchus run displacement --robot caiman --gait my_gait.toml" in caiman
    assert "suchus run displacement --robot" not in swimmer


@needs_node
def test_the_modules_make_one_program_in_which_no_name_stands_twice(tmp_path):
    program = page.program()
    assert not re.search(r"^(import|export) ", program, re.M)
    file = tmp_path / "program.mjs"
    file.write_text(program)
    subprocess.run([NODE, "--check", str(file)], check=True, capture_output=True)
    file.write_text(program + "\nfunction modulo() {}\n")  # such a clash is found
    assert subprocess.run([NODE, "--check", str(file)], check=False, capture_output=True).returncode == 1


@needs_engine
def test_the_page_with_its_engine_is_smaller_than_five_megabytes():
    assert 3_000_000 < len(page.laboratory_page(ROBOTS["caiman"], GAITS["belly_crawl"])) < page.MAX_SIZE


def refusal(capsys, *words):
    assert main(["page", *words]) == 2
    return " ".join(capsys.readouterr().err.split())


def test_bad_input_gets_a_sentence(toy, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert "'caimann'" in refusal(capsys, "caimann")
    assert "tripod" in refusal(capsys, "caiman", "tripod")
    assert "0 to 10.1 m" in refusal(capsys, "caiman", "--water", "-1")
    assert "there is no robot named ''" in refusal(capsys, "")
    assert "there is no gait named ''" in refusal(capsys, "caiman", "")
    for level in ("nan", "inf", "-inf", "1e9"):
        assert "0 to 10.1 m" in refusal(capsys, "caiman", "--water", level)
    assert "the page would be walk.txt" in refusal(capsys, "caiman", "--out", "walk.txt")
    assert list(tmp_path.iterdir()) == []


def test_without_an_engine_the_remedy_is_said_and_nothing_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(engine, "engine_folders", lambda: [tmp_path / "nowhere"])
    assert "run make page" in refusal(capsys, "strider")
    assert list(tmp_path.iterdir()) == []


def test_another_engine_is_refused(tmp_path, monkeypatch):
    (tmp_path / SCRIPT).write_text("export default 1")
    (tmp_path / BINARY).write_bytes(gzip.compress(b"\0asm"))
    monkeypatch.setattr(engine, "engine_folders", lambda: [tmp_path])
    with pytest.raises(NoEngine, match="is not that of @mujoco/mujoco"):
        read_engine()
    with pytest.raises(NoEngine, match=re.escape(INTEGRITY)):
        unpack_engine(b"another package", tmp_path / "new")
    assert not (tmp_path / "new").exists()
