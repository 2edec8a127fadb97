"""Many users at once: as one agent a user, compiled and plain alike, hostile signals, saved to the bit."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_algorithm import BLOCK
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.reuse.user_file import load_users, save_users
from lifelore.interaction.reuse.user_kernels import LEAST_LOG, bayes_users_f4, read_f4
from lifelore.interaction.selection import RULES, BeliefSampling, ExpectedImprovement, Greedy, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

KERNELS_RUN = Path(__file__).with_name("user_kernels_run.py")
N_TYPES, N_POLICIES = 9, 6
TOLERANCE = {"f8": 1e-12, "f4": 1e-5}
FLOOR = 1e-6
"""Above this, float32 beliefs also hold to 1e-4 of themselves."""


def library(kind: str = "return", **options) -> PolicyLibrary:
    random = np.random.default_rng(7)
    mean = random.normal(scale=30, size=(N_TYPES, N_POLICIES))
    probs = random.dirichlet(np.full(5, 0.5), (N_TYPES, N_POLICIES))
    probs[0, :, 0] = 0
    probs /= probs.sum(axis=2, keepdims=True)
    signal = {
        "return": None,
        "category": CategorySignal(probs),
        "own": LikelihoodSignal(lambda policy, x: -np.abs(mean[:, policy] - x), N_TYPES, N_POLICIES),
    }.get(kind)
    if kind in ("student-t", "histogram"):
        samples = mean[..., None] + random.normal(scale=20, size=(N_TYPES, N_POLICIES, 8))
        settings = {"edges": np.linspace(-150, 150, 13)} if kind == "histogram" else {}
        return PolicyLibrary.from_samples(samples, model=kind, **settings, **options)
    return PolicyLibrary.from_means(mean, 20.0, signal=signal, **options)


def drawn(model: PolicyLibrary, random: np.random.Generator, n: int):
    if isinstance(model.signal, CategorySignal):
        return random.integers(0, 5, n)
    return random.normal(scale=40, size=n)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["return", "category", "own", "student-t", "histogram"])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_batch_agrees_with_one_agent_a_user(kind, dtype):
    model, random = library(kind), np.random.default_rng(0)
    users = UserBeliefs(model, 40, dtype, models="plug-in")
    agents = [BayesianPolicyReuse(model, models="plug-in") for _ in range(40)]
    for _ in range(15):
        who, policies = random.integers(0, 40, 60), random.integers(0, N_POLICIES, 60)
        signals = drawn(model, random, 60)
        evidence = users.update(who, policies, signals)
        for k, (user, policy, signal) in enumerate(
            zip(who.tolist(), policies.tolist(), signals.tolist(), strict=True)
        ):
            agents[user].update(policy, signal)
            told = agents[user]._evidence[-1].log_evidence
            assert evidence[k] == told or evidence[k] == pytest.approx(told, rel=TOLERANCE[dtype], abs=1e-4)
        one_by_one = np.array([agent.belief for agent in agents])
        found = users.belief(np.arange(40))
        assert found == pytest.approx(one_by_one, abs=TOLERANCE[dtype])
        above = one_by_one > FLOOR
        assert found[above] == pytest.approx(one_by_one[above], rel=10 * TOLERANCE[dtype])
    assert (users.log_belief == -np.inf).any() == (kind == "category")


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("name", ["greedy", "expected-improvement", "knowledge-gradient", "belief-entropy"])
def test_rules_select_what_one_agent_a_user_selects(dtype, name):
    model, random = library(), np.random.default_rng(1)
    users = UserBeliefs(model, 700, dtype)
    policies, signals = random.integers(0, N_POLICIES, 700), drawn(model, random, 700)
    together = users.update_and_select(np.arange(700), policies, signals, name, episodes_left=5)
    assert np.array_equal(together, users.select(np.arange(700), name, episodes_left=5))
    rule, differ = rule_named(name), 0
    for user in range(700):
        scores = rule.scores(model, users.belief([user])[0], episodes_left=5)
        # float32 may decide otherwise between policies worth the same to its precision.
        assert scores[together[user]] >= scores.max() - 1e-4 * np.abs(scores).max()
        differ += scores.argmax() != together[user]
    assert differ <= (0 if dtype == "f8" else 3)


def test_sampling_follows_the_belief():
    model = library()
    users = UserBeliefs(model, 20_000)
    users.update(np.arange(20_000), np.full(20_000, 2), np.full(20_000, 11.0))
    stated = users.probabilities([0], "sampling")[0]
    for chosen in (users.select(np.arange(20_000), "sampling"), users.select(np.arange(20_000), BeliefSampling())):
        # A share of 20000 has a deviation of at most 0.0035; five of them.
        assert np.bincount(chosen, minlength=N_POLICIES) / 20_000 == pytest.approx(stated, abs=0.018)


def test_equal_best_responses_are_sampled_evenly():
    users = UserBeliefs(PolicyLibrary.from_means([[1.0, 1.0, 0.0], [0.0, 1.0, 1.0]], 1.0), 20_000)
    chosen = np.bincount(users.select(np.arange(20_000), "sampling"), minlength=3) / 20_000
    assert chosen == pytest.approx([0.25, 0.5, 0.25], abs=0.018)
    flat = UserBeliefs(PolicyLibrary.from_means(np.eye(4), 1.0), 20_000).select(np.arange(20_000), Greedy())
    assert np.bincount(flat) / 20_000 == pytest.approx(np.full(4, 0.25), abs=0.018)


def test_users_take_four_bytes_a_type():
    users = UserBeliefs(PolicyLibrary.from_means(np.zeros((68, 68)), 1.0), 1000)
    assert users.log_belief.nbytes / users.n_users == 272
    assert sum(x.nbytes for x in vars(users).values() if isinstance(x, np.ndarray)) < 300 * 1000


def test_a_user_may_come_twice_across_and_within_blocks():
    model, n = library(), 2 * BLOCK + 10
    random = np.random.default_rng(3)
    policies, signals = random.integers(0, N_POLICIES, n), drawn(model, random, n)
    users = UserBeliefs(model, 3, "f8")
    users.update(np.ones(n, int), policies, signals)
    agent = BayesianPolicyReuse(model, models="plug-in")
    for policy, signal in zip(policies.tolist(), signals.tolist(), strict=True):
        agent.update(policy, signal)
    assert users.log_belief[1] == pytest.approx(agent.log_belief, rel=1e-9, abs=1e-9)
    assert np.array_equal(users.log_belief[0], np.log(model.prior))


def test_what_float32_reads_as_zero_it_does_not_forget():
    model = PolicyLibrary.from_means([[0.0, 0.0], [20.0, 0.0]], 1.0)
    users = UserBeliefs(model, 1)
    for _ in range(3):
        users.update([0], [0], [0.0])
    # Each signal weighs 200 nats: far below the least float32, and still three signals the other way bring it
    # back.
    assert users.log_belief[0, 1] == pytest.approx(-600, rel=1e-5)
    assert users.belief([0]).tolist() == [[1.0, pytest.approx(math.exp(-600), rel=1e-2)]]
    assert users.select([0], "sampling").tolist() in ([0], [1])
    for _ in range(3):
        users.update([0], [0], [20.0])
    assert users.belief([0]) == pytest.approx(np.array([[0.5, 0.5]]), abs=1e-3)


def test_read_beliefs_hold_no_subnormals():
    logs = np.linspace(-110, 0, 2000, dtype=np.float32).reshape(20, 100)
    logs[:, 0] = 0
    logs[3, 5] = -np.inf
    linear = np.empty_like(logs)
    read_f4(logs, np.arange(20), linear)
    assert ((linear == 0) | (linear >= np.finfo(np.float32).tiny)).all()
    exact = np.exp(logs.astype(np.float64))
    exact[logs <= LEAST_LOG] = 0
    assert linear == pytest.approx(exact / exact.sum(axis=1, keepdims=True), rel=1e-6, abs=0)


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_hundred_thousand_hostile_signals_leave_beliefs(dtype):
    random = np.random.default_rng(0)
    model = PolicyLibrary.from_means(random.normal(size=(7, 4)), 1e-3)
    users, kept = UserBeliefs(model, 1000, dtype), 0
    for _ in range(100):
        signals = random.choice([-1.0, 1.0], 1000) * 10.0 ** random.uniform(-300, 100, 1000)
        evidence = users.update(random.permutation(1000), random.integers(0, 4, 1000), signals)
        kept += (evidence == -np.inf).sum()
        assert not np.isnan(users.log_belief).any()
        assert not np.isnan(evidence).any()
        assert (users.log_belief <= 0).all()
        assert np.abs(np.exp(users.log_belief.astype(float)).sum(axis=1) - 1).max() < 1e-5
    chosen = users.select(np.arange(1000), "greedy")
    assert ((chosen >= 0) & (chosen < 4)).all()
    assert users.select(np.arange(1000), ExpectedImprovement()).shape == (1000,)


def test_unexplained_signals_keep_the_belief_to_the_bit():
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.5, 0.5, 0.0]]])
    model = PolicyLibrary.from_means([[0.0], [1.0]], 1.0, signal=CategorySignal(probs))
    for dtype in ("f4", "f8"):
        users = UserBeliefs(model, 2, dtype)
        users.update([0, 1], [0, 0], [0, 1])
        before = users.log_belief.copy()
        assert users.update([0, 1], [0, 0], [2, 2]).tolist() == [-np.inf, -np.inf]
        assert np.array_equal(users.log_belief, before)
        assert before[1].tolist() == [-np.inf, 0.0]


def test_types_that_change_and_forgotten_users():
    model = library(prior=np.linspace(1, 3, N_TYPES) / np.linspace(1, 3, N_TYPES).sum())
    changing = TypeDynamics.hazard(0.1, model.prior)
    users, agent = UserBeliefs(model, 5, "f8", dynamics=changing), BayesianPolicyReuse(model, dynamics=changing)
    for signal in (3.0, -20.0, 44.0):
        chosen = users.update_and_select([4, 2], [1, 1], [signal, signal], "greedy")
        agent.update(1, signal)
        assert chosen[0] == chosen[1] == agent.expected_utility().argmax()
    assert users.belief([4, 2]) == pytest.approx(np.array([agent.belief] * 2), abs=1e-12)
    with pytest.raises(InputError, match="distinct where types change"):
        users.update([1, 1], [0, 0], [1.0, 2.0])
    users.reset([4])
    assert users.belief([4])[0] == pytest.approx(model.prior)
    assert users.belief([2])[0] != pytest.approx(model.prior)


def test_a_library_that_learns_is_taken_anew():
    model = PolicyLibrary.from_means([[0.0, 1.0], [1.0, 0.0]], 1.0, count=10)
    users = UserBeliefs(model, 1, "f8", models="plug-in")
    for _ in range(2000):
        model.observe(0, 0, 9.0)
    users.refresh()
    users.update([0], [0], [9.0])
    agent = BayesianPolicyReuse(model, models="plug-in")
    agent.update(0, 9.0)
    assert users.belief([0])[0] == pytest.approx(agent.belief, abs=1e-12)
    assert users.select([0], "greedy").tolist() == [agent.expected_utility().argmax()]


@pytest.mark.slow
def test_compiled_and_plain_python_agree(tmp_path):
    arrays = {}
    for name, switch in (("compiled", "0"), ("plain", "1")):
        out = tmp_path / f"{name}.npz"
        done = subprocess.run(
            [sys.executable, "-W", "error", str(KERNELS_RUN), str(out)],
            env=os.environ | {"NUMBA_DISABLE_JIT": switch},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        with np.load(out) as packed:
            arrays[name] = dict(packed)
    assert set(arrays["compiled"]) == set(arrays["plain"])
    assert len(arrays["plain"]) > 50
    for name, value in arrays["compiled"].items():
        assert value.dtype == arrays["plain"][name].dtype, name
        # Exponentials and matrix products may be rounded otherwise; choices may not differ.
        close = 0 if value.dtype.kind == "i" else 3e-6 if "f4" in name else 1e-11
        assert value == pytest.approx(arrays["plain"][name], rel=close, abs=close), name


# ---- files ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_saved_users_go_on_to_the_bit(dtype, tmp_path):
    model, random = library("category"), np.random.default_rng(0)
    users = UserBeliefs(
        model, 300, dtype, prior=np.arange(1, 10) / 45, dynamics=TypeDynamics.hazard(0.01, model.prior)
    )
    users.update(np.arange(300), random.integers(0, N_POLICIES, 300), drawn(model, random, 300))
    save_users(users, tmp_path / "users")
    loaded = load_users(tmp_path / "users")
    for one in (users, loaded):
        one.reset([7])
    for _ in range(3):
        policies, signals = random.integers(0, N_POLICIES, 300), drawn(model, random, 300)
        chosen = [one.update_and_select(np.arange(300), policies, signals) for one in (users, loaded)]
        assert np.array_equal(*chosen)
        assert users.log_belief.tobytes() == loaded.log_belief.tobytes()


def test_files_that_are_none_are_refused(tmp_path):
    path = tmp_path / "users.npz"
    with pytest.raises(InputError, match="cannot be read"):
        load_users(path)
    users = UserBeliefs(library(), 3)
    save_users(users, path)
    content = path.read_bytes()
    for cut in (0, 20, len(content) // 2, len(content) - 5):
        path.write_bytes(content[:cut])
        with pytest.raises(InputError, match="no file of user beliefs that can be read"):
            load_users(path)
    users.log_belief[1] = np.nan
    save_users(users, path)
    with pytest.raises(InputError, match="no beliefs"):
        load_users(path)
    np.savez(path, about=np.frombuffer(b"[]", np.uint8))
    with pytest.raises(InputError, match="another kind of file"):
        load_users(path)
    with pytest.raises(StoreError, match="cannot be written"):
        save_users(users, tmp_path / "no" / "users.npz")


# ---- bad input -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([0, 3], [0, 0], [1.0, 1.0]), NotFoundError, "unknown user 3; there are 3"),
        (([-1], [0], [1.0]), NotFoundError, "unknown user -1"),
        (([0], [6], [1.0]), NotFoundError, "unknown policy 6; there are 6"),
        (([0.5], [0], [1.0]), InputError, "whole numbers"),
        (([[0]], [0], [1.0]), InputError, "whole numbers"),
        (([0], [0], [math.nan]), InputError, "signals must be finite"),
        (([0], [0], [math.inf]), InputError, "signals must be finite"),
        (([0], [0], [1e200]), InputError, "signals must be finite"),
        (([0, 1], [0], [1.0]), InputError, "equally many, got 2, 1 and 1"),
    ],
)
def test_arguments_that_break_their_rule_are_refused(arguments, error, message):
    users = UserBeliefs(library(), 3)
    before = users.log_belief.copy()
    with pytest.raises(error, match=message):
        users.update(*arguments)
    assert np.array_equal(users.log_belief, before)


def test_categories_and_models_that_answer_wrongly_are_refused():
    users = UserBeliefs(library("category"), 3)
    for bad in ([5], [-1], [0.5]):
        with pytest.raises(InputError, match="category numbers 0 to 4"):
            users.update([0], [0], bad)

    class Broken:
        def log_likelihoods(self, policies, signals):
            return np.full((len(policies), N_TYPES), np.nan)

    model = library()
    model.signal = Broken()
    users = UserBeliefs(model, 3)
    with pytest.raises(InputError, match="gave NaN or infinity"):
        users.update([0], [0], [1.0])
    assert not np.isnan(users.log_belief).any()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"users": 0}, "users must be at least 1"),
        ({"users": 2, "dtype": "f2"}, "dtype must be"),
        ({"users": 2, "prior": [0.5, 0.5]}, r"prior must be \(9,\)"),
        ({"users": 2, "dynamics": TypeDynamics.hazard(0.1, [0.5, 0.5])}, "dynamics are for 2 types"),
    ],
)
def test_settings_that_break_their_rule_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        UserBeliefs(library(), **options)


def test_nothing_to_do_is_nothing_done():
    users = UserBeliefs(library(), 3)
    assert users.update([], [], []).shape == (0,)
    assert users.select([]).shape == (0,)
    assert set(RULES) == {name for name in RULES if users.select([1], name).shape == (1,)}


def test_the_kernel_reports_what_no_type_explains():
    logs = np.log(np.array([[0.5, 0.5]], np.float32))
    said, linear, evidence = np.full((1, 2), -np.inf), np.empty((1, 2), np.float32), np.empty(1)
    bayes_users_f4(logs, np.array([0]), said, linear, evidence)
    assert evidence.tolist() == [-np.inf]
    assert linear == pytest.approx(np.array([[0.5, 0.5]]))


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_probabilities_are_those_by_which_is_selected_where_policies_are_nearly_equal(dtype):
    """What a log says of the chance of a choice must hold however small the difference: it is divided by later."""
    near = [[1.0, 1.0 + 1e-8], [1.0, 1.0]]
    users = UserBeliefs(PolicyLibrary.from_means(near, 1.0), 4000, dtype, prior=[1.0, 0.0])
    every = np.arange(4000)
    for rule, equal in (("greedy", dtype == "f4"), ("sampling", False)):
        stated = users.probabilities([0], rule)[0]
        assert stated.tolist() == ([0.5, 0.5] if equal else [0.0, 1.0])
        # Four deviations of a share of 4000.
        assert np.bincount(users.select(every, rule), minlength=2) / 4000 == pytest.approx(stated, abs=0.032)


def test_evidence_below_the_range_of_numbers_is_not_that_of_the_impossible():
    said = {0: [-1.7e308, 0.0], 1: [-1.7e308, -np.inf]}
    signal = LikelihoodSignal(lambda policy, x: said[int(x)], 2)
    model = PolicyLibrary.from_means([[0.0], [1.0]], 1.0, signal=signal)
    users, agent = UserBeliefs(model, 1, "f8"), BayesianPolicyReuse(model, models="plug-in")
    for x in (0, 1):
        evidence = users.update([0], [0], [x])
        agent.update(0, x)
    assert np.isfinite(evidence).all()
    assert agent.unexplained == 0
    assert users.log_belief[0].tolist() == agent.log_belief.tolist() == [0.0, -np.inf]
