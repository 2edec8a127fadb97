"""The picture of calibration: points and bars at their numbers."""

import numpy as np

from lifelore.figures.reuse_calibration import draw_calibration

FOUND = {
    "predicted": [0.1, 0.5, 0.9], "observed": [0.2, 0.5, 0.8], "ci95": [[0.1, 0.3], None, [0.7, 0.9]],
    "n": [10, 10, 10], "groups": 7, "error": 0.06,
}  # fmt: skip


def test_points_and_bars_are_at_their_numbers():
    (axes,) = draw_calibration(FOUND).axes
    points = [line for line in axes.lines if line.get_marker() == "o"]
    assert [float(np.ravel(line.get_ydata())[0]) for line in points] == FOUND["observed"]
    bars = [line.get_ydata() for line in axes.lines[2:] if len(line.get_xdata()) == 2]
    assert [list(bar) for bar in bars] == [[0.1, 0.3], [0.7, 0.9]]
    assert axes.texts[0].get_text() == "10 predictions for 7 users\nmean distance 0.060"
