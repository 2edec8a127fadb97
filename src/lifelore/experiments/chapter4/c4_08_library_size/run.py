"""C4.8: regret by size of the library and number of episodes. Thesis: §4.6.4, Figure 4.12.

By Definition 4.3.1 regret is counted against the best policy of the *library*: a library without a good policy for
a task has next to no regret on it. Against the best of all 68 policies a larger library can come nearer.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.experiments.chapter4.reuse_runs import play_rule
from lifelore.experiments.chapter4.surveillance_runs import EXACT, LEARNT, SEEN, draw_tasks, library_of
from lifelore.interaction.reuse.regret import library_regret

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
    return [
        {"rule": name, "model": model, "share": share}
        for name in settings["rules"]
        for model in (LEARNT, EXACT)
        for share in settings["shares"]
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean regret up to each number of episodes, trial by trial, (n_trials, n_episodes) against each best."""
    world = Surveillance()
    found: dict[str, list] = {against: [] for against in AGAINST}
    known = []
    for trial in range(settings["trials"]):
        regret, met = _trial(settings, cell, world, seed, trial)
        for against, values in regret.items():
            found[against].append([round(float(values[:k].mean()), 3) for k in settings["episodes"]])
        known.append(met)
    return {**cell, **found, "met": known}


def _trial(settings: Mapping, cell: Mapping, world: Surveillance, seed: int, trial: int) -> tuple[dict, int]:
    """Regret by episode against both, and whether the task's type is in the library."""
    n, length = world.n_targets, settings["episodes"][-1]
    order = stream(seed, "library", trial).permutation(n)
    kept = np.sort(order[: max(1, round(cell["share"] * n))])
    task = draw_tasks(world, SEEN, 1, length, seed, trial)
    library = library_of(world, cell["model"], settings["samples"], seed, trial).take(kept.tolist(), kept.tolist())
    mean = task.mean[:, kept]

    def pays(episode: int, policies: np.ndarray) -> np.ndarray:
        return mean[0, policies] + world.deviation * task.noise[:, episode]

    generator = stream(seed, "chooser", cell["rule"], trial)
    played = play_rule(RULES_SHOWN[cell["rule"]], library, pays, 1, length, generator)
    regret = {
        "all": library_regret(task.mean, kept[played.policies])[0],
        "library": library_regret(mean, played.policies)[0],
    }
    return regret, int(task.mean[0].argmax() in kept)
