"""Factory customers as the long-lived agent meets them: tours, answers, and a life."""

import numpy as np
import pytest

from lifelore.agent.long_lived.families import factory_customers
from lifelore.agent.long_lived.families.factory_customers import ACTS, PAID, REFUSED, FactoryFamily, OrderTask
from lifelore.agent.long_lived.families.order_planning import (
    UNKNOWN,
    UNWANTED,
    WANTED,
    OrderState,
    OrderTable,
    set_weights,
)
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.long_life import live_long
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.streams import stream
from lifelore.domains.factory.customer_orders import CUSTOMERS, CustomerOrder
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.domains.task_stream import TaskStream

LAYOUT = modified_factory(stream(0, "test"))
TABLE = OrderTable.of(LAYOUT)
FULL = AGENTS["full"]


def certain_laws(*customers):
    """Laws of types whose wanted components are certain, (n_types, n_causes, n_effects)."""
    wanted = np.array([[k in CUSTOMERS[name] for k in range(9)] for name in customers], float)
    paid = np.concatenate([wanted, np.ones_like(wanted)], axis=1)
    return np.stack([paid, 1 - paid], axis=2)


def played(order, acts_of):
    """Return of an episode of acts chosen from the task's state."""
    task = OrderTask(order, TABLE)
    total, ended = 0.0, False
    while not ended:
        step = task.act(acts_of(task))
        total, ended = total + step.reward, step.ended
    return total


def plan(task, laws):
    return task.plan(laws, np.ones(len(ACTS), bool), None, Knowledge.empty(FactoryFamily(ALWAYS)).shared)


ALWAYS = TaskStream(("carts", "lamps"), n_contexts=1, loyalty=1.0)


@pytest.mark.parametrize("customer", CUSTOMERS)
def test_the_best_tour_is_the_optimum_over_single_moves(customer):
    order = CustomerOrder(LAYOUT, customer)
    wanted = np.isin(np.arange(9), CUSTOMERS[customer])
    whole = np.where(wanted, 0, 2) @ 3 ** np.arange(9)  # the configuration at the start
    assert TABLE.values[whole, TABLE.start] == pytest.approx(order.best_return, abs=1e-6)


@pytest.mark.parametrize("truth", ["bicycles", "lamps"])
def test_a_behaviour_is_worth_what_it_gets(truth):
    laws = certain_laws("bicycles", "carts", "lamps")
    order = CustomerOrder(LAYOUT, truth)
    own = ("bicycles", "carts", "lamps").index(truth)
    found = [played(order, lambda task, j=behaviour: plan(task, laws).acts[j]) for behaviour in range(3)]
    assert found[own] == pytest.approx(order.best_return)
    assert plan(OrderTask(order, TABLE), laws).values[own, own] == pytest.approx(found[own])
    assert max(np.delete(found, own)) < order.best_return


def test_returns_of_tours_are_those_of_the_world():
    order = CustomerOrder(LAYOUT, "chairs")  # wants 4, 6, 7, 8
    now = OrderTask(order, TABLE).state
    planned = np.isin(np.arange(9), (4, 1, 6))[None]
    rest = np.array([0, 8, 2, 7, 3, 1, 4, 5, 6])
    truth = np.isin(np.arange(9), CUSTOMERS["chairs"]).astype(int)
    expected = TABLE.returns(now, planned, rest[None], truth[None])
    assert played(order, lambda task: TABLE.act(task.state, planned[0], rest)) == pytest.approx(expected[0, 0])


def test_the_sets_agree_with_what_is_known():
    known = np.array([WANTED, UNWANTED, UNKNOWN, UNKNOWN])
    sets = OrderState(np.array([2, 0, 0, 0]), known, 0).sets()
    assert sorted(map(tuple, sets.tolist())) == [(1, 0, 0, 1), (1, 0, 1, 0), (1, 0, 1, 1)]
    weights = set_weights(np.array([[0.9, 0.1, 0.2, 0.5]]), sets)
    by_set = {tuple(s): w for s, w in zip(sets.tolist(), weights[0], strict=True)}
    total = 0.2 * 0.5 + 0.8 * 0.5 + 0.2 * 0.5
    assert by_set[1, 0, 0, 1] == pytest.approx(0.8 * 0.5 / total)
    assert by_set[1, 0, 1, 1] == pytest.approx(0.2 * 0.5 / total)


def test_answers_are_news_once_and_the_end_tells_the_rest():
    task = OrderTask(CustomerOrder(LAYOUT, "lamps"), TABLE)  # wants 2, 3, 6, 7
    assert [task.act(act).effects for act in (2, 0, 3)] == [((2, PAID),), ((0, REFUSED),), ((3, PAID),)]
    assert task.describe() == "procured [2, 3], assembled nothing"
    for act in (6, 7, 11, 12, 15):
        step = task.act(act)
    assert not step.ended
    step = task.act(16)
    assert step.ended
    assert set(step.effects) == {(k, REFUSED) for k in (1, 4, 5, 8)}
    task.begin()
    assert task.act(2).effects == ()
    assert task.act(0).effects == ()
    assert set(plan(task, certain_laws("carts")).acts) <= {3, 6, 7, 11}


def test_the_hidden_list_is_not_read():
    alike = [OrderTask(CustomerOrder(LAYOUT, name), TABLE) for name in ("bicycles", "carts")]
    laws = certain_laws("bicycles", "tables")
    first, second = (plan(task, laws) for task in alike)
    assert np.array_equal(first.values, second.values)
    assert np.array_equal(first.acts, second.acts)
    assert [task.act(0).effects for task in alike] == [((0, PAID),)] * 2


def missed(family, agent, tasks):
    """First returns below the best possible, and the number of types met."""
    lived = live_long(family, tasks=tasks, agent=agent, episodes=2)["tasks"]
    for task in lived:
        assert task["returns"][1] == pytest.approx(task["best_return"])
    points = np.array([task["best_return"] - task["returns"][0] for task in lived])
    return points, sum(task["new_type"] for task in lived)


def test_a_customer_is_learnt_from_one_order_and_served_best_from_the_next():
    points, types = missed(FactoryFamily(TaskStream(("carts",), n_contexts=1)), "full", 4)
    assert types == 1
    assert points[0] > 10
    assert points[2:] == pytest.approx(np.zeros(2), abs=1e-3)


@pytest.mark.slow
def test_context_and_reuse_and_memory_pay():
    family = FactoryFamily(TaskStream(tuple(CUSTOMERS), n_contexts=3, loyalty=1.0))
    agents = "full", "no-prior", "no-reuse", "scratch"
    full, no_prior, no_reuse, scratch = (missed(family, agent, 12)[0][6:].mean() for agent in agents)
    assert full < no_prior < scratch
    assert full < 0.3 * no_reuse


def test_tables_of_orders_met_last_are_kept(monkeypatch):
    monkeypatch.setattr(factory_customers, "MOST_TABLES", 2)
    family = FactoryFamily(TaskStream(tuple(CUSTOMERS)))
    first, second, again, _, kept, anew = (family.meet(number, FULL)[1].table for number in (0, 1, 0, 2, 0, 1))
    assert first is again is kept
    assert anew is not second
    np.testing.assert_array_equal(anew.values, second.values)
