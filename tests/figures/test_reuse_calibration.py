"""The picture of calibration: a panel for each kind, points and bars at their numbers."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.reuse_calibration import PANELS, draw_calibration

FOUND = {
    "predicted": [0.1, 0.5, 0.9], "observed": [0.2, 0.5, 0.8], "ci95": [[0.1, 0.3], None, [0.7, 0.9]],
    "n": [10, 20, 5], "groups": 7, "error": 0.06,
}  # fmt: skip


@pytest.mark.parametrize("names", [["outcomes"], ["types"], ["outcomes", "types"]])
def test_a_panel_for_each_calibration(names):
    figure = draw_calibration({name: FOUND if name in names else None for name in PANELS})
    assert [axes.get_title(loc="left") for axes in figure.axes] == [PANELS[name][0] for name in names]
    for axes, name in zip(figure.axes, names, strict=True):
        points = [line for line in axes.lines if line.get_marker() == "o"]
        assert [float(np.ravel(line.get_ydata())[0]) for line in points] == FOUND["observed"]
        bars = [line.get_ydata() for line in axes.lines[2:] if len(line.get_xdata()) == 2]
        assert [list(bar) for bar in bars] == [[0.1, 0.3], [0.7, 0.9]]
        total = {"outcomes": "10 predictions", "types": "35 predictions"}[name]
        assert axes.texts[0].get_text() == f"{total} for 7 users\nmean distance 0.060"


def test_a_document_without_a_calibration_is_refused():
    with pytest.raises(InputError, match="it has neither"):
        draw_calibration({"outcomes": None, "types": None})
