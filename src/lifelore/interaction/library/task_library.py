"""A policy library as one task sees it: its models also know what the task itself has shown.

The belief of policy reuse is then over types *and* the parameters of their models, although only the types' belief
is stored: the parameters have laws of known form (`outcomes.task_normals`, `outcomes.dirichlet`), which a few
numbers of each policy that was tried describe. With exact models there is nothing to learn but the type, and a
task needs no library of its own.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.task_outcomes import TaskOutcomes
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]


class TaskLibrary(PolicyLibrary):
    """The models of a library in one task; made by `PolicyLibrary.for_task`.

    Parameters
    ----------
    library : PolicyLibrary
        Read once: what it learns later, the task does not see.
    outcomes : TaskOutcomes, optional
        Of the task, where the library's outcomes are not known exactly.
    signal : optional
        The signal's model of the task, where it is not the return and not known exactly.
    """

    def __init__(self, library: PolicyLibrary, outcomes: TaskOutcomes | None, signal: Any = None) -> None:
        self.of, self.outcomes_of_task = library, outcomes
        returns = isinstance(library.signal, ReturnSignal) and library.signal.outcomes is library.performance
        self.evidence: Any = outcomes if returns else signal
        performance: Any = outcomes or library.performance
        if returns:
            signal = ReturnSignal(performance)
        super().__init__(performance, signal or library.signal, library.types, library.policies, library.prior)
        self._stale: dict[int, set[int]] = {}

    @property
    def signal_is_outcome(self) -> bool:
        """Whether the return is the signal, so that each signal teaches the outcomes too."""
        return self.evidence is self.outcomes_of_task

    def learn(
        self, policy: int, signal: Any, outcome: float | None, log_weights: Array, belief: Array | None
    ) -> None:
        """Take in the signal of a policy, and its outcome where the signal is another one.

        Parameters
        ----------
        log_weights : (n_spreads,) float64
            The spreads' log probabilities after the signal.
        belief : (n_types,) float64, optional
            Before the signal; None only where the signal is the outcome.
        """
        if self.evidence is not None:
            self.evidence.learn(policy, signal, log_weights)
        if belief is not None and not self.signal_is_outcome and outcome is not None and self.outcomes_of_task:
            predicted = self.outcomes_of_task.predicted(policy, outcome)
            self.outcomes_of_task.learn(policy, outcome, self.outcomes_of_task.weights_after(predicted, belief))
        self._outdate()

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did: the type may have changed."""
        for model in self._models().values():
            model.fade(keep)
        self._outdate()

    def table(self, n_bins: int = 8) -> SignalTable:
        """The signals' table given what the task has shown; bins stay those of the beginning."""
        if self.evidence is None or not hasattr(self.evidence, "cuts"):
            return self.of.table(n_bins)
        table, cuts = self.of.task_table(n_bins)
        if n_bins not in self._tables:
            self._tables[n_bins] = table.copy()
            self._stale[n_bins] = set(self.evidence.tried)
        if self._stale[n_bins]:
            some = sorted(self._stale[n_bins])
            rows = self.evidence.many_rows(some, [cuts[policy] for policy in some], table.n_signals)
            self._tables[n_bins].replace_many(some, rows)
        self._stale[n_bins].clear()
        return self._tables[n_bins]

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown, as arrays."""
        return {
            f"{name}.{key}": array
            for name, model in self._models().items()
            for key, array in model.state().items()
        }

    def restore_some(self, state: Mapping[str, NDArray[Any]], policies: list[int]) -> None:
        """Take over the part of a `state` that is of `policies`, this library's 0, 1, … in that order."""
        place = {policy: number for number, policy in enumerate(policies)}
        own = dict(state)
        for name in self._models():
            tried = state[f"{name}.policies"].tolist()
            here = [row for row, policy in enumerate(tried) if policy in place]
            own[f"{name}.policies"] = np.array([place[tried[row]] for row in here], np.int64)
            own[f"{name}.shown"] = state[f"{name}.shown"][here]
        self.restore(own)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take over a `state`; the library then has the same bits.

        Raises
        ------
        InputError
            The state is of another library.
        """
        try:
            for name, model in self._models().items():
                inside = {
                    key.partition(".")[2]: array for key, array in state.items() if key.startswith(name + ".")
                }
                model.restore(inside)
        except (KeyError, IndexError, ValueError) as error:
            raise InputError(f"the task's state is not of this library: {error}") from None
        self._tables.clear()
        self._stale.clear()

    def _outdate(self) -> None:
        """Have the rows of every policy that was tried computed again: all depend on the spreads' probabilities.

        The rows of other policies stay as they were at the beginning, since nothing was shown of them.
        """
        for stale in self._stale.values():
            stale.update(self.evidence.tried)

    def _models(self) -> dict[str, Any]:
        """The models that the task changes, by name."""
        found = {"signal": self.evidence}
        if not self.signal_is_outcome:
            found["outcomes"] = self.outcomes_of_task
        return {name: model for name, model in found.items() if model is not None}
