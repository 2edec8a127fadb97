"""Plans of factory orders over points: the best tour for each set of wanted components, and tours that may err.

A place is one of the factory's points, or the start; an act walks to a point and uses it. With V(c, p) the largest
discounted return from place p in configuration c (a stage for each component; unwanted ones count as assembled):

    V(c, p) = max_a  Σ_{t<d} γ^t move + γ^d (use + [c' complete] completion + γ V(c', p_a)),  d moves from p to p_a

A tour for a set M follows V; where a component of M is refused it leaves M, and where M is done but the order goes
on, the likeliest of the components that were not tried comes next.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.core.compiled.jit import kernel
from lifelore.domains.factory.factory import N_STAGES, Factory

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

UNKNOWN, UNWANTED, WANTED = -1, 0, 1
"""What an order has shown of a component."""
LEAST_WEIGHT = 1e-3
"""Sets of components that are less probable than this under a type are left out of its expectations."""


@dataclass(frozen=True, eq=False)
class OrderTable:
    """The best acts of a factory for every set of components.

    Parameters
    ----------
    factory : Factory
        Entering any cell costs the same.
    values : (3^n, 2n + 1) float64
        V by configuration and place; places are the procurement points, the assembly points, and the start.
    acts : (3^n, 2n + 1) int64
        The best act: k procures component k, n + k assembles it.
    moves : (2n, n_cells) int64
        Number of moves from each cell to each point.
    walk, shrink : (2n + 1, 2n) float64
        Discounted cost of the way from a place to a point, and the discount of what follows it.
    """

    factory: Factory
    values: Array
    acts: Numbers
    moves: Numbers
    walk: Array
    shrink: Array

    @classmethod
    def of(cls, factory: Factory) -> "OrderTable":
        """The table of a factory."""
        points = np.concatenate([factory.procure_at, factory.assemble_at])
        places = np.append(points, factory.start)
        start, move = np.nonzero(factory.floor.neighbour >= 0)
        end = factory.floor.neighbour[start, move]
        graph = sparse.csr_matrix((np.ones(len(end)), (start, end)), shape=(factory.n_cells, factory.n_cells))
        # Moves go both ways, so distances from the points are those to the points.
        moves = csgraph.shortest_path(graph, unweighted=True, indices=points).astype(np.int64)
        gamma, pay = factory.floor.discount, factory.rewards
        shrink = gamma ** moves[:, places].T
        walk = pay.move * (1 - shrink) / (1 - gamma)
        values, acts = best_acts_of_orders(walk, shrink, gamma, pay.use, pay.completion, factory.n_components)
        return cls(factory, values, acts, moves, walk, shrink)

    @property
    def start(self) -> int:
        """Number of the place at the start."""
        return 2 * self.factory.n_components

    def returns(self, now: "OrderState", planned: NDArray[np.bool_], order: Numbers, sets: Numbers) -> Array:
        """Returns from now on of tours, (n_tours, n_sets), if the wanted components are each of the sets.

        Parameters
        ----------
        planned : (n_tours, n) bool
            The components M that a tour plans for.
        order : (n_tours, n) int64
            In which order a tour goes on to other components.
        sets : (n_sets, n) int64
            1 for a wanted component; each agrees with `now`.
        """
        pay = self.factory.rewards
        rewards = np.array([self.factory.floor.discount, pay.use, pay.misuse, pay.completion])
        begin = _planned_stages(now.stages, now.known, planned) @ N_STAGES ** np.arange(len(now.stages))
        tried = (now.stages > 0) | (now.known != UNKNOWN) | planned
        left = (sets * (now.stages < N_STAGES - 1)).sum(axis=1)
        return returns_of_tours(
            self.acts, self.walk, self.shrink, rewards, now.place, begin, tried, left, order, sets
        )

    def act(self, now: "OrderState", planned: NDArray[np.bool_], order: Numbers) -> int:
        """The next act of a tour, (n,) each."""
        stages = _planned_stages(now.stages, now.known, planned)
        power = N_STAGES ** np.arange(len(stages))
        if (stages == N_STAGES - 1).all():
            rest = [k for k in order if now.known[k] == UNKNOWN and now.stages[k] == 0]
            stages[rest[:1]] = 0
        return int(self.acts[stages @ power, now.place])


@dataclass(frozen=True, eq=False)
class OrderState:
    """What is known of an order in progress.

    Parameters
    ----------
    stages, known : (n,) int64
        Stage of each component, and `UNKNOWN`, `UNWANTED` or `WANTED`.
    place : int
    """

    stages: Numbers
    known: Numbers
    place: int

    def sets(self) -> Numbers:
        """The sets of components that may be wanted, (n_sets, n) int64: not all of a set is assembled yet."""
        unknown = np.flatnonzero(self.known == UNKNOWN)
        found = np.zeros((1 << len(unknown), len(self.known)), np.int64)
        found[:, self.known == WANTED] = 1
        found[:, unknown] = np.arange(len(found))[:, None] >> np.arange(len(unknown)) & 1
        return found[(found * (self.stages < N_STAGES - 1)).any(axis=1)]


def set_weights(wanted: Array, sets: Numbers) -> Array:
    """P(set | type), (n_types, n_sets), from the probability (n_types, n) that each component is wanted."""
    logs = np.log(np.stack([1 - wanted, wanted]).clip(1e-12))
    weights = logs[0] @ (1 - sets.T) + logs[1] @ sets.T
    weights = np.exp(weights - weights.max(axis=1, keepdims=True))
    weights /= weights.sum(axis=1, keepdims=True)
    weights[weights < LEAST_WEIGHT * weights.max(axis=1, keepdims=True)] = 0.0
    return weights / weights.sum(axis=1, keepdims=True)


def _planned_stages(stages: Numbers, known: Numbers, planned: NDArray[np.bool_]) -> Numbers:
    open_ = (known == WANTED) | (planned & (known == UNKNOWN)) | (stages > 0)
    return np.where(open_, stages, N_STAGES - 1)


@kernel
def best_acts_of_orders(walk, shrink, gamma, use, completion, n):
    """V and its acts, (3^n, 2n + 1) each, from the last configuration to the first."""
    n_configurations = 3**n
    values = np.zeros((n_configurations, 2 * n + 1))
    acts = np.zeros((n_configurations, 2 * n + 1), np.int64)
    after = np.zeros(n)
    possible = np.zeros(n, np.int64)
    for configuration in range(n_configurations - 2, -1, -1):
        n_possible, power = 0, 1
        for k in range(n):
            stage = configuration // power % 3
            if stage < 2:
                act, following = k + n * stage, configuration + power
                paid = use + (completion if following == n_configurations - 1 else 0.0)
                possible[n_possible], after[n_possible] = act, paid + gamma * values[following, act]
                n_possible += 1
            power *= 3
        for place in range(2 * n + 1):
            best = -np.inf
            for number in range(n_possible):
                act = possible[number]
                value = walk[place, act] + shrink[place, act] * after[number]
                if value > best:
                    best = value
                    acts[configuration, place] = act
            values[configuration, place] = best
    return values, acts


@kernel
def returns_of_tours(acts, walk, shrink, rewards, place, begin, tried, left, order, sets):
    """See `OrderTable.returns`; a tour begins in a configuration, and a set has a number of components left."""
    gamma, use, misuse, completion = rewards
    n = sets.shape[1]
    found = np.zeros((len(begin), len(sets)))
    power = 3 ** np.arange(n)
    for tour in range(len(begin)):
        for number in range(len(sets)):
            wanted, open_ = sets[number], ~tried[tour]
            configuration, to_do = begin[tour], left[number]
            here, discount, total = place, 1.0, 0.0
            while to_do > 0:
                if configuration == power[n - 1] * 3 - 1:
                    for k in order[tour]:
                        if open_[k]:
                            open_[k] = False
                            configuration -= 2 * power[k]
                            break
                act = acts[configuration, here]
                total += discount * walk[here, act]
                discount *= shrink[here, act]
                k = act % n
                if act < n and wanted[k] == 0:
                    total += discount * misuse
                    configuration += 2 * power[k]
                else:
                    total += discount * use
                    configuration += power[k]
                    if act >= n:
                        to_do -= 1
                        if to_do == 0:
                            total += discount * completion
                discount *= gamma
                here = act
            found[tour, number] = total
    return found
