"""Scatter plots show the points of each group with its marker and colour."""

import numpy as np

from lifelore.figures.style import new_figure
from reproduction.figures.scatter import draw_scatter


def test_points_lie_where_they_are_given_and_the_legend_names_the_groups():
    axes = new_figure(4, 3).subplots()
    draw_scatter(axes, {"a": [[0, 1], [2, 3]], "b": [[4, 5]]}, legend={"loc": "best"}, title="t")
    clouds = [np.asarray(dots.get_offsets()).tolist() for dots in axes.collections]
    assert [at for at in clouds if at] == [[[0, 1], [2, 3]], [[4, 5]]]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["a", "b"]
    assert len(axes.lines) == 2
