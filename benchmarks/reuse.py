"""A decision of policy reuse beside loops, MABWiser and BoTorch, at growing sizes; a million users.

One core, and its own time alone: contenders take from a microsecond to a second, and on a shared machine only
the long ones would wait for others. A decision is a rule's scores and the choice of the best of them under a
flat belief, unless a row says otherwise. The library's table of signals and what the rules compute from it are
stored between decisions. Exact models have many types of equal distributions, models learnt from samples none.
"""

import time
from collections.abc import Callable
from statistics import mean, median
from typing import Any

import numpy as np

from benchmarks.peers import reuse_loops as loops
from benchmarks.peers.bandits import ALPHAS, BOTORCH, MABWISER, UCB1, BoTorchUCB, Player, installed, mabwiser_ucb1
from benchmarks.reserve import HORIZON, LargeReserve, Reserve
from benchmarks.reuse_users import bench_users
from benchmarks.rounds import Part, Rates, at_least, at_most, interleaved, joined, paired_ratio, row, row_beside
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
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
TASKS = 4
"""Tasks of 50 episodes that each method plays in a round; BoTorch, refitted each episode, plays the first."""

LEAST = {
    "update": 20.0, "expected improvement": 1000.0, "belief entropy": 100.0, "information-directed": 100.0,
    "knowledge gradient": 50.0,
}  # fmt: skip
"""Least ratios to the loops."""
MOST_US_LEARNT = {"belief entropy": 40.0, "knowledge gradient": 450.0}
"""Most microseconds of a decision on learnt models of the size beside loops."""
MOST_MS = {
    "expected improvement, flat belief": 20.0, "belief entropy, flat belief": 15.0,
    "knowledge gradient, settled belief": 30.0, "knowledge gradient, flat belief": 200.0,
}  # fmt: skip
"""Most milliseconds of a decision at the largest size, with exact and with learnt models."""
MOST_UNCERTAIN = 3.0
"""Most time of an episode with uncertain models, in the time of an episode with plug-in models."""
OURS, LOOPS = "Lifelore", "loops"
EI, SAMPLING = "policy reuse, expected improvement", "policy reuse, sampling"
TUNED, GP_EACH, GP_TEN = f"{UCB1}, tuned", "BoTorch GP-UCB, refitted each", "BoTorch GP-UCB, refitted every 10"
LEAST_PEERS = {UCB1: 2.0, GP_TEN: 50.0}
"""Least time of a peer's episode, in the time of ours."""


def bench_reuse(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    import scipy.linalg.blas  # noqa: F401  kernels call it: a library that is loaded later keeps its threads
    from threadpoolctl import threadpool_limits

    works = (_beside_loops, _uncertain, _beside_peers, _growth, bench_users)
    parts = []
    with threadpool_limits(1):
        for number, work in enumerate(works):
            parts.append(work(repeats, lambda label, number=number: progress(number, len(works), label)))
            progress(number + 1, len(works), "done")
    return joined(*parts)


# ---- beside loops ------------------------------------------------------------------------------------------


def _beside_loops(repeats: int, after: Callable[[str], None]) -> Part:
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
    rows, goals = _learnt(case, size, repeats, after)
    for name, (ours, theirs) in works.items():
        labels = {who: f"{name}, {size}: {who}" for who in (OURS, LOOPS)}
        times = interleaved({labels[OURS]: _us(ours), labels[LOOPS]: _us(theirs)}, repeats, after)
        rows += [row_beside(labels[OURS], times, "us"), row_beside(labels[LOOPS], times, "us", labels[OURS])]
        goals.append(at_least(f"{name}, {size}: {LOOPS} / {OURS}", LEAST[name], rows[-1]["ratio"]))
    return rows, goals


def _learnt(case: Reserve, size: str, repeats: int, after: Callable[[str], None]) -> Part:
    """The same update and decisions with models learnt from samples, where no two types are alike."""
    library, random = case.learnt(), np.random.default_rng(0)
    library.table(SIGNALS)
    agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.static(), models="plug-in")
    works: dict[str, Callable] = {"update": lambda: agent.update(3, 55.0)}
    works |= {name: _decision(library, rule, case.flat, random) for name, rule in case.rules().items()}
    labels = {name: f"{name}, {size}, learnt models" for name in works}
    times = interleaved({labels[name]: _us(run) for name, run in works.items()}, repeats, after)
    rows = [row_beside(label, times, "us") for label in labels.values()]
    return rows, [
        at_most(f"{labels[name]}, us", most, median(times[labels[name]])) for name, most in MOST_US_LEARNT.items()
    ]


def _uncertain(repeats: int, after: Callable[[str], None]) -> Part:
    """Episodes of selecting and learning with learnt models that know how few samples they are from."""
    case = Reserve(SIGNALS)
    library = case.learnt()
    rows, goals = [], []
    for name, rule in {"expected improvement": ExpectedImprovement(), "sampling": BeliefSampling()}.items():
        plug_in, uncertain = (f"select and learn, {name}, {models} models" for models in ("plug-in", "uncertain"))
        contenders = {
            plug_in: _playing(case, plug_in, _reuse(library, rule), []),
            uncertain: _playing(case, uncertain, _reuse(library, rule, "uncertain"), []),
        }
        times = interleaved(contenders, repeats, after)
        rows += [row_beside(plug_in, times, "us"), row_beside(uncertain, times, "us", plug_in)]
        goals.append(at_most(f"{name}: uncertain / plug-in models", MOST_UNCERTAIN, rows[-1]["ratio"]))
    return rows, goals


def _reuse(library: Any, rule: SelectionRule, models: Any = "plug-in") -> Callable[[int], Player]:
    def make(number: int) -> Player:
        agent = BayesianPolicyReuse(library, rule, None, TypeDynamics.static(), HORIZON, number, models)
        return agent.select, agent.update

    return make


def _decision(library: Any, rule: SelectionRule, belief: Any, random: np.random.Generator) -> Callable[[], int]:
    def decide() -> int:
        return choose(rule.scores(library, belief, episodes_left=HORIZON, generator=random), random)

    return decide


# ---- beside other programs -----------------------------------------------------------------------------------


def _beside_peers(repeats: int, after: Callable[[str], None]) -> Part:
    """Whole episodes of selecting and learning, and the regret they cost, on the same tasks."""
    case = Reserve(SIGNALS)
    methods = _methods(case)
    regrets: dict[str, list[float]] = {name: [] for name in methods}
    contenders = {name: _playing(case, name, make, regrets[name]) for name, make in methods.items()}
    times = interleaved(contenders, repeats, after)
    rows, goals = [], []
    for name in (EI, SAMPLING, UCB1, TUNED, GP_TEN, GP_EACH):
        known, beside = name in methods, None if name == EI else f"select and learn: {EI}"
        value, regret = (median(times[name]), mean(regrets[name])) if known else (None, None)
        ratio = paired_ratio(times[name], times[EI]) if known and beside else None
        rows.append(row(f"select and learn: {name}", value, "us", beside, ratio))
        rows.append(row(f"regret over {HORIZON} episodes: {name}", regret, "return"))
        if name in LEAST_PEERS:
            goals.append(at_least(f"{name} / {EI}", LEAST_PEERS[name], ratio))
    for name in (GP_TEN, GP_EACH):
        goals.append(at_most(f"regret: {EI} / {name}", 1.0, _share(regrets, EI, name)))
    return rows, goals


def _methods(case: Reserve) -> dict[str, Callable[[int], Player]]:
    def gaussian(refit: int) -> Callable[[int], Player]:
        def make(number: int) -> Player:
            first = int(stream(number, "bench", "reuse", "first").integers(len(case.mean)))
            process = BoTorchUCB(case.world.targets / 25.0, first, refit)
            return process.select, process.update

        return make

    methods = {
        EI: _reuse(case.library, ExpectedImprovement(of="outcome")),
        SAMPLING: _reuse(case.library, BeliefSampling()),
    }
    if installed(MABWISER):
        average = case.mean.mean(axis=0)
        methods[UCB1] = lambda number: mabwiser_ucb1(average, ALPHAS["as it comes"])
        methods[TUNED] = lambda number: mabwiser_ucb1(average, ALPHAS["tuned"])
    if installed(BOTORCH):
        methods[GP_TEN], methods[GP_EACH] = gaussian(10), gaussian(1)
    return methods


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


def _share(regrets: dict[str, list[float]], top: str, bottom: str) -> float | None:
    """Ratio of mean regrets over the tasks that both played: the first of each round, where one played no more."""
    if bottom not in regrets:
        return None
    step = len(regrets[top]) // len(regrets[bottom])
    return mean(regrets[top][::step]) / mean(regrets[bottom])


# ---- growth --------------------------------------------------------------------------------------------------


def _growth(repeats: int, after: Callable[[str], None]) -> Part:
    """One update and one decision at each size, under a flat belief and under one that a few types hold."""
    rows, goals = [], []
    sizes = [(size, n, False) for size, n in SIZES] + [(*max(SIZES), True)]
    for size, n_signals, learnt in sizes:
        case = LargeReserve(size, n_signals, learnt)
        labels = {f"{what}, {case.label}": _us(run) for what, run in _works(case).items()}
        times = interleaved(labels, repeats, after)
        rows += [row_beside(label, times, "us") for label in labels]
        if (size, n_signals) == max(SIZES):
            goals += _size_goals(case.label, times)
    return rows, goals


def _works(case: LargeReserve) -> dict[str, Callable]:
    agent = BayesianPolicyReuse(case.library, dynamics=TypeDynamics.static())
    random, n = np.random.default_rng(0), case.n_signals
    works: dict[str, Callable] = {"update": lambda: agent.update(3, 55.0)}
    rules: dict[str, SelectionRule] = {
        "greedy": Greedy(),
        "expected improvement": ExpectedImprovement(of="outcome"),
        "belief entropy": BeliefEntropy(n_bins=n),
        "information-directed": InformationDirected(n_bins=n),
        "knowledge gradient": KnowledgeGradient(n_bins=n, candidates="responses"),
    }
    for name, rule in rules.items():
        works[f"{name}, flat belief"] = _decision(case.library, rule, case.flat, random)
        if name not in ("greedy", "expected improvement"):
            works[f"{name}, settled belief"] = _decision(case.library, rule, case.settled, random)
    return works


def _size_goals(label: str, times: Rates) -> list[dict[str, Any]]:
    return [
        at_most(f"{name}, {label}, ms", most, median(times[f"{name}, {label}"]) / 1e3)
        for name, most in MOST_MS.items()
    ]


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
