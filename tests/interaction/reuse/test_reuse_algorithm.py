"""Algorithm 7 for every family of signals: against its slow twin, many rows against one, and what rows promise."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction import PolicyLibrary, ReturnSignal, TypeDynamics
from lifelore.interaction.library.library_file import SIGNALS
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.outcome_kinds import KINDS
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection import RULES, rule_named

from .families import FAMILIES, N_POLICIES, N_TYPES, PRIOR, Family

every_family = pytest.mark.parametrize("family", FAMILIES.values(), ids=FAMILIES)
learning = pytest.mark.parametrize(
    "family", [f for f in FAMILIES.values() if f.learns], ids=[name for name, f in FAMILIES.items() if f.learns]
)
with_twin = pytest.mark.parametrize(
    "family",
    [
        pytest.param(
            family, id=name, marks=[pytest.mark.slow] if name in ("gaussian", "student-t", "uneven") else []
        )
        for name, family in FAMILIES.items()
    ],
)
"""Integration of normals takes half a second."""
every_rate = pytest.mark.parametrize("rate", [0.0, 0.05, 1.0])
K = 5


def algorithm(family: Family, n_users: int = 1, rate: float = 0.05, **options) -> ReuseAlgorithm:
    return ReuseAlgorithm(family.library(), n_users, dynamics=TypeDynamics.hazard(rate, PRIOR), **options)


def drawn(family: Family, random: np.random.Generator, n: int = K) -> tuple[np.ndarray, list]:
    """Policies (n,) and a signal of each."""
    return random.integers(N_POLICIES, size=n), [family.draw(random) for _ in range(n)]


def taught(family: Family, n_users: int = K, rate: float = 0.05, seed: int = 0, **options) -> ReuseAlgorithm:
    """Users after four episodes."""
    random, made = np.random.default_rng(seed), algorithm(family, n_users, rate, **options)
    for _ in range(4):
        made.update(np.arange(n_users), *drawn(family, random, n_users))
    return made


def states(made: ReuseAlgorithm, users) -> list[np.ndarray]:
    """All that rows hold, as arrays."""
    known, pairs = made.known(users).performance, (*np.shape(users), N_TYPES, N_POLICIES)
    moments = [np.broadcast_to(each, pairs) for each in (known.mean, known.deviation)]
    return [made.log_belief[users].astype(np.float64), *moments, made.signals.log_weights[users]]


def assert_same(one, other, tolerance: float = 1e-12) -> None:
    for first, second in zip(one, other, strict=True):
        np.testing.assert_allclose(first, second, rtol=tolerance, atol=tolerance)


def test_every_family_is_here():
    libraries = [family.library() for family in FAMILIES.values()]
    assert {getattr(library.signal, "kind", "own") for library in libraries} == {*SIGNALS, "own"}
    assert {library.performance.kind for library in libraries} == set(KINDS)
    for family, library in zip(FAMILIES.values(), libraries, strict=True):
        assert ReuseAlgorithm(library).signals.law.learns == family.learns
        assert not ReuseAlgorithm(library, models="plug-in").signals.law.learns


# ---- against the slow twin -----------------------------------------------------------------------------------


@with_twin
@every_rate
def test_several_signals_an_episode_agree_with_the_twin(family, rate):
    """Beliefs over types and over spreads, and the evidence; the integrals are exact to some 1e-13."""
    random, made, twin = np.random.default_rng(1), algorithm(family, rate=rate), family.twin(rate)
    for number in range(5):
        for _ in range(number % 3):
            policy, signal = int(random.integers(N_POLICIES)), family.draw(random)
            log_evidence = made.observe(0, policy, signal).log_evidence
            assert log_evidence == pytest.approx(twin.observe(family.place(policy), signal), abs=1e-11)
        made.end_episode(0)
        twin.end_episode()
        assert made.belief(0) == pytest.approx(twin.belief, abs=1e-12)
        assert np.exp(made.signals.log_weights[0]) == pytest.approx(twin.weights, abs=1e-12)


@pytest.mark.parametrize("family", [f for f in FAMILIES.values() if f.impossible is not None])
def test_a_signal_that_no_type_explains_keeps_the_belief_and_teaches_nothing(family):
    made, other = (taught(family, 2) for _ in range(2))
    before = made.log_belief.copy()
    signal = family.draw(np.random.default_rng(3))
    found = made.observe(np.arange(2), np.array([1, 0]), [family.impossible, signal])
    assert found.log_evidence[0] == -np.inf < found.log_evidence[1]
    assert made.log_belief[0] == pytest.approx(before[0], abs=1e-14)
    # The other row learns as it would alone, and both go on.
    other.observe(1, 0, signal)
    assert_same(states(made, 1), states(other, 1))
    assert_same(states(made, 0)[1:], states(other, 0)[1:])
    single = taught(family, 2)
    assert single.observe(0, 1, family.impossible).log_evidence == -np.inf
    assert_same(states(single, 0), states(made, 0))


# ---- many rows and one, both precisions ----------------------------------------------------------------------


@every_family
@every_rate
def test_rows_are_single_users(family, rate):
    random, rows = np.random.default_rng(4), algorithm(family, 2 * K, rate)
    singles = [algorithm(family, rate=rate) for _ in range(2 * K)]
    for number in range(6):
        users = random.permutation(2 * K)[:K]
        policies, signals = drawn(family, random)
        found = rows.observe(users, policies, signals)
        for place, user in enumerate(users.tolist()):
            alone = singles[user].observe(0, int(policies[place]), signals[place])
            assert_same([each[place] for each in found], alone)
        if number % 2:
            rows.end_episode(np.arange(2 * K))
            for single in singles:
                single.end_episode(0)
    for user, single in enumerate(singles):
        assert_same(states(rows, user), states(single, 0))
        assert_same([each[user] for each in states(rows, np.arange(2 * K))], states(single, 0))


@every_family
@every_rate
def test_float32_agrees_with_float64(family, rate):
    users, random = np.arange(8), np.random.default_rng(0)
    f4, f8 = (algorithm(family, 8, rate, dtype=dtype) for dtype in ("f4", "f8"))
    for _ in range(20):
        policies, signals = drawn(family, random, 8)
        evidence = [made.update(users, policies, signals).log_evidence for made in (f4, f8)]
        assert evidence[0] == pytest.approx(evidence[1], rel=1e-5, abs=1e-5)
        assert f4.belief(users) == pytest.approx(f8.belief(users), abs=1e-5)
    assert (f4.log_belief.dtype, f4.nbytes < f8.nbytes) == (np.float32, True)
    means = [made.known(users).performance.mean for made in (f4, f8)]
    assert means[0] == pytest.approx(means[1], rel=1e-5, abs=1e-4)


@every_family
@pytest.mark.parametrize("name", RULES)
def test_rules_score_rows_as_single_users(family, name):
    made, rule, users = taught(family), rule_named(name), np.arange(K)
    if not made.library.has_table and "table" in type(rule).scores.__code__.co_names:
        pytest.skip("the signals have no table")
    for available in (None, np.array([False, True]), np.random.default_rng(0).permutation([[True, True]] * K)):
        stated = made.propensities(users, rule, available, episodes_left=3)
        assert stated.sum(axis=1) == pytest.approx(np.ones(K))
        for user in range(K):
            own = available if available is None or available.ndim == 1 else available[user]
            alone = made.propensities(user, rule, own, episodes_left=3)
            assert alone == pytest.approx(stated[user], abs=1e-9)
            chosen, scores = made.select(user, rule, np.random.default_rng(0), own, 3)
            assert scores[chosen] == scores.max()
            assert stated[user, chosen] > 0
            assert own is None or (scores[~own] == -np.inf).all()


# ---- rows are reset, grow, are stored ------------------------------------------------------------------------


@every_family
def test_a_reset_row_is_a_new_one_and_the_others_stay(family):
    made, fresh, before = taught(family), algorithm(family), taught(family)
    for users in (1, np.array([3, 4])):
        made.reset(users)
    for user in range(K):
        expected = states(before, user) if user in (0, 2) else states(fresh, 0)
        assert_same(states(made, user), expected)
    signal = family.draw(np.random.default_rng(5))
    made.update(1, 0, signal)
    fresh.update(0, 0, signal)
    assert_same(states(made, 1), states(fresh, 0))


@every_family
def test_new_rows_have_the_prior_and_the_others_stay(family):
    made, before = taught(family), taught(family)
    made.grow(K + 3)
    assert made.n_users == K + 3
    assert_same(states(made, np.arange(K)), states(before, np.arange(K)))
    assert_same(states(made, K + 2), states(algorithm(family), 0))


@every_family
@pytest.mark.parametrize("dtype", ["f8", "f4"])
def test_a_restored_row_goes_on_as_the_stored_one(family, dtype):
    stored, restored = taught(family, dtype=dtype), taught(family, seed=9, dtype=dtype)
    assert bool(stored.state(2)) == family.learns
    signal = family.draw(np.random.default_rng(6))
    # In the middle of an episode: the step between two episodes counts once.
    stored.observe(2, 0, signal)
    restored.restore(4, stored.log_belief[2], stored.state(2))
    for _ in range(2):
        stored.update(2, 1, signal)
        restored.update(4, 1, signal)
    assert_same(states(stored, 2), states(restored, 4), 1e-12 if dtype == "f8" else 1e-3)
    assert_same([stored.belief(2)], [restored.belief(4)], 1e-12 if dtype == "f8" else 1e-5)


@learning
def test_states_of_another_library_are_refused_and_change_nothing(family):
    made, state = taught(family), taught(family).state(0)
    before = states(made, 1)
    wrong = [
        (np.log([0.5, 0.5]), state),
        (np.log([0.5, 0.4, 0.3]), state),
        (made.log_belief[0], state | {"signal.log_weights": np.zeros(7)}),
    ]
    for name in state:
        if name == "unknown.log_odds":
            wrong.append((made.log_belief[0], state | {name: np.array(np.nan)}))
        elif not name.endswith("log_weights"):
            wrong.append((made.log_belief[0], {key: value for key, value in state.items() if key != name}))
            wrong.append((made.log_belief[0], state | {name: np.full_like(state[name], 99)[..., :1]}))
            wrong.append((made.log_belief[0], state | {name: -1 - state[name]}))
    for log_belief, parts in wrong:
        with pytest.raises(InputError, match=r"state|log_belief"):
            made.restore(1, log_belief, parts)
    assert_same(states(made, 1), before)


# ---- types that change ---------------------------------------------------------------------------------------


@learning
def test_what_was_shown_fades_with_the_probability_of_a_change(family):
    """At `keep` 1 nothing changes, at 0 all is forgotten, and between them the weights are those of the twin."""
    fresh = algorithm(family)
    for keep in (1.0, 0.0):
        made = taught(family)
        made.signals.fade(np.array([0, 3]), np.full(2, keep))
        expected = states(taught(family), 0) if keep else states(fresh, 0)
        assert_same(states(made, 0)[1:], expected[1:])
        assert_same(states(made, 1), states(taught(family), 1))
    half, twin, signal = algorithm(family), family.twin(), family.draw(np.random.default_rng(7))
    half.observe(0, 1, signal)
    twin.observe(family.place(1), signal)
    half.signals.fade(0, np.array(0.5))
    twin._fade(0.5)
    for _ in range(2):
        found = half.observe(0, 1, signal).log_evidence
        # The mixture with unchanged spreads: both have begun the same episode.
        assert found == pytest.approx(twin.observe(family.place(1), signal), abs=1e-11)


# ---- the library, and arguments ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["gaussian", "student-t", "histogram", "categorical"])
def test_outcomes_beside_the_signal_teach_how_well_policies_do(name):
    """As they would as signals; an outcome that no type explains teaches nothing."""
    family, signal = FAMILIES[name], FAMILIES["category"].library().signal
    library = PolicyLibrary(family.library().performance, signal, prior=PRIOR)
    made, outcome = ReuseAlgorithm(library, 2, spread=Spread.known(0.3)), family.draw(np.random.default_rng(8))
    alone = algorithm(family, spread=Spread.known(0.3))
    made.observe(np.arange(2), np.array([1, 0]), [0, 1], np.full(2, outcome))
    made.observe(0, 1, 2, outcome)
    for _ in range(2):
        alone.observe(0, 1, outcome)
    mean = made.known(0).performance.mean
    assert mean == pytest.approx(alone.known(0).performance.mean)
    assert (mean[:, 1] != library.performance.mean[:, 1]).all()
    made.observe(0, 1, 2)
    for unexplained in {"histogram": [99.0], "categorical": [7.7, 20.0]}.get(name, []):
        made.observe(0, 1, 2, unexplained)
        made.observe(np.arange(2), np.array([1, 1]), [2, 3], [unexplained, outcome])
    assert made.known(0).performance.mean.tolist() == mean.tolist()


@pytest.mark.parametrize("name", ["gaussian", "student-t", "histogram", "categorical"])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_an_algorithm_does_not_see_what_its_library_learns_later(name, dtype):
    made, other = (taught(FAMILIES[name], dtype=dtype) for _ in range(2))
    for _ in range(30):
        made.library.observe(0, 0, 3.0)
    for one in (made, other):
        one.update(1, 0, 3.0)
    assert_same(states(made, np.arange(K)), states(other, np.arange(K)), 0)


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_plug_in_models_follow_what_the_library_learns(dtype):
    library = FAMILIES["gaussian"].library()
    made = ReuseAlgorithm(library, models="plug-in", dynamics=TypeDynamics.static(), dtype=dtype)
    for _ in range(500):
        library.observe(0, 0, 40.0)
    made.update(0, 0, 30.0)
    expected = np.array(PRIOR) * np.exp(library.performance.log_density(0, 30.0))
    assert made.belief(0) == pytest.approx(expected / expected.sum())


class Doubled(GaussianOutcomes):
    """Gaussian outcomes with densities of their own."""

    def log_densities(self, policies, values):
        return 2 * super().log_densities(policies, values)


class Tripled(ReturnSignal):
    """Returns with log likelihoods of their own."""

    def log_likelihood(self, policy, signal):
        return 3 * super().log_likelihood(policy, signal)


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_likelihoods_of_a_callers_subclass_are_those_that_count(dtype):
    means, normal = [[0.0, 1.0], [2.0, 1.0]], GaussianOutcomes([[0.0, 1.0], [2.0, 1.0]], 1.0)
    for performance, signal, factor in ((Doubled(means, 1.0), None, 2), (normal, Tripled(normal), 3)):
        library = PolicyLibrary(performance, signal)
        made = ReuseAlgorithm(library, 2, dynamics=TypeDynamics.static(), dtype=dtype)
        made.update(np.arange(2), np.array([0, 1]), np.array([0.5, 0.5]))
        expected = np.exp(factor * normal.log_density(0, 0.5))
        assert made.belief(0) == pytest.approx(expected / expected.sum())
        assert made.belief(1) == pytest.approx([0.5, 0.5])


def test_arguments_that_break_their_rule_are_refused():
    library = FAMILIES["gaussian"].library()
    for options, message in (
        ({"dynamics": TypeDynamics.hazard(0.1, [0.2, 0.8])}, "dynamics are for 2 types"),
        ({"prior": [0.5, 0.5]}, r"prior must be \(3,\)"),
        ({"models": "exact"}, "'uncertain' or 'plug-in'"),
        ({"dtype": "f2"}, "'f4' or 'f8'"),
    ):
        with pytest.raises(InputError, match=message):
            ReuseAlgorithm(library, **options)


@every_family
def test_signals_that_are_none_are_refused_and_change_nothing(family):
    made, before = taught(family), states(taught(family), np.arange(K))
    kind = getattr(made.library.signal, "kind", "own")
    wrong = {"own": [], "return": [np.nan, np.inf, -np.inf, 1e200, "much", None, [1.0, 2.0]]}
    for signal in wrong.get(kind, ["no such", np.nan, [[9, 9, 9]]]):
        with pytest.raises(InputError):
            made.observe(0, 0, signal)
        with pytest.raises(InputError):
            made.observe(np.array([1, 0]), np.array([0, 0]), [family.draw(np.random.default_rng(0)), signal])
    assert_same(states(made, np.arange(K)), before, 0)
