"""A million users of policy reuse, with exact models, and with uncertain beside plug-in models.

Every user has tried ten policies. A measurement takes a hundred thousand users in random order: it learns from the
outcome of a policy that each user has tried, and selects again, in one pass.
"""

import time
from collections.abc import Callable
from statistics import median

import numpy as np
from numpy.typing import NDArray

from benchmarks.reserve import NOISE, Reserve
from benchmarks.rounds import Part, at_least, at_most, interleaved, paired_ratio, row, row_beside
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.user_beliefs import UserBeliefs

Numbers = NDArray[np.int64]

USERS, AT_ONCE = 1_000_000, 100_000
TRIED = 10
"""Number of policies that each user has tried before anything is measured."""
MOST_TIMES, MOST_BYTES, LEAST_RATE = 3.0, 600, 1.0
"""Goals of learnt models: times the time of plug-in models, bytes a user, million decisions a second."""
LEAST_EXACT, MOST_EXACT_BYTES = {"sampling": 2.0, "greedy": 0.8}, 300
"""Goals of exact models: million decisions a second, bytes a user."""
PLUG_IN, UNCERTAIN = "plug-in models", "uncertain models"
CHANGING = "uncertain models of types that change"


def bench_users(repeats: int, after: Callable[[str], None]) -> Part:
    """Rows and goals on many users, with exact models and with models learnt from ten runs a pair."""
    (rows, goals), (more_rows, more_goals) = _exact(repeats, after), _learnt(repeats, after)
    return rows + more_rows, goals + more_goals


def _exact(repeats: int, after: Callable[[str], None]) -> Part:
    """Beliefs in single precision."""
    case = Reserve(8)
    users = UserBeliefs(case.library, USERS, "f4", dynamics=TypeDynamics.static(), models="plug-in")
    labels = {rule: f"{USERS} users, {rule}" for rule in LEAST_EXACT}
    rates = interleaved({labels[rule]: _serving(case, users, rule) for rule in labels}, repeats, after)
    first, second = labels.values()
    size = users.log_belief.nbytes / USERS
    rows = [row_beside(first, rates, "M/s"), row_beside(second, rates, "M/s", first)]
    goals = [at_least(f"{label}, M/s", LEAST_EXACT[rule], median(rates[label])) for rule, label in labels.items()]
    return (
        [*rows, row("memory a user", size, "bytes")],
        [*goals, at_most("memory a user, bytes", MOST_EXACT_BYTES, size)],
    )


def _learnt(repeats: int, after: Callable[[str], None]) -> Part:
    """Models learnt from samples, with and without the knowledge of how few these are."""
    case = Reserve(8)
    users = _users(case)
    for own in users.values():
        _try_policies(case, own)
    size = users[UNCERTAIN].nbytes / USERS
    labels = {
        _label(name, own, rule): (own, rule) for name, own in users.items() for rule in ("sampling", "greedy")
    }
    rates = interleaved({label: _serving(case, *served) for label, served in labels.items()}, repeats, after)
    rows = []
    for label, (own, rule) in labels.items():
        beside = None if own is users[PLUG_IN] else _label(PLUG_IN, users[PLUG_IN], rule)
        rows.append(row_beside(label, rates, "M/s", beside))
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
