"""What `bench reuse` is measured on: the surveillance reserve, and reserves of any size with tables of signals."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers import reuse_loops as loops
from lifelore.core.errors import LifeloreError
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import (
    BeliefEntropy,
    ExpectedImprovement,
    InformationDirected,
    KnowledgeGradient,
    SelectionRule,
)
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]

HORIZON = 50
NOISE = 20.0
SPREAD = 15.0
"""Types over which the belief of a large reserve falls by a factor e: 104 of them hold 99.9 %."""


class BinnedReturn(ReturnSignal):
    """Returns with a table of float32 in bins of equal width, the same for all policies: half the memory."""

    def table(self, n_bins: int = 8) -> SignalTable:
        outcomes = self.outcomes
        low, high = outcomes.bounds()
        cuts = np.linspace(low, high, n_bins + 1)[1:-1]
        probs = np.empty((outcomes.n_policies, outcomes.n_types, n_bins), np.float32)
        for policy in range(outcomes.n_policies):
            probs[policy] = np.diff(outcomes.cumulative(policy, cuts), axis=1, prepend=0.0, append=1.0)
        return SignalTable(probs)


class Reserve:
    """The thesis's reserve: 68 types, 68 policies, returns in `n_signals` bins."""

    def __init__(self, n_signals: int) -> None:
        self.n_signals = n_signals
        self.world = Surveillance()
        self.library = PolicyLibrary.from_means(self.world.mean, NOISE)
        self.flat = self.library.prior
        self.mean: Array = self.library.performance.mean
        self.deviation: Array = self.library.performance.deviation

    @cached_property
    def probs(self) -> Array:
        """The signals' table, (n_policies, n_types, n_signals)."""
        return self.library.table(self.n_signals).probs

    def learnt(self, n: int = 10) -> PolicyLibrary:
        """A library fitted to `n` samples of every pair."""
        noise = stream(0, "bench", "reuse", "samples").standard_normal((*self.mean.shape, n))
        return PolicyLibrary.from_samples(self.mean[..., None] + NOISE * noise)

    def rules(self) -> dict[str, SelectionRule]:
        """The rules whose loops are measured beside them."""
        n = self.n_signals
        return {
            "expected improvement": ExpectedImprovement(of="outcome"),
            "belief entropy": BeliefEntropy(n_bins=n),
            "information-directed": InformationDirected(n_bins=n),
            "knowledge gradient": KnowledgeGradient(n_bins=n, candidates="responses"),
        }

    def looped(self, name: str) -> Array:
        """The same scores by loops, larger is better."""
        if name == "expected improvement":
            top = self.library.performance.bounds()[1]
            return loops.expected_improvement(self.flat, self.mean, self.deviation, top)
        if name == "belief entropy":
            return loops.belief_entropy(self.flat, self.mean, self.probs, float(np.ptp(self.mean)))
        if name == "information-directed":
            return -loops.information_ratio(self.flat, self.mean, self.probs)
        return loops.knowledge_gradient(self.flat, self.mean, self.probs, HORIZON)

    def check(self) -> None:
        """Refuse a comparison of unlike work: loops and rules must agree on what is best."""
        for name, rule in self.rules().items():
            scores = rule.scores(self.library, self.flat, episodes_left=HORIZON)
            looped = self.looped(name)
            if looped[scores.argmax()] < looped.max() - 1e-3 * np.abs(looped).max():
                raise LifeloreError(
                    f"{name} must select what its loops select, got others: no ratio means anything"
                )
        agent = BayesianPolicyReuse(self.library, dynamics=TypeDynamics.static())
        agent.update(3, 55.0)
        if not np.allclose(agent.belief, loops.updated(self.flat, self.mean, self.deviation, 3, 55.0)):
            raise LifeloreError("an update must be the loop's, got another: the ratio means nothing")

    def task(self, number: int) -> tuple[int, Array]:
        """A type, and what each policy would return in each episode, (HORIZON, 68): the same for all methods."""
        random = stream(0, "bench", "reuse", "task", number)
        type_ = int(random.integers(len(self.mean)))
        return type_, self.mean[type_] + NOISE * random.standard_normal((HORIZON, self.mean.shape[1]))


class LargeReserve:
    """As many targets as asked for, scattered as densely as the thesis's; each surveys 15 cells around it.

    `learnt` gives every pair a deviation of its own, so that no two types are alike to any policy.
    """

    def __init__(self, size: int, n_signals: int, learnt: bool = False) -> None:
        self.size, self.n_signals, self.learnt = size, n_signals, learnt
        random = stream(0, "bench", "reuse", "large", size)
        places = random.random((size, 2)) * 26 * np.sqrt(size / 68)
        apart = np.abs(places[:, None] - places).max(axis=-1)
        mean = 10 + np.where(apart <= 15, 200 - 30 * apart, 0.0)
        # Deviations as of some two hundred samples each: no two pairs have the same.
        deviation = NOISE * (1 + 0.05 * random.standard_normal(mean.shape).clip(-3, 3)) if learnt else NOISE
        outcomes = GaussianOutcomes(mean, deviation)
        self.library = PolicyLibrary(outcomes, BinnedReturn(outcomes))
        self.library.table(n_signals)
        self.flat = self.library.prior
        falling = np.exp(-np.arange(size) / SPREAD)
        self.settled = (falling / falling.sum())[random.permutation(size)]

    @property
    def label(self) -> str:
        """Types, policies and signals."""
        return f"{self.size} x {self.size} x {self.n_signals}" + (", learnt models" if self.learnt else "")
