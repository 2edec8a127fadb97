"""Multi-task Bayesian reinforcement learning (Wilson et al., 2007) on the orders of factory customers.

The orders of all customers come from an infinite mixture: each order has one of a number of classes that is not
known beforehand (Chinese restaurant process), and each class has its own probabilities that a component is wanted
(Beta prior). After each order, Gibbs sampling deals the past orders to classes anew. In a new order the classes
are weighed by what it has answered; one of them is the class that has no order yet.

Wilson et al. sample models from this posterior and follow the best policy of one of them. Here the act is the best
one, on the average over the whole posterior, among the best tours of the classes. Contexts are not used, because
the method has none. Thesis: §4.7.4.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.families.factory_customers import ACTS, PAID, FactoryFamily
from lifelore.agent.long_lived.families.order_planning import UNKNOWN, UNWANTED
from lifelore.agent.long_lived.task_family import AGENTS, SharedKnowledge
from lifelore.core.streams import stream
from lifelore.domains.factory.factory import N_COMPONENTS

Array = NDArray[np.float64]

CONCENTRATION = 1.0
"""α of the Chinese restaurant process: weight of a new class, in orders; more makes more classes."""
PSEUDO_COUNT = 0.5
"""Of a component being wanted and of its not being so, in each class; more makes classes alike."""
SWEEPS = 10
"""Sweeps of Gibbs sampling after each order; more cost time and let classes settle."""


class InfiniteMixture:
    """Lives through orders with a mixture over all that it has met.

    Attributes
    ----------
    wanted : list of (n,) float64
        Of each past order: 1 where a component was wanted, 0 where not, NaN where it was not found out.
    classes : list of int
        The class of each past order.
    """

    def __init__(self, seed: int = 0) -> None:
        self.wanted: list[Array] = []
        self.classes: list[int] = []
        self._generator = stream(seed, "bench", "infinite mixture")

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """See `order_peers.Peer`."""
        task, shared = family.meet(number, AGENTS["full"])[1], SharedKnowledge.empty(family)
        found = []
        for _ in range(n_episodes):
            task.begin()
            total, ended = 0.0, False
            while not ended:
                weights, laws = self.laws(_answers(task.known))
                plan = task.plan(laws, np.ones(len(ACTS), np.bool_), None, shared)
                step = task.act(int(plan.acts[int((weights @ plan.values).argmax())]))
                total, ended = total + step.reward, step.ended
            found.append(total)
        self.learn(_answers(task.known))
        return found

    def laws(self, answers: Array) -> tuple[Array, Array]:
        """P(class | answers), (n_classes + 1,), the last the new class; and its laws of acts' effects.

        Parameters
        ----------
        answers : (n,) float64
            As `wanted`.

        Returns
        -------
        weights : (n_classes + 1,) float64
            Sum to 1.
        laws : (n_classes + 1, 2 n, 2) float64
            Probabilities that an act is paid and refused; that assembly is paid is sure.
        """
        names = sorted(set(self.classes))
        probs = np.array([self._wanted_probs(np.array(self.classes) == name) for name in names] + [self._new()])
        sizes = np.array([self.classes.count(name) for name in names] + [CONCENTRATION])
        likelihood = np.where(np.isnan(answers), 1.0, np.where(answers == 1, probs, 1 - probs)).prod(axis=1)
        weights = sizes * likelihood
        laws = np.zeros((len(probs), 2 * N_COMPONENTS, 2))
        laws[:, :N_COMPONENTS, PAID], laws[:, N_COMPONENTS:, PAID] = probs, 1.0
        laws[:, :, 1 - PAID] = 1 - laws[:, :, PAID]
        return weights / weights.sum(), laws

    def learn(self, answers: Array) -> None:
        """Add an order, and deal all orders to classes anew."""
        self.wanted.append(answers)
        self.classes.append(self._drawn(len(self.wanted) - 1))
        for _ in range(SWEEPS):
            for order in self._generator.permutation(len(self.wanted)).tolist():
                self.classes[order] = self._drawn(order)

    def _drawn(self, order: int) -> int:
        """A class for an order, given those of all others."""
        classes = np.array([*self.classes, -1][: len(self.wanted)])
        others = np.arange(len(classes)) != order
        names = sorted(set(classes[others].tolist()) - {-1})
        members = [others & (classes == name) for name in names]
        probs = np.array([*map(self._wanted_probs, members), self._new()])
        answers = self.wanted[order]
        likelihood = np.where(np.isnan(answers), 1.0, np.where(answers == 1, probs, 1 - probs)).prod(axis=1)
        weights = likelihood * np.array([*(one.sum() for one in members), CONCENTRATION])
        unused = next(name for name in range(len(classes) + 1) if name not in names)
        return int(self._generator.choice([*names, unused], p=weights / weights.sum()))

    def _wanted_probs(self, members: NDArray[np.bool_]) -> Array:
        """Mean probability that each component is wanted in a class, from its orders (a mask)."""
        own = np.array([wanted for wanted, some in zip(self.wanted, members, strict=False) if some])
        known = ~np.isnan(own)
        return (np.nansum(own, axis=0) + PSEUDO_COUNT) / (known.sum(axis=0) + 2 * PSEUDO_COUNT)

    def _new(self) -> Array:
        return np.full(N_COMPONENTS, 0.5)


def _answers(known: NDArray[np.int64]) -> Array:
    """What an order has answered, as `InfiniteMixture.wanted`."""
    return np.where(known == UNKNOWN, np.nan, known > UNWANTED)
