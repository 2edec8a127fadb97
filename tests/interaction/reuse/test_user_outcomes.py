"""Uncertain models for many users: as the formulas and as one agent a user, hostile outcomes, saved to the bit."""

import json

import numpy as np
import pytest
from scipy.special import gammaln

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.reuse.user_file import load_users, save_users
from lifelore.interaction.selection import RULES, ExpectedImprovement, Greedy

N_TYPES, N_POLICIES = 9, 6
BELIEF = {"f8": 1e-12, "f4": 1e-5}
SPREAD = 0.3
KINDS = ["gaussian", "uneven", "partly exact", "student-t", "histogram", "categorical"]


def library(kind: str = "gaussian", spread: float | None = SPREAD) -> PolicyLibrary:
    """A learnt library; `spread` is the only spread that it holds possible, None leaves it to be estimated."""
    random = np.random.default_rng(7)
    mean = random.normal(scale=30, size=(N_TYPES, N_POLICIES))
    samples = mean[..., None] + random.normal(scale=20, size=(N_TYPES, N_POLICIES, 8))
    if kind in ("uneven", "partly exact"):
        count = random.integers(3, 40, (N_TYPES, N_POLICIES)).astype(float)
        if kind == "partly exact":
            count[::2, 1:3] = np.inf
        made = PolicyLibrary.from_means(mean, random.uniform(5, 30, (N_TYPES, N_POLICIES)), count=count)
    elif kind == "histogram":
        made = PolicyLibrary.from_samples(samples, model=kind, edges=np.linspace(-150, 150, 13))
    elif kind == "categorical":
        made = PolicyLibrary.from_samples(random.choice([0.0, 3.0, 10.0], samples.shape), model=kind)
    else:
        made = PolicyLibrary.from_samples(samples, model=kind)
    if spread is not None:
        holder, name = (made.performance.moments, "spread") if hasattr(made.performance, "moments") else (
            made.performance, "_spread"
        )  # fmt: skip
        setattr(holder, name, Spread.known(spread))
    return made


def drawn(kind: str, random: np.random.Generator, n: int):
    return random.choice([0.0, 3.0, 10.0], n) if kind == "categorical" else random.normal(scale=40, size=n)


class Naive:
    """One user, by the formulas as they are printed: all outcomes stay, nothing is summed up."""

    def __init__(self, model: PolicyLibrary, spread: float) -> None:
        moments = model.performance.moments
        self.m0, self.v0, self.nu0 = moments.mean, moments.variance, moments.freedom
        self.kappa0 = 1 / (1 / moments.count + spread)
        self.log_belief, self.seen = np.log(model.prior), [[] for _ in range(model.n_policies)]

    def law(self, policy: int):
        x = np.array(self.seen[policy])
        m0, v0, nu0, kappa0 = (a[:, policy] for a in (self.m0, self.v0, self.nu0, self.kappa0))
        if not len(x):
            return kappa0, m0, nu0, v0
        k, mean = len(x), x.mean()
        kappa = kappa0 + k
        square = nu0 * v0 + ((x - mean) ** 2).sum() + kappa0 * k / kappa * (mean - m0) ** 2
        return kappa, (kappa0 * m0 + k * mean) / kappa, nu0 + k, square / (nu0 + k)

    def update(self, policy: int, value: float) -> float:
        kappa, m, nu, v = self.law(policy)
        square = v * (1 + 1 / kappa)
        height = gammaln((nu + 1) / 2) - gammaln(nu / 2) - 0.5 * np.log(nu * np.pi * square)
        joint = self.log_belief + height - (nu + 1) / 2 * np.log1p((value - m) ** 2 / nu / square)
        evidence = np.logaddexp.reduce(joint)
        self.log_belief = joint - evidence
        self.seen[policy].append(value)
        return evidence

    def means(self) -> np.ndarray:
        return np.stack([self.law(policy)[1] for policy in range(len(self.seen))], axis=1)


@pytest.mark.parametrize("kind", ["gaussian", "uneven", "student-t"])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_batch_agrees_with_the_formulas(kind, dtype):
    model, random = library(kind), np.random.default_rng(0)
    users = UserBeliefs(model, 30, dtype, spread=0.7, dynamics=TypeDynamics.static())
    naive = [Naive(model, 0.7) for _ in range(30)]
    for _ in range(12):
        who, policies = random.integers(0, 30, 80), random.integers(0, N_POLICIES, 80)
        signals = drawn(kind, random, 80)
        evidence = users.update(who, policies, signals)
        expected = [
            naive[user].update(policy, signal)
            for user, policy, signal in zip(who.tolist(), policies.tolist(), signals.tolist(), strict=True)
        ]
        assert evidence == pytest.approx(np.array(expected), rel=BELIEF[dtype], abs=10 * BELIEF[dtype])
        belief = np.exp([user.log_belief for user in naive])
        assert users.belief(np.arange(30)) == pytest.approx(belief, abs=BELIEF[dtype])
    chosen = users.select(np.arange(30), "greedy")
    utility = np.array([user @ one.means() for user, one in zip(belief, naive, strict=True)])
    assert (utility[np.arange(30), chosen] >= utility.max(axis=1) - 1e-3).all()
    shares = users.probabilities(np.arange(30), "sampling")
    for user, one in enumerate(naive):
        best = np.eye(N_POLICIES)[one.means().argmax(axis=1)]
        assert shares[user] == pytest.approx(belief[user] @ best, abs=10 * BELIEF[dtype])


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_batch_agrees_with_one_agent_a_user(kind, dtype):
    model, random = library(kind), np.random.default_rng(0)
    users, agents = UserBeliefs(model, 12, dtype), [BayesianPolicyReuse(model, Greedy()) for _ in range(12)]
    assert users.outcomes is not None
    for _ in range(12):
        who, policies = random.integers(0, 12, 30), random.integers(0, N_POLICIES, 30)
        signals = drawn(kind, random, 30)
        evidence = users.update(who, policies, signals)
        for k, (user, policy, signal) in enumerate(
            zip(who.tolist(), policies.tolist(), signals.tolist(), strict=True)
        ):
            agents[user].update(policy, signal)
            told = agents[user]._evidence[-1].log_evidence
            assert evidence[k] == told or evidence[k] == pytest.approx(told, rel=BELIEF[dtype], abs=1e-4)
        one_by_one = np.array([agent.belief for agent in agents])
        assert users.belief(np.arange(12)) == pytest.approx(one_by_one, abs=BELIEF[dtype])
    every = np.arange(12)
    for rule in (Greedy(), ExpectedImprovement(), RULES["sampling"](), RULES["information-directed"]()):
        stated = users.probabilities(every, rule)
        for user, agent in enumerate(agents):
            agent.rule = rule
            assert stated[user] == pytest.approx(agent.probabilities(), abs=100 * BELIEF[dtype]), rule.name
    utility = np.array([agent.expected_utility() for agent in agents])
    assert (utility[every, users.select(every, "greedy")] >= utility.max(axis=1) - 1e-3).all()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_users_whose_types_change_agree_with_one_agent_a_user(kind, dtype):
    model, random = library(kind), np.random.default_rng(0)
    prior = np.linspace(1, 3, N_TYPES) / np.linspace(1, 3, N_TYPES).sum()
    changing = TypeDynamics.hazard(0.05, prior)
    users = UserBeliefs(model, 12, dtype, dynamics=changing)
    agents = [BayesianPolicyReuse(model, Greedy(), dynamics=changing) for _ in range(12)]
    for _ in range(12):
        # A user comes more than once in a call: its signals are taken in turn.
        who, policies = random.integers(0, 12, 30), random.integers(0, N_POLICIES, 30)
        signals = drawn(kind, random, 30)
        evidence = users.update(who, policies, signals)
        for k, (user, policy, signal) in enumerate(
            zip(who.tolist(), policies.tolist(), signals.tolist(), strict=True)
        ):
            agents[user].update(policy, signal)
            assert evidence[k] == pytest.approx(agents[user]._evidence[-1].log_evidence, rel=1e-6, abs=1e-4)
        one_by_one = np.array([agent.belief for agent in agents])
        assert users.belief(np.arange(12)) == pytest.approx(one_by_one, abs=10 * BELIEF[dtype])
    stated = users.probabilities(np.arange(12), "sampling")
    for user, agent in enumerate(agents):
        agent.rule = RULES["sampling"]()
        assert stated[user] == pytest.approx(agent.probabilities(), abs=100 * BELIEF[dtype])


@pytest.mark.parametrize("kind", ["gaussian", "categorical"])
def test_sampling_follows_the_stated_probabilities(kind):
    model, random = library(kind), np.random.default_rng(2)
    users = UserBeliefs(model, 20_000)
    for policy in (2, 4, 2, 0):
        users.update(np.arange(20_000), np.full(20_000, policy), np.full(20_000, drawn(kind, random, 1)[0]))
    among = np.array([True, False, True, True, False, True])
    for available in (None, among):
        stated = users.probabilities([0], "sampling", available=available)[0]
        chosen = users.select(np.arange(20_000), "sampling", available=available)
        # A share of 20000 has a deviation of at most 0.0035; five of them.
        assert np.bincount(chosen, minlength=N_POLICIES) / 20_000 == pytest.approx(stated, abs=0.018)


def test_a_policy_that_disappoints_is_given_up():
    """What plug-in models never do: they trust the library's overestimate for ever."""
    model = PolicyLibrary.from_means([[10.0, 8.0]], 1.0, count=5.0)
    outcomes = np.full(40, 6.0)
    for models, last in (("uncertain", 1), ("plug-in", 0)):
        users = UserBeliefs(model, 1, "f8", models=models)
        for outcome in outcomes:
            users.update([0], [0], [outcome])
        assert users.select([0], "greedy").tolist() == [last]
    # (5 · 10 + 40 · 6) / 45 = 6.44 < 8.


def test_exact_models_stay_plug_in():
    assert UserBeliefs(PolicyLibrary.from_means(np.eye(3), 1.0), 2).outcomes is None
    assert UserBeliefs(library(), 2, models="plug-in").outcomes is None


def test_ten_tried_policies_of_sixty_eight_take_less_than_600_bytes():
    random, n = np.random.default_rng(0), 20_000
    model = PolicyLibrary.from_samples(random.normal(size=(68, 68, 3)))
    users, every = UserBeliefs(model, n, spread=0.0), np.arange(n)
    tried = np.argsort(random.random((n, 68)), axis=1)[:, :10]
    for policies in (*tried.T, *tried.T):
        users.update(every, policies, random.normal(size=n))
    assert users.nbytes / n <= 600
    users.reset(every)
    for policies in tried.T:
        users.update(every, policies, random.normal(size=n))
    assert users.nbytes / n <= 600


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("kind", ["gaussian", "partly exact", "histogram", "changing"])
def test_a_million_hostile_outcomes_leave_beliefs(kind, dtype):
    random, n, dynamics = np.random.default_rng(0), 1000, TypeDynamics.static()
    if kind == "changing":
        kind, dynamics = "gaussian", TypeDynamics.hazard(0.002, np.full(N_TYPES, 1 / N_TYPES))
    users, every = UserBeliefs(library(kind), n, dtype, dynamics=dynamics), np.arange(n)
    rounds = 1000 if kind == "gaussian" else 100
    for turn in range(rounds):
        size = 10.0 ** random.uniform(-320, 100, n)
        signals = np.where(turn % 3 == 0, random.normal(size=n), random.choice([-1.0, 1.0], n) * size)
        signals[:2] = 1e100, -1e100
        who, policies = random.permutation(n), random.integers(0, N_POLICIES, n)
        chosen = users.update_and_select(who, policies, signals, "sampling")
        assert ((chosen >= 0) & (chosen < N_POLICIES)).all()
        assert (users.log_belief <= 0).all()
    assert np.abs(np.exp(users.log_belief.astype(float)).sum(axis=1) - 1).max() < 1e-5
    tried = users.outcomes.tried(every)
    assert np.isfinite(tried.averages).all()
    assert np.isfinite(tried.counts).all()
    assert users.select(every, "greedy").shape == (n,)


def test_users_forget_and_their_memory_serves_others():
    random, n = np.random.default_rng(0), 400
    users, every = UserBeliefs(library(), n, "f8"), np.arange(n)
    for policy in range(N_POLICIES):
        users.update(every, np.full(n, policy), random.normal(size=n))
    before = users.nbytes
    users.reset([*every[::2], 0])
    assert users.belief([0])[0] == pytest.approx(users.library.prior)
    fresh = UserBeliefs(library(), 1, "f8")
    for policy in range(N_POLICIES):
        users.update(every[::2], np.full(n // 2, policy), np.arange(n // 2))
        fresh.update([0], [policy], [7.0])
    assert users.belief([14]) == pytest.approx(fresh.belief([0]), abs=1e-12)
    assert users.nbytes == before
    assert np.diff(users.outcomes.tried(every).starts).tolist() == [N_POLICIES] * n


def test_a_library_that_learns_is_taken_anew():
    model = library()
    users = UserBeliefs(model, 1, "f8", spread=0.0, dynamics=TypeDynamics.static())
    users.update([0], [0], [5.0])
    for _ in range(500):
        model.observe(3, 0, 90.0)
    users.refresh()
    naive = Naive(model, 0.0)
    naive.log_belief, naive.seen[0] = users.log_belief[0].copy(), [5.0]
    naive.update(0, 60.0)
    users.update([0], [0], [60.0])
    assert users.log_belief[0] == pytest.approx(naive.log_belief, abs=1e-9)
    assert users.probabilities([0], "greedy")[0].argmax() == (np.exp(naive.log_belief) @ naive.means()).argmax()


@pytest.mark.parametrize("kind", ["gaussian", "categorical"])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_saved_users_go_on_to_the_bit(kind, dtype, tmp_path):
    random, names = np.random.default_rng(0), [f"user {i}" for i in range(50)]
    users = UserBeliefs(library(kind, spread=None), names, dtype, unknown="add")
    users.update(names, random.integers(0, N_POLICIES, 50), drawn(kind, random, 50))
    users.reset(names[:7])
    save_users(users, tmp_path / "users")
    loaded = load_users(tmp_path / "users")
    names.append("late")
    for _ in range(4):
        policies, signals = random.integers(0, N_POLICIES, 51), drawn(kind, random, 51)
        chosen = [one.update_and_select(names, policies, signals, "sampling") for one in (users, loaded)]
        assert np.array_equal(*chosen)
        assert users.log_belief.tobytes() == loaded.log_belief.tobytes()
    assert list(loaded.names) == names


def test_statistics_that_do_not_fit_are_refused(tmp_path):
    users, path = UserBeliefs(library(), 20), tmp_path / "users"
    for policy in range(N_POLICIES):
        users.update(np.arange(20), np.full(20, policy), np.arange(20.0))

    def spoil(change):
        save_users(users, path)
        with np.load(path) as packed:
            arrays = {name: packed[name].copy() for name in packed.files}
        change(arrays)
        with path.open("wb") as file:
            np.savez(file, **arrays)
        with pytest.raises(InputError, match="no file of user beliefs"):
            load_users(path)

    spoil(lambda arrays: arrays["heads"].__setitem__(0, 1000))
    spoil(lambda arrays: arrays["heads"].__setitem__(0, arrays["heads"][1]))
    spoil(lambda arrays: arrays["sizes"].__setitem__(3, 40))
    spoil(lambda arrays: arrays["chunks"].view(np.int32).__setitem__((2, 35), 2))
    spoil(lambda arrays: arrays["chunks"].view(np.int32).__setitem__((2, 30), 77))
    spoil(lambda arrays: arrays.pop("sizes"))


def test_files_older_than_uncertain_models_load_with_plug_in_models(tmp_path):
    model, path = library(), tmp_path / "users.npz"
    users = UserBeliefs(model, 4, "f8", models="plug-in")
    users.update([0, 1], [2, 3], [5.0, -8.0])
    save_users(users, path)
    with np.load(path) as packed:
        arrays = {name: packed[name] for name in packed.files}
    header = json.loads(arrays["about"].tobytes())
    old = {key: value for key, value in header.items() if key not in ("models", "spread", "unknown")}
    arrays["about"] = np.frombuffer(json.dumps(old | {"version": 1}).encode(), np.uint8)
    np.savez(path, **arrays)
    loaded = load_users(path)
    assert (loaded.models, loaded.outcomes, loaded.names, loaded.unknown) == ("plug-in", None, None, "error")
    for one in (users, loaded):
        one.update([0, 3], [1, 1], [30.0, 2.0])
    assert users.log_belief.tobytes() == loaded.log_belief.tobytes()
    arrays["about"] = np.frombuffer(json.dumps(header | {"version": 3}).encode(), np.uint8)
    np.savez(path, **arrays)
    with pytest.raises(InputError, match="has version 3, this Lifelore reads 2"):
        load_users(path)
