"""Bayesian policy reuse: select a policy from a library, learn from its signal which type of task this is.

    1  β⁰ ← G₀
    2  for each episode:  π ← argmax of the rule's scores under β;  run π, obtain σ;  β ← F(σ | ·, π) β, normalised

`select` and `update` are the two halves of an episode, and need not alternate: `update` says which policy a
signal is from, so signals may come late, in any order, or not at all. Thesis: §4.2, Alg. 7; §4.5.2, Alg. 8.
"""

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.belief import expected_utility, log_prior
from lifelore.interaction.beliefs.belief_kernels import bayes_row, gaussian_row
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.reuse.evidence import (
    KEPT,
    Evidence,
    Explanation,
    relative_evidence,
    surprise_of,
    two_best,
)
from lifelore.interaction.reuse.user_likelihood import rows_of_normals
from lifelore.interaction.selection import ExpectedImprovement, SelectionRule
from lifelore.interaction.selection.choice import choose

Array = NDArray[np.float64]


class BayesianPolicyReuse:
    """An agent that meets one task and reuses policies on it.

    Parameters
    ----------
    library : PolicyLibrary
        Kept, not copied: what its models learn, the agent knows.
    rule : SelectionRule, optional
        `ExpectedImprovement` unless given.
    prior : (n_types,) float, optional
        The library's unless given; at least 0, sums to 1 to 1e-9.
    dynamics : TypeDynamics, optional
        Static unless given. Otherwise each `update` is also an episode's step, and its order matters.
    horizon : int, optional
        Number of episodes K, at least 1; the knowledge gradient weighs what is learnt by the episodes left.
    seed : int or numpy generator
        For rules that draw and among equal policies.

    Raises
    ------
    InputError
        The prior is none, the horizon below 1, or the dynamics are for another number of types.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0, policies=["left", "right"])
    >>> agent = BayesianPolicyReuse(library)
    >>> agent.update("left", 0.5)
    >>> agent.belief.round(3).tolist(), library.policies[agent.select()]
    ([0.0, 1.0], 'right')
    """

    def __init__(
        self,
        library: PolicyLibrary,
        rule: SelectionRule | None = None,
        prior: ArrayLike | None = None,
        dynamics: TypeDynamics | None = None,
        horizon: int | None = None,
        seed: int | np.random.Generator = 0,
    ) -> None:
        self.library = library
        self.rule: SelectionRule = rule or ExpectedImprovement()
        self.dynamics = dynamics or TypeDynamics.static()
        self.horizon = horizon
        self.episode, self.surprise, self.unexplained = 0, 0.0, 0
        self.generator = stream(seed, "policy reuse") if isinstance(seed, int | np.integer) else seed
        self._log_belief = log_prior(library.prior if prior is None else prior)
        self._belief: Array | None = None
        self._selected: tuple[int, Array] | None = None
        self._normals = rows_of_normals(library.signal)
        self._evidence: deque[Evidence] = deque(maxlen=KEPT)
        if self._log_belief.shape != (library.n_types,):
            raise InputError(f"prior must be ({library.n_types},), got {self._log_belief.shape}")
        if horizon is not None and not horizon >= 1:
            raise InputError(f"horizon must be at least 1, got {horizon}")
        if self.dynamics.n_types not in (None, library.n_types):
            raise InputError(f"dynamics are for {self.dynamics.n_types} types, the library has {library.n_types}")

    # ---- the two halves of an episode ------------------------------------------------------------------

    def select(self) -> int:
        """The policy to run next, by number."""
        scores = self.rule.scores(
            self.library, self._current(), episodes_left=self.episodes_left, generator=self.generator
        )
        chosen = choose(scores, self.generator)
        self._selected = chosen, scores
        return chosen

    def update(self, policy: int | str, signal: Any) -> None:
        """Learn from the signal that a policy brought.

        A signal that no type explains leaves the belief as it is and raises the surprise.

        Raises
        ------
        NotFoundError
            There is no such policy.
        InputError
            The signal is none of the model's, or the model gave NaN or infinity. The belief stays as it was.
        """
        index = self.library.index_of_policy(policy)
        if self._normals is not None and isinstance(signal, float) and -LARGEST <= signal <= LARGEST:
            said = np.empty(len(self._log_belief))
            log_evidence = gaussian_row(self._log_belief, index, signal, *self._normals, said)
        else:
            said = self._said(index, signal)
            log_evidence = bayes_row(self._log_belief, said)
        if log_evidence != log_evidence:
            raise InputError(
                f"signal model {type(self.library.signal).__name__} gave NaN or infinity as a log likelihood for "
                f"policy {self.library.policies[index]!r}; minus infinity is allowed, they are not"
            )
        self._remember(Evidence(index, said, log_evidence))

    def _said(self, index: int, signal: Any) -> Array:
        # A copy, for it is kept as evidence, and a model may write its next answer into the same array.
        said = np.array(self.library.signal.log_likelihood(index, signal), np.float64)
        if said.shape != self._log_belief.shape:
            raise InputError(
                f"signal model {type(self.library.signal).__name__} must give {self._log_belief.shape} "
                f"log likelihoods, gave {said.shape}"
            )
        return said

    def _remember(self, evidence: Evidence) -> None:
        self._evidence.append(evidence)
        self.surprise += surprise_of(evidence.log_evidence)
        self.unexplained += evidence.log_evidence == -np.inf
        if self.dynamics.kind != "static":
            self._log_belief = self.dynamics.step(self._log_belief)
        self._belief = None
        self.episode += 1

    # ---- what it believes ------------------------------------------------------------------------------

    @property
    def belief(self) -> Array:
        """β, (n_types,), sums to 1; a copy."""
        return self._current().copy()

    @property
    def log_belief(self) -> Array:
        """log β, (n_types,); finite however small β is, minus infinity where it is 0; a copy."""
        return self._log_belief.copy()

    @property
    def episodes_left(self) -> int | None:
        """Episodes that follow the one now selected for; None without a horizon."""
        return None if self.horizon is None else max(self.horizon - self.episode - 1, 0)

    def expected_utility(self) -> Array:
        """Ũ(π) under the belief, (n_policies,)."""
        return expected_utility(self._current(), self.library.performance.mean)

    def probabilities(self) -> Array:
        """How likely `select` is to take each policy, (n_policies,), sums to 1."""
        return self.rule.probabilities(self.library, self._current(), episodes_left=self.episodes_left)

    def explain(self) -> Explanation:
        """What the last signals said of each type, and how the selected policy stood to the runner-up."""
        names, kept = self.library.policies, list(self._evidence)
        order = np.argsort(-self._current(), kind="stable").tolist()
        said = relative_evidence(kept, self.library.n_types)
        selected = score = runner_up = runner_up_score = None
        if self._selected is not None:
            selected, scores = self._selected
            score, runner_up, runner_up_score = two_best(scores, selected)
        return Explanation(
            None if selected is None else names[selected],
            None if runner_up is None else names[runner_up],
            score,
            runner_up_score,
            {self.library.types[i]: float(self._current()[i]) for i in order},
            {self.library.types[i]: said[:, i].tolist() for i in order},
            [names[one.policy] for one in kept],
            [float(one.log_evidence) for one in kept],
            float(self.surprise),
            int(self.unexplained),
        )

    def _current(self) -> Array:
        if self._belief is None:
            self._belief = np.exp(self._log_belief)
        return self._belief
