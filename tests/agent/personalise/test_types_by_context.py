"""Types by context: the shrinkage beside loops, and fits in which context counts, does not, or looks wrong."""

from typing import Any

import numpy as np
import pytest

from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.fitting.library_from_log import TypedRows, library_of
from lifelore.agent.personalise.fitting.types_by_context import (
    FEWEST_USERS,
    by_context,
    contexts_differ,
    own_contexts,
    priors_by_context,
)
from lifelore.agent.personalise.log.log import read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.study import open_study
from lifelore.memory import open_memory

NOISE = 0.5
"""Deviation of minutes."""


def drawn(seed, rates, n_users=300, each=6, kind="clicks"):
    """Users of contexts c0, c1, … whose policies have the rates (n_contexts, n_policies), and no types."""
    random = np.random.default_rng(seed)
    users = np.repeat(np.arange(n_users), each)
    contexts, policies = users % len(rates), random.integers(len(rates[0]), size=users.size)
    expected = np.array(rates)[contexts, policies]
    outcomes = (
        random.random(users.size) < expected
        if kind == "clicks"
        else expected + NOISE * random.normal(size=users.size)
    )
    return {
        "user": [f"u{user}" for user in users],
        "policy": [f"p{policy}" for policy in policies],
        "outcome": outcomes.astype(float).tolist(),
        "context": [f"c{context}" for context in contexts],
    }


RATES = [[0.5, 0.2, 0.3], [0.2, 0.5, 0.3], [0.3, 0.3, 0.3]]
FLAT = [[0.3, 0.35, 0.4]] * 3


def typed_of(log, n_types):
    """The log's rows with made-up types."""
    names = tuple(f"type {number + 1}" for number in range(n_types))
    return TypedRows(np.arange(len(log)), log.user.codes // 3 % n_types, names, 0, True)


# ---- the shrinkage, in plain Python --------------------------------------------------------------------------


def naive_ratio(groups):
    """ρ of users' means by (type, policy) and context: one-way analysis of variance, written out."""
    between = within = between_df = within_df = size = 0.0
    for contexts in groups.values():
        every = [value for values in contexts.values() for value in values]
        overall = sum(every) / len(every)
        for values in contexts.values():
            mean = sum(values) / len(values)
            between += len(values) * (mean - overall) ** 2
            within += sum((value - mean) ** 2 for value in values)
            within_df += len(values) - 1
        between_df += len(contexts) - 1
        size += len(every) - sum(len(values) ** 2 for values in contexts.values()) / len(every)
    return max(0.0, (between / between_df / (within / within_df) - 1) / (size / between_df))


def naive_means(log, typed, wide):
    """Mean and count of each context, type and policy."""
    own, by_user = {}, {}
    for row, type_ in zip(typed.rows.tolist(), typed.types.tolist(), strict=True):
        user, policy = log.user.words[row], log.policy.codes[row]
        cell = log.context.names[log.context_of_user[log.user.codes[row]]], type_, policy
        own.setdefault(cell, []).append(log.outcomes[row])
        by_user.setdefault((cell, user), []).append(log.outcomes[row])
    groups, users = {}, {}
    for ((context, type_, policy), _), outcomes in by_user.items():
        mean = sum(outcomes) / len(outcomes)
        groups.setdefault((type_, policy), {}).setdefault(context, []).append(mean)
        users[context, type_, policy] = users.get((context, type_, policy), 0) + 1
    ratio, found = naive_ratio(groups), {}
    for (context, type_, policy), outcomes in own.items():
        n, first = users[context, type_, policy], wide.mean[type_, policy]
        share = n * ratio / (n * ratio + 1)
        behind = wide.counts.sum(axis=2) if wide.kind == "categorical" else wide.moments.count
        count = 1 / (ratio / (n * ratio + 1) + (1 - share) ** 2 / behind[type_, policy])
        found[context, type_, policy] = first + share * (sum(outcomes) / len(outcomes) - first), count
    return ratio, found


@pytest.mark.parametrize("n_types", [1, 2])
@pytest.mark.parametrize(
    ("kind", "model"), [("clicks", "categorical"), ("minutes", "gaussian"), ("minutes", "student-t")]
)
def test_means_and_counts_are_those_of_loops(kind, model, n_types):
    log = read_log(drawn(1, RATES, n_users=90, kind=kind))
    typed = typed_of(log, n_types)
    wide: Any = library_of(log, typed, model).library.performance
    library, parted, counts = by_context(log, typed, model)
    ratio, expected = naive_means(log, typed, wide)
    assert ratio > 0
    assert library.n_types == len(parted.names) == 3 * n_types
    performance: Any = library.performance
    behind = performance.counts.sum(axis=2) if model == "categorical" else performance.moments.count
    for (context, type_, policy), (mean, count) in expected.items():
        place = n_types * int(context[1:]) + type_
        assert parted.names[place] == (context if n_types == 1 else f"type {type_ + 1}, {context}")
        assert performance.mean[place, policy] == pytest.approx(mean)
        assert behind[place, policy] == pytest.approx(count)
    assert counts.sum() == len(log)


def test_contexts_that_do_not_differ_expect_the_same():
    """Users' outcomes are the same in both contexts, so ρ is 0."""
    users, outcomes = np.repeat(np.arange(40), 2), np.tile([0.0, 1.0, 1.0, 1.0], 20)
    names, contexts = [f"u{user}" for user in users], [f"c{user // 20}" for user in users]
    log = read_log({"user": names, "policy": ["x", "y"] * 40, "outcome": outcomes.tolist(), "context": contexts})
    typed = typed_of(log, 1)
    found: Any = by_context(log, typed, "categorical").library.performance
    wide: Any = library_of(log, typed, "categorical").library.performance
    assert found.counts == pytest.approx(np.repeat(wide.counts, 2, axis=0))
    assert not contexts_differ(log)


def test_contexts_move_jointly_normal_means_and_leave_one_covariance():
    log = read_log(drawn(0, RATES, kind="minutes", n_users=600))
    performance: Any = by_context(log, typed_of(log, 1), "joint-normal").library.performance
    assert performance.mean == pytest.approx(np.array(RATES), abs=0.2)
    # Outcomes less their contexts' means are noise.
    variance = performance.noise**2 + np.diag(performance.covariance)
    assert variance == pytest.approx(NOISE**2, abs=0.04)


@pytest.mark.parametrize("model", ["gaussian", "student-t"])
def test_the_differences_between_contexts_are_no_noise(model):
    """Deviations are those of outcomes about the mean of their context: 0.5, not 2 as about the mean of all."""
    log = read_log(drawn(0, (10 * np.array(RATES)).tolist(), kind="minutes", n_users=600))
    performance: Any = by_context(log, typed_of(log, 1), model).library.performance
    assert np.sqrt(performance.moments.variance) == pytest.approx(np.full((3, 3), NOISE), rel=0.1)


def test_a_context_that_is_the_type_needs_no_other_types(memory_of_types):
    document, study = memory_of_types
    assert (document["types_found"], study.library.types) == (True, ("c0", "c1"))
    assert not [note for note in document["notes"] if "fewer than" in note]


@pytest.fixture
def memory_of_types(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        log = drawn(3, [[8, 4, 3], [3, 8, 5]], n_users=120, each=8, kind="minutes")
        yield fit(log, memory, FitSettings(model="gaussian")), open_study(memory)


def test_rows_of_weight_0_count_for_no_context():
    table = drawn(0, RATES, n_users=90) | {"weight": [1.0, 0.0] * 270}
    part = {name: column[::2] for name, column in table.items()}
    logs = [read_log(one, LogFormat(columns={"weight": "weight"})) for one in (table, part)]
    whole, half = (by_context(log, typed_of(log, 1), "gaussian") for log in logs)
    assert whole.library.performance.mean == pytest.approx(half.library.performance.mean)
    assert whole.counts.tolist() == half.counts.tolist()


def test_contexts_of_few_users_have_no_types_and_everybodys_prior():
    table = drawn(0, RATES, n_users=90)
    rare = [f"u{3 * number}" for number in range(FEWEST_USERS - 1)]
    table["context"] = ["rare" if user in rare else context for user, context in
                        zip(table["user"], table["context"], strict=True)]  # fmt: skip
    log = read_log(table)
    found = by_context(log, typed_of(log, 1), "categorical")
    assert found.library.types == ("c0", "c1", "c2")
    priors = priors_by_context(log, found)
    assert priors["rare"] == pytest.approx(found.library.prior)
    # Five users of everybody's prior beside the thirty of the context.
    assert priors["c1"] == pytest.approx((5 * found.library.prior + [0, 30, 0]) / 35)
    assert own_contexts(log, 1, 3) == [0, 1, 2]
    assert own_contexts(log, 1, 4000) == [], "no room for a type in each of two contexts"


def test_contexts_differ_beyond_chance_or_not():
    assert contexts_differ(read_log(drawn(0, RATES)))
    # Of twenty logs whose contexts are alike, each is mistaken with probability 0.01: three with less than 0.001.
    assert sum(contexts_differ(read_log(drawn(seed, FLAT))) for seed in range(20)) < 3


def test_a_user_of_many_outcomes_is_one_user():
    """Users differ and contexts do not: forty outcomes of a user are no forty proofs of a context."""
    mistaken = 0
    for seed in range(20):
        random = np.random.default_rng(seed)
        rate, users = random.random(24), np.repeat(np.arange(24), 40)
        log = read_log({"user": [f"u{user}" for user in users], "policy": ["x"] * len(users),
                        "outcome": (random.random(len(users)) < rate[users]).astype(float).tolist(),
                        "context": [f"c{user % 2}" for user in users]})  # fmt: skip
        mistaken += contexts_differ(log)
    assert mistaken < 3


# ---- fits ----------------------------------------------------------------------------------------------------


@pytest.fixture
def fitted(tmp_path):
    def fit_table(table, **settings):
        with open_memory(tmp_path / "m.db") as memory:
            document = fit(table, memory, FitSettings(**settings))
            return document, open_study(memory)

    return fit_table


@pytest.mark.parametrize("kind", ["clicks", "minutes"])
def test_context_acts_where_there_is_one_type(kind, fitted):
    document, study = fitted(drawn(0, RATES, kind=kind))
    assert "context" in document["personalised_by"]
    expected = {context: study.prior_of(context) @ study.library.performance.mean for context in study.contexts}
    best = {context: study.library.policies[int(mean.argmax())] for context, mean in expected.items()}
    assert (best["c0"], best["c1"]) == ("p0", "p1")
    assert document["context"]["types_of"] == 3
    assert document["context"]["worth"][0] > 0
    assert document["notes"][0].startswith("one type: users of a context start alike; 3 contexts (context)")
    assert "worth +" in document["notes"][0]
    assert (document["left_out"], document["rows"]) == (0, 1800)


def test_a_user_without_a_context_expects_the_mean_of_contexts(fitted):
    _, study = fitted(drawn(0, RATES))
    expected = study.prior_of(None) @ study.library.performance.mean
    assert expected == pytest.approx(np.mean(RATES, axis=0), abs=0.06)


def test_context_that_tells_nothing_is_told_so(fitted):
    document, study = fitted(drawn(2, FLAT))
    assert (document["context"]["types_of"], document["context"]["differ"]) == (0, False)
    assert study.library.n_types == 1
    assert "context changes nothing: outcomes do not differ by it" in document["notes"]


def test_context_acts_where_nobody_has_two_outcomes(fitted):
    document, _ = fitted(drawn(0, RATES, n_users=900, each=1))
    assert document["held_out"] is None
    assert (document["model"], document["context"]["types_of"]) == ("categorical", 3)
    assert any("models were not compared" in note for note in document["notes"])


def test_users_of_two_contexts_are_counted(fitted):
    table = drawn(0, RATES)
    table["context"][0], table["context"][6] = "c2", ""
    document, _ = fitted(table)
    assert document["context"]["several"] == 1
    assert "1 of 300 users have several contexts; the last of each counts" in document["notes"]


def test_types_of_few_users_are_named(fitted):
    random = np.random.default_rng(0)
    users = np.repeat(np.arange(60), 8)
    rows = {"user": [f"u{user}" for user in users], "policy": ["x", "y"] * (len(users) // 2)}
    # Four users are unlike all others.
    means = np.where((users < 4)[:, None], [9.0, 0.0], [0.0, 1.0])[
        np.arange(len(users)), np.arange(len(users)) % 2
    ]
    rows["outcome"] = (means + random.normal(scale=0.3, size=len(users))).tolist()
    document, _ = fitted(rows, types=2)
    assert [kind["users"] for kind in document["types"]] == [56, 4]
    assert "types of fewer than 10 users: type 2 has 4; ask for fewer --types" in document["notes"]


@pytest.mark.parametrize(
    ("model", "warned"), [("gaussian", True), ("joint-normal", True), ("categorical", False), ("auto", False)]
)
def test_two_values_read_as_amounts_are_told_so(model, warned, fitted):
    document, _ = fitted(drawn(0, FLAT, n_users=60), model=model)
    assert any("read as amounts" in note or "reads as amounts" in note for note in document["notes"]) == warned


def test_users_spelt_in_two_ways_are_named(fitted):
    table = drawn(0, RATES)
    table["user"][0], table["user"][7] = "U0", "U1"
    document, _ = fitted(table)
    spelt = "users differ only in capitals, spaces or a final .0 from others (2, as 'U0' and 'u0'); each counts"
    assert [note for note in document["notes"] if "capitals" in note] == [spelt]
