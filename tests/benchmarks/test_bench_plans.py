"""`bench plans`: plans and their validity by hand, the planner as a second opinion, and the contract."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.perception import fetched_scene, plans
from benchmarks.perception.fetch_plan import fetch_order, first_fault, is_valid
from benchmarks.perception.fetched_scene import fetched_given, fetched_without_labels
from benchmarks.perception.figure_plan_failures import FailedScene, draw_plan_failures
from benchmarks.perception.segmentation_scenes import TrueScene
from lifelore.bridges.planner import solve
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.figures.style import save_figure
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.reasoning.planning_domain import DOMAIN
from lifelore.perception.reasoning.planning_problem import problem_text
from lifelore.perception.reasoning.planning_state import planning_state
from lifelore.perception.relations.relation import Relation

# 4 and 5 rest on 3, 3 on 2; 6 on both 5 and 7.
PILE = [Relation(a, b, "on", 1.0, 0.0) for a, b in ((2, 1), (3, 2), (4, 3), (5, 3), (6, 5), (6, 7), (7, 1))]


def test_what_lies_above_is_put_away_first():
    state = planning_state(PILE)
    assert fetch_order(state, 4) == (4,)
    assert fetch_order(state, 2) == (4, 6, 5, 3, 2)
    assert fetch_order(state, 7) == (6, 7)


def test_what_may_be_covered_is_not_fetched():
    state = planning_state([*PILE, Relation(8, 1, "on", 1.0, 0.0)], hidden=(4, 8))
    assert state.may_be_covered == (4, 8)
    assert fetch_order(state, 2) is None
    assert fetch_order(state, 8) is None
    assert fetch_order(state, 5) == (6, 5)


@pytest.mark.planning
@pytest.mark.slow
@pytest.mark.parametrize("target", [2, 5, 7])
def test_a_planner_needs_as_many_steps(target):
    state = planning_state(PILE)
    order = fetch_order(state, target)
    assert order is not None
    found = solve(DOMAIN, problem_text(state, {n: f"o{n}" for n in range(2, 8)}, f"(holding o{target})"))
    assert found is not None
    # Each object but the last is picked up and put down.
    assert len(found) == 2 * len(order) - 1
    assert {step.arguments[0] for step in found} == {f"o{n}" for n in order}


def test_a_plan_is_valid_if_nothing_rests_on_what_is_picked_up():
    truth = [PairLabel(3, 2, "both"), PairLabel(4, 3, "on", 1), PairLabel(2, 1, "on"), PairLabel(5, 2, "adjacent")]
    assert is_valid((3, 2), truth)
    assert not is_valid((2,), truth)
    assert not is_valid((2, 3), truth)
    assert not is_valid((3,), [PairLabel(4, 3, "on", 2)])
    assert is_valid((), truth)
    assert first_fault((2, 3), truth) == (2, 3)
    assert first_fault((3, 2), truth) is None


def surface(low, high, step=0.006) -> np.ndarray:
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return points[((points == np.array(low)) | (points == np.array(high))).any(axis=1)]


@pytest.fixture
def pile() -> LabelledCloud:
    """A box on a larger box, seen from the front."""
    parts = [surface((-0.1, -0.1, 0), (0.2, 0.2, 0), 0.01), surface((0, 0, 0.001), (0.1, 0.1, 0.05))]
    parts.append(surface((0.02, 0.02, 0.052), (0.08, 0.08, 0.1)))
    return LabelledCloud(np.vstack(parts), np.repeat([TABLE, 2, 3], [len(part) for part in parts]))


TRUTHS = [(PairLabel(3, 2, "on"), PairLabel(2, 1, "on")), (PairLabel(2, 3, "on"), PairLabel(3, 1, "on"))]


def cut_as(monkeypatch, labels: np.ndarray) -> None:
    """Let the segmentation give these labels."""

    def segmented(cloud, up):
        assert cloud.labels is None
        return SimpleNamespace(cloud=LabelledCloud(cloud.points, labels))

    monkeypatch.setattr(fetched_scene, "segmented_scene", segmented)


def test_a_pile_of_two_is_planned_for_and_judged(pile, monkeypatch, tmp_path):
    (targets, right), (_, wrong) = (fetched_given(pile, truth) for truth in TRUTHS)
    assert targets == (2, 3)
    assert right.targets == 2
    assert right.plans[plans.UNKNOWN, 0.0] == (2, 2)
    assert wrong.plans[plans.UNKNOWN, 0.0] == (2, 0)
    planned, valid, useful = plans.shares([right, wrong], (plans.UNKNOWN, 0.0))
    assert (planned.value, valid.value, useful.value, valid.n) == (1.0, 0.5, 0.5, 4)
    # The upper box is fetched although the lower is on it; then the lower, although nothing was above.
    assert wrong.failures == {2: "2 rests on 3", 3: "2 rests on 3"}

    scenes = [SimpleNamespace(name="pile", cloud=pile, truth=truth) for truth in TRUTHS]
    monkeypatch.setattr(plans, "tabletop_scenes", lambda *_: scenes)
    monkeypatch.setattr(plans, "real_scenes_folder", lambda: None)
    cut_as(monkeypatch, np.where(pile.labels == 3, 9, pile.labels))
    told = []
    result = plans.bench_plans(2, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert (tmp_path / "bench_plans.png").read_bytes().startswith(b"\x89PNG")
    values = {row["name"]: row for row in result["rows"]}
    for how in ("simulated", "simulated without labels"):
        assert values[f"{how}, hidden tops unknown, from 0: valid plans"]["value"] == 0.5
        assert values[f"{how}, default threshold, failures: another object rests on it"]["value"] == 2
    assert values["real, hidden tops unknown, from 0: valid plans"]["value"] is None
    assert [goal["met"] for goal in result["goals"]] == [False, None, None, None]
    assert len(told) == 2


@pytest.mark.parametrize(
    ("labels", "reasons"),
    [
        # Both boxes are one segment, which finds the larger; what is on it stays there.
        (lambda true: np.minimum(true, 2), {2: "3 rests on 2", 3: fetched_scene.NOT_FOUND}),
        # No segment has half of a box.
        (
            lambda true: np.where(true == TABLE, true, 2 + np.arange(len(true)) % 3),
            {2: "not found", 3: "not found"},
        ),
    ],
)
def test_targets_that_are_not_found_have_no_plan(pile, monkeypatch, labels, reasons):
    cut_as(monkeypatch, labels(pile.labels))
    scene = TrueScene("pile", PointCloud(pile.points, pile.labels), TRUTHS[0], "z")
    _, found = fetched_without_labels(scene, (2, 3))
    assert found.failures == reasons
    assert found.plans[plans.DEFAULT][1] == 0


def test_a_piece_that_stands_for_no_object_spoils_the_plan(pile, monkeypatch):
    # A fifth of the upper box, its top, is a segment of its own.
    top = (pile.labels == 3) & (pile.points[:, 2] > 0.0999)
    assert 0 < top.sum() < 0.3 * (pile.labels == 3).sum()
    cut_as(monkeypatch, np.where(top, 4, pile.labels))
    scene = TrueScene("pile", PointCloud(pile.points, pile.labels), TRUTHS[0], "z")
    _, found = fetched_without_labels(scene, (2, 3))
    assert found.plans[plans.UNKNOWN, 0.0] == (2, 0)
    assert set(found.failures.values()) == {fetched_scene.NO_OBJECT}


def test_a_scene_that_cannot_be_cut_has_no_plans(pile):
    scene = TrueScene("nothing", PointCloud(pile.points[:5], pile.labels[:5]), TRUTHS[0], "table")
    cut, found = fetched_without_labels(scene, (2, 3))
    assert cut is None
    assert set(found.plans.values()) == {(0, 0)}
    assert found.failures == {2: fetched_scene.NOT_FOUND, 3: fetched_scene.NOT_FOUND}


def test_failures_are_drawn(pile, tmp_path):
    scenes = [
        FailedScene("one", pile.labels, (pile, pile), ({2: "3 rests on 2"}, {})),
        FailedScene("two", pile.labels, (pile, None), ({}, {2: "not found", 3: "not found"})),
        FailedScene("three", pile.labels, (pile, pile), ({}, {3: "not found"})),
    ]
    figure = draw_plan_failures(scenes)
    texts = [text.get_text().strip() for place in figure.axes for text in place.texts]
    assert [text for text in texts if ":" in text] == [
        "2: 3 rests on 2",
        "2: not found\n3: not found",
        "3: not found",
    ]
    assert texts.count("all fetched") == 3
    assert save_figure(figure, tmp_path / "failures.png").stat().st_size <= 300_000
