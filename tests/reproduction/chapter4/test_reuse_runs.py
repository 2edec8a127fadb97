"""The common runner against agents that play one task alone; counts by hand."""

import numpy as np
import pytest

from lifelore.core.metrics import entropy
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import ExpectedImprovement, InformationDirected
from reproduction.chapter4.reuse.many_tasks import converged_after, grouped_mean, play_rule

MEANS = np.array([[10.0, 4.0, 0.0], [5.0, 9.0, 1.0], [0.0, 3.0, 8.0]])


@pytest.mark.parametrize("rule", [ExpectedImprovement(), InformationDirected()])
def test_many_tasks_at_once_choose_as_single_agents_do(rule):
    library = PolicyLibrary.from_means(MEANS, 2.0, prior=[0.5, 0.3, 0.2])
    noise = np.random.default_rng(0).standard_normal((3, 12))
    every = np.arange(3)
    played = play_rule(
        rule, library, lambda t, p: MEANS[every, p] + 2 * noise[:, t], 3, 12, np.random.default_rng(1)
    )
    for task in range(3):
        agent = BayesianPolicyReuse(library, rule, dynamics=TypeDynamics.static(), horizon=12)
        for t in range(12):
            # The prior is uneven, so that nothing ties.
            assert played.entropy[task, t] == pytest.approx(float(entropy(agent.belief)), abs=1e-9)
            assert agent.select() == played.policies[task, t]
            chosen = int(played.policies[task, t])
            agent.update(chosen, MEANS[task, chosen] + 2 * noise[task, t])


def test_when_regret_ended_by_hand():
    regret = np.array([[0.0, 0, 0, 0], [5, 0, 0, 0], [0, 0, 3, 0], [1, 1, 1, 1], [0, 0, 0, 1e-12]])
    # From the first, after one, after three, never (one more than there are), and rounding is no regret.
    assert converged_after(regret).tolist() == [1, 2, 4, 5, 1]


def test_groups_make_the_interval():
    values = np.array([[0.0, 10.0], [0.0, 10.0], [0.0, 10.0]])
    found = grouped_mean(values)
    # Between groups nothing differs: an interval without spread.
    assert (found.value, found.median, found.ci95, found.n) == (5.0, 5.0, (5.0, 5.0), 6)
    shifted = grouped_mean(values + np.array([[0.0], [1.0], [2.0]]))
    assert shifted.ci95[0] >= 5
    assert shifted.ci95[1] <= 7
