"""Bayesian policy reuse for a single task: select policies of a library, learn the task's type from signals.

    1  β⁰ ← G₀
    2  for each episode:  π ← argmax of the rule's scores under β;  run π, obtain σ;  β ← F(σ | ·, π) β, normalised

`select` and `update` are the two halves of an episode and need not alternate: `update` names the policy that a
signal is from. Signals may come late, in any order, or not at all. Where an episode shows several signals,
`observe` takes each, and `end_episode` ends it. Thesis: §4.2, Alg. 7; §4.5.2, Alg. 8.
"""

from collections import deque
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models
from lifelore.interaction.reuse.explanation import MAX_EVIDENCE, Evidence, Explanation, relative_evidence, two_best
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, ReuseAlgorithm
from lifelore.interaction.selection import SelectionRule, printed_rule, rule_of
from lifelore.interaction.selection.choice import Available, available_mask, best_policies

Array = NDArray[np.float64]


class RankedPolicy(NamedTuple):
    """A policy with its score by the agent's rule.

    policy : int
    name : str
    score : float, comparable within a single ranking
    """

    policy: int
    name: str
    score: float


class BayesianPolicyReuse:
    """An agent that faces a single task or user and reuses policies on it.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied. With plug-in models the agent uses what the library's models learn in place; with uncertain
        models it reads them once, at its start.
    rule : SelectionRule or str, optional
        A rule or its name; by default `InformationDirected`, or `Greedy` where the signals have no
        table.
    prior : (n_types,) float, optional
        At least 0, sums to 1 to 1e-9; the library's prior by default.
    dynamics : TypeDynamics, optional
        By default `TypeDynamics.learnt()`, a belief over hazards; `TypeDynamics.static()` as in the thesis.
        Each end of an episode is a step, and the order of signals matters unless types are static.
    horizon : int, optional
        Number of episodes K, at least 1; the knowledge gradient weighs information by the episodes left.
    seed : int or numpy generator
        For rules that draw, and for the choice among equal policies.
    models : {"uncertain", "plug-in"}
        Whether a model learnt from a finite number of runs is known to be uncertain: the belief is then over types
        and the parameters of their models, and each signal teaches both. "plug-in" takes estimates for the truth,
        as the thesis does. Exact models are the same under both.
    novelty : float or NoveltyDetector, optional
        Prior probability that no known type fits, in (0, 1), such as 0.05: the agent then computes after each
        signal how probable that is. Or a detector of this library without signals, such as a calibrated detector's
        ``restart()``. Signals must be outcomes or categories.

    Attributes
    ----------
    novelty : NoveltyDetector or None
        Its attribute ``probability`` is the probability that no known type fits, ``alarm`` whether a calibrated
        detector raised an alarm; None without the argument.

    Raises
    ------
    InputError
        The prior is no distribution over the types, the horizon is below 1, the dynamics are for another number
        of types, or `novelty` breaks its rule.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0, policies=["left", "right"])
    >>> agent = BayesianPolicyReuse(library)
    >>> agent.update("left", 0.5)
    >>> agent.belief.round(3).tolist(), library.policies[agent.select()]
    ([0.007, 0.993], 'right')
    """

    def __init__(
        self,
        library: PolicyLibrary,
        rule: SelectionRule | str | None = None,
        prior: ArrayLike | None = None,
        dynamics: Dynamics | None = None,
        horizon: int | None = None,
        seed: int | np.random.Generator = 0,
        models: Models = "uncertain",
        novelty: float | NoveltyDetector | None = None,
    ) -> None:
        self.library = library
        self.models: Models = models
        self.rule: SelectionRule = rule_of(rule, library)
        self.algorithm = ReuseAlgorithm(library, prior=prior, dynamics=dynamics, models=models)
        self.horizon = horizon
        if isinstance(novelty, float | int):
            novelty = NoveltyDetector(library, novelty, prior, dynamics, models)
        self.novelty = novelty
        self.episode, self.surprise, self.unexplained = 0, 0.0, 0
        self._taught = False
        self.generator = stream(seed, "policy reuse")
        self._selected: tuple[int, Array] | None = None
        self._evidence: deque[Evidence] = deque(maxlen=MAX_EVIDENCE)
        if horizon is not None and not horizon >= 1:
            raise InputError(f"horizon must be at least 1, got {horizon}")

    @classmethod
    def of_thesis(
        cls,
        library: PolicyLibrary,
        rule: SelectionRule | str = "expected-improvement",
        *,
        prior: ArrayLike | None = None,
        seed: int | np.random.Generator = 0,
    ) -> Self:
        """Algorithm 8 as printed: models taken for the truth, a type that never changes, a printed rule.

        Parameters
        ----------
        library : PolicyLibrary
            Where it is fitted to samples, ``from_samples(…, shrinkage=0)`` gives each pair its own variance.
        rule : str or SelectionRule
            A name stands for `printed_rule`; a rule is taken as it is.
        prior : (n_types,) float, optional
            G₀; the library's prior by default.
        seed : int or numpy generator

        Raises
        ------
        NotFoundError
            The thesis prints no rule of that name.

        Examples
        --------
        >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)
        >>> agent = BayesianPolicyReuse.of_thesis(library, "greedy")
        >>> agent.update(0, 4.0)
        >>> agent.belief.round(3).tolist()  # densities of 4 under 10 ± 2 and 0 ± 2: 4.5 and 2 squared deviations
        [0.076, 0.924]
        """
        chosen = printed_rule(rule) if isinstance(rule, str) else rule
        return cls(library, chosen, prior, TypeDynamics.static(), seed=seed, models="plug-in")

    # ---- the two halves of an episode ------------------------------------------------------------------

    def select(self, available: Available | None = None) -> int:
        """The number of the policy to run next.

        Parameters
        ----------
        available : sequence of str or int, or (n_policies,) bool, optional
            The policies that can be run now: names, numbers or a mask; all by default. Rules then choose as if
            the library had no others, see `available_mask`.

        Raises
        ------
        InputError
            No policy is available, or the mask has another length.
        NotFoundError
            There is no such policy.
        """
        mask = self._mask(available)
        self._selected = self.algorithm.select(0, self.rule, self.generator, mask, self.episodes_left)
        return self._selected[0]

    def select_top(self, k: int, available: Available | None = None) -> list[RankedPolicy]:
        """The `k` policies of the largest scores, best first; the first is the policy that `select` takes.

        Rules that draw rank by a single draw: belief sampling by the mean outcomes on one drawn type.

        Raises
        ------
        InputError
            `k` is below 1 or above the number of available policies; as for `select`.
        NotFoundError
            There is no such policy.
        """
        names, mask = self.library.policies, self._mask(available)
        scores = self.algorithm.scores(0, self.rule, self.generator, mask, self.episodes_left)
        best = best_policies(scores, k, self.generator).tolist()
        self._selected = best[0], scores
        return [RankedPolicy(policy, names[policy], float(scores[policy])) for policy in best]

    def update(self, policy: int | str, signal: Any, outcome: float | None = None) -> None:
        """Learn from the signal of a policy, and end the episode: `observe` and `end_episode`."""
        self.observe(policy, signal, outcome)
        self.end_episode()

    def observe(self, policy: int | str, signal: Any, outcome: float | None = None) -> None:
        """Learn from a signal of a policy within an episode, which may show more of them.

        A signal that no type explains leaves the belief as it is and raises the surprise.

        Parameters
        ----------
        policy : int or str
        signal
            As the library's signal model takes it.
        outcome : float, optional
            The return, where the signal is another one: it teaches how well the policy does in this task.

        Raises
        ------
        NotFoundError
            There is no such policy.
        InputError
            The signal model cannot have made the signal, or gave NaN or infinity. The belief stays as it was.
        """
        index = self.library.index_of_policy(policy)
        log_likelihood, log_evidence = self.algorithm.observe(0, index, signal, outcome)
        evidence = Evidence(index, log_likelihood, float(log_evidence))
        self._evidence.append(evidence)
        self.surprise += evidence.surprise
        self.unexplained += evidence.log_evidence == -np.inf
        if self.novelty is not None:
            self.novelty.observe(index, signal)

    def end_episode(self, outcome: Any = None) -> None:
        """End an episode, with or without signals: the type may have changed before the next.

        Parameters
        ----------
        outcome : optional
            How the episode ended, for dynamics that learn from it.
        """
        self.algorithm.end_episode(0, outcome)
        if self.novelty is not None:
            self.novelty.end_episode()
        self.episode += 1

    def teach(self, least: float = 0.95) -> str | None:
        """Let the library learn from the outcomes of this task, once it has ended and if its type is sure enough.

        Agents at work go on with what they read at their start.

        Parameters
        ----------
        least : float
            Least belief in a type, in (0.5, 1].

        Returns
        -------
        str or None
            The type that learnt; None where no type is believed that much, or nothing is to be learnt.

        Raises
        ------
        InputError
            `least` lies outside its range, or the task has taught before.
        """
        if not 0.5 < least <= 1:
            raise InputError(f"least must lie in (0.5, 1], got {least}")
        if self._taught:
            raise InputError("this task has taught the library before; its outcomes count once")
        belief, outcomes = self.belief, self.algorithm.outcomes
        type_ = int(belief.argmax())
        if belief[type_] < least or not outcomes.law.learns:
            return None
        self.library.performance.absorb(type_, outcomes.state(0))  # pyright: ignore
        self.library.forget_tables()
        self._taught = True
        return self.library.types[type_]

    # ---- the belief and its explanation ----------------------------------------------------------------

    @property
    def belief(self) -> Array:
        """β, (n_types,), sums to 1; a copy."""
        return self.algorithm.belief(0)

    @property
    def log_belief(self) -> Array:
        """log β, (n_types,); finite however small β is, minus infinity where it is 0; a copy."""
        return self.algorithm.log_belief[0].copy()

    @property
    def dynamics(self) -> Dynamics:
        """How types change, with what was learnt of it: for the next task of the same opponent or user."""
        return self.algorithm.changes.learnt(0, self.algorithm.log_belief[0])

    @property
    def episodes_left(self) -> int | None:
        """Number of episodes after the current episode; None without a horizon."""
        return None if self.horizon is None else max(self.horizon - self.episode - 1, 0)

    def expected_utility(self) -> Array:
        """Ũ(π) under the belief, (n_policies,)."""
        return self.algorithm.known(0).performance.expected(self.belief)

    def probabilities(self, available: Available | None = None) -> Array:
        """Probability that `select(available)` takes each policy, (n_policies,), sums to 1; errors as there."""
        return self.algorithm.propensities(0, self.rule, self._mask(available), self.episodes_left)

    def explain(self) -> Explanation:
        """The evidence of the last signals for each type, and the selected policy beside the runner-up."""
        names, types, last = self.library.policies, self.library.types, list(self._evidence)
        belief = self.belief
        order = np.argsort(-belief, kind="stable").tolist()
        evidence = relative_evidence(last, self.library.n_types)
        selected = score = runner_up = runner_up_score = None
        if self._selected is not None:
            selected, scores = self._selected
            score, runner_up, runner_up_score = two_best(scores, selected)
        return Explanation(
            selected=None if selected is None else names[selected],
            runner_up=None if runner_up is None else names[runner_up],
            score=score,
            runner_up_score=runner_up_score,
            belief={types[i]: float(belief[i]) for i in order},
            evidence={types[i]: evidence[:, i].tolist() for i in order},
            policies=[names[signal.policy] for signal in last],
            log_evidence=[float(signal.log_evidence) for signal in last],
            surprise=float(self.surprise),
            unexplained=int(self.unexplained),
            novelty=self.algorithm.unknown_probability(0) if self.novelty is None else self.novelty.probability,
        )

    def _mask(self, available: Available | None) -> Any:
        return None if available is None else available_mask(available, self.library.policies)
