"""The picture of a claim without a drawing of its own: a strip a statement, with its number and its bound."""

from dataclasses import replace

import numpy as np

from reproduction.engine.statement import Statement
from reproduction.engine.statement_figures import COLOURS, draw_numbers
from tests.reproduction.toy_claim import toy_claim


def test_each_statement_shows_its_number_interval_and_bound():
    says = {"x is large": "x > 3", "y lies between": "y in [0, 1]", "z was not measured": "z > 0"}
    statements = tuple(Statement.parsed(words, holds, central=True) for words, holds in says.items())
    claim = replace(toy_claim({"n": 1}, lambda *_: {}), statements=statements)
    numbers = {"x": {"value": 4.0, "ci95": [2.0, 5.0]}, "y": {"value": 2.0, "ci95": None}}
    strips = draw_numbers(claim, {"measured": numbers}).axes
    assert [axes.get_title(loc="left") for axes in strips] == ["x is large: 4 [2, 5]", "y lies between: 2"]
    first, second = ([np.ravel(line.get_xdata()).tolist() for line in axes.lines] for axes in strips)
    assert (first, second) == ([[2, 5], [4], [3, 3]], [[2], [0, 0], [1, 1]])
    assert [strips[0].lines[1].get_color(), strips[1].lines[0].get_color()] == [COLOURS["½"], COLOURS["✗"]]
