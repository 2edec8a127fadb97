"""Orders of hidden customers in modified factories: the agent finds out which components a customer wants.

Every task has a new layout, whose points are known. The list of components is the customer's type and is not
shown: procuring or assembling a component of the list succeeds and pays, any other use costs (`FactoryRewards`).
"""

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from lifelore.core.errors import NotFoundError
from lifelore.core.mdp import COLLISION, TERMINAL
from lifelore.core.streams import stream
from lifelore.domains.factory.factory import ACTION_NAMES, ASSEMBLED, RAW, Factory
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.domains.task_stream import CountedTask, DrawnTask, TaskStream

CUSTOMERS = MappingProxyType(
    {
        "bicycles": (0, 1, 2, 3),
        "carts": (0, 1, 4, 5),
        "lamps": (2, 3, 6, 7),
        "chairs": (4, 6, 7, 8),
        "tables": (1, 5, 7, 8),
        "drones": (0, 3, 5, 8),
    }
)
"""Customers' types and the components of their orders; each component is wanted by two or three types."""
LONGEST = 2000
"""Actions after which an order is cut."""


@dataclass(frozen=True)
class OrderObservation:
    """The cell, the components that were procured or assembled so far, and whether the last move hit a wall."""

    cell: int
    procured: frozenset[int]
    assembled: frozenset[int]
    collision: bool = False


class CustomerOrder(CountedTask):
    """One order: a factory and a hidden list of components.

    Parameters
    ----------
    factory : Factory
    customer : str
        A key of `CUSTOMERS`.

    Raises
    ------
    NotFoundError
        No customer has this name.
    """

    n_actions, longest = len(ACTION_NAMES), LONGEST

    def __init__(self, factory: Factory, customer: str) -> None:
        if customer not in CUSTOMERS:
            raise NotFoundError(f"customer must be one of {', '.join(CUSTOMERS)}, got {customer!r}")
        self.factory, self.customer = factory, customer
        self._task = factory.task(CUSTOMERS[customer])
        self._step = getattr(self._task.domain.step, "py_func", self._task.domain.step)
        super().__init__(factory.start)

    @property
    def best_return(self) -> float:
        """Largest discounted return (the factory's discount) that an agent which knows the list can have."""
        return float(self._task.optimal_q()[self.factory.start].max())

    def _act(self, state: int, action: int) -> tuple[int, float, bool, bool]:
        following, reward, event = self._step(self._task.params, state, action, 0.5)
        return int(following), float(reward), bool(event & TERMINAL), bool(event & COLLISION)

    def _observed(self, state: int, refused: bool) -> OrderObservation:
        configuration, cell = divmod(state, self.factory.n_cells)
        stages = self._task.stages[configuration]
        items = np.array(self._task.components)
        return OrderObservation(
            cell,
            frozenset(items[stages > RAW].tolist()),
            frozenset(items[stages == ASSEMBLED].tolist()),
            refused,
        )


@dataclass(frozen=True)
class FactoryCustomers:
    """Orders by number: a new layout for every task, and a customer of the stream's type.

    Parameters
    ----------
    stream : TaskStream
        Its types are keys of `CUSTOMERS`.
    seed : int
        Of the layouts.
    """

    stream: TaskStream
    seed: int = 0

    def task(self, number: int, context: int | None = None) -> tuple[DrawnTask, CustomerOrder]:
        """Task `number` and its world, in a chosen context if given; the same for the same number.

        Examples
        --------
        >>> orders = FactoryCustomers(TaskStream(tuple(CUSTOMERS)))
        >>> drawn, order = orders.task(0)
        >>> order.customer == drawn.hidden_type
        True
        """
        drawn = self.stream.draw(number, context)
        return drawn, CustomerOrder(self.layout(number), drawn.hidden_type)

    def layout(self, number: int) -> Factory:
        """The factory of task `number`."""
        return modified_factory(stream(self.seed, "factory customers", "layout", number))
