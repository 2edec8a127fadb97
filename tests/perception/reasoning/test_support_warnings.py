"""Supports far from what they carry are named, near and unknown gaps are not."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.perception.reasoning.support_warnings import support_warnings


@pytest.mark.parametrize(
    ("relation", "gap", "said"),
    [
        ("on", 0.18, "with a gap: 3 on table (18 cm)"),
        ("both", 0.2, "3 on table (20 cm)"),
        ("on", 0.15, None),
        ("on", np.nan, None),
        ("on", np.inf, None),
        ("adjacent", 0.5, None),
    ],
)
def test_a_gap_below_an_object_is_said(make_scene, relation, gap, said):
    scene = make_scene({3: np.zeros((1, 3))}, relations=[(3, 1, relation)])
    scene = replace(scene, relations=tuple(replace(r, gap=gap) for r in scene.relations))
    messages = [one.message for one in support_warnings(scene)]
    assert (messages == []) if said is None else (said in messages[0])
