"""Users by name, users added while running, masks of available policies, and the best few policies."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction import PolicyLibrary, UserBeliefs

MEAN = np.random.default_rng(3).normal(scale=30, size=(7, 5))


def exact() -> PolicyLibrary:
    return PolicyLibrary.from_means(MEAN, 20.0)


def learnt() -> PolicyLibrary:
    noise = np.random.default_rng(4).normal(scale=20, size=(7, 5, 6))
    return PolicyLibrary.from_samples(MEAN[..., None] + noise)


@pytest.mark.parametrize("make", [exact, learnt])
def test_names_and_numbers_are_the_same_users(make):
    random = np.random.default_rng(0)
    names = [f"u{i}" for i in range(40)]
    named, numbered = UserBeliefs(make(), names), UserBeliefs(make(), 40)
    for _ in range(5):
        who, policies = random.integers(0, 40, 25), random.integers(0, 5, 25)
        signals = random.normal(scale=40, size=25)
        assert np.array_equal(
            named.update([names[i] for i in who], policies, signals), numbered.update(who, policies, signals)
        )
        assert np.array_equal(named.select(np.array(names)), numbered.select(np.arange(40)))
    assert np.array_equal(named.select(who), numbered.select(who))
    assert named.belief("u3").shape == (1, 7)


@pytest.mark.parametrize("make", [exact, learnt])
def test_users_come_while_the_others_go_on(make):
    random = np.random.default_rng(0)
    few, many = UserBeliefs(make(), [], "f8", unknown="add"), UserBeliefs(make(), 300, "f8")
    for turn in range(300):
        name, policy, signal = f"u{turn % 100}", int(random.integers(5)), float(random.normal())
        few.update([name], [policy], [signal])
        many.update([turn % 100], [policy], [signal])
    assert few.n_users == 100
    assert np.array_equal(few.log_belief, many.log_belief[:100])
    assert few.add_users(["x", "y"]).tolist() == [100, 101]
    assert np.array_equal(
        few.belief(["y"])[0], np.exp(few.algorithm.log_prior) / np.exp(few.algorithm.log_prior).sum()
    )
    assert many.add_users(3).tolist() == [300, 301, 302]
    many.update([302], [0], [1.0])
    with pytest.raises(NotFoundError, match="unknown user 303"):
        many.update([303], [0], [1.0])


def test_unknown_names_are_an_error_by_default():
    users = UserBeliefs(exact(), ["ada"])
    for call in (users.select, users.belief, users.reset):
        with pytest.raises(NotFoundError, match="unknown user 'ben'; there are 1; add_users adds it"):
            call(["ben"])
    with pytest.raises(InputError, match="'ada' is there already"):
        users.add_users(["ada"])
    with pytest.raises(InputError, match="must be texts"):
        users.add_users([3])  # type: ignore[list-item]
    with pytest.raises(InputError, match="by names; got a number"):
        users.add_users(3)
    with pytest.raises(InputError, match="users must be at least 0"):
        UserBeliefs(exact(), 2).add_users(-1)
    with pytest.raises(InputError, match="made without names"):
        UserBeliefs(exact(), 2).select(["ada"])
    with pytest.raises(InputError, match="unknown must be"):
        UserBeliefs(exact(), 2, unknown="maybe")  # type: ignore[arg-type]
    assert users.n_users == 1


def test_policies_are_available_by_name_number_or_mask():
    users = UserBeliefs(exact(), 3)
    for available in ("policy 1", ["policy 1"], [1], np.arange(5) == 1):
        assert users.select([0, 1, 2], available=available).tolist() == [1, 1, 1]
    for bad in (np.ones(4, bool), np.ones((2, 5), bool)):
        with pytest.raises(InputError, match=r"available must be \(5,\) or \(3, 5\) bool"):
            users.select([0, 1, 2], available=bad)
    with pytest.raises(InputError, match="at least one policy"):
        users.select([0, 1, 2], available=np.eye(3, 5, -1) > 0)
    with pytest.raises(NotFoundError, match="unknown policy"):
        users.select([0, 1, 2], available=["all"])
