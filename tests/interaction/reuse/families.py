"""Every family of signals for the tests of Algorithm 7: a small library, its signals, and their law by hand.

Three types, two policies. `predictive` is the law as `NaiveUncertainReuse` takes it: normals by numerical
integration, categories and steps by urns, exact models by their printed densities. Nothing of it is taken from the
code under test. Families that learn hold several spreads possible, except steps, which have none.
"""

from collections.abc import Callable
from itertools import pairwise
from math import fsum, inf, log
from typing import Any, NamedTuple

import numpy as np

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from lifelore.interaction.signals.reward_signal import RewardSignal
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

from ..twins.naive_models import NaiveUncertainReuse, NormalPair, Predictive, category_law, normal_law
from ..twins.naive_reuse import log_of, normal_log_density, steps_log_probability

N_TYPES, N_POLICIES = 3, 2
PRIOR = [0.2, 0.5, 0.3]
SPREAD = Spread.up_to(0.8)
MEAN = np.array([[0.0, 12.0], [9.0, -4.0], [-6.0, 3.0]])
PROBS = np.array(
    [
        [[0.7, 0.2, 0.1, 0.0], [0.1, 0.4, 0.5, 0.0]],
        [[0.0, 0.5, 0.5, 0.0], [0.3, 0.3, 0.4, 0.0]],
        [[0.2, 0.6, 0.2, 0.0], [0.6, 0.4, 0.0, 0.0]],
    ]
)
"""Of four categories; no type shows the last."""
EDGES = [-40.0, -8.0, 0.0, 6.0, 15.0, 40.0]
VALUES = [0.0, 3.0, 10.0, 20.0]


class Family(NamedTuple):
    """A library and its signals.

    library : callable that makes the library
    draw : callable that draws a signal by a generator
    predictive : Predictive
        The law by hand.
    learns : bool
        Whether users' signals change the law.
    impossible : signal that no type can have shown; None where any signal is possible
    spreads : bool
        Whether users of a type may differ.
    by_policy : bool
        Whether a signal tells of its policy alone.
    """

    library: Callable[[], PolicyLibrary]
    draw: Callable[[np.random.Generator], Any]
    predictive: Predictive
    learns: bool = False
    impossible: Any = None
    spreads: bool = True
    by_policy: bool = True

    def twin(self, rate: float = 0.0, spread: Spread = SPREAD) -> NaiveUncertainReuse:
        """The slow twin of a user, whose type changes with probability `rate`."""
        if not (self.learns and self.spreads):
            spread = Spread.known(0.0)
        return NaiveUncertainReuse(PRIOR, spread.values.tolist(), spread.weights.tolist(), self.predictive, rate)

    def place(self, policy: int) -> int:
        """The policy under whose number the twin keeps a signal."""
        return policy if self.by_policy else 0


def with_spread(library: PolicyLibrary, spread: Spread) -> PolicyLibrary:
    """The library, whose models that are learnt from runs hold `spread` possible."""
    performance, signal = library.performance, library.signal
    if isinstance(performance, GaussianOutcomes):
        learnt = np.isfinite(performance.moments.count).any()
    else:
        learnt = isinstance(performance, CountedOutcomes) and not performance.exact
    if learnt:
        performance.spread = spread  # pyright: ignore[reportAttributeAccessIssue]
    if isinstance(signal, CategorySignal) and signal.totals is not None:
        signal._spread = spread
    return library


def of_performance(performance: Any, signal: Any = None) -> PolicyLibrary:
    """The library of an outcome model with `SPREAD`."""
    return with_spread(PolicyLibrary(performance, signal, prior=np.array(PRIOR)), SPREAD)


def sampled(model: str, **options: Any) -> PolicyLibrary:
    """A library learnt from six runs of each pair."""
    noise = np.random.default_rng(1).normal(scale=5, size=(N_TYPES, N_POLICIES, 6))
    return of_performance(PolicyLibrary.from_samples(MEAN[..., None] + noise, model=model, **options).performance)


def uneven() -> PolicyLibrary:
    """Runs differ in number, deviations between pairs, and a pair is known exactly."""
    count = [[3.0, 40.0], [np.inf, 7.0], [5.0, 12.0]]
    return of_performance(GaussianOutcomes(MEAN, [[2.0, 6.0], [4.0, 9.0], [5.0, 3.0]], count))


def categorical() -> PolicyLibrary:
    return of_performance(CategoricalOutcomes(VALUES, PROBS, count=8))


def exact(signal: Any = None) -> PolicyLibrary:
    return of_performance(GaussianOutcomes(MEAN, 5.0), signal)


def categories() -> PolicyLibrary:
    signal = CategorySignal(PROBS, count=np.array([[4.0, 9.0], [12.0, 5.0], [7.0, 7.0]]))
    return exact(signal)


# ---- steps: states 0 and 1, one action, two outcomes ---------------------------------------------------------

STEPS = np.array([[[[5.0, 1.0]], [[2.0, 2.0]]], [[[1.0, 5.0]], [[0.0, 3.0]]], [[[3.0, 3.0]], [[4.0, 0.0]]]])
"""Counts (type, state, action, outcome)."""
PSEUDO_COUNT = 0.5


def episode(random: np.random.Generator) -> list[tuple[int, int, int]]:
    """Up to four steps: state, action, number of the outcome."""
    return [(int(state), 0, int(after)) for state, after in random.integers(2, size=(random.integers(5), 2))]


def reward_episode(random: np.random.Generator) -> list[tuple[int, int, float]]:
    """An episode whose outcomes are the rewards 0 and 5."""
    return [(state, action, 5.0 * outcome) for state, action, outcome in episode(random)]


def urn_of_steps(counts: np.ndarray, earlier: Any, steps: list[tuple[int, int, int]]) -> float:
    """Log probability of steps in their order; each adds a ball to the urn of its state and action.

    Parameters
    ----------
    counts : (n_states, n_actions, n_outcomes)
        Of the library, pseudo-counts included.
    earlier : sequence of (steps, weight)
    """
    urns = counts.copy()
    for shown, weight in earlier:
        for step in shown:
            urns[step] += weight
    logs = []
    for state, action, outcome in steps:
        logs.append(log_of(urns[state, action, outcome]) - log(urns[state, action].sum()))
        urns[state, action, outcome] += 1
    return fsum(logs)


def coded(earlier: Any) -> list[Any]:
    """Earlier episodes with places of rewards instead of the rewards."""
    return [([(s, a, int(r / 5)) for s, a, r in steps], weight) for steps, weight in earlier]


# ---- laws by hand --------------------------------------------------------------------------------------------


def learnt_normals(library: PolicyLibrary) -> Predictive:
    """The law of the library's moments, by numerical integration."""
    found: Any = library.performance
    fields = (found.moments.mean, found.moments.variance, found.moments.count, found.moments.freedom)
    return normal_law([[NormalPair(*(field[pair].item() for field in fields)) for pair in row] for row in PAIRS])


PAIRS = [[(type_, policy) for policy in range(N_POLICIES)] for type_ in range(N_TYPES)]


def in_bins(library: PolicyLibrary) -> Predictive:
    """The urn of a histogram's bins, as a density."""
    urn = category_law(library.performance.counts.tolist())  # pyright: ignore

    def cell(value: float) -> int:
        inside = [low <= value < high for low, high in pairwise(EDGES)]
        return inside.index(True)

    def predictive(type_, policy, spread, earlier, value):
        if not EDGES[0] <= value < EDGES[-1]:
            return -inf
        place = cell(value)
        shown = [(cell(x), weight) for x, weight in earlier]
        return urn(type_, policy, spread, shown, place) - log(EDGES[place + 1] - EDGES[place])

    return predictive


def of_values(counts: np.ndarray) -> Predictive:
    """The urn of a few values; a value that is none of them is impossible."""
    urn = category_law(counts.tolist())

    def predictive(type_, policy, spread, earlier, value):
        if value not in VALUES:
            return -inf
        shown = [(VALUES.index(x), weight) for x, weight in earlier]
        return urn(type_, policy, spread, shown, VALUES.index(value))

    return predictive


def fixed(density: Callable[[int, int, Any], float]) -> Predictive:
    """The law of an exact model, which nothing that users show changes."""
    return lambda type_, policy, spread, earlier, signal: density(type_, policy, signal)


def normal_density(type_: int, policy: int, value: float) -> float:
    return normal_log_density(value, MEAN[type_, policy].item(), 5.0)


def category_density(type_: int, policy: int, category: int) -> float:
    return log_of(PROBS[type_, policy, category].item())


def own_density(type_: int, policy: int, word: str) -> float:
    """A caller's function of words: types are told apart by their length."""
    return -inf if word == "never" else -abs(len(word) - type_ - policy)


def reward_density(type_: int, policy: int, rewards: list[float]) -> float:
    return fsum(normal_density(type_, policy, reward) for reward in rewards)


def joint_density(type_: int, policy: int, parts: tuple[int, float]) -> float:
    return category_density(type_, policy, parts[0]) + normal_density(type_, policy, parts[1])


def plug_in_steps(type_: int, policy: int, steps: list[tuple[int, int, int]]) -> float:
    table = STEPS[type_] / STEPS[type_].sum(axis=-1, keepdims=True)
    return steps_log_probability(steps, table.tolist())


def own_likelihood(policy: int, word: str) -> list[float]:
    """At the top of a module, as pickle needs it."""
    return [own_density(type_, policy, word) for type_ in range(N_TYPES)]


WORDS = LikelihoodSignal(own_likelihood, N_TYPES)
STEP_TABLE = STEPS / STEPS.sum(axis=-1, keepdims=True)
BY_POLICY = np.stack([STEPS, STEPS[::-1]], axis=1) + PSEUDO_COUNT


def steps_by_policy() -> PolicyLibrary:
    """Steps whose table depends on the policy."""
    totals = BY_POLICY.sum(axis=-1)
    return exact(StepRewardSignal([0.0, 5.0], BY_POLICY / totals[..., None], count=totals))


def number(random: np.random.Generator) -> float:
    return float(random.normal(2, 10))


def one_of(*signals: Any) -> Callable[[np.random.Generator], Any]:
    return lambda random: signals[int(random.integers(len(signals)))]


FAMILIES = {
    "gaussian": Family(lambda: sampled("gaussian"), number, learnt_normals(sampled("gaussian")), True),
    "student-t": Family(lambda: sampled("student-t"), number, learnt_normals(sampled("student-t")), True),
    "uneven": Family(uneven, number, learnt_normals(uneven()), True),
    "histogram": Family(
        lambda: sampled("histogram", edges=EDGES), number, in_bins(sampled("histogram", edges=EDGES)), True, 99.0
    ),
    "categorical": Family(categorical, one_of(0.0, 3.0, 10.0), of_values(8 * PROBS), True, 20.0),
    "category": Family(
        categories,
        one_of(0, 1, 2),
        category_law((PROBS * [[[4.0], [9.0]], [[12.0], [5.0]], [[7.0], [7.0]]]).tolist()),
        True,
        3,
    ),
    "transition": Family(
        lambda: exact(TransitionSignal.from_counts(STEPS, PSEUDO_COUNT)),
        episode,
        lambda i, policy, spread, earlier, steps: urn_of_steps(STEPS[i] + PSEUDO_COUNT, earlier, steps),
        True,
        spreads=False,
        by_policy=False,
    ),
    "step-reward": Family(
        steps_by_policy,
        reward_episode,
        lambda i, policy, spread, earlier, steps: urn_of_steps(
            BY_POLICY[i, policy], coded(earlier), coded([(steps, 1.0)])[0][0]
        ),
        True,
        spreads=False,
    ),
    "exact outcomes": Family(exact, number, fixed(normal_density)),
    "exact categories": Family(
        lambda: exact(CategorySignal(PROBS)), one_of(0, 1, 2), fixed(category_density), impossible=3
    ),
    "exact steps": Family(lambda: exact(TransitionSignal(STEP_TABLE)), episode, fixed(plug_in_steps)),
    "reward": Family(
        lambda: exact(RewardSignal(GaussianOutcomes(MEAN, 5.0))),
        lambda random: random.normal(2, 8, int(random.integers(4))).tolist(),
        fixed(reward_density),
    ),
    "joint": Family(
        lambda: exact(JointSignal([CategorySignal(PROBS), exact().signal])),
        lambda random: (int(random.integers(3)), number(random)),
        fixed(joint_density),
        impossible=(3, 0.0),
    ),
    "own": Family(lambda: exact(WORDS), one_of("a", "few", "words"), fixed(own_density), impossible="never"),
}
