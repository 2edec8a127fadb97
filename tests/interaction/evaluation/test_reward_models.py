"""Parts of the users and means without them: against a plain loop."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.reward_models import FOLDS, policy_means, user_folds


def test_parts_hold_whole_users_and_are_alike_in_size():
    users = np.random.default_rng(0).integers(0, 33, 400)
    folds = user_folds(users, np.random.default_rng(1))
    assert set(folds.tolist()) == set(range(FOLDS))
    sizes = [len(np.unique(users[folds == fold])) for fold in range(FOLDS)]
    assert max(sizes) - min(sizes) <= 1
    assert all(len(np.unique(folds[users == user])) == 1 for user in np.unique(users))


def test_of_few_users_each_is_a_part():
    assert sorted(user_folds([5, 5, 8, 9], np.random.default_rng(0))[[0, 2, 3]].tolist()) == [0, 1, 2]
    with pytest.raises(InputError, match="at least 2 users, got 1"):
        user_folds([5, 5], np.random.default_rng(0))


def test_means_leave_the_own_part_out():
    generator = np.random.default_rng(0)
    users, policies, outcomes = (
        generator.integers(0, 20, 90),
        generator.integers(0, 3, 90),
        generator.normal(size=90),
    )
    policies[users == 7] = 3
    folds = user_folds(users, generator)
    model = policy_means(outcomes, policies, 4, folds)
    probs = generator.dirichlet(np.ones(4), 90)
    expected = model.of_choices(probs)
    for row in range(90):
        others = folds != folds[row]
        own = np.array([
            outcomes[others & (policies == policy)].mean() if (others & (policies == policy)).any()
            else outcomes[others].mean()
            for policy in range(4)
        ])  # fmt: skip
        assert model.of_policies(policies)[row] == pytest.approx(own[policies[row]])
        assert expected[row] == pytest.approx(probs[row] @ own)
    # User 7 alone got policy 3, so for that user's part the mean of all others stands in.
    part = folds[users == 7][0]
    assert model.table[part, 3] == pytest.approx(outcomes[folds != part].mean())
