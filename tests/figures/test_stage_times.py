"""Seconds of pictures and stages are drawn as given."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_04_time_per_image.figure import draw_stage_times


def test_dots_and_bars_show_their_numbers():
    figure = draw_stage_times(
        {"one": [0.2, 0.1], "other": [0.4]},
        {"one": {"s": 7, "t": 9}, "other": {"s": 3, "t": 2}},
        {"a second": 1.0},
    )
    left, right = figure.axes
    one, other = (np.asarray(dots.get_offsets())[:, 0].tolist() for dots in left.collections)
    assert (one, other) == ([0.1, 0.2], [0.4])
    assert [bar.get_path().get_extents(bar.get_patch_transform()).width for bar in right.patches] == pytest.approx(
        [7, 9, 3, 2]
    )
    assert [text.get_text() for text in left.get_yticklabels()] == ["one\nmedian 150 ms", "other\nmedian 400 ms"]


@pytest.mark.parametrize(("whole", "stages"), [({}, {}), ({"a": [1.0]}, {"b": {}}), ({"a": []}, {"a": {}})])
def test_kinds_must_correspond_and_have_pictures(whole, stages):
    with pytest.raises(InputError, match="same kinds"):
        draw_stage_times(whole, stages)
