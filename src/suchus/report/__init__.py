"""Outcomes become files, and files become one page."""

from suchus.report.saving import check_place, save_outcome

__all__ = ["check_place", "save_outcome"]
