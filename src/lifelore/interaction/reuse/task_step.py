"""Bayes' rule for the type and the parameters of its models at once; a task forgets where types change.

    F(σ | τ, π) = (1 − w_τ) F(σ | τ, π, all signals so far) + w_τ F(σ | τ, π)
    β'(τ) ∝ F(σ | τ, π) β(τ)

w_τ is the probability that a task which is now of type τ has just changed to it; 0 where types do not change. The
signals so far count less afterwards by the probability that the type has just changed. Where a single change lies
between many signals this is close to exact; it is not exact, since the signals of both types are summed up.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.task_library import TaskLibrary
from lifelore.interaction.outcomes.task_outcomes import mixed

Array = NDArray[np.float64]


def learn(
    task: TaskLibrary,
    log_belief: Array,
    policy: int,
    signal: Any,
    outcome: float | None,
    dynamics: TypeDynamics,
) -> tuple[Array, float]:
    """Update the log belief (n_types,) in place and teach the task's models.

    Returns
    -------
    log_likelihood : (n_types,) float64
    log_evidence : float
        Minus infinity where no type explains the signal; then nothing changes.
    """
    before = np.exp(log_belief)
    if task.evidence is None:
        log_likelihood = np.array(task.signal.log_likelihood(policy, signal), np.float64)
        log_belief[:], log_evidence = bayes_rule(log_belief, log_likelihood)
        task.learn(policy, signal, outcome, np.zeros(1), before)
        return log_likelihood, log_evidence
    predicted = task.evidence.predicted(policy, signal)
    log_likelihood = mixed(predicted.by_spread, task.evidence.log_weights)
    changed = dynamics.changed_share(log_belief)
    anew = None
    if changed is not None:
        with np.errstate(divide="ignore"):
            anew = np.log(changed) + mixed(predicted.fresh, np.log(task.evidence.spread.weights))
            log_likelihood = np.logaddexp(np.log1p(-changed) + log_likelihood, anew)
    log_belief[:], log_evidence = bayes_rule(log_belief, log_likelihood)
    if not log_evidence > -np.inf:
        return log_likelihood, log_evidence
    if anew is not None:
        possible = log_likelihood > -np.inf
        changes = np.exp(log_belief[possible]) @ np.exp(anew[possible] - log_likelihood[possible])
        task.fade(1 - min(float(changes), 1.0))
    task.learn(policy, signal, outcome, task.evidence.weights_after(predicted.by_spread, before), before)
    return log_likelihood, log_evidence
