"""Films and replays stand beside the page; the robot shown is the one that was run; the animal stands beside ours."""

import json
from dataclasses import replace

import numpy as np
import pytest

from suchus.apps.report import load_result, render_outcome_page, render_page, write_outcome_page, write_page
from suchus.apps.report.beside import compare_with_animals
from suchus.apps.report.page import robot_of
from suchus.article.paper.animals import ANIMALS
from suchus.core.files import plain
from suchus.robot.design import crocodile, layout
from suchus.robot.kinematics import landmarks
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned, panels, save

CAIMAN = ROBOTS["caiman"]
OUTCOME = {
    "title": "How?",
    "shows": "Fig. 16",
    "decides": "This. That decides it all, and it takes quite a while to say why it does. More.",
    "command": "suchus run displacement",
    "measures": {
        "forward_coordinated": {"value": 0.8, "unit": "m"},
        "forward_limbs_only": {"value": 0.2, "unit": "m"},
    },
    "verdicts": [],
    "tables": [],
    "provenance": {"seconds": 1.0, "config_hash": "0" * 64, "seed": 1},
}


@pytest.fixture
def make(tmp_path):
    def make(name, robot=CAIMAN, **more):
        folder = tmp_path / "out" / name
        folder.mkdir(parents=True)
        save(captioned(panels()[0], "A drawing of it."), folder, "still")
        told = OUTCOME | {"experiment": name, "figures": [{"name": "still", "caption": "A drawing of it."}], **more}
        told["settings"] = {} if robot is None else {"robot": plain(robot)}
        (folder / "outcome.json").write_text(json.dumps(told))
        return folder

    return make


def test_the_report_plays_one_replay_and_the_page_of_each_outcome_holds_its_own(make, tmp_path):
    clips = {
        "films": [{"name": "swim 1.gif", "caption": "It swims."}],
        "replays": [{"name": "a.html", "caption": "It goes."}, {"name": "b.html", "caption": "It goes on."}],
    }
    folders = [make(name, **clips) for name in ("displacement", "turning")]
    for folder in folders:
        (folder / "a.html").write_text('<p>replay "a"</p>')
        (folder / "b.html").write_text("<p>replay b</p>")
        (folder / "swim 1.gif").write_bytes(b"GIF89a")
    page = write_page([load_result(folder) for folder in folders], [], tmp_path / "out" / "report.html").read_text()
    assert page.count("<iframe") == 1
    assert '<iframe src="displacement/a.html" title="It goes." loading="lazy">' in page
    for folder in folders:
        assert f'href="{folder.name}/index.html"' in page
        own = (folder / "index.html").read_text()
        assert 'srcdoc="&lt;p&gt;replay &#34;a&#34;&lt;/p&gt;"' in own
        assert 'href="a.html"' not in own
        assert 'href="b.html"' in own
        assert 'href="swim%201.gif"' in own


def test_a_replay_that_is_too_heavy_to_travel_is_linked(make):
    folder = make("displacement", replays=[{"name": "a.html", "caption": "It goes."}])
    (folder / "a.html").write_text(f"<p>{3 * 2**20 * 'x'}</p>")
    own = write_outcome_page(folder).read_text()
    assert "<iframe" not in own
    assert 'href="a.html"' in own


def test_links_lead_from_the_page_wherever_it_stands(make, tmp_path):
    folder = make("displacement", replays=[{"name": "a.html", "caption": "It goes."}])
    (folder / "a.html").write_text("<p>replay</p>")
    elsewhere = tmp_path / "pages" / "deep"
    elsewhere.mkdir(parents=True)
    page = write_page([load_result(folder)], [], elsewhere / "page.html").read_text()
    assert 'href="../../out/displacement/a.html"' in page
    assert (elsewhere / "../../out/displacement/a.html").exists()


def test_what_is_not_there_is_not_linked_and_a_picture_stands_for_it(make):
    result = load_result(make("displacement", replays=[{"name": "gone.html", "caption": "It goes."}]))
    page = render_page([result], [])
    assert "gone.html" not in page
    assert "<iframe" not in page
    own = render_outcome_page(result)
    assert "gone.html" not in own
    assert own.count("A drawing of it.") == 2  # its text and its caption


def test_a_replay_cannot_point_out_of_its_folder(make):
    with pytest.raises(Exception, match="no file of its folder"):
        load_result(make("displacement", replays=[{"name": "../../x.html", "caption": "It goes."}]))


def test_the_page_shows_the_robot_that_was_run(make):
    other = crocodile(replace(CAIMAN.tables, name="stranger", head=replace(CAIMAN.tables.head, snout=0.4)))
    results = [load_result(make(name, robot)) for name, robot in zip("abc", (other, CAIMAN, other), strict=True)]
    robot, others = robot_of(results)
    assert robot == other
    assert others == {"caiman": 1}
    page = render_page(results, [])
    assert "The robot stranger from above" in page
    assert "caiman (1)" in page


@pytest.mark.parametrize("robot", [None, "caiman", {"name": "of another version"}])
def test_without_a_robot_that_can_be_built_the_articles_is_shown(make, robot):
    folder = make("displacement", None)
    told = json.loads((folder / "outcome.json").read_text())
    told["settings"] = {"robot": robot}
    (folder / "outcome.json").write_text(json.dumps(told))
    assert robot_of([load_result(folder)]) == (CAIMAN, {})


def test_article_ours_and_animal_stand_side_by_side(make):
    results = {"displacement": load_result(make("displacement"))}
    rows = {row.animal.key: row for row in compare_with_animals(CAIMAN, results)}
    assert set(rows) == {"tail_length", "tail_mass", "mass", "speed", "stride_share"}
    assert (rows["speed"].robot_text, rows["speed"].article, rows["speed"].animal_text) == (
        "0.1 m/s",
        "0.091 m/s",
        "0.15 to 4.35 m/s",
    )
    assert rows["stride_share"].robot_text == "0.75"
    assert rows["tail_mass"].article == ""
    page = render_page(list(results.values()), [])
    for row in rows.values():
        assert row.animal.source.split("&")[0] in page


@pytest.mark.parametrize("name", ["caiman", "salamander", "pleurobot"])
def test_the_tail_of_any_body_stands_beside_the_animals(name):
    robot = ROBOTS[name]
    rows = {row.animal.key: row for row in compare_with_animals(robot, {})}
    marks = landmarks(robot, np.zeros(len(layout(robot).hinges)))
    behind = marks.feet[-1, 0] - marks.tail[0]  # a leg stands straight out from its hip
    mass = sum(shape.mass for part in robot.axis if part.name.startswith("tail") for shape in part.shapes)
    told = [float(rows[key].robot_text.split()[0]) for key in ("tail_length", "tail_mass")]
    assert told == pytest.approx([behind / robot.length, mass / robot.mass], abs=0.006)


@pytest.mark.parametrize("name", ["strider", "swimmer"])
def test_who_has_no_tail_or_no_hips_has_none_beside_the_animals(name):
    assert not {"tail_length", "tail_mass"} & {row.animal.key for row in compare_with_animals(ROBOTS[name], {})}


def test_every_number_of_an_animal_has_a_source_and_a_range():
    for animal in ANIMALS:
        assert animal.low <= animal.high
        assert any(char.isdigit() for char in animal.source)


def test_the_summary_says_enough_of_what_decides(make):
    page = render_page([load_result(make("displacement"))], [])
    assert '<td class="why">This. That decides it all, and it takes quite a while to say why it does.</td>' in page


def test_a_page_leads_with_two_sentences_and_has_a_column_of_intervals_where_there_are_some(make):
    own = write_outcome_page(make("displacement")).read_text()
    lead = '<p class="lead">This. That decides it all, and it takes quite a while to say why it does.</p>'
    assert lead in own.partition("</header>")[0]
    assert '<ul class="detail">\n<li>More.</li>\n</ul>' in own.partition("</header>")[2]
    assert "Interval" not in own
    speed = {"speed": 0.8, "speed_low": 0.7, "speed_high": 0.9, "way": 1.0}
    measures = {name: {"value": value, "unit": "m/s"} for name, value in speed.items()}
    own = write_outcome_page(make("turning", measures=measures, decides="It goes.")).read_text()
    assert own.count('<th scope="col">Interval</th>') == own.count('data-label="Interval"') == 1
    assert 'class="detail"' not in own


def test_only_what_is_on_the_shelf_is_said_to_be_run_by_its_name(make):
    shelf, other = (write_outcome_page(make(name)).read_text() for name in ("displacement", "drive_wave"))
    for said in ("suchus run displacement --help", "suchus.EXPERIMENTS[&#34;displacement&#34;]"):
        assert said in shelf or said.replace("&#34;", '"') in shelf
    assert "Run it again" in other
    for said in ("--help", "suchus.EXPERIMENTS", "in the catalog"):
        assert said not in other
