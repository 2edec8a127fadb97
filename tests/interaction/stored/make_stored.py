"""Make the stored files of policy reuse, and what the commit that made them says of each; run at commit fde65343.

    PYTHONPATH=src python make_stored.py FOLDER

FOLDER gets `libraries.zip`, `sessions.zip` and `users.zip` of npz files, and `memory.zip` of an SQLite memory with
two studies. `expected.json` in each archive holds what that commit says of the files. Later commits must say the
same. Do not run the script at a later commit: it would store what that commit says.
"""

import json
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.agent.reuse.fit import FitSettings, fit
from lifelore.agent.reuse.one_user import choose, retire, update
from lifelore.agent.reuse.report import report
from lifelore.agent.reuse.study import open_study
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_session import load_session, save_session
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.reuse.user_file import load_users, save_users
from lifelore.interaction.selection import RULES, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.ordered_normal_signal import OrderedNormalSignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from lifelore.interaction.signals.reward_signal import RewardSignal
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal
from lifelore.memory import open_memory

TYPES, POLICIES = ("reader", "skimmer", "buyer"), ("big", "dark", "plain", "round")
PRIOR = [0.5, 0.3, 0.2]
MEAN = np.array([[8.0, 2.0, 5.0, 4.0], [2.0, 9.0, 4.0, 5.0], [4.0, 4.0, 3.0, 9.0]])
N_TYPES, N_POLICIES = MEAN.shape
BANDS = ("short", "near", "far")
N_STATES, N_ACTIONS = 3, 2
REWARDS = (0.0, 1.0, 5.0)
OPEN = [4.1, 5.5, 3.2, 4.6, 2.9, 5.2, 3.9, 4.4, 3.6, 5.1, 3.4, 4.8]
"""Outcomes of policy 2 that leave the type open."""
Case = tuple[PolicyLibrary, list[Any]]


def random_of(*key: int) -> np.random.Generator:
    return np.random.default_rng([2026, *key])


# ---- libraries, and twelve signals for each -----------------------------------------------------------------


def runs(n: int = 6) -> np.ndarray:
    """Outcomes (types, policies, n)."""
    return MEAN[..., None] + 1.5 * random_of(1).standard_normal((N_TYPES, N_POLICIES, n))


def numbers(n: int = 12) -> list[float]:
    """Outcomes that a user of type "skimmer" might give."""
    return (MEAN[1, np.arange(n) % N_POLICIES] + 1.5 * random_of(2).standard_normal(n)).round(3).tolist()


def named(make: Any, *args: Any, **options: Any) -> PolicyLibrary:
    return make(*args, types=TYPES, policies=POLICIES, prior=PRIOR, **options)


def with_signal(signal: Any) -> PolicyLibrary:
    return named(PolicyLibrary.from_samples, runs(), signal=signal)


def whole(low: int, high: int, n: int = 12) -> list[int]:
    return random_of(3).integers(low, high, n).tolist()


def band_samples() -> np.ndarray:
    """Band numbers (types, policies, 8): low means are short."""
    hidden = MEAN[..., None] + 2.0 * random_of(4).standard_normal((N_TYPES, N_POLICIES, 8))
    return np.digitize(hidden, [3.5, 6.5])


def steps(key: int, last: int) -> list[list[tuple[int, int, int]]]:
    """Twelve sequences of (state, action, number below `last`)."""
    random = random_of(key)
    below = [N_STATES, N_ACTIONS, last]
    return [np.stack([random.integers(0, n, 4) for n in below], axis=1).tolist() for _ in range(12)]


def transition_counts(*policies: int) -> np.ndarray:
    shape = (N_TYPES, *policies, N_STATES, N_ACTIONS, N_STATES)
    return random_of(5, *policies).integers(0, 12, shape)


def step_reward_episodes() -> list[tuple[int, int, list[tuple[int, int, float]]]]:
    random = random_of(6)
    return [
        (type_, policy, [(s, a, REWARDS[random.choice(3, p=np.roll([0.6, 0.3, 0.1], type_ + s))])])
        for type_ in range(N_TYPES) for policy in range(N_POLICIES)
        for s in range(N_STATES) for a in range(N_ACTIONS) for _ in range(2)
    ]  # fmt: skip


def reward_sequences() -> list[tuple[int, int, list[float]]]:
    random = random_of(7)
    return [
        (type_, policy, random.choice(REWARDS, 8, p=np.roll([0.6, 0.3, 0.1], type_ + policy)).tolist())
        for type_ in range(N_TYPES) for policy in range(N_POLICIES)
    ]  # fmt: skip


def rated(n: int = 6) -> np.ndarray:
    """Ratings 1 to 5 (types, policies, n)."""
    return np.clip(np.round(MEAN[..., None] / 2 + random_of(8).standard_normal((N_TYPES, N_POLICIES, n))), 1, 5)


def rewards_of_steps() -> list[Any]:
    return [[(s, a, REWARDS[r]) for s, a, r in sequence] for sequence in steps(9, 3)]


def libraries() -> dict[str, Case]:
    """Every family of outcomes and kind of signal: a library, and twelve signals it can explain."""
    band, ratings = band_samples(), [float(x) for x in whole(1, 6)]
    deviation = 1.0 + 0.1 * np.arange(N_TYPES * N_POLICIES).reshape(MEAN.shape)
    missing = runs()
    missing[0, 0], missing[1, 2], missing[2, 1, 3:] = np.nan, np.nan, np.nan
    learnt_bands = CategorySignal.from_samples(band, 3, categories=BANDS)
    exact_probs = np.array([[[0.6, 0.3, 0.1], [0.1, 0.2, 0.7], [0.3, 0.4, 0.3], [0.25, 0.5, 0.25]]] * N_TYPES)
    exact_probs = np.stack([np.roll(rows, type_, axis=-1) for type_, rows in enumerate(exact_probs)])
    exact_bands = CategorySignal(exact_probs, BANDS)
    names = [BANDS[k] for k in whole(0, 3)]
    exact = named(PolicyLibrary.from_means, MEAN, 1.5)
    joint = named(PolicyLibrary.from_samples, runs())
    joint = named(PolicyLibrary, joint.performance, JointSignal([ReturnSignal(joint.performance), learnt_bands]))
    weights = random_of(10).uniform(0.2, 1.0, (N_TYPES, N_POLICIES, 6))
    return {
        "gaussian-exact": (exact, numbers()),
        "gaussian-exact-deviations": (named(PolicyLibrary.from_means, MEAN, deviation), numbers()),
        "gaussian-counts": (named(PolicyLibrary.from_means, MEAN, deviation, count=7.0), numbers()),
        "gaussian-learnt": (named(PolicyLibrary.from_samples, runs()), numbers()),
        "gaussian-weights": (named(PolicyLibrary.from_samples, runs(), weights=weights), numbers()),
        "gaussian-gaps": (named(PolicyLibrary.from_samples, missing, gaps=True), numbers()),
        "student-t": (named(PolicyLibrary.from_samples, runs(), model="student-t"), numbers()),
        "histogram": (
            named(PolicyLibrary.from_samples, runs(20), model="histogram", edges=np.linspace(-4, 16, 9)), numbers()
        ),
        "categorical-learnt": (named(PolicyLibrary.from_samples, rated(), model="categorical"), ratings),
        "categorical-exact": (
            named(PolicyLibrary, CategoricalOutcomes([1.0, 3.0, 5.0], exact_probs)),
            [float(2 * k + 1) for k in whole(0, 3)],
        ),
        "category-exact": (with_signal(exact_bands), names),
        "category-learnt": (with_signal(learnt_bands), names),
        "ordered-normal": (
            with_signal(OrderedNormalSignal.from_samples(band, cuts=[3.5, 6.5], categories=BANDS)), names
        ),
        "reward-categorical": (
            with_signal(RewardSignal.from_sequences(reward_sequences(), N_TYPES, N_POLICIES)),
            [random_of(11, k).choice(REWARDS, 3).tolist() for k in range(12)],
        ),
        "reward-gaussian": (
            with_signal(RewardSignal.from_sequences(reward_sequences(), N_TYPES, N_POLICIES, "gaussian")),
            [random_of(11, k).choice(REWARDS, 3).tolist() for k in range(12)],
        ),
        "transition-shared": (with_signal(TransitionSignal.from_counts(transition_counts())), steps(12, N_STATES)),
        "transition-policies": (
            with_signal(TransitionSignal.from_counts(transition_counts(N_POLICIES))), steps(12, N_STATES)
        ),
        "transition-exact": (
            with_signal(TransitionSignal(TransitionSignal.from_counts(transition_counts()).probs, N_POLICIES)),
            steps(12, N_STATES),
        ),
        "step-reward": (
            with_signal(
                StepRewardSignal.from_sequences(step_reward_episodes(), REWARDS, N_TYPES, N_STATES, N_ACTIONS)
            ),
            rewards_of_steps(),
        ),
        "joint": (joint, [[number, name] for number, name in zip(numbers(), names, strict=True)]),
    }  # fmt: skip


# ---- what the commit says -----------------------------------------------------------------------------------


def said_of_agent(agent: BayesianPolicyReuse) -> dict[str, Any]:
    """Answers of an agent that change nothing."""
    return {
        "belief": agent.belief.tolist(),
        "log_belief": agent.log_belief.tolist(),
        "expected_utility": agent.expected_utility().tolist(),
        "probabilities": agent.probabilities().tolist(),
        "probabilities_of_0_and_2": agent.probabilities([0, 2]).tolist(),
        "surprise": float(agent.surprise),
        "unexplained": int(agent.unexplained),
        "episode": agent.episode,
        "novelty": None if agent.novelty is None else float(agent.novelty.probability),
    }


def taught(
    agent: BayesianPolicyReuse, signals: list[Any], policies: list[int], outcomes: bool
) -> BayesianPolicyReuse:
    """The agent after signals of `policies`, a selection before each; `outcomes` beside the signals or not."""
    own = numbers(len(signals))
    for number, (policy, signal) in enumerate(zip(policies, signals, strict=True)):
        agent.select()
        agent.update(policy, signal, own[number] if outcomes else None)
    return agent


def said_of_library(library: PolicyLibrary, signals: list[Any]) -> dict[str, Any]:
    """Numbers of a library, and beliefs after each of the first four signals under both kinds of models."""
    likelihoods = [
        library.signal.log_likelihood(k % N_POLICIES, signal).tolist() for k, signal in enumerate(signals)
    ]
    said: dict[str, Any] = {
        "types": library.types, "policies": library.policies, "prior": library.prior.tolist(),
        "family": library.performance.kind, "signal": library.signal.kind, "signals": signals,
        "mean": np.asarray(library.performance.mean).tolist(),
        "deviation": np.asarray(library.performance.deviation).tolist(),
        "log_likelihoods": likelihoods,
    }  # fmt: skip
    for models in ("plug-in", "uncertain"):
        agent = BayesianPolicyReuse(library, models=models)
        beliefs = []
        for number, signal in enumerate(signals):
            agent.update(number % N_POLICIES, signal)
            beliefs.append(agent.belief.tolist())
        said[models] = {"beliefs": beliefs, "after": said_of_agent(agent), "rule": agent.rule.name}
    return said


def make_libraries(folder: Path) -> None:
    said = {}
    for name, (library, signals) in libraries().items():
        library.save(folder / f"{name}.npz")
        said[name] = said_of_library(PolicyLibrary.load(folder / f"{name}.npz"), signals)
    write(folder / "expected.json", said)


def sessions() -> dict[str, tuple[BayesianPolicyReuse, list[Any], bool]]:
    """Agents, the signals they learn from, and whether outcomes come beside the signals."""
    every = libraries()
    found: dict[str, tuple[BayesianPolicyReuse, list[Any], bool]] = {}
    left_out = ("gaussian-exact-deviations", "gaussian-counts", "gaussian-weights", "gaussian-gaps",
                "categorical-exact", "reward-gaussian", "transition-policies", "transition-exact")  # fmt: skip
    for name in [name for name in every if name not in left_out]:
        library, signals = every[name]
        found[name] = BayesianPolicyReuse(library, seed=5), signals, False
    learnt, signals = every["gaussian-learnt"]
    found["plug-in"] = BayesianPolicyReuse(learnt, models="plug-in", seed=5), signals, False
    found["novelty"] = BayesianPolicyReuse(learnt, novelty=0.05, seed=5), signals, False
    found["novelty-plug-in"] = BayesianPolicyReuse(learnt, models="plug-in", novelty=0.05, seed=5), signals, False
    found["static"] = BayesianPolicyReuse(learnt, dynamics=TypeDynamics.static(), seed=5), signals, False
    matrix = [[0.9, 0.1, 0.0], [0.05, 0.9, 0.05], [0.1, 0.2, 0.7]]
    for models in ("uncertain", "plug-in"):
        dynamics = TypeDynamics.transitions(matrix)
        agent = BayesianPolicyReuse(learnt, dynamics=dynamics, models=models, seed=5)
        found[f"transitions-{models}"] = agent, signals, False
        agent = BayesianPolicyReuse(
            learnt, dynamics=TypeDynamics.hazard(0.1, [0.2, 0.2, 0.6]), models=models, seed=5
        )
        found[f"hazard-{models}"] = agent, signals, False
    category, names = every["category-learnt"]
    found["category-and-outcome"] = BayesianPolicyReuse(category, seed=5), names, True
    found["category-novelty"] = BayesianPolicyReuse(category, novelty=0.1, seed=5), names, False
    for rule in RULES:
        # All signals are from the policy that tells types apart least: the belief stays open.
        found[f"rule-{rule}"] = BayesianPolicyReuse(learnt, rule_named(rule), horizon=30, seed=7), OPEN, False
    found["prior"] = (
        BayesianPolicyReuse(learnt, prior=[0.1, 0.1, 0.8], seed=np.random.default_rng(3)),
        signals,
        False,
    )
    return found


def make_sessions(folder: Path) -> None:
    said = {}
    for name, (agent, signals, outcomes) in sessions().items():
        policies = (
            [2] * len(signals) if signals is OPEN else [number % N_POLICIES for number in range(len(signals))]
        )
        save_session(taught(agent, signals, policies, outcomes), folder / f"{name}.npz")
        restored = load_session(folder / f"{name}.npz")
        row = said_of_agent(restored) | {"rule": restored.rule.name, "models": restored.models}
        row["next"] = [int(restored.select()) for _ in range(3)]
        restored.update(1, signals[0])
        row["then"] = said_of_agent(restored) | {"update": [1, signals[0]]}
        row["then"]["next"] = [int(restored.select()) for _ in range(3)]
        said[name] = row
    write(folder / "expected.json", said)


def make_users(folder: Path) -> None:
    """Files of many users: five users, ten updates, policies by turns."""
    every, said = libraries(), {}
    learnt = every["gaussian-learnt"][0]
    cases: dict[str, tuple[UserBeliefs, list[Any]]] = {
        "named-uncertain": (UserBeliefs(learnt, ["ann", "bo", "cy", "di", "ed"], "f8", unknown="add"), numbers()),
        "single-precision": (UserBeliefs(learnt, 5, "f4", models="plug-in", seed=3), numbers()),
        "exact": (UserBeliefs(every["gaussian-exact"][0], 5, "f8", dynamics=TypeDynamics.static()), numbers()),
        "categorical": (UserBeliefs(every["categorical-learnt"][0], 5, "f8"), every["categorical-learnt"][1]),
        "histogram": (UserBeliefs(every["histogram"][0], 5, "f8"), numbers()),
        "spread": (UserBeliefs(every["student-t"][0], 5, "f4", spread=0.25), numbers()),
    }  # fmt: skip
    for name, (users, signals) in cases.items():
        for number in range(10):
            users.update([number % 4], [(number // 2) % N_POLICIES], [signals[number]])
        save_users(users, folder / f"{name}.npz")
        restored = load_users(folder / f"{name}.npz")
        own = np.arange(5)
        said[name] = {
            "belief": restored.belief(own).tolist(),
            "probabilities": restored.probabilities(own).tolist(),
            "probabilities_sampling": restored.probabilities(own, "sampling").tolist(),
            "next": [restored.select(own).tolist() for _ in range(3)],
            "next_sampling": [restored.select(own, "sampling").tolist() for _ in range(3)],
            "then": {
                "update": [[4, 0], [1, 2], signals[:2]],
                "log_evidence": restored.update([4, 0], [1, 2], signals[:2]).tolist(),
                "belief": restored.belief(own).tolist(),
            },
        }
    write(folder / "expected.json", said)


# ---- a memory with studies ----------------------------------------------------------------------------------


def log_rows() -> dict[str, list[Any]]:
    """A log of twenty users, four decisions each."""
    random, rows = random_of(20), {"user": [], "policy": [], "outcome": [], "context": []}
    for user in range(20):
        for time in range(4):
            policy = (user + time) % N_POLICIES
            rows["user"].append(f"user{user:02d}")
            rows["policy"].append(POLICIES[policy])
            rows["outcome"].append(round(float(MEAN[user % N_TYPES, policy] + random.standard_normal()), 3))
            rows["context"].append(("shop", "web")[user % N_TYPES == 0])
    return rows


def make_memory(folder: Path) -> None:
    """Studies "learnt" (uncertain, control group) and "sampled" (plug-in); decisions open and ended."""
    path = folder / "memory.db"
    settings = {
        "learnt": FitSettings("learnt", "gaussian", N_TYPES, 0.3, seed=1),
        "sampled": FitSettings(
            "sampled", "student-t", N_TYPES, 0.0, rule="sampling", explore=0.1, models="plug-in"
        ),
    }
    said: dict[str, Any] = {}
    with open_memory(path) as memory:
        for name, fitted in settings.items():
            fit(log_rows(), memory, fitted)
            study = open_study(memory, name)
            open_decisions = {}
            for user, context in (("user03", None), ("ann", "shop"), ("bo", None)):
                for outcome in (8.5, 2.0, None, 4.25, None):
                    made = choose(memory, study, user, context=context, seed=4)
                    if outcome is not None:
                        update(memory, study, made["decision"], outcome)
                    else:
                        open_decisions.setdefault(user, []).append(made["decision"])
            said[name] = {"open": open_decisions}
        retire(memory, open_study(memory, "sampled"), "round")
    stored = path.read_bytes()
    with open_memory(path) as memory:
        for name in settings:
            study = open_study(memory, name)
            said[name] |= {
                "types": study.library.types, "mean": study.library.performance.mean.tolist(),
                "prior": study.library.prior.tolist(), "states": study.states,
                "report": report(memory, study),
                "answers": {
                    user: choose(memory, study, user, seed=9, novelty=True)
                    for user in ("user03", "ann", "bo", "stranger")
                },
            }  # fmt: skip
            said[name]["late"] = [
                update(memory, study, decision, 6.5) for own in said[name]["open"].values() for decision in own
            ]
            said[name]["after"] = {
                user: choose(memory, study, user, seed=10) for user in ("user03", "ann", "bo", "stranger")
            }
    for left in folder.glob("memory.db*"):
        left.unlink()
    path.write_bytes(stored)
    write(folder / "expected.json", said)


def write(path: Path, said: Any) -> None:
    path.write_text(json.dumps(rounded(said), separators=(",", ":")) + "\n")


def rounded(said: Any) -> Any:
    """Numbers to 13 digits: less is compared, and the files stay small."""
    if isinstance(said, dict):
        return {key: rounded(value) for key, value in said.items()}
    if isinstance(said, list | tuple):
        return [rounded(value) for value in said]
    return float(f"{said:.13g}") if isinstance(said, float) else said


def main() -> None:
    makers = {"libraries": make_libraries, "sessions": make_sessions, "users": make_users, "memory": make_memory}
    for part, make in makers.items():
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            make(folder)
            with zipfile.ZipFile(
                Path(sys.argv[1]) / f"{part}.zip", "w", zipfile.ZIP_DEFLATED, compresslevel=9
            ) as archive:
                for path in sorted(folder.iterdir()):
                    archive.writestr(zipfile.ZipInfo(path.name), path.read_bytes(), zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    main()
