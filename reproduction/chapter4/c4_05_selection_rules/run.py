"""C4.5: ways to select among 68 policies in the surveillance reserve. Thesis: §4.6.4, Figures 4.9 and 4.10."""

from collections.abc import Mapping

from reproduction.chapter4.reuse.rules import STANDARD
from reproduction.chapter4.surveillance.runs import CASES, DOUBTING, RULES, reserve_cells
from reproduction.chapter4.surveillance.runs import check_reserves as check
from reproduction.chapter4.surveillance.runs import run_method as run_cell

__all__ = ["cells", "check", "run_cell"]


def cells(settings: Mapping) -> list[dict]:
    """Every rule in every case of the default reserve, and with exact models on targets in every other.

    Of rules that doubt their models the standard forms.
    """
    trusting = [case for case in CASES if case not in DOUBTING]
    return [*reserve_cells(settings, trusting, RULES, RULES), *reserve_cells(settings, DOUBTING, STANDARD, ())]
