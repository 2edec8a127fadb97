"""`bench relations` on scenes made by hand: its contract, who takes part, what is scored apart, what is open."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.perception import relation_learners, relation_scenes, relations, shipped_relations
from benchmarks.perception.relation_learners import LEARNERS, LOGIC, OURS, SHIPPED, THESIS
from benchmarks.perception.shipped_relations import calibration_error
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.peers import PEERS
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scenes.real_scenes import RealScene
from reproduction.chapter2.scoring import network_stability
from reproduction.chapter2.scoring.network_stability import contact_nodes, stability
from reproduction.chapter2.scoring.relation_scoring import JudgedPair

FEW = ("majority", "orientation histogram", "bounding-box rule", THESIS, OURS)


def box(low, size, step=0.008) -> np.ndarray:
    axes = [np.arange(0, side + step / 2, step) for side in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    last = np.array([axis[-1] for axis in axes])
    return grid[((grid == 0) | (grid == last)).any(axis=1)] + np.array(low)


def made(number: int, seed: int) -> SimpleNamespace:
    """A box on another or beside it, in turn, as the tabletop would give it."""
    rng = np.random.default_rng([seed, number])
    on = number % 2 == 0
    under = box((0, 0, 0), (0.08, 0.08, 0.06))
    at = (*rng.uniform(0, 0.02, 2), 0.062) if on else (0.08 + rng.uniform(0.006, 0.012), rng.uniform(0, 0.02), 0.0)
    other = box(at, (0.06, 0.06, 0.05))
    x, y = np.meshgrid(np.arange(-0.1, 0.25, 0.02), np.arange(-0.1, 0.2, 0.02))
    floor = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    parts = [floor, under, other]
    cloud = LabelledCloud(
        np.concatenate(parts), np.repeat([TABLE, 2, 3], [len(p) for p in parts]), None, np.array([0.0, -1, 1])
    )
    truth = (
        PairLabel(3, 2, "on") if on else PairLabel(2, 3, "adjacent"),
        PairLabel(2, TABLE, "on"),
        PairLabel(3, TABLE, "none" if on else "on"),
    )
    gaps = (SimpleNamespace(a=2, b=3, visible=0.002 if on else 0.01),)
    return SimpleNamespace(name=f"made{number}", cloud=cloud, truth=truth, gaps=gaps)


@pytest.fixture
def small(monkeypatch):
    """Four lessons and four tests a round, two real scenes, four methods."""
    drawn = lambda n, seed, settings: (made(number, seed) for number in range(n))  # noqa: E731
    real = [RealScene(one.name, one.cloud, one.truth) for one in (made(0, 3), made(1, 3))]
    few = {name: LEARNERS[name] for name in FEW}
    monkeypatch.setattr(relations, "tabletop_scenes", drawn)
    monkeypatch.setattr(shipped_relations, "tabletop_scenes", drawn)
    for module in (relations, shipped_relations):
        monkeypatch.setattr(module, "ARRANGED_SCENES", 2)
    monkeypatch.setattr(relations, "LEARNT_SCENES", 4)
    monkeypatch.setattr(relations, "JUDGED_SCENES", 4)
    monkeypatch.setattr(relations, "LEARNERS", few)
    monkeypatch.setattr(relation_learners, "LEARNERS", few)
    monkeypatch.setattr(relation_learners, "PEERS", {name: PEERS[name] for name in FEW[:3]})
    monkeypatch.setattr(relation_scenes, "real_scenes", lambda: real)
    monkeypatch.setattr(relations, "real_scenes_folder", lambda: "somewhere")


def test_the_answer_keeps_its_contract(small):
    told = []
    result = relations.bench_relations(1, lambda *at: told.append(at))
    assert list(result) == ["rows", "goals"]
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    names = [line["name"] for line in result["rows"]]
    assert len(set(names)) == len(names)
    for line in result["rows"]:
        assert list(line)[:5] == ["name", "value", "unit", "ratio_to", "ratio"]
        assert line["n"] > 0
    total = told[0][1]
    assert [(done, of) for done, of, _ in told] == [(i + 1, total) for i in range(total)]
    values = {line["name"]: line for line in result["rows"]}
    for where in ("simulated", "real", "real, learnt from the others too"):
        for who in (*FEW, THESIS + LOGIC, OURS + LOGIC):
            assert 0 <= values[f"{who}, {where}, exact"]["value"] <= 1
            if who in (OURS + LOGIC,):
                peer, name = (
                    "orientation histogram",
                    f"{who}, {where}, exact less that of the orientation histogram",
                )
                apart = values[f"{who}, {where}, exact"]["value"] - values[f"{peer}, {where}, exact"]["value"]
                assert values[name]["value"] == pytest.approx(apart)
                assert values[name]["ci95"][0] <= apart <= values[name]["ci95"][1]
    assert values["majority, simulated, exact"]["n"] == 4
    assert values[f"{SHIPPED + LOGIC}, real, exact"]["n"] == 2
    assert values[f"{SHIPPED + LOGIC}, simulated pile, exact"]["n"] == 2
    assert 0 <= values[f"{SHIPPED + LOGIC}, simulated, calibration error"]["value"] <= 1
    # Boxes made along the axes are what the rule of boxes is for.
    assert values["bounding-box rule, simulated, exact"]["value"] == 1
    for goal in result["goals"]:
        assert goal["measured"] is not None
        assert goal["met"] in (True, False)


def test_without_real_scenes_their_goals_are_left_open(small, monkeypatch):
    monkeypatch.setattr(relations, "real_scenes_folder", lambda: None)
    result = relations.bench_relations(1, lambda *at: None)
    real = [goal for goal in result["goals"] if ", real" in goal["name"]]
    assert len(real) == 9
    assert all(goal["measured"] is None and goal["met"] is None for goal in real)
    assert all(goal["met"] is not None for goal in result["goals"] if goal not in real)
    assert not any(", real, exact" in line["name"] for line in result["rows"])


def test_calibration_error_by_hand():
    def judged(confidence, right):
        said = Relation(2, 3, "on" if right else "none", confidence, 0.0)
        return JudgedPair("s", PairLabel(2, 3, "on"), said, 0.0)

    # Of three at 0.9 two are right, 0.7 / 3 off in sum; one at 0.4 is right.
    pairs = [judged(0.9, True), judged(0.9, True), judged(0.9, False), judged(0.4, True)]
    assert calibration_error(pairs) == pytest.approx((0.7 + 0.6) / 4)
    assert calibration_error([judged(1.0, True)]) == 0
    assert calibration_error([JudgedPair("s", PairLabel(2, 3, "on"), None, 0.0)]) is None


def test_everybody_takes_part():
    assert set(LEARNERS) == {*PEERS, THESIS, OURS}


def test_networks_by_hand():
    def nodes(*places):
        return np.array(places, float)

    before = {(2, 3): nodes([0, 0, 0], [1, 0, 0]), (3, 2): nodes([0, 0, 1]), (4, 2): nodes([5, 5, 5])}
    after = {(2, 3): nodes([1, 0, 0.002], [0.003, 0, 0]), (3, 2): nodes([0, 0, 1], [2, 0, 1])}
    found = stability(before, after)
    assert found.same_count == (True, False, False)
    assert found.shifts == pytest.approx((0.003, 0.002))


def test_networks_of_pairs_without_a_relation_are_left_out(monkeypatch):
    def one(a, b):
        point = SimpleNamespace(position=np.zeros(3))
        return Interface(a, b, 0.0, (point,), (point, point), np.zeros((0, 2), np.int64))

    truth = [PairLabel(3, 2, "on"), PairLabel(2, 4, "none"), PairLabel(3, 4, "adjacent", 1)]
    found = contact_nodes([one(2, 3), one(2, 4), one(3, 4), one(2, TABLE)], truth)
    assert {key: len(places) for key, places in found.items()} == {(2, 3): 1, (3, 2): 2}
    assert network_stability.stability(found, found).same_count == (True, True)
