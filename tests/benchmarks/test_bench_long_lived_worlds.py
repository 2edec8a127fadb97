"""`bench long_lived_worlds`, small: its peers, its pairs, its rows and its figure."""

import numpy as np
import pytest

from benchmarks import BENCHES
from benchmarks.agent import long_lived_worlds as case
from benchmarks.agent import world_lives
from benchmarks.agent.infinite_mixture import PSEUDO_COUNT, InfiniteMixture
from benchmarks.agent.order_peers import PEERS, RememberedRmax, SuccessorFeatures, best_moves
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.families.order_planning import OrderTable
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.domains.task_stream import TaskStream

ONE_CUSTOMER = FactoryFamily(TaskStream(("carts",), n_contexts=1))


@pytest.mark.parametrize("items", [(0, 1, 2, 3), (2, 5, 6)])
def test_the_policies_that_are_reused_are_the_best_of_their_order(items):
    factory = modified_factory(np.random.default_rng(1))
    own, table = factory.task((0, 1, 2, 3)), OrderTable.of(factory)
    moves = best_moves(table, own, items).reshape(own.n_configurations, -1)
    if items == own.components:
        q = own.optimal_q().reshape(own.n_configurations, factory.n_cells, -1)[:-1]
        assert np.take_along_axis(q, moves[:-1, :, None], 2)[:, :, 0] == pytest.approx(q.max(axis=2), abs=1e-6)
    else:
        other = factory.task(items)
        first = other.optimal_q()[: factory.n_cells]
        assert first[np.arange(factory.n_cells), moves[0]] == pytest.approx(first.max(axis=1), abs=1e-6)


@pytest.mark.parametrize("kind", [RememberedRmax, SuccessorFeatures, InfiniteMixture])
def test_peers_learn_a_single_customer(kind):
    peer, best = kind(), [ONE_CUSTOMER.best_return(number) for number in range(8)]
    missed = np.array([best[number] - np.array(peer.live(ONE_CUSTOMER, number, 2)) for number in range(8)])
    assert missed.min() > -1e-9
    assert missed[0, 0] > 1
    assert missed[-1] == pytest.approx([0, 0], abs=1e-6)


def orders_of(*customers):
    """What orders of these customers answer; n components."""
    found = np.zeros((len(customers), 9))
    for row, name in zip(found, customers, strict=True):
        row[list(CUSTOMERS[name])] = 1
    return found


def test_the_mixture_finds_the_customers_that_it_was_not_told():
    peer = InfiniteMixture()
    names = ["bicycles", "chairs", "drones"] * 8
    for answers in orders_of(*names):
        peer.learn(answers)
    groups = {name: {peer.classes[i] for i, own in enumerate(names) if own == name} for name in set(names)}
    assert all(len(group) == 1 for group in groups.values())
    assert len(set(peer.classes)) == 3


def test_answers_weigh_the_classes_by_bayes():
    peer = InfiniteMixture()
    peer.wanted, peer.classes = list(orders_of("bicycles", "bicycles", "chairs")), [0, 0, 1]
    unknown = np.full(9, np.nan)
    weights, laws = peer.laws(unknown)
    assert weights == pytest.approx([2 / 4, 1 / 4, 1 / 4])
    often, once = (2 + PSEUDO_COUNT) / 3, (1 + PSEUDO_COUNT) / 2
    assert laws[0, :9, 0] == pytest.approx([often] * 4 + [1 - often] * 5)
    assert laws[1, 4, 0] == once
    assert laws[2, :9, 0].tolist() == [0.5] * 9
    assert laws.sum(axis=2) == pytest.approx(np.ones((3, 18)))
    # Component 4 is wanted: by chairs, and by no bicycle.
    answered = unknown.copy()
    answered[4] = 1
    joint = np.array([2 * (1 - often), once, 0.5])
    assert peer.laws(answered)[0] == pytest.approx(joint / joint.sum())


def test_q_learning_and_policy_reuse_have_as_many_episodes_and_no_more_than_the_best_return():
    for name in ("Q-learning", "probabilistic policy reuse"):
        peer = PEERS[name]()
        returns = np.array([peer.live(ONE_CUSTOMER, number, 3) for number in range(2)])
        assert returns.shape == (2, 3)
        assert (returns <= np.array([[ONE_CUSTOMER.best_return(k)] for k in range(2)]) + 1e-9).all()


def test_late_types_come_after_half_of_the_tasks():
    arrivals, changes = world_lives._changes("drones", 40)
    stream = TaskStream(tuple(CUSTOMERS), 0, 6, arrivals=arrivals, changes=changes)
    assert stream.draw(20).hidden_type == "drones"
    assert "drones" not in {stream.draw(number).hidden_type for number in range(20)}
    assert changes == (30,)


@pytest.mark.slow
def test_rows_goals_and_figure(monkeypatch, tmp_path):
    small = world_lives.cases(n_orders=4, n_ways=4)
    monkeypatch.setattr(case, "cases", lambda map: small)
    steps = []
    document = case.bench_long_lived_worlds(1, lambda *at: steps.append(at[:2]), out=tmp_path)
    assert BENCHES["long_lived_worlds"] == "agent"
    assert steps == [(done, 3) for done in range(1, 4)]
    rows = {row["name"]: row for row in document["rows"]}
    assert len(rows) == len(document["rows"])
    for half in ("first half", "second half"):
        own, scratch = (rows[f"factory, {half}: {name}"] for name in ("full", "scratch"))
        assert own["value"] >= 0
        assert own["ratio"] == pytest.approx(own["value"] / scratch["value"])
        more = rows[f"factory, {half}: scratch, more than full"]["value"]
        assert more == pytest.approx(scratch["value"] - own["value"])
        assert rows[f"office, {half}: best possible return"]["value"] < 0
    assert rows["factory that changes: alarm at the first task of the late type"]["value"] in (0.0, 1.0)
    assert [goal["goal"] for goal in document["goals"]] == [">= 0.0"] * 6
    assert (tmp_path / "bench_long_lived_worlds.png").stat().st_size > 5000
