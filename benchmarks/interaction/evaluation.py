"""`bench evaluation`: do the 95 % intervals of off-policy estimates contain the truth? In simulated studies.

Each study has users of hidden types, policies and outcomes 0 or 1, all drawn anew. A log is made by choosing at
random, or by belief sampling with exploration, so its choices depend on earlier outcomes. Targets are each single
policy, a random mixture of policies, and belief sampling itself: its next decision after the logged outcomes, and
all of the first decisions. The truth of every target is computed exactly, from all histories.
"""

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from benchmarks.interaction.simulated_log import FIRST, N_POLICIES, SimulatedLog, Study
from benchmarks.rounds import at_least, at_most, row
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.interaction.evaluation.clustered_estimate import ClusteredEstimate
from lifelore.interaction.evaluation.estimators import (
    doubly_robust,
    inverse_propensity,
    self_normalised,
)
from lifelore.interaction.evaluation.importance_weights import (
    decision_numbers,
    importance_weights,
    trajectory_weights,
    weight_summary,
)
from lifelore.interaction.evaluation.outcome_models import policy_means, user_folds

Array = NDArray[np.float64]

STUDIES = 60
"""Simulated studies a round and log."""
ENOUGH_USERS = 20.0
"""Effective users from which the goals ask for coverage; `reuse evaluate` warns below."""
LOGS = {"random log": 1.0, "10 % random": 0.1, "3 % random": 0.03}
"""Share of decisions that are drawn from all policies; belief sampling makes the others."""
TARGETS = ("single policy", "mixture", "rule, next decision", f"rule, first {FIRST} decisions")


def bench_evaluation(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    found: dict[tuple[str, ...], list[tuple[float, float, float]]] = defaultdict(list)
    for number in range(repeats * STUDIES):
        for log, explore in LOGS.items():
            generator = stream(0, "bench evaluation", log, number)
            study = Study.drawn(generator)
            for key, entry in _study_entries(study, study.log(generator, explore), explore, generator):
                found[(log, *key)].append(entry)
        progress(number + 1, repeats * STUDIES, f"study {number + 1}")
    rows, goals = [], []
    for key, entries in found.items():
        error, covered, users = np.array(entries).T
        enough = users >= ENOUGH_USERS
        name = ", ".join(key)
        rows.append(row(f"coverage, {name}", float(covered.mean()), f"of {len(covered)} intervals"))
        if not enough.all():
            few = f"below {ENOUGH_USERS:g} effective users"
            rows.append(row(f"coverage, {name}, {few}", float(covered[~enough].mean()), f"of {(~enough).sum()}"))
        rows.append(row(f"bias, {name}", float(error.mean()), f"± {1.96 * _error(error):.4f}"))
        rows.append(row(f"root of mean squared error, {name}", float(np.sqrt((error**2).mean())), "outcome"))
        goals.append(at_least(f"coverage, {name}", 0.92, float(covered[enough].mean())))
        if key[-1] != "self-normalised":
            goals.append(
                at_most(f"bias in standard errors, {name}", 3.3, abs(float(error.mean())) / _error(error))
            )
    return {"rows": rows, "goals": goals}


def _error(values: Array) -> float:
    return float(values.std(ddof=1) / len(values) ** 0.5)


def _study_entries(study: Study, log: SimulatedLog, explore: float, generator: np.random.Generator):
    """For each target and estimator: error, whether the interval covers, effective users."""
    model = policy_means(log.outcomes, log.policies, N_POLICIES, user_folds(log.users, generator))
    mixture = generator.dirichlet(np.ones(N_POLICIES))
    single = np.eye(N_POLICIES)[generator.integers(N_POLICIES)]
    for name, probs in ((TARGETS[0], single), (TARGETS[1], mixture)):
        weights = importance_weights(probs[log.policies], log.probability)
        target = model.of_choices(np.broadcast_to(probs, (len(log.users), N_POLICIES)))
        logged_model = model.of_policies(log.policies)
        yield from _entries(name, float(study.prior @ study.chance @ probs), log, weights, logged_model, target)
    early = log.first(FIRST)
    model = policy_means(early.outcomes, early.policies, N_POLICIES, user_folds(early.users, generator))
    weights = importance_weights(early.rule[np.arange(len(early.users)), early.policies], early.probability)
    target, logged_model = model.of_choices(early.rule), model.of_policies(early.policies)
    yield from _entries(TARGETS[2], study.value_of_rule(explore), early, weights, logged_model, target)
    before, through = trajectory_weights(weights, early.users)
    steps = decision_numbers(early.users)
    yield from _entries(TARGETS[3], study.value_of_rule(0.0), early, through, logged_model, target, before, steps)


def _entries(
    name: str,
    truth: float,
    log: SimulatedLog,
    weights: Array,
    logged_model: Array,
    target: Array,
    before: Array | None = None,
    steps: NDArray[np.int64] | None = None,
):
    effective = weight_summary(weights, log.users).effective_users
    if not weights.any() or (steps is not None and not (np.bincount(steps, weights) > 0).all()):
        return
    for estimator, found in (
        ("ips", inverse_propensity(log.outcomes, weights, log.users)),
        ("self-normalised", self_normalised(log.outcomes, weights, log.users, steps)),
        ("doubly-robust", doubly_robust(log.outcomes, weights, logged_model, target, log.users, before)),
    ):
        yield (name, estimator), _entry(found, truth, effective)


def _entry(found: ClusteredEstimate, truth: float, effective: float) -> tuple[float, float, float]:
    covers = found.ci95 is not None and found.ci95[0] <= truth <= found.ci95[1]
    return found.value - truth, float(covers), effective
