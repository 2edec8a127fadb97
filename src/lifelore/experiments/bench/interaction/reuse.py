"""`bench reuse`: policy reuse beside loops, MABWiser and BoTorch, at growing sizes and for a million users.

One core, and its own time alone: contenders take from a microsecond to a second, and on a shared machine only
the long ones would wait for others. A decision is a rule's scores and the choice of the best of them under a
flat belief, unless a row says otherwise. Kept from one decision to the next are the library's table of signals
and which types have equal laws in it: many where models are exact, none where they are learnt from samples.
"""

import time
from collections.abc import Callable
from statistics import mean, median
from typing import Any

import numpy as np

from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.experiments.bench.interaction import reuse_loops as loops
from lifelore.experiments.bench.interaction.reuse_case import HORIZON, NOISE, LargeReserve, Reserve
from lifelore.experiments.bench.interaction.reuse_peers import (
    BOTORCH,
    MABWISER,
    BoTorchUCB,
    Player,
    installed,
    mabwiser_ucb1,
)
from lifelore.experiments.bench.rounds import Rates, at_least, at_most, interleaved, paired_ratio, row
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import (
    BeliefEntropy,
    BeliefSampling,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    SelectionRule,
    choose,
)

SIGNALS = 50
SIZES = ((30, 50), (68, 50), (100, 50), (300, 50), (1000, 100))
"""Types (and as many policies) and signals of the rows on growth."""
DENSE_GRADIENT = 300
"""Size up to which the knowledge gradient is measured under a flat belief: beyond, it takes seconds."""
USERS, AT_ONCE = 1_000_000, 100_000
TASKS = 4
"""Tasks of 50 episodes that each method plays in a round; BoTorch, refitted each episode, plays the first."""
ALPHAS = {"as it comes": 1.0, "tuned": 30.0}
"""UCB1's factor: MABWiser's default, and the best of 0, 1, 3, 9, 30, 100 and 300 on forty other tasks."""

LEAST = {
    "update": 20.0, "expected improvement": 1000.0, "belief entropy": 100.0, "information-directed": 100.0,
    "knowledge gradient": 50.0,
}  # fmt: skip
"""Least ratios to the loops."""
MOST_MS = {"expected improvement": 20.0, "belief entropy": 15.0, "knowledge gradient": 30.0}
OURS, LOOPS = "Lifelore", "loops"
EI, SAMPLING = "policy reuse, expected improvement", "policy reuse, sampling"
UCB1, GP_EACH, GP_TEN = "MABWiser UCB1", "BoTorch GP-UCB, refitted each", "BoTorch GP-UCB, refitted every 10"

Result = tuple[list[dict[str, Any]], list[dict[str, Any]]]


def bench_reuse(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`."""
    from threadpoolctl import threadpool_limits

    rows: list[dict[str, Any]] = []
    goals: list[dict[str, Any]] = []
    parts = (_beside_loops, _beside_peers, _growth, _many_users)
    with threadpool_limits(1):
        for number, part in enumerate(parts):
            done = 0

            def after(label: str, number: int = number) -> None:
                nonlocal done
                done += 1
                progress(number, len(parts), f"{label}, {done}")

            more_rows, more_goals = part(repeats, after)
            rows += more_rows
            goals += more_goals
            progress(number + 1, len(parts), "done")
    return {"rows": rows, "goals": goals}


# ---- beside loops ------------------------------------------------------------------------------------------


def _beside_loops(repeats: int, after: Callable[[str], None]) -> Result:
    """One update and one decision of each rule, 68 x 68 x 50, and the same by loops."""
    case = Reserve(SIGNALS)
    case.check()
    agent = BayesianPolicyReuse(case.library, dynamics=TypeDynamics.static())
    random = np.random.default_rng(0)
    works: dict[str, tuple[Callable, Callable]] = {
        "update": (
            lambda: agent.update(3, 55.0),
            lambda: loops.updated(case.flat, case.mean, case.deviation, 3, 55.0),
        )
    }
    for name, rule in case.rules().items():
        works[name] = (
            _decision(case.library, rule, case.flat, random),
            lambda name=name: case.looped(name).argmax(),
        )
    size = f"{len(case.mean)} x {len(case.mean)} x {SIGNALS}"
    rows, goals = _learnt(case, size, repeats, after), []
    for name, (ours, theirs) in works.items():
        labels = {who: f"{name}, {size}: {who}" for who in (OURS, LOOPS)}
        times = interleaved({labels[OURS]: _us(ours), labels[LOOPS]: _us(theirs)}, repeats, after)
        ratio = paired_ratio(times[labels[LOOPS]], times[labels[OURS]])
        rows.append(row(labels[OURS], median(times[labels[OURS]]), "us"))
        rows.append(row(labels[LOOPS], median(times[labels[LOOPS]]), "us", labels[OURS], ratio))
        goals.append(at_least(f"{name}, {size}: {LOOPS} / {OURS}", LEAST[name], ratio))
    return rows, goals


def _learnt(case: Reserve, size: str, repeats: int, after: Callable[[str], None]) -> list[dict[str, Any]]:
    """The same decisions with models learnt from samples, where no two types are alike to any policy."""
    library, random = case.learnt(), np.random.default_rng(0)
    library.table(SIGNALS)
    works = {name: _decision(library, rule, case.flat, random) for name, rule in case.rules().items()}
    labels = {f"{name}, {size}, learnt models": _us(run) for name, run in works.items()}
    times = interleaved(labels, repeats, after)
    return [row(label, median(times[label]), "us") for label in labels]


def _decision(library: Any, rule: SelectionRule, belief: Any, random: np.random.Generator) -> Callable[[], int]:
    def decide() -> int:
        return choose(rule.scores(library, belief, episodes_left=HORIZON, generator=random), random)

    return decide


# ---- beside other programs -----------------------------------------------------------------------------------


def _beside_peers(repeats: int, after: Callable[[str], None]) -> Result:
    """Whole episodes of selecting and learning, and the regret they cost, on the same tasks."""
    case = Reserve(SIGNALS)
    methods = _methods(case)
    regrets: dict[str, list[float]] = {name: [] for name in methods}
    contenders = {name: _playing(case, name, make, regrets[name]) for name, make in methods.items()}
    times = interleaved(contenders, repeats, after)
    rows, goals = [], []
    for name in (*methods, *_absent()):
        known = name in methods
        value = median(times[name]) if known else None
        ratio = paired_ratio(times[name], times[EI]) if known and name != EI else None
        rows.append(row(f"select and learn: {name}", value, "us", None if name == EI else _of(EI), ratio))
        rows.append(
            row(f"regret over {HORIZON} episodes: {name}", mean(regrets[name]) if known else None, "return")
        )
    goals.append(at_least(f"{UCB1} / {EI}", 2.0, _slower(times, UCB1, EI)))
    goals.append(at_least(f"{GP_TEN} / {EI}", 50.0, _slower(times, GP_TEN, EI)))
    goals.append(at_most(f"regret: {EI} / {GP_TEN}", 1.0, _share(regrets, EI, GP_TEN)))
    goals.append(at_most(f"regret: {EI} / {GP_EACH}", 1.0, _share(regrets, EI, GP_EACH)))
    return rows, goals


def _methods(case: Reserve) -> dict[str, Callable[[int], Player]]:
    def reuse(rule: SelectionRule) -> Callable[[int], Player]:
        def make(number: int) -> Player:
            agent = BayesianPolicyReuse(case.library, rule, None, TypeDynamics.static(), HORIZON, number)
            return agent.select, agent.update

        return make

    def gaussian(refit: int) -> Callable[[int], Player]:
        def make(number: int) -> Player:
            first = int(stream(number, "bench", "reuse", "first").integers(len(case.mean)))
            process = BoTorchUCB(case.world.targets / 25.0, first, refit)
            return process.select, process.update

        return make

    methods = {EI: reuse(ExpectedImprovement()), SAMPLING: reuse(BeliefSampling())}
    if installed(MABWISER):
        average = case.mean.mean(axis=0)
        methods[UCB1] = lambda number: mabwiser_ucb1(average, ALPHAS["as it comes"])
        methods[f"{UCB1}, tuned"] = lambda number: mabwiser_ucb1(average, ALPHAS["tuned"])
    if installed(BOTORCH):
        methods[GP_TEN], methods[GP_EACH] = gaussian(10), gaussian(1)
    return methods


def _absent() -> list[str]:
    left_out = [] if installed(MABWISER) else [UCB1]
    return left_out + ([] if installed(BOTORCH) else [GP_TEN, GP_EACH])


def _playing(case: Reserve, name: str, make: Callable[[int], Player], regrets: list[float]) -> Callable[[], float]:
    """Microseconds an episode over the next tasks; their regrets are kept."""
    tasks, next_task = 1 if name == GP_EACH else TASKS, 0
    select, update = make(0)
    for _ in range(3):  # imported and compiled before anything is timed
        update(select(), 0.0)

    def timed() -> float:
        nonlocal next_task
        spent = 0.0
        for k in range(tasks):
            type_, returns = case.task(next_task * TASKS + k)
            started = time.process_time()
            select, update = make(next_task * TASKS + k)
            chosen = []
            for t in range(HORIZON):
                policy = select()
                update(policy, float(returns[t, policy]))
                chosen.append(policy)
            spent += time.process_time() - started
            regrets.append(float((case.mean[type_].max() - case.mean[type_, chosen]).sum()))
        next_task += 1
        return 1e6 * spent / (tasks * HORIZON)

    return timed


def _slower(times: Rates, top: str, bottom: str) -> float | None:
    return paired_ratio(times[top], times[bottom]) if top in times else None


def _share(regrets: dict[str, list[float]], top: str, bottom: str) -> float | None:
    """Ratio of mean regrets over the tasks that both played: the first of each round, where one played no more."""
    if bottom not in regrets:
        return None
    step = len(regrets[top]) // len(regrets[bottom])
    return mean(regrets[top][::step]) / mean(regrets[bottom])


def _of(name: str) -> str:
    return f"select and learn: {name}"


# ---- growth --------------------------------------------------------------------------------------------------


def _growth(repeats: int, after: Callable[[str], None]) -> Result:
    """One update and one decision at each size, under a flat belief and under one that a few types hold."""
    rows, goals = [], []
    sizes = [(size, n, False) for size, n in SIZES] + [(*max(SIZES), True)]
    for size, n_signals, learnt in sizes:
        case = LargeReserve(size, n_signals, learnt)
        labels = {f"{what}, {case.label}": _us(run) for what, run in _works(case).items()}
        times = interleaved(labels, repeats, after)
        rows += [row(label, median(times[label]), "us") for label in labels]
        if (size, n_signals) == max(SIZES) and not learnt:
            goals += _size_goals(case.label, times)
    return rows, goals


def _works(case: LargeReserve) -> dict[str, Callable]:
    agent = BayesianPolicyReuse(case.library, dynamics=TypeDynamics.static())
    random, n = np.random.default_rng(0), case.n_signals
    works: dict[str, Callable] = {"update": lambda: agent.update(3, 55.0)}
    rules: dict[str, SelectionRule] = {
        "greedy": Greedy(),
        "expected improvement": ExpectedImprovement(),
        "belief entropy": BeliefEntropy(n_bins=n),
        "information-directed": InformationDirected(n_bins=n),
        "knowledge gradient": KnowledgeGradient(n_bins=n),
    }
    for name, rule in rules.items():
        if case.size <= DENSE_GRADIENT or name != "knowledge gradient":
            works[f"{name}, flat belief"] = _decision(case.library, rule, case.flat, random)
        if name not in ("greedy", "expected improvement"):
            works[f"{name}, settled belief"] = _decision(case.library, rule, case.settled, random)
    return works


def _size_goals(label: str, times: Rates) -> list[dict[str, Any]]:
    belief = {name: "settled" if name == "knowledge gradient" else "flat" for name in MOST_MS}
    names = {name: f"{name}, {belief[name]} belief, {label}" for name in MOST_MS}
    return [at_most(f"{names[name]}, ms", MOST_MS[name], median(times[names[name]]) / 1e3) for name in MOST_MS]


# ---- a million users -----------------------------------------------------------------------------------------


def _many_users(repeats: int, after: Callable[[str], None]) -> Result:
    """Users in random order: learn from the last outcome and select the next policy, in one pass."""
    case = Reserve(SIGNALS)
    users = UserBeliefs(case.library, USERS, "f4", dynamics=TypeDynamics.static())
    random = stream(0, "bench", "reuse", "users")
    contenders = {name: _serving(case, users, name, random) for name in ("sampling", "greedy")}
    if installed(MABWISER):
        contenders[UCB1] = _serving_bandit(case, random)
    rates = interleaved(contenders, repeats, after)
    first = f"{USERS} users, sampling"
    rows = [row(first, median(rates["sampling"]), "M/s")]
    ratio = paired_ratio(rates["greedy"], rates["sampling"])
    rows.append(row(f"{USERS} users, greedy", median(rates["greedy"]), "M/s", first, ratio))
    beside = None
    if UCB1 in rates:
        beside = paired_ratio(rates["sampling"], rates[UCB1])
        rows.append(row(f"one user, {UCB1}", median(rates[UCB1]), "M/s", first, 1 / beside))
    else:
        rows.append(row(f"one user, {UCB1}", None, "M/s", first))
    size = users.log_belief.nbytes / USERS
    rows.append(row("memory a user", size, "bytes"))
    return rows, [
        at_least(f"{USERS} users, sampling, M/s", 2.0, rows[0]["value"]),
        at_least(f"{USERS} users, greedy, M/s", 0.8, rows[1]["value"]),
        at_least(f"sampling / {UCB1}", 200.0, beside),
        at_most("memory a user, bytes", 300, size),
    ]


def _serving(case: Reserve, users: UserBeliefs, rule: str, random: np.random.Generator) -> Callable[[], float]:
    def timed() -> float:
        n = min(AT_ONCE, USERS)
        who = random.permutation(USERS)[:n]
        policies = random.integers(0, case.mean.shape[1], n)
        returns = case.mean[who % len(case.mean), policies] + NOISE * random.standard_normal(n)
        started = time.process_time()
        users.update_and_select(who, policies, returns, rule)
        return n / (time.process_time() - started) / 1e6

    timed()  # compiled before anything is timed
    return timed


def _serving_bandit(case: Reserve, random: np.random.Generator) -> Callable[[], float]:
    select, update = mabwiser_ucb1(case.mean.mean(axis=0), ALPHAS["as it comes"])

    def timed() -> float:
        outcomes = random.normal(100, NOISE, 200).tolist()
        started = time.process_time()
        for outcome in outcomes:
            update(select(), outcome)
        return len(outcomes) / (time.process_time() - started) / 1e6

    return timed


def _us(run: Callable) -> Callable[[], float]:
    """Microseconds of one call, over as many calls as take a few milliseconds; one goes before, untimed."""
    run()  # compiled before the calls are counted
    run()
    started = time.process_time()
    run()
    calls = max(1, int(4e-3 / (time.process_time() - started)))

    def timed() -> float:
        if calls > 1:
            run()
        started = time.process_time()
        for _ in range(calls):
            run()
        return 1e6 * (time.process_time() - started) / calls

    return timed
