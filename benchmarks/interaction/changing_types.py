"""`bench changing_types`: regret of policy reuse by its hazard, for users whose type changes once and for others.

Users of the surveillance world (68 types, 68 policies, noise of deviation 20) play 100 episodes by the rule
information-directed, with exact models and with models of ten runs a pair. Users of the first kind get another
type after 50 episodes. All hazards meet the same users and the same noise, so that differences are paired. A user
is stuck where the mean regret of the last ten episodes is above 5.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray

from benchmarks.interaction.reuse_case import NOISE
from benchmarks.rounds import at_most, estimated_row
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.type_dynamics import DEFAULT_HAZARD, TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import LEAST_SCORED, ReuseAlgorithm
from lifelore.interaction.selection import InformationDirected
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, STUCK, late_regret

Array = NDArray[np.float64]

HAZARDS = (0.0, 0.0005, DEFAULT_HAZARD, 0.01, 0.05)
EPISODES, CHANGE_AFTER = 100, 50
USERS = 50
"""Users of a round; every round has users, noise and learnt models of its own."""
RUNS = 10
"""Runs a pair of type and policy behind learnt models."""
CHANGING, STAYING = "type changes once", "type never changes"


def bench_changing_types(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`. Rows also have ``ci95`` and ``n``."""
    regrets: dict[tuple[str, str, float], list[Array]] = {}
    total = repeats * len(list(_cases()))
    for round_ in range(repeats):
        for done, case in enumerate(_cases()):
            regrets.setdefault(case, []).append(played(*case, round_))
            progress(round_ * total // repeats + done + 1, total, ", ".join(map(str, case)))
    found = {case: np.concatenate(parts) for case, parts in regrets.items()}
    rows = [line for case in _cases() for line in _rows(found, case)]
    by_name = {line["name"]: line for line in rows}
    stuck = by_name[_stuck_name((EXACT, CHANGING, DEFAULT_HAZARD))]
    goals = [at_most(stuck["name"], 0.05, stuck["value"])]
    for models in (EXACT, LEARNT):
        cost = by_name[_cost_name((models, STAYING, DEFAULT_HAZARD))]
        low = None if cost["ci95"] is None else cost["ci95"][0]
        goals.append(at_most(f"{cost['name']}, lower end of the interval", 0.0, low))
    return {"rows": rows, "goals": goals}


def _cases() -> Iterator[tuple[str, str, float]]:
    return product((EXACT, LEARNT), (CHANGING, STAYING), HAZARDS)


def played(models: str, kind: str, hazard: float, round_: int) -> Array:
    """Expected regret of every user of a round in every episode, (USERS, EPISODES)."""
    mean = Surveillance().mean
    library = library_of(mean, models, round_)
    types = types_of_users(kind, len(mean), round_)
    noise = stream(0, "bench", "changing types", "noise", round_).normal(0.0, NOISE, (USERS, EPISODES))
    generator = stream(0, "bench", "changing types", "ties", round_)
    reuse = ReuseAlgorithm(library, TypeDynamics.hazard(hazard, library.prior), least=LEAST_SCORED)
    log_belief, every, rule = np.tile(reuse.start(), (USERS, 1)), np.arange(USERS), InformationDirected()
    regret = np.empty((USERS, EPISODES))
    for episode in range(EPISODES):
        own = mean[types[:, episode]]
        chosen, _ = reuse.select(reuse.belief(log_belief), rule, generator)
        regret[:, episode] = own.max(axis=1) - own[every, chosen]
        reuse.update(log_belief, every, chosen, own[every, chosen] + noise[:, episode])
    return regret


def library_of(mean: Array, models: str, round_: int) -> PolicyLibrary:
    """The library of exact models, or that of models learnt from `RUNS` runs a pair."""
    if models == EXACT:
        return PolicyLibrary.from_means(mean, NOISE)
    runs = stream(0, "bench", "changing types", "runs", round_).normal(0.0, NOISE, (*mean.shape, RUNS))
    return PolicyLibrary.from_samples(mean[:, :, None] + runs)


def types_of_users(kind: str, n_types: int, round_: int) -> NDArray[np.int64]:
    """The type of each user in each episode, (USERS, EPISODES); who changes gets any of the other types."""
    generator = stream(0, "bench", "changing types", "users", round_)
    first = generator.integers(0, n_types, USERS)
    second = (first + generator.integers(1, n_types, USERS)) % n_types
    types = np.repeat(first[:, None], EPISODES, axis=1)
    if kind == CHANGING:
        types[:, CHANGE_AFTER:] = second[:, None]
    return types


def _rows(found: dict[tuple[str, str, float], Array], case: tuple[str, str, float]) -> Iterator[dict]:
    models, kind, hazard = case
    own, static = found[case], found[models, kind, 0.0]
    total, reference = own.sum(axis=1), static.sum(axis=1)
    name = f"regret of {EPISODES} episodes, {_words(case)}"
    ratio = None if not hazard else float(total.mean() / reference.mean())
    yield _estimated(name, total, "pay", _words((models, kind, 0.0)) if hazard else None, ratio)
    if hazard:
        yield _estimated(_cost_name(case), total - reference, "pay")
    yield _estimated(_stuck_name(case), (late_regret(own) > STUCK).astype(float), "share")


def _estimated(
    name: str, values: Array, unit: str, ratio_to: str | None = None, ratio: float | None = None
) -> dict:
    return estimated_row(name, mean_estimate(values), unit) | {"ratio_to": ratio_to, "ratio": ratio}


def _words(case: tuple[str, str, float]) -> str:
    models, kind, hazard = case
    return f"{models} models, {kind}, hazard {hazard:g}"


def _cost_name(case: tuple[str, str, float]) -> str:
    return f"regret more than static types, {_words(case)}"


def _stuck_name(case: tuple[str, str, float]) -> str:
    return f"stuck in the end, {_words(case)}"
