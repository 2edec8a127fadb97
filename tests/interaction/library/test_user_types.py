"""Types found among users: by hand where the answer is known, and on draws from the model itself."""

import numpy as np
import pytest
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction.library.user_types import user_types
from lifelore.interaction.outcomes.outcome_families import PSEUDO, CategoricalFamily, GaussianFamily
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows

MEANS = np.array([[0.9, 0.1, 0.5], [0.1, 0.9, 0.5], [0.5, 0.5, 0.05]])


def drawn(n_users=120, each=15, family="gaussian", seed=0, means=MEANS):
    """Users of equally many types, each met with policies at random."""
    generator = np.random.default_rng(seed)
    true = np.arange(n_users) % len(means)
    users = np.repeat(np.arange(n_users), each)
    policies = generator.integers(means.shape[1], size=len(users))
    policies[: means.shape[1]] = range(means.shape[1])
    mean = means[true[users], policies]
    values = generator.normal(mean, 0.2) if family == "gaussian" else (generator.random(len(mean)) < mean) * 1.0
    return OutcomeRows(users, policies, values, (n_users, means.shape[1])), true


@pytest.mark.slow
@pytest.mark.parametrize("family", ["gaussian", "categorical"])
def test_types_that_are_there_are_found_and_counted(family):
    rows, true = drawn(family=family, each=15 if family == "gaussian" else 40)
    found = user_types(rows, np.random.default_rng(1), 3, family=family)
    assert found.n_types == 3
    agree = np.array([[np.mean(found.labels[true == t] == f) for f in range(3)] for t in range(3)])
    assert (agree.max(axis=1) > 0.9).all()
    assert sorted(agree.argmax(axis=1)) == [0, 1, 2]
    assert found.probs.sum(axis=1) == pytest.approx(1)
    assert found.weights == pytest.approx(found.probs.mean(axis=0))
    assert (np.diff(found.weights) <= 0).all()


@pytest.mark.parametrize("family", ["gaussian", "categorical"])
def test_of_many_users_a_sample_gives_the_start_and_all_are_fitted(family, monkeypatch):
    rows, _ = drawn(n_users=240, each=20, family=family)
    whole = user_types(rows, np.random.default_rng(1), 3, family=family)
    monkeypatch.setattr("lifelore.interaction.library.user_types.SAMPLED_USERS", 90)
    found = user_types(rows, np.random.default_rng(1), 3, family=family)
    assert found.n_types == whole.n_types == 3
    agree = np.array([[np.mean(found.labels[whole.labels == t] == f) for f in range(3)] for t in range(3)])
    assert (agree.max(axis=1) > 0.97).all()
    assert np.sort(found.weights) == pytest.approx(np.sort(whole.weights), abs=0.01)
    assert found.probs.sum(axis=1) == pytest.approx(1)


@pytest.mark.parametrize("family", [GaussianFamily, CategoricalFamily])
def test_the_product_is_the_log_likelihood_of_every_outcome(family):
    """The naive twin goes through the outcomes one by one."""
    rows, true = drawn(n_users=9, each=7, family="categorical")
    made = family(rows)
    shares = np.eye(3)[true]
    logs = made.stats @ made.fit(shares).T
    expected = np.zeros((9, 3))
    for type_ in range(3):
        for user, policy, value in zip(rows.types, rows.policies, rows.values, strict=True):
            overall = rows.values[rows.policies == policy]
            own = rows.values[(rows.policies == policy) & (true[rows.types] == type_)]
            if family is CategoricalFamily:
                probability = ((own == value).sum() + PSEUDO * (overall == value).mean()) / (len(own) + PSEUDO)
                expected[user, type_] += np.log(probability)
                continue
            mean = {
                t: (rows.values[(rows.policies == policy) & (true[rows.types] == t)].sum() + overall.mean())
                / ((true[rows.types[rows.policies == policy]] == t).sum() + 1)
                for t in range(3)
            }
            of_row = true[rows.types[rows.policies == policy]]
            spread = np.sqrt(np.mean([(v - mean[t]) ** 2 for v, t in zip(overall, of_row, strict=True)]))
            expected[user, type_] += norm.logpdf(value, mean[type_], spread)
    assert logs == pytest.approx(expected)


def test_bad_input():
    rows, _ = drawn(n_users=6)
    generator = np.random.default_rng(0)
    with pytest.raises(InputError, match="family must be one of gaussian, categorical, got 'beta'"):
        user_types(rows, generator, 2, family="beta")
    with pytest.raises(InputError, match="n_types must lie between 1 and the 6 users, got 7"):
        user_types(rows, generator, 7)
    with pytest.raises(InputError, match="values must be finite"):
        user_types(rows._replace(values=rows.values * np.nan), generator, 2)
    with pytest.raises(InputError, match="every user and every policy needs a row"):
        user_types(rows._replace(shape=(7, 3)), generator, 2)
