"""C4.8: how regret depends on the size of the library and on the number of episodes.

In each trial a random part of the 68 types with their policies is the library, and the task is any of the 68,
met in training or not. The larger library of a trial holds the smaller one, and all meet the same task and
noise.

Against which policy regret is counted decides what the figure can show. The thesis's own definition takes the
best policy of the *library* (Definition 4.3.1): then a library with nothing of use for a task has next to no
regret on it. The default here is the best of all 68, which is what a larger library can come nearer to; the
other stands beside it.

What is known: models learnt from `samples` deployments a pair, or exact ones, of the library's types and policies.

Thesis: §4.6.4, Figure 4.12.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.experiments.chapter4.reuse_runs import play_rule
from lifelore.experiments.chapter4.surveillance_runs import EXACT, LEARNT, SEEN, draw_tasks, library_of
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import share_of
from lifelore.experiments.engine.learning_settings import check_counts
from lifelore.experiments.engine.predicate import Predicate
from lifelore.interaction.reuse.regret import library_regret

FULL = {
    "trials": 300,
    "shares": [0.1, 0.25, 0.5, 0.75, 1.0],
    "episodes": [5, 10, 20, 30, 40, 50],
    "samples": 10,
    "rules": ["EI", "EI, printed", "sampling"],
}
QUICK = {**FULL, "trials": 8, "episodes": [5, 20], "rules": ["EI"]}
RULE = "EI"
AGAINST = ("all", "library")
"""Whose best policy regret is counted against."""


def _check(settings: Mapping) -> None:
    check_counts(settings, ("trials", "episodes", "samples"))
    shares, episodes = settings["shares"], settings["episodes"]
    if len(shares) < 2 or not shares[0] > 0 or shares[-1] > 1 or sorted(set(shares)) != shares:
        raise InputError(f"shares must be two or more in (0, 1], rising, got {shares}")
    if len(episodes) < 2 or sorted(set(episodes)) != episodes:
        raise InputError(f"episodes must be two or more, rising, got {episodes}")
    unknown = [name for name in settings["rules"] if name not in RULES_SHOWN]
    if unknown or RULE not in settings["rules"]:
        raise InputError(
            f"rules must include {RULE} and be among {', '.join(RULES_SHOWN)}, got {settings['rules']}"
        )


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


def table(settings: Mapping, results: Sequence[Mapping], rule: str, model: str, against: str) -> np.ndarray:
    """Mean regret of every trial, (n_shares, n_episodes, n_trials)."""
    of = {r["share"]: np.array(r[against], float).T for r in results if (r["rule"], r["model"]) == (rule, model)}
    return np.stack([of[share] for share in settings["shares"]])


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What size and episodes save, corner against corner, and in how many single steps the mean falls."""
    measured: dict[str, Estimate] = {}
    first, last = settings["episodes"][0], settings["episodes"][-1]
    for rule in settings["rules"]:
        for model in (LEARNT, EXACT):
            for against in AGAINST:
                found = table(settings, results, rule, model, against)
                name = f"{rule.replace(', ', '_')}_{model}" + ("" if against == "all" else "_library_regret")
                measured[f"saved_by_size_early_{name}"] = _saved(found[0, 0], found[-1, 0])
                measured[f"saved_by_size_late_{name}"] = _saved(found[0, -1], found[-1, -1])
                measured[f"saved_by_episodes_small_{name}"] = _saved(found[0, 0], found[0, -1])
                measured[f"saved_by_episodes_whole_{name}"] = _saved(found[-1, 0], found[-1, -1])
                mean = found.mean(axis=2)
                measured[f"steps_of_size_{name}"] = share_of((np.diff(mean, axis=0) < 0).ravel())
                measured[f"steps_of_episodes_{name}"] = share_of((np.diff(mean, axis=1) < 0).ravel())
                measured[f"least_step_of_size_late_{name}"] = _least(found[:, -1])
                measured[f"regret_whole_{last}_{name}"] = mean_estimate(found[-1, -1])
                measured[f"regret_whole_{first}_{name}"] = mean_estimate(found[-1, 0])
    return measured


def _saved(before: np.ndarray, after: np.ndarray) -> Estimate:
    """How much less `after` is, trial by trial."""
    return mean_estimate(before - after)


def _least(found: np.ndarray) -> Estimate:
    """The smallest of what one step in size saves, (n_shares, n_trials)."""
    steps = [_saved(small, large) for small, large in pairwise(found)]
    return min(steps, key=lambda step: step.value)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: mean regret up to each number of episodes, its standard error, and tasks met in training."""
    kept = []
    for result in results:
        row = {key: result[key] for key in ("rule", "model", "share")}
        for against in AGAINST:
            values = np.array(result[against], float)
            row[against] = values.mean(axis=0).round(3).tolist()
            row[f"{against}_error"] = (values.std(axis=0, ddof=1) / len(values) ** 0.5).round(3).tolist()
        row["share_met"] = round(float(np.mean(result["met"])), 4)
        kept.append(row)
    return kept


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_08_library_size.figure_library_size import draw_library_size

    return draw_library_size(result)


CAUSES = {
    "library regret, size": "by Definition 4.3.1 a small library has seldom a policy that pays on the task, so "
    "that there is little to regret",
}

CLAIM = Claim(
    id="C4.8",
    title="Size of the library and number of episodes (Figure 4.12)",
    thesis="Average regret of BPR-EI falls with the size of the library, as a share of the 68 tasks, and with the "
    "number of episodes; 200 trials a cell, tasks seen and unseen.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.8"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
