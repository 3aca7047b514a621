import pytest

from suchus.errors import UnknownName
from suchus.experiment import judge, staged


@pytest.mark.parametrize(
    ("measured", "holds", "word"),
    [
        (0.73, None, "reproduced"),
        (0.77, None, "reproduced"),  # within the claim's band of 0.05 m
        (0.60, None, "same sense"),
        (-0.60, None, "contradicted"),
        (0.73, False, "contradicted"),  # the number is right but the statement is not
        (0.60, False, "contradicted"),
        (None, None, "not testable"),
    ],
)
def test_a_verdict_on_a_number(measured, holds, word):
    assert judge("displacement_coordinated", measured, "because", holds=holds).verdict == word


def test_a_verdict_on_a_statement_is_what_was_found():
    assert judge("com_fluctuation", -0.1, "because", holds=True).verdict == "reproduced"
    assert judge("com_fluctuation", 0.1, "because", holds=False).verdict == "contradicted"


def test_another_tolerance_is_another_band():
    assert judge("displacement_coordinated", 0.60, "because", tolerance=0.2).verdict == "reproduced"


def test_an_unknown_claim_is_named():
    with pytest.raises(UnknownName, match="no claim named 'displacment_ratio'"):
        judge("displacment_ratio", 1.0, "because")


def test_progress_of_a_stage_fills_its_part():
    seen = []
    report = staged(lambda stage, share: seen.append((stage, share)), "middle", 0.25, 0.75)
    report(0.0)
    report(0.5)
    report(1.0)
    assert seen == [("middle", 0.25), ("middle", 0.5), ("middle", 0.75)]
