"""C4.17: six selection rules in 22 worlds, with exact models and with models learnt from few runs.

Our own claim, not of the thesis. Tasks come in groups. A group has tasks, noise and, where they are drawn,
deviations and tables of its own. Where models are learnt it has a library of its own. All rules meet the same
tasks, luck and libraries.
"""

from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.core.streams import stream
from lifelore.experiments.chapter4.c4_17_default_rule.worlds import CALLS, EQUAL, NOISES, world_of
from lifelore.experiments.chapter4.reuse.many_tasks import EXACT, LEARNT, late_regret, play_rule
from lifelore.interaction.reuse.regret import library_regret
from lifelore.interaction.selection import (
    BeliefSampling,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    SelectionRule,
)

RULES: dict[str, SelectionRule] = {
    "EI, outcome": ExpectedImprovement(of="outcome"),
    "EI, pay": ExpectedImprovement(of="pay"),
    "IDS": InformationDirected(),
    "KG": KnowledgeGradient(),
    "sampling": BeliefSampling(),
    "greedy": Greedy(),
}
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
    """By rule and group: the mean of the summed regret and the share of stuck tasks, (n_groups,) each."""
    groups = [_group(settings, cell, seed, group) for group in range(settings["groups"])]
    return {
        **cell,
        "rules": {
            name: {key: [group[name][key] for group in groups] for key in ("regret", "stuck")} for name in RULES
        },
    }


def _group(settings: Mapping, cell: Mapping, seed: int, group: int) -> dict[str, dict[str, float]]:
    name, noise, model = cell["world"], cell["noise"], cell["model"]
    n_tasks, n_episodes = settings["tasks"], settings["episodes"]
    world = world_of(name, noise, seed, group)
    training = stream(seed, "C4.17", "training runs", name, noise, group)
    library = world.library(model, settings["samples"], training)
    tasks = stream(seed, "C4.17", "tasks", name, group)
    types, luck = tasks.integers(len(world.mean), size=n_tasks), tasks.random((n_tasks, n_episodes))
    signals, most = world.pays(types, luck), STUCK * float(np.ptp(world.mean))
    found = {}
    for word, rule in RULES.items():
        generator = stream(seed, "C4.17", "chooser", word, name, noise, model, group)
        policies = play_rule(rule, library, signals, n_tasks, n_episodes, generator).policies
        regret = library_regret(world.mean[types], policies)
        found[word] = {
            "regret": round(float(regret.sum(axis=1).mean()), 4),
            "stuck": float((late_regret(regret) > most).mean()),
        }
    return found
