"""C5.5: what entropy and belief say about what to learn next, in lives of factory orders with hidden customers.

In spare time after a life, contexts to practise are chosen by the entropy of the prior over types, or as often as
they came. In other lives a type arrives late: does a belief that is spread over the known types tell its first
task from those of known types, does the detector of unexplained effects, and is the type added? The area under the
curve (AUC) is the probability that a sign is stronger in the late type's task than in one of a known type.
Thesis: §3.3.2, §5.2.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.curiosity import context_to_practise
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import live_task
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.agent.long_lived.task_log import TaskLog
from lifelore.core.intervals import percentile_interval
from lifelore.core.metrics import Estimate, entropy, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.task_stream import TaskStream
from reproduction.engine.estimates import UNMEASURED, exact_share
from reproduction.engine.records import having

UNIFORM, CURIOUS = CHOOSERS = ("uniform", "curious")
"""How the context of a spare order is chosen."""
SPARE_NUMBER, TEST_NUMBER = 10_000, 20_000
"""Numbers of the first spare and of the first test order: their layouts are those of no order of the life."""
FULL = AGENTS["full"]
MET = 2
"""Tasks of a type after which it counts as known."""
GAIN = 0.8
"""Share of what uniform replay gains, at which orders are compared."""
RESAMPLES = 1000
"""Resamples of an interval; more costs time, not accuracy."""
SIGNS = ("spread at the end", "mean spread", "alarm")
"""Signs of a new type in a task: entropy of the belief in the known types after the task, its mean over the task's
decisions, and the largest score of the detector."""


def cells(settings: Mapping) -> list[dict]:
    """Every life with spare time, lived with both choosers; every life with a late type."""
    spare = [{"part": "spare time", "life": life} for life in range(settings["lives"])]
    return spare + [{"part": "late type", "life": life} for life in range(settings["late_lives"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean points missed after each span of spare orders by chooser; or the signs of tasks in a life."""
    if cell["part"] == "late type":
        return {**cell, **late_type(1000 * seed + cell["life"], settings["arrival"], settings["late_episodes"])}
    family = FactoryFamily(TaskStream(tuple(CUSTOMERS), 1000 * seed + cell["life"], settings["contexts"]), seed)
    best = [family.best_return(number) for number in _tests(settings)]
    return {**cell, **{name: _spare_time(settings, family, best, name, cell["life"], seed) for name in CHOOSERS}}


def _spare_time(
    settings: Mapping, family: FactoryFamily, best: Sequence[float], chooser: str, life: int, seed: int
) -> list[float]:
    knowledge, n_episodes = Knowledge.empty(family), settings["episodes"]
    for number in range(settings["lived"]):
        _lived(knowledge, number, f"lived.{number}", n_episodes, seed)
    random = stream(seed, "C5.5", "spare time", life)
    missed = [_missed(settings, knowledge, best)]
    for number in range(SPARE_NUMBER, SPARE_NUMBER + settings["spans"] * settings["span"]):
        if chooser == CURIOUS:
            context = context_to_practise(knowledge, random)
        else:
            context = family.stream.draw(int(random.integers(settings["lived"]))).context
        # The date goes on from task to task: spare orders are the latest.
        _lived(knowledge, number, f"spare.{number}", n_episodes, seed, context)
        if (number + 1 - SPARE_NUMBER) % settings["span"] == 0:
            missed.append(_missed(settings, knowledge, best))
    return missed


def _lived(
    knowledge: Knowledge, number: int, name: str, n_episodes: int, seed: int, context: int | None = None
) -> TaskLog:
    """A task that was lived and learnt from."""
    met = knowledge.family.meet(number, FULL, context)
    lived, news = live_task(knowledge, *met, FULL, name, n_episodes=n_episodes, seed=seed)
    knowledge.learn(news)
    return lived


def _tests(settings: Mapping) -> range:
    """The numbers of the test orders."""
    return range(TEST_NUMBER, TEST_NUMBER + settings["tests"])


def _missed(settings: Mapping, knowledge: Knowledge, best: Sequence[float]) -> float:
    """Mean points that the first episodes of new orders miss of their `best`; nothing is learnt from them."""
    missed = []
    for number, most in zip(_tests(settings), best, strict=True):
        lived, _ = live_task(knowledge, *knowledge.family.meet(number, FULL), FULL, "test", n_episodes=1)
        missed.append(most - lived.returns[0])
    return round(float(np.mean(missed)), 4)


def late_type(life: int, arrival: int, episodes: int) -> dict:
    """A life up to the first task of a type that arrives late: ``{"known", "late", "learnt"}``.

    *known* has the `SIGNS` of each task of a type that was met in `MET` tasks or more, *late* those of the late
    type's first task; *learnt*: it became a type of its own there. The number of the life draws the late type.
    """
    types = tuple(CUSTOMERS)
    late = types[life % len(types)]
    family = FactoryFamily(TaskStream(types, life, len(types), arrivals={late: arrival}), life)
    knowledge = Knowledge.empty(family)
    met, known = Counter[str](), []
    for number in range(arrival):
        lived = _lived(knowledge, number, f"agent.{number}", episodes, life)
        if met[lived.drawn.hidden_type] >= MET:
            known.append(signs(lived))
        met[lived.drawn.hidden_type] += 1
    last = _lived(knowledge, arrival, "late", episodes, life)
    return {"known": known, "late": signs(last), "learnt": last.learnt == "late"}


def signs(lived: TaskLog) -> list[float]:
    """The `SIGNS` of a task; a belief's last entry, an unknown type, is left out."""
    beliefs = np.array([decision.belief[:-1] for decisions in lived.decisions for decision in decisions])
    sums = beliefs.sum(axis=1, keepdims=True)
    spread = entropy(np.divide(beliefs, sums, out=np.full_like(beliefs, 1 / beliefs.shape[1]), where=sums > 0))
    return [round(float(x), 5) for x in (spread[-1], spread.mean(), lived.alarm_score)]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Ratio of orders needed; AUC of the belief's spread and of the alarm; late types learnt."""
    missed = curves(results)
    start, end = missed[UNIFORM][:, 0], missed[UNIFORM][:, -1]
    goals = start - GAIN * np.maximum(start - end, 0.0)
    needed = [
        [orders_needed(settings["span"], own, goal) for own, goal in zip(missed[name], goals, strict=True)]
        for name in (CURIOUS, UNIFORM)
    ]
    late = having(results, part="late type")
    return {
        "curious_over_uniform_orders": ratio_estimate(*needed),
        "spread_auc": auc_over_lives(late, SIGNS[0]),
        "alarm_auc": auc_over_lives(late, SIGNS[2]),
        "late_type_learnt": exact_share(life["learnt"] for life in late),
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The belief's spread at the end of the task, and its mean over the task."""
    late = having(results, part="late type")
    for sign in SIGNS[:2]:
        yield {"belief": sign}, {"spread_auc": auc_over_lives(late, sign)}


def curves(results: Sequence[Mapping]) -> dict[str, NDArray[np.float64]]:
    """Points missed after each span of spare orders, (n_lives, n_spans + 1), by chooser."""
    return {name: np.array([one[name] for one in results if name in one]) for name in CHOOSERS}


def orders_needed(span: int, missed: NDArray[np.float64], goal: float) -> float:
    """Spare orders until no more than `goal` is missed, between spans by a straight line; all, if never."""
    reached = np.flatnonzero(missed <= goal)
    if not len(reached):
        return float(span * (len(missed) - 1))
    last = int(reached[0])
    if last == 0:
        return 0.0
    above, below = missed[last - 1], missed[last]
    return float(span * (last - 1 + (above - goal) / (above - below)))


def auc_over_lives(lives: Sequence[Mapping], sign: str) -> Estimate:
    """The area under the curve of all lives' signs; its interval resamples lives (percentiles)."""
    at = SIGNS.index(sign)
    pairs = [(np.array([task[at] for task in life["known"]]), life["late"][at]) for life in lives]
    known, late = [known for known, _ in pairs], np.array([late for _, late in pairs])
    if not sum(map(len, known)):
        return UNMEASURED
    # Wins of each late task over the known tasks of each life; ties count half.
    wins = np.array([[(np.sign(one - other) / 2 + 0.5).sum() for other in known] for one in late])
    n = np.array([len(other) for other in known])
    draws = stream(len(lives), "lives resampled").integers(len(lives), size=(RESAMPLES, len(lives)))
    draws = draws[n[draws].sum(axis=1) > 0]
    found = [wins[np.ix_(draw, draw)].sum() / (len(lives) * n[draw].sum()) for draw in draws]
    value = wins.sum() / (len(lives) * n.sum())
    return Estimate(float(value), float(np.median(found)), percentile_interval(found), len(lives))
