"""Orders of hidden customers: what is shown, what pays, and the best return."""

import pytest

from lifelore.core import InputError, NotFoundError, stream
from lifelore.domains.factory.customer_orders import CUSTOMERS, LONGEST, CustomerOrder
from lifelore.domains.factory.modified_factory import modified_factory

LAYOUT = modified_factory(stream(0, "test"))


def test_the_optimal_policy_has_the_best_return():
    order = CustomerOrder(LAYOUT, "lamps")
    q = LAYOUT.task(CUSTOMERS["lamps"]).optimal_q()
    observation, total, discount = order.reset(), 0.0, 1.0
    while not order.ended:
        observation, reward, _ = order.step(int(q[order._now[0]].argmax()))
        total, discount = total + discount * reward, discount * LAYOUT.floor.discount
    assert observation.assembled == frozenset(CUSTOMERS["lamps"])
    assert total == pytest.approx(order.best_return, abs=1e-6)


def test_the_list_shows_in_what_succeeds_alone():
    seen = []
    for customer in ("bicycles", "chairs"):
        order = CustomerOrder(LAYOUT, customer)
        order._now = int(LAYOUT.procure_at[4]), 0, False
        observation, reward, _ = order.step(4)
        seen.append((reward, len(observation.procured)))
    assert seen == [(-10.0, 0), (10.0, 1)]
    assert CustomerOrder(LAYOUT, "bicycles").reset() == CustomerOrder(LAYOUT, "chairs").reset()


def test_mistakes_are_refused():
    with pytest.raises(NotFoundError, match="customer must be one of"):
        CustomerOrder(LAYOUT, "cars")
    order = CustomerOrder(LAYOUT, "carts")
    with pytest.raises(InputError, match=r"action must lie in \[0, 6\)"):
        order.step(6)
    assert [order.step(0)[2] for _ in range(LONGEST)] == [False] * (LONGEST - 1) + [True]
