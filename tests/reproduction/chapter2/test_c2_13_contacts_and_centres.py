"""C2.13: nodes by hand, what is told of scenes made by hand, and one scene in full."""

from importlib.util import find_spec

import numpy as np
import pytest

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_13_contacts_and_centres import measure as c2_13
from reproduction.chapter2.c2_13_contacts_and_centres.measure import (
    centres_apart,
    given,
    node_counts,
    node_measures,
    nodes,
    strong,
    topmost_alone_remains,
)
from reproduction.chapter2.c2_13_contacts_and_centres.run import BALL, BLOCK, LESSON, SCENE, run_cell
from reproduction.chapter2.c2_13_contacts_and_centres.run import cells as block_cells
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, STANDARD, kernel_name
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C2.13")

FIGURE = [[0, 0, 0.2, 12], [0, 0, 0.0, 2], [0.1, 0, 0.03, 3]]
"""The thesis's: three nodes, one of which is strong."""


def row(block, ball=((0, 0, 0.21, 9),), *, scene="s", relation="on", centres=(0.0, 0.0, 0.1)):
    """A pair as a cell keeps it: a = ball, b = block; `centres` from the block's to the ball's."""
    away = np.array(centres)
    return {
        "scene": scene, "a": BALL, "b": BLOCK, "relation": relation, "confidence": 3, "pair": [BLOCK, BALL],
        "gap": 0.001, "contacts": {STANDARD: {"a": block, "b": list(ball)}},
        "peers": {"centroid k-NN": [(-away).tolist(), away.tolist()]},
    }  # fmt: skip


@pytest.mark.parametrize(
    ("block", "remains"),
    [
        (FIGURE, True),
        (FIGURE[:1], True),
        (FIGURE[1:], False),  # none is strong
        ([*FIGURE, [0.1, 0, 0.01, 7]], False),  # two are
        ([[0, 0, 0.2, 6], [0, 0, 0.1, 7]], False),  # the strong one is not topmost
    ],
)
def test_the_topmost_alone_remains(block, remains):
    assert topmost_alone_remains(nodes(row(block))) is remains


def test_seven_support_vectors_are_strong():
    assert strong(np.array([[0.1, 7], [0.2, 6]])).tolist() == [[0.1, 7]]


def test_nodes_by_hand():
    scenes = [row(FIGURE), row(FIGURE[:1]), row(FIGURE[1:]), row([*FIGURE, [0.1, 0, 0.01, 7]])]
    found = node_measures(scenes)
    assert found["rank_of_three_nodes"].value == pytest.approx((0.5 + 1 + 1 + 0) / 4)
    assert found["several_nodes_without_threshold"].value == 0.75
    assert found["one_node_with_threshold"].value == 0.5
    assert found["kept_node_is_topmost"].value == 0.5
    assert node_counts(scenes, STANDARD) == {"every contact": [0, 1, 1, 1, 1], "strong": [1, 2, 1, 0, 0]}


def test_centres_in_the_order_of_the_truth():
    one = row(FIGURE, centres=(0.03, 0.0, 0.1))
    assert centres_apart(one).tolist() == [0.03, 0.0, 0.1]
    assert centres_apart({**one, "a": BLOCK, "b": BALL}).tolist() == [-0.03, 0.0, -0.1]


def test_contacts_and_centres_are_asked_each_by_itself():
    beside = [row([[0, 0, 0.1, 9]], [[0.01, 0, 0.1, 9]], scene=f"b{k}", relation="adjacent") for k in range(4)]
    upon = [row(FIGURE[:1], scene=f"o{k}", centres=(0.0, 0.0, 0.02)) for k in range(4)]
    # Its contact is that of a thing on another, its centre that of a thing beside another.
    scene = row(FIGURE[:1], scene="x", centres=(0.0, 0.0, 0.099))
    assert given([*beside, *upon], [scene]) == {"contacts": ["on"], "centres": ["adjacent"]}


def test_the_grid_asks_all_of_every_camera_and_kernel(monkeypatch):
    good, bad = Estimate(0.95, 1.0, (0.9, 1.0), 9), Estimate(0.95, 1.0, (0.89, 1.0), 9)
    lost = Estimate(0.5, 0.5, (0.4, 0.6), 9)
    kept = {"one_node_with_threshold": good, "kept_node_is_topmost": good}
    first = kernel_name(*KERNELS[0])
    monkeypatch.setattr(c2_13, "lessons_and_scenes", lambda results, camera: ([], [camera]))
    monkeypatch.setattr(
        c2_13,
        "node_measures",
        lambda scenes, kernel=STANDARD: kept | ({"kept_node_is_topmost": bad} if kernel == first else {}),
    )
    # By the second camera centres tell on as well.
    centres = {"stereo": lost, "kinect": good}
    monkeypatch.setattr(
        c2_13, "on_measures", lambda lessons, scenes: {"on_by_contacts": good, "on_by_centres": centres[scenes[0]]}
    )
    found = c2_13.measure({"cameras": ["stereo", "kinect"]}, [])
    share = found["cameras_and_kernels_in_which_all_is_so"]
    assert (share.value, share.ci95, share.n) == (5 / 12, None, 12)


def test_cells_are_lots_of_lessons_and_scenes_by_camera():
    cells = block_cells({"cameras": ["stereo", "kinect"], "lessons": 23, "scenes": 16})
    assert [(cell["kind"], cell["first"]) for cell in cells[:4]] == [
        (LESSON, 0),
        (LESSON, 22),
        (SCENE, 0),
        (SCENE, 15),
    ]
    assert [cell["camera"] for cell in cells] == ["stereo"] * 4 + ["kinect"] * 4


@pytest.mark.skipif(find_spec("mujoco") is None, reason="needs mujoco")
def test_a_scene_in_full():
    settings = CLAIM.settings("quick", {"scenes": 1})
    found = run_cell(settings, {"kind": SCENE, "camera": "kinect", "first": 0}, 0)
    [one] = found["rows"]
    assert (one["a"], one["b"], one["relation"]) == (BALL, BLOCK, "on")
    assert centres_apart(one)[2] > 0.05
    assert nodes(one)[:, 0].max() == pytest.approx(one["contacts"][STANDARD]["b"][0][2], abs=0.02)
    assert [row["example"].split(":")[0] for row in found["examples"]] == ["every contact", "of at least 7"]
