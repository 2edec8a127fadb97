"""Figures of chapter 2 show the numbers they are given."""

import numpy as np
import pytest

from lifelore.figures.style import house_style, new_figure
from reproduction.chapter2.c2_01_nearest_displacements.figure import PRINTED, draw_confusion
from reproduction.chapter2.c2_03_displacements_by_relation.figure import draw_displacements
from reproduction.chapter2.c2_04_time_per_image.figure import draw_seconds
from reproduction.chapter2.scoring.method_panels import draw_method_panels


def axes_with(draw, *arguments, **more):
    with house_style():
        axes = new_figure(4, 3).subplots()
        draw(axes, *arguments, **more)
    return axes


def test_the_printed_matrix_has_its_recalls():
    axes = axes_with(draw_confusion, np.array(PRINTED), "thesis")
    assert axes.get_title("left") == "thesis\n96 of 132 right"
    ticks = [tick.get_text() for tick in axes.get_xticklabels()]
    # 64 of 70, 20 of 32, 12 of 30, and no pair that is none.
    assert ticks == ["on\n91 %", "adjacent\n62 %", "both\n40 %", "none\n–"]
    assert [text.get_text() for text in axes.texts] == [str(n) for row in PRINTED for n in row]


ROWS = [
    {"relation": "on", "mm": [[0, 8], [0, 9]], "middle_of_on": [0, 8.5]},
    {"relation": "adjacent", "mm": [[90, 0], [-20, 1]], "middle_of_on": [0, 8.5]},
]


def test_displacements_lie_where_they_are_given():
    axes = axes_with(draw_displacements, ROWS, "all")
    clouds = [np.asarray(dots.get_offsets()).tolist() for dots in axes.collections]
    assert [at for at in clouds if at] == [[[0, 8], [0, 9]], [[90, 0], [-20, 1]]]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["on (2)", "adjacent (2)"]
    assert [text.get_text() for text in axes.texts] == ["(0, 8.5)"]
    assert axes.get_aspect() == 1


def test_a_close_up_reaches_as_far_as_asked_whatever_its_band():
    axes = axes_with(draw_displacements, ROWS, "close", reach=25)
    assert axes.get_xlim() == axes.get_ylim() == (-25, 25)
    assert axes.get_legend() is None
    (band,) = axes.patches
    low, high = band.get_path().get_extents(band.get_patch_transform()).intervaly
    assert low < -25
    # A fifth of the way to the middle of on.
    assert high == pytest.approx(1.7)


def test_seconds_are_dots_by_kind():
    axes = axes_with(
        draw_seconds, {"stereo": np.array([0.2, 0.1]), "kinect": np.array([0.4])}, {"stereo": 7e4, "kinect": 2e4}
    )
    clouds = [np.asarray(dots.get_offsets())[:, 0].tolist() for dots in axes.collections]
    assert [at for at in clouds if at] == [[0.1, 0.2], [0.4]]
    labels = [text.get_text() for text in axes.get_yticklabels()]
    assert labels == ["stereo\n70,000 points\n150 ms", "kinect\n20,000 points\n400 ms"]


def test_method_panels_are_shares_with_intervals():
    measured = {"value": 0.9, "ci95": [0.8, 0.95], "n": 52}
    with house_style():
        figure = new_figure(4, 3)
        draw_method_panels(
            figure, {"real": {"lifelore": measured, "thesis": measured | {"value": 0.7, "ci95": None}}}
        )
    (axes,) = figure.axes
    np.testing.assert_allclose([bar.get_width() for bar in axes.patches], [90, 70])
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["lifelore", "thesis"]
    assert axes.get_title("left") == "real (52 pairs)"
    assert [list(line.get_xdata()) for line in axes.lines] == [[80, 95]]
