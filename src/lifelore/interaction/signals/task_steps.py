"""Step signals of one task: the probabilities of a step's outcomes, known from a finite number of runs.

Each (state, action) has a Dirichlet law, which the task's own steps change, also within an episode. The likelihood
of an episode is the product of the predictive probabilities of its steps in order (Dirichlet-multinomial).
Thesis: §4.4.2.1–2.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_model import check_policy
from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_outcomes import SpreadWeights
from lifelore.interaction.signals.step_checks import check_steps

if TYPE_CHECKING:
    from lifelore.interaction.signals.step_model import StepModel

Array = NDArray[np.float64]
Place = tuple[int, int, int]


class TaskSteps(SpreadWeights):
    """P(outcome | state, action; type, policy) in one task, given the steps it has shown.

    Parameters
    ----------
    signal : StepModel
        The library's, from counted steps; not changed.
    """

    def __init__(self, signal: "StepModel") -> None:
        assert signal.totals is not None
        super().__init__(Spread.known(0.0))
        self.signal, self.n_types, self.n_policies = signal, signal.n_types, signal.n_policies
        self._shown: dict[Place, Array] = {}

    def predicted(self, policy: int, signal: Any) -> Array:
        """The log likelihood of an episode given what the task has shown, (1, n_types)."""
        return self._log_likelihood(policy, signal, self._shown)[None]

    def predicted_anew(self, policy: int, signal: Any) -> Array:
        """`predicted` of a task that has shown nothing."""
        return self._log_likelihood(policy, signal, {})[None]

    def log_likelihood(self, policy: int, signal: Any) -> Array:
        """Log likelihood of an episode per type, given what the task has shown, (n_types,)."""
        return self._log_likelihood(policy, signal, self._shown)

    def learn(self, policy: int, signal: Any, log_weights: Array | None = None) -> None:
        """Take in an episode of this task."""
        for place, new in self._counted(policy, signal).items():
            self._shown[place] = self._shown.get(place, 0.0) + new

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did."""
        for shown in self._shown.values():
            shown *= keep

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown: ``places`` (m, 3): table, state, action; ``shown`` (m, n_outcomes): counts."""
        n_outcomes = self.signal.shape[2]
        return {
            "places": np.array(list(self._shown), np.int64).reshape(-1, 3),
            "shown": np.array(list(self._shown.values())).reshape(-1, n_outcomes),
        }

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Take over a `state`; the model then has the same bits."""
        places, shown = np.asarray(state["places"], np.int64), np.array(state["shown"], np.float64)
        if places.shape != (len(shown), 3) or shown.shape != (len(places), self.signal.shape[2]):
            raise InputError(f"a task's state must have {self.signal.shape[2]} counts of each state and action")
        self._shown = dict(zip(map(tuple, places.tolist()), shown, strict=True))  # type: ignore[arg-type]

    def _log_likelihood(self, policy: int, signal: Any, shown: Mapping[Place, Array]) -> Array:
        found = np.zeros(self.n_types)
        for place, new in self._counted(policy, signal).items():
            prior, more = self._prior(place), shown.get(place)
            found += _sequence(prior if more is None else prior + more[:, None], new)
        return found

    def _counted(self, policy: int, signal: Any) -> dict[Place, Array]:
        """How often each outcome came, by table, state and action."""
        if self.n_policies is not None:
            check_policy(policy, self.n_policies)
        steps = self.signal.steps_of(signal)
        check_steps(steps, self.signal.shape)
        table, found = 0 if self.signal.shared else policy, {}
        for state, action, outcome in steps.tolist():
            found.setdefault((table, state, action), np.zeros(self.signal.shape[2]))[outcome] += 1
        return found

    def _prior(self, place: Place) -> Array:
        """Counts of the library, (n_outcomes, n_types)."""
        assert self.signal.totals is not None
        return np.exp(self.signal.log_probs(place)) * self.signal.totals[place]


def _sequence(prior: Array, new: Array) -> Array:
    """Log probability of outcomes in their order under Dirichlet laws (n_outcomes, n_types), (n_types,)."""
    came = np.flatnonzero(new)
    before, more = prior[came], new[came, None]
    total = prior.sum(axis=0)
    possible = before > 0
    safe = np.where(possible, before, 1.0)
    each = np.where(possible, gammaln(safe + more) - gammaln(safe), -np.inf)
    return each.sum(axis=0) - (gammaln(total + new.sum()) - gammaln(total))
