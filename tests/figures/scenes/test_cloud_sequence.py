"""Sequences of clouds: one picture and caption each, one colour for an object, a star on the marked object."""

import numpy as np
import pytest

from docs.pictures.cloud_sequence import draw_cloud_sequence
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.style import save_figure

POINTS = np.random.default_rng(0).uniform(0, 0.1, (60, 3))
FIRST = LabelledCloud(POINTS, np.repeat([1, 2, 3], 20), None, np.array([0.0, -1, 0.5]))
LATER = LabelledCloud(POINTS[:40], np.repeat([1, 3], 20), None, np.array([0.0, -1, 0.5]))


def test_a_picture_and_a_caption_for_each_cloud(tmp_path):
    figure = draw_cloud_sequence([FIRST, LATER, LATER], ["start", "later", "end"], marked=2, columns=2)
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert [axes.get_title("left") for axes in shown] == ["start", "later", "end"]
    assert [len(axes.lines) for axes in shown] == [1, 0, 0]
    assert [[text.get_text() for text in axes.texts] for axes in shown] == [["2", "3"], ["3"], ["3"]]
    first, later = (axes.images[0].get_array().reshape(-1, 3) for axes in shown[:2])
    assert len(np.unique(first.round(2), axis=0)) > len(np.unique(later.round(2), axis=0))
    save_figure(figure, tmp_path / "sequence.png")


def test_what_cannot_be_drawn_is_refused():
    for clouds, captions, columns in (([], [], 2), ([FIRST], [], 2), ([FIRST], ["one"], 0)):
        with pytest.raises(InputError, match="a sequence needs"):
            draw_cloud_sequence(clouds, captions, columns=columns)
