from functools import partial

import numpy as np
import pytest
from toys import broken, fell, stone

from evidence.league import ContestantFamily, Interval, Predictor, SingleContestant, every, find, known
from evidence.league.judging import WIDEST, judged
from evidence.league.sealing import Measured, _answers, predicted
from evidence.league.spread import drawn, of_answers, of_draws, widest
from suchus.core.errors import InvalidDesign, NotConverged, UnknownName


def test_the_interval_covers_its_share_of_a_uniform_unknown():
    one = stone()
    choices = drawn(one, 2000)
    assert choices[0] == {"height": 1.0}
    found = of_draws("times", fell(choices, lambda *_: None))
    assert found.value == (1.0, 2.0)
    np.testing.assert_allclose(found.low, [0.525, 1.05], atol=2e-3)
    np.testing.assert_allclose(found.high, [1.475, 2.95], atol=2e-3)


def test_what_is_known_is_not_drawn_and_draws_are_the_same_every_time():
    assert drawn(stone(height=(1.0, 1.0, 1.0)), 50) == [{"height": 1.0}]
    assert drawn(stone(), 9) == drawn(stone(), 9)


def test_an_interval_reaches_to_its_value_though_no_draw_does():
    found = of_draws("speed", [{"speed": 9.0}, *[{"speed": 1.0 + 0.01 * i} for i in range(40)]])
    assert found.value == found.high == 9.0


@pytest.mark.parametrize(("failed", "refused"), [(1, False), (3, True)])
def test_too_few_answers_are_refused(failed, refused):
    answers = [{"speed": 1.0}] * (10 - failed) + [{}] * failed
    if refused:
        with pytest.raises(NotConverged, match="7 of 10 choices"):
            of_draws("speed", answers)
    else:
        assert of_draws("speed", answers).value == 1.0
    assert of_draws("speed", [{}, {"speed": 1.0}]) is None


def test_an_expensive_rung_takes_the_interval_of_another_around_all_of_its_answers():
    like = Interval(2.0, 1.0, 3.0)
    assert of_answers("speed", [{"speed": 4.0}, {"speed": 6.0}], like) == Interval(4.0, 2.0, 9.0)
    assert of_answers("speed", [{"speed": -4.0}], like) == Interval(-4.0, -6.0, -2.0)
    assert of_answers("speed", [{"speed": 4.0}, {"speed": 6.0}], None) == Interval(4.0, 4.0, 6.0)


def test_a_single_answer_is_no_certainty():
    with pytest.raises(NotConverged, match="one answer has no interval"):
        of_answers("speed", [{"speed": 4.0}], None)
    narrow, wide = Interval(10.0, 9.0, 11.0), Interval((0.0, 2.0), (-0.1, 1.0), (0.1, 3.0))
    assert widest([narrow, wide]) == widest([wide, narrow]) == wide
    assert widest([]) is None


def test_an_expensive_rung_takes_the_widest_interval_where_the_one_that_it_takes_after_has_no_word():
    def guess(choices, progress):
        return [{"times": (3.0, 3.0)}]

    wild = stone(
        rungs={
            "fall": Predictor(words="", work=fell, draws=40),
            "film": Predictor(words="", work=partial(broken, NotConverged("no film.")), draws=4),
            "guess": Predictor(words="", work=guess, draws=0, interval_source="film"),
        }
    )
    found, refused = predicted(wild, {name: _answers((wild, name), lambda *_: None) for name in wild.rungs})
    fall, guessed = (found["times"][name] for name in ("fall", "guess"))
    assert guessed.low == pytest.approx([3.0 * low / value for low, value in zip(fall.low, fall.value, strict=True)])
    assert refused == {"film": "no film."}


def test_a_rung_without_an_interval_and_a_number_without_a_source_are_refused():
    with pytest.raises(InvalidDesign, match="name in like"):
        Predictor(words="", work=fell, draws=0)
    with pytest.raises(InvalidDesign, match="without a source"):
        stone(source=" ")
    with pytest.raises(InvalidDesign, match="must lie in the range"):
        stone(height=(2.0, 0.5, 1.5))
    with pytest.raises(InvalidDesign, match="draws none"):
        stone(rungs={"film": Predictor(words="", work=fell, draws=0, interval_source="film")})


def _measured(value, low, high):
    return Measured(value=value, low=low, high=high, unit="m/s", source="a gun")


@pytest.mark.parametrize(
    ("low", "high", "word"),
    [
        (1.0, 1.89, "missed"),
        (1.0, 1.9, "within"),
        (2.1, 3.0, "within"),
        (2.11, 3.0, "missed"),
        (0.5, WIDEST * 0.5, "within"),
        (0.5, WIDEST * 0.51, "within, wide"),
        (-0.5, 3.0, "within, wide"),
        (0.0, 3.0, "within, wide"),
    ],
)
def test_the_word_on_each_side_of_each_bound(low, high, word):
    assert judged(Interval((low + high) / 2, low, high), _measured(2.0, 1.9, 2.1)).word == word


def test_of_several_numbers_the_worst_decides():
    three = Interval((1.0, 2.0), (0.9, 1.8), (1.1, 2.2))
    assert judged(three, _measured((1.0, 2.0), (1.0, 2.0), (1.0, 2.0))).word == "within"
    found = judged(three, _measured((1.0, 4.0), (1.0, 4.0), (1.0, 4.0)))
    assert found.word == "missed"
    assert found.ratio == pytest.approx(0.5)


def test_contestants_are_found_by_their_names():
    family = ContestantFamily(
        name="stone",
        default_parameters=(1.0, 2.5),
        low=0.5,
        high=6.0,
        parameter_label="metres",
        create=lambda h: stone(f"stone_{h:g}"),
    )
    shelf = {"stone": family, "stone_old": SingleContestant(stone("stone_old"))}
    assert every(shelf) == ("stone_1", "stone_2.5", "stone_old")
    assert find(shelf, "stone_old").name == "stone_old"
    assert find(shelf, "stone_3").name == "stone_3"
    for name in ("stone", "stone_x", "stones", "stone_old_2"):
        with pytest.raises(UnknownName, match=name):
            find(shelf, name)
    with pytest.raises(InvalidDesign, match=r"0.5 to 6 can be asked"):
        find(shelf, "stone_7")
    assert known(1.0, "m", "x").low == known(1.0, "m", "x").high == 1.0


def test_some_models_are_asked_and_the_others_are_named():
    some = stone().asking(["formula", "slice"])
    assert list(some.rungs) == ["formula"]
    assert some.excluded_models == {"film": "it was not asked"}
    assert stone().asking([]) == stone()
    with pytest.raises(InvalidDesign, match="takes the interval of formula"):
        stone().asking(["film"])
    with pytest.raises(InvalidDesign, match="has none of the models slice; it has formula, film"):
        stone().asking(["slice"])
