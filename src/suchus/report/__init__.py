"""Outcomes become files, and files become one page."""

from suchus.report.comparison import Comparison, compare, render_comparison, write_comparison
from suchus.report.page import render_page, write_page
from suchus.report.rendering import number, quantity
from suchus.report.result import Failure, Picture, Result, load_result, whole
from suchus.report.saving import check_place, save_outcome

__all__ = [
    "Comparison",
    "Failure",
    "Picture",
    "Result",
    "check_place",
    "compare",
    "load_result",
    "number",
    "quantity",
    "render_comparison",
    "render_page",
    "save_outcome",
    "whole",
    "write_comparison",
    "write_page",
]
