"""Episodes of policy reuse beside MABWiser and Vowpal Wabbit, decisions by size, a million users, a fresh process.

One core, and its own time alone: contenders take from a microsecond to a second, and on a shared machine only
the long ones would wait for others. An episode is a selection and the update by its payoff. A decision is a
rule's scores and the choice of the best of them under a flat belief; the library's table of signals is stored
between decisions.
"""

import re
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.peers.bandits import PEERS, Player, installed
from benchmarks.process import measured_inside
from benchmarks.reuse_users import bench_users, learnt_library, reserve_means
from benchmarks.rounds import Part, at_least, at_most, counted, interleaved, joined, row, row_beside
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import (
    BeliefEntropy,
    ExpectedImprovement,
    InformationDirected,
    KnowledgeGradient,
    choose,
)

SIZE = 8
"""Types, and as many policies, of the tasks of a single user; means and noise have deviation 1."""
EPISODES, TASKS = 50, 4
"""Episodes of a task, and tasks of a measurement."""
SAMPLING = "sampling, exact models"
MOST_US = {"default rule, exact models": 60.0, SAMPLING: 20.0}
"""Most microseconds of an episode."""
SIGNALS, SIZES, JUDGED = 50, (30, 68, 100, 300), 68
"""Signals, types (and as many policies) of the rows on rules; goals are for the size that is judged."""
MOST_US_OF_RULES = {"belief entropy": 3 * 43.0, "knowledge gradient": 3 * 469.0}
"""Most microseconds of a decision: three times those of the compiled rules that NumPy has replaced."""
MOST_SECONDS = 0.25
"""Most seconds of README's example in a fresh process, beyond the import of NumPy."""
README = Path(__file__).parents[1] / "README.md"
_FRESH = """
import contextlib, io, json, sys, time
import numpy
started = time.process_time()
with contextlib.redirect_stdout(io.StringIO()):
    exec(sys.argv[1])
print(json.dumps([time.process_time() - started, sum(name in sys.modules for name in ("numba", "scipy"))]))
"""


def bench_reuse(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    from threadpoolctl import threadpool_limits

    players = 4 + sum(installed(package) for package, _ in PEERS.values())
    after = counted(progress, repeats * (players + 4 * len(SIZES) + 8 + 1))
    with threadpool_limits(1):
        return joined(*(work(repeats, after) for work in (_one_user, _rules, bench_users, _fresh_process)))


def _us(run: Callable[[], Any]) -> Callable[[], float]:
    """Microseconds of one call, over as many calls as take a few milliseconds; one goes before, untimed."""
    run()
    started = time.process_time()
    run()
    calls = max(1, int(4e-3 / max(time.process_time() - started, 1e-6)))

    def timed() -> float:
        run()
        started = time.process_time()
        for _ in range(calls):
            run()
        return 1e6 * (time.process_time() - started) / calls

    return timed


# ---- a single user, beside other programs --------------------------------------------------------------------


def _one_user(repeats: int, after: Callable[[str], None]) -> Part:
    """Episodes of one user after another, by us and by the peers."""
    mean = stream(0, "bench", "reuse", "means").standard_normal((SIZE, SIZE))
    libraries = {"exact": PolicyLibrary.from_means(mean, 1.0), "learnt": learnt_library(mean, 1.0)}
    ours: dict[str, Callable[[int], Player]] = {
        f"{word}, {kind} models": _player(library, rule)
        for kind, library in libraries.items()
        for word, rule in (("default rule", None), ("sampling", "sampling"))
    }
    peers = {
        name: lambda seed, make=make: make(mean.mean(axis=0), seed)
        for name, (package, make) in PEERS.items()
        if installed(package)
    }
    times = interleaved({name: _episodes(mean, make) for name, make in (ours | peers).items()}, repeats, after)
    rows = [row_beside(f"an episode, {name}", {f"an episode, {name}": times[name]}, "us") for name in ours]
    goals = [at_most(f"an episode, {name}, us", most, median(times[name])) for name, most in MOST_US.items()]
    for name in PEERS:
        value = median(times[name]) if name in peers else None
        ratio = median(np.divide(times[name], times[SAMPLING]).tolist()) if name in peers else None
        rows.append(row(f"an episode, {name}", value, "us", f"an episode, {SAMPLING}", ratio))
        goals.append(at_least(f"{name} / {SAMPLING}", 1.0, ratio))
    return rows, goals


def _player(library: PolicyLibrary, rule: str | None) -> Callable[[int], Player]:
    def make(seed: int) -> Player:
        agent = BayesianPolicyReuse(library, rule, seed=seed)
        return agent.select, agent.update

    return make


def _episodes(mean: Any, make: Callable[[int], Player]) -> Callable[[], float]:
    """Microseconds of an episode of `TASKS` tasks, the same for all players."""

    def timed() -> float:
        random, spent = stream(0, "bench", "reuse", "tasks"), 0.0
        for task in range(TASKS):
            payoffs = mean[random.integers(SIZE)] + random.standard_normal((EPISODES, SIZE))
            select, update = make(task)
            started = time.process_time()
            for paid in payoffs.tolist():
                policy = select()
                update(policy, paid[policy])
            spent += time.process_time() - started
        return 1e6 * spent / (TASKS * EPISODES)

    timed()  # imported before anything is timed
    return timed


# ---- rules by size -------------------------------------------------------------------------------------------


def _rules(repeats: int, after: Callable[[str], None]) -> Part:
    """A decision of each rule at each size, with models learnt from samples."""
    rules: dict[str, Any] = {
        "expected improvement": ExpectedImprovement(of="outcome"),
        "belief entropy": BeliefEntropy(n_bins=SIGNALS),
        "information-directed": InformationDirected(n_bins=SIGNALS),
        "knowledge gradient": KnowledgeGradient(n_bins=SIGNALS, candidates="responses"),
    }
    rows, goals = [], []
    for size in SIZES:
        library, random = learnt_library(reserve_means(size)), np.random.default_rng(0)
        labels = {name: f"{name}, {size} x {size} x {SIGNALS}" for name in rules}
        times = interleaved(
            {labels[name]: _us(_decision(library, rule, random)) for name, rule in rules.items()}, repeats, after
        )
        rows += [row_beside(label, times, "us") for label in labels.values()]
        if size == JUDGED:
            goals += [
                at_most(f"{labels[name]}, us", most, median(times[labels[name]]))
                for name, most in MOST_US_OF_RULES.items()
            ]
    return rows, goals


def _decision(library: Any, rule: Any, random: np.random.Generator) -> Callable[[], int]:
    def decide() -> int:
        return choose(rule.scores(library, library.prior, episodes_left=EPISODES, generator=random), random)

    return decide


# ---- a fresh process -----------------------------------------------------------------------------------------


def readme_example() -> str:
    """README's program of policy reuse."""
    programs = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    return next(program for program in programs if "BayesianPolicyReuse" in program)


def _fresh_process(repeats: int, after: Callable[[str], None]) -> Part:
    """README's example in processes of its own."""
    name, program = "README's example in a fresh process", readme_example()
    measured_inside(_FRESH, program)  # bytecode is written
    seconds, loaded = [], 0
    for _ in range(repeats):
        spent, loaded = measured_inside(_FRESH, program)
        seconds.append(spent)
        after(name)
    rows = [
        row(f"{name}, beyond NumPy", median(seconds), "s"),
        row(f"{name}, of Numba and SciPy", loaded, "imported"),
    ]
    return rows, [
        at_most(f"{name}, s", MOST_SECONDS, median(seconds)),
        at_most(f"{name}: imports of Numba and SciPy", 0, loaded),
    ]
