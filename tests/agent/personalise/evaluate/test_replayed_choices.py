"""A study replayed on many users side by side has the choices of one user after the other."""

import numpy as np
import pytest

from lifelore.agent.personalise.evaluate import target_policies as module
from lifelore.agent.personalise.evaluate.target_policies import replayed_choices
from lifelore.agent.personalise.fitting.fit import FitSettings, study_of_log
from lifelore.agent.personalise.log.log import read_log
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse

MEANS = np.array([[5.0, 0.0, 3.0], [0.0, 5.0, 3.0]])


def log_of(policies, n_users=9, seed=0, context="web"):
    """Users with 1 to 5 decisions each, in a mixed order; every third of them has a context."""
    random = np.random.default_rng(seed)
    users = random.permutation([user for user in range(n_users) for _ in range(1 + user % 5)])
    numbers = random.integers(len(policies), size=len(users))
    return read_log({
        "user": [f"u{user}" for user in users],
        "policy": [policies[number] for number in numbers],
        "outcome": random.normal(MEANS[users % 2, numbers], 2).tolist(),
        "context": [context if user % 3 == 0 else "" for user in users],
    })  # fmt: skip


def naive(study, log, rows):
    """The slow twin: an agent for each user, a decision at a time."""
    agents, expected, probs, unknown = {}, [], [], []
    numbers = study.active_numbers
    mask = np.isin(np.arange(study.library.n_policies), numbers)
    for row in rows:
        user, policy = log.user.codes[row], log.policy.names[log.policy.codes[row]]
        context = log.context.names[log.context_of_user[user]] if log.context_of_user[user] >= 0 else None
        if user not in agents:
            prior = study.prior_of(context)
            agents[user] = BayesianPolicyReuse(
                study.library, prior=prior, dynamics=study.dynamics, models=study.models
            )
        agent = agents[user]
        odds = agent.algorithm.propensities(0, study.selection, mask)[numbers]
        chosen = dict(zip(study.active, (0.9 * odds + 0.1 / len(odds)).tolist(), strict=True))
        means = dict(zip(study.active, agent.expected_utility()[numbers].tolist(), strict=True))
        expected.append([means.get(name, np.nan) for name in log.policy.names])
        probs.append([chosen.get(name, 0.0) for name in log.policy.names])
        unknown.append(sum(chosen[name] for name in chosen if name not in log.policy.names))
        if policy in study.library.policies:
            agent.update(policy, log.outcomes[row])
        else:
            agent.end_episode()
    return np.array(expected), np.array(probs), np.array(unknown)


@pytest.mark.parametrize("models", ["uncertain", "plug-in"])
@pytest.mark.parametrize("rule", ["sampling", "information-directed"])
def test_users_side_by_side_are_users_one_after_the_other(monkeypatch, rule, models):
    monkeypatch.setattr(module, "USERS_AT_ONCE", 4)
    # The study knows a policy, r, that the log has not, and has retired q; it does not know the log's s.
    settings = FitSettings(model="gaussian", types=2, rule=rule, explore=0.1, models=models, change=0.05)
    study = study_of_log(log_of(("p", "q", "r"), 40), settings)[0].with_state("q", "retired")
    log = log_of(("p", "q", "s"), seed=1)
    rows = np.random.default_rng(2).permutation(len(log))[: len(log) - 3]
    rows.sort()
    found = replayed_choices(study, log, rows)
    for one, twin in zip(found, naive(study, log, rows), strict=True):
        np.testing.assert_allclose(one, twin, rtol=1e-10, atol=1e-12)
    assert found.unknown.max() > 0
    without = replayed_choices(study, log, rows, choose=False)
    np.testing.assert_array_equal(without.expected, found.expected)
    assert not without.probabilities.any()
    assert replayed_choices(study, log, rows[:0]).expected.shape == (0, 3)
