"""C4.5: ways to select among 68 policies in the surveillance reserve. Thesis: §4.6.4, Figures 4.9 and 4.10."""

from collections.abc import Mapping

from lifelore.experiments.chapter4.surveillance_runs import CASES, RULES, reserve_cells, run_method
from lifelore.experiments.chapter4.surveillance_runs import check_reserves as check

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    """Every rule in every case of the default reserve, and with exact models on targets in every other."""
    return reserve_cells(settings, CASES, RULES, RULES)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One rule on all its tasks."""
    return run_method(settings, cell, seed)
