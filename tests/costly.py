"""Which tests cost more than they may in ``make test``, as they were last measured: ``make test-all`` runs those.

``make costs`` measures all of them anew. What a test costs is its processor time, and that of its processes. The quick
form of an experiment is made once for all tests that ask for it, so it counts only where it is too dear itself.
"""

import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

FILE = Path(__file__).with_name("costly.json")
LIMIT = 0.07
"""Most processor time of a test that ``make test`` runs [s]; what keeps the whole near ten minutes."""
QUICK_LIMIT = 20.0
"""Most processor time of an experiment's quick form that ``make test`` runs [s]."""
WHY = f"more than {LIMIT} s of processor time, or a quick form of more than {QUICK_LIMIT:g} s"
KEPT = {
    "tests/cli/test_answer.py::test_the_numbers_that_carry_the_answer_are_measured": "runs each quick form first",
    "tests/docs/test_verdicts.py::test_what_runs_quickly_still_says_the_same": "the verdicts themselves",
    "tests/flow/test_forces.py::test_the_torque_of_a_turning_cylinder_is_the_exact_one": "an exact answer of the flow",
    "tests/flow/test_free.py::test_a_spring_mounted_cylinder_rings_as_stokes_says": "an exact answer of a free body",
    "tests/flow/test_nest.py::test_its_force_is_that_of_fine_cells_everywhere": "a patch of fine cells",
    "tests/flow/test_solver.py::test_channel_flow_keeps_its_parabola": "an exact answer of the flow",
    "tests/flow/test_solver.py::test_taylor_green_decays_at_second_order": "the order of the solver",
    "tests/flow/test_surface_in_space.py::test_three_accounts_of_the_force_on_a_sphere_agree": "the flow in space",
    "tests/coupling/test_coupled.py::test_a_swim_that_was_killed_goes_on_to_the_same_bytes": "the coupling",
    "tests/fuzz/test_fuzz.py::test_two_thousand_hostile_cases_end_in_a_result_or_a_sentence": "hostile input",
    "tests/land/test_simulation.py::test_the_articles_displacements_come_out_within_a_centimetre": "the article",
    "tests/land/test_simulation.py::test_a_run_that_diverges_ends_alone_with_time_and_cause": "divergence",
    "tests/league/test_sealing.py::test_nothing_that_was_measured_is_read_before_the_seal": "the seal",
    "tests/optimise/test_conduct_optimise.py::test_another_search_is_named_and_left_alone": "the search",
    "tests/study/test_varied.py::test_a_claim_holds_in_the_share_of_designs_that_is_known": "the shares",
    "tests/test_imports.py::test_what_walks_loads_no_flow_solver_and_a_swim_by_cfd_would_be_noticed": "what is loaded",
    "tests/viewer/test_browser.py::test_only_this_computer_can_look": "the viewer's door",
    "tests/water/test_momentum.py::test_body_and_water_together_keep_their_momentum": "an exact balance",
}
"""Tests that stay whatever they cost, and why."""
_WRITES = os.environ.get("SUCHUS_COSTS") == "write"


def costly() -> dict[str, float]:
    """Return the processor time of each test that costs too much [s]."""
    told: dict[str, float] = json.loads(FILE.read_text(encoding="utf-8"))
    return told


def mark(items: Iterable[pytest.Item]) -> None:
    """Mark what costs too much as slow, unless all is being measured."""
    known = {} if _WRITES else costly()
    for item in items:
        if item.nodeid in known and not item.get_closest_marker("validate") and not item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.slow(WHY))


class Meter:
    """Measures what each test costs, and at the end writes which cost too much; a plugin of ``make costs``."""

    def __init__(self) -> None:
        self._began = 0.0
        self._asked: set[str] = set()
        self._quick: dict[str, float] = {}
        self._own: dict[str, tuple[float, set[str]]] = {}

    @staticmethod
    def spent() -> float:
        """Return the processor time of this process and of those that it has waited for [s]."""
        return sum(os.times()[:4])

    def asked(self, name: str, made: float) -> None:
        """Note that a test asks for the quick form of an experiment, and what it took to make it [s], if it did."""
        self._asked.add(name)
        self._began += made
        self._quick[name] = max(made, self._quick.get(name, 0.0))

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self) -> Iterator[None]:
        """Begin to measure a test."""
        self._began, self._asked = self.spent(), set()
        yield

    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> None:
        """Let the last report of a test carry what it cost."""
        if call.when == "teardown":
            item.user_properties.append(("cost", (self.spent() - self._began, sorted(self._asked), dict(self._quick))))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take what a test cost from its last report, whichever worker ran it."""
        for name, value in report.user_properties:
            if report.when == "teardown" and name == "cost":
                own, asked, quick = value
                self._own[report.nodeid] = own, set(asked)
                for form, made in quick.items():
                    self._quick[form] = max(made, self._quick.get(form, 0.0))

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write which tests cost too much."""
        if hasattr(session.config, "workerinput"):
            return
        found = {}
        for test, (own, asked) in self._own.items():
            dear = max((self._quick.get(name, 0.0) for name in asked), default=0.0)
            kept = test.partition("[")[0] in KEPT and dear <= QUICK_LIMIT
            if not kept and (own > LIMIT or dear > QUICK_LIMIT):
                found[test] = round(max(own, dear), 2)
        FILE.write_text(json.dumps(dict(sorted(found.items())), indent=0, ensure_ascii=False) + "\n", encoding="utf-8")


METER = Meter() if _WRITES else None
