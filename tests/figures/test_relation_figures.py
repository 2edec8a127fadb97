"""Colours of relations, objects and methods are fixed; the separation curve shows the numbers it is given."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.object_palette import method_palette, mixed, object_palette, relation_palette
from lifelore.figures.separation_curve import draw_separation
from lifelore.perception.peers import PEERS


def test_separation_in_millimetres():
    curve = {"gap": [0, 0.1], "support_vectors": [[30, 20, 40], [10, 5, 15]], "nodes": [2, 0]}
    above, below = draw_separation({"l = 60 mm": curve}, near=0.08).axes
    np.testing.assert_allclose(above.lines[0].get_xydata(), [[0, 30], [100, 10]])
    np.testing.assert_allclose(below.lines[0].get_xydata(), [[0, 2], [100, 0]])
    with pytest.raises(InputError, match="one row a gap"):
        draw_separation({"l": curve | {"nodes": [1]}})


def test_colours_are_fixed_and_differ():
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"
    assert len(set(object_palette(range(2, 17)).values())) == 15
    assert relation_palette(["left_of"])["on"] == relation_palette([])["on"]
    palette = method_palette(["lifelore", "mine", "yours"])
    assert palette["lifelore"] == method_palette(["lifelore"])["lifelore"]
    assert len(set(palette.values())) == 3
    assert method_palette(["thesis", "mine"])["mine"] != method_palette(["thesis"])["thesis"]
    everybody = [*PEERS, "thesis", "lifelore"]
    assert len(set(method_palette(everybody).values())) == len(everybody)
