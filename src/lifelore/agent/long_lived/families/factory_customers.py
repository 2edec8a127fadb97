"""Orders of factory customers as the long-lived agent meets them.

The floor and its points are known, the components that a customer wants are not. An act walks the shortest way to
a point and uses it: "procure component k", or "assemble component k". Each act is a cause, whose effect is that it
is paid or refused. An order answers the same act alike in all its episodes, so only new answers are effects; and
when an order ends, all components that it did not ask for are known to be unwanted.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.order_planning import (
    UNKNOWN,
    UNWANTED,
    WANTED,
    OrderState,
    OrderTable,
    set_weights,
)
from lifelore.agent.long_lived.task_family import Abilities, AgentTask, Plan, SharedKnowledge, Step, TaskFamily
from lifelore.domains.factory.customer_orders import CustomerOrder, FactoryCustomers
from lifelore.domains.factory.factory import ASSEMBLE, ASSEMBLED, N_COMPONENTS, PROCURE, PROCURED, RAW
from lifelore.domains.task_stream import DrawnTask, TaskStream

Array = NDArray[np.float64]

ACTS = tuple(f"{use} component {k}" for use in ("procure", "assemble") for k in range(N_COMPONENTS))
EFFECTS = ("paid", "refused")
PAID, REFUSED = range(2)
MOST_TABLES = 32
"""Tables of best acts that a family keeps, 6 MB each; that of an order not met for long is computed again."""


@dataclass(eq=False)
class FactoryFamily(TaskFamily):
    """Orders of factory customers; rewards are discounted, so that those of an episode add up to its return.

    Parameters
    ----------
    stream : TaskStream
        Its types are keys of `customer_orders.CUSTOMERS`.
    seed : int
        Of the layouts.
    """

    stream: TaskStream
    seed: int = 0

    name = "factory-customers"
    acts = ACTS
    n_causes = len(ACTS)
    n_effects = len(EFFECTS)
    groups = np.arange(len(ACTS)) // N_COMPONENTS

    def __post_init__(self) -> None:
        world = FactoryCustomers(self.stream, self.seed)
        self.table = lru_cache(MOST_TABLES)(lambda number: OrderTable.of(world.layout(number)))
        """Best acts in an order, by its number."""

    def order(self, number: int, context: int | None = None) -> tuple[DrawnTask, CustomerOrder]:
        """Order `number`, drawn and as the world has it."""
        return FactoryCustomers(self.stream, self.seed).task(number, context)

    def meet(self, number: int, abilities: Abilities, context: int | None = None) -> "tuple[DrawnTask, OrderTask]":
        """Order `number`, drawn and met; there are no relations to perceive."""
        table, drawn = self.table(number), self.stream.draw(number, context)
        return drawn, OrderTask(CustomerOrder(table.factory, drawn.hidden_type), table)

    def best_return(self, number: int, context: int | None = None) -> float:
        """The best discounted return."""
        return self.order(number, context)[1].best_return

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words."""
        return EFFECTS[effect]


class OrderTask(AgentTask):
    """An order as the agent meets it.

    Parameters
    ----------
    order : CustomerOrder
        Of its hidden list nothing is read.
    table : OrderTable
        Of the order's factory.
    """

    def __init__(self, order: CustomerOrder, table: OrderTable) -> None:
        self.order, self.table = order, table
        self.known = np.full(order.factory.n_components, UNKNOWN)
        self.begin()

    def begin(self) -> None:
        """Begin an episode at the start."""
        self.seen = self.order.reset()
        self._place, self._discount = self.table.start, 1.0

    @property
    def state(self) -> OrderState:
        """What is known of the order."""
        stages = np.full(len(self.known), RAW)
        stages[list(self.seen.procured)] = PROCURED
        stages[list(self.seen.assembled)] = ASSEMBLED
        return OrderState(stages, self.known, self._place)

    def describe(self) -> str:
        """What has been procured and assembled."""
        found = [f"{name} {sorted(items) or 'nothing'}" for name, items in self._items().items()]
        return ", ".join(found)

    def _items(self) -> dict[str, frozenset[int]]:
        return {"procured": self.seen.procured, "assembled": self.seen.assembled}

    # ---- acts ---------------------------------------------------------------------------------------

    def act(self, act: int) -> Step:
        """Walk to the act's point and use it."""
        use, component = divmod(act, len(self.known))
        before, gained, ended = self._items(), 0.0, False
        for action in (*self._way_to(act), (PROCURE, ASSEMBLE)[use]):
            self.seen, reward, ended = self.order.step(action)
            gained += self._discount * reward
            self._discount *= self.order.factory.floor.discount
            if ended:
                break
        self._place = act
        effect = PAID if self._items() != before else REFUSED
        return Step(gained, self._news(use, component, act, effect, ended), ended)

    def _news(self, use: int, component: int, act: int, effect: int, ended: bool) -> tuple[tuple[int, int], ...]:
        news = []
        if self.known[component] == UNKNOWN and use == 0:
            self.known[component] = WANTED if effect == PAID else UNWANTED
            news.append((act, effect))
        if ended and effect == PAID:
            for other in np.flatnonzero(self.known == UNKNOWN).tolist():
                self.known[other] = UNWANTED
                news.append((other, REFUSED))
        return tuple(news)

    def _way_to(self, act: int) -> list[int]:
        """Moves of a shortest way to the point of an act."""
        neighbour, moves_left = self.order.factory.floor.neighbour, self.table.moves[act]
        cell, way = self.seen.cell, []
        while moves_left[cell]:
            following = neighbour[cell]
            move = int(np.where(following >= 0, moves_left[following], len(neighbour)).argmin())
            way.append(move)
            cell = int(following[move])
        return way

    # ---- plans --------------------------------------------------------------------------------------

    def plan(self, laws: Array, tried: NDArray[np.bool_], new: int | None, shared: SharedKnowledge) -> Plan:
        """Each type's tour: for its likeliest components, as many as its law finds best."""
        now, n = self.state, len(self.known)
        wanted = laws[:, :n, PAID]
        sets = now.sets()
        weights = set_weights(wanted, sets)
        some = weights.any(axis=0)
        sets, weights = sets[some], weights[:, some]
        n_unknown = int((self.known == UNKNOWN).sum())
        found = np.empty((len(laws), len(sets)))
        acts = np.empty(len(laws), np.int64)
        for number in range(len(laws)):
            order = np.argsort(np.where(self.known == UNKNOWN, -wanted[number], np.inf), kind="stable")
            planned = np.zeros((n_unknown + 1, n), np.bool_)
            for most in range(n_unknown + 1):
                planned[most, order[:most]] = True
            own = np.flatnonzero(weights[number])
            orders = np.tile(order, (len(planned), 1))
            best = int((self.table.returns(now, planned, orders, sets[own]) @ weights[number, own]).argmax())
            found[number] = self.table.returns(now, planned[best : best + 1], order[None], sets)[0]
            acts[number] = self.table.act(now, planned[best], order)
        return Plan(self._discount * weights @ found.T, acts, acts)
