"""Graphs: order, and DOT that a reader of DOT takes."""

import re
import shutil
import subprocess

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.perception.scene_graph import quoted, to_dot

POINT = np.zeros((1, 3))


@pytest.fixture
def scene(make_scene):
    rows = [(4, 3, "adjacent", 0.3), (3, 2, "on", 0.9), (2, 1, "on", 0.8), (2, 4, "none")]
    return make_scene({2: POINT, 3: POINT, 4: POINT}, relations=rows)


def test_dot_by_hand(scene):
    assert to_dot(scene).splitlines()[3:] == [
        '  n1 [label="table" shape=box];',
        '  n2 [label="2"];',
        '  n3 [label="3"];',
        '  n4 [label="4"];',
        '  n2 -> n1 [label="on 0.80"];',
        '  n3 -> n2 [label="on 0.90"];',
        '  n4 -> n3 [label="adjacent 0.30" dir=none constraint=false style=dashed];',
        "}",
    ]


@given(st.text())
def test_whatever_a_relation_is_called_its_quotes_close_where_they_should(text):
    body = quoted(text)[1:-1]
    assert re.fullmatch(r'(?:[^"\\\n\r]|\\["\\n])*', body)
    meaning = re.sub(r"\\(.)", lambda match: {"n": "\n"}.get(match[1], match[1]), body)
    assert meaning == text.replace("\r", "")


@pytest.mark.skipif(not shutil.which("dot"), reason="Graphviz is not installed")
def test_graphviz_takes_it(scene):
    subprocess.run(["dot", "-Tsvg"], input=to_dot(scene), text=True, check=True, capture_output=True)
