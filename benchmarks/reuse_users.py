"""A million users of policy reuse, with exact models, and with uncertain beside plug-in models; the reserves.

Every user has tried ten policies. A measurement takes a hundred thousand users in random order: it learns from the
outcome of a policy that each user has tried, and selects again, in one pass.
"""

import time
from collections.abc import Callable
from statistics import median

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import Part, at_least, interleaved, row, row_beside
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.user_beliefs import UserBeliefs

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

NOISE, SAMPLES = 20.0, 10
"""Deviation of an outcome, and samples of each pair that models are learnt from."""
USERS, AT_ONCE = 1_000_000, 100_000
TRIED = 10
"""Number of policies that each user has tried before anything is measured."""
EXACT, PLUG_IN, UNCERTAIN, CHANGING = "exact", "plug-in", "uncertain", "changing uncertain"
LEAST_RATES = {EXACT: 1.0, PLUG_IN: 1.0, UNCERTAIN: 0.5}
"""Least million decisions of belief sampling a second."""


def reserve_means(size: int = 68) -> Array:
    """Mean outcomes of a surveillance reserve, (size, size): the thesis's at 68, else scattered as densely."""
    if size == 68:
        return Surveillance().mean
    places = stream(0, "bench", "reuse", "large", size).random((size, 2)) * 26 * np.sqrt(size / 68)
    apart = np.abs(places[:, None] - places).max(axis=-1)
    return 10 + np.where(apart <= 15, 200 - 30 * apart, 0.0)


def learnt_library(mean: Array, noise: float = NOISE) -> PolicyLibrary:
    """A library fitted to `SAMPLES` samples of every pair."""
    random = stream(0, "bench", "reuse", "samples", len(mean))
    return PolicyLibrary.from_samples(mean[..., None] + noise * random.standard_normal((*mean.shape, SAMPLES)))


def bench_users(repeats: int, after: Callable[[str], None]) -> Part:
    """Rows and goals on many users; beliefs in single precision."""
    mean = reserve_means()
    users = _users(mean)
    for own in users.values():
        _try_policies(mean, own)
    labels = {(name, rule): f"users, {rule}, {name} models" for name in users for rule in ("sampling", "greedy")}
    contenders = {label: _serving(mean, users[name], rule) for (name, rule), label in labels.items()}
    rates = interleaved(contenders, repeats, after)
    rows = []
    for (name, rule), label in labels.items():
        rows.append(row_beside(label, rates, "M/s", None if name == EXACT else labels[EXACT, rule]))
    rows += [
        row(f"memory a user, {name} models", users[name].algorithm.nbytes / users[name].n_users, "bytes")
        for name in users
    ]
    goals = [
        at_least(f"{labels[name, 'sampling']}, M/s", least, median(rates[labels[name, "sampling"]]))
        for name, least in LEAST_RATES.items()
    ]
    return rows, goals


def _users(mean: Array) -> dict[str, UserBeliefs]:
    exact, learnt = PolicyLibrary.from_means(mean, NOISE), learnt_library(mean)
    static, changing = TypeDynamics.static(), TypeDynamics.hazard(0.002, learnt.prior)
    return {
        EXACT: UserBeliefs(exact, USERS, dynamics=static),
        PLUG_IN: UserBeliefs(learnt, USERS, dynamics=static, models="plug-in"),
        UNCERTAIN: UserBeliefs(learnt, USERS, dynamics=static),
        CHANGING: UserBeliefs(learnt, AT_ONCE, dynamics=changing),
    }


def _try_policies(mean: Array, users: UserBeliefs) -> None:
    """Let every user try `TRIED` policies of its own, in the order of the users."""
    every, random = np.arange(users.n_users), stream(0, "bench", "reuse", "tried")
    first = random.integers(0, mean.shape[1], users.n_users)
    for number in range(TRIED):
        policies = _tried(first, number, mean)
        users.update(every, policies, _outcomes(mean, every, policies, random))


def _tried(first: Numbers, number: Numbers | int, mean: Array) -> Numbers:
    """The policies that users try: distinct, for 7 and the number of policies have no common factor."""
    return (first + 7 * np.asarray(number)) % mean.shape[1]


def _outcomes(mean: Array, users: Numbers, policies: Numbers, random: np.random.Generator) -> Array:
    return mean[users % len(mean), policies] + NOISE * random.standard_normal(len(users))


def _serving(mean: Array, users: UserBeliefs, rule: str) -> Callable[[], float]:
    """Million users a second who learn from an outcome of a policy that they tried before, and select."""
    first = stream(0, "bench", "reuse", "tried").integers(0, mean.shape[1], users.n_users)
    random = stream(0, "bench", "reuse", "served", rule)

    def timed() -> float:
        who = random.permutation(users.n_users)[:AT_ONCE]
        policies = _tried(first[who], random.integers(0, TRIED, len(who)), mean)
        outcomes = _outcomes(mean, who, policies, random)
        started = time.process_time()
        users.update_and_select(who, policies, outcomes, rule)
        return len(who) / (time.process_time() - started) / 1e6

    return timed
