"""What a store says made its numbers covers all code that can change them."""

import grimp

from suchus.record import code_digest
from suchus.study.makers import MADE_BY, deciding

HARMLESS = ("suchus.errors", "suchus.threads")  # words, and how many threads, which change no byte


def test_all_code_that_runs_a_batch_is_in_the_digest():
    graph = grimp.build_graph("suchus", cache_dir=None)
    used = {"suchus.study.chunk"} | set(graph.find_upstream_modules("suchus.study.chunk"))
    rooms = tuple("suchus." + place.removesuffix(".py").replace("/", ".") for place in MADE_BY)
    missing = [m for m in used if not any(m == r or m.startswith(f"{r}.") for r in (*rooms, *HARMLESS))]
    assert [m for m in missing if m.count(".") > 1 or not any(r.startswith(f"{m}.") for r in rooms)] == []
    assert {"suchus.land.simulation", "suchus.paper.timing", "suchus.metrics.bends"} <= used  # the graph is a graph


def test_another_source_has_another_digest():
    assert code_digest("design") == code_digest("design")
    assert code_digest("design") != code_digest("design", "motion") != code_digest("motion", "design")
    assert code_digest("study/claims.py") != code_digest("study/answers.py")
    assert deciding()["source"] == code_digest(*MADE_BY)[:12]
