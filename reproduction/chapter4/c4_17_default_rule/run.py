"""C4.17: six selection rules in 22 worlds, with exact models and with models learnt from few runs.

Our own claim, not of the thesis. Tasks come in groups. A group has tasks, noise and, where they are drawn,
deviations and tables of its own. Where models are learnt it has a library of its own, and the rules among which
the library's default is decided also run with models that are known to be uncertain. All meet the same tasks, luck
and libraries.
"""

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import (
    BeliefSampling,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    SelectionRule,
)
from reproduction.chapter4.c4_17_default_rule.worlds import CALLS, EQUAL, NOISES, world_of
from reproduction.chapter4.reuse.many_tasks import (
    EXACT,
    LEARNT,
    UNCERTAIN,
    late_regret,
    play_doubting,
    play_rule,
)

RULES: dict[str, SelectionRule] = {
    "EI, outcome": ExpectedImprovement(of="outcome"),
    "EI, pay": ExpectedImprovement(of="pay"),
    "IDS": InformationDirected(),
    "KG": KnowledgeGradient(),
    "sampling": BeliefSampling(),
    "greedy": Greedy(),
}
CANDIDATES = ("EI, pay", "IDS")
"""Rules among which the library's default is decided: they need no horizon and cost little for many users."""
STUCK = 0.01
"""Share of the range of mean pays; a task is stuck where its regret over the last ten episodes exceeds it."""


def cells(settings: Mapping) -> list[dict]:
    """Every world with every noise; calls have a single noise."""
    noises = {name: (EQUAL,) if name == CALLS else NOISES for name in settings["worlds"]}
    return [
        {"world": name, "noise": noise, "model": model}
        for name, model in product(settings["worlds"], (EXACT, LEARNT))
        for noise in noises[name]
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By rule and group: the mean of the summed regret and the share of stuck tasks, (n_groups,) each.

    ``rules`` take models for the truth; ``uncertain``: the candidates know that learnt models are uncertain.
    """
    groups = [_group(settings, cell, seed, group) for group in range(settings["groups"])]
    return {
        **cell,
        **{
            kind: {
                name: {key: [group[kind][name][key] for group in groups] for key in ("regret", "stuck")}
                for name in groups[0][kind]
            }
            for kind in groups[0]
        },
    }


def _group(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict[str, dict[str, dict[str, float]]]:
    name, noise, model = cell["world"], cell["noise"], cell["model"]
    n_tasks, n_episodes = settings["tasks"], settings["episodes"]
    world = world_of(name, noise, seed, group)
    training = stream(seed, "C4.17", "training runs", name, noise, group)
    library = world.library(model, settings["samples"], training)
    tasks = stream(seed, "C4.17", "tasks", name, group)
    types, luck = tasks.integers(len(world.mean), size=n_tasks), tasks.random((n_tasks, n_episodes))
    signals, most = world.pays(types, luck), STUCK * float(np.ptp(world.mean))

    def judged(policies: NDArray[np.int64]) -> dict[str, float]:
        regret = library_regret(world.mean[types], policies)
        return {
            "regret": round(float(regret.sum(axis=1).mean()), 4),
            "stuck": float((late_regret(regret) > most).mean()),
        }

    found: dict[str, dict[str, dict[str, float]]] = {"rules": {}}
    for word, rule in RULES.items():
        generator = stream(seed, "C4.17", "chooser", word, name, noise, model, group)
        found["rules"][word] = judged(play_rule(rule, library, signals, n_tasks, n_episodes, generator).policies)
    if model == LEARNT:
        found[UNCERTAIN] = {}
        for word in CANDIDATES:
            of_agents = (seed, "C4.17", "doubting", word, name, noise, group)
            played = play_doubting(RULES[word], library, signals, n_tasks, n_episodes, of_agents)
            found[UNCERTAIN][word] = judged(played.policies)
    return found
