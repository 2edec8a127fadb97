"""`bench perfect_information`: regret of the myopic value of perfect information beside that of four other rules.

The worlds and their noises are those of claim O1, without the three other layouts of the surveillance reserve.
Each round is a group of ten tasks of 50 episodes, with noise and learnt models of its own; all rules meet the
same. With uncertain models rules hold a belief over the parameters of learnt models too.
"""

from collections.abc import Iterator, Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import at_most, estimated_row, row
from lifelore.core.metrics import mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import (
    ExpectedImprovement,
    InformationDirected,
    KnowledgeGradient,
    SelectionRule,
    ValueOfPerfectInformation,
)
from reproduction.chapter4.reuse.many_tasks import (
    EXACT,
    LEARNT,
    UNCERTAIN,
    late_regret,
    play_doubting,
    play_rule,
)
from reproduction.own.o_01_default_rule.run import STUCK
from reproduction.own.o_01_default_rule.worlds import (
    CALLS,
    EQUAL,
    GOLF,
    NOISES,
    TABLES,
    TELEPHONE,
    world_of,
)

Array = NDArray[np.float64]
Case = tuple[str, str, str]
"""World, noise and models."""

PERFECT, ONCE = "perfect information", "perfect information, counted once"
GRADIENT, DIRECTED, IMPROVEMENT = "knowledge gradient", "information-directed", "improvement of the pay"
RULES: dict[str, SelectionRule] = {
    PERFECT: ValueOfPerfectInformation(),
    ONCE: ValueOfPerfectInformation(counted="once"),
    GRADIENT: KnowledgeGradient(),
    DIRECTED: InformationDirected(),
    IMPROVEMENT: ExpectedImprovement(),
}
WORLDS = ("X", GOLF, TELEPHONE, TABLES, CALLS)
MODELS = (EXACT, LEARNT, UNCERTAIN)
WITH_DOUBT = (PERFECT, ONCE, DIRECTED, IMPROVEMENT)
"""Rules that also run with uncertain models; a decision of the knowledge gradient takes several times theirs."""
TASKS, EPISODES, RUNS = 10, 50, 10
"""Tasks of a round, episodes of a task, and runs of each pair of type and policy behind learnt models."""
LIKE_GRADIENT = 1.1
"""Largest ratio of the regrets of the two rules; the thesis calls them similar in principle."""


def bench_perfect_information(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`. Rows also have ``ci95`` and ``n``, the rounds."""
    cases = list(_cases())
    found: dict[Case, dict[str, list[tuple[float, float]]]] = {
        case: {name: [] for name in _rules(case)} for case in cases
    }
    for number, (round_, case) in enumerate(product(range(repeats), cases)):
        for name in found[case]:
            found[case][name].append(played(case, name, round_))
        progress(number + 1, repeats * len(cases), ", ".join(case))
    rows = [
        line for models in MODELS for line in _rows({case: found[case] for case in cases if case[2] == models})
    ]
    ratios = {line["name"]: line["value"] for line in rows}
    goals = [
        at_most(name, LIKE_GRADIENT, ratios[name])
        for name in (f"regret of {PERFECT} / {GRADIENT}, {models} models" for models in (EXACT, LEARNT))
    ]
    return {"rows": rows, "goals": goals}


def _cases() -> Iterator[Case]:
    for models, name in product(MODELS, WORLDS):
        for noise in (EQUAL,) if name == CALLS else NOISES:
            yield name, noise, models


def _rules(case: Case) -> tuple[str, ...]:
    return WITH_DOUBT if case[2] == UNCERTAIN else tuple(RULES)


def played(case: Case, rule: str, round_: int) -> tuple[float, float]:
    """Mean summed regret of a round's tasks, and the share of them that is stuck as in O1."""
    name, noise, models = case
    world = world_of(name, noise, 0, round_)
    known = EXACT if models == EXACT else LEARNT
    library = world.library(known, RUNS, stream(0, "bench", "perfect information", "runs", name, noise, round_))
    tasks = stream(0, "bench", "perfect information", "tasks", name, round_)
    types, luck = tasks.integers(len(world.mean), size=TASKS), tasks.random((TASKS, EPISODES))
    signals, of_rule = world.pays(types, luck), (0, "bench", "perfect information", rule, *case, round_)
    if models == UNCERTAIN:
        policies = play_doubting(RULES[rule], library, signals, TASKS, EPISODES, of_rule).policies
    else:
        policies = play_rule(RULES[rule], library, signals, TASKS, EPISODES, stream(*of_rule)).policies
    regret = library_regret(world.mean[types], policies)
    stuck = late_regret(regret) > STUCK * float(np.ptp(world.mean))
    return float(regret.sum(axis=1).mean()), float(stuck.mean())


def _rows(found: Mapping[Case, Mapping[str, list[tuple[float, float]]]]) -> Iterator[dict]:
    """By rule: regret in units of the best rule of a world, mean over worlds, and stuck tasks above the least."""
    names, (models,) = list(next(iter(found.values()))), {case[2] for case in found}
    regret = {name: np.array([np.array(of[name])[:, 0] for of in found.values()]) for name in names}
    stuck = {name: np.array([np.array(of[name])[:, 1].mean() for of in found.values()]) for name in names}
    best = np.min([values.mean(axis=1) for values in regret.values()], axis=0)
    relative = {name: (values / best[:, None]).mean(axis=0) for name, values in regret.items()}
    least = np.min(list(stuck.values()), axis=0)
    for name in names:
        yield estimated_row(f"relative regret, {name}, {models} models", mean_estimate(relative[name]), "ratio")
        above = float((stuck[name] - least).max())
        yield row(f"stuck above the least, at most, {name}, {models} models", above, "share")
    for other in (name for name in names if name != PERFECT):
        estimate = ratio_estimate(relative[PERFECT], relative[other])
        yield estimated_row(f"regret of {PERFECT} / {other}, {models} models", estimate, "ratio")
