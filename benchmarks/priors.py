"""A prior of a million contexts, beside a dictionary of lists and a dense list of lists; a factory's tables.

Contexts are of two sorts: the states of a world in order, and codes scattered over 47 bits, as percepts and hashes
are. A dense list knows states only. The factory task has four components. Its tables are enumerated by a compiled
function, beside plain Python. Its exact solution goes by the order of configurations, beside sweeps over all
states at once (value iteration).
"""

import time
from collections.abc import Callable
from random import Random

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import Part, at_least, at_most, counted, interleaved, joined, row_beside
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError, LifeloreError
from lifelore.core.mdp import _enumerate_with
from lifelore.core.planning.planning import optimal_q
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.factory.layout import factory

CONTEXTS, ACTIONS, ALPHA0 = 1_000_000, 4, 0.1
LEAST_RATIO, MOST_MS = 20.0, 100.0
STATES, SCATTERED = "states in order", "scattered codes"
OURS, DICT, DENSE = "ActionPrior", "dict of lists", "dense list of lists"
Rows = list[list[float]]
COMPONENTS = 4
TABLES, SOLVE = "tables of four components, compiled", "exact solution, by configurations"
PLAIN, SWEEPS = "tables of four components, plain Python", "exact solution, sweeps over all states"
FACTORY_GOALS = {TABLES: 20.0, SOLVE: 50.0}
"""Most milliseconds."""


class Case:
    """Contexts, a policy's best actions, and the same as lists; priors that have counted the policy once."""

    def __init__(self, name: str, n: int) -> None:
        random = stream(0, "bench", "priors", name)
        self.name, self.n = name, n
        self.codes: NDArray[np.int64] = np.arange(n) if name == STATES else random.integers(0, 2**47, n)
        self.best = random.random((n, ACTIONS)) < 0.4
        self.best[np.arange(n), random.integers(0, ACTIONS, n)] = True
        self.code_list, self.best_list = self.codes.tolist(), self.best.tolist()
        self.prior = ActionPrior(ACTIONS, ALPHA0)
        self.prior.update(self.codes, self.best)
        self.prior.sample(self.codes, random)  # compiled and warm before anything is timed

    # ---- update, from nothing and again ----------------------------------------------------------------

    def update(self) -> ActionPrior:
        prior = ActionPrior(ACTIONS, ALPHA0)
        prior.update(self.codes, self.best)
        return prior

    def update_dict(self) -> dict[int, list[float]]:
        counts: dict[int, list[float]] = {}
        for code, best in zip(self.code_list, self.best_list, strict=True):
            own = counts.get(code)
            if own is None:
                own = counts[code] = [0.0] * ACTIONS
            for action in range(ACTIONS):
                if best[action]:
                    own[action] += 1.0
        return counts

    def update_dense(self) -> Rows:
        counts = [[0.0] * ACTIONS for _ in range(self.n)]
        for own, best in zip(counts, self.best_list, strict=True):
            for action in range(ACTIONS):
                if best[action]:
                    own[action] += 1.0
        return counts

    # ---- sampling by the proportion ---------------------------------------------------------------------

    def sample(self) -> NDArray[np.int64]:
        return self.prior.sample(self.codes, self._numbers)

    def sample_dict(self) -> list[int]:
        get, nothing = self._dict.get, [0.0] * ACTIONS
        return [_drawn(get(code, nothing), self._random) for code in self.code_list]

    def sample_dense(self) -> list[int]:
        return [_drawn(own, self._random) for own in self._dense]

    def prepare(self) -> None:
        """Make what sampling reads; and refuse a comparison of unlike work."""
        self._numbers, self._random = stream(0, "bench", "priors", "draws"), Random(0).random
        self._dict = self.update_dict()
        known = [self._dict[code] for code in self.code_list[:1000]]
        if self.prior.counts(self.codes[:1000]).tolist() != known:
            raise InputError("the dictionary must hold the prior's counts, got others: the ratio means nothing")
        self._dense = self.update_dense() if self.name == STATES else []


def _drawn(counts: list[float], random: Callable[[], float]) -> int:
    left = random() * (sum(counts) + ACTIONS * ALPHA0)
    for action in range(ACTIONS - 1):
        left -= counts[action] + ALPHA0
        if left < 0:
            return action
    return ACTIONS - 1


def bench_priors(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    after, parts = counted(progress, 14 * repeats), []
    for name in (STATES, SCATTERED):
        case = Case(name, CONTEXTS)
        case.prepare()
        work = {
            "update": {OURS: case.update, DICT: case.update_dict, DENSE: case.update_dense},
            "sampling": {OURS: case.sample, DICT: case.sample_dict, DENSE: case.sample_dense},
        }
        for what, contenders in work.items():
            if name == SCATTERED:
                contenders.pop(DENSE)
            parts.append(_beside(what, name, contenders, repeats, after))
    return joined(*parts, _factory(repeats, after))


def _beside(
    what: str, name: str, contenders: dict[str, Callable], repeats: int, after: Callable[[str], None]
) -> Part:
    labels = {who: f"{what}, {name}: {who}" for who in contenders}
    times = interleaved({labels[who]: _milliseconds(run) for who, run in contenders.items()}, repeats, after)
    rows, goals = [row_beside(labels[OURS], times, "ms")], []
    for who in contenders:
        if who != OURS:
            rows.append(row_beside(labels[who], times, "ms", labels[OURS]))
            goals.append(at_least(f"{labels[who]} / {OURS}", LEAST_RATIO, rows[-1]["ratio"]))
    if what == "sampling":
        goals.append(at_most(f"{what}, {name}, ms", MOST_MS, rows[0]["value"]))
    return rows, goals


def _factory(repeats: int, after: Callable[[str], None]) -> Part:
    """Tables and exact values of a factory task, each beside the slow way to the same."""
    task = factory().task(range(COMPONENTS))
    tables = task.tables()
    # Both ways agree, and kernels are warm from here on.
    if not np.allclose(task.optimal_q(tables), optimal_q(tables, task.domain.discount), atol=1e-6):
        raise LifeloreError("both ways must find the same values, got others by configurations than by sweeps")
    contenders = {
        TABLES: task.tables,
        SOLVE: lambda: task.optimal_q(tables),
        PLAIN: lambda: _enumerate_with(task.domain)(task.params, [0.5]),
        SWEEPS: lambda: optimal_q(tables, task.domain.discount),
    }
    times = interleaved({name: _milliseconds(run) for name, run in contenders.items()}, repeats, after)
    rows = [row_beside(name, times, "ms") for name in (TABLES, SOLVE)]
    rows += [row_beside(PLAIN, times, "ms", TABLES), row_beside(SWEEPS, times, "ms", SOLVE)]
    return rows, [
        at_most(f"{name}, ms", most, row_beside(name, times, "ms")["value"])
        for name, most in FACTORY_GOALS.items()
    ]


def _milliseconds(run: Callable) -> Callable[[], float]:
    def timed() -> float:
        started = time.perf_counter()
        run()
        return 1e3 * (time.perf_counter() - started)

    return timed
