"""The model that users choose who are held out: on simulated users, and its scores beside loops."""

import numpy as np
import pytest

from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.fitting.held_out import COUNTED, LEAST, MOST_SHOWN, HeldOut
from lifelore.agent.personalise.log.log import read_log
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.memory import open_memory


def table(users, policies, outcomes):
    return {
        "user": [f"u{user}" for user in users],
        "policy": [f"p{policy:02d}" for policy in policies],
        "outcome": outcomes.tolist(),
    }


def ratings(seed, n_users=600, n_items=12, each=10):
    """Ratings 0.5, 1, …, 5 of items that two factors join; nobody rates an item twice."""
    random = np.random.default_rng(seed)
    taste = random.normal(size=(n_users, 2)) @ random.normal(scale=0.5, size=(2, n_items))
    liked = 3.2 + random.normal(scale=0.3, size=n_items) + random.normal(scale=0.3, size=(n_users, 1)) + taste
    users = np.repeat(np.arange(n_users), each)
    items = np.concatenate([random.permutation(n_items)[:each] for _ in range(n_users)])
    outcomes = liked[users, items] + random.normal(scale=0.7, size=users.size)
    return table(users, items, np.clip(np.round(2 * outcomes) / 2, 0.5, 5))


def hard_types(seed, n_users=300, n_policies=8, each=12):
    """Four types with means of their own; users of a type are alike."""
    random = np.random.default_rng(seed)
    means, types = random.normal(size=(4, n_policies)), random.integers(4, size=n_users)
    users, policies = np.repeat(np.arange(n_users), each), random.integers(n_policies, size=n_users * each)
    return table(users, policies, means[types[users], policies] + random.normal(size=users.size))


def no_structure(seed, n_users=400, n_items=10, each=8):
    """Ratings of users who are all alike."""
    random = np.random.default_rng(seed)
    users, items = np.repeat(np.arange(n_users), each), random.integers(n_items, size=n_users * each)
    outcomes = 3.2 + random.normal(scale=0.3, size=n_items)[items] + random.normal(scale=0.9, size=users.size)
    return table(users, items, np.clip(np.round(2 * outcomes) / 2, 0.5, 5))


@pytest.fixture
def fitted(tmp_path):
    def fit_table(log):
        with open_memory(tmp_path / "m.db") as memory:
            return fit(log, memory, FitSettings())

    return fit_table


def test_ratings_of_ten_values_are_personalised_by_shared_items(fitted):
    document = fitted(ratings(2))
    assert (document["model"], document["personalised_by"]) == ("joint-normal", ["items"])
    assert document["held_out"]["over_single"][1] > 0
    # Nobody rates an item twice, so that counting is best single.
    assert document["held_out"]["over_counting"][1] > 0
    tried = {(one["model"], one["types"]) for one in document["held_out"]["candidates"]}
    assert {("categorical", 1), ("gaussian", 1), ("gaussian", 2), ("joint-normal", 1)} <= tried


def test_hard_types_are_found_and_beat_counting(fitted):
    document = fitted(hard_types(1))
    assert len(document["types"]) == 4
    assert "types" in document["personalised_by"]
    assert document["held_out"]["over_single"][1] > 0
    assert document["held_out"]["over_counting"][1] > 0


def test_without_structure_nothing_is_personalised_and_the_user_is_told(fitted):
    document = fitted(no_structure(0))
    assert document["personalised_by"] == []
    assert document["notes"][0].startswith("nothing is personalised")
    low, high = document["held_out"]["over_single"][1:]
    assert low <= 0 <= high
    assert any("counting each user's own outcomes" in note for note in document["notes"])


# ---- scores beside loops --------------------------------------------------------------------------------------

LOG = {
    "user": ["a", "b", "a", "a", "b", "a", "c", "c", "a", "c", "b"],
    "policy": ["x", "y", "y", "x", "x", "y", "z", "x", "x", "y", "y"],
    "outcome": [3.0, 1.0, 0.0, 2.5, 2.0, 4.0, 1.0, 0.5, 1.0, 3.5, 2.0],
}
LIBRARY = PolicyLibrary(
    JointNormalOutcomes([[2.0, 1.0], [0.0, 3.0]], [[1.0, 0.4], [0.4, 0.6]], [1.0, 0.8]), policies=("x", "y")
)
"""It does not know z."""


def rows_of(user):
    return [(p, x) for u, p, x in zip(LOG["user"], LOG["policy"], LOG["outcome"], strict=True) if u == user]


CONTEXTS = {"k": np.array([0.9, 0.1]), "l": np.array([0.2, 0.8])}
"""The log has k for user a, and nothing for others."""


def naive_scores(held_out, contexts):
    """Log score and value of each user, asked before the first outcome and when half are shown."""
    scores, values = [], []
    for user in ("a", "b", "c"):
        rows = rows_of(user)
        prior = contexts.get("k") if user == "a" else None
        agent = BayesianPolicyReuse(LIBRARY, dynamics=TypeDynamics.static(), prior=prior)
        times = [asked(held_out, agent, rows)]
        for policy, outcome in rows[: len(rows) // 2]:
            if policy in LIBRARY.policies:
                agent.update(policy, outcome)
        times.append(asked(held_out, agent, rows[len(rows) // 2 :]))
        scores.append(times[1][0])
        values.append(np.nanmean(np.array([value for _, value in times])))
    return scores, values


def asked(held_out, agent, later):
    """Mean log probability of the bins of later outcomes, and the mean of those of the policy chosen."""
    known = agent.algorithm.known(0).performance
    logs = []
    for policy, outcome in later:
        if policy in LIBRARY.policies:
            place = int(np.searchsorted(held_out.cuts, outcome))
            below = known.cumulative(LIBRARY.policies.index(policy), held_out.cuts[place - 1 : place + 1])
            logs.append(np.log(max(agent.belief @ (below[:, 1] - below[:, 0]), LEAST)))
    offered = sorted({policy for policy, _ in later if policy in LIBRARY.policies})
    expected = [agent.expected_utility()[LIBRARY.policies.index(policy)] for policy in offered]
    best = offered[int(np.argmax(expected))]
    own = [outcome for policy, outcome in later if policy == best]
    return np.mean(logs), np.mean(own) if len(offered) > 1 else np.nan


@pytest.mark.parametrize("contexts", [{}, CONTEXTS])
def test_scores_are_those_of_loops(contexts):
    log = LOG | {"context": ["k" if user == "a" else "" for user in LOG["user"]]}
    held_out = HeldOut(read_log(log))
    found = held_out.of_library(LIBRARY, contexts)
    scores, values = naive_scores(held_out, contexts)
    assert found.log_score == pytest.approx(scores)
    assert found.value == pytest.approx(values, nan_ok=True)


def test_counting_is_the_mean_of_own_outcomes_and_two_of_everybodys():
    held_out = HeldOut(read_log(LOG))
    means = np.array([1.9, 2.0, 0.0])
    # At the start all choose y: a 2 of 0 and 4; b 1.5 of 1 and 2; c 3.5.
    start = np.array([2.0, 1.5, 3.5])
    # a showed x 3, y 0: x is (2 · 1.9 + 3) / 3 = 2.27, y 4 / 3; b showed y 1: x 1.9, y (4 + 1) / 3; c showed z.
    assert held_out.by_means(means, COUNTED) == pytest.approx((start + np.array([1.75, 2.0, 3.5])) / 2)
    # Everybody's best policy is y.
    assert held_out.by_means(means) == pytest.approx((start + np.array([4.0, 2.0, 3.5])) / 2)


def test_later_outcomes_of_a_single_policy_have_no_value_and_long_histories_are_cut():
    n = 50
    log = {"user": ["a"] * n + ["b"] * 2, "policy": ["x", "y"] * (n // 2) + ["x", "x"], "outcome": [1.0, 0.0] * 26}
    held_out = HeldOut(read_log(log))
    assert np.isnan(held_out.by_means(np.array([1.0, 0.0]))).tolist() == [False, True]
    assert (held_out.policies >= 0).sum(axis=1).tolist() == [MOST_SHOWN, 2]
    assert held_out.half.tolist() == [MOST_SHOWN // 2, 1]


def test_users_without_a_click_are_one_bin():
    log = {"user": ["a", "a", "b", "b"], "policy": ["x", "y"] * 2, "outcome": [0.0] * 4}
    found = HeldOut(read_log(log)).of_library(LIBRARY)
    assert found.log_score == pytest.approx(0.0)
    assert found.value.tolist() == [0.0, 0.0]
