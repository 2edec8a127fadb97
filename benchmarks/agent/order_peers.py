"""Other methods on the orders of factory customers, task by task: all have the same number of episodes.

R-max with a remembered model, successor features and `infinite_mixture` act as the long-lived agent does: they
know the floor, walk to a point and use it, and remember what the order in progress has answered. Q-learning and
probabilistic policy reuse take single moves in the world's own states.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.agent.infinite_mixture import InfiniteMixture
from lifelore.agent.long_lived.families.factory_customers import ACTS, PAID, FactoryFamily, OrderTask
from lifelore.agent.long_lived.families.order_planning import UNWANTED, OrderTable
from lifelore.agent.long_lived.task_family import AGENTS, SharedKnowledge
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import uniform_rows
from lifelore.core.streams import stream
from lifelore.domains.factory.customer_orders import CUSTOMERS, LONGEST
from lifelore.domains.factory.factory import ASSEMBLED, N_STAGES, PROCURE, RAW, FactoryTask
from lifelore.interaction.baselines.probabilistic_policy_reuse import ProbabilisticPolicyReuse

Array = NDArray[np.float64]

KNOWN_AFTER = 5
"""Tries after which R-max takes a component as known; more explore longer."""


class Peer(Protocol):
    """A method that lives through orders."""

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """Discounted returns of the episodes of an order."""
        ...


class RememberedRmax:
    """R-max (Brafman and Tennenholtz, 2002) with a model of all orders and no types.

    Components that were tried less than `KNOWN_AFTER` times are taken as wanted; others are wanted as often as
    they were. The plan is the best tour under this law.
    """

    def __init__(self) -> None:
        self.counts = np.zeros((len(ACTS), 2))

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """See `Peer`."""
        task, shared = family.meet(number, AGENTS["full"])[1], SharedKnowledge.empty(family)
        found, effects = [], []
        for _ in range(n_episodes):
            task.begin()
            total, ended = 0.0, False
            while not ended:
                tries = self.counts.sum(axis=1, keepdims=True)
                law = np.where(tries >= KNOWN_AFTER, self.counts / np.maximum(tries, 1), np.eye(2)[PAID])
                plan = task.plan(law[None], tries[:, 0] > 0, None, shared)
                step = task.act(int(plan.acts[0]))
                total, ended = total + step.reward, step.ended
                effects += step.effects
            found.append(total)
        np.add.at(self.counts, tuple(np.array(effects).T), 1)
        return found


class SuccessorFeatures:
    """Successor features with generalised policy improvement (Barreto et al., 2017) over the tours of past orders.

    Features of an act: the cost of its way, which component was procured or assembled, and whether the order is
    complete. Rewards are linear in them: w is the mean pay of past orders, and the pay of this order where it is
    known. A policy is the best tour of a past order on this floor; its successor features are computed.
    """

    def __init__(self) -> None:
        self.tours: list[frozenset[int]] = []
        self.pay, self.n_tasks = np.zeros(9), 0

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """See `Peer`."""
        task = family.meet(number, AGENTS["full"])[1]
        found = []
        for _ in range(n_episodes):
            task.begin()
            total, ended = 0.0, False
            while not ended:
                step = task.act(self.act(task))
                total, ended = total + step.reward, step.ended
            found.append(total)
            wanted = frozenset(np.flatnonzero(task.known > UNWANTED).tolist())
            if wanted not in self.tours:
                self.tours.append(wanted)
        rewards = task.order.factory.rewards
        self.pay += np.where(task.known > UNWANTED, rewards.use, rewards.misuse)
        self.n_tasks += 1
        return found

    def act(self, task: OrderTask) -> int:
        """The first act of the tour with the largest ψ·w; single components where no tour has acts left."""
        rewards = task.order.factory.rewards
        weights = self.pay / max(self.n_tasks, 1)
        weights = np.where(task.known == UNWANTED, rewards.misuse, weights)
        weights = np.where(task.known > UNWANTED, rewards.use, weights)
        for tours in (self.tours, [frozenset([k]) for k in range(len(task.known))]):
            found = [self.value(task, tour, weights) for tour in tours]
            found = [one for one in found if one is not None]
            if found:
                return max(found)[1]
        raise AssertionError("an order in progress has a component that was not refused")

    @staticmethod
    def value(task: OrderTask, tour: frozenset[int], weights: Array) -> tuple[float, int] | None:
        """ψ·w of a tour from here, and its first act; None where it has none left."""
        now, table, rewards = task.state, task.table, task.order.factory.rewards
        gamma, n = task.order.factory.floor.discount, len(task.known)
        open_ = np.isin(np.arange(n), list(tour)) & (task.known != UNWANTED) | (now.stages > RAW)
        stages = np.where(open_, now.stages, ASSEMBLED)
        if (stages == ASSEMBLED).all():
            return None
        # A tour completes an order that agrees with it so far.
        agrees = not any(
            known == UNWANTED if k in tour else known > UNWANTED for k, known in enumerate(task.known)
        )
        total = 0.0
        power, place, discount, first = N_STAGES ** np.arange(n), now.place, 1.0, None
        while (stages < ASSEMBLED).any():
            act = int(table.acts[stages @ power, place])
            first = act if first is None else first
            total += discount * table.walk[place, act]
            discount *= float(table.shrink[place, act])
            total += discount * (weights[act] if act < n else rewards.use)
            stages[act % n] += 1
            if agrees and (stages == ASSEMBLED).all():
                total += discount * rewards.completion
            discount *= gamma
            place = act
        assert first is not None, "the tour has acts left"
        return total, first


class FlatQLearning:
    """Q-learning of single moves, from nothing in each task: layouts differ, so Q of other tasks means nothing."""

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """See `Peer`."""
        task, world, own = _tabular(family, number)
        settings = QLearning(n_episodes, LONGEST)
        _, curve = settings.learn(task.tables(), task.domain.discount, world=world, own=own)
        return curve.returns.tolist()


class PolicyReuse:
    """Probabilistic policy reuse: the best policies of the customers met before, computed for this floor."""

    def __init__(self) -> None:
        self.customers: list[str] = []

    def live(self, family: FactoryFamily, number: int, n_episodes: int) -> list[float]:
        """See `Peer`."""
        task, world, own = _tabular(family, number)
        wanted, tables = task.components, task.tables()
        table = family.meet(number, AGENTS["full"])[1].table
        library = [best_moves(table, task, CUSTOMERS[name]) for name in self.customers]
        policies = np.eye(6)[np.array(library, np.int64).reshape(len(library), task.domain.n_states)]
        schedule = QLearning(n_episodes, LONGEST).schedule(task.domain.discount)
        prq = ProbabilisticPolicyReuse(gain_unit=100.0)
        reuser = prq.begin(task.domain.n_states, policies, world, own)
        curve, _ = prq.learn(tables, uniform_rows(tables), policies, schedule, reuser)
        name = next(name for name, items in CUSTOMERS.items() if items == wanted)
        if name not in self.customers:
            self.customers.append(name)
        return curve.returns.tolist()


def best_moves(table: OrderTable, task: FactoryTask, items: tuple[int, ...]) -> NDArray[np.int64]:
    """(n_states,) the best actions for an order of other `items`; those not on the task's list stay raw."""
    factory, n = table.factory, table.factory.n_components
    gamma, pay, neighbour = factory.floor.discount, factory.rewards, factory.floor.neighbour
    ways = np.where(neighbour >= 0, table.moves[:, neighbour], factory.n_cells).argmin(axis=2)
    use = PROCURE + np.arange(2 * n) // n
    actions = np.where(table.moves == 0, use[:, None], ways)
    shrink = gamma**table.moves
    walk = pay.move * (1 - shrink) / (1 - gamma)
    power, last = N_STAGES ** np.arange(n), len(table.values) - 1
    stages = np.full((task.n_configurations, n), ASSEMBLED, np.int64)
    stages[:, list(items)] = RAW
    for place, item in enumerate(task.components):
        if item in items:
            stages[:, item] = task.stages[:, place]
    found = np.zeros((task.n_configurations, factory.n_cells), np.int64)
    for row, own in zip(found, stages, strict=True):
        components = np.flatnonzero(own < ASSEMBLED)
        if components.size:
            acts, following = components + n * own[components], own @ power + power[components]
            paid = pay.use + np.where(following == last, pay.completion, gamma * table.values[following, acts])
            best = acts[(walk[acts] + shrink[acts] * paid[:, None]).argmax(axis=0)]
            row[:] = actions[best, np.arange(factory.n_cells)]
    return found.ravel()


def _tabular(family: FactoryFamily, number: int):
    """The task of single moves, and the random streams of world and learner."""
    drawn, order = family.order(number)
    streams = (stream(family.seed, "bench", "long lived", who, number) for who in ("world", "own"))
    return order.factory.task(CUSTOMERS[drawn.hidden_type]), *streams


PEERS: dict[str, type[Peer]] = {
    "R-max, remembered model": RememberedRmax,
    "successor features, GPI": SuccessorFeatures,
    "infinite mixture, Gibbs sampling": InfiniteMixture,
    "probabilistic policy reuse": PolicyReuse,
    "Q-learning": FlatQLearning,
}
"""Peers by name."""
