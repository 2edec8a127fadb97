"""Rows of `bench reuse` on a million users with learnt models: uncertain beside plug-in models.

Every user has tried ten policies. A measurement takes a hundred thousand users in random order: it learns from the
outcome of the policy that each user was to run next, and selects again.
"""

import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.interaction.reuse_case import NOISE, Reserve
from benchmarks.rounds import at_least, at_most, interleaved, paired_ratio, row
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.user_beliefs import UserBeliefs

Numbers = NDArray[np.int64]

USERS, AT_ONCE = 1_000_000, 100_000
TRIED = 10
"""Number of policies that each user has tried before anything is measured."""
MOST_TIMES, MOST_BYTES, LEAST_RATE = 3.0, 600, 1.0
"""Goals: times the time of plug-in models, bytes a user, million decisions a second."""
PLUG_IN, UNCERTAIN = "plug-in models", "uncertain models"
CHANGING = "uncertain models of types that change"

Result = tuple[list[dict[str, Any]], list[dict[str, Any]]]


def bench_users(repeats: int, after: Callable[[str], None]) -> Result:
    """Rows and goals on many users, with models learnt from ten runs a pair."""
    case = Reserve(8)
    users = _users(case)
    for own in users.values():
        _try_policies(case, own)
    size = users[UNCERTAIN].nbytes / USERS
    contenders = {
        _label(name, own, rule): _serving(case, own, rule)
        for name, own in users.items()
        for rule in ("sampling", "greedy")
    }
    rates = interleaved(contenders, repeats, after)
    rows = []
    for label, found in rates.items():
        beside = _label(PLUG_IN, users[PLUG_IN], label.split(", ")[1])
        if label == beside:
            rows.append(row(label, median(found), "M/s"))
        else:
            rows.append(row(label, median(found), "M/s", beside, paired_ratio(found, rates[beside])))
    rows.append(row(f"memory a user, {UNCERTAIN}", size, "bytes"))
    uncertain, plug_in = (_label(name, users[name], "sampling") for name in (UNCERTAIN, PLUG_IN))
    times = paired_ratio(rates[plug_in], rates[uncertain])
    return rows, [
        at_least(f"{uncertain}, M/s", LEAST_RATE, median(rates[uncertain])),
        at_most(f"time of a decision, {UNCERTAIN} / {PLUG_IN}", MOST_TIMES, times),
        at_most(f"memory a user, {UNCERTAIN}, bytes", MOST_BYTES, size),
    ]


def _users(case: Reserve) -> dict[str, UserBeliefs]:
    library = case.learnt()
    static, changing = TypeDynamics.static(), TypeDynamics.hazard(0.002, library.prior)
    return {
        PLUG_IN: UserBeliefs(library, USERS, dynamics=static, models="plug-in"),
        UNCERTAIN: UserBeliefs(library, USERS, dynamics=static, models="uncertain"),
        CHANGING: UserBeliefs(library, AT_ONCE, dynamics=changing, models="uncertain"),
    }


def _label(name: str, users: UserBeliefs, rule: str) -> str:
    return f"{users.n_users} users, {rule}, {name}"


def _try_policies(case: Reserve, users: UserBeliefs) -> None:
    """Let every user try `TRIED` policies of its own, in the order of the users."""
    every, random = np.arange(users.n_users), stream(0, "bench", "reuse", "tried")
    first = random.integers(0, case.mean.shape[1], users.n_users)
    for number in range(TRIED):
        policies = _tried(first, number, case)
        users.update(every, policies, _outcomes(case, every, policies, random))


def _tried(first: Numbers, number: Numbers | int, case: Reserve) -> Numbers:
    """The policies that users try: distinct, for 7 and the number of policies have no common factor."""
    return (first + 7 * np.asarray(number)) % case.mean.shape[1]


def _outcomes(
    case: Reserve, users: Numbers, policies: Numbers, random: np.random.Generator
) -> NDArray[np.float64]:
    return case.mean[users % len(case.mean), policies] + NOISE * random.standard_normal(len(users))


def _serving(case: Reserve, users: UserBeliefs, rule: str) -> Callable[[], float]:
    """Million users a second who learn from an outcome of a policy that they tried before, and select."""
    first = stream(0, "bench", "reuse", "tried").integers(0, case.mean.shape[1], users.n_users)
    random = stream(0, "bench", "reuse", "served", rule)

    def timed() -> float:
        who = random.permutation(users.n_users)[:AT_ONCE]
        policies = _tried(first[who], random.integers(0, TRIED, len(who)), case)
        outcomes = _outcomes(case, who, policies, random)
        started = time.process_time()
        users.update_and_select(who, policies, outcomes, rule)
        return len(who) / (time.process_time() - started) / 1e6

    timed()  # compiled before anything is timed
    return timed
