"""`bench plans`: plans and their validity by hand, the planner as a second opinion, and the contract."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from lifelore.bridges.planner import solve
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.experiments.bench.perception import plans
from lifelore.experiments.bench.perception.fetch_plan import fetch_order, is_valid
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


def surface(low, high, step=0.006) -> np.ndarray:
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return points[((points == np.array(low)) | (points == np.array(high))).any(axis=1)]


def test_a_pile_of_two_is_planned_for_and_judged(monkeypatch, tmp_path):
    parts = [surface((-0.1, -0.1, 0), (0.2, 0.2, 0), 0.01), surface((0, 0, 0.001), (0.1, 0.1, 0.05))]
    parts.append(surface((0.02, 0.02, 0.052), (0.08, 0.08, 0.1)))
    cloud = LabelledCloud(np.vstack(parts), np.repeat([TABLE, 2, 3], [len(part) for part in parts]))
    truths = [(PairLabel(3, 2, "on"), PairLabel(2, 1, "on")), (PairLabel(2, 3, "on"), PairLabel(3, 1, "on"))]
    right, wrong = (plans.fetched_in(cloud, truth) for truth in truths)
    assert right.targets == 2
    assert right.plans[plans.UNKNOWN, 0.0] == (2, 2)
    assert wrong.plans[plans.UNKNOWN, 0.0] == (2, 0)
    planned, valid, useful = plans.shares([right, wrong], (plans.UNKNOWN, 0.0))
    assert (planned.value, valid.value, useful.value, valid.n) == (1.0, 0.5, 0.5, 4)

    scenes = [SimpleNamespace(cloud=cloud, truth=truth) for truth in truths]
    monkeypatch.setattr(plans, "tabletop_scenes", lambda *_: scenes)
    monkeypatch.setattr(plans, "real_scenes_folder", lambda: None)
    told = []
    result = plans.bench_plans(2, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert (tmp_path / "bench_plans.png").read_bytes().startswith(b"\x89PNG")
    values = {row["name"]: row for row in result["rows"]}
    assert values["simulated, hidden tops unknown, from 0: valid plans"]["value"] == 0.5
    assert values["real, hidden tops unknown, from 0: valid plans"]["value"] is None
    assert [goal["met"] for goal in result["goals"]] == [False, None]
    assert len(told) == 2
