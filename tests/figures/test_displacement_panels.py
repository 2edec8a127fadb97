"""Several views of displacements: close-ups reach as far as they are told, endless bands do not widen them."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_03_displacements_by_relation.figure import draw_displacement_panels

PANEL = {"displacements": [[0, 8], [90, 0]], "relations": ["on", "adjacent"]}


def test_a_close_up_reaches_as_far_as_told_whatever_its_band():
    close = {**PANEL, "reach": 25, "bands": {"adjacent": (-np.inf, 1.6)}}
    far, near = draw_displacement_panels({"all": {**PANEL, "bands": close["bands"]}, "close": close}).axes
    assert near.get_xlim() == near.get_ylim() == (-25, 25)
    assert near.get_legend() is None
    assert -1 < far.get_ylim()[0] < 0
    (band,) = near.patches
    low, high = band.get_path().get_extents(band.get_patch_transform()).intervaly
    assert low < -25
    assert high == pytest.approx(1.6)


def test_three_panels_leave_the_fourth_place_empty():
    axes = draw_displacement_panels(dict.fromkeys("abc", PANEL)).axes
    assert [one.get_title("left") for one in axes] == ["a", "b", "c", ""]
    assert not axes[3].axison


def test_every_panel_is_checked():
    with pytest.raises(InputError, match=r"shape \(1, 2\)"):
        draw_displacement_panels({"a": PANEL, "b": {"displacements": np.zeros((2, 2)), "relations": ["on"]}})
