"""Traces as step functions by hand, against a plain twin; and the figure."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.figures.lives.task_curves import draw_task_curves, share_at, step_grid
from lifelore.figures.style import save_figure

TRACE = [[100, 0.0], [200, 0.5], [300, 0.9]]


def test_share_is_a_step_function_that_keeps_its_last_value():
    assert share_at(TRACE, [50, 100, 199, 200, 299, 300, 9000]).tolist() == [0, 0, 0, 0.5, 0.5, 0.9, 0.9]


def test_losses_count_as_nothing():
    assert share_at([[100, -3.0], [200, 1.0 + 1e-12]], [100, 200]).tolist() == [0, 1]


def test_an_empty_trace_is_nothing_throughout():
    assert share_at(np.empty((0, 2)), [1, 10]).tolist() == [0, 0]


@given(st.lists(st.floats(0, 1), max_size=8), st.lists(st.integers(1, 1000), min_size=1, max_size=8))
def test_share_agrees_with_a_plain_loop(shares, steps):
    trace = [(100 * (i + 1), share) for i, share in enumerate(shares)]
    plain = [next((share for at, share in reversed(trace) if at <= step), 0.0) for step in steps]
    assert share_at(np.reshape(trace, (-1, 2)), steps).tolist() == plain


def test_grid_spans_all_traces():
    grid = step_grid([TRACE, [[50, 0.0]], np.empty((0, 2))])
    assert (grid[0], grid[-1]) == pytest.approx((50, 375))
    assert len(step_grid([np.empty((0, 2))])) == 2


def test_figure_shows_mean_and_threshold(tmp_path):
    panels = {"early": {"lore": [TRACE, [[100, 1.0]]], "scratch": [TRACE]}, "late": {"lore": [TRACE]}}
    figure = draw_task_curves(panels, threshold=0.7, title="Learning")
    early = figure.axes[0]
    mean = early.lines[0].get_ydata()
    assert (mean[0], mean[-1]) == pytest.approx((0.5, 0.95))
    assert any(np.allclose(line.get_ydata(), 0.7) for line in early.lines)
    assert save_figure(figure, tmp_path / "curves.png").stat().st_size > 5_000
