"""C4.8: regret by size of the library and number of episodes. Thesis: §4.6.4, Figure 4.12.

By Definition 4.3.1 regret is counted against the best policy of the *library*: a library without a good policy for
a task has next to no regret on it. Against the best of all 68 policies a larger library can come nearer.
"""

from collections.abc import Mapping
from itertools import product

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.reuse.regret import library_regret
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN, play_doubting, play_rule
from reproduction.chapter4.reuse.rules import RULES_SHOWN
from reproduction.chapter4.surveillance.runs import SEEN, draw_tasks, library_of

RULE = "EI"
AGAINST = ("all", "library")
"""The policies with whose best regret compares."""


def check(settings: Mapping) -> None:
    for key in ("shares", "episodes"):
        values = settings[key]
        if len(values) < 2 or sorted(set(values)) != values:
            raise InputError(f"{key} must be two or more, rising, got {values}")
    if RULE not in settings["rules"]:
        raise InputError(f"rules must include {RULE}, got {settings['rules']}")


def cells(settings: Mapping) -> list[dict]:
    """Every rule, kind of model and size of the library."""
    every = [
        *product(settings["rules"], (LEARNT, EXACT), settings["shares"]),
        *product([RULE], [UNCERTAIN], settings["shares"]),
    ]
    return [{"rule": name, "model": model, "share": share} for name, model, share in every]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean regret up to each number of episodes, trial by trial, (n_trials, n_episodes) against each best.

    ``met``: whether the task's type is in the library.
    """
    world, n_episodes = Surveillance(), settings["episodes"]
    found: dict[str, list] = {key: [] for key in (*AGAINST, "met")}
    for trial in range(settings["trials"]):
        order = stream(seed, "library", trial).permutation(world.n_targets)
        part = np.sort(order[: max(1, round(cell["share"] * world.n_targets))])
        task = draw_tasks(world, SEEN, 1, n_episodes[-1], seed, trial)
        library = library_of(world, cell["model"], settings["samples"], seed, trial).take(
            part.tolist(), part.tolist()
        )
        mean = task.mean[:, part]

        def pays(episode: int, policies: np.ndarray, mean=mean, task=task) -> np.ndarray:
            return mean[0, policies] + world.deviation * task.noise[:, episode]

        rule, stream_of = RULES_SHOWN[cell["rule"]], (seed, "chooser", cell["rule"], trial)
        if cell["model"] == UNCERTAIN:
            played = play_doubting(rule, library, pays, 1, n_episodes[-1], stream_of)
        else:
            played = play_rule(rule, library, pays, 1, n_episodes[-1], stream(*stream_of))
        chosen = played.policies
        regrets = {"all": library_regret(task.mean, part[chosen]), "library": library_regret(mean, chosen)}
        for against, regret in regrets.items():
            found[against].append([round(float(regret[0, :k].mean()), 3) for k in n_episodes])
        found["met"].append(int(task.mean[0].argmax() in part))
    return {**cell, **found}
