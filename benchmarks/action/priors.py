"""`bench priors`: a million contexts, beside a dictionary of lists and a dense list of lists, each in plain loops.

Contexts are of two sorts: the states of a world in order, and codes scattered over 47 bits, as percepts and hashes
are. A dense list knows states only.
"""

import time
from collections.abc import Callable
from random import Random
from statistics import median

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_least, at_most, interleaved, paired_ratio, row
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

CONTEXTS, ACTIONS, ALPHA0 = 1_000_000, 4, 0.1
LEAST_RATIO, MOST_MS = 20.0, 100.0
STATES, SCATTERED = "states in order", "scattered codes"
OURS, DICT, DENSE = "ActionPrior", "dict of lists", "dense list of lists"
Rows = list[list[float]]


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
    rows, goals, done = [], [], 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, 10 * repeats, label)

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
            more_rows, more_goals = _beside(what, name, contenders, repeats, after)
            rows += more_rows
            goals += more_goals
    return {"rows": rows, "goals": goals}


def _beside(
    what: str, name: str, contenders: dict[str, Callable], repeats: int, after: Callable[[str], None]
) -> tuple[list[dict], list[dict]]:
    def label(who: str) -> str:
        return f"{what}, {name}: {who}"

    times = interleaved({label(who): _milliseconds(run) for who, run in contenders.items()}, repeats, after)
    ours = label(OURS)
    rows = [row(ours, median(times[ours]), "ms")]
    goals = []
    for who in contenders:
        if who != OURS:
            rows.append(
                row(
                    label(who), median(times[label(who)]), "ms", ours, paired_ratio(times[label(who)], times[ours])
                )
            )
            goals.append(at_least(f"{label(who)} / {OURS}", LEAST_RATIO, rows[-1]["ratio"]))
    if what == "sampling":
        goals.append(at_most(f"{what}, {name}, ms", MOST_MS, rows[0]["value"]))
    return rows, goals


def _milliseconds(run: Callable) -> Callable[[], float]:
    def timed() -> float:
        started = time.perf_counter()
        run()
        return 1e3 * (time.perf_counter() - started)

    return timed
