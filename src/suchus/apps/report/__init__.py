"""Outcomes become files, and files become one page."""

from suchus.apps.report.comparison import Comparison, compare, render_comparison, write_comparison
from suchus.apps.report.outcome_page import PAGE, answer, answer_rows, render_outcome_page, write_outcome_page
from suchus.apps.report.page import render_page, write_page
from suchus.apps.report.result import OUTCOME, Failure, Picture, Result, has_all_files, is_unchanged, load_result
from suchus.apps.report.saving import check_place, save_outcome
from suchus.visual.pages import number, quantity

__all__ = [
    "OUTCOME",
    "PAGE",
    "Comparison",
    "Failure",
    "Picture",
    "Result",
    "answer",
    "answer_rows",
    "check_place",
    "compare",
    "has_all_files",
    "is_unchanged",
    "load_result",
    "number",
    "quantity",
    "render_comparison",
    "render_outcome_page",
    "render_page",
    "save_outcome",
    "write_comparison",
    "write_outcome_page",
    "write_page",
]
