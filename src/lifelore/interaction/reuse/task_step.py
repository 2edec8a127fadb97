"""Bayes' rule for the type and the parameters of its models at once; a task forgets where types change.

    F(σ | τ, π) = (1 − w_τ) F(σ | τ, π, all signals so far) + w_τ F(σ | τ, π)
    β'(τ) ∝ F(σ | τ, π) β(τ)

w_τ is the probability that a task which is now of type τ has just changed to it; 0 where types do not change. The
signals so far count less afterwards by the probability that the type has just changed. Where a single change lies
between many signals this is close to exact; it is not exact, since the signals of both types are summed up.
"""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.hazard import HazardTerms, hazard_rule
from lifelore.interaction.library.task_library import TaskLibrary

Array = NDArray[np.float64]


def learn(
    task: TaskLibrary,
    log_belief: Array,
    policy: int,
    signal: Any,
    outcome: float | None,
    hazard: HazardTerms | None,
    compiled: bool,
) -> tuple[Array, float]:
    """Update the log belief (n_types,) in place, with the step of a hazard, and teach the task's models.

    Parameters
    ----------
    hazard : HazardTerms, optional
        None where types change by no hazard.
    compiled : bool
        Whether kernels update the belief; their bits are those of NumPy.

    Returns
    -------
    log_likelihood : (n_types,) float64
    log_evidence : float
        Minus infinity where no type explains the signal; then the task learns nothing.
    """
    before = log_belief.copy()
    if task.evidence is None:
        log_likelihood = np.array(task.signal.log_likelihood(policy, signal), np.float64)
        log_evidence = _step(log_belief, log_likelihood, hazard, compiled)
        task.learn(policy, signal, outcome, np.zeros(1), np.exp(before))
        return log_likelihood, log_evidence
    anew = None if hazard is None else hazard.log_anew
    log_likelihood, changed, gain = task.evidence.evidence(policy, signal, before, anew)
    log_evidence = _step(log_belief, log_likelihood, hazard, compiled)
    if not log_evidence > -np.inf:
        return log_likelihood, log_evidence
    if anew is not None:
        changes = np.exp(before + log_likelihood - log_evidence) @ changed
        task.fade(1 - min(float(changes), 1.0))
    belief = None if task.signal_is_outcome else np.exp(before)
    task.learn(policy, signal, outcome, task.evidence.weights_gained(gain), belief)
    return log_likelihood, log_evidence


def _step(log_belief: Array, log_likelihood: Array, hazard: HazardTerms | None, compiled: bool) -> float:
    """Bayes' rule and the step of a hazard, in place; the log evidence."""
    if compiled:
        bayes_row, hazard_row = _kernels()
        if hazard is None:
            return bayes_row(log_belief, log_likelihood)
        return hazard_row(log_belief, log_likelihood, hazard)
    if hazard is None:
        log_belief[:], log_evidence = bayes_rule(log_belief, log_likelihood)
    else:
        log_belief[:], log_evidence = hazard_rule(log_belief, log_likelihood, hazard)
    return log_evidence


@cache
def _kernels() -> tuple[Any, Any]:
    """The kernels of a single belief, imported at their first use, because the import starts Numba."""
    from lifelore.interaction.beliefs.belief_kernels import bayes_row
    from lifelore.interaction.beliefs.hazard_kernels import hazard_row

    return bayes_row, hazard_row
