import base64
import json
import re
import shutil
from dataclasses import asdict, dataclass, replace
from html.parser import HTMLParser
from types import SimpleNamespace

import pytest
import xarray as xr

from suchus.apps.report import Failure, load_result, number, quantity, render_outcome_page, render_page, save_outcome
from suchus.apps.report.page import _place
from suchus.apps.report.saving import changed_settings
from suchus.article.paper import CLAIMS, ERRATA
from suchus.article.verdict import Rule, Verdict
from suchus.core import files as record
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import count_evidence
from suchus.experiments.experiment import Experiment, Measure, Outcome, silent
from suchus.robot.design import with_values
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned, panels, styled


def said(key, measured, why, word):
    """A verdict that was put in."""
    rule = Rule(claim=key, experiment="question", measure="way", why=why)
    return Verdict(
        claim=CLAIMS[key], rule=rule, measured=measured, low=None, high=None, verdict=word, why=why, share=None
    )


@dataclass(frozen=True)
class Question(Experiment):
    title = "Is <everything> escaped & told?"
    shows = "Fig. 16"

    def run(self, progress=silent):
        return Outcome(
            experiment="question",
            measures={"way": Measure(-0.5, "m"), "turn": Measure(1.0, "rad"), "ghost": Measure(float("inf"), "m")},
            verdicts=(
                said("displacement_coordinated", 0.5, 'It was "put in" <i>by hand</i>.', "same sense"),
                said("cycle_count", 2, "Two.", "reproduced"),
                said("com_fluctuation", None, "Nobody looked.", "not testable"),
            ),
            decides="What is put in.",
            record=xr.Dataset({"x": ("time", [0.0, 1.0])}),
            settings={"seed": 1},
            tables={"rows.txt": "a < b\n"},
        )

    def simulate(self, progress=silent):
        raise NotImplementedError  # its outcome is put in

    measure = explain = simulate

    def draw(self, outcome):
        figures = {}
        for name in ("first", "second"):
            with styled():
                figure, axes = panels()
                axes[0, 0].fill_between([0, 1], outcome.record.x)
            figures[name] = captioned(figure, f'The "{name}" figure & its <clip>.')
        return figures

    def quick(self):
        return self


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    question, tmp_path = Question(), tmp_path_factory.mktemp("results")
    outcome = question.run()
    folder = save_outcome(
        outcome, question.draw(outcome), question, str(tmp_path / "question"), command="suchus run question"
    )
    return load_result(folder)


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.text = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text.append(data)

    def all(self, *names):
        return [attrs for tag, attrs in self.tags if tag in names]


@pytest.fixture(scope="module")
def page(result):
    failure = Failure(name="other_question", sentence="It <broke>.", trace="Traceback ...")
    return Page(render_page([result], [failure]))


@pytest.fixture(scope="module")
def own(result):
    return Page(render_outcome_page(result))


@pytest.fixture(params=["report", "outcome"])
def either(request, page, own):
    return page if request.param == "report" else own


def test_the_pages_ask_nothing_of_the_network_and_run_no_script(either):
    for _, attrs in either.tags:
        for name in ("src", "href", "srcset", "data", "poster", "action"):
            assert attrs.get(name, "#").startswith(("#", "data:", "question/index.html"))
    assert either.all("script", "iframe", "object", "embed") == []
    assert not re.search(r"url\(|@import", "".join(either.text))


def test_every_picture_tells_its_caption_to_those_who_cannot_see_it(own, page):
    assert all(len(image["alt"]) > 10 for image in page.all("img"))
    images = own.all("img")
    assert [image["alt"] for image in images if image["alt"].startswith('The "')] == [
        'The "first" figure & its <clip>.',
        'The "second" figure & its <clip>.',
    ]
    assert all(len(image["alt"]) > 10 for image in images)


def test_identifiers_are_unique_and_every_link_arrives(page):
    ids = [attrs["id"] for _, attrs in page.tags if "id" in attrs]
    assert len(ids) == len(set(ids))
    links = {a["href"] for a in page.all("a")}
    assert {link[1:] for link in links if link.startswith("#")} <= set(ids)
    assert {link for link in links if not link.startswith("#")} == {"question/index.html"}


def test_the_first_link_of_the_report_leads_to_its_verdicts(page):
    assert page.all("a")[0] == {"class": "skip", "href": "#verdicts"}


def test_both_pages_can_be_read_without_sight_and_by_keyboard(either):
    assert either.all("html") == [{"lang": "en"}]
    assert all("scope" in heading for heading in either.all("th"))
    assert len(either.all("h1")) == 1
    labelled = [attrs for attrs in either.all("div") if attrs.get("role") == "region"]
    assert all(attrs.get("aria-label") and attrs.get("tabindex") == "0" for attrs in labelled)
    ids = [attrs["id"] for _, attrs in either.tags if "id" in attrs]
    assert len(ids) == len(set(ids))


def test_the_verdicts_stand_first_and_in_the_order_of_the_article(page):
    text = " ".join(" ".join(page.text).split())
    assert text.index("Verdicts") < text.index("Is <everything>")
    every = text[text.index("in the order of the article") :]  # the headline before it says some of them too
    places = [every.index(why) for why in ("Two.", "Nobody looked.", 'It was "put in" <i>by hand</i>.')]
    assert places == sorted(places)
    for said in ("0.73 m", "0.5 m", "same sense", "reproduced", "not testable", "IV.B"):
        assert said in text


@pytest.mark.parametrize(("claims", "place"), [(("a", "c"), 2), (("b",), 1), ((), 3)])
def test_a_result_stands_where_the_article_comes_to_its_last_claim(claims, place):
    result = SimpleNamespace(outcome={"verdicts": [{"claim": claim} for claim in claims]})
    assert _place(result, {"a": 0, "b": 1, "c": 2}) == place


def test_the_page_tells_everything_that_it_promises(page):
    text = " ".join(" ".join(page.text).split())
    robot = ROBOTS["caiman"]
    for said in (
        "What is put in.",
        "It <broke>.",
        "Traceback ...",
        quantity(robot.hind_leg.femur, "m"),
        "Length from hip to knee, the table's a2.",
        *(m.shows.split("  ")[0] for m in ERRATA.values()),
        *(chosen.why for chosen in ROBOTS.beside("caiman", "chosen", ())),
        *(chosen.why for name in GAITS for chosen in GAITS.beside(name, "chosen", ())),
    ):
        assert " ".join(said.split()) in text


def test_the_page_of_an_outcome_tells_answer_numbers_verdicts_settings_and_data(own):
    text = " ".join(" ".join(own.text).split())
    for said in (
        "Is <everything> escaped & told?",
        "What is put in.",
        "−0.5 m",
        "1 rad (57.3°)",
        "not finite",
        'It was "put in" <i>by hand</i>.',
        "a < b",
        "suchus run question",
        "All are the defaults.",
    ):
        assert said in text
    assert text.index("What is put in.") < text.index("−0.5 m") < text.index("by hand") < text.index("not finite")
    saved = {a["download"]: a["href"] for a in own.all("a") if "download" in a}
    assert {"numbers.csv", "first.data.csv", "second.data.csv", "rows.txt"} == set(saved)
    numbers = base64.b64decode(saved["numbers.csv"].partition(",")[2]).decode()
    assert numbers.splitlines() == ["measure,value,unit,time_step", "way,-0.5,m,", "turn,1.0,rad,", "ghost,,m,"]


def test_settings_that_differ_from_the_shelf_stand_on_the_page():
    question = replace(EXPERIMENTS["displacement"], cycles=3, gait=GAITS["high_walk"], bends=(0.0, 1.0))
    rows = {row["name"]: (row["value"], row["shelf"]) for row in changed_settings(question)}
    assert set(rows) == {"cycles", "gait", "bends"}
    assert rows["cycles"] == ("3", "2")
    assert rows["gait"] == ("high_walk", "belly_crawl")
    assert rows["bends"][0] == "0, 1"
    heavier = with_values(ROBOTS["caiman"], {"pelvis.mass": 1.0})
    assert changed_settings(replace(EXPERIMENTS["displacement"], robot=heavier))[0]["value"] == "another caiman"
    assert changed_settings(EXPERIMENTS["displacement"]) == []


def test_a_run_that_was_cut_short_says_so_and_has_no_verdicts(result, tmp_path):
    question = Question()
    outcome = replace(question.run(), verdicts=(), unjudged="Not judged: repeats is 2, and 8 at least are needed.")
    place = tmp_path / "again" / "question"
    save_outcome(outcome, question.draw(outcome), question, place, command="suchus run question --quick")
    short = render_page([load_result(place)], [])
    assert short.count("Not judged: repeats is 2, and 8 at least are needed.") == 1
    assert "not judged" in short
    assert "0 verdicts" in short
    assert "Not judged" not in render_page([result], [])


def test_a_page_without_results_is_still_a_page():
    page = Page(render_page([], []))
    assert "No claim was tested." in page.text


def test_a_folder_that_holds_no_outcome_is_refused(result, tmp_path):
    with pytest.raises(UnreadableFile, match="there is no file"):
        load_result(tmp_path)
    (tmp_path / "outcome.json").write_text('{"figures": [], "tables": []}')
    with pytest.raises(IncompatibleRecord, match="lacks experiment"):
        load_result(tmp_path)
    (tmp_path / "outcome.json").write_text(json.dumps({**result.outcome, "figures": [], "tables": ["../secret"]}))
    with pytest.raises(IncompatibleRecord, match="no file of its folder"):
        load_result(tmp_path)
    for text in ("[]", "1", '"x"'):
        (tmp_path / "outcome.json").write_text(text)
        with pytest.raises(IncompatibleRecord, match="no outcome") as refused:
            load_result(tmp_path)
        assert "indices" not in str(refused.value)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("measures",), 3), (("measures", "way"), [1.0]), (("measures", "way", "value"), "long"),
        (("verdicts",), {}), (("verdicts", 0), 1), (("verdicts", 0, "measured"), [1]),
        (("verdicts", 0, "share"), "all"), (("verdicts", 0, "verdict"), "reproduceD"), (("verdicts", 0, "rule"), 1),
        (("provenance", "seconds"), None), (("provenance", "config_hash"), 7),
        (("title",), None), (("experiment",), ["x"]), (("figures",), 1), (("tables",), [1]), (("films",), "ab"),
    ],
)  # fmt: skip
def test_an_outcome_of_other_kinds_makes_no_page(result, place, value, tmp_path):
    shutil.copytree(result.folder, tmp_path / "question")
    file = tmp_path / "question" / "outcome.json"
    told = json.loads(file.read_text())
    assert told["verdicts"]
    inner = told
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    file.write_text(json.dumps(told))
    with pytest.raises(IncompatibleRecord, match="is no outcome of suchus"):
        load_result(file.parent)


@pytest.mark.parametrize("text", ["[" * 5000, "1" * 5000, '{"a": "\ud800'])
def test_an_outcome_that_cannot_be_read_is_a_sentence(tmp_path, text):
    (tmp_path / "outcome.json").write_text(text, errors="surrogatepass")
    with pytest.raises(UnreadableFile, match=r"outcome\.json (holds|is not)"):
        load_result(tmp_path)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.73, "m", "0.73 m"),
        (-1.5, "-", "−1.5"),
        (None, "m", ""),
        (2, "-", "2"),
        (1.25e-7, "N", "1.25 × 10⁻⁷ N"),
        (3.141592653589793, "rad", "3.142 rad (180°)"),
    ],
)
def test_numbers_read_well(value, unit, text):
    assert quantity(value, unit) == text


def test_a_number_keeps_the_digits_asked_for():
    assert number(0.123456, 2) == "0.12"


def test_the_headline_comparison_stands_before_all_counts(page):
    text = " ".join(" ".join(page.text).split())
    assert text.index("headline comparison") < text.index("Same sense")
    head = text[text.index("headline comparison") : text.index("Same sense")]
    assert "0.73 m" in head
    assert "0.5 m" in head
    assert "cycles in the experiment" not in head  # a claim that is no headline


def of_another_robot(result, tmp_path, name):
    """The same result, as if it were of another robot of the shelf."""
    shutil.copytree(result.folder, tmp_path / "question")
    file = tmp_path / "question" / "outcome.json"
    told = json.loads(file.read_text())
    told["settings"] = {"robot": record.plain(asdict(ROBOTS[name]))}
    file.write_text(json.dumps(told))
    return render_page([load_result(file.parent)], [])


def test_another_robot_has_a_page_of_its_own_without_the_claims_of_the_article(result, tmp_path):
    own = of_another_robot(result, tmp_path / "own", "strider")
    assert "Strider, measured" in own
    gone = ("same sense", "misprints", "Read this first", "headline comparison", '<th scope="col">Verdicts', "No claim")
    for said in gone:
        assert said not in own
    assert "none of them is judged here" in own
    assert "<code>suchus size strider</code>" in own
    caiman = of_another_robot(result, tmp_path / "article", "caiman")
    assert "same sense" in caiman
    assert "measured</title>" not in caiman


def test_wide_figures_take_the_whole_page_and_others_half(result, tmp_path):
    assert [picture.is_wide for picture in result.pictures] == [False, False]
    shutil.copytree(result.folder, tmp_path / "question")
    file = tmp_path / "question" / "first.svg"
    file.write_text(re.sub(r'width="[\d.]+pt"', 'width="900pt"', file.read_text(), count=1))
    assert [picture.is_wide for picture in load_result(file.parent).pictures] == [True, False]
    shutil.copy(file, tmp_path / "question" / "second.svg")
    assert render_outcome_page(load_result(file.parent)).count('class="across"') == 1


def test_the_page_counts_as_the_readme_does_and_names_what_is_no_evidence(result):
    text = render_page([result], [])
    words = {row["claim"]: row["verdict"] for row in result.outcome["verdicts"]}
    assert str(count_evidence(words)) in text
    assert "1 not testable" in str(count_evidence(words))
    first = text[text.index("Read this first") : text.index("</aside>")]
    assert "Fitted" in first  # of another word, and fitted nonetheless
    assert "same sense" in first
    assert "Said twice:" not in first
