"""The figure of C3.1 shows the shares it is given."""

import numpy as np

from lifelore.experiments.chapter3.c3_01_useful_actions.figure import draw_useful_actions


def result(examples=True):
    rows = [
        {"generator": "g", "useful": 3, "actions": 8, "mazes": 1},
        {"generator": "g", "useful": 4, "actions": 8, "mazes": 3},
    ]
    example = {
        "example": 2, "shape": [1, 2], "cells": [[0, 0], [0, 1]], "counted": [True, True],
        "probs": [[0, 0, 1, 0], [0, 0, 0, 1]],
    }  # fmt: skip
    return {"rows": rows + ([example] if examples else []), "settings": {"generators": ["g"], "mazes": 4}}


def test_shares_and_examples():
    figure = draw_useful_actions(result(), [0.5])
    maze, shares = figure.axes
    assert maze.get_title("left") == "2 of 8 actions useful"
    bars = [(bar.get_x() + bar.get_width() / 2, bar.get_height()) for bar in shares.patches]
    np.testing.assert_allclose(bars, [[37.5, 25], [50, 75]])
    assert list(shares.lines[0].get_xdata()) == [50, 50]


def test_without_examples_only_shares_are_drawn():
    assert len(draw_useful_actions(result(examples=False), [0.5]).axes) == 1
